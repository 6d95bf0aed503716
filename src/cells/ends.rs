//! What free end faces add to a mirrored half-space.
//!
//! R(k) = C(k) - C_mirrored(k), the compliance of a body with end faces free of traction less that of the half-space with one
//! image of every pressure in each face, is smooth but at the corner: panels of polynomials, graded towards the
//! end, carry it with a few nodes ([`crate::body`]), however many cells there are. With E the means of the panels' polynomials over
//! the cells, W the nodes' weights and 2 b the length of a cell,
//!
//! p_nodes = 2 b W^-1 E^T p_cells (least squares),    u_cells = E R p_nodes,
//!
//! which is symmetric as R W^-1 is. R fades within a few 1/k of the ends, so few shapes along the line make up all of it: the
//! eigenvectors of the sum of W^1/2 R W^-1/2 squared over the wavenumbers. Across the contact R is a convolution with r(x) = (1/pi^2) int_0^inf R(k) cos(k x) dk,
//! taken at the cells' distances: it fades too slowly for a sum over the grid's own wavenumbers.

use super::grid::Grid;
use super::influence::EvenTransform;
use crate::base::{Panels, Wavenumbers};
use crate::body::{End, Resolution, Shape, Stack};
use crate::contact;
use crate::stress::{Field, Load};
use nalgebra::{DMatrix, DVector};
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

/// Accuracy (p0) of the nodes that carry the free ends: the finest, as contacts of all lengths are few to set up.
const TOLERANCE: f64 = 1e-4;

/// Shapes along the line that displace less than this part of the largest one are left out.
const NEGLIGIBLE: f64 = 1e-5;

/// A body with free ends at the coarse wavenumbers.
#[derive(Debug)]
struct Freed {
    stack: Stack,
    /// Share of the compliance of all bodies like this one.
    share: f64,
}

/// R(k) of all bodies together at some wavenumbers, on the nodes of panels along half of the contact.
#[derive(Debug)]
pub struct FreeEnds {
    axis: Panels,
    wavenumbers: Wavenumbers,
    /// Bodies of one length and one Poisson's ratio are one.
    bodies: Vec<Freed>,
    /// B, a column for each of the few shapes along the line that R consists of.
    basis: DMatrix<f64>,
    /// r at the coarse wavenumbers, with (R - [`FreeEnds::uniform`]) W^-1 = B r B^T.
    matrices: Vec<DMatrix<f64>>,
}

impl FreeEnds {
    /// For a contact of half-length `half_length` (C) between `bodies`, of which some have free ends.
    pub fn new(half_length: f64, bodies: &[FreeBody]) -> Self {
        let resolution = Resolution::for_tolerance(TOLERANCE);
        let axis = resolution.contact_axis(half_length);
        let longest = bodies.iter().fold(half_length, |m: f64, b| m.max(b.half));
        let wavenumbers = resolution.wavenumbers(longest);
        let mut distinct: Vec<FreeBody> = Vec::new();
        for body in bodies {
            match distinct.iter_mut().find(|b| b.half == body.half && b.nu == body.nu) {
                Some(like) => like.share += body.share,
                None => distinct.push(*body),
            }
        }
        let mut sums = vec![DMatrix::zeros(axis.len(), axis.len()); wavenumbers.coarse().len()];
        let pairs = distinct.iter().map(|&FreeBody { half, nu, share }| {
            let (place, coarse) = ((0.0, Shape { half, nu }), wavenumbers.coarse().nodes());
            let [stack, mirrored] = [FREED, MIRRORED]
                .map(|end| Stack::new(&axis, (true, false), place, end, (&resolution, coarse)));
            for (i, sum) in sums.iter_mut().enumerate() {
                stack.add_compliance(i, share, sum);
                mirrored.add_compliance(i, -share, sum);
            }
            Freed { stack, share }
        });
        let bodies = pairs.collect();
        let basis = DMatrix::zeros(0, 0);
        let mut ends = Self { bodies, axis, wavenumbers, basis, matrices: Vec::new() };
        let roots =
            DVector::from_iterator(ends.axis.len(), ends.axis.weights().iter().map(|w| w.sqrt()));
        let nodes = ends.wavenumbers.coarse().nodes().iter();
        let all: Vec<_> = nodes.zip(sums).map(|(k, sum)| ends.remainder(*k, sum, &roots)).collect();
        let shapes = shapes(&all, ends.wavenumbers.coarse().weights());
        ends.matrices = all.par_iter().map(|matrix| shapes.tr_mul(&(matrix * &shapes))).collect();
        ends.basis = scaled(shapes, &roots, |value, root| value / root);
        ends
    }

    /// W^1/2 (R - [`FreeEnds::uniform`]) W^-1/2 of the compliance `r` at `k`, with the square `roots` of the weights.
    fn remainder(&self, k: f64, r: DMatrix<f64>, roots: &DVector<f64>) -> DMatrix<f64> {
        let columns = scaled(r.transpose(), roots, |value, root| value / root);
        let sum = scaled(columns.transpose(), roots, |value, root| value * root);
        let uniform = roots * roots.transpose() * self.uniform(k);
        // R is symmetric, but the strips in the place of far images carry the mean of a pressure: right
        // at the place that moves, not at the one that is pressed. The symmetric part therefore gets
        // the displacement by a uniform pressure.
        let symmetric = (&sum + sum.transpose()) * 0.5;
        let missing = (&sum - &symmetric) * roots / roots.norm_squared();
        let both = &missing * roots.transpose() + roots * missing.transpose();
        symmetric + both - uniform
    }

    /// Memory of the correction on `grid` (bytes).
    pub(super) fn bytes(&self, grid: &Grid) -> f64 {
        8.0 * grid.nx as f64 * (self.matrices.len() + self.basis.ncols().pow(2)) as f64
    }

    /// What long waves of uniform pressure displace in bodies that end, 2 pi / (k H) between any two places of the contact, faded beyond
    /// 1/H: it grows too fast towards k = 0 to be interpolated.
    fn uniform(&self, k: f64) -> f64 {
        let of = |freed: &Freed| {
            let half = freed.stack.body().half;
            freed.share * 2.0 * PI / (k * half) * (-k * half).exp()
        };
        self.bodies.iter().map(of).sum()
    }

    /// The wavenumbers for fields over the cells of `grid`, which are padded to twice their extent.
    fn resolving(&self, grid: &Grid) -> Wavenumbers {
        self.wavenumbers.resolving(4.0 * grid.half_width)
    }

    /// Axis along half of the contact.
    pub fn axis(&self) -> &Panels {
        &self.axis
    }

    /// Wavenumbers across the contact.
    pub fn wavenumbers(&self) -> &Wavenumbers {
        &self.wavenumbers
    }

    /// Whether all bodies are alike.
    pub fn shared(&self) -> bool {
        self.bodies.len() == 1
    }

    /// The stresses in the body of half-length `half` (C) and Poisson's ratio `nu`, one of those given, under `pressure` with its
    /// [`Load::moments`] over [`FreeEnds::wavenumbers`]; contributions below `tolerance` (p0) are neglected.
    pub fn field<'a>(
        &'a self,
        (half, nu): (f64, f64),
        pressure: &'a dyn Load,
        moments: &DMatrix<f64>,
        tolerance: f64,
    ) -> Field<'a> {
        let own = |freed: &&Freed| {
            let body = freed.stack.body();
            body.half == half && body.nu == nu
        };
        let freed = self.bodies.iter().find(own).expect("one of the bodies");
        Field::new(&freed.stack, &self.wavenumbers, pressure, moments, None, tolerance)
    }

    /// Mean displacement along the line (C^2 / (2 R)) that the free ends add at `depth` (C), as the approach of contacts on
    /// `grid` has it; see [`contact::reference`].
    pub(super) fn reference(&self, pressure: &dyn Load, grid: &Grid, depth: f64) -> f64 {
        let wavenumbers = self.resolving(grid);
        let compliance = |(matrix, k): (&DMatrix<f64>, &f64)| {
            let remainder = &self.basis * matrix * self.basis.transpose();
            let mut whole = remainder.add_scalar(self.uniform(*k));
            for (mut column, weight) in whole.column_iter_mut().zip(self.axis.weights()) {
                column *= *weight;
            }
            whole
        };
        let all = self.matrices.iter().zip(self.wavenumbers.coarse().nodes());
        let matrices: Vec<DMatrix<f64>> = all.map(compliance).collect();
        let compliance = contact::Compliance { wavenumbers: &wavenumbers, matrices: &matrices };
        let transform = |k: f64| pressure.transforms(&[k]).column(0).into_owned();
        contact::reference(&compliance, transform, depth)
    }

    /// On the quarter of the cells of `grid`, for cosine transforms of length `mx` across the contact.
    pub(super) fn on_cells(&self, grid: &Grid, mx: usize) -> EndCorrection {
        let (a, b) = grid.half_sides();
        let rank = self.basis.ncols();
        let wavenumbers = self.resolving(grid);
        // Of each coarse wavenumber, and each of the cells' own, the share in the latter's matrix.
        let fine = wavenumbers.fine();
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
            add(self.uniform(*k), &wave, &mut uniform_shares);
            let (first, interpolation) = wavenumbers.interpolation(i);
            for (share, into) in interpolation.iter().zip(&mut shares[first..]) {
                add(*share, &wave, into);
            }
        }
        // The transform back across the contact is mx times the sequence.
        let scale = 2.0 * b / mx as f64;
        let mut matrices = vec![0.0; mx * rank * rank];
        matrices.par_chunks_mut(rank * rank).enumerate().for_each(|(k, into)| {
            for (share, matrix) in shares.iter().zip(&self.matrices) {
                let share = scale * share[k];
                into.iter_mut().zip(matrix.as_slice()).for_each(|(sum, m)| *sum += share * m);
            }
        });
        let of_cell = |means: &Vec<(usize, f64)>| -> Vec<f64> {
            let shape =
                |i: usize| means.iter().map(|(node, mean)| mean * self.basis[(*node, i)]).sum();
            (0..rank).map(shape).collect()
        };
        EndCorrection {
            shapes: means(&self.axis, grid).iter().flat_map(of_cell).collect(),
            rank,
            matrices,
            uniform: uniform_shares.iter().map(|share| scale * share).collect(),
        }
    }
}

/// The eigenvectors that all of the symmetric `matrices` consist of, those of the sum of their squares.
fn shapes(matrices: &[DMatrix<f64>], weights: &[f64]) -> DMatrix<f64> {
    let n = matrices[0].nrows();
    let squares = matrices.iter().zip(weights).map(|(matrix, weight)| matrix * matrix * *weight);
    let sum = squares.fold(DMatrix::zeros(n, n), |sum, square| sum + square);
    let eigen = sum.symmetric_eigen();
    let most = eigen.eigenvalues.max();
    let wanted = |i: &usize| eigen.eigenvalues[*i] > NEGLIGIBLE * NEGLIGIBLE * most;
    let columns: Vec<_> = (0..n).filter(wanted).map(|i| eigen.eigenvectors.column(i)).collect();
    DMatrix::from_columns(&columns)
}

/// The rows of `matrix` combined with the numbers of `scales` by `with`.
fn scaled(
    mut matrix: DMatrix<f64>,
    scales: &DVector<f64>,
    with: fn(f64, f64) -> f64,
) -> DMatrix<f64> {
    for mut column in matrix.column_iter_mut() {
        column
            .iter_mut()
            .zip(scales.iter())
            .for_each(|(value, scale)| *value = with(*value, *scale));
    }
    matrix
}

/// [`FreeEnds`] on the cells of a quarter, in the wavenumbers of their transform.
#[derive(Debug, Clone)]
pub(super) struct EndCorrection {
    /// E B: for each cell along the line the mean of each shape.
    shapes: Vec<f64>,
    rank: usize,
    /// For each wavenumber 2 b r.
    matrices: Vec<f64>,
    /// For each wavenumber 2 b times [`FreeEnds::uniform`].
    uniform: Vec<f64>,
}

impl EndCorrection {
    /// Adds the displacement that the pressures `p(j)` of wavenumber `k` cause to `out`.
    pub(super) fn add(&self, k: usize, p: impl Fn(usize) -> f64, out: &mut [f64]) {
        let rank = self.rank;
        let (mut loads, mut moved) = (vec![0.0; rank], vec![0.0; rank]);
        let mut total = 0.0;
        for (j, shapes) in self.shapes.chunks_exact(rank).enumerate() {
            let p = p(j);
            total += p;
            loads.iter_mut().zip(shapes).for_each(|(load, shape)| *load += shape * p);
        }
        let matrix = &self.matrices[k * rank * rank..][..rank * rank];
        for (column, load) in matrix.chunks_exact(rank).zip(&loads) {
            moved.iter_mut().zip(column).for_each(|(sum, m)| *sum += m * load);
        }
        let uniform = self.uniform[k] * total;
        for (out, shapes) in out.iter_mut().zip(self.shapes.chunks_exact(rank)) {
            *out += uniform + shapes.iter().zip(&moved).map(|(shape, m)| shape * m).sum::<f64>();
        }
    }
}

/// The means of the polynomials of `axis` over the cells on its half of the line.
pub(super) fn means(axis: &Panels, grid: &Grid) -> Vec<Vec<(usize, f64)>> {
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
