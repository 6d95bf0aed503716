//! The request to the finite-element program: the content of `request.json`, which
//! `fem/edgeline_fem/request.py` reads.

use super::code::Code;
use super::result::{wanted_curves, wanted_lines};
use super::settings::FemSettings;
use crate::body::EdgeModel;
use crate::case::{Accuracy, Block, Case, Cells, Fatigue, Load, Pose, Roller, Sliding, Surface};
use crate::solve::{Scene, SolvedScene};
use crate::stress::BodyKind;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use std::f64::consts::FRAC_PI_2;
use std::path::Path;

/// The form of a case in requests and records. It leaves out the accuracy and the cells, which are
/// the models' own, and the rough surface, which finite elements refuse.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Case")]
pub(super) struct Problem {
    name: String,
    roller: Roller,
    block: Block,
    #[serde(flatten)]
    load: Load,
    #[serde(flatten)]
    pose: Pose,
    #[serde(flatten)]
    sliding: Sliding,
    #[serde(skip)]
    fatigue: Fatigue,
    #[serde(skip)]
    surface: Option<Surface>,
    #[serde(skip)]
    accuracy: Accuracy,
    #[serde(skip)]
    cells: Option<Cells>,
}

/// A request to the finite-element program.
#[derive(Serialize)]
pub(super) struct Request<'a> {
    schema: u32,
    case: Value,
    mesh: Mesh,
    /// See [`contact_ends_m`].
    #[serde(skip_serializing_if = "Vec::is_empty")]
    contact_ends_m: Vec<f64>,
    solver: Solver,
    gmsh: &'a Path,
    #[serde(skip_serializing_if = "Option::is_none")]
    engine: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    ccx: Option<&'a Path>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    large_displacements: bool,
    curves: Vec<WantedCurve>,
    /// In the order in which the results are to have them.
    pressure_points_m: Map<String, Value>,
}

#[derive(Serialize)]
struct Mesh {
    size: f64,
}

#[derive(Serialize)]
struct Solver {
    linear: &'static str,
    tolerance: f64,
    max_iterations: u32,
}

#[derive(Serialize)]
struct WantedCurve {
    body: BodyKind,
    curve: &'static str,
    points_m: Vec<[f64; 3]>,
}

/// Points of a profile in a request.
const PROFILE_POINTS: u32 = 401;

/// The case as the program takes it: the form of a record, with profiles as the drops of points.
fn case_of(case: &Case) -> Value {
    #[derive(Serialize)]
    struct Form(#[serde(with = "Problem")] Case);
    let mut value = serde_json::to_value(Form(case.clone())).expect("plain data");
    for body in BodyKind::ALL {
        let Some(profile) = case.profile(body) else { continue };
        let [from, to] = case.ends_m(body);
        let half = 0.5 * (to - from);
        let point = |i: u32| {
            // Closer towards the ends, where profiles are steep.
            let t = 2.0 * f64::from(i) / f64::from(PROFILE_POINTS - 1) - 1.0;
            let y = half * (FRAC_PI_2 * t).sin();
            // What has no limit at the end is cut just before it.
            [y, profile.drop(y.clamp(-CUT * half, CUT * half))]
        };
        let own = value[body.name()].as_object_mut().expect("a body is a table");
        own.insert("profile_m".into(), json!((0..PROFILE_POINTS).map(point).collect::<Vec<_>>()));
    }
    value
}

/// Tolerance (p0) of the solution that tells where meshes are to be finer, and the step (C) to
/// which it tells: the request is to be the same for any program that is as accurate.
const EXPECTED: f64 = 1e-2;
const STEP: f64 = 0.02;

/// Where along y (m) the contact of `case` ends before its bodies do, by `quarter-space`. Meshes
/// are finer there; what they give does not depend on it. None where that model has no solution.
fn contact_ends_m(case: &Case) -> Vec<f64> {
    let expected = case.clone().with_tolerance(EXPECTED);
    let scene = Scene::new(&expected, EdgeModel::QuarterSpace, None);
    if !scene.may_end() {
        return Vec::new();
    }
    let Ok(solved) = SolvedScene::new(&scene) else { return Vec::new() };
    let ends = solved.ends().into_iter().zip(solved.open).filter(|(_, open)| *open);
    ends.map(|(y, _)| (y / STEP).round() * STEP * case.hertz().c_m).collect()
}

/// Part of a half-length up to which a profile is taken as it is.
const CUT: f64 = 1.0 - 1e-6;

impl<'a> Request<'a> {
    /// Asks for the standard curves and pressure lines of `case` by the code and on the mesh of
    /// `settings`.
    pub fn new(case: &Case, settings: &'a FemSettings) -> Self {
        let other = settings.code != Code::Fenicsx;
        Self {
            schema: 1,
            case: case_of(case),
            mesh: Mesh { size: settings.size },
            contact_ends_m: contact_ends_m(case),
            solver: Solver { linear: settings.linear.name(), tolerance: 1e-8, max_iterations: 200 },
            gmsh: &settings.gmsh,
            engine: other.then(|| settings.code.name()),
            ccx: other.then_some(settings.ccx.as_path()),
            large_displacements: settings.large_displacements,
            curves: wanted_curves(case)
                .into_iter()
                .map(|(body, curve, points_m)| WantedCurve { body, curve, points_m })
                .collect(),
            pressure_points_m: wanted_lines(case)
                .into_iter()
                .map(|(name, points)| (name.to_string(), json!(points)))
                .collect(),
        }
    }
}
