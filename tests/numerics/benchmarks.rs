//! Public benchmarks with published answers.

use edgeline::body::EdgeModel;
use edgeline::case::Case;
use edgeline::solve::{Options, SolvedCase, solve};
use std::f64::consts::PI;

/// NAFEMS, Advanced Finite Element Contact Benchmarks (2006), benchmark 1: a steel cylinder of 50 mm radius on an
/// aluminium block in plane strain, 35 kN per mm. By Hertz: 3585 MPa and a half-width of 6.215 mm. Between mirrors a
/// finite line is a part of that endless one.
#[test]
fn the_cylinder_of_nafems_has_its_pressure_and_half_width() {
    let text = "name = \"nafems-1\"
[roller]
radius_m = 0.05
length_m = 0.25
young_pa = 210e9
poisson = 0.3
[block]
length_m = 0.25
young_pa = 70e9
poisson = 0.3
[load]
force_n = 8.75e6
";
    let case = Case::from_toml(text).unwrap();
    let hertz = case.hertz();
    assert!((hertz.p0_pa * 1e-6 - 3585.0).abs() < 1.0, "{}", hertz.p0_pa);
    assert!((hertz.c_m * 1e3 - 6.215).abs() < 0.002, "{}", hertz.c_m);
    let solved = |model| SolvedCase::new(&case, &Options::new(model)).unwrap();
    let mirrored = solved(EdgeModel::Mirror);
    for (x, y) in [(0.0, 0.0), (0.5, 0.0), (0.7, 0.0), (0.3, 13.0)] {
        let wanted = (1.0_f64 - x * x).sqrt();
        assert!((mirrored.pressure(x, y) - wanted).abs() < 5e-3, "at {x}, {y}");
    }
    assert_eq!(mirrored.pressure(1.01, 0.0), 0.0);
    // Plane strain on the axis: the largest shear stress, 0.300 p0, lies 0.786 C deep (Johnson, 1985, Eq. 4.46).
    let block = edgeline::stress::BodyKind::Block;
    let found = mirrored.stress(block, &[[0.0, 0.0, 0.786]]).unwrap()[0];
    assert!((0.5 * (found.xx - found.zz) - 0.300).abs() < 3e-3, "{found:?}");
    // Free ends carry less, so the middle of a finite roller carries more.
    let free = solved(EdgeModel::QuarterSpace);
    let (middle, end) = (free.pressure(0.0, 0.0), free.pressure(0.0, 20.0));
    assert!(middle > 1.01 && middle < 1.03 && end < 0.8, "{middle}, {end}");
}

/// A steel roller, D = L = 10 mm, pressed on a plate by 0.01 mm at its middle plane (R. Teutsch and B. Sauer, J. Tribol.,
/// 2004): 4219, 3939, 3678 and 3435 N for plates 0.5, 1, 2 and 4 D thick, by a fit within 1.5 % of finite
/// elements.
///
/// Here the plate is infinitely deep, so the approach is counted to the plate's depth: that of the model, to one roller
/// radius, and from there on the displacement below a line of equal forces on a half-space (Boussinesq; Johnson, 1985,
/// Eq. 3.18). The stiff base of the true plate is not there, so thin plates take less force. Poisson's ratio is taken as
/// 0.3, and the plate as far longer than the roller.
#[test]
fn the_roller_on_plates_of_teutsch_and_sauer_takes_their_forces_as_far_as_a_deep_body_can() {
    const MODULUS: f64 = 208e9;
    const LENGTH: f64 = 0.01;
    let under_force = |approach: f64| {
        let text = format!(
            "name = \"plate\"\n[roller]\nradius_m = 0.005\nlength_m = {LENGTH}\nyoung_pa = {MODULUS}\npoisson = 0.3\n\
             [block]\nlength_m = 0.1\nyoung_pa = {MODULUS}\npoisson = 0.3\n[load]\napproach_m = {approach}\n"
        );
        let case = Case::from_toml(&text).unwrap();
        solve(&case, &Options::new(EdgeModel::QuarterSpace)).unwrap().summary.load_n
    };
    // Displacement along z at a depth below the middle of the line, for a force of one newton.
    let below = |z: f64| {
        let line = LENGTH / z.hypot(0.5 * LENGTH) + 4.0 * (1.0 - 0.3) * (0.5 * LENGTH / z).asinh();
        (1.0 + 0.3) / (2.0 * PI * MODULUS * LENGTH) * line
    };
    let mut ratios = Vec::new();
    for (depth, wanted) in [(0.005, 4219.0), (0.01, 3939.0), (0.02, 3678.0), (0.04, 3435.0)] {
        let mut force = wanted;
        for _ in 0..4 {
            force = under_force(1e-5 - force * (below(0.005) - below(depth)));
        }
        let settled = under_force(1e-5 - force * (below(0.005) - below(depth)));
        assert!((settled / force - 1.0).abs() < 1e-3, "{settled} {force}");
        ratios.push(force / wanted);
    }
    assert!(ratios.iter().all(|r| (0.93..1.03).contains(r)), "{ratios:?}");
    assert!((ratios[3] - 1.0).abs() < 0.03, "{ratios:?}");
}
