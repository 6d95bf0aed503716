//! The files of a designed profile: the case with it, tables of loads, trials and lines through the
//! optimum, pictures, and `summary.json`.

use super::columns::{Columns, Value};
use super::draw::{Colour, Figure, INK, Look, Marker, Panel, Rule, Series};
use super::study_files::pretty;
use crate::base::number::significant;
use crate::case::{Case, Design, Objective, Parameter};
use crate::study::optimum::{LoadResult, Optimum, Settings};
use serde_json::{Map, Value as Json, json};

const MM: f64 = 1e3;
const MPA: f64 = 1e-6;
const UM: f64 = 1e6;

/// Name of the case with the best profile, and of its file.
pub const CASE_FILE: &str = "case.toml";

/// Points of the profile's line.
const PROFILE_POINTS: usize = 201;

/// Largest number of loads with a pressure line of their own in the picture.
const MOST_LINES: usize = 6;

/// The files by name, `summary.json` last.
pub fn contents(
    design: &Design,
    settings: &Settings,
    found: &Optimum,
    case: &Case,
) -> Vec<(String, Vec<u8>)> {
    let mut files = vec![(CASE_FILE.to_string(), case.to_toml().into_bytes())];
    for table in [loads(found), history(design, found), scans(design, found)] {
        files.push((format!("{}.csv", table.name), table.to_csv().into_bytes()));
    }
    for (name, figure) in
        [("parameters", parameters(design, found)), ("loads", pressures(design, found, case))]
    {
        let picture = figure.draw();
        files.push((format!("plot-{name}.svg"), picture.to_svg().into_bytes()));
        files.push((format!("plot-{name}.png"), picture.to_png()));
    }
    files.push(("summary.json".into(), pretty(&summary(design, settings, found)).into_bytes()));
    files
}

/// The results in numbers.
pub fn summary(design: &Design, settings: &Settings, found: &Optimum) -> Json {
    let values: Map<String, Json> = design
        .parameters
        .iter()
        .zip(&found.values)
        .map(|(p, v)| (p.name.into(), json!(v)))
        .collect();
    let largest = |all: &[Option<f64>]| {
        all.iter()
            .copied()
            .collect::<Option<Vec<f64>>>()
            .map(|all| all.into_iter().fold(0.0, f64::max))
    };
    json!({
        "case": design.case.name,
        "body": design.body.name(),
        "method": settings.method.name(),
        "objective": design.objective.name(),
        "exclude_c": design.exclude_c,
        "values": values,
        "at_bounds": at_bounds(design, found),
        "objective_pa": found.confirmed_pa,
        "objective_of_search_pa": found.searched_pa,
        "tolerance": found.loads[0].case.accuracy.tolerance,
        "tolerance_of_search": settings.tolerance,
        "own_profile_pa": largest(&found.before),
        "best_of_each_search_pa": searches(found),
        "seed": settings.seed,
        "trials": found.history.len(),
        "solves": found.solves,
        "loads": found.loads.iter().map(|load| json!({
            "force_n": load.case.load.force_n,
            "eccentricity_m": load.case.load.eccentricity_m,
            "tilt_rad": load.case.pose.tilt_rad,
            "objective_pa": value_pa(load, design.objective),
            "warnings": load.summary.warnings(),
        })).collect::<Vec<_>>(),
    })
}

/// Parameters that lie at one of their bounds, within a hundredth of the way between them.
pub fn at_bounds(design: &Design, found: &Optimum) -> Vec<&'static str> {
    let near = |(parameter, value): (&Parameter, &f64)| {
        let at = |part: f64| parameter.at(part);
        (*value <= at(0.01) || *value >= at(0.99)).then_some(parameter.name)
    };
    design.parameters.iter().zip(&found.values).filter_map(near).collect()
}

/// The best objective (Pa) of each search, the first sample before them.
fn searches(found: &Optimum) -> Vec<Option<f64>> {
    let last = found.history.iter().map(|trial| trial.search).max().unwrap_or(0);
    let best = |search: usize| {
        let own = found.history.iter().filter(|trial| trial.search == search);
        own.filter_map(|trial| trial.objective_pa).reduce(f64::min)
    };
    (0..=last).map(best).collect()
}

/// The largest value of an objective under a load (Pa).
pub fn value_pa(load: &LoadResult, objective: Objective) -> f64 {
    let own = Objective::ALL.iter().position(|o| *o == objective).expect("one of all");
    load.peaks[own].value * load.hertz.p0_pa
}

/// What each load sees.
fn loads(found: &Optimum) -> Columns {
    let row = |(load, before): (&LoadResult, &Option<f64>)| {
        let (summary, hertz) = (&load.summary, &load.hertz);
        let optional = |value: Option<f64>| value.unwrap_or(f64::NAN);
        let mut row = vec![
            ("force_n", Value::Number(summary.load_n)),
            ("eccentricity_m", Value::Number(optional(load.case.load.eccentricity_m))),
            ("tilt_rad", Value::Number(summary.tilt_rad)),
            ("c_m", Value::Number(hertz.c_m)),
            ("p0_pa", Value::Number(hertz.p0_pa)),
            ("approach_m", Value::Number(summary.approach_m)),
            ("contact_from_m", Value::Number(summary.contact_y_m[0])),
            ("contact_to_m", Value::Number(summary.contact_y_m[1])),
        ]
        .into_iter()
        .map(|(name, value)| (name.to_string(), value))
        .collect::<Vec<_>>();
        for (objective, peak) in Objective::ALL.into_iter().zip(&load.peaks) {
            let name = objective.name();
            let mut put = |column: String, value: Value| row.push((column, value));
            put(format!("{name}_pa"), Value::Number(peak.value * hertz.p0_pa));
            if objective != Objective::Pressure {
                put(format!("{name}_body"), Value::Text(peak.body.name().into()));
            }
            for (axis, v) in ["x", "y", "z"].into_iter().zip(peak.at) {
                if axis == "y" || objective != Objective::Pressure {
                    put(format!("{name}_{axis}_m"), Value::Number(v * hertz.c_m));
                }
            }
        }
        row.push(("own_profile_pa".into(), Value::Number(optional(*before))));
        row
    };
    Columns::of_rows("loads", found.loads.iter().zip(&found.before).map(row))
}

/// All trials.
fn history(design: &Design, found: &Optimum) -> Columns {
    let mut best = f64::INFINITY;
    let row = |(i, trial): (usize, &crate::study::optimum::Trial)| {
        best = trial.objective_pa.map_or(best, |objective| objective.min(best));
        let mut row = vec![
            ("trial".to_string(), Value::Number((i + 1) as f64)),
            ("search".to_string(), Value::Number(trial.search as f64)),
        ];
        let values = design.parameters.iter().zip(&trial.values);
        row.extend(values.map(|(p, v)| (p.name.to_string(), Value::Number(*v))));
        row.push(("loads".into(), Value::Number(trial.loads as f64)));
        row.push(("objective_pa".into(), Value::Number(trial.objective_pa.unwrap_or(f64::NAN))));
        row.push(("best_pa".into(), Value::Number(if best.is_finite() { best } else { f64::NAN })));
        row
    };
    Columns::of_rows("history", found.history.iter().enumerate().map(row))
}

/// The lines through the optimum.
fn scans(design: &Design, found: &Optimum) -> Columns {
    let lines = design.parameters.iter().zip(&found.scans);
    let rows = lines.flat_map(|(parameter, line)| {
        line.iter().map(move |(value, objective_pa)| {
            vec![
                ("parameter".to_string(), Value::Text(parameter.name.into())),
                ("value".to_string(), Value::Number(*value)),
                ("objective_pa".to_string(), Value::Number(*objective_pa)),
            ]
        })
    });
    Columns::of_rows("scans", rows)
}

/// The looks of lines, told apart without colour too.
fn look(i: usize) -> Look {
    let look = |rgb, dash, marker| Look { colour: Colour { name: "", rgb }, dash, marker };
    let all = [
        look([0x00, 0x72, 0xb2], None, Marker::Circle),
        look([0xd5, 0x5e, 0x00], Some((7.0, 3.0)), Marker::Triangle),
        look([0x00, 0x8c, 0x67], Some((2.0, 3.0)), Marker::Square),
        look([0xb0, 0x60, 0x95], Some((9.0, 3.0)), Marker::Cross),
        look([0x7a, 0x5c, 0x00], Some((1.0, 2.0)), Marker::Diamond),
        look([0x44, 0x44, 0x44], Some((4.0, 2.0)), Marker::Circle),
    ];
    all[i % all.len()]
}

/// The look of a profile's line, unlike those of all loads: figures have one legend.
fn profile_look(dash: Option<(f64, f64)>) -> Look {
    Look { colour: INK, dash, marker: Marker::Disc }
}

/// A parameter's name and unit on a plot, and how many of this unit are one of its own; a short
/// length is in µm.
fn written(name: &str, value: f64) -> (String, &'static str, f64) {
    let (name, unit, scale) = match name.rsplit_once('_') {
        Some((name, "m")) if value.abs() < 1e-4 => (name, "µm", UM),
        Some((name, "m")) => (name, "mm", MM),
        Some((name, "n")) => (name, "N", 1.0),
        _ => (name, "", 1.0),
    };
    (name.replace('_', " "), unit, scale)
}

/// The objective over each parameter: the trials, and the line through the optimum; and over the
/// trials.
fn parameters(design: &Design, found: &Optimum) -> Figure {
    let label = format!("largest {} (MPa)", design.objective.label());
    let shown = |objective: f64| objective * MPA;
    // Very bad trials would hide the rest.
    let least = found.searched_pa;
    let worst =
        found.scans.iter().flatten().map(|(_, o)| *o).fold(1.02 * least, f64::max).min(1.5 * least);
    let y_range = Some((shown(least - 0.06 * (worst - least)), shown(worst)));
    let panel = |i: usize| {
        let (parameter, line) = (&design.parameters[i], &found.scans[i]);
        let (name, unit, scale) = written(parameter.name, found.values[i]);
        let tried = found.history.iter().filter_map(|trial| {
            Some((trial.values[i], trial.objective_pa.filter(|o| *o <= worst)?))
        });
        let tried = tried.map(|(v, o)| (scale * v, shown(o))).collect();
        let line = line.iter().filter(|(_, o)| *o <= worst);
        let line = line.map(|(v, o)| (scale * v, shown(*o))).collect();
        let optimum = significant(scale * found.values[i], 4);
        Panel {
            title: format!("optimum at {name} = {optimum} {unit}").trim_end().to_string(),
            x_label: if unit.is_empty() { name } else { format!("{name} ({unit})") },
            y_label: label.clone(),
            series: vec![
                Series::marks("trials", look(5), tried),
                Series { markers: false, ..Series::curve("through the optimum", look(0), line) },
            ],
            rules: vec![Rule::Vertical(scale * found.values[i], String::new())],
            log: (parameter.is_logarithmic(), false),
            y_range,
            ..Panel::default()
        }
    };
    let panels: Vec<Panel> = (0..design.parameters.len()).map(panel).collect();
    let count = panels.len() + 1;
    let mut best = f64::INFINITY;
    let falling = found.history.iter().enumerate().filter_map(|(i, trial)| {
        best = best.min(trial.objective_pa.unwrap_or(f64::INFINITY));
        (best <= worst).then_some(((i + 1) as f64, shown(best)))
    });
    let history = Panel {
        title: "Best so far".into(),
        x_label: "trial".into(),
        y_label: label,
        series: vec![Series { markers: false, ..Series::curve("", look(0), falling.collect()) }],
        y_range,
        ..Panel::default()
    };
    Figure {
        title: format!("{}: design of a profile", design.case.name),
        columns: count.min(2),
        panels: panels.into_iter().chain([history]).collect(),
        panel_size: (430, 300),
    }
}

/// The profile, and the pressure along the contact under each load.
fn pressures(design: &Design, found: &Optimum, case: &Case) -> Figure {
    let profile = |case: &Case, name: &str, own: Look| {
        let profile = case.profile(design.body)?;
        let [from, to] = case.ends_m(design.body);
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let place = |i: usize| 0.9999 * half * (2.0 * i as f64 / (PROFILE_POINTS - 1) as f64 - 1.0);
        let line =
            (0..PROFILE_POINTS).map(place).map(|u| ((middle + u) * MM, profile.drop(u) * UM));
        Some(Series { markers: false, ..Series::curve(name, own, line.collect()) })
    };
    let series = [
        profile(&design.case, "as the case has it", profile_look(Some((1.0, 3.0)))),
        profile(case, "designed", profile_look(None)),
    ];
    let drop = Panel {
        title: "Profile".into(),
        x_label: "y (mm)".into(),
        y_label: "drop (µm)".into(),
        series: series.into_iter().flatten().collect(),
        ..Panel::default()
    };
    let mut heaviest: Vec<&LoadResult> = found.loads.iter().collect();
    heaviest
        .sort_by(|a, b| value_pa(b, design.objective).total_cmp(&value_pa(a, design.objective)));
    let lines = heaviest.iter().take(MOST_LINES).enumerate().map(|(i, load)| {
        let beside = match (load.case.load.eccentricity_m, load.case.pose.tilt_rad) {
            (Some(e), _) if e != 0.0 => format!(", {} mm beside", significant(e * MM, 3)),
            (_, Some(tilt)) if tilt != 0.0 => format!(", {} mrad", significant(tilt * 1e3, 3)),
            _ => String::new(),
        };
        let line =
            load.line.iter().map(|[y, p]| (y * load.hertz.c_m * MM, p * load.hertz.p0_pa * MPA));
        let name = format!("{} N{beside}", significant(load.case.load.force_n, 4));
        Series { markers: false, ..Series::curve(&name, look(i), line.collect()) }
    });
    let pressure = Panel {
        title: "Pressure along the contact, x = 0".into(),
        x_label: "y (mm)".into(),
        y_label: "p (MPa)".into(),
        series: lines.collect(),
        ..Panel::default()
    };
    Figure {
        title: format!("{}: the designed profile", design.case.name),
        columns: 2,
        panels: vec![drop, pressure],
        panel_size: (470, 330),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_of_plots_are_in_mm_or_in_um() {
        let said = |name, value| {
            let (name, unit, scale) = written(name, value);
            format!("{name} {} {unit}", significant(scale * value, 3))
        };
        assert_eq!(said("radius_m", 0.25), "radius 250 mm");
        assert_eq!(said("amplitude_m", 2e-6), "amplitude 2 µm");
        assert_eq!(said("design_force_n", 5.0), "design force 5 N");
        assert_eq!(said("k2", 0.5), "k2 0.5 ");
    }

    #[test]
    fn no_load_looks_like_a_profile() {
        let profiles = [profile_look(None), profile_look(Some((1.0, 3.0)))];
        assert!((0..MOST_LINES).all(|i| !profiles.contains(&look(i))));
        assert!((0..MOST_LINES).all(|i| look(i).colour != INK && profiles[0] != profiles[1]));
    }
}
