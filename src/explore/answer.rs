//! A solution as JSON for the page, in SI units: what `edgeline solve` writes into its files.

use crate::base::stop::go_on;
use crate::base::{BodyKind, PerBody, Result};
use crate::body::EdgeModel;
use crate::case::{Case, Draft, FLAGS, Form, KEYS};
use crate::report::solution::too_fine;
use crate::solve::{Options, Scene, Solution, SolvedCase, Summary};
use crate::stress::{Quantity, StressCurve};
use serde::Serialize;
use std::collections::BTreeMap;

/// The curves in the planes of symmetry along the contact and into the bodies, which suffice while
/// a slider moves.
const FEW: [&str; 6] =
    ["surface-along-y", "along-y-0.5C", "along-y-0.78C", "depth-centre", "depth-0.9", "depth-end"];

/// Points of a profile's line.
const PROFILE_POINTS: usize = 81;

/// A case and its solution. Fields of the drawing have seven digits, which is more than a screen
/// shows.
#[derive(Serialize)]
struct Answer {
    case: CaseAnswer,
    summary: Summary,
    /// What the command line notes about the case, and warns of.
    notes: Vec<String>,
    /// Pressure on the two standard lines, by their names.
    pressure: BTreeMap<String, Line>,
    /// Mean pressures of the cells, row by row along the contact.
    map: Map,
    line_load: LineLoads,
    /// By body and name.
    curves: PerBody<BTreeMap<String, Curve>>,
}

/// A case as the page's fields show it.
#[derive(Serialize)]
struct CaseAnswer {
    name: String,
    /// Numbers by the paths of their keys, in both ways to give the load and the lengths.
    load: BTreeMap<&'static str, Option<f64>>,
    factors: BTreeMap<&'static str, Option<f64>>,
    /// What is on or off, by path.
    flags: BTreeMap<&'static str, bool>,
    profiles: PerBody<Option<ProfileAnswer>>,
    /// The bodies' ends along y (m).
    ends_m: PerBody<[f64; 2]>,
    /// Whether curves along y stand for both halves of the contact.
    symmetric: bool,
}

/// A body's profile.
#[derive(Serialize)]
struct ProfileAnswer {
    kind: &'static str,
    /// The file of a table.
    file: Option<String>,
    y_m: Vec<f32>,
    drop_m: Vec<f32>,
}

#[derive(Serialize)]
struct Line {
    /// The running coordinate (m).
    at_m: Vec<f32>,
    p_pa: Vec<f32>,
}

#[derive(Serialize)]
struct Map {
    /// Width of the cells (m); the first of a row lies in the middle, and the row is its own mirror
    /// image.
    dx_m: f64,
    y_m: Vec<f32>,
    dy_m: Vec<f32>,
    /// A row for each y, from the middle outwards.
    p_pa: Vec<Vec<f32>>,
}

#[derive(Serialize)]
struct LineLoads {
    y_m: Vec<f32>,
    line_load_n_per_m: Vec<f32>,
    half_width_m: Vec<f32>,
}

#[derive(Serialize)]
struct Curve {
    /// The running coordinate.
    axis: &'static str,
    at_m: Vec<f32>,
    /// The point at the start of the curve (m).
    from_m: [f32; 3],
    /// By the names of [`Quantity`].
    stress_pa: BTreeMap<&'static str, Vec<f32>>,
}

/// Solves `case` and writes the answer. With a tolerance `coarser`, the case's own is at least
/// that, and there are only the curves of [`FEW`].
///
/// # Errors
/// As [`SolvedCase::new`].
pub fn solved(case: &Case, method: EdgeModel, coarser: Option<f64>) -> Result<Vec<u8>> {
    let mut options = Options::new(method);
    let mut roughly = case.clone();
    if let Some(least) = coarser {
        options.curves.retain(|name| FEW.contains(&name.as_str()));
        roughly.accuracy.tolerance = case.accuracy.tolerance.max(least);
    }
    let solved = SolvedCase::new(&roughly, &options)?;
    go_on()?;
    let found = solved.solution();
    let answer = Answer {
        case: case_answer(case),
        notes: too_fine(&roughly).into_iter().chain(found.summary.warnings()).collect(),
        pressure: pressure(&found),
        map: map(&found),
        line_load: line_load(&found),
        curves: PerBody {
            block: curves(&found, BodyKind::Block),
            roller: curves(&found, BodyKind::Roller),
        },
        summary: found.summary,
    };
    Ok(serde_json::to_vec(&answer).expect("numbers and texts are JSON"))
}

/// A case alone, for the page's fields.
pub fn described(case: &Case) -> serde_json::Value {
    serde_json::to_value(case_answer(case)).expect("numbers and texts are JSON")
}

fn case_answer(case: &Case) -> CaseAnswer {
    let values = |form: Form| {
        let draft = Draft::of(case, form);
        KEYS.iter().filter(|key| key.is_of(form)).map(|key| (key.path, key.get(&draft))).collect()
    };
    let profile = |body: BodyKind| {
        let (spec, profile) = (case.profile_spec(body)?, case.profile(body)?);
        let [from, to] = case.ends_m(body);
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let share = |i: usize| 2.0 * i as f64 / (PROFILE_POINTS - 1) as f64 - 1.0;
        // A Lundberg profile has no drop at the very end.
        let places = (0..PROFILE_POINTS).map(|i| 0.9999 * half * share(i));
        let (y, drop): (Vec<f64>, Vec<f64>) = places.map(|u| (middle + u, profile.drop(u))).unzip();
        Some(ProfileAnswer {
            kind: spec.kind.name(),
            file: spec.file.as_ref().map(|file| file.display().to_string()),
            y_m: short(y),
            drop_m: short(drop),
        })
    };
    let per_body = |body| case.ends_m(body);
    CaseAnswer {
        name: case.name.clone(),
        load: values(Form::Load),
        factors: values(Form::Factors),
        flags: FLAGS.iter().map(|flag| (flag.path, flag.get(case))).collect(),
        profiles: PerBody { block: profile(BodyKind::Block), roller: profile(BodyKind::Roller) },
        ends_m: PerBody { block: per_body(BodyKind::Block), roller: per_body(BodyKind::Roller) },
        symmetric: Scene::new(case, EdgeModel::HalfSpace, None).is_symmetric(),
    }
}

/// Numbers for a drawing.
fn short(values: impl IntoIterator<Item = f64>) -> Vec<f32> {
    values.into_iter().map(|v| v as f32).collect()
}

fn pressure(found: &Solution) -> BTreeMap<String, Line> {
    let hertz = &found.curves.hertz;
    let lines = found.curves.pressure.iter().map(|line| {
        let axis = usize::from(line.name == "along-y");
        let at_m = short(line.at.iter().map(|at| at[axis] * hertz.c_m));
        (line.name.clone(), Line { at_m, p_pa: short(line.p.iter().map(|p| p * hertz.p0_pa)) })
    });
    lines.collect()
}

fn map(found: &Solution) -> Map {
    let hertz = &found.curves.hertz;
    let mut map = Map { dx_m: 0.0, y_m: Vec::new(), dy_m: Vec::new(), p_pa: Vec::new() };
    for row in found.cells.chunk_by(|a, b| a.y == b.y) {
        map.dx_m = row[0].dx * hertz.c_m;
        map.y_m.push((row[0].y * hertz.c_m) as f32);
        map.dy_m.push((row[0].dy * hertz.c_m) as f32);
        // The rows are symmetric and have an odd number of cells.
        map.p_pa.push(short(row[row.len() / 2..].iter().map(|cell| cell.p * hertz.p0_pa)));
    }
    map
}

fn line_load(found: &Solution) -> LineLoads {
    let hertz = &found.curves.hertz;
    let lines = || found.line_loads.iter();
    LineLoads {
        y_m: short(lines().map(|line| line.y * hertz.c_m)),
        line_load_n_per_m: short(lines().map(|line| line.load * hertz.c_m * hertz.p0_pa)),
        half_width_m: short(lines().map(|line| line.half_width * hertz.c_m)),
    }
}

fn curves(found: &Solution, body: BodyKind) -> BTreeMap<String, Curve> {
    let hertz = &found.curves.hertz;
    let curve = |curve: &StressCurve| {
        let axis = axis(&curve.name);
        let values = |of: Quantity| {
            (of.name(), short(curve.stress.iter().map(|stress| of.of(stress) * hertz.p0_pa)))
        };
        Curve {
            axis: ["x", "y", "z"][axis],
            at_m: short(curve.at.iter().map(|at| at[axis] * hertz.c_m)),
            from_m: curve.at[0].map(|v| (v * hertz.c_m) as f32),
            stress_pa: Quantity::ALL.map(values).into_iter().collect(),
        }
    };
    let own = found.curves.stress.iter().filter(|curve| curve.body == body);
    own.map(|one| (one.name.clone(), curve(one))).collect()
}

/// The axis that a curve of this name runs along.
fn axis(name: &str) -> usize {
    match name {
        name if name.contains("along-x") => 0,
        name if name.contains("along-y") => 1,
        _ => 2,
    }
}
