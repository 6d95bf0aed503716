//! The linear problem of a contact with fixed half-widths, by Galerkin's method: the gap's means
//! under each node's modes vanish.
//!
//! What higher modes would do is then left out alike at all nodes, whatever their unknowns. By
//! collocation at points of their own, nodes with an independent half-width and their neighbours
//! differed by 3e-4 p0 at 0.03 C from an end, by 1e-3 p0 at 0.01 C.

use super::layout::Layout;
use super::operator::{LineOperator, screened};
use super::problem::{Motion, Problem};
use crate::base::{Error, Result, linear};
use crate::kernels::strip;
use multiversion::{multiversion, target::target_cfg_f};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;
use std::ops::Range;

/// Modes of a node that are summed side by side.
const TILE: usize = 4;
type Tile = [f64; TILE];

/// The linear problem for fixed half-widths. The unknowns are those of each node, then the
/// approach.
pub(super) struct LinearProblem<'a> {
    pub operator: &'a LineOperator<'a>,
    pub problem: &'a Problem<'a>,
    pub layout: &'a Layout,
    pub half_widths: &'a [f64],
    pub slopes: &'a [f64],
}

impl LinearProblem<'_> {
    /// The unknowns of the nodes, then the rigid motions.
    pub fn solve(&self) -> Result<DVector<f64>> {
        let motions = self.problem.motions();
        let size = self.layout.len() + motions.len();
        let mut matrix = DMatrix::zeros(size, size);
        let mut right = DMatrix::zeros(size, 1);
        self.add_waves(&mut matrix);
        self.add_local(&mut matrix, &mut right);
        for (at, motion) in (self.layout.len()..).zip(&motions) {
            self.add_motion(at, motion, &mut matrix);
            right[at] = motion.resultant;
        }
        let solution = linear::solve(matrix, right).ok_or_else(|| Error::NotConverged {
            iterations: 0,
            residual: f64::INFINITY,
            remedy:
                "the contact's equations are singular: check the case's lengths, and how near its \
                     load is to an end, or take --engine cells"
                    .into(),
        })?;
        Ok(solution.column(0).into_owned())
    }

    /// Number of fine wavenumbers.
    fn wavenumbers(&self) -> usize {
        self.operator.compliance.wavenumbers.fine().len()
    }

    /// Adds the displacements from the remainders of the compliance.
    fn add_waves(&self, matrix: &mut DMatrix<f64>) {
        let (layout, all) = (self.layout, self.wavenumbers());
        let nodes = 0..self.operator.axis.len();
        let transforms: Vec<Vec<Tile>> = nodes.clone().map(|j| self.transforms(j)).collect();
        let tests: Vec<Vec<Tile>> =
            nodes.zip(&transforms).map(|(i, transforms)| self.tests(i, transforms)).collect();
        for (j, transforms) in transforms.iter().enumerate() {
            let columns = self.columns(j);
            for (i, tests) in tests.iter().enumerate() {
                let entries = &self.operator.entries(i, j)[..self.operator.count(i, j)];
                let rows = layout.unknowns(i);
                for (columns, transforms) in columns.chunks(TILE).zip(transforms.chunks_exact(all))
                {
                    for (row, tests) in rows.clone().step_by(TILE).zip(tests.chunks_exact(all)) {
                        let sums = sum_waves(entries, transforms, tests);
                        add_tile(matrix, row..rows.end.min(row + TILE), columns, &sums);
                    }
                }
            }
        }
    }

    /// Columns and factors of node `j`'s modes, the singular one last.
    fn columns(&self, j: usize) -> Vec<Vec<(usize, f64)>> {
        let mut columns = self.layout.mode_parts(j);
        columns.push(self.layout.singular_parts(j, self.slopes).collect());
        columns
    }

    /// Fourier transforms of node `j`'s modes, the singular one last, tile by tile at all
    /// wavenumbers; zero where a wavenumber is negligible.
    fn transforms(&self, j: usize) -> Vec<Tile> {
        let (all, fine) = (self.wavenumbers(), self.operator.compliance.wavenumbers.fine());
        let counts = (0..self.operator.axis.len())
            .map(|i| self.operator.count(i, j).max(self.operator.count(j, i)));
        let count = counts.max().unwrap_or(0);
        let mut modes = vec![0.0; self.layout.counts[j]];
        let mut tiles = vec![[0.0; TILE]; (modes.len() + 1).div_ceil(TILE) * all];
        for (at, k) in fine[..count].iter().enumerate() {
            let singular = strip::transforms(self.half_widths[j], *k, &mut modes);
            for (mode, transform) in modes.iter().chain([&singular]).enumerate() {
                tiles[mode / TILE * all + at][mode % TILE] = *transform;
            }
        }
        tiles
    }

    /// The means of waves under the modes of node `i`'s equations, from the `transforms` of its
    /// modes and in their form, times the weights of the quadrature over wavenumbers.
    fn tests(&self, i: usize, transforms: &[Tile]) -> Vec<Tile> {
        let (all, weights) = (self.wavenumbers(), self.operator.compliance.wavenumbers.weights());
        let (rows, own) = (self.layout.unknowns(i).len(), self.layout.modes(i).len());
        let mut tiles = vec![[0.0; TILE]; rows.div_ceil(TILE) * all];
        for row in 0..rows {
            let (mode, size) =
                if row < own { (row, PI / 2.0) } else { (self.layout.counts[i], PI) };
            let per_weight = 1.0 / (PI * PI * size * self.half_widths[i]);
            let from = transforms[mode / TILE * all..].iter().map(|tile| tile[mode % TILE]);
            let to = tiles[row / TILE * all..].iter_mut().map(|tile| &mut tile[row % TILE]);
            for ((to, from), w) in to.zip(from).zip(weights) {
                *to = per_weight * w * from;
            }
        }
        tiles
    }

    /// Adds an unknown rigid motion in column `at`, and its equation in row `at`.
    fn add_motion(&self, at: usize, motion: &Motion, matrix: &mut DMatrix<f64>) {
        let (layout, axis) = (self.layout, self.operator.axis);
        matrix[(at, at)] = motion.own;
        for (i, ((&y, w), a)) in
            axis.nodes().iter().zip(axis.weights()).zip(self.half_widths).enumerate()
        {
            let displaced = (motion.displacement)(y);
            // The means of a uniform displacement.
            let (modes, rows) = (layout.modes(i), layout.unknowns(i));
            for row in modes.clone().take(1).chain(modes.end..rows.end) {
                matrix[(row, at)] = -displaced;
            }
            let carried = motion.share * w * displaced * a * PI;
            if let Some(first) = layout.modes(i).next() {
                matrix[(at, first)] = 0.5 * carried;
            }
            for (column, factor) in layout.singular_parts(i, self.slopes) {
                matrix[(at, column)] += carried * factor;
            }
        }
    }

    /// Adds the plane, screened part and the gap.
    fn add_local(&self, matrix: &mut DMatrix<f64>, right: &mut DMatrix<f64>) {
        let layout = self.layout;
        for (i, &a) in self.half_widths.iter().enumerate() {
            let columns = self.columns(i);
            // Of the node's modes, and of the singular one.
            let mut modes = vec![0.0; layout.counts[i]];
            for (t, tests) in points(layout.modes(i).len(), layout.counts[i]) {
                let mut singular = 2.0 / PI * strip::logarithmic(a, t, &mut modes);
                modes.iter_mut().for_each(|sum| *sum *= 2.0 / PI);
                for ([_, sin, turn], weight) in screened(a, t) {
                    // sqrt(1-t^2) U_2m = sin((2m+1) f), by the recurrence in steps of 2 f.
                    let (mut before, mut here) = (-sin, sin);
                    for sum in &mut modes {
                        *sum += weight * here * sin;
                        (before, here) = (here, turn * here - before);
                    }
                    singular += weight;
                }
                let gap = self.problem.gap(a * t, self.operator.axis.nodes()[i]);
                for (row, test) in layout.unknowns(i).zip(tests) {
                    for (columns, displaced) in columns.iter().zip(modes.iter().chain([&singular]))
                    {
                        for (column, factor) in columns {
                            matrix[(row, *column)] += test * factor * displaced;
                        }
                    }
                    right[row] -= test * gap;
                }
            }
        }
    }
}

/// Points t in (0, 1) of Gauss-Chebyshev's rule, and at each the weights of the means under `own`
/// modes and the singular one: exact for what `all` modes displace by the logarithm, polynomials of
/// degree 2 `all`.
fn points(own: usize, all: usize) -> impl Iterator<Item = (f64, Vec<f64>)> {
    let count = all + 1;
    (0..count).map(move |q| {
        let angle = PI * (2 * q + 1) as f64 / (4 * count) as f64;
        let modes = (0..own).map(|m| 2.0 * angle.sin() * ((2 * m + 1) as f64 * angle).sin());
        (angle.cos(), modes.chain([1.0]).map(|test| test / count as f64).collect())
    })
}

/// Adds the sums of a tile's modes, with these `columns` and factors, to the equations `rows` of
/// its tests.
fn add_tile(
    matrix: &mut DMatrix<f64>,
    rows: Range<usize>,
    columns: &[Vec<(usize, f64)>],
    sums: &[Tile; TILE],
) {
    for (columns, sums) in columns.iter().zip(sums) {
        for (column, factor) in columns {
            for (row, sum) in rows.clone().zip(sums) {
                matrix[(row, *column)] += factor * sum;
            }
        }
    }
}

/// Sums over wavenumbers of transform times test times entry, for each transform and each test of a
/// tile; compiled for the processor's vector units.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn sum_waves(entries: &[f64], transforms: &[Tile], tests: &[Tile]) -> [Tile; TILE] {
    let times = |a: f64, b: f64, c: f64| -> f64 {
        if target_cfg_f!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
    };
    let mut sums = [[0.0; TILE]; TILE];
    for ((entry, transforms), tests) in entries.iter().zip(transforms).zip(tests) {
        let displaced = tests.map(|test| entry * test);
        for mode in 0..TILE {
            for test in 0..TILE {
                sums[mode][test] = times(transforms[mode], displaced[test], sums[mode][test]);
            }
        }
    }
    sums
}
