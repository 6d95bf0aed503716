//! Solving a case, and asking its solution.

use crate::case::Case;
use crate::errors::raised;
use crate::tables::table;
use crate::work::{heard, work};
use edgeline::base::{BodyKind, Error, HertzScales, Result, StressTensor};
use edgeline::cli::values::{checked_residual, checked_tolerance};
use edgeline::report::cells::contents;
use edgeline::report::columns::Columns;
use edgeline::report::solution::{tables, too_fine, write_locked};
use edgeline::solve::{
    CellOptions, CellSolution, Options, Point, SolvedCase, check_grid, check_points,
    solve_on_cells, stress_on_cells,
};
use edgeline::stress::Grid;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray4, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};

/// A case's solution by one method.
#[pyclass(frozen, module = "edgeline._native")]
pub struct Solution {
    case: edgeline::case::Case,
    options: Options,
    solved: Solved,
}

/// What the engine found.
enum Solved {
    Line(Box<(SolvedCase, edgeline::solve::Solution)>),
    Cells(Box<CellSolution>),
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
    heard(py, || Solution::new(case.0.clone(), method, tolerance, engine))?.map_err(raised)
}

impl Solution {
    fn new(
        mut case: edgeline::case::Case,
        method: &str,
        tolerance: Option<f64>,
        engine: Option<&str>,
    ) -> Result<Self> {
        let options = Options::new(method.parse()?);
        // Only cells take a rough surface.
        let own = if case.surface.is_some() { "cells" } else { "line" };
        let solved = match engine.unwrap_or(own) {
            "line" => {
                if let Some(tolerance) = tolerance {
                    case.accuracy.tolerance = checked_tolerance(tolerance)?;
                }
                let solved = SolvedCase::new(&case, &options)?;
                case = solved.case().clone();
                let found = solved.solution();
                Solved::Line(Box::new((solved, found)))
            }
            "cells" => {
                let mut cells = CellOptions::default();
                if let Some(residual) = tolerance {
                    cells.tolerance = checked_residual(residual)?;
                }
                let quiet = |_: usize, _: f64| {};
                Solved::Cells(Box::new(solve_on_cells(&case, &options, &cells, &quiet)?))
            }
            other => {
                return Err(Error::Value {
                    key: "engine".into(),
                    value: format!("{other:?}"),
                    reason: "there is no engine of this name".into(),
                    remedy: "give line or cells".into(),
                });
            }
        };
        Ok(Self { case, options, solved })
    }

    fn tables(&self) -> Vec<Columns> {
        match &self.solved {
            Solved::Line(line) => tables(&line.1, &self.options),
            Solved::Cells(cells) => tables(&cells.solution, &self.options),
        }
    }

    fn write(&self, folder: &Path) -> Result<()> {
        match &self.solved {
            Solved::Line(line) => write_locked(&line.1, &self.options, Vec::new(), folder),
            Solved::Cells(cells) => {
                let more = contents(cells);
                write_locked(&cells.solution, &self.options, more, folder)
            }
        }
    }

    /// The pressure (p0) at x, y (C).
    fn at(&self, x: f64, y: f64) -> f64 {
        match &self.solved {
            Solved::Line(line) => line.0.pressure(x, y),
            Solved::Cells(cells) => cells.pressure_at(x, y),
        }
    }

    /// Stresses (p0) at places (m).
    fn stresses(&self, body: BodyKind, places: Vec<[f64; 3]>) -> Result<Vec<StressTensor>> {
        match &self.solved {
            Solved::Line(line) => {
                let c_m = line.0.hertz().c_m;
                let at: Vec<_> = places.iter().map(|at_m| at_m.map(|v| v / c_m)).collect();
                line.0.stress(body, &at)
            }
            Solved::Cells(cells) => {
                let points = places.into_iter().map(|at_m| Point { body, at_m }).collect();
                let options = Options { points, bodies: Vec::new(), ..self.options.clone() };
                stress_on_cells(&self.case, &options, &cells.pressure)
            }
        }
    }

    /// Stresses (Pa) on a grid (m), component by component.
    fn on_grid(&self, body: BodyKind, grid: &Grid) -> Result<Vec<f64>> {
        let HertzScales { c_m, p0_pa, .. } = self.case.hertz();
        if let Solved::Line(line) = &self.solved {
            let found = line.0.on_grid(body, &scaled(grid, c_m))?;
            return Ok(found.values().iter().map(|v| v * p0_pa).collect());
        }
        let Grid { x, y, z } = grid;
        let line = |z: f64, y: f64| x.iter().map(move |x| [*x, y, z]);
        let plane = |z: f64| y.iter().flat_map(move |y| line(z, *y));
        let found = self.stresses(body, z.iter().flat_map(|z| plane(*z)).collect())?;
        let component = |i: usize| found.iter().map(move |s| s.components()[i] * p0_pa);
        Ok((0..6).flat_map(component).collect())
    }
}

/// Points whose stresses are computed at once: between them signals, such as that of Ctrl-C, are
/// heard.
const AT_ONCE: usize = 4096;

/// The same of a grid, in whole planes: what a call sets up costs more on cells than its points.
const GRID_AT_ONCE: usize = 16384;

/// A grid (m) in units of C.
fn scaled(grid: &Grid, c_m: f64) -> Grid {
    let [x, y, z] = [&grid.x, &grid.y, &grid.z].map(|axis| axis.iter().map(|v| v / c_m).collect());
    Grid { x, y, z }
}

/// Refuses a place on the surface that is no place.
fn check_finite(x: &[f64], y: &[f64]) -> Result<()> {
    let bad = x.iter().zip(y).position(|(x, y)| !x.is_finite() || !y.is_finite());
    let Some(i) = bad else { return Ok(()) };
    Err(Error::Value {
        key: format!("point {}", i + 1),
        value: format!("({}, {}) m", x[i], y[i]),
        reason: "x and y are finite numbers".into(),
        remedy: "correct it, or leave it out".into(),
    })
}

/// A body by its name.
fn body(name: &str) -> Result<BodyKind> {
    BodyKind::find(name).ok_or_else(|| Error::Value {
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
        match &self.solved {
            Solved::Line(line) => serde_json::to_string(&line.1.summary),
            Solved::Cells(cells) => serde_json::to_string(&cells.solution.summary),
        }
        .expect("a summary is plain data")
    }

    /// What to know of the solution, and what to beware of.
    fn warnings(&self) -> Vec<String> {
        match &self.solved {
            Solved::Line(line) => {
                too_fine(&self.case).into_iter().chain(line.1.summary.warnings()).collect()
            }
            Solved::Cells(_) => Vec::new(),
        }
    }

    /// All tables by their names.
    #[pyo3(name = "tables")]
    fn all_tables<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for columns in work(py, || self.tables())? {
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
        check_finite(x, y).map_err(raised)?;
        let HertzScales { c_m, p0_pa, .. } = self.case.hertz();
        let at = |(x, y): (&f64, &f64)| p0_pa * self.at(x / c_m, y / c_m);
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
        let p0_pa = self.case.hertz().p0_pa;
        let places = x.iter().zip(y).zip(z).map(|((x, y), z)| [*x, *y, *z]);
        let places: Vec<[f64; 3]> = places.collect();
        check_points(&self.case, places.iter().map(|at_m| (body, *at_m))).map_err(raised)?;
        let mut found: Vec<f64> = Vec::with_capacity(6 * places.len());
        for some in places.chunks(AT_ONCE) {
            let stresses = work(py, || self.stresses(body, some.to_vec()))?.map_err(raised)?;
            found.extend(stresses.iter().flat_map(|s| (*s * p0_pa).components()));
            py.check_signals()?;
        }
        found.into_pyarray(py).reshape([places.len(), 6])
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
        let [x, y, z] = [x, y, z].map(|axis| axis.as_slice().map(<[f64]>::to_vec));
        let grid = Grid { x: x?, y: y?, z: z? };
        let shape = [6, grid.z.len(), grid.y.len(), grid.x.len()];
        let c_m = self.case.hertz().c_m;
        check_grid(&self.case, body, &scaled(&grid, c_m)).map_err(raised)?;
        let per_plane = grid.x.len() * grid.y.len();
        let mut components: [Vec<f64>; 6] = Default::default();
        for z in grid.z.chunks((GRID_AT_ONCE / per_plane.max(1)).max(1)) {
            let some = Grid { z: z.to_vec(), ..grid.clone() };
            let found = work(py, || self.on_grid(body, &some))?.map_err(raised)?;
            for (all, own) in components.iter_mut().zip(found.chunks_exact(some.len().max(1))) {
                all.extend(own);
            }
            py.check_signals()?;
        }
        components.concat().into_pyarray(py).reshape(shape)
    }

    /// Writes the files of `edgeline solve` into a folder.
    #[pyo3(name = "write")]
    fn write_files(&self, py: Python<'_>, folder: PathBuf) -> PyResult<()> {
        work(py, || self.write(&folder))?.map_err(raised)
    }
}
