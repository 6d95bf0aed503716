//! Solving a case, and asking its solution.

use crate::case::Case;
use crate::errors::raised;
use crate::tables::table;
use crate::work::work;
use edgeline::base::{BodyKind, Error, Result};
use edgeline::cli::values::checked_tolerance;
use edgeline::report::solution::{tables, write_locked};
use edgeline::solve::{Options, SolvedCase};
use edgeline::stress::Grid;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray4, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// A case's solution by one method.
#[pyclass(frozen, module = "edgeline._native")]
pub struct Solution {
    options: Options,
    solved: SolvedCase,
    found: edgeline::solve::Solution,
}

/// Solves a case.
#[pyfunction]
#[pyo3(signature = (case, method, tolerance, engine))]
pub fn solve(
    py: Python<'_>,
    case: &Case,
    method: &str,
    tolerance: Option<f64>,
    engine: Option<&str>,
) -> PyResult<Solution> {
    work(py, || Solution::new(case.0.clone(), method, tolerance, engine))?.map_err(raised)
}

impl Solution {
    fn new(
        mut case: edgeline::case::Case,
        method: &str,
        tolerance: Option<f64>,
        engine: Option<&str>,
    ) -> Result<Self> {
        if let Some(tolerance) = tolerance {
            case.accuracy.tolerance = checked_tolerance(tolerance)?;
        }
        if let Some(other) = engine.filter(|engine| *engine != "line") {
            return Err(Error::Value {
                key: "engine".into(),
                value: format!("{other:?}"),
                reason: "there is no engine of this name".into(),
                remedy: "give line".into(),
            });
        }
        let options = Options::new(method.parse()?);
        let solved = SolvedCase::new(&case, &options)?;
        let found = solved.solution();
        Ok(Self { options, solved, found })
    }
}

/// A body by its name.
fn body(name: &str) -> Result<BodyKind> {
    let named = |body: &BodyKind| body.name() == name;
    BodyKind::ALL.into_iter().find(named).ok_or_else(|| Error::Value {
        key: "body".into(),
        value: format!("{name:?}"),
        reason: "there is no body of this name".into(),
        remedy: format!("give {}", BodyKind::ALL.map(BodyKind::name).join(" or ")),
    })
}

#[pymethods]
impl Solution {
    /// The summary as JSON.
    fn summary(&self) -> String {
        serde_json::to_string(&self.found.summary).expect("a summary is plain data")
    }

    /// All tables by their names.
    fn tables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for columns in work(py, || tables(&self.found, &self.options))? {
            all.set_item(columns.name, table(py, columns)?)?;
        }
        Ok(all)
    }

    /// Pressure (Pa) at x, y (m), all of one length.
    fn pressure<'py>(
        &self,
        py: Python<'py>,
        x: PyReadonlyArray1<'py, f64>,
        y: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (x, y) = (x.as_slice()?, y.as_slice()?);
        let scales = *self.solved.hertz();
        let at = |(x, y): (&f64, &f64)| {
            scales.p0_pa * self.solved.pressure(x / scales.c_m, y / scales.c_m)
        };
        let found: Vec<f64> = work(py, || x.iter().zip(y).map(at).collect())?;
        Ok(found.into_pyarray(py))
    }

    /// Stresses (Pa), shape (n, 6), at x, y, z (m), all of length n.
    fn stress<'py>(
        &self,
        py: Python<'py>,
        body_name: &str,
        x: PyReadonlyArray1<'py, f64>,
        y: PyReadonlyArray1<'py, f64>,
        z: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let body = body(body_name).map_err(raised)?;
        let (x, y, z) = (x.as_slice()?, y.as_slice()?, z.as_slice()?);
        let scales = *self.solved.hertz();
        let found = work(py, || {
            let at = x.iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z].map(|v| v / scales.c_m));
            let found = self.solved.stress(body, &at.collect::<Vec<_>>())?;
            Ok(found.iter().flat_map(|s| (*s * scales.p0_pa).components()).collect::<Vec<f64>>())
        })?
        .map_err(raised)?;
        let n = x.len();
        found.into_pyarray(py).reshape([n, 6])
    }

    /// Stresses (Pa) at every combination of x, y and z (m), shape (6, nz, ny, nx).
    fn grid<'py>(
        &self,
        py: Python<'py>,
        body_name: &str,
        x: PyReadonlyArray1<'py, f64>,
        y: PyReadonlyArray1<'py, f64>,
        z: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray4<f64>>> {
        let body = body(body_name).map_err(raised)?;
        let scales = *self.solved.hertz();
        let axis = |values: &[f64]| values.iter().map(|v| v / scales.c_m).collect::<Vec<_>>();
        let grid = Grid { x: axis(x.as_slice()?), y: axis(y.as_slice()?), z: axis(z.as_slice()?) };
        let shape = [6, grid.z.len(), grid.y.len(), grid.x.len()];
        let found = work(py, || {
            let found = self.solved.on_grid(body, &grid)?;
            Ok(found.values().iter().map(|v| v * scales.p0_pa).collect::<Vec<f64>>())
        })?
        .map_err(raised)?;
        found.into_pyarray(py).reshape(shape)
    }

    /// Writes the files of `edgeline solve` into a folder.
    fn write(&self, py: Python<'_>, folder: PathBuf) -> PyResult<()> {
        work(py, || write_locked(&self.found, &self.options, &folder))?.map_err(raised)
    }
}
