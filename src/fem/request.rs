//! The request to the finite-element program: the content of `request.json`, which
//! `fem/edgeline_fem/request.py` reads.

use super::result::{wanted_curves, wanted_lines};
use crate::case::{Accuracy, Block, Case, Cells, Load, Pose, Roller};
use crate::stress::BodyKind;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use std::path::Path;

/// The form of a case in requests and records. It leaves out the accuracy and the cells, which are
/// the models' own.
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
    #[serde(skip)]
    accuracy: Accuracy,
    #[serde(skip)]
    cells: Option<Cells>,
}

/// A request to the finite-element program.
#[derive(Serialize)]
pub(super) struct Request<'a> {
    schema: u32,
    #[serde(with = "Problem")]
    case: Case,
    mesh: Mesh,
    solver: Solver,
    gmsh: &'a Path,
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

impl<'a> Request<'a> {
    /// Asks for the standard curves and pressure lines of `case` on a mesh of relative size `size`,
    /// with the linear solver called `linear`.
    pub fn new(case: &Case, size: f64, linear: &'static str, gmsh: &'a Path) -> Self {
        Self {
            schema: 1,
            case: case.clone(),
            mesh: Mesh { size },
            solver: Solver { linear, tolerance: 1e-8, max_iterations: 200 },
            gmsh,
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
