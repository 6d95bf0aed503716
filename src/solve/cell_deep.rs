//! How far points and lines deep below a contact on cells have come.
//!
//! Cells are counted from points at infinity of half-spaces. What they and their images displace
//! below the surface is known in closed form there; what free ends add is the displacement of the
//! surface by them less the shortening above.

use super::cells::{contact_ends, line_loads};
use super::deep::{self, Force, Places, Plate, Sunk, images};
use super::scene::Scene;
use crate::cells::{CellPressure, CellProblem};
use crate::stress::LineLoad;

/// The approach and the tilt at one depth.
#[derive(Debug, Clone, Copy)]
pub(super) struct DeepMotion {
    /// Approach (C^2 / (2 R)) at y = 0, as [`deep::Approaches`] has it.
    pub approach: f64,
    /// Tilt (C / (2 R)), as [`deep::tilt`] has it.
    pub tilt: f64,
}

impl DeepMotion {
    /// That at `depth` (C) of the contact of `scene` with the `pressure` that solves the `problem`.
    pub fn new(scene: &Scene, problem: &CellProblem, pressure: &CellPressure, depth: f64) -> Self {
        let lines = line_loads(pressure, scene.middle);
        let places = Places::new(contact_ends(&lines).at);
        let nearest = places.nearest();
        let tilts = !scene.span().symmetric;
        let mut at = vec![nearest];
        at.extend(places.all().iter().filter(|_| tilts));
        let far = |y: f64| pressure.approach + pressure.tilt * scene.off_middle(y);
        let moved = displaced(scene, problem, pressure, &forces(&lines, pressure), (&at, depth));
        let closed: Vec<f64> = at.iter().zip(moved).map(|(y, moved)| far(*y) - moved).collect();
        let tilt = if tilts { places.slope(&closed[1..]) } else { 0.0 };
        Self { approach: closed[0] - nearest * tilt, tilt }
    }
}

/// The displacement (C^2 / (2 R)) of points of both bodies together at `depth` (C) below each of
/// the places `at` along the line, where the `pressure` makes these `forces`.
fn displaced(
    scene: &Scene,
    problem: &CellProblem,
    pressure: &CellPressure,
    forces: &[Force],
    (at, depth): (&[f64], f64),
) -> Vec<f64> {
    let mut all = vec![0.0; at.len()];
    let free = problem.free.as_ref().map(|free| {
        let columns = free.columns(pressure);
        let lift = free.lift(&columns, pressure);
        all.iter_mut().zip(at).for_each(|(sum, y)| *sum = lift(scene.off_middle(*y)));
        let moments = free.moments(&columns);
        (free, columns, moments)
    });
    for (kind, body) in &scene.distinct_bodies() {
        let end = scene.end(*kind);
        let sunk = |y: f64| {
            let mirrored = images(body, end.image_weight.unwrap_or(0.0), forces);
            Sunk::new(body, y, forces.iter().copied().chain(mirrored))
        };
        let Some((free, columns, moments)) = free.as_ref().filter(|_| end.freed) else {
            all.iter_mut().zip(at).for_each(|(sum, y)| *sum += sunk(*y).at(depth));
            continue;
        };
        let fields = free.fields(&scene.free_body(*kind), columns, moments, scene.tolerance);
        let reach = deep::reach(body.half, depth);
        let rule = deep::depths(reach);
        for (sum, y) in all.iter_mut().zip(at) {
            let sunk = sunk(*y);
            let [freed, mirrored] = fields
                .each_ref()
                .map(|field| deep::strains(body, field, scene.off_middle(*y), &rule));
            let added: Vec<f64> = freed.iter().zip(mirrored).map(|(own, all)| own - all).collect();
            let shortened: f64 = added.iter().zip(rule.weights()).map(|(s, w)| s * w).sum();
            *sum += sunk.at(reach) - shortened;
            if reach < depth {
                let strains = added.iter().zip(rule.nodes()).map(|(s, z)| s + sunk.strain(*z));
                let strains: Vec<f64> = strains.collect();
                *sum -= Plate::new(body, *y, forces, (&rule, &strains)).between(reach, depth);
            }
        }
    }
    all
}

/// What the rows of cells, with the loads `lines`, displace far from them.
fn forces(lines: &[LineLoad], pressure: &CellPressure) -> Vec<Force> {
    let grid = &pressure.grid;
    let (a, _) = grid.half_sides();
    let rows = pressure.pressure.chunks_exact(grid.nx);
    let force = |(line, row): (&LineLoad, &[f64])| {
        let total: f64 = row.iter().sum();
        let squares = row.iter().enumerate().map(|(i, p)| p * grid.x(i).powi(2)).sum::<f64>();
        Force {
            y: line.y,
            // A uniform cell has a third of a^2 of its own.
            square: if total > 0.0 { squares / total + a * a / 3.0 } else { 0.0 },
            size: line.weight * line.load,
        }
    };
    lines.iter().zip(rows).map(force).collect()
}
