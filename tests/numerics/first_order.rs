//! What round surfaces and free ends make of each other, to first order in C / R.

use super::common::{case as straight, small};
use edgeline::base::gauss_legendre;
use edgeline::body::EdgeModel;
use edgeline::case::{Case, Study, find_case};
use edgeline::fem::FemResults;
use edgeline::solve::{CellOptions, Options, Point, Scene, Solution, solve, solve_on_cells};
use edgeline::stress::{BodyKind, Curves, EDGE, away_from_edges};
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

/// The case of this name, with or without the terms.
fn case(name: &str, first_order: bool) -> Case {
    let mut case = find_case(Path::new(name)).unwrap();
    case.accuracy.first_order = first_order;
    case
}

fn solved(case: &Case) -> Solution {
    solve(case, &Options::new(EdgeModel::QuarterSpace)).unwrap()
}

/// In plane strain the surface of a roller shrinks under the pressure, in proportion to it, and is
/// rounder there: with e = (C / R) (1 - nu1^2) E* / E1 (1 - 2 nu) / (2 (1 - nu)) the gap's slope is
/// 2 (x + e F), F the load from 0 to x. Under the slope a T_1 + e sum f_n T_n the pressure is
/// sqrt(1 - t^2) times U_0 (a + e f_1) and others that carry no load, so that a = 1 - e f_1 / 2.
#[test]
fn the_middle_of_a_long_contact_is_as_narrow_as_in_plane_strain() {
    let [flat, round] = [false, true].map(|order| {
        let mut case = straight(1e-3, 200.0, 1.0);
        case.accuracy.first_order = order;
        let lines = solved(&case).line_loads;
        lines[lines.len() / 2]
    });
    let (nu, curvature) = (0.3, 2.0 * (1e-3 / PI).sqrt());
    let e = 0.5 * curvature * (1.0 - 2.0 * nu) / (2.0 * (1.0 - nu));
    // F of the Hertz pressure at the cosine of an angle, and its first coefficient.
    let load = |angle: f64| 0.5 * (angle.cos() * angle.sin() + FRAC_PI_2 - angle);
    let (nodes, weights) = gauss_legendre(40);
    let angles = nodes.iter().map(|g| FRAC_PI_2 * (1.0 + g)).zip(&weights);
    let first: f64 = angles.map(|(angle, w)| w * load(angle) * angle.cos()).sum();
    // The ends move a little load away from the middle.
    let want = -0.5 * e * first + 0.5 * (round.load / flat.load - 1.0);
    let got = round.half_width / flat.half_width - 1.0;
    small(
        "change of the half-width, in that of plane strain, less 1",
        (got / want - 1.0).abs(),
        0.04,
    );
    assert!(want < -2e-3, "{want}");
}

/// From C / R = 0.1 on the terms of free ends no longer grow, neither in the pressure nor in the
/// stresses: in the plane x = 0 sigma_yy has no others.
#[test]
fn what_is_rounder_than_first_order_bears_has_the_terms_of_its_limit() {
    let limit = 0.25 * PI * 0.1f64.powi(2);
    let [flat, bounded, rounder] = [(limit, false), (limit, true), (0.05, true)].map(|it| {
        let mut case = straight(it.0, 5.0, 0.8).with_tolerance(1e-2);
        case.accuracy.first_order = it.1;
        solved(&case)
    });
    let mut grown = 0.0f64;
    for name in ["depth-end", "depth-0.9"] {
        let of = |s: &Solution| s.curves.curve(BodyKind::Roller, name).unwrap().stress.clone();
        let [flat, bounded, rounder] = [&flat, &bounded, &rounder].map(of);
        for ((flat, a), b) in flat.iter().zip(&bounded).zip(&rounder) {
            small("sigma_yy", (a.yy - b.yy).abs(), 1e-6);
            grown = grown.max((a.yy - flat.yy).abs());
        }
    }
    assert!(grown > 0.005, "{grown}");
}

/// Mirror images have mirrored pressures, and those of a body that is not symmetric about the
/// contact's middle come from both of its parts.
#[test]
fn mirror_images_are_mirrored() {
    let [left, right] = [-1.0, 1.0].map(|side| {
        let mut case = case("eccentric-half", true).with_tolerance(5e-3);
        case.load.eccentricity_m = case.load.eccentricity_m.map(|y| side * y.abs());
        solved(&case)
    });
    for (i, line) in left.line_loads.iter().enumerate() {
        let other = &right.line_loads[right.line_loads.len() - 1 - i];
        assert!((line.y + other.y).abs() < 1e-9, "{} {}", line.y, other.y);
        small("load per length", (line.load - other.load).abs(), 1e-5);
    }
    for body in BodyKind::ALL {
        let of = |solution: &Solution, name: &str| {
            solution.curves.curve(body, name).unwrap().stress.clone()
        };
        let pairs = [("depth-end", "depth-end-neg"), ("depth-0.9", "depth-0.9-neg")];
        for (one, other) in pairs {
            for (a, b) in of(&left, one).iter().zip(of(&right, other)).skip(2) {
                small("xx", (a.xx - b.xx).abs(), 1e-4);
                small("yz", (a.yz + b.yz).abs(), 1e-4);
            }
        }
    }
}

/// The corners of the study with the largest C / R, and its middle.
fn wide_cases() -> Vec<Case> {
    let wide = |case: &&Case| case.name.contains("w1e-3") || case.name == "centre";
    Study::built_in().cases().filter(wide).cloned().collect()
}

/// Errors against recorded finite elements, `edge` and more from the roller's corners: the root
/// mean square of the worst component on a curve, and the largest error, of block and roller.
fn errors(case: &Case, solution: &Curves, edge: f64) -> [[f64; 2]; 2] {
    assert!(case.accuracy.first_order);
    let recorded = FemResults::embedded_of(case).unwrap().expect("a record");
    let half = 0.5 * case.roller.length_m / case.hertz().c_m;
    let counts = |at: [f64; 3]| {
        let on_rim = at[2] == 0.0 && (at[0].abs() - 1.0).abs() < 0.06;
        away_from_edges(at, [-half, half], edge) && !on_rim
    };
    let (mut worst, mut largest) = ([0.0f64; 2], [0.0f64; 2]);
    for want in &recorded.finest().curves.stress {
        let got = solution.curve(want.body, &want.name).expect("the same curves");
        let body = usize::from(want.body == BodyKind::Roller);
        for component in 0..6 {
            let pairs = want.at.iter().zip(want.stress.iter().zip(&got.stress));
            let off: Vec<f64> = pairs
                .filter(|(at, _)| counts(**at))
                .map(|(_, (a, b))| a.components()[component] - b.components()[component])
                .collect();
            let rms = (off.iter().map(|d| d * d).sum::<f64>() / off.len() as f64).sqrt();
            worst[body] = worst[body].max(rms);
            largest[body] = off.iter().fold(largest[body], |m, d| m.max(d.abs()));
        }
    }
    [worst, largest]
}

/// Limits are a third to a half of the differences without these terms.
#[test]
fn round_rollers_have_the_stresses_of_finite_elements() {
    for case in wide_cases() {
        let [worst, largest] = errors(&case, &solved(&case).curves, EDGE);
        let name = &case.name;
        small(&format!("{name}: block, root mean square"), worst[0], 0.004);
        small(&format!("{name}: roller, root mean square"), worst[1], 0.006);
        small(&format!("{name}: block, largest"), largest[0], 0.010);
        small(&format!("{name}: roller, largest"), largest[1], 0.014);
    }
}

/// All cases of the study. The roller of the longest and widest one was off by 0.0124 without these
/// terms. Its cells are 0.1 C long, so that a point at 0.15 C lies in the second one.
#[test]
fn round_rollers_on_cells_have_the_stresses_of_finite_elements() {
    let cells = CellOptions { counts: Some([256, 400]), ..CellOptions::default() };
    for case in Study::built_in().cases() {
        let options = Options::new(EdgeModel::QuarterSpace);
        let found = solve_on_cells(case, &options, &cells, &|_, _| {}).unwrap().solution;
        let [worst, _] = errors(case, &found.curves, 0.15);
        small(&format!("{}: block", case.name), worst[0], 0.005);
        small(&format!("{}: roller", case.name), worst[1], 0.008);
    }
}

/// Models without free end faces have nothing of these terms, and share their solutions as before.
#[test]
fn only_free_ends_have_the_terms() {
    let heavier = |case: &Case| {
        let factors = case.factors();
        let other = straight(2.0 * factors.load, factors.slenderness, factors.length_ratio);
        Case { accuracy: case.accuracy, ..other }
    };
    for (model, first_order, same) in [
        (EdgeModel::QuarterSpace, true, false),
        (EdgeModel::QuarterSpace, false, true),
        (EdgeModel::Mirror, true, true),
    ] {
        let mut case = straight(3e-4, 5.0, 0.5);
        case.accuracy.first_order = first_order;
        let key = |case: &Case| Scene::new(case, model, None).key();
        assert_eq!(key(&case) == key(&heavier(&case)), same, "{model} {first_order}");
    }
}

/// Refuses a curve in the roller of `case` whose stresses are not within a `limit` those at the
/// points that `count`; gives all its points.
fn check_points(
    case: &Case,
    curve: &str,
    limit: f64,
    count: impl Fn(&[f64; 3]) -> bool,
) -> Vec<[f64; 3]> {
    let mut options = Options::new(EdgeModel::QuarterSpace);
    let line = solved(case).curves.curve(BodyKind::Roller, curve).unwrap().clone();
    let c_m = case.hertz().c_m;
    let body = BodyKind::Roller;
    options.points = line.at.iter().map(|at| Point { body, at_m: at.map(|v| v * c_m) }).collect();
    options.curves.clear();
    let points = solve(case, &options).unwrap().points;
    let pairs = line.at.iter().zip(line.stress.iter().zip(&points));
    for (_, (a, b)) in pairs.filter(|(at, _)| count(at)) {
        let pairs = a.components().into_iter().zip(b.components());
        small("line and point", pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max), limit);
    }
    line.at
}

/// Stresses down a line that goes deeper than the skin is felt are those at its points.
#[test]
fn lines_into_short_bodies_are_their_points() {
    let mut case = straight(2e-2, 0.7, 1.0).with_tolerance(5e-3);
    case.accuracy.first_order = true;
    let at = check_points(&case, "depth-end-x0.7", 1.5e-3, |_| true);
    assert!(at[at.len() - 1][2] > 5.0 * 0.7);
}

/// What the skin adds changes smoothly from one depth to the next, off all planes of symmetry: by
/// 0.04 C / R less smoothly where pieces of panels had the nodes that loads need.
#[test]
fn what_the_skin_adds_has_no_steps() {
    let mut case = straight(3e-3, 7.3, 0.8).with_tolerance(1e-2);
    let c_m = case.hertz().c_m;
    (case.pose.offset_m, case.load.eccentricity_m) = (0.9 * c_m, Some(0.6 * c_m));
    let mut options = Options::new(EdgeModel::QuarterSpace);
    options.curves.clear();
    let (columns, depths) = ([[0.4, -3.1], [2.2, 2.7], [1.3, 6.6]], 120);
    let at = |[x, y]: [f64; 2], i: i32| [x, y, 0.05 * 60f64.powf(f64::from(i) / 119.0)];
    let places = columns.iter().flat_map(|column| (0..depths).map(|i| at(*column, i)));
    let point = |at: [f64; 3]| Point { body: BodyKind::Roller, at_m: at.map(|v| v * c_m) };
    options.points = places.map(point).collect();
    let [flat, round] = [false, true].map(|order| {
        case.accuracy.first_order = order;
        solve(&case, &options).unwrap().points
    });
    let curvature = c_m / case.roller.radius_m;
    let pairs = round.iter().zip(&flat).map(|(a, b)| (a.components(), b.components()));
    let added: Vec<[f64; 6]> =
        pairs.map(|(a, b)| std::array::from_fn(|i| (a[i] - b[i]) / curvature)).collect();
    for (column, added) in columns.iter().zip(added.chunks(depths as usize)) {
        let worst = added
            .windows(3)
            .flat_map(|w| (0..6).map(|i| (w[1][i] - 0.5 * (w[0][i] + w[2][i])).abs()));
        small(&format!("second differences at {column:?}"), worst.fold(0.0, f64::max), 5e-3);
    }
}

/// Beside a face from which the contact has lifted off, stresses on the surface vary with the
/// distance from the face: 0.005 p0 off where only that from the contact's end counted.
#[test]
fn the_surface_beside_an_open_face_is_its_points() {
    let mut case = straight(2e-4, 12.0, 0.7).with_tolerance(5e-3);
    case.accuracy.first_order = true;
    case.load.eccentricity_m = Some(1e-3);
    let ends = solved(&case).summary.contact_y_m.map(|y| y / case.hertz().c_m);
    assert!(ends[0] > -8.0, "{ends:?}");
    check_points(&case, "surface-along-y", 5e-4, |[_, y, _]| *y < 0.0);
}
