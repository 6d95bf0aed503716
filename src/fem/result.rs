//! The output of the finite-element program: `fem.json`, `curves.csv`, `pressure.csv`.

use crate::base::number::stated;
use crate::base::{Error, HertzScales, Result, StressTensor};
use crate::body::EdgeModel;
use crate::case::Case;
use crate::host::csv_fault;
use crate::solve::Scene;
use crate::stress::curves::{across_contact, curves_on, every_name};
use crate::stress::{BodyKind, CurveSpec, Curves, PressureLine, StressCurve};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// Names of the pressure lines: x = 0, and y = 0 or, where the overlap does not contain that, its
/// middle.
pub const LINE_NAMES: [&str; 2] = ["along-y", "along-x"];

/// Points that differ by less than this (C) are equal: files have nine digits.
const SAME_POINT: f64 = 1e-6;

/// The relative tolerance of a coordinate far from the centre.
const SAME_POINT_RELATIVE: f64 = 1e-8;

/// The summary of one finite-element run: the content of `fem.json`, and of one mesh in a record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FemSummary {
    /// Versions of the libraries and programs, and the processor, by name.
    pub versions: BTreeMap<String, serde_json::Value>,
    /// Number of MPI ranks.
    pub ranks: usize,
    /// Unknowns of both bodies.
    pub unknowns: usize,
    /// |sum of the contact forces - load| / load.
    pub load_error_rel: f64,
    /// Error of the supports' reaction relative to the load, the larger of both bodies.
    pub equilibrium_residual: f64,
    /// Residual of complementarity, relative.
    pub complementarity_residual: f64,
    /// Approach (m) of the roller's mid-plane and the block's bottom: that of the model, which
    /// depends on how deep the block is.
    pub approach_m: f64,
    /// Pressure at the contact's centre (Pa).
    pub p_centre_pa: f64,
    /// Largest nodal pressure (Pa).
    pub p_max_pa: f64,
    /// Seconds of each stage, `total` among them.
    pub seconds: BTreeMap<String, f64>,
    /// Largest resident memory, summed over the ranks (MiB).
    pub peak_memory_mib: f64,
    /// All other data of the run (mesh, solver, boundary conditions, ...).
    #[serde(flatten)]
    pub more: serde_json::Map<String, serde_json::Value>,
}

impl FemSummary {
    /// Refuses a run that did not carry its load: its curves would be those of another problem.
    pub(super) fn check(&self, path: &Path) -> Result<()> {
        for (name, value) in [
            ("load_error_rel", self.load_error_rel),
            ("equilibrium_residual", self.equilibrium_residual),
        ] {
            if value.is_nan() || value.abs() > 1e-6 {
                return Err(nonsense(
                    path,
                    None,
                    format!("{name} = {} is more than 1e-6", stated(value)),
                ));
            }
        }
        for (name, value) in [
            ("p_centre_pa", self.p_centre_pa),
            ("p_max_pa", self.p_max_pa),
            ("unknowns", self.unknowns as f64),
            ("seconds.total", self.seconds.get("total").copied().unwrap_or(f64::NAN)),
        ] {
            if !(value.is_finite() && value > 0.0) {
                let message = format!("{name} = {value} is not a positive number");
                return Err(nonsense(path, None, message));
            }
        }
        Ok(())
    }

    /// Wall-clock seconds of all stages.
    pub fn total_seconds(&self) -> f64 {
        self.seconds["total"]
    }

    /// The processor that it ran on.
    pub fn processor(&self) -> &str {
        self.versions.get("processor").and_then(|v| v.as_str()).unwrap_or("unknown")
    }
}

/// The result of one mesh, from a record or from a live run.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshResult {
    /// Relative element size; 1 is the production mesh, smaller is finer.
    pub size: f64,
    /// The summary of its run.
    pub summary: FemSummary,
    /// Contact pressure along y and along x, and stresses on the standard curves of both bodies, in
    /// the order of [`curves_on`], the block first.
    pub curves: Curves,
}

/// The files of a finished run as texts.
#[derive(Debug, Clone, Copy)]
pub struct ResultTexts<'t> {
    /// `fem.json`.
    pub summary: &'t str,
    /// `curves.csv`.
    pub curves: &'t str,
    /// `pressure.csv`.
    pub pressure: &'t str,
}

impl MeshResult {
    /// Reads the result of `case` on the mesh of relative `size` by `ranks` processes; `folder`,
    /// where the files stand, is only named in errors.
    ///
    /// # Errors
    /// [`Error::File`] when a file is damaged, belongs to another case or another number of
    /// processes, or states that the run did not carry its load.
    pub fn parse(
        case: &Case,
        size: f64,
        ranks: usize,
        texts: ResultTexts,
        folder: &Path,
    ) -> Result<Self> {
        let path = folder.join("fem.json");
        let value = parse_json(texts.summary, &path)?;
        let hertz = case.hertz();
        for (pointer, wanted) in [("/hertz/c_m", hertz.c_m), ("/hertz/p0_pa", hertz.p0_pa)] {
            let got = value.pointer(pointer).and_then(Value::as_f64).unwrap_or(f64::NAN);
            if (got / wanted - 1.0).abs() > 1e-9 || got.is_nan() {
                let message = format!("{pointer} = {got:e}, but the case has {wanted:e}");
                return Err(nonsense(&path, None, message));
            }
        }
        let summary: FemSummary = serde_json::from_value(value)
            .map_err(|e| nonsense(&path, None, format!("is not a FEM summary: {e}")))?;
        summary.check(&path)?;
        if summary.ranks != ranks {
            let message = format!("was computed by {} processes", summary.ranks);
            return Err(nonsense(&path, None, message));
        }
        let stress = parse_curves(texts.curves, &hertz, &folder.join("curves.csv"))?;
        let pressure = parse_lines(texts.pressure, &hertz, &folder.join("pressure.csv"))?;
        let curves = Curves {
            hertz,
            pressure: pressure.into_iter().map(|(_, line)| line).collect(),
            stress: stress.into_iter().map(|(_, curve)| curve).collect(),
        };
        check_points(case, &curves, folder)?;
        Ok(Self { size, summary, curves })
    }
}

/// The standard curves of both bodies of `case` (C).
fn curves_of(case: &Case) -> impl Iterator<Item = CurveSpec> {
    let (c_m, span) = (case.hertz().c_m, Scene::new(case, EdgeModel::HalfSpace, None).span());
    BodyKind::ALL
        .into_iter()
        .flat_map(move |body| curves_on(body, &span, case.ends_m(body).map(|y| y / c_m)))
}

/// The points of the pressure lines of `case` (C).
fn lines_of(case: &Case) -> [(&'static str, Vec<[f64; 2]>); 2] {
    let span = Scene::new(case, EdgeModel::HalfSpace, None).span();
    let along_y = span.contact_line().into_iter().map(|y| [0.0, y]).collect();
    let along_x = across_contact().into_iter().map(|x| [x, span.centre()]).collect();
    let [first, second] = LINE_NAMES;
    [(first, along_y), (second, along_x)]
}

/// The curves that are asked of the finite-element side, points in metres.
pub fn wanted_curves(case: &Case) -> Vec<(BodyKind, &'static str, Vec<[f64; 3]>)> {
    let c_m = case.hertz().c_m;
    let in_metres = |points: &[[f64; 3]]| points.iter().map(|p| p.map(|v| v * c_m)).collect();
    curves_of(case).map(|spec| (spec.body, spec.name, in_metres(&spec.points))).collect()
}

/// The points at which the contact pressure is requested (m), by line.
pub fn wanted_lines(case: &Case) -> Vec<(&'static str, Vec<[f64; 2]>)> {
    let c_m = case.hertz().c_m;
    let in_metres = |points: Vec<[f64; 2]>| points.iter().map(|p| p.map(|v| v * c_m)).collect();
    lines_of(case).into_iter().map(|(name, points)| (name, in_metres(points))).collect()
}

/// Whether two lists contain the same points (C), within the digits of a file.
fn same_points<const N: usize>(got: &[[f64; N]], want: &[[f64; N]]) -> bool {
    let near = |(g, w): (&f64, &f64)| (g - w).abs() <= SAME_POINT + SAME_POINT_RELATIVE * w.abs();
    got.len() == want.len() && got.iter().zip(want).all(|(g, w)| g.iter().zip(w).all(near))
}

/// Checks that `curves`, from `curves.csv` and `pressure.csv` in `folder`, are those of `case`,
/// point by point.
///
/// # Errors
/// [`Error::File`] that names the first curve or line that is missing, too many, or elsewhere.
pub fn check_points(case: &Case, curves: &Curves, folder: &Path) -> Result<()> {
    let path = &folder.join("curves.csv");
    let wanted: Vec<_> = curves_of(case).collect();
    if curves.stress.len() != wanted.len() {
        let message = format!("holds {} curves instead of {}", curves.stress.len(), wanted.len());
        return Err(nonsense(path, None, message));
    }
    for (curve, spec) in curves.stress.iter().zip(&wanted) {
        let named = curve.body == spec.body && curve.name == spec.name;
        if !(named && same_points(&curve.at, &spec.points)) {
            let message = format!(
                "the {} points of {} {} are not the {} of {} {}",
                curve.at.len(),
                curve.body.name(),
                curve.name,
                spec.points.len(),
                spec.body.name(),
                spec.name,
            );
            return Err(nonsense(path, None, message));
        }
    }
    let path = &folder.join("pressure.csv");
    let wanted = lines_of(case);
    let same = |(line, (name, points)): (&PressureLine, &(&str, Vec<_>))| {
        line.name == *name && same_points(&line.at, points)
    };
    if curves.pressure.len() == wanted.len() && curves.pressure.iter().zip(&wanted).all(same) {
        return Ok(());
    }
    Err(nonsense(path, None, "the pressure lines are not those that were asked for"))
}

/// Curves of a `curves.csv` in units of `hertz`, each with the size of its mesh: from the leading
/// column `mesh` if there is one, otherwise NaN.
pub(super) fn parse_curves(
    text: &str,
    hertz: &HertzScales,
    path: &Path,
) -> Result<Vec<(f64, StressCurve)>> {
    let mut stress_columns = Vec::from(["body", "curve", "x_m", "y_m", "z_m"]);
    let names = StressTensor::NAMES.map(|name| format!("{name}_pa"));
    stress_columns.extend(names.iter().map(String::as_str));
    let table = Csv::parse(text, path, &stress_columns)?;
    let names_of_curves: Vec<&str> = every_name().collect();
    let mut curves: Vec<(f64, StressCurve)> = Vec::new();
    for row in table.rows() {
        let row = row?;
        let body = BodyKind::find(row.text(0))
            .ok_or_else(|| row.nonsense(format!("there is no body '{}'", row.text(0))))?;
        let name = row.one_of(1, &names_of_curves)?;
        let at = [row.number(2)?, row.number(3)?, row.number(4)?].map(|v| v / hertz.c_m);
        let mut components = [0.0; 6];
        for (i, component) in components.iter_mut().enumerate() {
            *component = row.number(5 + i)? / hertz.p0_pa;
        }
        let stress = StressTensor::from_components(components);
        let size = row.mesh()?;
        match curves.last_mut() {
            Some((s, curve)) if same_mesh(*s, size) && curve.body == body && curve.name == name => {
                curve.at.push(at);
                curve.stress.push(stress);
            }
            _ => {
                let (name, at, stress) = (name.to_string(), vec![at], vec![stress]);
                curves.push((size, StressCurve { body, name, at, stress, own_error: None }));
            }
        }
    }
    Ok(curves)
}

/// Lines of a `pressure.csv` in units of `hertz`, each with the size of its mesh as in
/// [`parse_curves`].
pub(super) fn parse_lines(
    text: &str,
    hertz: &HertzScales,
    path: &Path,
) -> Result<Vec<(f64, PressureLine)>> {
    let table = Csv::parse(text, path, &["line", "x_m", "y_m", "p_pa"])?;
    let mut lines: Vec<(f64, PressureLine)> = Vec::new();
    for row in table.rows() {
        let row = row?;
        let name = row.one_of(0, &LINE_NAMES)?;
        let at = [row.number(1)?, row.number(2)?].map(|v| v / hertz.c_m);
        let p = row.number(3)? / hertz.p0_pa;
        let size = row.mesh()?;
        match lines.last_mut() {
            Some((s, line)) if same_mesh(*s, size) && line.name == name => {
                line.at.push(at);
                line.p.push(p);
            }
            _ => {
                let (name, at, p) = (name.to_string(), vec![at], vec![p]);
                lines.push((size, PressureLine { name, at, p, own_error: None }));
            }
        }
    }
    Ok(lines)
}

/// Parses JSON that the finite-element side wrote.
fn parse_json(text: &str, path: &Path) -> Result<Value> {
    serde_json::from_str(text)
        .map_err(|e| nonsense(path, Some(e.line()), format!("is not JSON: {e}")))
}

/// What `mesh.json` says about the meshes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MeshSummary {
    /// Unknowns of both bodies.
    pub unknowns: u64,
}

impl MeshSummary {
    /// Reads a `mesh.json`; `path` is only named in errors.
    ///
    /// # Errors
    /// [`Error::File`] when it does not state the unknowns of both bodies.
    pub fn parse(text: &str, path: &Path) -> Result<Self> {
        let value = parse_json(text, path)?;
        let mut unknowns = 0u64;
        for body in BodyKind::ALL {
            let pointer = format!("/bodies/{}/unknowns", body.name());
            let of_body = value.pointer(&pointer).and_then(Value::as_u64).filter(|n| *n > 0);
            unknowns = of_body
                .and_then(|n| unknowns.checked_add(n))
                .ok_or_else(|| nonsense(path, None, format!("has no number at {pointer}")))?;
        }
        Ok(Self { unknowns })
    }
}

/// Whether two sizes mean one mesh; NaN stands for "no column".
fn same_mesh(a: f64, b: f64) -> bool {
    a == b || (a.is_nan() && b.is_nan())
}

/// An error about the content of a file that the finite-element side wrote.
pub(super) fn nonsense(path: &Path, line: Option<usize>, message: impl Into<String>) -> Error {
    Error::File {
        path: path.to_path_buf(),
        line,
        message: message.into(),
        remedy: "the file was damaged or not written by this version; remove it and run FEM again"
            .into(),
    }
}

/// A CSV text with the columns that are wanted, wherever they stand.
struct Csv<'t> {
    path: &'t Path,
    reader: csv::Reader<&'t [u8]>,
    /// Where each wanted column stands.
    columns: Vec<usize>,
    /// Where the column `mesh` stands.
    mesh: Option<usize>,
}

impl<'t> Csv<'t> {
    fn parse(text: &'t str, path: &'t Path, wanted: &[&str]) -> Result<Self> {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let header = reader.headers().map_err(|e| nonsense(path, Some(1), csv_fault(&e)))?.clone();
        let find = |name: &str| header.iter().position(|h| h == name);
        let columns = wanted
            .iter()
            .map(|name| {
                find(name).ok_or_else(|| nonsense(path, Some(1), format!("has no column {name}")))
            })
            .collect::<Result<_>>()?;
        Ok(Self { path, columns, mesh: find("mesh"), reader })
    }

    fn rows(self) -> impl Iterator<Item = Result<Row<'t>>> {
        let Csv { path, reader, columns, mesh } = self;
        let columns = std::rc::Rc::new(columns);
        reader.into_records().map(move |record| match record {
            Ok(record) => Ok(Row { path, record, columns: columns.clone(), mesh }),
            Err(e) => {
                let line = e.position().map(|p| p.line() as usize);
                Err(nonsense(path, line, csv_fault(&e)))
            }
        })
    }
}

/// One row of a [`Csv`].
struct Row<'t> {
    path: &'t Path,
    record: csv::StringRecord,
    columns: std::rc::Rc<Vec<usize>>,
    mesh: Option<usize>,
}

impl Row<'_> {
    fn text(&self, column: usize) -> &str {
        // The reader refuses rows of another width than the header.
        &self.record[self.columns[column]]
    }

    fn number(&self, column: usize) -> Result<f64> {
        self.finite(self.text(column))
    }

    fn mesh(&self) -> Result<f64> {
        self.mesh.map_or(Ok(f64::NAN), |column| self.finite(&self.record[column]))
    }

    fn one_of(&self, column: usize, names: &[&'static str]) -> Result<&'static str> {
        let text = self.text(column);
        names
            .iter()
            .copied()
            .find(|name| *name == text)
            .ok_or_else(|| self.nonsense(format!("'{text}' is none of {}", names.join(", "))))
    }

    fn finite(&self, text: &str) -> Result<f64> {
        match text.trim().parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(self.nonsense(format!("'{text}' is not a finite number"))),
        }
    }

    fn nonsense(&self, message: String) -> Error {
        nonsense(self.path, self.record.position().map(|p| p.line() as usize), message)
    }
}
