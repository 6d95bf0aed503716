//! The pressure along the line that the pressures of cells are the means of.
//!
//! Stresses on the surface and beside the contact's end follow the pressure at a place, which steps
//! from cell to cell. Where the pressure is smooth along the line, its means over a cell and both
//! neighbours tell it better: it is taken as
//!
//! p(y) = (S - y)^-m (S + y)^-m' (c_0 + c_1 y + c_2 y^2)
//!
//! with the c that give the three means, and m and m' the exponents of the pressure at the
//! contact's ends, zero where it is finite ([`crate::body::corner_exponent`]). Each cell keeps its
//! load.

use super::grid::Grid;
use super::means::{Part, integrals, parts};
use super::pressure::CellPressure;
use crate::base::Panels;
use nalgebra::{DMatrix, Matrix3};

/// Means that make up the pressure in a cell.
const MEANS: usize = 3;

/// Integrals over a cell with each polynomial of the axis that is not zero there: nodes, and the
/// integrals.
type Integrals = Vec<(usize, f64)>;

/// What a cell's pressures add to the loads on the nodes of an axis.
struct CellLoads {
    /// By the uniform pressure one.
    uniform: Integrals,
    /// The first cell of those whose means count, and what the pressure adds that has the mean one
    /// over one of them and zero over the others; none where pressures are uniform, and with too
    /// few cells.
    smooth: Option<(usize, [Integrals; MEANS])>,
}

/// The pressures that `of` makes of the rows of cells for each of `count` places across, at the
/// nodes of an axis by least squares: a row for each node. With `exponents` they are smooth along
/// the line and go like s^-m at the distance s from its ends, m of `exponents`, zero where they are
/// finite; only in a cell that is not pressed, or next to one, are they uniform, as the contact's
/// edge is there. Without they are uniform in every cell.
pub(super) fn nodal(
    cells: &CellPressure,
    axis: &Panels,
    symmetric: bool,
    exponents: Option<[f64; 2]>,
    count: usize,
    of: impl Fn(&[f64], usize) -> f64,
) -> DMatrix<f64> {
    let grid = &cells.grid;
    let first = if symmetric { grid.ny / 2 } else { 0 };
    let rows: Vec<&[f64]> = cells.pressure.chunks_exact(grid.nx).skip(first).collect();
    let mut loads = DMatrix::zeros(axis.len(), count);
    for (row, own) in rows.iter().zip(cell_loads(axis, grid, symmetric, exponents)) {
        for i in 0..count {
            let mut add = |integrals: &Integrals, p: f64| {
                integrals.iter().for_each(|(node, integral)| loads[(*node, i)] += integral * p);
            };
            let near = own.smooth.as_ref().map(|(first, by_mean)| {
                (std::array::from_fn::<f64, MEANS, _>(|l| of(rows[first + l], i)), by_mean)
            });
            match near {
                Some((means, by_mean)) if means.iter().all(|p| *p != 0.0) => {
                    by_mean.iter().zip(means).for_each(|(integrals, p)| add(integrals, p));
                }
                _ => add(&own.uniform, of(row, i)),
            }
        }
    }
    for (mut row, weight) in loads.row_iter_mut().zip(axis.weights()) {
        row /= *weight;
    }
    loads
}

/// The loads of each cell along the line.
fn cell_loads(
    axis: &Panels,
    grid: &Grid,
    symmetric: bool,
    exponents: Option<[f64; 2]>,
) -> Vec<CellLoads> {
    let (length, end) = (2.0 * grid.half_sides().1, grid.half_length);
    let cells = parts(axis, grid, symmetric);
    let of_cell = |j: usize| {
        let cell = &cells[j];
        let smooth = exponents.filter(|_| cells.len() >= MEANS).map(|[low, high]| {
            let singular = |y: f64| (end + y).powf(-low) * (end - y).powf(-high);
            let first = j.clamp(1, cells.len() - 2) - 1;
            let from = cell[0].1.panel(0)[0];
            let powers = |y: f64| [0, 1, 2].map(|n| ((y - from) / length).powi(n) * singular(y));
            let mean = |cell: &[Part], n: usize| -> f64 {
                let part = |(_, part): &Part| -> f64 {
                    let nodes = part.nodes().iter().zip(part.weights());
                    nodes.map(|(y, weight)| powers(*y)[n] * weight / length).sum()
                };
                cell.iter().map(part).sum()
            };
            let means = Matrix3::from_fn(|l, n| mean(&cells[first + l], n));
            let inverse = means.try_inverse().expect("three functions with different means");
            let by_mean = std::array::from_fn(|l| {
                let shape = |y: f64| {
                    powers(y).iter().zip(inverse.column(l).iter()).map(|(f, c)| f * c).sum()
                };
                integrals(axis, cell, shape)
            });
            (first, by_mean)
        });
        CellLoads { uniform: integrals(axis, cell, |_| 1.0), smooth }
    };
    (0..cells.len()).map(of_cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Panels between the edges of cells of length 0.5 over [-2, 2], the outer ones graded towards
    /// the ends.
    fn axis() -> Panels {
        let outer = (0..30).map(|i| 0.5f64.powi(i + 1));
        let mut breaks: Vec<f64> = outer.flat_map(|s| [s - 2.0, 2.0 - s]).collect();
        breaks.extend((-4..=4).map(|i| 0.5 * f64::from(i)));
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        Panels::new(breaks, 6)
    }

    /// One column of cells with these means.
    fn of(means: &[f64], exponents: [f64; 2]) -> Vec<f64> {
        let grid = Grid::new(4, means.len(), 1.0, 2.0).unwrap();
        let pressure = means.iter().flat_map(|p| [*p; 4]).collect();
        let cells = CellPressure::of(grid, pressure);
        nodal(&cells, &axis(), false, Some(exponents), 1, |row, _| row[0])
            .column(0)
            .iter()
            .copied()
            .collect()
    }

    #[test]
    fn means_of_a_singular_pressure_give_the_pressure() {
        let p =
            |y: f64| (2.0 + y).powf(-0.5) * (2.0 - y).powf(-0.226) * (1.0 + 0.2 * y - 0.1 * y * y);
        // With y = 2 - t^4 and y = t^4 - 2 on either half, where the integrands are smooth.
        let mean = |j: i32| {
            let (from, to) = (0.5 * f64::from(j) - 2.0, 0.5 * f64::from(j) - 1.5);
            let side = if j < 4 { 1.0 } else { -1.0 };
            let mut ends = [from, to].map(|y| (2.0 + side * y).powf(0.25));
            ends.sort_by(f64::total_cmp);
            let part = Panels::new(ends.to_vec(), 30);
            let nodes = part.nodes().iter().zip(part.weights());
            nodes.map(|(t, w)| w * 4.0 * t.powi(3) * p(side * (t.powi(4) - 2.0)) / 0.5).sum::<f64>()
        };
        let means: Vec<f64> = (0..8).map(mean).collect();
        for (y, got) in axis().nodes().iter().zip(of(&means, [0.5, 0.226])) {
            // The axis's own rule misses some 1e-5 of the integral next to the singular end.
            assert!((got / p(*y) - 1.0).abs() < 1e-4, "{y}: {got} {}", p(*y));
        }
    }

    #[test]
    fn cells_keep_their_loads_and_edges_of_the_contact_their_steps() {
        let means = [0.0, 0.0, 0.4, 0.9, 1.0, 1.1, 0.7, 2.0];
        let got = of(&means, [0.226, 0.0]);
        let axis = axis();
        for (j, p) in means.iter().enumerate() {
            let from = 0.5 * j as f64 - 2.0;
            let nodes = || axis.nodes().iter().zip(axis.weights()).zip(&got);
            let inside = || nodes().filter(|((y, _), _)| (from..from + 0.5).contains(*y));
            let load: f64 = inside().map(|((_, weight), p)| weight * p).sum();
            assert!((load - 0.5 * p).abs() < 1e-13, "{j}: {load}");
            let steps = inside().all(|(_, value)| (value - p).abs() < 1e-12);
            assert_eq!(steps, j < 3, "{j}");
        }
    }
}
