//! Public benchmarks with published answers.

use edgeline::body::EdgeModel;
use edgeline::case::Case;
use edgeline::solve::{Options, SolvedCase};

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
