//! The solver against known solutions, an independent one, its own refinement and the laws that any
//! solution keeps. Lengths are in units of C, stresses in units of p0.

use std::f64::consts::PI;

use crate::common::{apart, scene, worse};
use edgeline::base::{Material, Panels, StressTensor};
use edgeline::body::{Body, EdgeModel, Resolution, Shape};
use edgeline::case::{Case, Factors};
use edgeline::kernels::{hertz, love, strip};
use edgeline::solve::{Options, Point, Scene, SolvedScene, solve};
use edgeline::stress::curves::standard_curves;
use edgeline::stress::{BodyKind, Field, Pressure, RoundStress};
use nalgebra::{DMatrix, DVector};

/// Distance from the roller's corner within which nothing is compared (C).
const CORNER: f64 = 0.1;

fn solved(slenderness: f64, length_ratio: f64, nu: f64, model: EdgeModel) -> SolvedScene {
    SolvedScene::new(&scene(slenderness, length_ratio, nu, model)).unwrap()
}

/// Half-length of a body of a scene.
fn half_of(scene: &Scene, kind: BodyKind) -> f64 {
    scene.bodies[kind].half
}

/// Points of the standard curves of a body, each outside [`CORNER`], named.
fn curve_points(scene: &Scene, kind: BodyKind) -> Vec<(&'static str, [f64; 3])> {
    let curves = standard_curves(kind, scene.half_length, half_of(scene, kind));
    let away = |at: &[f64; 3]| (at[1] - scene.half_length).hypot(at[2]) > CORNER * 0.999;
    let points = curves.into_iter().flat_map(|c| c.points.into_iter().map(move |p| (c.name, p)));
    points.filter(|(_, at)| away(at)).collect()
}

fn at(field: &Field, [x, y, z]: [f64; 3]) -> StressTensor {
    field.at(y, z, &[x])[0]
}

/// Asserts |got - want| <= tolerance and says what was got.
fn near(what: &str, got: f64, want: f64, tolerance: f64) {
    println!("{what}: {got:.5}, expected {want:.5} +- {tolerance}");
    assert!((got - want).abs() <= tolerance, "{what}: got {got}, expected {want} +- {tolerance}");
}

/// Asserts value <= tolerance and says what was got.
fn small(what: &str, value: f64, tolerance: f64) {
    println!("{what}: {value:.2e} of at most {tolerance:.0e}");
    assert!(value <= tolerance, "{what}: {value:e} > {tolerance:e}");
}

// --- Known pressures ---------------------------------------------------------------------------

/// Pressure on x = 0 by an independent calculation of another kind: cells of uniform pressure,
/// 0.04 long at the end and growing by 1.25, with 128 wavenumbers of a periodic transform.
#[test]
fn pressures_of_an_independent_calculation() {
    use EdgeModel::*;
    const DISTANCES: [f64; 6] = [0.1, 0.3, 0.6, 1.0, 2.0, 3.0];
    let rows: [(f64, f64, EdgeModel, [f64; 7]); 7] = [
        (5.0, 1.0, HalfSpace, [2.11, 1.36, 1.127, 1.025, 0.946, 0.919, 0.905]),
        (5.0, 1.0, Mirror, [1.025, 1.016, 1.010, 1.006, 1.000, 0.997, 0.995]),
        (5.0, 1.0, Guilbault, [0.747, 0.904, 0.963, 0.991, 1.011, 1.016, 1.019]),
        (5.0, 1.0, QuarterSpace, [0.735, 0.858, 0.933, 0.9735, 1.008, 1.018, 1.023]),
        (5.0, 0.5, QuarterSpace, [1.211, 1.076, 1.031, 1.009, 0.990, 0.983, 0.9785]),
        (20.0, 1.0, QuarterSpace, [0.690, 0.812, 0.886, 0.928, 0.968, 0.9835, 1.0165]),
        (20.0, 0.5, QuarterSpace, [1.255, 1.113, 1.065, 1.042, 1.021, 1.011, 0.986]),
    ];
    for (slenderness, length_ratio, model, row) in rows {
        let solved = solved(slenderness, length_ratio, 0.3, model);
        let tolerance = if model == QuarterSpace { 0.004 } else { 0.01 };
        for (distance, want) in DISTANCES.into_iter().zip(row) {
            // Where p has no limit at the end, that calculation's cells are too long next to it:
            // halving them moves its half-space value at 0.1 from 2.06 to 2.03 and on. There the
            // value is our own of twice the resolution and the extent (and so of four times, to
            // the last digit).
            let want = match (model, length_ratio, distance) {
                (HalfSpace, _, d) if d < 1.0 => continue,
                (QuarterSpace, 0.5, 0.1) => [1.2061, 1.2503][usize::from(slenderness > 10.0)],
                _ => want,
            };
            let got = solved.pressure.at(0.0, slenderness - distance);
            near(&format!("{model} {slenderness} {length_ratio} {distance}"), got, want, tolerance);
        }
        near(&format!("{model} centre"), solved.pressure.at(0.0, 0.0), row[6], tolerance);
    }
}

/// Mid-plane of a long contact whose ends lose no load sideways. (Free ends do: a flush one still
/// raises the middle by 1.3 % of p0 at S_l = 200, as what its ends carry less has to go somewhere.)
/// The half-space's pressure, which grows without bound at the end, from coarse answers: 1 % of itself as
/// far as 0.1 C from there.
#[test]
fn coarse_half_spaces_are_good_to_one_percent() {
    let line = |tolerance| {
        let scene = scene(5.0, 1.0, 0.3, EdgeModel::HalfSpace);
        let solved = SolvedScene::new(&Scene { tolerance, ..scene }).unwrap();
        (0..=980).map(move |i| solved.pressure.at(0.0, 4.9 * f64::from(i) / 980.0))
    };
    for tolerance in [1e-2, 5e-3] {
        let pairs = line(tolerance).zip(line(1e-3));
        let worst = pairs.map(|(got, want)| (got / want - 1.0).abs()).fold(0.0, f64::max);
        small(&format!("tolerance {tolerance:e}, relative"), worst, 0.8e-2);
    }
}

#[test]
fn long_contact_is_plane_strain() {
    let solved = solved(200.0, 1.0, 0.3, EdgeModel::Mirror);
    for i in 0..=18 {
        let x = 0.05 * f64::from(i);
        let tolerance = if i == 0 { 2e-3 } else { 5e-3 };
        let got = solved.pressure.at(x, 0.0);
        near(&format!("p at {x}"), got, hertz::line_pressure(x), tolerance);
    }
    let field = solved.field(BodyKind::Block);
    for z in [0.0, 0.1, 0.3, 0.5, 0.7861, 1.0, 1.5, 2.0, 3.0, 5.0] {
        for x in [0.0, 0.5] {
            let got = at(&field, [x, 0.0, z]);
            let want = hertz::line_stress(x, z, 0.3);
            small(&format!("stress at {x} {z}"), apart(&got, &want), 5e-3);
            near(&format!("tau_max at {x} {z}"), got.tau_max(), want.tau_max(), 5e-3);
        }
    }
}

/// The approach of points at a depth in plane strain: the integral of (1 - e^(-k d)) 2 J1(k) / k^2 over k,
/// whose derivative in d is 2 (sqrt(1 + d^2) - d).
#[test]
fn approach_of_a_long_contact_is_that_of_plane_strain() {
    for tolerance in [1e-2, 1e-3] {
        let scene = Scene { tolerance, ..scene(900.0, 1.0, 0.3, EdgeModel::Mirror) };
        let solved = SolvedScene::new(&scene).unwrap();
        for d in [3.0f64, 10.0, 40.0] {
            let want = d * (1.0 + d * d).sqrt() + d.asinh() - d * d;
            near(&format!("approach at {d}"), solved.approach(d), want, 0.005 * want);
        }
    }
}

/// Without Poisson's effect plane strain pulls at no end face: flush ends are not felt at all.
#[test]
fn flush_ends_without_lateral_strain_are_not_felt() {
    let solved = solved(5.0, 1.0, 0.0, EdgeModel::QuarterSpace);
    let mut worst: f64 = 0.0;
    for i in 0..=50 {
        for x in [0.0, 0.5, 0.9, 1.1] {
            let p = solved.pressure.at(x, 0.1 * f64::from(i));
            worst = worse(worst, (p - hertz::line_pressure(x)).abs());
        }
    }
    small("pressure", worst, 5e-4);
    let field = solved.field(BodyKind::Block);
    let off = |(_, p): (_, [f64; 3])| apart(&at(&field, p), &hertz::line_stress(p[0], p[2], 0.0));
    let points = curve_points(&solved.scene, BodyKind::Block);
    small("stresses", points.into_iter().map(off).fold(0.0, worse), 1e-3);
}

/// A block whose end is 50 C away, pressed by a rigid roller, is a half-space to the contact.
#[test]
fn a_far_end_is_no_end() {
    let rigid = |model, half| {
        let mut scene = scene(5.0, 5.0 / half, 0.3, model);
        (scene.bodies.block.share, scene.bodies.roller.share) = (1.0, 0.0);
        SolvedScene::new(&scene).unwrap()
    };
    let endless = rigid(EdgeModel::HalfSpace, 55.0);
    let ends = rigid(EdgeModel::QuarterSpace, 55.0);
    let worst = (0..=98).flat_map(|i| [0.0, 0.5, 0.8].map(|x| (x, 0.05 * f64::from(i))));
    let off = |(x, y)| (endless.pressure.at(x, y) - ends.pressure.at(x, y)).abs();
    small("pressure", worst.map(off).fold(0.0, worse), 2e-3);
    let fields = [endless.field(BodyKind::Block), ends.field(BodyKind::Block)];
    let points = curve_points(&endless.scene, BodyKind::Block);
    let off = |(_, p): (_, [f64; 3])| apart(&at(&fields[0], p), &at(&fields[1], p));
    small("stresses", points.into_iter().map(off).fold(0.0, worse), 5e-3);
}

/// Half-space stresses as `solve` gives them at extra points, against Love's stresses summed over
/// fine cells of the same pressure.
#[test]
fn stresses_of_cells() {
    let case = case(5e-4, 5.0, 0.5);
    let hertz = case.hertz();
    let places = [
        [0.0, 0.0, 0.3],
        [0.4, 1.0, 0.7],
        [0.0, 4.5, 0.5],
        [0.6, 5.0, 0.4],
        [0.3, 5.6, 0.3],
        [2.0, 3.0, 1.0],
        [1.5, 7.0, 3.0],
        [0.2, 4.0, 8.0],
    ];
    for model in [EdgeModel::HalfSpace, EdgeModel::Mirror] {
        let scene = Scene::new(&case, model, None);
        let solved = SolvedScene::new(&scene).unwrap();
        // Cells of the pressure: 0.05 wide, graded towards the end of the line.
        let mut ends = vec![0.0f64, 0.002];
        while ends[ends.len() - 1] < 5.0 {
            let last = ends[ends.len() - 1];
            ends.push((last + (0.2 * last).clamp(0.002, 0.1)).min(5.0));
        }
        let mut cells = Vec::new();
        for pair in ends.windows(2) {
            let along = Panels::new(vec![5.0 - pair[1], 5.0 - pair[0]], 4);
            for i in 0..26 {
                let [low, high] = [f64::from(i), f64::from(i + 1)].map(|i| -1.3 + 0.1 * i);
                let force: f64 = along
                    .nodes()
                    .iter()
                    .zip(along.weights())
                    .map(|(&y, w)| {
                        let (a, c) = solved.pressure.modes(y).unwrap();
                        w * (strip::cumulative(a, &c, high) - strip::cumulative(a, &c, low))
                    })
                    .sum();
                let (b, a) = (0.5 * (pair[1] - pair[0]), 0.05);
                cells.push((0.5 * (low + high), 5.0 - 0.5 * (pair[0] + pair[1]), a, b, force));
            }
        }
        for body in BodyKind::ALL {
            let half = half_of(&scene, body);
            let shifts: &[f64] =
                if model == EdgeModel::Mirror { &[0.0, -2.0, 2.0] } else { &[0.0] };
            let inside = places.iter().filter(|at| at[1] <= half);
            let points: Vec<Point> =
                inside.map(|at| Point { body, at_m: at.map(|v| v * hertz.c_m) }).collect();
            let mut options = Options::new(model);
            options.curves.clear();
            options.points.clone_from(&points);
            let solution = solve(&case, &options).unwrap();
            let flat = |[x, y, z]: [f64; 3]| {
                let mut sum = StressTensor::default();
                for &(u, v, a, b, force) in &cells {
                    for shift in shifts {
                        for sign in [1.0, -1.0] {
                            let source = sign * v + shift * half;
                            let unit = love::stress(x - u, y - source, z, a, b, 0.3);
                            sum += unit * (force / (4.0 * a * b));
                        }
                    }
                }
                sum
            };
            for (point, got) in points.iter().zip(&solution.points) {
                let [x, y, z] = point.at_m.map(|v| v / hertz.c_m);
                let mut want = flat([x, y, z]);
                if body == BodyKind::Roller {
                    let slope = (flat([x + 1e-3, y, z]) - flat([x - 1e-3, y, z])) * 500.0;
                    let curvature = hertz.c_m / case.roller.radius_m;
                    want = RoundStress::new(x, z, want, &slope).at(curvature);
                }
                let got = *got * (1.0 / hertz.p0_pa);
                small(&format!("{model} {} {x} {y} {z}", body.name()), apart(&got, &want), 3e-3);
            }
        }
    }
}

/// On the roller's end face, off all planes of symmetry. Finite elements with 440,000 unknowns have
/// sigma_zz = -0.2754 p0 on the end face there.
#[test]
fn the_round_roller_is_right_at_its_end_face() {
    let material = Material { young_pa: 210e9, poisson: 0.25 };
    let factors = Factors { load: 3e-4, slenderness: 8.0, length_ratio: 0.8 };
    let case = Case::from_factors("case", 0.01, material, material, factors);
    let hertz = case.hertz();
    let mut options = Options::new(EdgeModel::QuarterSpace);
    options.curves.clear();
    options.points = [7.8, 7.95, 7.99, 7.999, 8.0]
        .map(|y| Point { body: BodyKind::Roller, at_m: [1.392, y, 1.912].map(|v| v * hertz.c_m) })
        .to_vec();
    for tolerance in [5e-3, 1e-3, 1e-4] {
        let solution = solve(&Case { tolerance, ..case.clone() }, &options).unwrap();
        for (point, stress) in options.points.iter().zip(&solution.points) {
            let off = (stress.zz / hertz.p0_pa + 0.2754).abs();
            small(&format!("sigma_zz at y = {:e} m, {tolerance}", point.at_m[1]), off, 6e-3);
        }
    }
}

// --- Laws of any solution ----------------------------------------------------------------------

/// Betti: the work of one pressure on another's displacement is the same both ways.
#[test]
fn compliance_is_reciprocal() {
    let resolution = Resolution::for_tolerance(1e-3);
    for (half, model) in [
        (5.0, EdgeModel::HalfSpace),
        (5.0, EdgeModel::Mirror),
        (5.0, EdgeModel::QuarterSpace),
        (5.5, EdgeModel::QuarterSpace),
        (10.0, EdgeModel::QuarterSpace),
    ] {
        let body =
            Body::new(Shape { contact: 5.0, half, nu: 0.3 }, model.end(0.3, None), &resolution);
        let axis = resolution.contact_axis(5.0);
        let (nodes, weights) = (axis.nodes(), axis.weights());
        let shapes: [&dyn Fn(f64) -> f64; 4] =
            [&|_| 1.0, &|y| (y / 5.0).powi(8), &|y| (0.3 * PI * y).cos(), &|y| {
                (-2.0 * (5.0 - y)).exp() * (5.0 - y)
            }];
        for k in [0.01, 0.1, 1.0, 5.0, 30.0] {
            let compliance = body.layer(k).compliance;
            let work = |f: &dyn Fn(f64) -> f64, g: &dyn Fn(f64) -> f64| -> f64 {
                let g = DVector::from_fn(nodes.len(), |i, _| g(nodes[i]));
                let u = &compliance * g;
                (0..nodes.len()).map(|i| weights[i] * f(nodes[i]) * u[i]).sum()
            };
            for (i, f) in shapes.iter().enumerate() {
                for g in &shapes[..i] {
                    let scale = (work(f, f) * work(g, g)).sqrt();
                    let off = (work(f, g) - work(g, f)).abs() / scale;
                    // Beyond the first period the images' own shape is replaced by their mean: the
                    // complete model is reciprocal to what that leaves at small wavenumbers.
                    let tolerance = if model == EdgeModel::QuarterSpace { 2e-2 } else { 5e-4 };
                    small(&format!("{model} to {half} at k = {k}, shape {i}"), off, tolerance);
                }
            }
        }
    }
}

/// Rounding costs a few hundred units of 1e-16 at most, however fine the grading, long the body, near
/// its end, small the wavenumber or incompressible the material.
#[test]
fn equations_of_the_end_faces_are_well_conditioned() {
    let usual = Resolution::for_tolerance(1e-3);
    let at = |slenderness: f64, half: f64, nu: f64, resolution: &Resolution, k: f64| {
        let shape = Shape { contact: slenderness, half, nu };
        Body::new(shape, EdgeModel::QuarterSpace.end(nu, None), resolution).layer(k).condition
    };
    let say = |what: &str, values: Vec<f64>| {
        println!(
            "{what}: {}",
            values.iter().map(|v| format!("{v:.3}")).collect::<Vec<_>>().join(" ")
        );
        for value in values {
            assert!((1.0..1e3).contains(&value), "{what}: {value:e}");
        }
    };
    let wavenumbers = [1e-4, 1e-3, 1e-2, 0.1, 0.3, 1.0, 10.0, 100.0];
    say("k", wavenumbers.map(|k| at(5.0, 5.0, 0.3, &usual, k)).to_vec());
    say("k, longer", wavenumbers.map(|k| at(5.0, 10.0, 0.3, &usual, k)).to_vec());
    say("nu", [0.0, 0.1, 0.3, 0.45, 0.499].map(|nu| at(5.0, 5.0, nu, &usual, 0.1)).to_vec());
    let graded = |corner: f64| Resolution { corner, ..usual.clone() };
    let corners = [0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4];
    say("corner", corners.map(|c| at(5.0, 5.0, 0.3, &graded(c), 1.0)).to_vec());
    let ratio = |ratio: f64| Resolution { ratio, ..usual.clone() };
    say("ratio", [3.0, 2.0, 1.5, 1.3].map(|r| at(5.0, 5.0, 0.3, &ratio(r), 1.0)).to_vec());
    let reach = |face_reach: f64| Resolution { face_reach, ..usual.clone() };
    say("depth", [7.0, 14.0, 28.0, 56.0].map(|r| at(5.0, 5.0, 0.3, &reach(r), 0.1)).to_vec());
    let lengths = [0.5, 5.0, 50.0, 500.0];
    say("length", lengths.map(|s| at(s, s, 0.3, &usual, 0.25 / s)).to_vec());
    let ledges = [1e-8, 1e-4, 1e-2, 0.1, 1.0, 100.0];
    say("ledge", ledges.map(|l| at(5.0, 5.0 + l, 0.3, &usual, 0.1)).to_vec());
}

/// No pressure gives work back, whatever weight the images have: contacts have one solution. (It takes
/// images that push, psi < -1, to break that; the field's own range is 0 to 2.)
#[test]
fn compliance_is_positive_definite() {
    for (model, psi) in [
        (EdgeModel::HalfSpace, 1.0),
        (EdgeModel::Mirror, 1.0),
        (EdgeModel::Guilbault, 1.5),
        (EdgeModel::Guilbault, 2.0),
        (EdgeModel::Guilbault, 10.0),
        (EdgeModel::QuarterSpace, 1.0),
    ] {
        for (slenderness, length_ratio) in
            [(0.5, 1.0), (0.5, 0.99), (2.0, 1.0), (5.0, 1.0), (5.0, 0.9), (20.0, 1.0), (200.0, 1.0)]
        {
            let smallest = smallest_energy(slenderness, length_ratio, model, psi);
            assert!(smallest > 0.0, "{model} {psi} {slenderness} {length_ratio}: {smallest:e}");
        }
    }
    assert!(smallest_energy(0.5, 1.0, EdgeModel::Guilbault, -1.2) < 0.0);
}

/// Smallest eigenvalue of the symmetric part of a body's compliance at any wavenumber, for pressures
/// whose mean square along the line is one, relative to the largest.
fn smallest_energy(slenderness: f64, length_ratio: f64, model: EdgeModel, psi: f64) -> f64 {
    let resolution = Resolution::for_tolerance(1e-2);
    let half = slenderness / length_ratio;
    let shape = Shape { contact: slenderness, half, nu: 0.3 };
    let body = Body::new(shape, model.end(0.3, Some(psi)), &resolution);
    let axis = resolution.contact_axis(slenderness);
    let root: Vec<f64> = axis.weights().iter().map(|w| w.sqrt()).collect();
    let wavenumbers = resolution.wavenumbers(half);
    let energies = wavenumbers.coarse().nodes().iter().map(|&k| {
        let c = body.layer(k).compliance;
        let energy = DMatrix::from_fn(root.len(), root.len(), |i, j| {
            0.5 * (c[(i, j)] * root[i] / root[j] + c[(j, i)] * root[j] / root[i])
        });
        let values = energy.symmetric_eigenvalues();
        values.min() / values.max()
    });
    energies.fold(f64::INFINITY, f64::min)
}

/// The field of a body under a pressure of half-width 1 and one mode, given by its amplitude
/// along y.
fn field_of(amplitude: impl Fn(f64) -> f64) -> impl Fn([f64; 3]) -> StressTensor {
    let resolution = Resolution::for_tolerance(1e-3);
    let shape = Shape { contact: 3.0, half: 4.0, nu: 0.3 };
    let body = Body::new(shape, EdgeModel::QuarterSpace.end(0.3, None), &resolution);
    let wavenumbers = resolution.wavenumbers(4.0);
    let layers: Vec<_> = wavenumbers.coarse().nodes().iter().map(|&k| body.layer(k)).collect();
    let axis = resolution.contact_axis(3.0);
    let amplitudes = axis.nodes().iter().map(|&y| vec![amplitude(y)]).collect();
    let pressure = Pressure::new(axis.clone(), vec![1.0; axis.len()], amplitudes);
    let moments = pressure.moments(&wavenumbers);
    move |place| {
        at(&Field::new(&body, &wavenumbers, &layers, &pressure, &moments, None, 1e-3), place)
    }
}

/// What is left of the three tractions on the end faces, 40 x 40 points of each.
#[test]
fn end_faces_are_free() {
    for (slenderness, length_ratio, nu) in [
        (5.0, 1.0, 0.3),
        (5.0, 0.5, 0.3),
        (20.0, 1.0, 0.3),
        (20.0, 0.5, 0.3),
        (1.0, 1.0, 0.3),
        (5.0, 0.99, 0.3),
        (5.0, 1.0, 0.45),
    ] {
        let solved = solved(slenderness, length_ratio, nu, EdgeModel::QuarterSpace);
        let xs: Vec<f64> = (0..40).map(|i| 4.0 * f64::from(i) / 39.0).collect();
        for kind in BodyKind::ALL {
            let field = solved.field(kind);
            // On the face itself zero is put in; so near to it the fields say what they are.
            let y = half_of(&solved.scene, kind) * (1.0 - 2e-9);
            let mut left = [0.0; 3];
            for i in 0..40 {
                let z = 0.02 * 500f64.powf(f64::from(i) / 39.0);
                for s in field.at(y, z, &xs) {
                    for (worst, traction) in left.iter_mut().zip([s.yy, s.xy, s.yz]) {
                        *worst = worse(*worst, traction.abs());
                    }
                }
            }
            for (name, left) in ["yy", "xy", "yz"].iter().zip(left) {
                let what = format!("{} {slenderness} {length_ratio} {nu}: {name}", kind.name());
                small(&what, left, 5e-3);
            }
        }
    }
}

/// The force through a plane under the contact is the load: a half-space's misses what it lets pass
/// beyond the end faces.
#[test]
fn planes_carry_the_load() {
    for (slenderness, length_ratio) in [(5.0, 1.0), (5.0, 0.5), (20.0, 1.0)] {
        let solved = solved(slenderness, length_ratio, 0.3, EdgeModel::QuarterSpace);
        for kind in BodyKind::ALL {
            let half = half_of(&solved.scene, kind);
            let (field, ledge) = (solved.field(kind), half - slenderness);
            let graded = |length: f64| {
                let steps =
                    (0..).map(|i| 0.05 * 1.8f64.powi(i)).take_while(move |s| 1.4 * s < length);
                [0.0].into_iter().chain(steps).collect::<Vec<_>>()
            };
            let inner = graded(slenderness);
            let mut breaks = vec![0.0];
            breaks.extend(inner.iter().rev().map(|s| slenderness - s));
            if ledge > 0.0 {
                breaks.extend(graded(ledge)[1..].iter().map(|s| slenderness + s));
                breaks.push(half);
            }
            let along = Panels::new(breaks, 5);
            for depth in [0.5, 1.0, 2.0, 5.0] {
                let mut breaks = vec![0.0];
                let mut step = 0.5f64;
                while breaks[breaks.len() - 1] < 100.0 {
                    breaks.push(breaks[breaks.len() - 1] + step);
                    step *= 1.4;
                }
                let across = Panels::new(breaks, 6);
                let lines = along.nodes().iter().zip(along.weights()).map(|(&y, w)| {
                    let stresses = field.at(y, depth, across.nodes());
                    w * stresses.iter().zip(across.weights()).map(|(s, w)| -s.zz * w).sum::<f64>()
                });
                let force = 2.0 * lines.sum::<f64>() / (0.5 * PI * slenderness);
                let what = format!("{} {slenderness} {length_ratio} at {depth}", kind.name());
                near(&what, force, 1.0, 2e-3);
            }
        }
    }
}

#[test]
fn stresses_superpose_and_mirror() {
    let end = |y: f64| (y / 3.0).powi(4);
    let (one, other, both) = (field_of(end), field_of(|y| 2.0 - end(y)), field_of(|_| 2.0));
    for place in
        [[0.0, 0.0, 0.5], [0.7, 2.9, 0.2], [0.3, 3.5, 0.0], [1.0, 4.0, 1.0], [0.5, 3.9, 3.0]]
    {
        let (sum, whole) = (one(place) + other(place), both(place));
        small(&format!("superposition at {place:?}"), apart(&sum, &whole), 1e-4);
        // Even in x but for xy and xz, even in y but for xy and yz.
        let [x, y, z] = place;
        let s = both([-x, y, z]);
        let turned = StressTensor { xy: -s.xy, xz: -s.xz, ..s };
        small("mirrored in x", apart(&turned, &whole), 1e-12);
        let s = both([x, -y, z]);
        let turned = StressTensor { xy: -s.xy, yz: -s.yz, ..s };
        // In y = 0 itself both are what is left of sums in single precision.
        small("mirrored in y", apart(&turned, &whole), if y == 0.0 { 1e-6 } else { 1e-12 });
    }
    // What is odd in y vanishes in the middle plane, where nothing makes it do so but the loads.
    for x in [0.2, 1.0] {
        let s = both([x, 0.0, 0.4]);
        small("xy in the middle plane", s.xy.abs(), 1e-6);
        small("yz in the middle plane", s.yz.abs(), 1e-6);
    }
}

/// The contact presses and never pulls, and carries the load.
#[test]
fn pressure_never_pulls() {
    for (slenderness, length_ratio) in
        [(5.0, 1.0), (5.0, 0.5), (1.0, 1.0), (1.0, 0.95), (20.0, 0.1)]
    {
        let case = case(5e-4, slenderness, length_ratio);
        for model in EdgeModel::ALL {
            let mut options = Options::new(model);
            options.curves.clear();
            let solution = solve(&case, &options).unwrap();
            let what = format!("{model} {slenderness} {length_ratio}");
            assert!(solution.cells.iter().all(|c| c.p_pa >= 0.0), "{what} pulls");
            let force: f64 = solution.cells.iter().map(|c| c.p_pa * c.dx_m * c.dy_m).sum();
            small(&format!("{what} load"), (force / case.force_n - 1.0).abs(), 1e-10);
        }
    }
}

// --- What is skipped ---------------------------------------------------------------------------

/// Sources beyond a wave's reach, and end faces that a wavenumber does not reach.
#[test]
fn what_waves_do_not_reach_does_not_matter() {
    let usual = Resolution::for_tolerance(1e-3);
    let farther = Resolution { reach: 28.0, face_reach: 28.0, ..usual.clone() };
    for (slenderness, length_ratio) in [(5.0, 1.0), (5.0, 0.5), (5.0, 0.1)] {
        let scene = scene(slenderness, length_ratio, 0.3, EdgeModel::QuarterSpace);
        let [near, far] =
            [&usual, &farther].map(|r| SolvedScene::with_resolution(&scene, r).unwrap());
        let field = near.field(BodyKind::Block);
        at(&field, [0.0, slenderness - 1.0, 0.5]);
        let work = field.work();
        assert!(work.done > 0 && work.beyond_reach > 0, "{work:?}");
        assert_eq!(work.ends > 0, length_ratio < 1.0, "{work:?}");
        let (pressure, stress) = changes(&near, &far);
        small(&format!("{slenderness} {length_ratio}: pressure"), pressure, 5e-4);
        small(&format!("{slenderness} {length_ratio}: stresses"), stress, 5e-4);
    }
}

#[test]
fn faded_wavenumbers_do_not_matter() {
    let solved = solved(5.0, 0.5, 0.3, EdgeModel::QuarterSpace);
    for kind in BodyKind::ALL {
        let usual = solved.field(kind);
        let all = solved.field_with(kind, None, 0.0);
        let mut worst: f64 = 0.0;
        for (_, place) in curve_points(&solved.scene, kind) {
            worst = worse(worst, apart(&at(&usual, place), &at(&all, place)));
        }
        assert!(usual.work().faded > 0 && all.work().faded == 0);
        small(kind.name(), worst, 2e-4);
    }
}

/// Points of the curves that are interpolated, ledges of about the depth included, below which the end
/// face's corner is as near as the contact's. Where a coarse answer's own error is seen, as on the end
/// face, whose load is given on coarse panels, the points between must not add to it.
#[test]
fn points_between_do_not_matter() {
    let levels = [1e-2, 5e-3, 1e-3, 1e-4];
    // Largest change, and for both ways the largest error and the sum of its squares.
    let mut found = [[0.0; 5]; 4];
    let (mut fewer, mut all, mut points) = ([0; 4], [0; 4], 0.0);
    for (slenderness, length_ratio, model) in [
        (5.0, 1.0, EdgeModel::QuarterSpace),
        (5.0, 0.5, EdgeModel::QuarterSpace),
        (20.0, 0.97, EdgeModel::QuarterSpace),
        (1.0, 0.9, EdgeModel::QuarterSpace),
        (200.0, 0.999, EdgeModel::QuarterSpace),
        (8.0, 0.8, EdgeModel::Guilbault),
    ] {
        let scenes = levels
            .map(|tolerance| Scene { tolerance, ..scene(slenderness, length_ratio, 0.3, model) });
        let solved = scenes.each_ref().map(|scene| SolvedScene::new(scene).unwrap());
        for kind in BodyKind::ALL {
            let between = solved.each_ref().map(|s| s.field(kind));
            let direct = solved.each_ref().map(|s| s.field(kind));
            for curve in standard_curves(kind, slenderness, half_of(&scenes[0], kind)) {
                let [x, y, z] = curve.points[0];
                let run =
                    |axis: usize| -> Vec<f64> { curve.points.iter().map(|p| p[axis]).collect() };
                let values = between.each_ref().map(|field| match curve.name {
                    "surface-along-x" => Vec::new(),
                    name if name.starts_with("depth") => field.down(&[x], y, &run(2)).concat(),
                    _ => field.along(x, z, &run(1)),
                });
                let away = |p: &[f64; 3]| (p[1] - slenderness).hypot(p[2]) > CORNER * 0.999;
                for (i, place) in curve.points.iter().enumerate().take(values[0].len()) {
                    let own = direct.each_ref().map(|field| at(field, *place));
                    points += 1.0;
                    for level in (0..levels.len()).filter(|_| away(place)) {
                        let off = |a: &StressTensor, b| apart(a, b) / levels[level];
                        let errors = [&values[level][i], &own[level]].map(|s| off(s, &own[3]));
                        let so_far = &mut found[level];
                        so_far[0] = worse(so_far[0], off(&values[level][i], &own[level]));
                        for (error, sums) in errors.iter().zip(so_far[1..].chunks_mut(2)) {
                            (sums[0], sums[1]) = (worse(sums[0], *error), sums[1] + error * error);
                        }
                    }
                }
            }
            for level in 0..levels.len() {
                fewer[level] += between[level].work().done;
                all[level] += direct[level].work().done;
            }
        }
    }
    for level in 0..levels.len() {
        let [change, max, square, direct_max, direct_square] = found[level];
        let rms = [square, direct_square].map(|s: f64| (s / points).sqrt());
        println!("{} of {} evaluations", fewer[level], all[level]);
        println!("errors {max:.2} for {direct_max:.2}, RMS {:.3} for {:.3}", rms[0], rms[1]);
        assert!(10 * fewer[level] < 6 * all[level]);
        small(&format!("change in tolerances of {:e}", levels[level]), change, 2.0);
        if level < 3 {
            assert!(max <= 1.05 * direct_max && rms[0] <= 1.1 * rms[1]);
        }
    }
    assert!(found[2][0] < 1.0 && found[3][0] < 1.0);
}

#[test]
fn bodies_that_are_alike_are_computed_once() {
    let alike = solved(5.0, 1.0, 0.3, EdgeModel::QuarterSpace);
    let mut scene = alike.scene.clone();
    scene.bodies.block.nu += 1e-12;
    let different = SolvedScene::new(&scene).unwrap();
    assert!(alike.bodies_shared() && !different.bodies_shared());
    let (pressure, stress) = changes(&different, &alike);
    small("pressure", pressure, 1e-8);
    small("stresses", stress, 1e-6);
}

#[test]
fn a_curve_alone_is_what_it_is_among_all() {
    let case = case(5e-4, 5.0, 0.5);
    let whole = solve(&case, &Options::new(EdgeModel::QuarterSpace)).unwrap();
    let mut options = Options::new(EdgeModel::QuarterSpace);
    options.bodies = vec![BodyKind::Roller];
    options.curves = vec!["depth-end".into()];
    let alone = solve(&case, &options).unwrap();
    assert_eq!(alone.curves.len(), 1);
    let same = whole.curves.iter().find(|c| **c == alone.curves[0]);
    assert!(same.is_some(), "the curve differs");
}

// --- Scales and threads ------------------------------------------------------------------------

fn case(load: f64, slenderness: f64, length_ratio: f64) -> Case {
    let steel = Material { young_pa: 210e9, poisson: 0.3 };
    let factors = Factors { load, slenderness, length_ratio };
    Case::from_factors("case", 0.01, steel, steel, factors)
}

/// All numbers of a solution in units of C and p0 that know nothing of the roller's radius.
fn numbers(case: &Case) -> Vec<f64> {
    let mut options = Options::new(EdgeModel::QuarterSpace);
    options.bodies = vec![BodyKind::Block];
    let solution = solve(case, &options).unwrap();
    let (c, p0) = (solution.hertz.c_m, solution.hertz.p0_pa);
    let mut all = vec![solution.load_n / (p0 * c * case.roller.length_m)];
    for line in &solution.lines {
        all.extend(line.p_pa.iter().map(|p| p / p0));
    }
    for curve in &solution.curves {
        all.extend(curve.stress_pa.iter().flat_map(|s| s.components()).map(|s| s / p0));
    }
    all
}

fn furthest(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, worse)
}

#[test]
fn load_is_no_factor_in_units_of_half_width_and_pressure() {
    let reference = numbers(&case(1e-4, 5.0, 0.5));
    assert!(reference.iter().all(|n| n.is_finite()));
    for load in [1e-3, 1e-10] {
        let other = numbers(&case(load, 5.0, 0.5));
        small(&format!("W = {load:e}"), furthest(&reference, &other), 1e-9);
    }
}

#[test]
fn threads_change_nothing() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| numbers(&case(1e-3, 5.0, 1.0)))
    };
    small("one thread or two", furthest(&on(1), &on(2)), 1e-12);
}

// --- Refinement --------------------------------------------------------------------------------

/// What a resolution changes against a finer one: pressure and stresses outside [`CORNER`].
fn changes(coarse: &SolvedScene, fine: &SolvedScene) -> (f64, f64) {
    let length = coarse.scene.half_length;
    let mut pressure: f64 = 0.0;
    for i in 0..=200 {
        // Denser towards the end.
        let s = CORNER * (length / CORNER).powf(f64::from(i) / 200.0);
        for x in [0.0, 0.4, 0.8] {
            let p = [coarse, fine].map(|s3| s3.pressure.at(x, length - s));
            pressure = worse(pressure, (p[0] - p[1]).abs());
        }
    }
    let mut stress: f64 = 0.0;
    for kind in BodyKind::ALL {
        if coarse.bodies_shared() && kind == BodyKind::Roller {
            continue;
        }
        let fields = [coarse.field(kind), fine.field(kind)];
        for (_, place) in curve_points(&coarse.scene, kind) {
            let [a, b] = [0, 1].map(|i| at(&fields[i], place));
            stress = worse(stress, apart(&a, &b));
        }
    }
    (pressure, stress)
}

/// Every panel halved and every extent doubled.
fn assert_converged(scenes: &[(f64, f64, f64)]) {
    let base = Resolution::for_tolerance(1e-3);
    for &(slenderness, length_ratio, nu) in scenes {
        let scene = scene(slenderness, length_ratio, nu, EdgeModel::QuarterSpace);
        let coarse = SolvedScene::with_resolution(&scene, &base).unwrap();
        let fine = SolvedScene::with_resolution(&scene, &base.refined()).unwrap();
        let (pressure, stress) = changes(&coarse, &fine);
        let what = format!("S_l = {slenderness}, L_r = {length_ratio}, nu = {nu}");
        small(&format!("{what}: pressure"), pressure, 2e-3);
        small(&format!("{what}: stresses"), stress, 5e-3);
    }
}

#[test]
fn refinement_changes_little() {
    assert_converged(&[(5.0, 1.0, 0.3), (5.0, 0.5, 0.3), (20.0, 1.0, 0.3), (20.0, 0.5, 0.3)]);
}

#[test]
fn refinement_changes_little_short_and_long() {
    assert_converged(&[(1.0, 1.0, 0.3), (1.0, 0.5, 0.3), (2.0, 1.0, 0.3), (2.0, 0.5, 0.3)]);
    assert_converged(&[(100.0, 1.0, 0.3), (100.0, 0.5, 0.3)]);
}

#[test]
fn refinement_changes_little_at_other_ledges_and_materials() {
    assert_converged(&[(5.0, 0.1, 0.3), (5.0, 0.95, 0.3), (5.0, 0.99, 0.3), (20.0, 0.99, 0.3)]);
    assert_converged(&[(5.0, 1.0, 0.0), (5.0, 0.5, 0.0), (5.0, 1.0, 0.25), (5.0, 0.5, 0.25)]);
    assert_converged(&[(5.0, 0.5, 0.45), (5.0, 1.0, 0.45)]);
}

/// One direction of refinement after the other: what a resolution half as fine as the default, and the
/// default itself, are off from one twice as fine. The table stands in docs/theory.md.
#[test]
fn every_direction_converges() {
    type Level = fn(&mut Resolution, f64);
    let directions: [(&str, Level); 5] = [
        ("panels along y and z", |r, level| {
            r.corner *= 0.5f64.powf(level);
            r.ratio = r.ratio.powf(0.5f64.powf(level));
        }),
        ("modes across x", |r, level| r.modes = (5.0 + 2.0 * level) as usize),
        ("free half-widths", |r, level| r.spacing *= 0.5f64.powf(level)),
        ("wavenumbers", |r, level| {
            r.k_max *= 2f64.powf(level);
            r.k_step *= 0.5f64.powf(level);
            r.k_ratio = r.k_ratio.powf(0.5f64.powf(level));
        }),
        ("extents and images", |r, level| {
            r.k_min *= 0.5f64.powf(level);
            r.face_reach *= 2f64.powf(level);
            r.reach = (r.reach * 2f64.powf(level)).min(30.0);
            r.images = (r.images as f64 * 2f64.powf(level)).max(1.0) as usize;
        }),
    ];
    for length_ratio in [1.0, 0.5] {
        let scene = scene(5.0, length_ratio, 0.3, EdgeModel::QuarterSpace);
        for (name, level) in directions {
            let solve = |by: f64| {
                let mut resolution = Resolution::for_tolerance(1e-3);
                level(&mut resolution, by);
                SolvedScene::with_resolution(&scene, &resolution).unwrap()
            };
            let fine = solve(1.0);
            let errors = [-1.0, 0.0].map(|by| changes(&solve(by), &fine));
            let text = errors.map(|(p, s)| format!("{p:.5} / {s:.5}"));
            println!("| {length_ratio} | {name} | {} | {} |", text[0], text[1]);
            let [coarse, usual] = errors;
            assert!(usual.0 <= coarse.0 && usual.1 <= coarse.1, "{name}: {errors:?}");
            assert!(usual.0 <= 2e-3 && usual.1 <= 2e-3, "{name}: {errors:?}");
        }
    }
}
