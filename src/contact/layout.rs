//! The unknowns of the nodes along the line.

use super::problem::Problem;
use super::settings::ContactSettings;
use crate::kernels::strip;
use nalgebra::DVector;
use std::ops::Range;

/// Distance from the line's end (C) beyond which a few modes describe the pressure.
const DISTURBED: f64 = 1.0;
const INNER_MODES: usize = 3;

/// Modes at nodes so near a corner at which the pressure grows without limit, in terms of the
/// shortest wave 1 / k_max. What nodes beside each other do to each other there is known for a few
/// modes only: higher ones are noise that tears the nodes apart. Where bodies have no ends the
/// exponent is 1/2, and the modes, known in closed form, change up to the corner.
const UNRESOLVED: f64 = 0.1;
const UNRESOLVED_MODES: usize = 3;
const ENDLESS_EXPONENT: f64 = 0.5;

/// Modes that a node without an independent half-width has of its own, where the pressure has a
/// limit at the end. Its higher ones are small, change slowly along the line, and are interpolated
/// as its half-width is: fewer unknowns, at 1e-4 no further from the limit than with all of them.
const OWN_MODES: usize = 4;

/// Points across the contact at which the sign of a pressure is checked.
const SHAPE_POINTS: i32 = 8;

/// Part of a contact's half-length, or of the length within which the gap turns if that is shorter,
/// in which the square of the half-width is linear at a tip.
const TIP_LENGTH: f64 = 0.003;

/// Fewest free nodes in contact.
const LEAST: usize = 2;

/// Limit of the ratio of a node's edge slope to that of a free node, with which its singular
/// amplitude scales.
const STEEPEST: f64 = 10.0;

/// Power of the distance from the contact's end in which the half-width is interpolated: it
/// steepens towards an end, where the pressure changes by s ln s, or by s^-m (the second one).
const STEEPENING: f64 = 0.6;
const STEEPENING_WITHOUT_LIMIT: f64 = 0.75;

/// Knots through which a half-width, or towards a tip its square, is interpolated, and beyond the
/// last of them extrapolated: cubics, but parabolas towards an end without a limit and straight
/// lines towards a tip. By straight lines throughout, errors of pressures 0.03 to 0.1 C from a
/// steep tip are as large at 3e-4 as at 1e-3, and those 0.03 to 0.05 C from an end with a limit up
/// to ten times 1e-4.
const CUBIC: usize = 4;
const PARABOLA: usize = 3;
const LINE: usize = 2;

/// What is interpolated at a node: positions of free nodes, and their shares.
pub(super) type Shares = [(usize, f64); CUBIC];

/// The unknowns of each node. Free nodes have all modes and the singular one, whose amplitude
/// determines the change of their half-width. Next to the end of the line the nodes are closer than
/// the shortest wave, and independent half-widths would be noise. They are interpolated from those
/// of the free nodes, at least `spacing` apart, in the [`STEEPENING`] power of the distance from
/// the end, and so are higher modes, see [`OWN_MODES`]. A node beyond the last free one whose
/// pressure would be tensile loses modes, the higher ones first; with none left it carries no
/// pressure.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    /// The free nodes, ascending.
    pub free: Vec<usize>,
    /// The half-width of each node from those of the free nodes: positions in `free`, and shares.
    pub shares: Vec<Shares>,
    /// Whether the contact narrows to a tip towards the end next to each node: it is the square of
    /// the half-width that is interpolated then.
    pub narrows: Vec<bool>,
    /// Modes of each node, with those that are interpolated.
    pub counts: Vec<usize>,
    /// Modes of each node that are unknowns, the lowest ones.
    own: Vec<usize>,
    /// The first unknown of each node, and the end.
    starts: Vec<usize>,
}

/// The free nodes of those in `contact`, ascending: from each end towards the middle, so that
/// mirror images of a contact have mirror images of them.
fn free_nodes(problem: &Problem, spacing: [f64; 2], contact: &Range<usize>) -> Vec<usize> {
    let nodes = problem.axis.nodes();
    // Where the contact ends before the bodies do, it narrows to a tip.
    let receded = [contact.start > 0, contact.end < nodes.len()];
    let last = [nodes[contact.start], nodes[contact.end - 1]];
    let breaks = problem.axis.breaks();
    let ends = [breaks[0], problem.axis.end()];
    let half = 0.5 * (last[1] - last[0]) * if problem.both_ends { 1.0 } else { 2.0 };
    let tips = problem.turns.map(|turns| TIP_LENGTH * half.min(turns));
    let near = |side: usize, y: f64| {
        if side == 0 && !problem.both_ends {
            return false;
        }
        let end = if receded[side] { last[side] } else { ends[side] };
        let apart = if receded[side] || problem.open[side] {
            tips[side].max(spacing[side])
        } else {
            spacing[side]
        };
        (y - end).abs() < apart
    };
    let middle = match problem.both_ends {
        true => nodes.partition_point(|y| *y < 0.5 * (last[0] + last[1])),
        false => contact.start,
    };
    let towards = |side: usize, inward: &mut dyn Iterator<Item = usize>| {
        let mut last: Option<f64> = None;
        let apart = |j: &usize| {
            let y = nodes[*j];
            let far = last.is_none_or(|last| (y - last).abs() >= spacing[side]);
            let is_free = far && !near(0, y) && !near(1, y);
            if is_free {
                last = Some(y);
            }
            is_free
        };
        inward.filter(apart).collect::<Vec<_>>()
    };
    let mut free = towards(0, &mut (contact.start..middle));
    let after = towards(1, &mut (middle..contact.end).rev());
    free.extend(after.into_iter().rev());
    if free.is_empty() { vec![middle] } else { free }
}

/// The coordinate in which half-widths next to `y` are interpolated: a power of the distance from
/// the end next to it, see [`STEEPENING`].
fn steepening(problem: &Problem, y: f64) -> impl Fn(f64) -> f64 {
    let end = [problem.axis.breaks()[0], problem.axis.end()][problem.side_of(y)];
    let power = if problem.is_steep(y) { STEEPENING_WITHOUT_LIMIT } else { STEEPENING };
    move |at| (at - end).abs().powf(power)
}

/// A place at which the half-width is known: a free node, by its position among these, or a tip,
/// where it is zero.
struct Knot {
    y: f64,
    free: Option<usize>,
    /// See [`Layout::narrows`]; a tip does.
    narrows: bool,
}

/// The knots along the line, ascending. A contact that has receded from the end of the line has its
/// tip somewhere beyond the last free node.
fn knots(problem: &Problem, contact: &Range<usize>, free: &[usize], narrows: &[bool]) -> Vec<Knot> {
    let axis = problem.axis;
    let tip = |y: f64, open: bool| open.then_some(Knot { y, free: None, narrows: true });
    let node = |(at, j): (usize, &usize)| Knot {
        y: axis.nodes()[*j],
        free: Some(at),
        narrows: narrows[*j],
    };
    tip(axis.breaks()[0], problem.open[0] && contact.start == 0)
        .into_iter()
        .chain(free.iter().enumerate().map(node))
        .chain(tip(axis.end(), problem.open[1] && contact.end == axis.len()))
        .collect()
}

/// The shares of free nodes from those of knots.
fn shares_of<'a>(knots: impl IntoIterator<Item = (&'a Knot, f64)>) -> Shares {
    let mut shares = [(0, 0.0); CUBIC];
    let of_nodes = knots.into_iter().filter_map(|(knot, share)| Some((knot.free?, share)));
    shares.iter_mut().zip(of_nodes).for_each(|(own, share)| *own = share);
    shares
}

/// The `count` knots nearest to a place between or beyond them, of which the first `after` lie
/// before it.
fn knots_around(knots: &[Knot], after: usize, count: usize) -> &[Knot] {
    let first = after.saturating_sub(count.div_ceil(2)).min(knots.len() - count);
    &knots[first..first + count]
}

/// The shares of free nodes at `y`, next to which the contact narrows to a tip or not: by the
/// polynomial through the knots around it, of which the first `after` lie before it. Knots of both
/// kinds have a straight line between them.
fn shares_at(
    problem: &Problem,
    knots: &[Knot],
    after: usize,
    y: f64,
    narrow: bool,
    bent: bool,
) -> Shares {
    let beyond = after == 0 || after == knots.len();
    let count = if !bent || knots.len() < CUBIC || beyond && narrow {
        LINE
    } else if beyond && problem.is_steep(y) {
        PARABOLA
    } else {
        CUBIC
    };
    let alike = |near: &&[Knot]| near.iter().all(|knot| knot.narrows == narrow);
    let near = Some(knots_around(knots, after, count)).filter(alike);
    let near = near.unwrap_or_else(|| knots_around(knots, after, LINE));
    let steepened = steepening(problem, y);
    let at = |y: f64| if narrow { y } else { steepened(y) };
    let share = |own: &Knot| {
        let others = near.iter().filter(|other| other.y != own.y);
        others.map(|other| (at(y) - at(other.y)) / (at(own.y) - at(other.y))).product()
    };
    shares_of(near.iter().map(|own| (own, share(own))))
}

/// Whether the contact ends before the bodies do towards the end next to `y`.
fn narrows(problem: &Problem, contact: &Range<usize>, y: f64) -> bool {
    let receded = [contact.start > 0, contact.end < problem.axis.len()];
    let side = problem.side_of(y);
    problem.open[side] || receded[side]
}

impl Layout {
    /// All modes at the nodes that are in `contact`, at most `tail_modes` behind the last free one,
    /// none at the others; half-widths by curves if `bent`, or by straight lines.
    pub fn new(
        problem: &Problem,
        settings: &ContactSettings,
        tail_modes: usize,
        bent: bool,
        contact: Range<usize>,
    ) -> Self {
        let axis = problem.axis;
        let free = free_nodes(problem, settings.spacing, &contact);
        let narrows: Vec<bool> =
            axis.nodes().iter().map(|y| narrows(problem, &contact, *y)).collect();
        let knots = knots(problem, &contact, &free, &narrows);
        let shares: Vec<Shares> = axis
            .nodes()
            .iter()
            .zip(&narrows)
            .map(|(y, narrow)| {
                let after = knots.partition_point(|knot| knot.y < *y);
                // Towards a plane of symmetry the half-width is uniform.
                if free.len() == 1 || after == 0 && !problem.both_ends {
                    return shares_of([(&knots[0], 1.0)]);
                }
                shares_at(problem, &knots, after, *y, *narrow, bent)
            })
            .collect();
        let (first, last) = (free[0], free[free.len() - 1]);
        let near = UNRESOLVED / problem.compliance.wavenumbers.coarse().end();
        let corners = axis.corners().iter();
        let corners = corners.filter(|c| c.exponent().is_some_and(|m| m < ENDLESS_EXPONENT));
        let corners: Vec<f64> = corners.map(|corner| corner.at).collect();
        let modes_at = |(j, y): (usize, &f64)| {
            let tail = j > last || problem.both_ends && j < first;
            let most = if !contact.contains(&j) {
                0
            } else if corners.iter().any(|at| (y - at).abs() < near) {
                UNRESOLVED_MODES.min(tail_modes)
            } else if tail {
                tail_modes
            } else if problem.distance_to_end(*y) > DISTURBED {
                INNER_MODES
            } else {
                settings.modes
            };
            settings.modes.min(most)
        };
        let mut counts: Vec<usize> = axis.nodes().iter().enumerate().map(modes_at).collect();
        let mut own = counts.clone();
        for j in 0..counts.len() {
            let is_free = free.binary_search(&j).is_ok();
            if is_free || narrows[j] || problem.is_steep(axis.nodes()[j]) {
                continue;
            }
            own[j] = counts[j].min(OWN_MODES);
            // Those that all of the free nodes have.
            let of_free = shares[j].iter().filter(|(_, share)| *share != 0.0);
            let known = of_free.map(|(at, _)| counts[free[*at]]).min().unwrap_or(0);
            counts[j] = counts[j].min(known).max(own[j]);
        }
        let mut layout = Self { free, shares, narrows, counts, own, starts: Vec::new() };
        layout.number();
        layout
    }

    /// Numbers the unknowns.
    fn number(&mut self) {
        let mut next = 0;
        self.starts.clear();
        for (j, modes) in self.own.iter().enumerate() {
            self.starts.push(next);
            next += modes + usize::from(self.is_free(j));
        }
        self.starts.push(next);
    }

    /// The nodes in `contact` without those towards an end that carry no load: from the outermost
    /// free nodes inwards those whose pressure, with its singular mode, sums to tension.
    pub fn shrunk(
        &self,
        problem: &Problem,
        contact: &Range<usize>,
        unknowns: &DVector<f64>,
    ) -> Range<usize> {
        // The integrals of sqrt(1 - t^2) and of 1 / sqrt(1 - t^2) are pi / 2 and pi.
        let lifted = |j: usize| {
            let first = self.modes(j).next().map_or(0.0, |first| unknowns[first]);
            first + 2.0 * unknowns[self.singular(j)] < 0.0
        };
        let mut left = 0..self.free.len();
        while problem.recedes[0] && left.len() > LEAST && lifted(self.free[left.start]) {
            left.start += 1;
        }
        while problem.recedes[1] && left.len() > LEAST && lifted(self.free[left.end - 1]) {
            left.end -= 1;
        }
        let start = if left.start == 0 { contact.start } else { self.free[left.start - 1] + 1 };
        let end = if left.end == self.free.len() { contact.end } else { self.free[left.end] };
        start..end
    }

    fn is_free(&self, j: usize) -> bool {
        self.free.binary_search(&j).is_ok()
    }

    /// Unknowns and equations of node `j`: its modes, then the singular one if it is free.
    pub fn unknowns(&self, j: usize) -> Range<usize> {
        self.starts[j]..self.starts[j + 1]
    }

    /// The modes of node `j` that are unknowns.
    pub fn modes(&self, j: usize) -> Range<usize> {
        self.starts[j]..self.starts[j] + self.own[j]
    }

    /// All modes of node `j` in terms of the unknowns: columns and factors of each.
    pub fn mode_parts(&self, j: usize) -> Vec<Vec<(usize, f64)>> {
        let own = self.modes(j).map(|mode| vec![(mode, 1.0)]);
        let interpolated = (self.own[j]..self.counts[j]).map(|mode| {
            let shares = self.shares[j].iter().filter(|(_, share)| *share != 0.0);
            shares.map(|(at, share)| (self.starts[self.free[*at]] + mode, *share)).collect()
        });
        own.chain(interpolated).collect()
    }

    /// The coefficients of all modes of node `j`.
    pub fn coefficients(&self, j: usize, unknowns: &DVector<f64>) -> Vec<f64> {
        let sum = |parts: &Vec<(usize, f64)>| {
            parts.iter().map(|(column, factor)| factor * unknowns[*column]).sum()
        };
        self.mode_parts(j).iter().map(sum).collect()
    }

    /// The singular mode of the free node `j`.
    pub fn singular(&self, j: usize) -> usize {
        self.starts[j + 1] - 1
    }

    /// Unknowns of all nodes; those of rigid motions follow.
    pub fn len(&self) -> usize {
        self.starts[self.own.len()]
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

    /// Removes modes from nodes that are not free and whose pressure is tensile somewhere across
    /// the contact: all of them if the mean is tensile, otherwise the higher ones. Returns whether
    /// there was such a node.
    pub fn release(&mut self, both_ends: bool, unknowns: &DVector<f64>) -> bool {
        let mut released = false;
        let [first, last] = [0, self.free.len() - 1].map(|at| self.free[at]);
        let behind = (0..first).filter(|_| both_ends).chain(last + 1..self.counts.len());
        for j in behind {
            let c = &self.coefficients(j, unknowns);
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
            (self.counts[j], self.own[j]) = (left, left);
            released = true;
        }
        self.number();
        released
    }
}
