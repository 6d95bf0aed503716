//! Contacts and stresses on cells compared with an independent calculation and with the line
//! solver.

use crate::common::{near, scene, small, table};
use edgeline::base::profile::Table;
use edgeline::base::{Material, StressTensor};
use edgeline::body::EdgeModel;
use edgeline::case::{Case, Cells, Factors, ProfileKind, ProfileSpec, Surface, builtin_case};
use edgeline::cells::{CellPressure, CellProblem, CellTilt, Grid, Heights, RoughGap};
use edgeline::contact::{Gap, Straight};
use edgeline::solve::{
    CellOptions, Options, PEAK_CURVE, Point, Scene, SolvedCase, SolvedScene, layers_on_cells,
    loads_on_cells, solve, solve_on_cells, stress_on_cells,
};
use edgeline::stress::{BodyKind, away_from_edge, away_from_edges};
use std::f64::consts::PI;
use std::sync::Arc;

const HALF_LENGTH: f64 = 5.0;

fn on_cells(scene: &Scene, nx: usize, ny: usize, tolerance: f64) -> CellPressure {
    let grid = Grid::new(nx, ny, 1.5, scene.half_length).unwrap();
    scene.on_cells(grid, tolerance).solve(&Straight).unwrap()
}

/// The waves of tests/data/cells.py, a sample at the middle of each cell.
fn waves(grid: &Grid) -> Heights {
    let at =
        |x: f64, y: f64| 0.15 * ((7.0 * x + 1.0).sin() + 0.7 * (5.3 * x - 2.1 * y + 0.3).cos());
    let values = (0..grid.nx).flat_map(|i| (0..grid.ny).map(move |j| at(grid.x(i), grid.y(j))));
    let (a, b) = grid.half_sides();
    Heights::new([grid.nx, grid.ny], [2.0 * a, 2.0 * b], values.collect()).unwrap()
}

/// tests/data/cells.py: whole complex transforms, every image at its own place, Polonsky and Keer's
/// iteration.
#[test]
fn the_published_method_equals_an_independent_calculation() {
    let rows = table("cells.csv");
    for (name, model, ratio) in [
        ("half-space", EdgeModel::HalfSpace, 1.0),
        ("guilbault-flush", EdgeModel::Guilbault, 1.0),
        ("guilbault-half", EdgeModel::Guilbault, 0.5),
        ("rough-half", EdgeModel::Guilbault, 0.5),
    ] {
        let grid = Grid::new(96, 160, 1.5, HALF_LENGTH).unwrap();
        let problem = scene(HALF_LENGTH, ratio, 0.3, model).on_cells(grid, 1e-11);
        let heights = waves(&grid);
        let rough = RoughGap::new(&Straight, &heights, &grid, 1.0, 1.0).unwrap();
        let gap: &dyn Gap = if name == "rough-half" { &rough } else { &Straight };
        let solution = problem.solve(gap).unwrap();
        let p = |i: usize, j: usize| solution.pressure[j * 96 + i];
        let (mut off, mut all) = (0.0, 0.0);
        for (label, numbers) in &rows {
            let Some(line) = label.strip_prefix(name).map(str::trim) else { continue };
            let (index, want) = (numbers[0] as usize, numbers[1]);
            let whole = match line {
                "sum" => solution.pressure.iter().sum::<f64>(),
                "squares" => solution.pressure.iter().map(|p| p * p).sum(),
                "approach" => solution.approach,
                _ => {
                    let got = match line {
                        "along" => p(48, index),
                        "across" => p(index, 80),
                        "end" => p(index, 159),
                        line => panic!("{line}"),
                    };
                    off += (got - want).abs();
                    all += want;
                    continue;
                }
            };
            near(&format!("{name}, {line}"), whole / want, 1.0, 1e-8);
        }
        assert!(all > 50.0, "three lines of pressures");
        small(&format!("{name}, relative L1"), off / all, 1e-8);
    }
}

/// Root mean square of the pressure's difference to the line engine, over the cells of the contact
/// more than 0.15 C from its ends and 0.05 C from its edges, where a cell holds a mean over a steep
/// slope.
fn pressure_error(cells: &CellPressure, line: &SolvedScene) -> f64 {
    let grid = &cells.grid;
    let (mut sum, mut count) = (0.0, 0.0f64);
    for (i, p) in cells.pressure.iter().enumerate() {
        let (x, y) = (grid.x(i % grid.nx), grid.y(i / grid.nx));
        let inside = line.pressure.at(x.abs() + 0.05, y) > 0.0;
        if inside && grid.half_length - y.abs() > 0.15 {
            sum += (p - line.pressure.at(x, y)).powi(2);
            count += 1.0;
        }
    }
    (sum / count).sqrt()
}

#[test]
fn pressures_are_the_line_engines_for_every_edge_model() {
    for (slenderness, ratio) in [(5.0, 1.0), (5.0, 0.5)] {
        for model in EdgeModel::ALL {
            let scene = scene(slenderness, ratio, 0.3, model);
            let line = SolvedScene::new(&Scene { tolerance: 1e-4, ..scene.clone() }).unwrap();
            let cells = on_cells(&scene, 256, 400, 1e-8);
            let name = format!("{model}, S_l {slenderness}, L_r {ratio}");
            // Singular at both ends, or at one, or nowhere.
            let limit = match (model, ratio) {
                (EdgeModel::HalfSpace, _) => 3e-3,
                (_, 0.5) => 4e-4,
                _ => 2e-4,
            };
            small(&name, pressure_error(&cells, &line), limit);
        }
    }
}

#[test]
fn stresses_are_the_line_engines_for_the_published_models() {
    for model in [EdgeModel::HalfSpace, EdgeModel::Mirror, EdgeModel::Guilbault] {
        let scene = scene(HALF_LENGTH, 0.5, 0.3, model);
        let line = SolvedScene::new(&Scene { tolerance: 1e-4, ..scene.clone() }).unwrap();
        let cells = on_cells(&scene, 256, 400, 1e-8);
        // A half-space's pressure is singular at both ends: the cells' error there falls with their
        // length, 0.006 p0 at 128 x 200 and half of it here.
        let limit = if model == EdgeModel::HalfSpace { 0.008 } else { 0.004 };
        for kind in BodyKind::ALL {
            let field = scene.cell_field(kind, &cells).unwrap();
            let line = line.field(kind);
            for [x, y, z] in [[0.0, 0.0, 0.5], [0.4, 4.5, 0.3], [0.2, 5.0, 0.6], [-0.3, -4.8, 1.0]]
            {
                let (got, want) = (field.at(x, y, z), line.at(y, z, &[x])[0]);
                let name = format!("{model}, {} at {x} {y} {z}", kind.name());
                small(&name, crate::common::apart(&got, &want), limit);
            }
        }
    }
    let free = scene(HALF_LENGTH, 1.0, 0.3, EdgeModel::QuarterSpace);
    assert!(free.cell_field(BodyKind::Block, &on_cells(&free, 32, 40, 1e-6)).is_none());
}

#[test]
fn stresses_under_free_ends_are_the_line_engines() {
    let options = Options::new(EdgeModel::QuarterSpace);
    for name in ["flush-short", "half-short"] {
        let case = builtin_case(name).unwrap().unwrap();
        let line = solve(&case, &options).unwrap();
        let cells = CellOptions { counts: Some([256, 400]), ..CellOptions::default() };
        let cells = solve_on_cells(&case, &options, &cells, &|_, _| {}).unwrap().solution;
        let half_length = case.factors().slenderness;
        for (got, want) in cells.curves.stress.iter().zip(&line.curves.stress) {
            assert_eq!((got.body, &got.name), (want.body, &want.name));
            let pairs = got.at.iter().zip(got.stress.iter().zip(&want.stress));
            let off: Vec<f64> = pairs
                .filter(|(at, _)| away_from_edge(**at, half_length, 0.15))
                .map(|(_, (got, want))| crate::common::apart(got, want).powi(2))
                .collect();
            let rms = (off.iter().sum::<f64>() / off.len() as f64).sqrt();
            // On the surface the cells show the steps of their pressure.
            let limit = if got.name.starts_with("surface") { 4e-3 } else { 2e-3 };
            small(&format!("{name}, {} of the {}", got.name, got.body.name()), rms, limit);
        }
        near(name, cells.summary.approach_m / line.summary.approach_m, 1.0, 8e-4);
    }
}

/// Cases without symmetry: a crown and an eccentric load, an offset and a held tilt, profiles on
/// both bodies, a roller that is longer than the block.
const SKEW: [&str; 4] = [
    "[roller.profile]\nkind = \"crown\"\nradius_m = 2.0\n[load]\nforce_n = 3000.0\neccentricity_m = 1e-4",
    "[load]\nforce_n = 3000.0\n[pose]\noffset_m = 1e-3\ntilt_rad = 4e-5",
    "[roller.profile]\nkind = \"logarithmic\"\namplitude_m = 5e-7\nk = 0.9\n[block.profile]\nkind = \"crown\"\n\
     radius_m = 4.0\n[load]\nforce_n = 3000.0\n[pose]\noffset_m = -4e-4",
    "[load]\nforce_n = 3000.0\neccentricity_m = -1.5e-4\n[pose]\noffset_m = 3e-4",
];

fn skew(number: usize) -> Case {
    // The last one's roller is longer than its block.
    let (roller, block) = if number == 3 { (3.2e-3, 2.5e-3) } else { (2.5e-3, 2.5e-3) };
    let text = format!(
        "name = \"skew\"\n[roller]\nradius_m = 10e-3\nlength_m = {roller:e}\nyoung_pa = 210e9\npoisson = 0.3\n\
         [block]\nlength_m = {block:e}\nyoung_pa = 180e9\npoisson = 0.27\n{}",
        SKEW[number]
    );
    Case::from_toml(&text).unwrap()
}

/// A surface with these heights.
fn surface(shape: [usize; 2], steps: [f64; 2], values: Vec<f64>) -> Surface {
    Surface {
        heights: "heights".into(),
        dx_m: steps[0],
        dy_m: steps[1],
        detrend: None,
        samples: Some(Arc::new(Heights::new(shape, steps, values).unwrap())),
    }
}

/// A case by the line engine at its finest resolution, or at its own where that does not converge.
fn on_line(case: &Case, options: &Options) -> SolvedCase {
    let finest = SolvedCase::new(&case.clone().with_tolerance(1e-4), options);
    finest.unwrap_or_else(|_| SolvedCase::new(case, options).unwrap())
}

/// Differences between cells and the line engine's `solved` (p0): root mean squares of the pressure
/// and of the worst of the stress curves into and on the bodies, and those of the tilt (in
/// displacements of the contact's end) and of the approach (relative).
fn apart_from_line(
    case: &Case,
    options: &Options,
    solved: &SolvedCase,
    counts: [usize; 2],
) -> [f64; 5] {
    let line = solved.solution();
    let cells = CellOptions { counts: Some(counts), ..CellOptions::default() };
    let found = solve_on_cells(case, options, &cells, &|_, _| {}).unwrap();
    let cells = &found.solution;
    let [from, to] = case.overlap();
    let (mut sum, mut count) = (0.0, 0.0f64);
    for cell in &cells.cells {
        let inside = solved.pressure(cell.x.abs() + 0.05, cell.y) > 0.0;
        if inside && cell.y - from > 0.15 && to - cell.y > 0.15 {
            sum += (cell.p - solved.pressure(cell.x, cell.y)).powi(2);
            count += 1.0;
        }
    }
    // On the surface the stresses show the steps of the cells' pressure, and beside the contact's
    // edges the mean over a steep slope.
    let beside_edge = |[x, y, z]: [f64; 3]| {
        let [inner, outer] = [-0.05, 0.05].map(|by| solved.pressure(x.abs() + by, y) > 0.0);
        z == 0.0 && inner != outer
    };
    let mut worst = [0.0f64; 2];
    for (got, want) in cells.curves.stress.iter().zip(&line.curves.stress) {
        assert_eq!((got.body, &got.name, got.at.len()), (want.body, &want.name, want.at.len()));
        let pairs = got.at.iter().zip(got.stress.iter().zip(&want.stress));
        let off: Vec<f64> = pairs
            .filter(|(at, _)| away_from_edges(**at, [from, to], 0.15) && !beside_edge(**at))
            .map(|(_, (got, want))| crate::common::apart(got, want).powi(2))
            .collect();
        let own = &mut worst[usize::from(got.name.starts_with("surface"))];
        *own = own.max((off.iter().sum::<f64>() / off.len().max(1) as f64).sqrt());
    }
    let (got, want) = (&cells.summary, &line.summary);
    let slope = case.hertz().c_m / (2.0 * case.equivalent_radius_m());
    let tilt = (got.tilt_rad - want.tilt_rad).abs() / slope * 0.5 * (to - from);
    let approach = (got.approach_m / want.approach_m - 1.0).abs();
    [(sum / count).sqrt(), worst[0], worst[1], tilt, approach]
}

/// The four corners of the study that are symmetric, and four cases that are not.
fn eight_corners() -> Vec<(String, Case)> {
    let symmetric =
        [(5.0, 1.0), (5.0, 0.5), (20.0, 1.0), (20.0, 0.5)].map(|(slenderness, ratio)| {
            let steel = Material { young_pa: 210e9, poisson: 0.3 };
            let factors = Factors { load: 5e-4, slenderness, length_ratio: ratio };
            let case = Case::from_factors("corner", 10e-3, steel, steel, factors);
            (format!("S_l {slenderness}, L_r {ratio}"), case)
        });
    symmetric.into_iter().chain((0..4).map(|i| (format!("skew {i}"), skew(i)))).collect()
}

/// A block with a hollow of 2.5 times the roller's radius, beside the middle of an offset roller.
const HOLLOW: &str = "name = \"hollow\"\n[roller]\nradius_m = 8e-3\nlength_m = 2.5e-3\nyoung_pa = 210e9\n\
     poisson = 0.3\n[block]\nlength_m = 4e-3\nradius_m = -20e-3\nyoung_pa = 180e9\npoisson = 0.22\n\
     [load]\nforce_n = 3000.0\neccentricity_m = 1e-4\n[pose]\noffset_m = 2e-4";

#[test]
fn corners_are_the_line_engines_on_a_small_grid() {
    let mut all = eight_corners();
    // Some of them with what round surfaces make of the compliance and of the stresses.
    let rounded = |(name, case): (String, Case)| {
        let mut case = case;
        case.accuracy.first_order = true;
        (format!("{name}, to first order"), case)
    };
    let hollow = ("hollow".into(), Case::from_toml(HOLLOW).unwrap());
    let some = [all[1].clone(), all[5].clone(), hollow];
    all.extend(some.map(rounded));
    for (name, case) in all {
        let mut options = Options::new(EdgeModel::QuarterSpace);
        options.curves = ["depth-0.9", "along-y-0.78C"].map(String::from).to_vec();
        let line = on_line(&case, &options);
        let [pressure, stress, ..] = apart_from_line(&case, &options, &line, [48, 72]);
        let long = name.contains("20");
        small(&format!("{name}, pressure"), pressure, if long { 1.5e-2 } else { 3e-3 });
        small(&format!("{name}, stress"), stress, if long { 4e-3 } else { 3e-3 });
    }
}

/// What round bodies that are pressed at one end alone add is smooth along the line: with panels as
/// small at their corners as the line engine has there, pressures wavered by 0.006 p0.
#[test]
fn round_bodies_pressed_at_one_end_do_not_waver() {
    let mut case = skew(1);
    case.accuracy.first_order = true;
    let mut options = Options::new(EdgeModel::QuarterSpace);
    options.curves = vec!["depth-centre".into()];
    let line = on_line(&case, &options);
    let [pressure, ..] = apart_from_line(&case, &options, &line, [96, 288]);
    small("pressure", pressure, 5e-4);
}

/// What a round surface adds follows the contact's own ends, where the contact ends before its
/// bodies do: 0.0048 p0 beyond the end, where it followed the overlap's.
#[test]
fn round_shape_ends_with_the_contact_on_both_engines() {
    let case = Case::from_toml(
        "name = \"inside\"\n[roller]\nradius_m = 10e-3\nyoung_pa = 210e9\npoisson = 0.3\n\
         [block]\nyoung_pa = 210e9\npoisson = 0.3\n[dimensionless]\nW = 1e-3\nS_l = 5.0\nL_r = 0.5\n\
         [roller.profile]\nkind = \"crown\"\nradius_m = 0.07",
    );
    let case = case.unwrap();
    let mut options = Options::new(EdgeModel::QuarterSpace);
    options.bodies = vec![BodyKind::Roller];
    options.curves = ["depth-end", "along-y-0.5C"].map(String::from).to_vec();
    let line = on_line(&case, &options);
    let [_, stress, ..] = apart_from_line(&case, &options, &line, [96, 160]);
    let found = line.solution().summary.contact_y_m;
    assert!(found[1] < 0.9 * case.overlap_m()[1], "{found:?}");
    small("root mean square", stress, 8e-4);
}

/// What a round surface adds to a rough contact follows the loads around a place: a crown in the
/// heights is that of the line engine, and heights that rise across the contact move it by C, where
/// the roller's surface is turned by C / R. Under Hertz's mean load in the middle both were up to
/// 0.015 p0 off.
#[test]
fn round_shape_follows_the_loads_of_a_rough_contact() {
    let text = "name = \"crown\"\n[roller]\nradius_m = 10e-3\nyoung_pa = 210e9\npoisson = 0.3\n\
         [block]\nyoung_pa = 210e9\npoisson = 0.3\n[dimensionless]\nW = 1e-3\nS_l = 5.0\nL_r = 1.0";
    let plain = Case::from_toml(text).unwrap();
    let crown = format!("{text}\n[block.profile]\nkind = \"crown\"\nradius_m = 0.3");
    let crown = Case::from_toml(&crown).unwrap();
    let (c_m, unit_m) = (plain.hertz().c_m, plain.gap_unit_m());
    let turn = c_m / plain.roller.radius_m;
    let places = [(0.4, 0.1, 0.15), (-0.3, 0.4, 0.5), (0.7, -0.7, 0.5), (0.0, 0.7, 1.5)];
    let options = |at: &dyn Fn((f64, f64, f64)) -> [f64; 3]| {
        let point = |place| Point { body: BodyKind::Roller, at_m: at(place).map(|v| v * c_m) };
        let points = places.map(point).to_vec();
        let (curves, bodies) = (Vec::new(), vec![BodyKind::Roller]);
        Options { points, curves, bodies, ..Options::new(EdgeModel::QuarterSpace) }
    };
    for by in [0.0, 1.0] {
        // A point at a vertical depth lies farther out along the turned surface.
        let own = options(&|(x, y, z)| [x + by * z * turn, 5.0 * y, z]);
        let line = SolvedCase::new(&crown, &own).unwrap().solution();
        let mut rough = plain.clone();
        let (shape, steps) = ([61, 101], [0.1 * c_m, 0.1 * c_m]);
        let height = |k: usize| {
            let (x, y) = ((k / 101) as f64 - 30.0, (k % 101) as f64 - 50.0);
            0.2 * by * x * unit_m - (0.3 - (0.3f64.powi(2) - (y * steps[1]).powi(2)).sqrt())
        };
        rough.surface = Some(surface(shape, steps, (0..61 * 101).map(height).collect()));
        let cells = CellOptions { counts: Some([160, 160]), ..CellOptions::default() };
        let moved = options(&|(x, y, z)| [x + by, 5.0 * y, z]);
        let found = solve_on_cells(&rough, &moved, &cells, &|_, _| {}).unwrap().solution;
        for (i, (got, flat)) in found.points.iter().zip(&line.points).enumerate() {
            let StressTensor { xx, yy, zz, xy, xz, yz } = *flat;
            let (sin, cos) = (by * turn).sin_cos();
            let want = StressTensor {
                xx: xx * cos * cos + zz * sin * sin - 2.0 * xz * sin * cos,
                zz: zz * cos * cos + xx * sin * sin + 2.0 * xz * sin * cos,
                xz: (xx - zz) * sin * cos + xz * (cos * cos - sin * sin),
                xy: xy * cos - yz * sin,
                yz: yz * cos + xy * sin,
                yy,
            };
            let off = crate::common::apart(got, &want);
            small(&format!("moved by {by} C, {:?}", places[i]), off, 3e-3);
        }
    }
}

/// The tables of docs/performance.md, "Contacts on cells".
#[test]
#[ignore = "some minutes"]
fn corners_are_the_line_engines_by_every_model() {
    for (name, case) in eight_corners() {
        // The published models' pressure is singular at more of the ends: corners without symmetry
        // add nothing.
        let skew = name.contains("skew");
        for model in EdgeModel::ALL.into_iter().filter(|m| !skew || *m == EdgeModel::QuarterSpace) {
            let mut options = Options::new(model);
            let mut grids = vec![[64, 100], [128, 200], [256, 400]];
            if model != EdgeModel::QuarterSpace {
                // Love's sums take the time, and short lines need fewer cells.
                options.curves =
                    ["depth-0.9", "depth-end", "surface-along-y"].map(String::from).into();
                grids.remove(if name.contains("20") { 1 } else { 2 });
            }
            let line = on_line(&case, &options);
            let of_grid = |counts: &[usize; 2]| apart_from_line(&case, &options, &line, *counts);
            let found: Vec<_> = grids.iter().map(of_grid).collect();
            println!("{name} {model}: {found:?}");
            let (coarse, fine) = (found[0], found[found.len() - 1]);
            let [pressure, stress, surface, ..] = fine;
            small(&format!("{name}, {model}, pressure"), pressure, 4e-3);
            let limit = if model == EdgeModel::QuarterSpace { 6e-3 } else { 0.05 };
            small(&format!("{name}, {model}, stress"), stress, limit);
            if model == EdgeModel::QuarterSpace {
                small(&format!("{name}, {model}, stress on the surface"), surface, limit);
                assert!((0..2).all(|i| fine[i] < coarse[i]), "{name}: {found:?}");
            }
            assert!(pressure < coarse[0], "{name}, {model}: {found:?}");
        }
    }
}

/// Layers by transforms are the stresses at their points, of a skew contact with waves on it.
#[test]
fn layers_are_the_stresses_at_points_by_every_model() {
    let case = with_waves(skew(1));
    let [from, to] = case.overlap();
    let c_m = case.hertz().c_m;
    let cells = CellOptions { counts: Some([64, 72]), ..CellOptions::default() };
    for model in [EdgeModel::Guilbault, EdgeModel::QuarterSpace] {
        let mut options = Options::new(model);
        (options.curves, options.bodies) = (Vec::new(), vec![BodyKind::Block]);
        let found = solve_on_cells(&case, &options, &cells, &|_, _| {}).unwrap();
        let grid = &found.pressure.grid;
        let depths = [0.1, 0.6].map(|z| z * c_m);
        let layers = layers_on_cells(&case, &options, &found.pressure, &depths).unwrap();
        for layer in &layers {
            let places = [(32, 36), (20, 1), (40, 70), (9, 50)];
            let middle = 0.5 * (from + to);
            let at = |(i, j): (usize, usize)| {
                [grid.x(i) * c_m, (grid.y(j) + middle) * c_m, layer.depth_m]
            };
            options.points =
                places.map(|place| Point { body: layer.body, at_m: at(place) }).to_vec();
            let wanted = stress_on_cells(&case, &options, &found.pressure).unwrap();
            for ((i, j), want) in places.into_iter().zip(wanted) {
                let got = layer.stress.each_ref().map(|field| field[j * grid.nx + i]);
                let got = StressTensor::from_components(got);
                let name = format!("{model}, {i} {j} at {:.1e} m", layer.depth_m);
                small(&name, crate::common::apart(&got, &want), 1e-3);
            }
        }
    }
}

/// Points so far from the contact that the load's resultants alone count: those of a smooth
/// contact are the line engine's, and heights that rise across the contact move it, and them, by C.
#[test]
fn far_points_under_cells_are_the_line_engines() {
    let smooth = skew(3);
    let [from, to] = smooth.overlap();
    let (c_m, unit_m) = (smooth.hertz().c_m, smooth.gap_unit_m());
    let (half, middle) = (0.5 * (to - from), 0.5 * (from + to));
    let mut moved = smooth.clone();
    let (shape, span) = ([41, 11], [8.0 * c_m, (to - from) * c_m]);
    let steps = [span[0] / 40.0, span[1] / 10.0];
    let height = |k: usize| 2.0 * unit_m * ((k / shape[1]) as f64 * steps[0] / c_m - 4.0);
    moved.surface = Some(surface(shape, steps, (0..shape[0] * shape[1]).map(height).collect()));
    let places = [(30.0, 0.1, 0.0), (25.0, 3.0, 0.4), (-60.0, 20.0, -0.6), (8.0, 70.0, 0.3)];
    let options = |by: f64| {
        let at_m = |(x, z, y): (f64, f64, f64)| [x + by, middle + y * half, z].map(|v| v * c_m);
        let mut options = Options::new(EdgeModel::QuarterSpace);
        (options.curves, options.bodies) = (Vec::new(), vec![BodyKind::Block]);
        options.points = places.map(|at| Point { body: BodyKind::Block, at_m: at_m(at) }).to_vec();
        options
    };
    let line = SolvedCase::new(&smooth, &options(0.0)).unwrap().solution();
    let cells = CellOptions { counts: Some([96, 128]), ..CellOptions::default() };
    for (name, case, by) in [("smooth", &smooth, 0.0), ("moved", &moved, 1.0)] {
        let own = options(by);
        let found = solve_on_cells(case, &own, &cells, &|_, _| {}).unwrap();
        for (i, (got, want)) in found.solution.points.iter().zip(&line.points).enumerate() {
            small(&format!("{name}, {:?}", places[i]), crate::common::apart(got, want), 3e-4);
        }
        // A layer as deep.
        let (grid, depth_m) = (&found.pressure.grid, 50.0 * c_m);
        let layer = layers_on_cells(case, &own, &found.pressure, &[depth_m]).unwrap().remove(0);
        let (i, j) = (70, 20);
        let at_m = [grid.x(i) * c_m, (grid.y(j) + middle) * c_m, depth_m];
        let below = Options { points: vec![Point { body: BodyKind::Block, at_m }], ..own };
        let want = stress_on_cells(case, &below, &found.pressure).unwrap()[0];
        let got = layer.stress.each_ref().map(|field| field[j * grid.nx + i]);
        let off = crate::common::apart(&StressTensor::from_components(got), &want);
        small(&format!("{name}, layer"), off, 1e-5);
    }
}

/// Under a rough contact the pressure has an odd part across. Free ends make shears of that in the
/// plane x = 0, too, which has waves of its own: they are those beside it.
#[test]
fn stresses_in_the_plane_of_the_axis_are_those_beside_it() {
    let text = "name = \"plane\"\n[roller]\nradius_m = 10e-3\nyoung_pa = 210e9\npoisson = 0.3\n\
         [block]\nyoung_pa = 210e9\npoisson = 0.3\n[dimensionless]\nW = 1e-3\nS_l = 5.0\nL_r = 1.0\n\
         [accuracy]\nfirst_order = true";
    let mut case = Case::from_toml(text).unwrap();
    let (c_m, unit_m) = (case.hertz().c_m, case.gap_unit_m());
    let height = |k: usize| 0.05 * unit_m * ((k / 11) as f64 - 30.0);
    let steps = [0.1 * c_m, 1.1 * c_m];
    case.surface = Some(surface([61, 11], steps, (0..61 * 11).map(height).collect()));
    let options = |points| Options { points, ..Options::new(EdgeModel::QuarterSpace) };
    let cells = CellOptions { counts: Some([64, 64]), ..CellOptions::default() };
    let found = solve_on_cells(&case, &options(Vec::new()), &cells, &|_, _| {}).unwrap();
    for body in BodyKind::ALL {
        for (y, z) in [(4.75, 0.2), (-4.5, 0.3), (4.9, 0.5)] {
            // One at a time, as points of one column share their waves.
            let [before, at, after] = [-1e-3, 0.0, 1e-3].map(|x| {
                let points = vec![Point { body, at_m: [x, y, z].map(|v| v * c_m) }];
                stress_on_cells(&case, &options(points), &found.pressure).unwrap()[0]
            });
            assert!(at.xy.abs() > 0.005, "{body:?} {y} {z}: {at:?}");
            let off = crate::common::apart(&at, &((before + after) * 0.5));
            small(&format!("{body:?} {y} {z}"), off, 1e-4);
        }
    }
}

/// Half-side of a rough patch, beside which the gap is wide (C).
const PATCH: f64 = 0.95;

/// The gap of a plane and a rough patch on cells.
struct Patch {
    cells: usize,
    gaps: Vec<f64>,
}

impl Patch {
    /// Random waves of a self-affine surface, four to sixteen on a side: a Hurst exponent of 0.8,
    /// and a root mean square slope of one (2 R / C).
    fn new(cells: usize) -> Self {
        let mut state = 12345u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut waves = Vec::new();
        for (i, j) in (-16i32..=16).flat_map(|i| (0..=16).map(move |j| (i, j))) {
            let (qx, qy) = (PI * f64::from(i), PI * f64::from(j));
            let q = qx.hypot(qy);
            if (4.0 * PI..16.0 * PI).contains(&q) && (j > 0 || i > 0) {
                waves.push((qx, qy, 2.0 * PI * random(), q.powf(-1.8)));
            }
        }
        let slope: f64 = waves.iter().map(|(qx, qy, _, h)| 0.5 * h * h * (qx * qx + qy * qy)).sum();
        let place = |i: usize| (2 * i + 1) as f64 / cells as f64 - 1.0;
        let mut gaps = vec![0.0; cells * cells];
        for (qx, qy, phase, h) in waves {
            let across: Vec<_> = (0..cells).map(|i| (qx * place(i) + phase).sin_cos()).collect();
            for (j, row) in gaps.chunks_exact_mut(cells).enumerate() {
                let (sin, cos) = (qy * place(j)).sin_cos();
                for (gap, (s, c)) in row.iter_mut().zip(&across) {
                    *gap += h / slope.sqrt() * (c * cos - s * sin);
                }
            }
        }
        Self { cells, gaps }
    }
}

impl Gap for Patch {
    fn at(&self, x: f64, y: f64) -> f64 {
        if x.abs() > PATCH || y.abs() > PATCH {
            return 100.0;
        }
        let index = |v: f64| (0.5 * (v + 1.0) * self.cells as f64) as usize;
        self.gaps[index(y) * self.cells + index(x)]
    }
}

/// At small loads A = kappa F / (E* h'), with kappa about 2: sqrt(8 / pi) by Persson's theory,
/// sqrt(2 pi) by that of Bush, Gibson and Thomas (1975, Wear 35, 87), between them in calculations
/// (Hyun, Pei, Molinari, Robbins 2004, Phys. Rev. E 70, 026117). Cells make the area larger by a
/// part of their size along its boundary, which is taken off (Yastrebov, Anciaux, Molinari 2017,
/// Tribology International 114, 161).
#[test]
fn the_contact_area_of_a_self_affine_surface_grows_with_the_load() {
    let patch = Patch::new(256);
    let grid = Grid::new(256, 256, 1.0, 1.0).unwrap();
    let kappas: Vec<f64> = [0.01, 0.02, 0.04]
        .iter()
        .map(|mean| {
            let load = mean * (2.0 * PATCH).powi(2);
            let (images, free, most_iterations) = (Vec::new(), None, 1000);
            let tilt = CellTilt::Held(0.0);
            let problem =
                CellProblem { grid, images, free, load, tilt, tolerance: 1e-5, most_iterations };
            let found = problem.solve(&patch).unwrap();
            let pressed = |i: usize, j: usize| found.pressure[j * 256 + i] > 0.0;
            let pairs = (0..256).flat_map(|i| (1..256).map(move |j| (i, j)));
            let steps = pairs.map(|(i, j)| {
                let (own, before) =
                    ([pressed(j, i), pressed(i, j)], [pressed(j - 1, i), pressed(i, j - 1)]);
                (0..2).filter(|axis| own[*axis] != before[*axis]).count()
            });
            let boundary = 2.0 / 256.0 * steps.sum::<usize>() as f64;
            let excess = (PI - 1.0 + 2f64.ln()) / 24.0 * boundary * 2.0 / 256.0;
            // In units of C^2 / (2 R), C and p0 the contact modulus is one.
            (found.contact_area() - excess) / load
        })
        .collect();
    let (persson, bush) = ((8.0 / PI).sqrt(), (2.0 * PI).sqrt());
    assert!(kappas.iter().all(|kappa| (persson..bush).contains(kappa)), "{kappas:?}");
    small("area against load, change of its slope", 1.0 - kappas[2] / kappas[0], 0.15);
}

/// Heights that rise along the line are a smooth surface that is tilted by their slope: the tilt
/// that is held counts from the lines deep below, whatever distributes the load along the contact.
#[test]
fn a_plane_of_heights_is_a_held_tilt() {
    let slope = 3e-4;
    let flush = [EdgeModel::HalfSpace, EdgeModel::QuarterSpace].map(|model| (1, 0.0, model));
    for (number, offset_m, model) in [flush[0], flush[1], (2, -4e-4, EdgeModel::Mirror)] {
        let mut tilted = skew(number);
        tilted.pose.offset_m = offset_m;
        tilted.pose.tilt_rad = Some(slope);
        let mut rough = tilted.clone();
        rough.pose.tilt_rad = None;
        let [from, to] = tilted.overlap();
        let c_m = tilted.hertz().c_m;
        let steps = [4.0 * c_m / 59.0, (to - from) * c_m / 79.0];
        let plane = |k: usize| slope * ((k % 80) as f64 - 39.5) * steps[1];
        let values = (0..60 * 80).map(plane).collect();
        rough.surface = Some(surface([60, 80], steps, values));
        let cells = CellOptions { counts: Some([96, 128]), ..CellOptions::default() };
        let mut options = Options::new(model);
        options.curves = vec!["depth-0.9".into()];
        let solve = |case: &Case| solve_on_cells(case, &options, &cells, &|_, _| {}).unwrap();
        let [want, got] = [&tilted, &rough].map(solve);
        let pairs = got.pressure.pressure.iter().zip(&want.pressure.pressure);
        let off = pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
        small(&format!("plane {number}, {model}, pressure"), off, 1e-5);
        let [got, want] = [got, want].map(|found| found.solution.summary);
        let centres = [got, want].map(|summary| summary.centre_of_pressure_m[1] / c_m);
        assert!(centres[1].abs() > 0.01, "the tilt moves the load: {centres:?}");
        near(&format!("plane {number}, {model}, centre of pressure"), centres[0], centres[1], 1e-5);
    }
}

/// A load in the middle of symmetric bodies that are free to tilt lies there on heights, too: those
/// of a plane tilt the roller by their slope, and it presses as on smooth bodies.
#[test]
fn a_roller_that_is_free_lies_flat_on_a_plane_of_heights() {
    let slope = 4e-4;
    let smooth = builtin_case("flush-short").unwrap().unwrap();
    let mut rough = smooth.clone();
    rough.load.eccentricity_m = Some(0.0);
    let c_m = smooth.hertz().c_m;
    let steps = [4.0 * c_m / 59.0, smooth.roller.length_m / 79.0];
    let plane = |k: usize| slope * ((k % 80) as f64 - 39.5) * steps[1];
    rough.surface = Some(surface([60, 80], steps, (0..60 * 80).map(plane).collect()));
    for model in EdgeModel::ALL {
        let cells = CellOptions { counts: Some([48, 64]), ..CellOptions::default() };
        let mut options = Options::new(model);
        options.curves = vec!["depth-0.9".into()];
        let solve = |case: &Case| solve_on_cells(case, &options, &cells, &|_, _| {}).unwrap();
        let [want, got] = [&smooth, &rough].map(solve);
        let pairs = got.pressure.pressure.iter().zip(&want.pressure.pressure);
        let off = pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
        // Free ends are those of any pressure here, and of an even one on the smooth surface.
        let limit = if model == EdgeModel::QuarterSpace { 1e-3 } else { 1e-5 };
        small(&format!("free on a plane, {model}, pressure"), off, limit);
        let summary = got.solution.summary;
        near(&format!("free on a plane, {model}, tilt"), summary.tilt_rad / -slope, 1.0, 1e-5);
        let centre = summary.centre_of_pressure_m[1] / c_m;
        small(&format!("free on a plane, {model}, centre of pressure"), centre.abs(), 1e-6);
    }
}

/// A bump beside the contact of smooth bodies, beyond the cells that this one needs: they reach
/// farther, and where they may not the case is refused.
#[test]
fn a_bump_beyond_the_smooth_contact_carries_load() {
    let smooth = builtin_case("flush-short").unwrap().unwrap();
    let (c_m, [from, to]) = (smooth.hertz().c_m, smooth.overlap());
    let shape = [121, 121];
    let steps = [4.0 * c_m / 120.0, (to - from) * c_m / 120.0];
    let bump = |k: usize| {
        let x = ((k / 121) as f64 - 60.0) * steps[0] / c_m;
        let y = ((k % 121) as f64 - 60.0) * steps[1] / c_m;
        5e-6 * (-((x - 1.5).powi(2) + y * y) / 0.02).exp()
    };
    let raised = |by_m: f64| (0..121 * 121).map(|k| bump(k) + by_m).collect();
    let mut rough = smooth.clone();
    rough.surface = Some(surface(shape, steps, raised(0.0)));
    let mut options = Options::new(EdgeModel::Mirror);
    options.curves = vec!["depth-centre".into()];
    let solve = |case: &Case| {
        let cells = CellOptions { counts: Some([96, 128]), ..CellOptions::default() };
        solve_on_cells(case, &options, &cells, &|_, _| {})
    };
    let found = solve(&rough).unwrap();
    let [x, y] = found.solution.summary.p_max_at_m.map(|v| v / c_m);
    assert!((x - 1.5).abs() < 0.2 && y.abs() < 0.3, "{x} {y}");
    assert!(found.pressure.grid.half_width > 1.5);
    rough.cells = Some(Cells { half_width_m: 1.25 * c_m });
    let said = solve(&rough).unwrap_err().to_string();
    assert!(said.contains("beyond them heights touch") && said.contains("half_width_m"), "{said}");
    // A straight profile that is counted from elsewhere is the same one.
    let mut lowered = ProfileSpec::new(ProfileKind::Table);
    lowered.file = Some("drops.csv".into());
    lowered.table = Some(Arc::new(Table::new(vec![from, 0.0, to], vec![-1e-5; 3])));
    rough.roller.profile = Some(lowered);
    assert_eq!(solve(&rough).unwrap_err().to_string(), said);
    rough.roller.profile = None;
    // Wide enough, the answer is the same one.
    rough.cells = Some(Cells { half_width_m: found.pressure.grid.half_width * c_m });
    let wide = solve(&rough).unwrap().solution.summary;
    let found = found.solution.summary;
    near("pressure", wide.p_max_pa / found.p_max_pa, 1.0, 1e-6);
    // What all heights have in common changes the approach alone, also beside their range.
    for by_m in [-2e-3, 0.5] {
        rough.surface = Some(surface(shape, steps, raised(by_m)));
        let other = solve(&rough).unwrap().solution.summary;
        near("raised, pressure", other.p_max_pa / wide.p_max_pa, 1.0, 1e-8);
        near("raised, approach", (wide.approach_m - other.approach_m) / by_m, 1.0, 1e-9);
    }
}

/// The largest force takes a wider region of cells than the others.
#[test]
fn what_a_force_does_on_cells_does_not_depend_on_others_before_it() {
    let case = builtin_case("half-short").unwrap().unwrap();
    let options = Options::new(EdgeModel::HalfSpace);
    let cells = CellOptions { counts: Some([32, 32]), ..CellOptions::default() };
    let solve = |parts: &[f64]| {
        let forces: Vec<f64> = parts.iter().map(|part| part * case.load.force_n).collect();
        loads_on_cells(&case, &options, &cells, &forces, &|_, _| {}).unwrap()
    };
    let steps = solve(&[0.5, 4.0, 0.5]);
    assert_eq!(steps[0], steps[2]);
    assert_eq!(steps[1..], solve(&[4.0, 0.5]));
}

/// Pressures, tilt and stresses of a case by free ends, which sum the cells of a rough case by
/// other means than those of a smooth one.
#[test]
fn vanishing_heights_on_skew_bodies_with_free_ends_change_nothing() {
    for (number, first_order) in [(0, false), (1, false), (1, true)] {
        let mut smooth = skew(number);
        smooth.accuracy.first_order = first_order;
        let mut rough = smooth.clone();
        let [from, to] = smooth.overlap();
        let c_m = smooth.hertz().c_m;
        let span = [4.0 * c_m, (to - from) * c_m];
        let values = (0..60 * 80).map(|k| 1e-13 * f64::from(k).sin()).collect();
        let steps = [span[0] / 59.0, span[1] / 79.0];
        rough.surface = Some(surface([60, 80], steps, values));
        let cells = CellOptions { counts: Some([96, 128]), ..CellOptions::default() };
        let mut options = Options::new(EdgeModel::QuarterSpace);
        options.curves = ["depth-0.9", "depth-end-x0.7", "along-y-0.5C"].map(String::from).to_vec();
        let solve = |case: &Case| solve_on_cells(case, &options, &cells, &|_, _| {}).unwrap();
        let [smooth, rough] = [&smooth, &rough].map(solve);
        let pairs = rough.pressure.pressure.iter().zip(&smooth.pressure.pressure);
        let off = pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
        small(&format!("skew {number}, pressure"), off, 1e-3);
        let [got, want] = [&rough, &smooth].map(|found| found.solution.summary.tilt_rad);
        near(&format!("skew {number}, tilt"), got / want, 1.0, 1e-3);
        for curve in &rough.solution.curves.stress {
            let own = curve.name.strip_suffix("-xneg").unwrap_or(&curve.name);
            let all = &smooth.solution.curves.stress;
            // A smooth contact has no line under its largest pressure.
            if own == PEAK_CURVE {
                continue;
            }
            let twin = all.iter().find(|c| c.body == curve.body && c.name == own).unwrap();
            for (i, at) in curve.at.iter().enumerate() {
                if !away_from_edges(*at, [from, to], 0.3) || at[2] < 0.1 {
                    continue;
                }
                let mut want = twin.stress[i];
                if own != curve.name {
                    (want.xy, want.xz) = (-want.xy, -want.xz);
                }
                let off = crate::common::apart(&curve.stress[i], &want);
                assert!(off < 8e-3, "skew {number}, {}, {at:?}: {off}", curve.name);
            }
        }
    }
}

/// Waves of 20 nm over the contact of `case`.
fn with_waves(mut case: Case) -> Case {
    let [from, to] = case.overlap();
    let c_m = case.hertz().c_m;
    let steps = [4.0 * c_m / 59.0, (to - from) * c_m / 79.0];
    let values =
        (0..60 * 80).map(|k| 2e-8 * (f64::from(k / 80) * 0.9 + f64::from(k % 80) * 0.4).sin());
    let samples = Some(Arc::new(Heights::new([60, 80], steps, values.collect()).unwrap()));
    let [dx_m, dy_m] = steps;
    case.surface = Some(Surface { heights: "waves".into(), dx_m, dy_m, detrend: None, samples });
    case
}

#[test]
fn threads_change_nothing_with_free_ends() {
    let mut options = Options::new(EdgeModel::QuarterSpace);
    options.curves = ["depth-0.9", "surface-along-y"].map(String::from).to_vec();
    let cells = CellOptions { counts: Some([96, 128]), ..CellOptions::default() };
    let symmetric = builtin_case("half-short").unwrap().unwrap();
    for (name, case) in
        [("symmetric", symmetric), ("skew", skew(0)), ("rough", with_waves(skew(3)))]
    {
        let [one, three] = [1, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| solve_on_cells(&case, &options, &cells, &|_, _| {}).unwrap())
        });
        let pairs = one.pressure.pressure.iter().zip(&three.pressure.pressure);
        let off = pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
        small(&format!("{name}, pressure"), off, 1e-12);
        for (a, b) in one.solution.curves.stress.iter().zip(&three.solution.curves.stress) {
            let pairs = a.stress.iter().zip(&b.stress);
            let off = pairs.fold(0.0, |m: f64, (a, b)| m.max(crate::common::apart(a, b)));
            small(&format!("{name}, {} of the {}", a.name, a.body.name()), off, 1e-12);
        }
    }
}

#[test]
fn a_surface_of_vanishing_height_is_the_smooth_contact() {
    let scene = scene(HALF_LENGTH, 1.0, 0.3, EdgeModel::Guilbault);
    let grid = Grid::new(64, 96, 1.5, HALF_LENGTH).unwrap();
    let problem = scene.on_cells(grid, 1e-10);
    let smooth = problem.solve(&Straight).unwrap();
    let (c_m, unit_m) = (1e-3, 1e-6);
    let rough = |height_m: f64| {
        let wave = |k: usize| {
            height_m * ((k / 200) as f64 * 0.7).sin() * ((k % 200) as f64 * 0.4 + 1.0).cos()
        };
        let values = (0..80 * 200).map(wave).collect();
        let heights = Heights::new([80, 200], [0.04 * c_m, 0.055 * c_m], values).unwrap();
        let gap = RoughGap::new(&Straight, &heights, &grid, c_m, unit_m).unwrap();
        let found = problem.solve(&gap).unwrap();
        let off = found.pressure.iter().zip(&smooth.pressure).map(|(a, b)| (a - b).abs());
        off.fold(0.0, f64::max)
    };
    let [high, low] = [1e-8, 1e-10].map(rough);
    assert!(high > 1e-3, "{high}");
    small("pressure", low / high, 0.03);
}
