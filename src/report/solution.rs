//! The files of one solution, in SI units: `summary.json`, `pressure.csv`, `curves.csv` and `points.csv`.

use super::study_files::pretty;
use crate::base::{HertzScales, Result, StressTensor};
use crate::host::write_set;
use crate::solve::{Options, Solution};
use std::fmt::Write;
use std::path::Path;

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
    put("summary.json", pretty(&solution.summary));
    write_set(folder, &files)
}

/// The contact pressure, one row a cell.
fn pressure_csv(solution: &Solution) -> String {
    let HertzScales { c_m, p0_pa, .. } = solution.curves.hertz;
    let mut text = String::from("x_m,y_m,dx_m,dy_m,p_pa\n");
    for cell in &solution.cells {
        let [x_m, y_m, dx_m, dy_m] = [cell.x, cell.y, cell.dx, cell.dy].map(|v| v * c_m);
        row(&mut text, "", &[x_m, y_m, dx_m, dy_m, cell.p * p0_pa]);
    }
    text
}

/// The standard curves, one row a point.
fn curves_csv(solution: &Solution) -> String {
    let HertzScales { c_m, p0_pa, .. } = solution.curves.hertz;
    let mut text = format!("body,curve,{}\n", stress_columns());
    for curve in &solution.curves.stress {
        let place = format!("{},{},", curve.body.name(), curve.name);
        for (at, stress) in curve.at.iter().zip(&curve.stress) {
            row(&mut text, &place, &with_stress(at.map(|v| v * c_m), *stress * p0_pa));
        }
    }
    text
}

/// The points that were asked for, in their order.
fn points_csv(solution: &Solution, options: &Options) -> String {
    let mut text = format!("body,{}\n", stress_columns());
    for (point, stress) in options.points.iter().zip(&solution.points) {
        let place = format!("{},", point.body.name());
        row(&mut text, &place, &with_stress(point.at_m, *stress * solution.curves.hertz.p0_pa));
    }
    text
}

/// Names of the columns of a point and its stresses.
fn stress_columns() -> String {
    let components = StressTensor::NAMES.map(|name| format!("{name}_pa")).join(",");
    format!("x_m,y_m,z_m,{components},von_mises_pa,tau_max_pa")
}

fn with_stress(at_m: [f64; 3], stress_pa: StressTensor) -> Vec<f64> {
    let mut values = at_m.to_vec();
    values.extend(stress_pa.components());
    values.extend([stress_pa.von_mises(), stress_pa.tau_max()]);
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
