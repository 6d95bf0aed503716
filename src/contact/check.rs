//! The laws of contact, checked at points of their own.

use super::operator::{LineOperator, Operator};
use super::problem::Problem;
use super::solution::ContactSolution;
use crate::base::{Error, Result, worse};
use crate::kernels::strip;

/// Positions of the check across the contact, in half-widths of each node.
const PLACES: [f64; 6] = [0.31, 0.73, 0.97, 1.05, 1.3, 2.2];

/// Distance from the line's end (C) within which interpolated half-widths leave gaps that say
/// nothing about the rest.
const END: f64 = 0.2;

/// The same where a contact narrows to a tip, as a part of its length.
const TIP: f64 = 0.05;

/// Deepest penetration (C^2 / (2 R)) at nodes that carry nothing, up to the line's end: beside a
/// tip that is found within its error it is below 0.015, beside the singular end of a half-space up
/// to 0.043 (within 0.05 C of it), where a part of the contact was lost above 0.07.
const LOST: f64 = 0.05;

/// Largest part of the load that may not be carried: rounding leaves far less.
const CARRIED: f64 = 1e-6;

/// Refuses a solution that violates a law of contact by more than `tolerance`: there is no gap
/// under pressure and no penetration elsewhere (in units of C^2 / (2 R)), and the pressure is not
/// tensile (p0). Nodes without pressure do not penetrate by more than [`LOST`], also near the
/// line's end. With any finite `tolerance` the load is carried.
///
/// # Errors
/// [`Error::Unsound`] with the law that is violated most.
pub(super) fn check(
    operator: &LineOperator,
    problem: &Problem,
    solution: &ContactSolution,
    tolerance: f64,
) -> Result<()> {
    let unsound = |law: &'static str, value: f64, limit: f64| {
        let remedy = "another [accuracy] tolerance or another model may do".into();
        Err(Error::Unsound { law, value, limit, remedy })
    };
    if tolerance.is_finite() && (solution.load_error > CARRIED || solution.load_error.is_nan()) {
        return unsound("the part of the load that is not carried", solution.load_error, CARRIED);
    }
    // Values, their limits and the laws.
    let mut broken: [(f64, f64, &'static str); 4] = [
        (0.0, tolerance, "the deepest penetration (C^2 / 2 R)"),
        (0.0, tolerance, "the widest gap under a pressure (C^2 / 2 R)"),
        (0.0, tolerance, "the largest tensile traction between the bodies (p0)"),
        (0.0, tolerance.max(LOST), "the deepest penetration where no pressure is (C^2 / 2 R)"),
    ];
    let nodes = problem.axis.nodes().iter().enumerate();
    let counted: Vec<usize> = nodes
        .filter(|(j, y)| *j == 0 && !problem.both_ends || !near_end(problem, solution, **y))
        .map(|(j, _)| j)
        .collect();
    let idle: Vec<usize> =
        (0..problem.axis.len()).filter(|j| solution.coefficients[*j].is_empty()).collect();
    for (t, gaps) in PLACES.iter().zip(gaps_of(operator, problem, solution, &PLACES)) {
        broken[3].0 = idle.iter().fold(broken[3].0, |deepest, j| worse(deepest, -gaps[*j]));
        for (gap, coefficients) in counted.iter().map(|&j| (&gaps[j], &solution.coefficients[j])) {
            broken[0].0 = worse(broken[0].0, -gap);
            if *t < 1.0 && !coefficients.is_empty() {
                broken[1].0 = worse(broken[1].0, *gap);
                broken[2].0 = worse(broken[2].0, -strip::pressure(1.0, coefficients, *t));
            }
        }
    }
    let excess = |(value, limit, _): &(f64, f64, &str)| value / limit;
    let worst = broken.into_iter().max_by(|a, b| excess(a).total_cmp(&excess(b)));
    let (value, limit, law) = worst.expect("four laws");
    if value <= limit { Ok(()) } else { unsound(law, value, limit) }
}

/// Whether `y` lies so close to an end of the contact that its gap says nothing about the rest.
fn near_end(problem: &Problem, solution: &ContactSolution, y: f64) -> bool {
    let [from, to] = solution.ends.map(|end| end.at);
    let length = if problem.both_ends { to - from } else { to };
    let tip = if problem.may_end() { TIP * length } else { 0.0 };
    (y - from).abs().min((to - y).abs()) < END.max(tip) || problem.distance_to_end(y) < END
}

/// Gaps between the loaded bodies (C^2 / (2 R)) at the nodes along the line, at the distances
/// `places` from x = 0 in half-widths of each node: a row of all nodes for each place. A node
/// without pressure has the half-width interpolated from its neighbours.
pub fn gaps(problem: &Problem, solution: &ContactSolution, places: &[f64]) -> Vec<Vec<f64>> {
    let operator = LineOperator::new(problem.compliance, problem.axis, 0.0);
    gaps_of(&operator, problem, solution, places)
}

/// [`gaps`] for a given operator.
fn gaps_of(
    operator: &LineOperator,
    problem: &Problem,
    solution: &ContactSolution,
    places: &[f64],
) -> Vec<Vec<f64>> {
    let mut gaps = operator.displacements(solution, places);
    for (row, t) in gaps.iter_mut().zip(places) {
        let nodes = operator.axis.nodes().iter().zip(&solution.half_widths);
        for (value, (y, a)) in row.iter_mut().zip(nodes) {
            *value += problem.gap.at(a * t, *y) - solution.approach - solution.tilt * y;
        }
    }
    gaps
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::{Panels, Wavenumbers};
    use crate::contact::{Compliance, ContactSettings, Rotation, Straight, solve};
    use nalgebra::DMatrix;
    use std::f64::consts::PI;

    /// Bodies without ends: C(k) = 2 pi / k.
    fn compliance(numbers: &Wavenumbers, n: usize) -> Vec<DMatrix<f64>> {
        let one = |k: &f64| DMatrix::identity(n, n) * (2.0 * PI / k);
        numbers.coarse().nodes().iter().map(one).collect()
    }

    #[test]
    fn what_breaks_a_law_is_refused() {
        let axis = Panels::new(vec![0.0, 2.0, 4.0], 3);
        let breaks = (0..=24).map(|i| if i == 0 { 0.0 } else { 1e-3 * 1.6f64.powi(i) });
        let numbers = Wavenumbers::new(Panels::new(breaks.collect(), 5), 2.0);
        let matrices = compliance(&numbers, axis.len());
        let compliance = Compliance { wavenumbers: &numbers, matrices: &matrices };
        let settings = ContactSettings {
            modes: 3,
            spacing: [0.1; 2],
            tolerance: 1e-6,
            max_iterations: 20,
            soundness: 1e-3,
        };
        let problem = Problem {
            compliance: &compliance,
            axis: &axis,
            both_ends: false,
            gap: &Straight,
            load: 2.0 * PI,
            rotation: Rotation::Held(0.0),
            open: [false; 2],
            recedes: [false; 2],
            turns: [f64::INFINITY; 2],
            guess: None,
        };
        let solution = solve(&problem, &settings).unwrap();
        // Hertz: no gap within, and x sqrt(x^2 - 1) - ln(x + sqrt(x^2 - 1)) beyond.
        let places = [0.2, 0.8, 1.1, 3.0];
        for (x, row) in places.iter().zip(gaps(&problem, &solution, &places)) {
            let root = (x * x - 1.0).max(0.0).sqrt();
            let want = if *x < 1.0 { 0.0 } else { x * root - (x + root).ln() };
            assert!(row.iter().all(|gap| (gap - want).abs() < 1e-4), "at {x}: {row:?}, {want}");
        }

        let all = LineOperator::new(&compliance, &axis, 0.0);
        let law = |change: &dyn Fn(&mut ContactSolution)| {
            let mut changed = solution.clone();
            change(&mut changed);
            match check(&all, &problem, &changed, 1e-3) {
                Err(Error::Unsound { law, value, .. }) => (law, value),
                other => panic!("{other:?}"),
            }
        };
        assert!(law(&|s| s.approach += 0.01).0.contains("penetration"));
        assert!(law(&|s| s.approach -= 0.01).0.contains("gap"));
        assert!(law(&|s| s.coefficients[1] = vec![0.5, -2.0]).1 > 0.5);
        assert_eq!(law(&|s| s.half_widths[0] = f64::NAN).1, f64::INFINITY);
    }
}
