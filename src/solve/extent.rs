//! The extent of a body, within which stresses can be computed.

use crate::case::Case;
use crate::stress::BodyKind;

/// Relative tolerance of a coordinate, which may have lost digits in a file.
const ROUNDING: f64 = 1e-9;

/// The extent of a body in its own frame (m): |y| up to its half-length, and z from its surface
/// down. Across the contact it is unlimited.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    body: BodyKind,
    half_length_m: f64,
    depth_m: f64,
}

/// A coordinate outside a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Outside {
    /// The axis, `x`, `y` or `z`.
    pub axis: &'static str,
    /// The coordinate (m).
    pub value_m: f64,
    /// What is wrong with it.
    pub reason: String,
    /// What to give instead.
    pub remedy: String,
}

impl Extent {
    /// The extent of one of the bodies of `case`.
    pub fn of(case: &Case, body: BodyKind) -> Self {
        let (length_m, depth_m) = match body {
            BodyKind::Block => (case.block.length_m, f64::INFINITY),
            BodyKind::Roller => (case.roller.length_m, 2.0 * case.roller.radius_m),
        };
        Self { body, half_length_m: 0.5 * length_m, depth_m }
    }

    /// Half of the body's length (m).
    pub fn half_length_m(&self) -> f64 {
        self.half_length_m
    }

    /// Whether the point `at_m` (m) lies within the body.
    ///
    /// # Errors
    /// The first coordinate outside, with a remedy.
    pub fn check(&self, at_m: [f64; 3]) -> Result<(), Outside> {
        (0..3).try_for_each(|axis| self.check_axis(axis, at_m[axis]))
    }

    /// Whether one coordinate (m) lies within the body; `axis` is 0, 1 or 2 for x, y or z.
    ///
    /// # Errors
    /// As [`Extent::check`].
    pub fn check_axis(&self, axis: usize, value_m: f64) -> Result<(), Outside> {
        let name = self.body.name();
        let inside = match axis {
            0 => true,
            1 => value_m.abs() <= self.half_length_m * (1.0 + ROUNDING),
            _ => (0.0..=self.depth_m).contains(&value_m),
        };
        let (reason, remedy) = if !value_m.is_finite() {
            ("is not a finite number".to_string(), "correct it".to_string())
        } else if inside {
            return Ok(());
        } else if axis == 1 {
            (format!("is outside the {name}"), format!("keep |y| <= {:e} m", self.half_length_m))
        } else if self.body == BodyKind::Block {
            (format!("is outside the {name}"), "keep z >= 0".to_string())
        } else {
            (format!("is outside the {name}"), format!("keep 0 <= z <= {:e} m", self.depth_m))
        };
        Err(Outside { axis: ["x", "y", "z"][axis], value_m, reason, remedy })
    }
}
