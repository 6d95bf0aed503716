//! What the tests of the numerics share: a plain scene, and comparisons in which a NaN never passes for
//! small.

use edgeline::base::{PerBody, StressTensor};
use edgeline::body::EdgeModel;
use edgeline::solve::{Scene, SceneBody};

/// A contact of equal materials: slenderness, length ratio, Poisson's ratio.
pub fn scene(slenderness: f64, length_ratio: f64, nu: f64, model: EdgeModel) -> Scene {
    let body = |half| SceneBody { half, nu, share: 0.5 };
    Scene {
        half_length: slenderness,
        bodies: PerBody { block: body(slenderness / length_ratio), roller: body(slenderness) },
        model,
        psi: None,
        tolerance: 1e-3,
    }
}

/// The larger one; a NaN wins.
pub fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// Largest difference of two stresses' components.
pub fn apart(a: &StressTensor, b: &StressTensor) -> f64 {
    let pairs = a.components().into_iter().zip(b.components());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, worse)
}
