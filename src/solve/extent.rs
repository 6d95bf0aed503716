//! The extent of a body, within which stresses can be computed.

use crate::base::number::stated;
use crate::base::{Error, PerBody};
use crate::case::Case;
use crate::stress::BodyKind;

/// Relative tolerance of a coordinate, which may have lost digits in a file.
const ROUNDING: f64 = 1e-9;

/// The extent of a body (m): y from end to end, z from its surface at the point's x down. Across
/// the contact a flat block has no end, and a round body its radius on either side; around a
/// concave one there is no end below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    body: BodyKind,
    ends_m: [f64; 2],
    half_width_m: f64,
    depth_m: f64,
}

/// Refuses points (m) of the bodies of `case` that lie outside them.
///
/// # Errors
/// [`Error::Value`] that names the first one.
pub fn check_points(
    case: &Case,
    points_m: impl IntoIterator<Item = (BodyKind, [f64; 3])>,
) -> Result<(), Error> {
    let [block, roller] = BodyKind::ALL.map(|body| Extent::of(case, body));
    let extents = PerBody { block, roller };
    let check = |(i, (body, at_m)): (usize, (BodyKind, [f64; 3]))| {
        extents[body].check(at_m).map_err(|outside| outside.of_point(i, body))
    };
    points_m.into_iter().enumerate().try_for_each(check)
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

impl Outside {
    /// The error that names it by a `key`.
    pub fn refused(self, key: String) -> Error {
        let value = format!("{} m", stated(self.value_m));
        Error::Value { key, value, reason: format!("it {}", self.reason), remedy: self.remedy }
    }

    /// The error of the coordinate of a `body`'s point number `index` from zero.
    fn of_point(self, index: usize, body: BodyKind) -> Error {
        let key = format!("{} of point {} ({})", self.axis, index + 1, body.name());
        self.refused(key)
    }
}

impl Extent {
    /// The extent of one of the bodies of `case`.
    pub fn of(case: &Case, body: BodyKind) -> Self {
        let radius_m = match body {
            BodyKind::Block => case.block.radius_m.unwrap_or(f64::INFINITY),
            BodyKind::Roller => case.roller.radius_m,
        };
        let depth_m = if radius_m > 0.0 { 2.0 * radius_m } else { f64::INFINITY };
        Self { body, ends_m: case.ends_m(body), half_width_m: radius_m.abs(), depth_m }
    }

    /// The body's ends along y (m).
    pub fn ends_m(&self) -> [f64; 2] {
        self.ends_m
    }

    /// Whether the point `at_m` (m) lies within the body.
    ///
    /// # Errors
    /// The first coordinate outside, with a remedy.
    pub fn check(&self, at_m: [f64; 3]) -> Result<(), Outside> {
        (0..3).try_for_each(|axis| self.check_axis(axis, at_m[axis]))?;
        let [x_m, _, z_m] = at_m;
        if self.depth_m.is_infinite() {
            return Ok(());
        }
        // Across the round body, from its surface at this x.
        let through_m = 2.0 * (self.half_width_m.powi(2) - x_m * x_m).max(0.0).sqrt();
        if z_m <= through_m + ROUNDING * self.depth_m {
            return Ok(());
        }
        Err(Outside {
            axis: "z",
            value_m: z_m,
            reason: format!("is outside the {} at x = {} m", self.body.name(), stated(x_m)),
            remedy: format!("keep 0 <= z <= {} m there", stated(through_m)),
        })
    }

    /// Whether one coordinate (m) lies within the body; `axis` is 0, 1 or 2 for x, y or z.
    ///
    /// # Errors
    /// As [`Extent::check`].
    pub fn check_axis(&self, axis: usize, value_m: f64) -> Result<(), Outside> {
        let name = self.body.name();
        let inside = match axis {
            0 => value_m.abs() <= self.half_width_m,
            1 => {
                let [from, to] = self.ends_m;
                let rounding = ROUNDING * (to - from);
                (from - rounding..=to + rounding).contains(&value_m)
            }
            _ => (0.0..=self.depth_m).contains(&value_m),
        };
        let (reason, remedy) = if !value_m.is_finite() {
            ("is not a finite number".to_string(), "correct it".to_string())
        } else if inside {
            return Ok(());
        } else if axis == 0 {
            (
                format!("is beside the {name}"),
                format!("keep |x| <= {} m", stated(self.half_width_m)),
            )
        } else if axis == 1 {
            let [from, to] = self.ends_m;
            let remedy = match from == -to {
                true => format!("keep |y| <= {} m", stated(to)),
                false => format!("keep y from {} to {} m", stated(from), stated(to)),
            };
            (format!("is outside the {name}"), remedy)
        } else if self.depth_m.is_infinite() {
            (format!("is outside the {name}"), "keep z >= 0".to_string())
        } else {
            (format!("is outside the {name}"), format!("keep 0 <= z <= {} m", stated(self.depth_m)))
        };
        Err(Outside { axis: ["x", "y", "z"][axis], value_m, reason, remedy })
    }
}
