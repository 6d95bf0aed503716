//! Limits of grids of points.

use super::extent::{Extent, Outside};
use crate::base::{Error, Result};
use crate::case::Case;
use crate::stress::{BodyKind, Grid};

/// Largest number of points of one grid; the result takes 48 bytes per point.
pub const MOST_GRID_POINTS: usize = 20_000_000;

/// Refuses grids (C) that are empty, too large, or not within the body.
///
/// # Errors
/// [`Error::Value`] with the axis and what to give instead.
pub fn check_grid(case: &Case, body: BodyKind, grid: &Grid) -> Result<()> {
    // The product of three lengths may overflow where its factors do not.
    let sizes = [grid.x.len(), grid.y.len(), grid.z.len()];
    let count = sizes.iter().try_fold(1usize, |product, n| product.checked_mul(*n));
    if count.is_none_or(|n| n == 0 || n > MOST_GRID_POINTS) {
        return Err(Error::Value {
            key: format!("grid size ({})", body.name()),
            value: sizes.map(|n| n.to_string()).join(" x "),
            reason: format!("a grid has 1 to {MOST_GRID_POINTS} points"),
            remedy: "choose other numbers of points".into(),
        });
    }
    let refused = |outside: Outside| {
        let key = format!("grid {} ({})", outside.axis, body.name());
        outside.refused(key)
    };
    let (extent, c_m) = (Extent::of(case, body), case.hertz().c_m);
    for (axis, values) in [&grid.x, &grid.y, &grid.z].into_iter().enumerate() {
        for v in values {
            extent.check_axis(axis, v * c_m).map_err(refused)?;
        }
    }
    // A round body is less deep beside its middle.
    let farthest = |values: &[f64]| values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    extent
        .check([farthest(&grid.x), grid.y[0], farthest(&grid.z)].map(|v| v * c_m))
        .map_err(refused)
}
