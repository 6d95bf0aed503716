//! What a case's own radii and friction make of the stresses that cases of one scene share.

use crate::base::{BodyKind, PerBody, StressTensor};
use crate::case::{Case, Sliding};
use crate::stress::RoundStress;
use crate::stress::round::DIAMETRAL_TENSION;

/// The radii and the friction of a case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shaping {
    /// C / R of each body, negative for a concave one.
    pub curvatures: PerBody<f64>,
    /// The length of the shorter body in those of the roller: far from the contact the roller
    /// carries its load along all of its length.
    pub loaded: f64,
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
        let loaded = case.shorter_m() / case.roller.length_m;
        Self { curvatures, loaded, friction }
    }

    /// The larger C / R of the bodies, whatever its sign.
    pub fn largest_curvature(&self) -> f64 {
        self.curvatures.block.abs().max(self.curvatures.roller.abs())
    }

    /// The uniform sigma_xx of the roller, squeezed across its diameter (p0).
    pub fn roller_tension(&self) -> f64 {
        DIAMETRAL_TENSION * self.curvatures.roller * self.loaded
    }

    /// Whether the stress of a body is more than that of a flat one under the pressure alone.
    pub fn adds_to(&self, body: BodyKind) -> bool {
        self.curvatures[body] != 0.0 || self.friction != 0.0
    }

    /// The stress of a body (p0).
    pub fn stress(&self, body: BodyKind, stress: &RoundStress) -> StressTensor {
        let curvature = self.curvatures[body];
        let pressed = stress.at(curvature);
        let (pressed, friction) = match body {
            BodyKind::Block => (pressed, self.friction),
            BodyKind::Roller => {
                let tension = StressTensor { xx: self.roller_tension(), ..StressTensor::default() };
                (pressed + tension, -self.friction)
            }
        };
        match friction == 0.0 {
            true => pressed,
            false => pressed + stress.under_traction(curvature) * friction,
        }
    }
}
