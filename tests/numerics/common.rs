//! Shared parts of the tests of the numerics: a plain scene, and comparisons that fail for NaN.

use edgeline::base::{Material, PerBody, StressTensor};
use edgeline::body::EdgeModel;
use edgeline::case::{Case, Factors};
use edgeline::solve::{Scene, SceneBody, SolvedScene};
use edgeline::stress::curves::standard_curves;
use edgeline::stress::{BodyField, BodyKind, away_from_edge};
use std::path::Path;

/// A contact of equal materials: slenderness, length ratio, Poisson's ratio.
pub fn scene(slenderness: f64, length_ratio: f64, nu: f64, model: EdgeModel) -> Scene {
    let body = |half| SceneBody::straight(half, nu, 0.5);
    let bodies = PerBody { block: body(slenderness / length_ratio), roller: body(slenderness) };
    Scene::symmetric(bodies, model, 1e-3)
}

/// The larger one, or NaN if either is NaN.
pub fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// The `index`-th point in D dimensions of Kronecker's sequence for the powers of the root of
/// x^(D + 1) = x + 1, which leaves no large holes in any dimension.
pub fn sequence<const D: usize>(index: usize) -> [f64; D] {
    let mut root = 1.5f64;
    for _ in 0..60 {
        root = (1.0 + root).powf(1.0 / (D + 1) as f64);
    }
    std::array::from_fn(|d| (0.5 + (index + 1) as f64 * root.powi(-(d as i32 + 1))).fract())
}

/// The scenes that `EDGELINE_SCENES` asks for, a number of them or a range like `5000..10000`;
/// without it `few` of them, `stride` apart.
pub fn wanted_scenes(few: usize, stride: usize) -> Vec<usize> {
    let number = |n: &str| n.parse::<usize>().expect("a number of scenes, or a range of them");
    match std::env::var("EDGELINE_SCENES").ok() {
        None => (0..few).map(|i| stride * i).collect(),
        Some(wanted) => {
            let (from, to) = wanted.split_once("..").unwrap_or(("0", &wanted));
            (number(from)..number(to)).collect()
        }
    }
}

/// Largest difference of two stresses' components.
pub fn apart(a: &StressTensor, b: &StressTensor) -> f64 {
    let pairs = a.components().into_iter().zip(b.components());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, worse)
}

/// Distance from the roller's corner within which nothing is compared (C).
pub const CORNER: f64 = 0.1;

pub fn solved(slenderness: f64, length_ratio: f64, nu: f64, model: EdgeModel) -> SolvedScene {
    SolvedScene::new(&scene(slenderness, length_ratio, nu, model)).unwrap()
}

/// Half-length of a body of a scene.
pub fn half_of(scene: &Scene, kind: BodyKind) -> f64 {
    scene.bodies[kind].half
}

/// Points of the standard curves of a body, each outside [`CORNER`], named.
pub fn curve_points(scene: &Scene, kind: BodyKind) -> Vec<(&'static str, [f64; 3])> {
    let curves = standard_curves(kind, scene.half_length, half_of(scene, kind));
    let points = curves.into_iter().flat_map(|c| c.points.into_iter().map(move |p| (c.name, p)));
    points.filter(|(_, at)| away_from_edge(*at, scene.half_length, CORNER)).collect()
}

pub fn at(field: &BodyField, [x, y, z]: [f64; 3]) -> StressTensor {
    field.at(y, z, &[x])[0]
}

/// Asserts |got - want| <= tolerance and reports the value.
pub fn near(what: &str, got: f64, want: f64, tolerance: f64) {
    println!("{what}: {got:.5}, expected {want:.5} +- {tolerance}");
    assert!((got - want).abs() <= tolerance, "{what}: got {got}, expected {want} +- {tolerance}");
}

/// Asserts |value| <= tolerance and reports the value.
pub fn small(what: &str, value: f64, tolerance: f64) {
    println!("{what}: {value:.2e} of at most {tolerance:.0e}");
    assert!(value.abs() <= tolerance, "{what}: |{value:e}| > {tolerance:e}");
}

pub fn case(load: f64, slenderness: f64, length_ratio: f64) -> Case {
    let steel = Material { young_pa: 210e9, poisson: 0.3 };
    let factors = Factors { load, slenderness, length_ratio };
    Case::from_factors("case", 0.01, steel, steel, factors)
}

/// Asserts that tractions of `stress` (y, z and all x) vanish on the end faces of both bodies, at
/// 40 x 40 points of each.
pub fn free_ends(
    solved: &SolvedScene,
    what: &str,
    stress: impl Fn(&BodyField, f64, f64, &[f64]) -> Vec<StressTensor>,
) {
    let xs: Vec<f64> = (0..40).map(|i| 4.0 * f64::from(i) / 39.0).collect();
    for kind in BodyKind::ALL {
        let field = solved.field(kind);
        // On the face itself the tractions are set to zero; next to it they are computed.
        let y = half_of(&solved.scene, kind) * (1.0 - 2e-9);
        let mut left = [0.0; 3];
        for i in 0..40 {
            let z = 0.02 * 500f64.powf(f64::from(i) / 39.0);
            for s in stress(&field, y, z, &xs) {
                for (worst, traction) in left.iter_mut().zip([s.yy, s.xy, s.yz]) {
                    *worst = worse(*worst, traction.abs());
                }
            }
        }
        for (name, left) in ["yy", "xy", "yz"].iter().zip(left) {
            small(&format!("{} {what}: {name}", kind.name()), left, 5e-3);
        }
    }
}

/// Rows of `tests/data/<name>`: a label if the file has one, and the numbers. Lines that begin with
/// # are comments.
pub fn table(name: &str) -> Vec<(String, Vec<f64>)> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name);
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(path).unwrap();
    let rows = reader.records().map(|row| {
        let row = row.unwrap();
        let label = row[0].parse::<f64>().is_err();
        let numbers = row.iter().skip(usize::from(label)).map(|n| n.parse().unwrap()).collect();
        (if label { row[0].to_owned() } else { String::new() }, numbers)
    });
    rows.collect()
}
