//! What a case's own radii and friction make of the stresses that cases of one scene share.

use crate::base::{BodyKind, PerBody, StressTensor};
use crate::case::{Case, Sliding};
use crate::stress::RoundStress;

/// The radii and the friction of a case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shaping {
    /// C / R of each body, negative for a concave one.
    pub curvatures: PerBody<f64>,
    /// The traction on the block along +x in pressures.
    pub friction: f64,
}

impl Shaping {
    /// Those of a case.
    pub fn of(case: &Case) -> Self {
        let of_radius = |radius_m: f64| case.hertz().c_m / radius_m;
        let Sliding { friction } = case.sliding;
        let curvatures = PerBody {
            block: case.block.radius_m.map_or(0.0, of_radius),
            roller: of_radius(case.roller.radius_m),
        };
        Self { curvatures, friction }
    }

    /// The larger C / R of the bodies, whatever its sign.
    pub fn largest_curvature(&self) -> f64 {
        self.curvatures.block.abs().max(self.curvatures.roller.abs())
    }

    /// Whether the stress of a body is more than that of a flat one under the pressure alone.
    pub fn adds_to(&self, body: BodyKind) -> bool {
        self.curvatures[body] != 0.0 || self.friction != 0.0
    }

    /// The stress of a body (p0).
    pub fn stress(&self, body: BodyKind, stress: &RoundStress) -> StressTensor {
        let curvature = self.curvatures[body];
        let (pressed, friction) = match body {
            BodyKind::Block => (stress.on_one_side(curvature), self.friction),
            BodyKind::Roller => (stress.at(curvature), -self.friction),
        };
        match friction == 0.0 {
            true => pressed,
            false => pressed + stress.under_traction(curvature) * friction,
        }
    }
}
