//! The tables and files of one solution, in SI units: `summary.json`, `pressure.csv`,
//! `line_load.csv`, `curves.csv` and `points.csv`.

use super::columns::{Columns, Values};
use super::study_files::pretty;
use crate::base::number::stated;
use crate::base::{HertzScales, Result, StressTensor};
use crate::body::Resolution;
use crate::case::Case;
use crate::host::{Lock, remove_marker, replace_set};
use crate::solve::{Lamina, Options, Scene, Solution, Summary};
use serde::Serialize;
use std::path::Path;

/// Most cells that are written as text: more of them have a file of their own, see
/// [`super::cells`].
const MOST_CELLS: usize = 100_000;

/// A contact's end that differs from that of the overlap by less than this part of its length
/// reaches it.
const ROUNDING: f64 = 1e-9;

/// Writes the files of `solution` into `folder`: `more` by their names, each of its [`tables`] as
/// CSV but for pressures on very many cells, and `summary.json` last, so that its presence means
/// that all are there. Returns their names, `summary.json` first and `more` last.
///
/// # Errors
/// [`crate::base::Error::Io`] when a file cannot be written.
pub fn write<D: Serialize>(
    solution: &Solution<D>,
    options: &Options,
    more: Vec<(String, Vec<u8>)>,
    folder: &Path,
) -> Result<Vec<String>> {
    let further: Vec<String> = more.iter().map(|(name, _)| name.clone()).collect();
    let mut files = more;
    let mut put = |name: String, text: String| files.push((name, text.into_bytes()));
    for table in tables(solution, options) {
        if table.name == "pressure" && solution.cells.len() > MOST_CELLS {
            continue;
        }
        put(format!("{}.csv", table.name), table.to_csv());
    }
    put("summary.json".into(), pretty(&solution.summary));
    // Curves and pressures of finite elements there are no longer those that it marks as complete.
    remove_marker(folder, "fem.json")?;
    replace_set(folder, &files)?;
    let own = files.into_iter().skip(further.len()).map(|(name, _)| name);
    let mut names: Vec<String> = own.collect();
    names.rotate_right(1);
    Ok([names, further].concat())
}

/// As [`write()`], into a folder that is locked meanwhile, and made if it is not there.
///
/// # Errors
/// As [`write()`]; [`crate::base::Error::Busy`] when another run has the folder.
pub fn write_locked<D: Serialize>(
    solution: &Solution<D>,
    options: &Options,
    more: Vec<(String, Vec<u8>)>,
    folder: &Path,
) -> Result<()> {
    let _lock = Lock::claim(folder)?;
    write(solution, options, more, folder).map(|_| ())
}

/// What to know of the largest pressure of a contact that reaches a singular end, where the
/// pressure has no bound; nothing elsewhere.
pub fn unbounded<D>(case: &Case, found: &Summary<D>) -> Option<&'static str> {
    let ends = case.overlap_m();
    let exponents = Scene::new(case, found.method, None).corner_exponents();
    let reaches =
        |side: usize| (found.contact_y_m[side] - ends[side]).abs() < ROUNDING * (ends[1] - ends[0]);
    (0..2)
        .any(|side| exponents[side].is_some() && reaches(side))
        .then_some("a singular end: it grows with the resolution")
}

/// What to know of a case that asks for more than the finest resolution of the engine along a line.
pub fn too_fine(case: &Case) -> Option<String> {
    let (asked, finest) = (case.accuracy.tolerance, Resolution::FINEST);
    let note = || {
        format!(
            "the finest resolution is that of a tolerance of {}, which {} takes, too",
            stated(finest),
            stated(asked)
        )
    };
    (asked < finest).then(note)
}

/// All tables of `solution`: `pressure`, `line_load`, `curves` and, if `options` asked for points,
/// `points`.
pub fn tables<D>(solution: &Solution<D>, options: &Options) -> Vec<Columns> {
    let mut tables = vec![pressure(solution), line_load(solution), curves(solution)];
    if !options.points.is_empty() {
        tables.push(points(solution, options));
    }
    tables
}

/// The contact pressure: by the line engine over cells across the contact at each node along it,
/// whose `dy_m` is its weight.
fn pressure<D>(solution: &Solution<D>) -> Columns {
    let HertzScales { c_m, p0_pa, .. } = solution.curves.hertz;
    let rows = solution.cells.iter().map(|cell| {
        let [x_m, y_m, dx_m, dy_m] = [cell.x, cell.y, cell.dx, cell.dy].map(|v| v * c_m);
        [x_m, y_m, dx_m, dy_m, cell.p * p0_pa]
    });
    let columns = numbers(["x_m", "y_m", "dx_m", "dy_m", "p_pa"].map(String::from), rows);
    Columns { name: "pressure", columns }
}

/// The load per length and the half-width along the contact.
fn line_load<D>(solution: &Solution<D>) -> Columns {
    let HertzScales { c_m, p0_pa, .. } = solution.curves.hertz;
    let rows = solution
        .line_loads
        .iter()
        .map(|line| [line.y * c_m, line.load * c_m * p0_pa, line.half_width * c_m]);
    let names = ["y_m", "line_load_n_per_m", "half_width_m"];
    Columns { name: "line_load", columns: numbers(names.map(String::from), rows) }
}

/// The standard curves, one row a point.
fn curves<D>(solution: &Solution<D>) -> Columns {
    let HertzScales { c_m, p0_pa, .. } = solution.curves.hertz;
    let (mut bodies, mut names, mut rows) = (Vec::new(), Vec::new(), Vec::new());
    for curve in &solution.curves.stress {
        for (at, stress) in curve.at.iter().zip(&curve.stress) {
            bodies.push(curve.body.name().to_string());
            names.push(curve.name.clone());
            rows.push(with_stress(at.map(|v| v * c_m), *stress * p0_pa));
        }
    }
    let mut columns =
        vec![("body".into(), Values::Texts(bodies)), ("curve".into(), Values::Texts(names))];
    columns.extend(numbers(stress_columns(), rows));
    Columns { name: "curves", columns }
}

/// The requested points, in their order.
fn points<D>(solution: &Solution<D>, options: &Options) -> Columns {
    let bodies = options.points.iter().map(|point| point.body.name().to_string()).collect();
    let rows = options.points.iter().zip(&solution.points);
    let rows = rows.map(|(p, stress)| with_stress(p.at_m, *stress * solution.curves.hertz.p0_pa));
    let mut columns = vec![("body".into(), Values::Texts(bodies))];
    columns.extend(numbers(stress_columns(), rows));
    Columns { name: "points", columns }
}

/// The slices of a contact beside those of ISO/TS 16281, in SI units.
pub fn laminae(all: &[Lamina]) -> Columns {
    let names = [
        "y_m",
        "width_m",
        "load_n",
        "line_load_n_per_m",
        "p_pa",
        "iso_load_n",
        "iso_line_load_n_per_m",
        "iso_p_pa",
        "iso_edge_factor",
    ];
    let rows = all.iter().map(|lamina| {
        let Lamina { y_m, width_m, load_n, standard_load_n, p_pa, standard_p_pa, edge_factor } =
            *lamina;
        let [line, iso_line] = [load_n, standard_load_n].map(|load| load / width_m);
        [y_m, width_m, load_n, line, p_pa, standard_load_n, iso_line, standard_p_pa, edge_factor]
    });
    Columns { name: "laminae", columns: numbers(names.map(String::from), rows) }
}

/// Columns of numbers from their rows.
fn numbers<const N: usize>(
    names: [String; N],
    rows: impl IntoIterator<Item = [f64; N]>,
) -> Vec<(String, Values)> {
    let mut columns = names.map(|name| (name, Vec::new()));
    for row in rows {
        columns.iter_mut().zip(row).for_each(|((_, column), value)| column.push(value));
    }
    columns.into_iter().map(|(name, column)| (name, Values::Numbers(column))).collect()
}

/// Names of the columns of a point and its stresses.
fn stress_columns() -> [String; 11] {
    let [xx, yy, zz, xy, xz, yz] = StressTensor::NAMES.map(|name| format!("{name}_pa"));
    let [x, y, z, mises, tau] =
        ["x_m", "y_m", "z_m", "von_mises_pa", "tau_max_pa"].map(String::from);
    [x, y, z, xx, yy, zz, xy, xz, yz, mises, tau]
}

fn with_stress([x, y, z]: [f64; 3], stress_pa: StressTensor) -> [f64; 11] {
    let [xx, yy, zz, xy, xz, yz] = stress_pa.components();
    [x, y, z, xx, yy, zz, xy, xz, yz, stress_pa.von_mises(), stress_pa.tau_max()]
}
