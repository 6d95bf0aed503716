//! Loads that are given by the approach they cause.

use crate::common::{case as plain, small};
use edgeline::base::Result;
use edgeline::body::EdgeModel;
use edgeline::case::{Case, Load, ProfileKind, ProfileSpec};
use edgeline::solve::{CellOptions, Options, Solution, solve, solve_on_cells};

fn crowned(case: Case, radius_m: f64) -> Case {
    let mut profile = ProfileSpec::new(ProfileKind::Crown);
    profile.radius_m = Some(radius_m);
    let mut case = case;
    case.roller.profile = Some(profile);
    case
}

/// The case whose load is the approach.
fn approached(case: &Case, approach_m: f64) -> Case {
    let load = Load { force_n: f64::NAN, approach_m: Some(approach_m), ..case.load };
    let case = Case { load, ..case.clone() };
    case.check().unwrap();
    case
}

fn solved(case: &Case, method: EdgeModel) -> Result<Solution> {
    solve(case, &Options { curves: Vec::new(), ..Options::new(method) })
}

/// The approach of a force gives the force: straight, longer than the block, crowned with ends
/// inside, eccentric, tilted, offset, sliding, by several models and tolerances. Where rounding
/// decides between two solutions of the contact, they are up to 3e-8 apart; where one end is sought
/// inside, the axis is laid anew, and its solutions are up to 2e-6 apart.
#[test]
fn the_approach_of_a_force_gives_the_force() {
    let quarter = EdgeModel::QuarterSpace;
    let coarse = || plain(5e-4, 5.0, 0.8).with_tolerance(5e-3);
    let with = |case: Case, change: fn(&mut Case)| {
        let mut case = case;
        change(&mut case);
        case
    };
    for (name, case, method) in [
        ("straight", plain(5e-4, 5.0, 1.0), quarter),
        ("half-space", coarse(), EdgeModel::HalfSpace),
        ("a longer roller", plain(1e-4, 8.0, 1.5).with_tolerance(5e-3), EdgeModel::Guilbault),
        ("ends inside", crowned(coarse(), 0.05), quarter),
        (
            "one end inside",
            with(crowned(coarse(), 0.3), |case| case.load.eccentricity_m = Some(4e-4)),
            quarter,
        ),
        ("eccentric", with(coarse(), |case| case.load.eccentricity_m = Some(2e-4)), quarter),
        ("tilted", with(coarse(), |case| case.pose.tilt_rad = Some(2e-4)), EdgeModel::Mirror),
        (
            "offset and sliding",
            with(coarse(), |case| {
                case.pose.offset_m = 3e-4;
                case.load.eccentricity_m = Some(1e-4);
                case.sliding.friction = 0.2;
            }),
            quarter,
        ),
    ] {
        let forward = solved(&case, method).unwrap().summary;
        let back = solved(&approached(&case, forward.approach_m), method).unwrap().summary;
        let limit = if name == "one end inside" { 5e-6 } else { 5e-8 };
        small(name, (back.load_n / case.load.force_n - 1.0).abs(), limit);
        small(name, (back.approach_m / forward.approach_m - 1.0).abs(), limit);
        small(name, (back.p_max_pa / forward.p_max_pa - 1.0).abs(), 1e-5);
        small(name, (back.tilt_rad - forward.tilt_rad).abs() / 1e-4, 1e-3);
    }
}

/// Hertz's elliptic contact far from the ends: the approach of its bodies grows with the force to
/// the power 2/3, and a line contact's with nearly its first power. Between points at one depth the
/// exponent is a little more. Neglected waves, one more or less, change an approach by some 1e-8.
#[test]
fn a_given_approach_is_met_over_decades() {
    let case = crowned(plain(5e-4, 5.0, 1.0).with_tolerance(1e-2), 0.05);
    let mut last: Option<[f64; 2]> = None;
    for approach_m in [1e-7, 1e-6, 1e-5, 1e-4] {
        let found = solved(&approached(&case, approach_m), EdgeModel::QuarterSpace).unwrap();
        small("approach", (found.summary.approach_m / approach_m - 1.0).abs(), 5e-8);
        let load = found.summary.load_n;
        if let Some([was, at]) = last {
            let power = (approach_m / at).ln() / (load / was).ln();
            assert!((0.6..0.95).contains(&power), "{power} at {approach_m}");
        }
        last = Some([load, approach_m]);
    }
}

#[test]
fn an_approach_that_no_legal_force_causes_is_refused() {
    let case = plain(5e-4, 5.0, 1.0).with_tolerance(1e-2);
    for (approach_m, wanted) in [(0.5, "under the largest legal force"), (1e-12, "under the least")]
    {
        let said = solved(&approached(&case, approach_m), EdgeModel::Mirror).unwrap_err();
        let said = said.to_string();
        assert!(said.starts_with("load.approach_m = ") && said.contains(wanted), "{said}");
    }
}

/// Deep stresses, which the solution itself finds within 1 % to 40 % only, are those of a plate.
#[test]
fn the_approach_is_one_at_all_tolerances() {
    let with = |load: f64, slenderness: f64, length_ratio: f64, nu: [f64; 2]| {
        let mut case = plain(load, slenderness, length_ratio);
        [case.roller.material.poisson, case.block.material.poisson] = nu;
        case
    };
    let mut eccentric = with(3e-4, 5.0, 0.5, [0.3, 0.3]);
    eccentric.load.eccentricity_m = Some(0.1 * eccentric.roller.length_m);
    let cases = [
        with(5e-4, 5.0, 1.0, [0.3, 0.3]),
        with(5e-4, 5.0, 0.5, [0.45, 0.0]),
        with(1e-4, 20.0, 0.7, [0.1, 0.3]),
        with(1e-3, 2.0, 2.0, [0.3, 0.49]),
        eccentric,
    ];
    let usual = [(1e-2, 2e-3), (5e-3, 1e-3), (1e-3, 8e-4)];
    // What is neglected at one depth adds up over those of a block 2,700 C long.
    let slender = with(5e-9, 400.0, 0.3, [0.36, 0.21]);
    let cases = cases.into_iter().map(|case| (case, usual));
    for (case, limits) in cases.chain([(slender, [(1e-2, 1e-2), (5e-3, 5e-3), (1e-3, 1e-3)])]) {
        case.check().unwrap();
        let of = |tolerance: f64| {
            let case = case.clone().with_tolerance(tolerance);
            solved(&case, EdgeModel::QuarterSpace).unwrap().summary.approach_m
        };
        let fine = of(1e-4);
        for (tolerance, limit) in limits {
            let off = (of(tolerance) / fine - 1.0).abs();
            println!("{tolerance}: {off:.1e}");
            small(&format!("the approach at {tolerance} of {case:?}"), off, limit);
        }
    }
}

/// Cells count to the same points by the closed form of their displacement, the line engine by
/// strains: straight, on a longer block, offset, with ends inside, lifted off at one end, and where
/// the contact has left y = 0.
#[test]
fn both_engines_count_the_approach_and_the_tilt_to_the_same_points() {
    let held = |tilt_rad: f64, offset_m: f64| {
        let mut case = plain(5e-4, 5.0, 0.7);
        (case.pose.tilt_rad, case.pose.offset_m) = (Some(tilt_rad), offset_m);
        case
    };
    let mut eccentric = plain(3e-4, 6.0, 1.3);
    eccentric.load.eccentricity_m = Some(0.15 * eccentric.block.length_m);
    eccentric.block.material.poisson = 0.1;
    // The published models take turns.
    let published = [EdgeModel::HalfSpace, EdgeModel::Mirror, EdgeModel::Guilbault];
    for ((name, case), published) in [
        ("straight", plain(5e-4, 5.0, 1.0)),
        ("on a longer block", plain(1e-4, 12.0, 0.6)),
        ("ends inside", crowned(plain(5e-4, 5.0, 0.8), 0.06)),
        ("eccentric", eccentric),
        ("offset", held(2e-3, 6e-4)),
        ("lifted off", held(1e-2, 0.0)),
        ("beside the middle", held(2.5e-2, 0.0)),
    ]
    .into_iter()
    .zip(published.into_iter().cycle())
    {
        for method in [published, EdgeModel::QuarterSpace] {
            let options = Options { curves: Vec::new(), ..Options::new(method) };
            let line = solve(&case, &options).unwrap().summary;
            let cells = CellOptions { counts: Some([96, 144]), ..CellOptions::default() };
            let cells = solve_on_cells(&case, &options, &cells, &|_, _| {}).unwrap();
            let cells = cells.solution.summary;
            // Where the contact has left y = 0, the tilt carries the approach there.
            let whole =
                line.approach_m.abs() + (line.tilt_rad * line.centre_of_pressure_m[1]).abs();
            let off = (cells.approach_m - line.approach_m) / whole;
            let slope = line.hertz.c_m / case.roller.radius_m;
            let [from, to] = line.contact_y_m;
            let turned = (cells.tilt_rad - line.tilt_rad) / slope * 0.5 * (to - from);
            println!("{name} {method}: approach {off:.1e}, tilt {:.1e} C", turned / line.hertz.c_m);
            // The pressure of a half-space is singular at all ends, which uniform cells follow
            // least.
            let limit = if method == EdgeModel::HalfSpace { 5e-3 } else { 2e-3 };
            small(&format!("{name}, {method}: approach"), off.abs(), limit);
            small(&format!("{name}, {method}: tilt"), turned.abs() / line.hertz.c_m, limit);
        }
    }
}
