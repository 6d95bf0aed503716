//! Stresses on a grid of points, in SI units.

use super::scene::{Scene, SolvedScene};
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::Case;
use crate::stress::grid::on_grid;
use crate::stress::{BodyKind, Grid, GridStress};

/// Largest number of points of one grid: the result takes 48 bytes a point.
pub const MOST_GRID_POINTS: usize = 20_000_000;

/// Solves `case` by `method` and evaluates the six stress components of `body` (Pa) at every point
/// of `grid_m`, whose coordinates are in metres; z is the depth into that body.
///
/// Runs on all threads of the current pool. Coordinates that mirror each other exactly in x = 0 or
/// in y = 0 are computed once.
///
/// # Errors
/// [`Error::Value`] when the grid is empty, too large, or leaves the body, and
/// [`Error::NotConverged`] when the contact does not settle.
pub fn solve_on_grid(
    case: &Case,
    method: EdgeModel,
    body: BodyKind,
    grid_m: &Grid,
) -> Result<GridStress> {
    check(case, body, grid_m)?;
    let hertz = case.hertz();
    let in_c = |values: &[f64]| values.iter().map(|v| v / hertz.c_m).collect::<Vec<_>>();
    // The body's end may be a rounding beyond itself once it is divided by C.
    let scene = Scene::new(case, method, None);
    let half = scene.bodies[body].half;
    let y = in_c(&grid_m.y).into_iter().map(|y| y.clamp(-half, half)).collect();
    let grid = Grid { x: in_c(&grid_m.x), y, z: in_c(&grid_m.z) };
    let solved = SolvedScene::new(&scene)?;
    let curvature = match body {
        BodyKind::Block => None,
        BodyKind::Roller => Some(hertz.c_m / case.roller.radius_m),
    };
    Ok(on_grid(&solved.field(body), &grid, curvature).scaled(hertz.p0_pa))
}

/// Refuses grids that are empty, too large, or not within the body.
fn check(case: &Case, body: BodyKind, grid: &Grid) -> Result<()> {
    let refuse = |axis: &str, value: String, reason: &str, remedy: String| Error::Value {
        key: format!("grid {axis} ({})", body.name()),
        value,
        reason: reason.into(),
        remedy,
    };
    // The product of three lengths may overflow where its factors do not.
    let sizes = [grid.x.len(), grid.y.len(), grid.z.len()];
    let count = sizes.iter().try_fold(1usize, |product, n| product.checked_mul(*n));
    if count.is_none_or(|n| n == 0 || n > MOST_GRID_POINTS) {
        let value = sizes.map(|n| n.to_string()).join(" x ");
        let reason = format!("a grid has 1 to {MOST_GRID_POINTS} points");
        return Err(refuse("size", value, &reason, "choose other numbers of points".into()));
    }
    let half_m = 0.5
        * match body {
            BodyKind::Block => case.block.length_m,
            BodyKind::Roller => case.roller.length_m,
        };
    let deepest_m = match body {
        BodyKind::Block => f64::INFINITY,
        BodyKind::Roller => 2.0 * case.roller.radius_m,
    };
    for (axis, values) in [("x", &grid.x), ("y", &grid.y), ("z", &grid.z)] {
        for &v in values {
            let (bad, reason, remedy) = if !v.is_finite() {
                (true, "every coordinate must be a finite number", "correct it".to_string())
            } else if axis == "y" {
                let remedy = format!("keep |y| <= {half_m:e} m");
                (v.abs() > half_m * (1.0 + 1e-9), "it lies beyond the body's end face", remedy)
            } else if axis == "z" {
                let remedy = match body {
                    BodyKind::Block => "keep z >= 0".to_string(),
                    BodyKind::Roller => format!("keep 0 <= z <= {deepest_m:e} m"),
                };
                (!(0.0..=deepest_m).contains(&v), "z is a depth within the body", remedy)
            } else {
                (false, "", String::new())
            };
            if bad {
                return Err(refuse(axis, format!("{v:e} m"), reason, remedy));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::{Options, Point, solve};
    use super::*;
    use crate::case::builtin_case;

    #[test]
    fn a_grid_is_what_points_are() {
        let mut case = builtin_case("half-short").unwrap().unwrap();
        case.accuracy.tolerance = 5e-3;
        let c = case.hertz().c_m;
        let end = 0.5 * case.roller.length_m;
        let grid = Grid {
            x: [-1.2, -0.4, 0.0, 0.4, 2.0].map(|v| v * c).to_vec(),
            y: vec![-end, -0.7 * end, 0.1 * end, 0.7 * end, end],
            z: [0.0, 0.3, 1.7].map(|v| v * c).to_vec(),
        };
        for body in BodyKind::ALL {
            let stress = solve_on_grid(&case, EdgeModel::QuarterSpace, body, &grid).unwrap();
            assert_eq!(stress.len(), 75);
            let mut options = Options::new(EdgeModel::QuarterSpace);
            options.curves.clear();
            let mut indices = Vec::new();
            for (iz, &z) in grid.z.iter().enumerate() {
                for (iy, &y) in grid.y.iter().enumerate() {
                    for (ix, &x) in grid.x.iter().enumerate() {
                        options.points.push(Point { body, at_m: [x, y, z] });
                        indices.push(grid.index(ix, iy, iz));
                    }
                }
            }
            let points = solve(&case, &options).unwrap();
            let p0 = points.hertz.p0_pa;
            for (i, wanted) in indices.into_iter().zip(&points.points) {
                for (a, b) in stress.at(i).components().into_iter().zip(wanted.components()) {
                    assert!((a - b).abs() < 1e-9 * p0, "{body:?} point {i}: {a} is not {b}");
                }
            }
        }
    }

    #[test]
    fn bad_grids_are_refused() {
        let case = builtin_case("flush-short").unwrap().unwrap();
        let good = Grid { x: vec![0.0], y: vec![0.0], z: vec![0.0] };
        let refused = |grid: Grid| {
            solve_on_grid(&case, EdgeModel::Mirror, BodyKind::Roller, &grid)
                .unwrap_err()
                .to_string()
        };
        assert!(refused(Grid { x: vec![], ..good.clone() }).contains("0 x 1 x 1"));
        assert!(refused(Grid { x: vec![f64::NAN], ..good.clone() }).contains("grid x (roller)"));
        assert!(refused(Grid { y: vec![-1.0], ..good.clone() }).contains("beyond the body's end"));
        assert!(refused(Grid { z: vec![-1e-9], ..good.clone() }).contains("keep 0 <= z"));
        assert!(refused(Grid { z: vec![1.0], ..good }).contains("grid z (roller) = 1e0 m"));
        let many = Grid { x: vec![0.0; 5000], y: vec![0.0; 5000], z: vec![0.0] };
        assert!(refused(many).contains("5000 x 5000 x 1"));
    }
}
