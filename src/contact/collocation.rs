//! The linear problem of a contact with fixed half-widths.

use super::layout::Layout;
use super::operator::{LineOperator, screened};
use super::problem::{Motion, Problem};
use crate::base::{Error, Result, linear};
use crate::kernels::strip;
use multiversion::{multiversion, target::target_cfg_f};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;
use std::ops::Range;

/// Points of a node, or modes of one, that are summed side by side.
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
            remedy: "the collocation matrix is singular: check the case's lengths, and how near \
                     its load is to an end, or take --engine cells"
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
        let cosines: Vec<Vec<Tile>> = nodes.clone().map(|i| self.cosines(i)).collect();
        for j in nodes {
            let transforms = self.transforms(j);
            let columns = self.columns(j);
            for (i, cosines) in cosines.iter().enumerate() {
                let entries = &self.operator.entries(i, j)[..self.operator.count(i, j)];
                let rows = layout.unknowns(i);
                for (columns, transforms) in columns.chunks(TILE).zip(transforms.chunks_exact(all))
                {
                    for (row, cosines) in rows.clone().step_by(TILE).zip(cosines.chunks_exact(all))
                    {
                        let sums = sum_waves(entries, transforms, cosines);
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

    /// Cosines at the points of node `i`, tile by tile at all wavenumbers; zero where a wavenumber
    /// is negligible.
    fn cosines(&self, i: usize) -> Vec<Tile> {
        let (all, fine) = (self.wavenumbers(), self.operator.compliance.wavenumbers.fine());
        let count =
            (0..self.operator.axis.len()).map(|j| self.operator.count(i, j)).max().unwrap_or(0);
        let mut tiles = vec![[0.0; TILE]; self.layout.unknowns(i).len().div_ceil(TILE) * all];
        for (point, t) in self.layout.points(i).enumerate() {
            let relevant = tiles[point / TILE * all..].iter_mut().zip(&fine.nodes()[..count]);
            for (tile, k) in relevant {
                tile[point % TILE] = (k * self.half_widths[i] * t).cos();
            }
        }
        tiles
    }

    /// Transforms of node `j`'s modes, the singular one last, times the quadrature's weights, in
    /// the form of [`LinearProblem::cosines`].
    fn transforms(&self, j: usize) -> Vec<Tile> {
        let (all, numbers) = (self.wavenumbers(), self.operator.compliance.wavenumbers);
        let count =
            (0..self.operator.axis.len()).map(|i| self.operator.count(i, j)).max().unwrap_or(0);
        let mut modes = vec![0.0; self.layout.counts[j]];
        let mut tiles = vec![[0.0; TILE]; (modes.len() + 1).div_ceil(TILE) * all];
        for (at, (k, w)) in
            numbers.fine().nodes().iter().zip(numbers.weights()).take(count).enumerate()
        {
            let singular = strip::transforms(self.half_widths[j], *k, &mut modes);
            for (mode, transform) in modes.iter().chain([&singular]).enumerate() {
                tiles[mode / TILE * all + at][mode % TILE] = w / (PI * PI) * transform;
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
            for row in layout.unknowns(i) {
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
            for (row, t) in layout.unknowns(i).zip(layout.points(i)) {
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
                for (columns, displaced) in columns.iter().zip(modes.iter().chain([&singular])) {
                    for (column, factor) in columns {
                        matrix[(row, *column)] += factor * displaced;
                    }
                }
                right[row] = -self.problem.gap(a * t, self.operator.axis.nodes()[i]);
            }
        }
    }
}

/// Adds the sums of a tile's modes, with these `columns` and factors, to the equations `rows` of
/// its points.
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

/// Sums over wavenumbers of transform times cosine times entry, for each transform and each cosine
/// of a tile; compiled for the processor's vector units.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn sum_waves(entries: &[f64], transforms: &[Tile], cosines: &[Tile]) -> [Tile; TILE] {
    let times = |a: f64, b: f64, c: f64| -> f64 {
        if target_cfg_f!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
    };
    let mut sums = [[0.0; TILE]; TILE];
    for ((entry, transforms), cosines) in entries.iter().zip(transforms).zip(cosines) {
        let displaced = cosines.map(|c| entry * c);
        for mode in 0..TILE {
            for point in 0..TILE {
                sums[mode][point] = times(transforms[mode], displaced[point], sums[mode][point]);
            }
        }
    }
    sums
}
