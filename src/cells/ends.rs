//! What free end faces add to a mirrored half-space.
//!
//! R(k) = C(k) - C_mirrored(k), the compliance of a body with end faces free of traction less that of the half-space with one
//! image of every pressure in each face, is smooth but at the corner: panels of polynomials, graded towards the
//! end, carry it with a few nodes ([`crate::body`]), however many cells there are. With E the means of the panels' polynomials over
//! the cells, W the nodes' weights and 2 b the length of a cell,
//!
//! p_nodes = 2 b W^-1 E^T p_cells (least squares),    u_cells = E R p_nodes,
//!
//! which is symmetric as R W^-1 is. Across the contact R is a convolution with r(x) = (1/pi^2) int_0^inf R(k) cos(k x) dk,
//! taken at the cells' distances: it fades too slowly for a sum over the grid's own wavenumbers.

use super::grid::Grid;
use super::influence::EvenTransform;
use crate::base::{Panels, Parity, Wavenumbers};
use crate::body::{Body, End, Resolution, Shape};
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::f64::consts::PI;

/// A body with free end faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeBody {
    /// Half-length H (C).
    pub half: f64,
    /// Poisson's ratio.
    pub nu: f64,
    /// Share of the compliance.
    pub share: f64,
}

/// The mirrored half-space: what the cells' own images do.
const MIRRORED: End = End { image_weight: Some(1.0), freed: false, gamma: None };

/// End faces free of traction.
const FREED: End = End { image_weight: Some(1.0), freed: true, gamma: None };

/// R(k) of all bodies together at some wavenumbers, on the nodes of panels along half of the contact.
#[derive(Debug, Clone)]
pub(super) struct FreeEnds {
    axis: Panels,
    wavenumbers: Wavenumbers,
    /// (R - [`uniform`]) W^-1 at the coarse wavenumbers.
    matrices: Vec<DMatrix<f64>>,
    bodies: Vec<FreeBody>,
}

/// What long waves of uniform pressure displace in bodies that end, 2 pi / (k H) between any two places of the contact, faded beyond
/// 1/H: it grows too fast towards k = 0 to be interpolated.
fn uniform(bodies: &[FreeBody], k: f64) -> f64 {
    bodies.iter().map(|body| body.share * 2.0 * PI / (k * body.half) * (-k * body.half).exp()).sum()
}

impl FreeEnds {
    /// For a contact of half-length `half_length` whose fields are wanted up to the distance `width` apart.
    pub(super) fn new(half_length: f64, width: f64, bodies: &[FreeBody], tolerance: f64) -> Self {
        let resolution = Resolution::for_tolerance(tolerance);
        let axis = resolution.contact_axis(half_length);
        let longest = bodies.iter().fold(half_length, |m: f64, b| m.max(b.half));
        let wavenumbers = resolution.wavenumbers(longest).resolving(width);
        let pairs: Vec<_> = bodies
            .iter()
            .map(|body| {
                let shape = Shape { contact: half_length, half: body.half, nu: body.nu };
                (
                    body.share,
                    [FREED, MIRRORED].map(|end| Body::new(shape, end, Parity::Even, &resolution)),
                )
            })
            .collect();
        let remainder = |&k: &f64| {
            let mut sum = DMatrix::zeros(axis.len(), axis.len());
            for (share, [freed, mirrored]) in &pairs {
                sum += (freed.layer(k).compliance - mirrored.layer(k).compliance) * *share;
            }
            for (mut column, weight) in sum.column_iter_mut().zip(axis.weights()) {
                column /= *weight;
            }
            // Symmetric but for the error of the nodes.
            ((&sum + sum.transpose()) * 0.5).add_scalar(-uniform(bodies, k))
        };
        let matrices = wavenumbers.coarse().nodes().par_iter().map(remainder).collect();
        Self { axis, wavenumbers, matrices, bodies: bodies.to_vec() }
    }

    /// On the quarter of the cells of `grid`, for cosine transforms of length `mx` across the contact.
    pub(super) fn on_cells(&self, grid: &Grid, mx: usize) -> EndCorrection {
        let (a, b) = grid.half_sides();
        let nodes = self.axis.len();
        // Of each coarse wavenumber, and each of the cells' own, the share in the latter's matrix.
        let fine = self.wavenumbers.fine();
        let mut shares = vec![vec![0.0; mx + 1]; self.matrices.len()];
        let mut uniform_shares = vec![0.0; mx + 1];
        let mut transform = EvenTransform::new(mx);
        let add = |share: f64, wave: &[f64], into: &mut [f64]| {
            into.iter_mut().zip(wave).for_each(|(into, wave)| *into += share * wave);
        };
        for (i, (k, weight)) in fine.nodes().iter().zip(fine.weights()).enumerate() {
            let width = 2.0 * (k * a).sin() / k;
            let mut wave: Vec<f64> = (0..=mx)
                .map(|d| (k * 2.0 * a * d as f64).cos() * weight * width / (PI * PI))
                .collect();
            transform.apply(&mut wave);
            add(uniform(&self.bodies, *k), &wave, &mut uniform_shares);
            let (first, interpolation) = self.wavenumbers.interpolation(i);
            for (share, into) in interpolation.iter().zip(&mut shares[first..]) {
                add(*share, &wave, into);
            }
        }
        // The transform back across the contact is mx times the sequence.
        let scale = 2.0 * b / mx as f64;
        let mut matrices = vec![0.0; mx * nodes * nodes];
        matrices.par_chunks_mut(nodes * nodes).enumerate().for_each(|(k, into)| {
            into.fill(scale * uniform_shares[k]);
            for (share, matrix) in shares.iter().zip(&self.matrices) {
                let share = scale * share[k];
                into.iter_mut().zip(matrix.as_slice()).for_each(|(sum, m)| *sum += share * m);
            }
        });
        EndCorrection { means: means(&self.axis, grid), nodes, matrices }
    }
}

/// [`FreeEnds`] on the cells of a quarter, in the wavenumbers of their transform.
#[derive(Debug, Clone)]
pub(super) struct EndCorrection {
    /// E: for each cell along the line its nodes and their weights.
    means: Vec<Vec<(usize, f64)>>,
    nodes: usize,
    /// For each wavenumber 2 b R W^-1.
    matrices: Vec<f64>,
}

impl EndCorrection {
    /// Adds the displacement that the pressures `p(j)` of wavenumber `k` cause to `out`.
    pub(super) fn add(&self, k: usize, p: impl Fn(usize) -> f64, out: &mut [f64]) {
        let nodes = self.nodes;
        let (mut loads, mut moved) = (vec![0.0; nodes], vec![0.0; nodes]);
        for (j, means) in self.means.iter().enumerate() {
            let p = p(j);
            means.iter().for_each(|(node, mean)| loads[*node] += mean * p);
        }
        let matrix = &self.matrices[k * nodes * nodes..][..nodes * nodes];
        for (column, load) in matrix.chunks_exact(nodes).zip(&loads) {
            moved.iter_mut().zip(column).for_each(|(sum, m)| *sum += m * load);
        }
        for (out, means) in out.iter_mut().zip(&self.means) {
            *out += means.iter().map(|(node, mean)| mean * moved[*node]).sum::<f64>();
        }
    }
}

/// The means of the polynomials of `axis` over the cells on its half of the line.
fn means(axis: &Panels, grid: &Grid) -> Vec<Vec<(usize, f64)>> {
    let length = 2.0 * grid.half_sides().1;
    let order = axis.order();
    let of_cell = |j: usize| {
        let cell = [length * j as f64, length * (j + 1) as f64];
        let mut all = Vec::new();
        for panel in 0..axis.panel_count() {
            let [from, to] = axis.panel(panel);
            let (from, to) = (from.max(cell[0]), to.min(cell[1]));
            if to <= from {
                continue;
            }
            let start = all.len();
            all.extend((0..order).map(|i| (panel * order + i, 0.0)));
            let part = Panels::new(vec![from, to], order);
            for (y, weight) in part.nodes().iter().zip(part.weights()) {
                let values = axis.polynomials(panel, *y).map(|v| v * weight / length);
                all[start..].iter_mut().zip(values).for_each(|((_, mean), v)| *mean += v);
            }
        }
        all
    };
    (0..grid.ny / 2).map(of_cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_over_cells_are_those_of_polynomials() {
        let axis = Panels::new(vec![0.0, 1.7, 2.6, 3.0], 4);
        let grid = Grid::new(4, 10, 1.0, 3.0).unwrap();
        let all = means(&axis, &grid);
        let cubic = |y: f64| y * (1.0 - 0.3 * y * y);
        let integral = |y: f64| 0.5 * y * y - 0.075 * y.powi(4);
        for (j, means) in all.iter().enumerate() {
            let got: f64 = means.iter().map(|(node, m)| m * cubic(axis.nodes()[*node])).sum();
            let want = (integral(0.6 * (j + 1) as f64) - integral(0.6 * j as f64)) / 0.6;
            assert!((got - want).abs() < 1e-13, "{got} {want}");
        }
        // The cells add up to the line.
        let mut sums = vec![0.0; axis.len()];
        all.iter().flatten().for_each(|(node, mean)| sums[*node] += 0.6 * mean);
        for (sum, weight) in sums.iter().zip(axis.weights()) {
            assert!((sum - weight).abs() < 1e-13);
        }
    }
}
