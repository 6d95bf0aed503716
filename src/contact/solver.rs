//! The Newton iteration for the contact's boundary.

use super::check::check;
use super::ends::ends;
use super::galerkin::LinearProblem;
use super::layout::{Layout, Shares};
use super::operator::LineOperator;
use super::problem::{Problem, Rotation};
use super::settings::ContactSettings;
use super::solution::{Coarser, ContactSolution};
use crate::base::stop::go_on;
use crate::base::{Error, Result};
use crate::kernels::strip;
use nalgebra::DVector;
use std::ops::Range;

/// What may be neglected of an entry's sum over the wavenumbers, in tolerances of the singularity.
const NEGLIGIBLE: f64 = 0.4;

/// Fewest free nodes of a contact that narrows.
const TIP_NODES: usize = 3;

/// Iterations of an attempt that is not the last, and the amplitude of the edge singularity (p0)
/// from which on it may go on as the last one may: half-widths that begin far too small at most
/// double in an iteration, and are found soon after that.
const ATTEMPT: usize = 26;
const ARRIVES: f64 = 1e-2;

/// Limit of the ratio of a node's edge slope to that of its first mode, and of the inverse, far
/// from the solution and [`NEAR`] it. Higher modes, which describe the pressure's inside, may
/// cancel the slope of the first one for an iteration, and the half-width would run away.
const STEEPER: f64 = 1.3;
const NEAR_STEEPER: f64 = 2.0;

/// Amplitude of the edge singularity (p0) from which on a solution is near, and tensile nodes are
/// released.
const NEAR: f64 = 1e-3;

/// A node's singular mode may not vanish with Newton's step. Next to an end of the line, from where
/// half-widths are continued up to that end, it reacts to its half-width by up to more than twice
/// what the step expects, and changes sign from one iteration to the next. Next to a steep end,
/// where the limit [`STEEPER`] holds, it reacts by as little as a fifth. From this ratio of the
/// amplitudes of two iterations on, a node takes the part of the step that secants tell, within
/// limits.
const STAYS: f64 = 0.3;
const LEAST_PART: f64 = 0.2;
const MOST_PART: f64 = 4.0;

/// Amplitude of the edge singularity (p0) above which a node takes no more than the whole step: the
/// other nodes change it as much as its own half-width does.
const MOVED: f64 = 2e-2;

/// Smallest half-width in the iteration (C), and that of a contact that ends at a tip.
const NARROWEST: f64 = 0.05;
const TIP: f64 = 1e-3;

/// Modes of the second attempt. Beside an end where half-widths rise steeply, as under an eccentric
/// load, free nodes with many modes react to each other's half-widths more than to their own.
const FEWER_MODES: usize = 5;

/// Modes of the last attempt behind the last free node: there the half-widths follow those of the
/// free nodes, and with many modes the pressures of a contact that hardly reaches its end turn
/// tensile one after the other.
const FEW_TAIL_MODES: usize = 3;

/// Distance between free nodes (C) below which half-widths that fewer nodes have found come first,
/// and how closely: their distance, the tolerance of their singularity and their most iterations.
const CLOSE: f64 = 0.025;
const FIRST_SPACING: f64 = 0.12;
const FIRST_TOLERANCE: f64 = 5e-3;
const FIRST_ITERATIONS: usize = 10;

/// Solves for the pressure that carries the problem's load.
///
/// For fixed half-widths the problem is linear: Galerkin's method determines the modes at every
/// node, and the load determines the approach. Nodes whose half-width is unknown also have the
/// amplitude b of the singular mode 1/sqrt(1 - t^2); at the correct boundary b = 0. To first order
/// b / sqrt(1 - t^2) is the effect of moving the boundary of S sqrt(1 - t^2) to a sqrt(1 + 2 b /
/// S), so this update is Newton's and converges quadratically.
///
/// # Errors
/// [`Error::NotConverged`] if the boundary does not converge, [`Error::Unsound`] if the solution
/// violates a law of contact.
pub fn solve(problem: &Problem, settings: &ContactSettings) -> Result<ContactSolution> {
    let negligible = NEGLIGIBLE * settings.tolerance;
    let operator = LineOperator::new(problem.compliance, problem.axis, negligible);
    let guess = first_guess(&operator, problem, settings)?;
    let mut answer = Err(not_converged(0, f64::INFINITY));
    let attempts = attempts(settings, problem.may_end() || problem.open.contains(&true));
    let wanted = attempts[0].coarser();
    for attempt in attempts {
        answer = solve_once(&operator, problem, &attempt, guess.clone()).and_then(|solution| {
            check(&operator, problem, &solution, settings.soundness)?;
            let coarser = Some(attempt.coarser()).filter(|own| *own != wanted);
            Ok(ContactSolution { coarser, ..solution })
        });
        if answer.is_ok() {
            return answer;
        }
        go_on()?;
    }
    answer
}

/// How a contact is tried to be solved.
struct Attempt {
    settings: ContactSettings,
    /// Most modes behind the last free node.
    tail_modes: usize,
    /// Whether nodes take parts of Newton's steps, see [`STAYS`].
    by_secants: bool,
    /// Whether half-widths are interpolated by cubics, not by straight lines.
    bent: bool,
    /// Iterations after which it is given up, unless it [`ARRIVES`].
    iterations: usize,
}

impl Attempt {
    fn coarser(&self) -> Coarser {
        let ContactSettings { spacing, modes, .. } = self.settings;
        Coarser { spacing, modes, end_modes: self.tail_modes }
    }
}

/// The attempts, one after the other until one succeeds: a pressure that is singular at the end, as
/// a half-space's, may need fewer unknown half-widths, and few of those whole steps. If the contact
/// `may_end` before its bodies do, cubics between half-widths that are far off may go below zero,
/// and straight lines come next.
fn attempts(settings: &ContactSettings, may_end: bool) -> Vec<Attempt> {
    let all = settings.modes;
    let one = |by_secants, times: f64, modes, tail_modes, iterations| {
        let spacing = settings.spacing.map(|apart| times * apart);
        let settings = ContactSettings { spacing, modes, ..*settings };
        Attempt { settings, tail_modes, by_secants, bent: false, iterations }
    };
    let first = || one(true, 1.0, all, all, ATTEMPT);
    let mut list = vec![Attempt { bent: true, ..first() }];
    list.extend(may_end.then(first));
    if all > FEWER_MODES {
        list.push(one(true, 1.0, FEWER_MODES, FEWER_MODES, ATTEMPT));
    }
    for by_secants in [true, false] {
        list.extend([2.0, 4.0].map(|times| one(by_secants, times, all, all, ATTEMPT)));
        list.push(one(by_secants, 8.0, all, FEW_TAIL_MODES, settings.max_iterations));
    }
    list
}

/// The half-widths that an iteration begins with: those of the problem's guess, else 1. Where free
/// nodes are closer than [`CLOSE`], half-widths far off would oscillate from one to the next, and
/// one of them could be left behind in a solution of its own; fewer free nodes come first there.
fn first_guess(
    operator: &LineOperator,
    problem: &Problem,
    settings: &ContactSettings,
) -> Result<Vec<f64>> {
    let known = |y: &f64| problem.guess.map_or(1.0, |slices| slices.half_width(*y).max(TIP));
    let known: Vec<f64> = problem.axis.nodes().iter().map(known).collect();
    if problem.guess.is_some() || problem.may_end() || settings.spacing[1] >= CLOSE {
        return Ok(known);
    }
    let fewer = ContactSettings {
        spacing: [FIRST_SPACING; 2],
        tolerance: FIRST_TOLERANCE,
        max_iterations: FIRST_ITERATIONS,
        ..*settings
    };
    let fewer = Attempt {
        settings: fewer,
        tail_modes: FEW_TAIL_MODES,
        by_secants: true,
        bent: false,
        iterations: FIRST_ITERATIONS,
    };
    match solve_once(operator, problem, &fewer, known.clone()) {
        Err(Error::Stopped) => Err(Error::Stopped),
        found => Ok(found.map_or(known, |first| first.half_widths)),
    }
}

/// One attempt of [`solve`], from these half-widths.
fn solve_once(
    operator: &LineOperator,
    problem: &Problem,
    attempt: &Attempt,
    mut half_widths: Vec<f64>,
) -> Result<ContactSolution> {
    let Attempt { ref settings, tail_modes, by_secants, bent, iterations } = *attempt;
    let n = problem.axis.len();
    let mut contact = 0..n;
    let layout_of = |contact| Layout::new(problem, settings, tail_modes, bent, contact);
    let mut layout = layout_of(contact.clone());
    let mut parts = StepParts::new(n);
    // Edge slopes S of the pressure at the nodes: sum (2m + 1) c_m.
    let mut slopes = vec![1.0; n];
    let mut last = f64::INFINITY;
    for iteration in 1..=settings.max_iterations {
        go_on()?;
        if iteration > iterations && last > ARRIVES {
            return Err(not_converged(iteration - 1, last));
        }
        let held = LinearProblem {
            operator,
            problem,
            layout: &layout,
            half_widths: &half_widths,
            slopes: &slopes,
        };
        let unknowns = held.solve()?;
        let singular: Vec<f64> =
            layout.free.iter().map(|&j| unknowns[layout.singular(j)]).collect();
        let worst = singular.iter().fold(0.0, |worst: f64, s| worst.max(s.abs()));
        let steeper = if worst <= NEAR { NEAR_STEEPER } else { STEEPER };
        for (j, slope) in slopes.iter_mut().enumerate() {
            *slope = edge_slope(&layout.coefficients(j, &unknowns), steeper);
        }
        last = worst;
        let shrunk = layout.shrunk(problem, &contact, &unknowns);
        let settled = shrunk == contact;
        let near = settled && worst <= settings.tolerance.max(NEAR);
        let released = near && layout.release(problem.both_ends, &unknowns);
        if settled && worst <= settings.tolerance && !released {
            check_nodes(problem, settings, &layout, &contact)?;
            let solution = carrying(problem, &layout, half_widths, &unknowns);
            return Ok(ContactSolution { iterations: iteration, residual: worst, ..solution });
        }
        let wanted = |(&j, singular): (&usize, &f64)| {
            // Beyond a factor of two the linearisation does not hold.
            let grow = if slopes[j] > 0.0 { 1.0 + 2.0 * singular / slopes[j] } else { 0.25 };
            let part = if by_secants { parts.part_of(j, *singular) } else { 1.0 };
            half_widths[j] * grow.clamp(0.25, 4.0).sqrt().powf(part)
        };
        let wanted: Vec<f64> = layout.free.iter().zip(&singular).map(wanted).collect();
        half_widths = between(&layout, &wanted);
        if !settled {
            contact = shrunk;
            layout = layout_of(contact.clone());
        }
        if !settled || released {
            parts = StepParts::new(n);
        }
    }
    Err(not_converged(settings.max_iterations, last))
}

fn not_converged(iterations: usize, residual: f64) -> Error {
    let remedy = "ask for a coarser [accuracy] tolerance if it is below 0.1, check the case's lengths, or take --engine cells, as a contact in several parts along the line needs";
    Error::NotConverged { iterations, residual, remedy: remedy.into() }
}

/// The parts of Newton's steps that the nodes take, see [`STAYS`].
struct StepParts {
    /// The last amplitude of each node's singular mode, and the part of its last step.
    last: Vec<(f64, f64)>,
}

impl StepParts {
    fn new(nodes: usize) -> Self {
        Self { last: vec![(f64::NAN, 1.0); nodes] }
    }

    /// The part of the next step of node `j`, whose singular mode has now this amplitude.
    fn part_of(&mut self, j: usize, amplitude: f64) -> f64 {
        let (had, part) = &mut self.last[j];
        let left = amplitude / *had;
        if left.abs() > STAYS || *part != 1.0 {
            let most = if amplitude.abs() <= MOVED { MOST_PART } else { 1.0 };
            let secant = *part / (1.0 - left);
            *part = if secant > 0.0 { secant.clamp(LEAST_PART, most) } else { part.min(1.0) };
        }
        *had = amplitude;
        *part
    }
}

/// The half-widths at all nodes from those at the free ones.
fn between(layout: &Layout, free: &[f64]) -> Vec<f64> {
    let at_node = |(shares, narrows): (&Shares, &bool)| {
        let mean = |of: fn(f64) -> f64| -> f64 {
            shares.iter().map(|(node, share)| share * of(free[*node])).sum()
        };
        // Towards a tip it is the square that is smooth.
        match narrows {
            true => mean(|a| a * a).max(TIP * TIP).sqrt(),
            false => mean(|a| a).max(NARROWEST),
        }
    };
    layout.shares.iter().zip(&layout.narrows).map(at_node).collect()
}

/// Refuses a contact that ends before its bodies do, and whose free nodes are so few that its
/// half-widths say nothing of how it narrows.
fn check_nodes(
    problem: &Problem,
    settings: &ContactSettings,
    layout: &Layout,
    contact: &Range<usize>,
) -> Result<()> {
    let narrows = problem.open.contains(&true)
        || problem.both_ends && contact.start > 0
        || contact.end < problem.axis.len();
    let lacking = TIP_NODES.saturating_sub(layout.free.len());
    if !narrows || lacking == 0 || settings.soundness.is_infinite() {
        return Ok(());
    }
    Err(Error::Unsound {
        law: "the number of nodes that a contact lacks to narrow to its end",
        value: lacking as f64,
        limit: 0.0,
        remedy: "take a tighter [accuracy] tolerance, or --engine cells".into(),
    })
}

/// The edge slope S of the pressure with these modes, at most `steeper` times that of the first one
/// or its inverse, see [`STEEPER`].
fn edge_slope(modes: &[f64], steeper: f64) -> f64 {
    let slope: f64 = modes.iter().enumerate().map(|(m, c)| (2 * m + 1) as f64 * c).sum();
    match modes.first() {
        Some(first) if *first > 0.0 => slope.clamp(first / steeper, first * steeper),
        Some(first) => *first,
        None => 0.0,
    }
}

/// The solution from the `unknowns`. The share of the load in the singular modes, which is below
/// the tolerance, is redistributed so that the regular modes carry the load and its moment.
fn carrying(
    problem: &Problem,
    layout: &Layout,
    half_widths: Vec<f64>,
    unknowns: &DVector<f64>,
) -> ContactSolution {
    let axis = problem.axis;
    let n = axis.len();
    let mut coefficients: Vec<Vec<f64>> =
        (0..n).map(|j| layout.coefficients(j, unknowns)).collect();
    // Load and its first two moments about y = 0.
    let carried = |coefficients: &[Vec<f64>]| -> [f64; 3] {
        let mut sums = [0.0; 3];
        for (j, (y, w)) in axis.nodes().iter().zip(axis.weights()).enumerate() {
            let a = half_widths[j];
            let line = w * strip::cumulative(a, &coefficients[j], a);
            sums.iter_mut().zip([1.0, *y, y * y]).for_each(|(sum, arm)| *sum += line * arm);
        }
        sums
    };
    let [load, first, second] = carried(&coefficients);
    // Factors c + d y that give back both resultants.
    let (constant, slope) = match problem.rotation {
        Rotation::Held(_) | Rotation::Sprung { .. } => (problem.load / load, 0.0),
        Rotation::Free(moment) => {
            let determinant = load * second - first * first;
            (
                (problem.load * second - moment * first) / determinant,
                (load * moment - first * problem.load) / determinant,
            )
        }
    };
    for (own, y) in coefficients.iter_mut().zip(axis.nodes()) {
        own.iter_mut().for_each(|c| *c *= constant + slope * y);
    }
    let load_error = (carried(&coefficients)[0] / problem.load - 1.0).abs();
    let ends = ends(problem, layout, &half_widths, &coefficients);
    let motions = &unknowns.as_slice()[layout.len()..];
    let tilt = match problem.rotation {
        Rotation::Held(tilt) => tilt,
        Rotation::Free(_) | Rotation::Sprung { .. } => motions[1],
    };
    ContactSolution {
        half_widths,
        coefficients,
        approach: motions[0],
        tilt,
        ends,
        load_error,
        iterations: 0,
        coarser: None,
        residual: 0.0,
    }
}
