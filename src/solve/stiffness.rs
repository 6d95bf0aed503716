//! How stiff a contact is, by differences of solutions.

use super::options::Options;
use super::solved::SolvedCase;
use super::summary::Stiffness;
use crate::base::{Error, Result};
use crate::case::Case;

/// Relative step of the force, and step of the load's line of action in lengths of the overlap.
/// Solutions of unlike axes differ by parts of their tolerance: with smaller steps that would be
/// much of a difference, above all of how the approach follows the moment, and the tilt the force.
const FORCE_STEP: f64 = 3e-2;
const PLACE_STEP: f64 = 1e-2;

/// Largest tolerance (p0) of the solutions, for the same reason.
const TOLERANCE: f64 = 1e-3;

/// The stiffnesses of a solved case.
///
/// Approach and tilt are solved for at forces and moments a step to either side, with the tilt
/// free; the matrix of their central differences is inverted. The error is that of a difference:
/// about the square of the step, and the tolerance of the solutions, 1e-3 or less, over the step.
///
/// # Errors
/// As [`SolvedCase::new`].
pub fn stiffness(solved: &SolvedCase, options: &Options) -> Result<Stiffness> {
    let case = solved.case();
    let options = Options { curves: Vec::new(), points: Vec::new(), ..options.clone() };
    let force = case.load.force_n;
    let [from, to] = case.overlap_m();
    let arm = if solved.is_symmetric() { 0.0 } else { solved.centre_of_pressure_m() };
    // Within the overlap, however far beside the middle the load is.
    let step = (PLACE_STEP * (to - from)).min(0.5 * (arm - from)).min(0.5 * (to - arm));
    let at = |force_n: f64, moment: f64| -> Result<[f64; 2]> {
        let mut case: Case = case.clone().with_force(force_n);
        let held = solved.is_symmetric() && moment == 0.0;
        case.load.eccentricity_m = if held { None } else { Some(moment / force_n) };
        case.pose.tilt_rad = None;
        case.accuracy.tolerance = case.accuracy.tolerance.min(TOLERANCE);
        let solved = SolvedCase::new(&case, &options)?;
        Ok([solved.approach_m(), solved.tilt_rad()])
    };
    let moment = force * arm;
    let slopes =
        |[low, high]: [[f64; 2]; 2], width: f64| [0, 1].map(|i| (high[i] - low[i]) / width);
    let both = [-FORCE_STEP, FORCE_STEP].map(|part| at(force * (1.0 + part), moment));
    let [low, high] = both;
    let by_force = slopes([low?, high?], 2.0 * FORCE_STEP * force);
    let by_moment = if solved.is_symmetric() {
        // The tilt is odd in the moment, and the approach even.
        let [_, tilt] = at(force, force * step)?;
        [0.0, tilt / (force * step)]
    } else {
        let [low, high] = [-step, step].map(|by| at(force, moment + force * by));
        slopes([low?, high?], 2.0 * force * step)
    };
    let determinant = by_force[0] * by_moment[1] - by_force[1] * by_moment[0];
    if determinant.is_nan() || determinant <= 0.0 {
        return Err(Error::Unsound {
            law: "the determinant of the contact's compliance, its sign changed,",
            value: -determinant,
            limit: 0.0,
            remedy: "take a finer [accuracy] tolerance".into(),
        });
    }
    Ok(Stiffness {
        force_by_approach_n_per_m: by_moment[1] / determinant,
        moment_by_tilt_nm_per_rad: by_force[0] / determinant,
        force_by_tilt_n_per_rad: -by_moment[0] / determinant,
        moment_by_approach_n: -by_force[1] / determinant,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Material;
    use crate::body::EdgeModel;
    use crate::case::Factors;

    fn case(slenderness: f64) -> Case {
        let material = Material { young_pa: 210e9, poisson: 0.3 };
        let factors = Factors { load: 5e-4, slenderness, length_ratio: 1.0 };
        Case::from_factors("case", 0.01, material, material, factors).with_tolerance(1e-3)
    }

    fn found(case: &Case) -> (SolvedCase, Stiffness) {
        let options = Options { curves: Vec::new(), ..Options::new(EdgeModel::QuarterSpace) };
        let solved = SolvedCase::new(case, &options).unwrap();
        let found = stiffness(&solved, &options).unwrap();
        (solved, found)
    }

    #[test]
    fn force_by_approach_is_the_slope_between_two_loads() {
        let case = case(8.0);
        let (solved, found) = found(&case);
        let at = |part: f64| {
            let case = case.clone().with_force(case.load.force_n * part);
            let options = Options { curves: Vec::new(), ..Options::new(EdgeModel::QuarterSpace) };
            SolvedCase::new(&case, &options).unwrap().approach_m()
        };
        let slope = 0.04 * case.load.force_n / (at(1.02) - at(0.98));
        let off = found.force_by_approach_n_per_m / slope - 1.0;
        assert!(off.abs() < 2e-3, "{off}");
        assert_eq!(found.force_by_tilt_n_per_rad, 0.0);
        // Slices without influence on each other would have L^2 / 12 times the other stiffness.
        let length = case.roller.length_m;
        let slices = found.moment_by_tilt_nm_per_rad
            / found.force_by_approach_n_per_m
            / (length * length / 12.0);
        assert!((0.7..1.5).contains(&slices), "{slices}");
        assert!(solved.is_symmetric());
    }

    /// The matrix of an elastic contact is symmetric, and a small held tilt adds what it says.
    #[test]
    fn a_tilted_contact_has_the_force_and_the_moment_of_its_stiffness() {
        let mut tilted = case(5.0);
        tilted.load.eccentricity_m = Some(1e-4);
        let (solved, stiffness) = found(&tilted);
        let options = Options { curves: Vec::new(), ..Options::new(EdgeModel::QuarterSpace) };
        let moved = |force: f64, arm: f64| {
            let mut case = tilted.clone().with_force(force);
            case.load.eccentricity_m = Some(arm);
            let solved = SolvedCase::new(&case, &options).unwrap();
            [solved.approach_m(), solved.tilt_rad()]
        };
        let force = tilted.load.force_n;
        let [before, after] = [moved(force, 1e-4), moved(1.01 * force, 1.02e-4)];
        let [approach, tilt] = [after[0] - before[0], after[1] - before[1]];
        let predicted = stiffness.force_by_approach_n_per_m * approach
            + stiffness.force_by_tilt_n_per_rad * tilt;
        assert!((predicted / (0.01 * force) - 1.0).abs() < 0.03, "{predicted}");
        let predicted =
            stiffness.moment_by_approach_n * approach + stiffness.moment_by_tilt_nm_per_rad * tilt;
        let wanted = force * (1.01 * 1.02e-4 - 1e-4);
        assert!((predicted / wanted - 1.0).abs() < 0.05, "{predicted} of {wanted}");
        assert!((solved.centre_of_pressure_m() - 1e-4).abs() < 1e-10);
        let [one, other] = [stiffness.force_by_tilt_n_per_rad, stiffness.moment_by_approach_n];
        assert!((one / other - 1.0).abs() < 0.04, "{one} {other}");
    }

    /// So it is where half of the line has lifted off.
    #[test]
    fn the_stiffness_of_a_contact_beside_the_middle_is_symmetric() {
        let mut tilted = case(5.0);
        tilted.pose.tilt_rad = Some(2e-2);
        let (solved, stiffness) = found(&tilted);
        assert!(solved.scene().ends()[0] > -1.0, "{:?}", solved.scene().ends());
        let [one, other] = [stiffness.force_by_tilt_n_per_rad, stiffness.moment_by_approach_n];
        assert!(one > 0.0 && (one / other - 1.0).abs() < 0.02, "{one} {other}");
    }

    /// The number of panels of wavenumbers changes with S_l, and with it approach and tilt within
    /// their tolerance: that is no slope. What a tilt adds to the force is what an approach adds to
    /// the moment.
    #[test]
    fn stiffnesses_do_not_depend_on_the_tolerance() {
        for tolerance in [1e-2, 1e-3] {
            let mut case = crate::case::builtin_case("eccentric-half").unwrap().unwrap();
            case.accuracy.tolerance = tolerance;
            let (_, found) = found(&case);
            for (own, wanted) in [
                (found.force_by_approach_n_per_m, 97.0e6),
                (found.moment_by_tilt_nm_per_rad, 45.4),
                (found.force_by_tilt_n_per_rad, 1763.0),
                (found.moment_by_approach_n, 1763.0),
            ] {
                assert!((own / wanted - 1.0).abs() < 5e-3, "{tolerance}: {own}, not {wanted}");
            }
        }
    }
}
