//! One case and one edge model to one solution, in SI units.

use crate::base::{HertzScales, Result, StressTensor};
use crate::body::EdgeModel;
use crate::case::Case;
use crate::stress::{BodyKind, curves};
use serde::Serialize;

/// What to compute.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The edge model of both bodies.
    pub method: EdgeModel,
    /// Bodies whose curves are wanted.
    pub bodies: Vec<BodyKind>,
    /// Names of the standard curves that are wanted; all by default.
    pub curves: Vec<String>,
    /// Extra points, in their order.
    pub points: Vec<Point>,
}

impl Options {
    /// All standard curves of both bodies.
    pub fn new(method: EdgeModel) -> Self {
        Self {
            method,
            bodies: BodyKind::ALL.to_vec(),
            curves: curves::CURVE_NAMES.iter().map(|s| s.to_string()).collect(),
            points: Vec::new(),
        }
    }
}

/// A point in a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// The body.
    pub body: BodyKind,
    /// x, y, z (m); z is the depth into the body, >= 0.
    pub at_m: [f64; 3],
}

/// A cell of the contact pressure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PressureCell {
    /// Centre across the contact (m).
    pub x_m: f64,
    /// Place along the contact (m).
    pub y_m: f64,
    /// Width (m).
    pub dx_m: f64,
    /// Length (m).
    pub dy_m: f64,
    /// Mean pressure (Pa), >= 0; the sum of p dx dy over the cells is the load.
    pub p_pa: f64,
}

/// Pressure on a line of points.
#[derive(Debug, Clone, PartialEq)]
pub struct PressureLine {
    /// `along-y` (x = 0) or `along-x` (y = 0).
    pub name: &'static str,
    /// Points x, y (m).
    pub at_m: Vec<[f64; 2]>,
    /// Pressure at the points (Pa).
    pub p_pa: Vec<f64>,
}

/// Stresses along a standard curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// The body.
    pub body: BodyKind,
    /// The curve's name.
    pub name: &'static str,
    /// Points x, y, z (m).
    pub at_m: Vec<[f64; 3]>,
    /// Stresses at the points (Pa).
    pub stress_pa: Vec<StressTensor>,
}

/// Seconds of each stage.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Axes and compliance.
    pub setup: f64,
    /// Contact.
    pub contact: f64,
    /// Stresses.
    pub stress: f64,
    /// All of it.
    pub total: f64,
}

/// The most stressed place of the standard curves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Critical {
    /// The body.
    pub body: BodyKind,
    /// The measure, `von_mises`.
    pub measure: &'static str,
    /// Its value (Pa).
    pub value_pa: f64,
    /// Where: x, y, z (m).
    pub at_m: [f64; 3],
}

/// The solution of a case by one method.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The case's name.
    pub case: String,
    /// The edge model.
    pub method: EdgeModel,
    /// The scales.
    pub hertz: HertzScales,
    /// Load (N).
    pub load_n: f64,
    /// Approach of the bodies' far points that the model implies (m).
    pub approach_m: f64,
    /// Pressure at the contact's centre (Pa).
    pub p_centre_pa: f64,
    /// Largest pressure of the cells (Pa).
    pub p_max_pa: f64,
    /// Its place x, y (m).
    pub p_max_at_m: [f64; 2],
    /// Whether the contact iteration reached its tolerance.
    pub converged: bool,
    /// Iterations of the contact solve.
    pub iterations: usize,
    /// |load of the pressure - load| / load.
    pub load_error_rel: f64,
    /// Time spent.
    pub seconds: Seconds,
    /// The most stressed place.
    pub critical: Option<Critical>,
    /// The contact pressure in cells.
    pub cells: Vec<PressureCell>,
    /// The contact pressure on the two standard lines.
    pub lines: Vec<PressureLine>,
    /// The standard curves asked for.
    pub curves: Vec<Curve>,
    /// Stresses at the extra points (Pa), in their order.
    pub points: Vec<StressTensor>,
    /// What was chosen and what was skipped, for `summary.json` (axes, wavenumbers, counts).
    pub details: serde_json::Value,
}

/// Solves `case` with one method.
///
/// # Errors
/// [`crate::base::Error::NotConverged`] when the contact iteration does not settle, and
/// [`crate::base::Error::Value`] when a point of `options` lies outside its body.
pub fn solve(case: &Case, options: &Options) -> Result<Solution> {
    let _ = (case, options);
    todo!("lands with the solver")
}
