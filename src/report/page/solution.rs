//! The pictures of one solution, and a page about it for a report.

use super::render::fill;
use crate::base::number::{duration, significant, with_minus_signs};
use crate::base::{BodyKind, Result};
use crate::case::{Case, Draft, FLAGS, Form, KEYS, Key};
use crate::report::plots;
use crate::report::solution::unbounded;
use crate::solve::{CellDetails, Solution, Summary};
use minijinja::context;

const NAME: &str = "solution.html";
const PAGE: &str = include_str!("solution.html");

/// What holds for every solution.
const NOTES: [&str; 4] = [
    "Lengths are in mm from the middle of the roller: x across the contact, y along it, z into the body at \
     hand. Tension is positive, and pressure where the bodies press each other.",
    "C and p0 are the half-width and the largest pressure of Hertz's contact of endless bodies under the same \
     load per length of the shorter body.",
    "At the edge of a body on a longer one the elastic stress has no bound. Values nearer to it than 0.1 C are \
     drawn but not counted as largest.",
    "The contact is elastic. Compare the largest stress with the yield strength of the material \
     before the numbers are used.",
];

/// How a case was solved: what is written on pictures and page.
#[derive(Debug, Clone)]
pub struct Label {
    /// The model, and the engine if it is not the usual one.
    pub by: String,
    /// The program and its version.
    pub program: String,
    /// When; left out if empty.
    pub date: String,
    /// How it was solved on cells, which take a residual in place of the case's tolerance.
    pub cells: Option<CellDetails>,
}

/// The pictures of `solution`, `plot-<name>.svg` and `.png`, and `summary.html`, which shows them
/// beside the case and the results.
///
/// # Errors
/// [`crate::base::Error::File`] when the page cannot be made.
pub fn of_solution<D>(
    case: &Case,
    label: &Label,
    solution: &Solution<D>,
) -> Result<Vec<(String, Vec<u8>)>> {
    let (mut files, mut pictures) = (Vec::new(), Vec::new());
    for (name, figure) in
        plots::of_solution(case, &format!("{}, {}", label.by, label.program), solution)
    {
        let picture = figure.draw();
        let svg = picture.to_svg();
        files.push((format!("plot-{name}.png"), picture.to_png()));
        files.push((format!("plot-{name}.svg"), svg.clone().into_bytes()));
        pictures.push(svg);
    }
    let data = context! {
        case => case.name, by => label.by, program => label.program, date => label.date,
        results => results(case, label, &solution.summary), inputs => inputs(case, label), notes => NOTES, pictures,
    };
    files.push(("summary.html".into(), fill(NAME, PAGE, data)?.into_bytes()));
    Ok(files)
}

/// A number with its unit.
fn with_unit(value: f64, unit: &str) -> String {
    format!("{} {unit}", with_minus_signs(&significant(value, 5))).trim_end().to_string()
}

/// The units of keys in words, which stand behind the numbers.
const UNITS: [&str; 5] = [", in metres", " in metres", " in pascals", " in newtons", " in radians"];

/// The numbers and the kinds of profiles of a case, as its file has them, without a tolerance that
/// had no part.
fn inputs(case: &Case, label: &Label) -> Vec<[String; 2]> {
    let draft = Draft::of(case, Form::Load);
    let number = |key: &Key| {
        let value = key.get(&draft)?;
        let (unit, scale) = match key.leaf().rsplit_once('_') {
            Some((_, "m")) => ("mm", 1e3),
            Some(("young", "pa")) => ("GPa", 1e-9),
            Some((_, "pa")) => ("MPa", 1e-6),
            Some((_, "n")) => ("N", 1.0),
            Some((_, "rad")) => ("mrad", 1e3),
            _ => ("", 1.0),
        };
        let what = UNITS.iter().fold(capital(key.what), |what, unit| what.replace(unit, ""));
        Some([format!("{what} ({})", key.table()), with_unit(scale * value, unit)])
    };
    let profile = |body: BodyKind| {
        let profile = match body {
            BodyKind::Block => &case.block.profile,
            BodyKind::Roller => &case.roller.profile,
        };
        Some([format!("Profile ({})", body.name()), profile.as_ref()?.kind.name().to_string()])
    };
    let factors = case.factors();
    let factors =
        [("W", factors.load), ("S_l", factors.slenderness), ("L_r", factors.length_ratio)]
            .map(|(name, value)| [name.to_string(), with_unit(value, "")]);
    let unused = |key: &&Key| label.cells.is_some() && key.path == "accuracy.tolerance";
    let numbers = KEYS.iter().filter(|key| !unused(key)).filter_map(number);
    let flags = FLAGS
        .iter()
        .filter(|flag| flag.get(case))
        .map(|flag| [format!("{} ({})", capital(flag.what), flag.table()), "taken in".to_string()]);
    let heights = case.surface.as_ref().map(|surface| {
        let name = surface.heights.file_name().unwrap_or_default();
        ["Heights (surface)".to_string(), name.to_string_lossy().into_owned()]
    });
    numbers
        .chain(flags)
        .chain(heights)
        .chain(BodyKind::ALL.into_iter().filter_map(profile))
        .chain(factors)
        .collect()
}

/// Least tilt (rad) that is shown.
const LEAST_TILT: f64 = 1e-8;

/// "the load in newtons," as "Load in newtons".
fn capital(what: &str) -> String {
    let what = what.trim_start_matches("the ").trim_end_matches(',');
    let mut letters = what.chars();
    // A letter alone is a quantity.
    if letters.clone().nth(1) == Some(' ') {
        return what.into();
    }
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The results in numbers.
fn results<D>(case: &Case, label: &Label, found: &Summary<D>) -> Vec<[String; 2]> {
    let hertz = &found.hertz;
    let mm = |v: f64| with_unit(1e3 * v, "mm");
    let pressure =
        |v: f64| format!("{} ({})", with_unit(1e-6 * v, "MPa"), with_unit(v / hertz.p0_pa, "p0"));
    let place = |at_m: &[f64]| {
        let numbers: Vec<String> = at_m.iter().map(|v| with_unit(1e3 * v, "")).collect();
        format!("{} mm", numbers.join(", "))
    };
    let mut rows = vec![
        ("C, p0", format!("{}, {}", mm(hertz.c_m), with_unit(1e-6 * hertz.p0_pa, "MPa"))),
        ("Contact modulus E*", with_unit(1e-9 * hertz.e_star_pa, "GPa")),
        ("Pressure in the middle", pressure(found.p_centre_pa)),
        ("Largest mean pressure of a cell", pressure(found.p_max_pa)),
        ("… at x, y", place(&found.p_max_at_m)),
    ];
    if let Some(note) = unbounded(case, found) {
        rows.push(("… near", note.to_string()));
    }
    if let Some(critical) = &found.critical {
        rows.push(("Largest von Mises stress", pressure(critical.value_pa)));
        rows.push(("… in", critical.body.name().to_string()));
        rows.push(("… at x, y, z", place(&critical.at_m)));
    }
    rows.push(("Contact along y, from and to", place(&found.contact_y_m)));
    rows.push(("Approach of the bodies", with_unit(1e6 * found.approach_m, "µm")));
    // Of heights that are not symmetric a held tilt of zero has rounding alone.
    if found.tilt_rad.abs() > LEAST_TILT {
        rows.push(("Tilt", with_unit(1e3 * found.tilt_rad, "mrad")));
    }
    if found.centre_of_pressure_m[1] != 0.0 {
        rows.push(("Line of action at y", mm(found.centre_of_pressure_m[1])));
    }
    if let Some(cells) = label.cells.as_ref().filter(|_| case.surface.is_some()) {
        let area = with_unit(1e6 * cells.contact_area_m2, "mm²");
        rows.push(("Real contact area", area));
        rows.push(("Mean gap within C of the line x = 0", with_unit(1e6 * cells.mean_gap_m, "µm")));
    }
    rows.push(match &label.cells {
        Some(cells) => ("Relative residual asked for", with_unit(cells.tolerance, "")),
        None => ("Tolerance", with_unit(case.accuracy.tolerance, "p0")),
    });
    rows.push(("Load is met to", format!("{:.0e}", found.load_error_rel)));
    rows.push(("Run time", duration(found.seconds.total)));
    rows.into_iter().map(|(name, value)| [name.to_string(), value]).collect()
}
