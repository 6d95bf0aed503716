//! The files of one solution: `summary.json`, `pressure.csv`, `curves.csv` and `points.csv`.

use super::study_files::pretty;
use crate::base::{Result, StressTensor};
use crate::host::write_set;
use crate::solve::{Options, Solution};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::Path;

/// The summary of a solution, as `summary.json` and `--json` show it.
pub fn summary(solution: &Solution) -> Value {
    json!({
        "case": solution.case,
        "method": solution.method,
        "hertz": solution.hertz,
        "load_n": solution.load_n,
        "approach_m": solution.approach_m,
        "p_centre_pa": solution.p_centre_pa,
        "p_max_pa": solution.p_max_pa,
        "p_max_at_m": solution.p_max_at_m,
        "converged": solution.converged,
        "iterations": solution.iterations,
        "load_error_rel": solution.load_error_rel,
        "seconds": solution.seconds,
        "critical": solution.critical,
        "details": solution.details,
    })
}

/// Writes the files of `solution` into `folder`: `more` by their names, `points.csv` if `options` asked
/// for points, and `summary.json` last, so that its presence means that all are there.
///
/// # Errors
/// [`crate::base::Error::Io`] when a file cannot be written.
pub fn write(
    solution: &Solution,
    options: &Options,
    more: Vec<(String, Vec<u8>)>,
    folder: &Path,
) -> Result<()> {
    let mut files = more;
    let mut put = |name: &str, text: String| files.push((name.to_string(), text.into_bytes()));
    put("pressure.csv", pressure_csv(solution));
    put("curves.csv", curves_csv(solution));
    if !options.points.is_empty() {
        put("points.csv", points_csv(solution, options));
    }
    put("summary.json", pretty(&summary(solution)));
    write_set(folder, &files)
}

/// The contact pressure, one row a cell.
fn pressure_csv(solution: &Solution) -> String {
    let mut text = String::from("x_m,y_m,dx_m,dy_m,p_pa\n");
    for cell in &solution.cells {
        row(&mut text, "", &[cell.x_m, cell.y_m, cell.dx_m, cell.dy_m, cell.p_pa]);
    }
    text
}

/// The standard curves, one row a point.
fn curves_csv(solution: &Solution) -> String {
    let mut text = format!("body,curve,{}\n", stress_columns());
    for curve in &solution.curves {
        let place = format!("{},{},", curve.body.name(), curve.name);
        for (at, stress) in curve.at_m.iter().zip(&curve.stress_pa) {
            row(&mut text, &place, &with_stress(at, stress));
        }
    }
    text
}

/// The points that were asked for, in their order.
fn points_csv(solution: &Solution, options: &Options) -> String {
    let mut text = format!("body,{}\n", stress_columns());
    for (point, stress) in options.points.iter().zip(&solution.points) {
        let place = format!("{},", point.body.name());
        row(&mut text, &place, &with_stress(&point.at_m, stress));
    }
    text
}

/// Names of the columns of a point and its stresses.
fn stress_columns() -> String {
    let components = StressTensor::NAMES.map(|name| format!("{name}_pa")).join(",");
    format!("x_m,y_m,z_m,{components},von_mises_pa,tau_max_pa")
}

fn with_stress(at: &[f64; 3], stress: &StressTensor) -> Vec<f64> {
    let mut values = at.to_vec();
    values.extend(stress.components());
    values.extend([stress.von_mises(), stress.tau_max()]);
    values
}

/// Appends a row; the numbers have as many digits as it takes to read them back exactly.
fn row(text: &mut String, place: &str, values: &[f64]) {
    text.push_str(place);
    for (i, value) in values.iter().enumerate() {
        let comma = if i == 0 { "" } else { "," };
        // Many stresses vanish by symmetry.
        let written = match value {
            0.0 => write!(text, "{comma}0"),
            _ => write!(text, "{comma}{value:e}"),
        };
        written.expect("a string grows");
    }
    text.push('\n');
}
