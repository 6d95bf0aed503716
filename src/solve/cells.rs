//! The contact pressure in cells, whose sum is the load.

use super::solved_scene::SolvedScene;
use crate::base::HertzScales;
use crate::case::Case;
use crate::cells::CellPressure;
use crate::kernels::strip;
use crate::stress::round::ContactEnds;
use crate::stress::{LineLoad, Load};

/// Cells of the written pressure across the contact (C).
const CELL: f64 = 0.05;

/// A cell of the contact pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PressureCell {
    /// Centre across the contact (C).
    pub x: f64,
    /// Place along the contact (C).
    pub y: f64,
    /// Width (C).
    pub dx: f64,
    /// Length (C).
    pub dy: f64,
    /// Mean pressure (p0), >= 0; the sum of p dx dy over the cells is the load.
    pub p: f64,
}

/// The cell of largest pressure; there is always one.
pub(super) fn largest(cells: &[PressureCell]) -> &PressureCell {
    cells.iter().max_by(|a, b| a.p.total_cmp(&b.p)).expect("a contact has cells")
}

/// What the pressures of `cells` miss of the force of `case`, or exceed it by, as a part of it.
pub(super) fn load_error(cells: &[PressureCell], case: &Case) -> f64 {
    let HertzScales { c_m, p0_pa, .. } = case.hertz();
    let carried_n: f64 = cells.iter().map(|c| c.p * p0_pa * (c.dx * c_m) * (c.dy * c_m)).sum();
    (carried_n / case.load.force_n - 1.0).abs()
}

/// Mean pressures of cells that are `CELL` wide and as long as a node's quadrature weight, so that
/// their sum is the solution's load.
pub(super) fn pressure_cells(solved: &SolvedScene) -> Vec<PressureCell> {
    let pressure = &solved.pressure;
    let axis = pressure.axis();
    let mut cells = Vec::new();
    // Symmetric about both planes, hence computed once.
    let profile = |j: usize| -> Vec<f64> {
        let (a, coefficients) = pressure.at_node(j);
        let reach = (a / CELL - 0.5).ceil().max(0.0) as i32;
        let carried = |i: i32| strip::cumulative(a, coefficients, (f64::from(i) - 0.5) * CELL);
        let sums: Vec<f64> = (0..=reach + 1).map(carried).collect();
        without_tension(sums.windows(2).map(|sum| (sum[1] - sum[0]) / CELL).collect())
    };
    let profiles: Vec<Vec<f64>> = (0..axis.len()).map(profile).collect();
    let nodes = axis.nodes().iter().zip(axis.weights()).zip(&profiles);
    let mirrored = nodes.clone().rev().filter(|_| pressure.is_symmetric()).map(|n| (-1.0, n));
    let sides = mirrored.chain(nodes.map(|n| (1.0, n)));
    for (side, ((&y, &dy), profile)) in sides {
        let reach = profile.len() as i32 - 1;
        for i in -reach..=reach {
            let p = profile[i.unsigned_abs() as usize];
            cells.push(PressureCell { x: f64::from(i) * CELL, y: side * y, dx: CELL, dy, p });
        }
    }
    cells
}

/// The pressures of a row of cells from its middle on, without those below zero that the modes
/// leave somewhere within their accuracy; the row still carries its load.
fn without_tension(mut row: Vec<f64>) -> Vec<f64> {
    if row.iter().any(|p| *p < 0.0) {
        // All but the middle cell are there twice.
        let load = |row: &[f64]| row[0] + 2.0 * row[1..].iter().sum::<f64>();
        let wanted = load(&row).max(0.0);
        row.iter_mut().for_each(|p| *p = p.max(0.0));
        let left = load(&row);
        row.iter_mut().filter(|p| **p > 0.0).for_each(|p| *p *= wanted / left);
    }
    row
}

/// The load per length of each row of cells, whose middle is at `middle` (C).
pub(super) fn line_loads(pressure: &CellPressure, middle: f64) -> Vec<LineLoad> {
    let grid = &pressure.grid;
    let (a, b) = grid.half_sides();
    let row = |(j, row): (usize, &[f64])| LineLoad {
        y: grid.y(j) + middle,
        weight: 2.0 * b,
        load: 2.0 * a * row.iter().sum::<f64>(),
        half_width: a * row.iter().filter(|p| **p > 0.0).count() as f64,
    };
    pressure.pressure.chunks_exact(grid.nx).enumerate().map(row).collect()
}

/// The ends along y of the rows that carry a load.
pub(super) fn contact_ends(lines: &[LineLoad]) -> ContactEnds {
    let loaded = |line: &&LineLoad| line.load > 0.0;
    let ends = [lines.iter().find(loaded), lines.iter().rfind(loaded)];
    let edge =
        |line: Option<&LineLoad>, side: f64| line.map_or(0.0, |l| l.y + side * 0.5 * l.weight);
    let idle = |line: Option<&LineLoad>| line.is_some_and(|line| line.load <= 0.0);
    ContactEnds {
        at: [edge(ends[0], -1.0), edge(ends[1], 1.0)],
        open: [idle(lines.first()), idle(lines.last())],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_without_tension_carries_the_same_load() {
        let row = without_tension(vec![0.5, 0.4, -0.1, 0.2]);
        assert!(row.iter().all(|p| *p >= 0.0) && row[2] == 0.0, "{row:?}");
        assert!((row[0] + 2.0 * row[1..].iter().sum::<f64>() - 1.5).abs() < 1e-15, "{row:?}");
        assert_eq!(without_tension(vec![0.5, 0.1]), [0.5, 0.1]);
        assert_eq!(without_tension(vec![-0.5, 0.1]), [0.0, 0.0]);
    }
}
