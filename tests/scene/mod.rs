//! What several test binaries share.

use edgeline::body::EdgeModel;
use edgeline::solve::{Scene, SceneBody};

/// A contact of equal materials: slenderness, length ratio, Poisson's ratio.
pub fn scene(slenderness: f64, length_ratio: f64, nu: f64, model: EdgeModel) -> Scene {
    let body = |half| SceneBody { half, nu, share: 0.5 };
    Scene {
        half_length: slenderness,
        bodies: [body(slenderness / length_ratio), body(slenderness)],
        model,
        psi: None,
        tolerance: 1e-3,
    }
}
