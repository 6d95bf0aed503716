//! A solved case gives the same results in all its ways.

use super::{KeySolution, Options, Point, Scene, SolvedCase, SolvedScene, check_points, solve};
use crate::base::Material;
use crate::body::{EdgeModel, Resolution};
use crate::case::{Case, Factors, builtin_case};
use crate::contact::Coarser;
use crate::stress::{BodyKind, Grid};

#[test]
fn a_grid_is_what_points_are() {
    let mut case = builtin_case("half-short").unwrap().unwrap();
    case.accuracy.tolerance = 5e-3;
    let c = case.hertz().c_m;
    let end = case.factors().slenderness;
    let grid = Grid {
        x: vec![-1.2, -0.4, 0.0, 0.4, 2.0],
        y: vec![-end, -0.7 * end, 0.1 * end, 0.7 * end, end],
        z: vec![0.0, 0.3, 1.7],
    };
    let mut options = Options::new(EdgeModel::QuarterSpace);
    options.curves.clear();
    let solved = SolvedCase::new(&case, &options).unwrap();
    for body in BodyKind::ALL {
        let stress = solved.on_grid(body, &grid).unwrap();
        assert_eq!(stress.len(), 75);
        let (mut indices, mut places) = (Vec::new(), Vec::new());
        for (iz, &z) in grid.z.iter().enumerate() {
            for (iy, &y) in grid.y.iter().enumerate() {
                for (ix, &x) in grid.x.iter().enumerate() {
                    indices.push(grid.index(ix, iy, iz));
                    places.push([x, y, z]);
                }
            }
        }
        options.points = places.iter().map(|at| Point { body, at_m: at.map(|v| v * c) }).collect();
        let of_options = solve(&case, &options).unwrap().points;
        let of_places = solved.stress(body, &places).unwrap();
        for ((i, a), b) in indices.into_iter().zip(&of_options).zip(&of_places) {
            let got = stress.at(i).components();
            for ((got, a), b) in got.into_iter().zip(a.components()).zip(b.components()) {
                let off = (got - a).abs().max((got - b).abs());
                assert!(off < 1e-9, "{body:?} point {i}: {got} is not {a} or {b}");
            }
        }
    }
}

/// Where panels meet, in the middle of an eccentric line, the stresses on the surface are the mean
/// of those on both sides, whatever the polynomials on either side leave between them.
#[test]
fn where_panels_meet_stresses_are_those_of_both_sides() {
    for name in ["eccentric-flush", "offset-flush-end"] {
        let case = builtin_case(name).unwrap().unwrap().with_tolerance(1e-2);
        let scene = Scene::new(&case, EdgeModel::QuarterSpace, None);
        let own = SolvedScene::new(&scene).unwrap().resolution;
        // Half-widths far apart, and waves as long as these ask for.
        let far_apart = Resolution { corner: 0.04, spacing: [0.15; 2], k_max: 36.0, ..own };
        let resolution = if name == "eccentric-flush" { far_apart } else { own };
        let solved = SolvedScene::with_resolution(&scene, &resolution).unwrap();
        let breaks = solved.pressure.axis().breaks();
        let middle = breaks[breaks.len() / 2];
        for (body, x) in [(BodyKind::Block, 0.95), (BodyKind::Roller, 0.3)] {
            let places = [-1e-7, 0.0, 1e-7].map(|beside| (body, [x, middle + beside, 0.0]));
            let found = solved.stresses(&[], &places).points;
            let [before, at, after] = [0, 1, 2].map(|i| found[i].flat.pressure.components());
            for (got, (before, after)) in at.into_iter().zip(before.into_iter().zip(after)) {
                let off = (got - 0.5 * (before + after)).abs();
                assert!(off < 2e-5, "{name} {body:?}: {got} between {before} and {after}");
            }
        }
    }
}

#[test]
fn bad_grids_are_refused() {
    let case = builtin_case("flush-short").unwrap().unwrap();
    let solved = SolvedCase::new(&case, &Options::new(EdgeModel::Mirror)).unwrap();
    let good = Grid { x: vec![0.0], y: vec![0.0], z: vec![0.0] };
    let refused = |grid: Grid| solved.on_grid(BodyKind::Roller, &grid).unwrap_err().to_string();
    assert!(refused(Grid { x: vec![], ..good.clone() }).contains("0 x 1 x 1"));
    assert!(refused(Grid { x: vec![f64::NAN], ..good.clone() }).contains("grid x (roller)"));
    let end = case.factors().slenderness;
    assert!(refused(Grid { y: vec![-2.0 * end], ..good.clone() }).contains("keep |y| <="));
    assert!(refused(Grid { z: vec![-1e-9], ..good.clone() }).contains("keep 0 <= z"));
    let beside = -1.001 * case.roller.radius_m / case.hertz().c_m;
    let said = refused(Grid { x: vec![beside], ..good.clone() });
    assert!(said.contains("is beside the roller; keep |x| <= 0.01 m"), "{said}");
    let beyond = 2.0 * case.roller.radius_m / case.hertz().c_m * 1.001;
    let said = refused(Grid { z: vec![beyond], ..good.clone() });
    assert!(said.contains("grid z (roller)") && said.contains("outside the roller"), "{said}");
    // So does a raceway end; what is around a concave one has no end below.
    let inside = |radius_m: f64, at_m: [f64; 3]| {
        let mut raceway = case.clone();
        raceway.block.radius_m = Some(radius_m);
        check_points(&raceway, [(BodyKind::Block, at_m)]).map_err(|e| e.to_string())
    };
    for radius_m in [0.02, -0.02] {
        assert!(inside(radius_m, [0.019, 0.0, 1e-3]).is_ok());
        let said = inside(radius_m, [-0.021, 0.0, 0.0]).unwrap_err();
        assert!(said.contains("is beside the block; keep |x| <= 0.02 m"), "{said}");
    }
    assert!(inside(-0.02, [0.0, 0.0, 0.05]).is_ok());
    assert!(inside(0.02, [0.0, 0.0, 0.05]).unwrap_err().contains("is outside the block"));
    let many = Grid { x: vec![0.0; 5000], y: vec![0.0; 5000], z: vec![0.0] };
    assert!(refused(many).contains("5000 x 5000 x 1"));
    let said = solved.stress(BodyKind::Roller, &[[0.0, 0.0, beyond]]).unwrap_err().to_string();
    assert!(said.starts_with("z of point 1 (roller)"), "{said}");
}

/// A load this near to an end leaves hardly any contact to solve.
#[test]
fn a_load_at_the_very_end_is_refused_with_what_to_do() {
    let text = builtin_case("eccentric-half").unwrap().unwrap().to_toml();
    let mut case = Case::from_toml(&text).unwrap();
    case.accuracy.tolerance = 5e-2;
    case.load.eccentricity_m = Some(0.4999 * case.roller.length_m);
    let refused = SolvedCase::new(&case, &Options::new(EdgeModel::QuarterSpace)).err().unwrap();
    assert!(refused.to_string().contains("--engine cells"), "{refused}");
}

/// The case of a file, at a tolerance and without curves.
fn solved(toml: &str, tolerance: f64) -> SolvedCase {
    solved_by(EdgeModel::QuarterSpace, toml, tolerance)
}

/// The same by another model.
fn solved_by(model: EdgeModel, toml: &str, tolerance: f64) -> SolvedCase {
    contact_of(model, &Case::from_toml(toml).unwrap().with_tolerance(tolerance))
}

fn contact_of(model: EdgeModel, case: &Case) -> SolvedCase {
    let mut options = Options::new(model);
    options.curves.clear();
    SolvedCase::new(case, &options).unwrap()
}

/// A roller and a block with Fujiwara's profile whose curve is concave towards the ends, where they
/// press each other the more: as half-spaces, without limit.
const STEEP: &str = include_str!("../../tests/data/steep.toml");

#[test]
fn the_first_attempt_solves_steep_ends() {
    for model in EdgeModel::ALL {
        for tolerance in [3e-2, 1e-2] {
            let summary = solved_by(model, STEEP, tolerance).solution().summary;
            assert_eq!((summary.details.coarser, summary.warnings()), (None, vec![]), "{model}");
            let case = Case::from_toml(STEEP).unwrap().with_tolerance(tolerance);
            let (case, key) = KeySolution::new(&case, model).unwrap();
            assert_eq!(key.of(&case).warnings, [""; 0], "{model}");
        }
    }
}

/// It tells what was given up alone.
#[test]
fn a_contact_coarser_than_its_resolution_says_so() {
    let case = Case::from_toml(STEEP).unwrap().with_tolerance(3e-2);
    let mut scene = SolvedScene::new(&Scene::new(&case, EdgeModel::Mirror, None)).unwrap();
    let mut summary = contact_of(EdgeModel::Mirror, &case).solution().summary;
    let Resolution { spacing, modes, .. } = summary.details.resolution;
    for (times, fewer) in [(4.0, 0), (1.0, 1), (8.0, 1)] {
        let coarser = Coarser {
            spacing: spacing.map(|apart| times * apart),
            modes: modes - fewer,
            end_modes: modes - fewer,
        };
        summary.details.coarser = Some(coarser);
        scene.contact.coarser = Some(coarser);
        assert_eq!(scene.warnings(), ["coarser"]);
        let said = summary.warnings();
        assert!(summary.converged && said.len() == 1 && said[0].contains("`coarser`"), "{said:?}");
        let farther = format!("{times:.0} times as far apart");
        assert_eq!(said[0].contains(&farther), times > 1.0, "{said:?}");
        let left = format!("{} of {modes} modes", modes - fewer);
        assert_eq!(said[0].contains(&left), fewer > 0, "{said:?}");
    }
}

/// A logarithmic roller, steep within 0.1 C of its ends, of which the load presses one into a
/// longer block.
const PRESSED: &str = r#"
name = "pressed"
[roller]
radius_m = 10e-3
length_m = 4.84826e-3
young_pa = 210e9
poisson = 0.353
profile = { kind = "logarithmic", k = 0.98, amplitude_m = 5.415e-7 }
[block]
length_m = 7.8451e-3
young_pa = 124.9e9
poisson = 0.4495
[load]
force_n = 1607.3
eccentricity_m = 2.5614e-4
[pose]
offset_m = 7.62e-5
"#;

/// With Newton's steps alone half-widths as close as 1e-4 asks for were not found, and those twice
/// as far apart were 0.043 p0 off.
#[test]
fn steep_ends_are_found_as_closely_as_asked() {
    let [fine, finest] = [1e-3, 1e-4].map(|tolerance| solved(PRESSED, tolerance));
    assert_eq!(finest.solution().summary.warnings(), Vec::<String>::new());
    let end = 0.5 * finest.case().roller.length_m / finest.hertz().c_m;
    for inside in [0.05, 0.1, 0.2, 0.5] {
        let [a, b] = [&fine, &finest].map(|solved| solved.pressure(0.0, end - inside));
        assert!((a - b).abs() < 2e-3 && b > 1.0, "{inside}: {a} {b}");
    }
}

/// Without elastic bodies the roller would touch as far as y = -2.3 C alone. On 64 x 160 cells the
/// contact reaches both ends, with at most 1.336 p0. The search for its end,
/// at which a line far too short tells nothing of how far, stopped at y = -5.35 C, with 5 p0.
#[test]
fn a_held_tilt_that_a_first_guess_lifts_off_is_found() {
    let steel = Material { young_pa: 210e9, poisson: 0.3 };
    let factors = Factors { load: 3e-4, slenderness: 6.0, length_ratio: 1.0 };
    let mut case = Case::from_factors("tilted", 10e-3, steel, steel, factors).with_tolerance(5e-3);
    case.pose.tilt_rad = Some(5.4e-3);
    let solved = contact_of(EdgeModel::QuarterSpace, &case);
    let summary = &solved.solution().summary;
    assert_eq!(summary.warnings(), Vec::<String>::new());
    let half = 0.5 * solved.case().roller.length_m;
    assert!(summary.contact_y_m.iter().all(|y| (y.abs() - half).abs() < 1e-9 * half));
    let pressures = (-58..=58).map(|i| solved.pressure(0.0, 0.1 * f64::from(i)));
    let most = pressures.fold(0.0, f64::max);
    assert!((most - 1.336).abs() < 2e-3, "{most}");
    assert!((0.05..0.5).contains(&solved.pressure(0.0, -5.8)), "{}", solved.pressure(0.0, -5.8));
}

/// A roller with Lundberg's profile under an eccentric load, 25 C long to either side. The contact
/// ends 0.084 C before it does: the engine on 48 x 12000 cells has its last one, 0.0042 C long, up
/// to 0.0843 C from there.
const BESIDE: &str = r#"
name = "lundberg"
[roller]
radius_m = 17.59e-3
length_m = 20.29e-3
young_pa = 146.5e9
poisson = 0.2997
profile = { kind = "lundberg", design_force_n = 6354 }
[block]
length_m = 29.06e-3
young_pa = 89.48e9
poisson = 0.4137
[load]
force_n = 9421
eccentricity_m = 1.48e-3
"#;

#[test]
fn an_end_beside_the_rollers_is_the_contacts() {
    for (tolerance, within, of_load) in [(5e-3, 1e-3, 2e-2), (1e-3, 5e-4, 5e-3)] {
        let solved = solved(BESIDE, tolerance);
        let (solution, c_m) = (solved.solution(), solved.hertz().c_m);
        assert_eq!(solution.summary.warnings(), Vec::<String>::new());
        let to = solution.summary.contact_y_m[1];
        let inside = (0.5 * solved.case().roller.length_m - to) / c_m;
        assert!((inside - 0.0838).abs() < within, "{tolerance}: {inside}");
        // The line load falls towards it as on the cells, in terms of the largest.
        let lines = &solution.line_loads;
        let most = lines.iter().map(|line| line.load).fold(0.0, f64::max);
        for (y, on_cells) in [(25.1, 0.8543), (25.15, 0.6804), (25.18, 0.4388), (25.19, 0.3041)] {
            let after = lines.iter().position(|line| line.y > y).unwrap();
            let [a, b] = [&lines[after - 1], &lines[after]];
            let share = (y - a.y) / (b.y - a.y);
            let found = (a.load + share * (b.load - a.load)) / most;
            assert!((found - on_cells).abs() < of_load, "{tolerance}: {found} at {y}, {on_cells}");
        }
    }
}
