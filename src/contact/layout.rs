//! The unknowns of the nodes along the line.

use super::problem::Problem;
use super::settings::ContactSettings;
use crate::kernels::strip;
use nalgebra::DVector;
use std::f64::consts::PI;
use std::ops::Range;

/// Distance from the line's end (C) beyond which a few modes describe the pressure.
const DISTURBED: f64 = 1.0;
const INNER_MODES: usize = 3;

/// Points across the contact at which the sign of a pressure is checked.
const SHAPE_POINTS: i32 = 8;

/// Limit of the ratio of a node's edge slope to that of a free node, with which its singular
/// amplitude scales.
const STEEPEST: f64 = 10.0;

/// The unknowns of each node. Free nodes have all modes and the singular one, whose amplitude
/// determines the change of their half-width. Next to the end of the line the nodes are closer than
/// the shortest wave, and independent half-widths would be noise. They are interpolated linearly
/// from those of the free nodes, at least `spacing` apart. A node beyond the last free one whose
/// pressure would be tensile loses modes, the higher ones first; with none left it carries no
/// pressure.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    /// The free nodes, ascending.
    pub free: Vec<usize>,
    /// The half-width of each node from those of the free nodes: positions in `free`, and shares.
    pub shares: Vec<[(usize, f64); 2]>,
    /// Modes of each node.
    pub counts: Vec<usize>,
    /// The first unknown of each node, and the end.
    starts: Vec<usize>,
}

impl Layout {
    /// All modes everywhere.
    pub fn new(problem: &Problem, settings: &ContactSettings) -> Self {
        let axis = problem.axis;
        let mut limit = f64::INFINITY;
        let mut free = Vec::new();
        for (j, &y) in axis.nodes().iter().enumerate().rev() {
            let apart = y <= limit && problem.distance_to_end(y) >= settings.spacing;
            if apart || j == 0 && free.is_empty() {
                free.push(j);
                limit = y - settings.spacing;
            }
        }
        free.reverse();
        let shares = axis
            .nodes()
            .iter()
            .enumerate()
            .map(|(j, y)| {
                let after = free.partition_point(|f| *f < j);
                if after == 0 || free.len() == 1 {
                    return [(0, 1.0), (0, 0.0)];
                }
                let before = after.min(free.len() - 1) - 1;
                let [a, b] = [before, before + 1].map(|i| axis.nodes()[free[i]]);
                let share = (y - a) / (b - a);
                [(before, 1.0 - share), (before + 1, share)]
            })
            .collect();
        let modes_at = |y: &f64| match problem.distance_to_end(*y) > DISTURBED {
            true => settings.modes.min(INNER_MODES),
            false => settings.modes,
        };
        let counts = axis.nodes().iter().map(modes_at).collect();
        let mut layout = Self { free, shares, counts, starts: Vec::new() };
        layout.number();
        layout
    }

    /// Numbers the unknowns.
    fn number(&mut self) {
        let mut next = 0;
        self.starts.clear();
        for (j, modes) in self.counts.iter().enumerate() {
            self.starts.push(next);
            next += modes + usize::from(self.is_free(j));
        }
        self.starts.push(next);
    }

    fn is_free(&self, j: usize) -> bool {
        self.free.binary_search(&j).is_ok()
    }

    /// Unknowns and collocation equations of node `j`: its modes, then the singular one if it is
    /// free.
    pub fn unknowns(&self, j: usize) -> Range<usize> {
        self.starts[j]..self.starts[j + 1]
    }

    /// The modes of node `j`.
    pub fn modes(&self, j: usize) -> Range<usize> {
        self.starts[j]..self.starts[j] + self.counts[j]
    }

    /// The singular mode of the free node `j`.
    pub fn singular(&self, j: usize) -> usize {
        self.starts[j + 1] - 1
    }

    /// Unknowns of all nodes; those of rigid motions follow.
    pub fn len(&self) -> usize {
        self.starts[self.counts.len()]
    }

    /// The amplitude of node `j`'s singular mode in terms of those of the free nodes: columns and
    /// factors. A relative change of the half-width changes the amplitudes in proportion to the
    /// edge slopes.
    pub fn singular_parts(&self, j: usize, slopes: &[f64]) -> impl Iterator<Item = (usize, f64)> {
        let own = slopes[j];
        self.shares[j]
            .map(|(position, share)| {
                let free = self.free[position];
                let ratio = if free == j { 1.0 } else { (own / slopes[free]).clamp(0.0, STEEPEST) };
                (self.singular(free), share * ratio)
            })
            .into_iter()
            .filter(|(_, factor)| *factor != 0.0)
    }

    /// Collocation points of node `j`, as t in (0, 1): zeros of T_2n with the singular mode,
    /// otherwise those of U_2n, the points of Gauss's rule for the weight sqrt(1 - t^2).
    pub fn points(&self, j: usize) -> impl Iterator<Item = f64> {
        let count = self.unknowns(j).len();
        let free = self.is_free(j);
        (0..count).map(move |l| {
            let angle = if free {
                PI * (2 * l + 1) as f64 / (4 * count) as f64
            } else {
                PI * (l + 1) as f64 / (2 * count + 1) as f64
            };
            angle.cos()
        })
    }

    /// Removes modes from nodes that are not free and whose pressure is tensile somewhere across
    /// the contact: all of them if the mean is tensile, otherwise the higher ones. Returns whether
    /// there was such a node.
    pub fn release(&mut self, both_ends: bool, unknowns: &DVector<f64>) -> bool {
        let mut released = false;
        let [first, last] = [0, self.free.len() - 1].map(|at| self.free[at]);
        let behind = (0..first).filter(|_| both_ends).chain(last + 1..self.counts.len());
        for j in behind {
            let c = &unknowns.as_slice()[self.modes(j)];
            let is_tensile = |modes: &[f64]| {
                (0..=SHAPE_POINTS).any(|i| {
                    // Just inside the edge the sign is that of the slope.
                    let t = 0.999 * f64::from(i) / f64::from(SHAPE_POINTS);
                    strip::pressure(1.0, modes, t) < 0.0
                })
            };
            let left = match c.len() {
                0 => continue,
                _ if c[0] < 0.0 => 0,
                _ if !is_tensile(c) => continue,
                1 | 2 => 1,
                _ => 2,
            };
            self.counts[j] = left;
            released = true;
        }
        self.number();
        released
    }
}
