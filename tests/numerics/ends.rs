//! The strength of the contact's end, and the only fitted number of the `guilbault` model.
//! Lengths are in units of C, stresses in units of p0.

use crate::common::{CORNER, apart, scene, small, worse};
use edgeline::base::PerBody;
use edgeline::body::{EdgeModel, GAMMA, Resolution, transition};
use edgeline::solve::edge::{self, EdgeStrength, Side};
use edgeline::solve::{Scene, SceneBody, SolvedScene};
use edgeline::stress::curves::{CURVE_NAMES, standard_curves};
use edgeline::stress::{BodyKind, away_from_edge};

/// The strength of the end at a resolution.
fn strength(scene: &Scene, resolution: &Resolution) -> Option<EdgeStrength> {
    edge::edge_strength(&SolvedScene::with_resolution(scene, resolution).unwrap(), Side::Positive)
}

/// A contact of unlike materials: half-lengths and Poisson's ratios of block and roller, and the
/// block's share of the compliance.
fn unlike(halves: [f64; 2], nu: [f64; 2], share: f64, tolerance: f64) -> Scene {
    let bodies = PerBody {
        block: SceneBody::straight(halves[0], nu[0], share),
        roller: SceneBody::straight(halves[1], nu[1], 1.0 - share),
    };
    Scene::symmetric(bodies, EdgeModel::QuarterSpace, tolerance)
}

#[test]
fn exponents_of_corners_are_the_known_ones() {
    let exponent =
        |length_ratio, nu, model| scene(5.0, length_ratio, nu, model).corner_exponents()[1];
    // Two half-planes: a rigid punch's. A quarter-plane on a half-plane of the same material,
    // without friction: 0.226, whatever Poisson's ratio (Dundurs and Lee, Journal of Elasticity 2,
    // 1972).
    assert_eq!(exponent(0.5, 0.3, EdgeModel::HalfSpace), Some(0.5));
    for nu in [0.0, 0.3, 0.49] {
        let m = exponent(0.5, nu, EdgeModel::QuarterSpace).unwrap();
        assert!((m - 0.226).abs() < 5e-4, "{m}");
    }
    // One quarter-plane that slides between mirrors: cot(pi m) = tan(pi m / 2).
    let m = exponent(0.5, 0.3, EdgeModel::Mirror).unwrap();
    assert!((m - 1.0 / 3.0).abs() < 1e-9, "{m}");
    for model in [EdgeModel::QuarterSpace, EdgeModel::Mirror] {
        assert_eq!(exponent(1.0, 0.3, model), None);
    }
}

/// Beside a flush end nodes are closer to each other than their half-widths are independent. With
/// all modes of their own they would have noise that pressures between them show: 0.9 and 1.1
/// tolerances at these ends.
#[test]
fn pressures_between_the_nodes_beside_a_flush_end_converge() {
    for (half, nu, share) in [(2.8674, [0.315, 0.436], 0.484), (3.4893, [0.411, 0.200], 0.517)] {
        let scene = unlike([half; 2], nu, share, 1e-3);
        let solved = SolvedScene::new(&scene).unwrap();
        let fine = SolvedScene::new(&Scene { tolerance: 1e-4, ..scene.clone() }).unwrap();
        for x in [0.0, 0.4, 0.8] {
            let worst = (0..=200).fold(0.0, |worst, i| {
                let y = half - 0.03 * 20f64.powf(f64::from(i) / 200.0);
                worse(worst, (solved.pressure.at(x, y) - fine.pressure.at(x, y)).abs())
            });
            small(&format!("S_l {half}, x = {x}"), worst, 0.7 * scene.tolerance);
        }
    }
}

/// Beside a singular end the load per length changes fast along the line. When the shears of a slow
/// change were taken out of the waves there, too, those at this depth were up to 7 tolerances off,
/// and more waves, which have faded there by e^-100, made it 12.
#[test]
fn shears_beside_a_singular_end_do_not_depend_on_short_waves() {
    for (half, block, nu, share) in
        [(3.98, 22.36, [0.304, 0.429], 0.735), (54.13, 194.0, [0.442, 0.445], 0.729)]
    {
        let scene = unlike([block, half], nu, share, 1e-4);
        let own = SolvedScene::new(&scene).unwrap();
        let more = Resolution { k_max: 2.0 * own.resolution.k_max, ..own.resolution };
        let fine = SolvedScene::with_resolution(&scene, &more).unwrap();
        for kind in BodyKind::ALL {
            for from_end in [0.05, 0.1, 0.2, 0.3, 0.5] {
                let y = half - from_end;
                let [own, fine] = [&own, &fine].map(|s| s.field(kind).at(y, 0.5, &[0.0])[0]);
                let off = own.yz - fine.yz;
                small(&format!("S_l {half}, {kind:?}, {from_end}"), off, 0.5 * scene.tolerance);
            }
        }
    }
}

/// Coarse tolerances are kept as fine ones are. With two wavenumbers a panel, too far apart for
/// polynomials through seven of them, pressures next to flush ends were 3.8 to 4.8 tolerances off.
#[test]
fn coarse_tolerances_are_kept_beside_flush_ends() {
    for (half, nu, share) in [
        (9.943, [0.387, 0.034], 0.531),
        (6.25, [0.287, 0.342], 0.269),
        (48.744, [0.335, 0.224], 0.546),
    ] {
        let [own, fine] = [3e-2, 1e-3]
            .map(|tolerance| SolvedScene::new(&unlike([half; 2], nu, share, tolerance)).unwrap());
        small(
            &format!("approach, S_l {half}"),
            own.approach(100.0) / fine.approach(100.0) - 1.0,
            2e-2,
        );
        for from_end in [0.03, 0.045, 0.06, 0.1, 0.2, 0.4] {
            for x in [0.0, 0.4, 0.8] {
                let [own, fine] = [&own, &fine].map(|s| s.pressure.at(x, half - from_end));
                small(&format!("S_l {half} at {x}, {from_end}"), own - fine, 3e-2);
            }
        }
    }
}

#[test]
fn strengths_do_not_depend_on_the_mesh() {
    let usual = Resolution::for_tolerance(1e-3);
    for slenderness in [5.0, 20.0] {
        let longer = scene(slenderness, 0.5, 0.3, EdgeModel::QuarterSpace);
        let fits = [usual, usual.refined()].map(|r| match strength(&longer, &r) {
            Some(EdgeStrength::Singular {
                exponent, factor, corner_exponent, residual, ..
            }) => {
                assert!(exponent < corner_exponent && residual < 0.01, "{exponent} {residual}");
                [exponent, factor]
            }
            other => panic!("{other:?}"),
        });
        assert!((fits[0][0] - fits[1][0]).abs() < 2e-3, "{fits:?}");
        assert!((fits[0][1] / fits[1][1] - 1.0).abs() < 5e-3, "{fits:?}");
        let flush = scene(slenderness, 1.0, 0.3, EdgeModel::QuarterSpace);
        let limits = [usual, usual.refined()].map(|r| match strength(&flush, &r) {
            Some(EdgeStrength::Finite { limit, residual, .. }) => {
                // Next to the last free half-width the error of p is about 0.002 p0.
                assert!(residual < 3e-3, "{residual}");
                limit
            }
            other => panic!("{other:?}"),
        });
        // The limit lies beyond the last free half-width too.
        assert!((limits[0] - limits[1]).abs() < 6e-3, "{limits:?}");
        if slenderness == 5.0 {
            // Finite elements: 0.572 within one percent.
            assert!((limits[1] - 0.572).abs() < 0.006, "{limits:?}");
        }
    }
    // With images weighted by psi > 1 in both bodies neither law holds.
    assert_eq!(strength(&scene(5.0, 1.0, 0.3, EdgeModel::Guilbault), &usual), None);
}

/// The edge of a block that ends beyond the roller is free of stress: between two free faces at a
/// right angle stresses vanish like the 1.7th power of the distance (Williams, Journal of Applied
/// Mechanics 19, 1952). Beside it, off the plane x = 0 as well, they are those of a fine solution.
#[test]
fn edges_without_load_are_free_of_stress() {
    for (slenderness, length_ratio) in [(2.164, 0.9535), (5.0, 0.9), (5.0, 0.5)] {
        let plain = scene(slenderness, length_ratio, 0.3, EdgeModel::QuarterSpace);
        let half = plain.bodies.block.half;
        let ledge = half - slenderness;
        let solved = |tolerance| SolvedScene::new(&Scene { tolerance, ..plain.clone() }).unwrap();
        let stresses = |solved: &SolvedScene, off: f64, z: f64| {
            solved.field(BodyKind::Block).at(half - off, z, &[0.0, 0.6])
        };
        let fine = solved(1e-3);
        for tolerance in [1e-2, 5e-3, 1e-3] {
            let own = solved(tolerance);
            let near = stresses(&own, 0.5 * ledge, 0.0)[0].yy.abs();
            for off in [0.02, 0.005, 0.001] {
                let yy = stresses(&own, off, 0.0)[0].yy;
                let limit = 0.4 * tolerance + near * (off / (0.5 * ledge)).powf(1.7);
                small(&format!("{length_ratio}, {tolerance}, yy {off} C from the edge"), yy, limit);
            }
            for (off, z) in [(0.01, 0.01), (0.003, 0.003), (0.0, 0.02), (0.03, 0.0), (0.05, 0.02)] {
                let pairs = stresses(&own, off, z).into_iter().zip(stresses(&fine, off, z));
                for (own, fine) in pairs {
                    let what = format!("{length_ratio}, {tolerance}, {off} {z}");
                    small(&what, apart(&own, &fine), 0.3 * tolerance);
                }
            }
        }
    }
}

// --- The stress transition factor --------------------------------------------------------------

/// The values that determine sigma_yy of `guilbault` at a point, and that of the complete solution.
struct Sample {
    /// sigma_yy with the images in full.
    mirrored: f64,
    /// The same on the end face, at the same x and z.
    on_face: f64,
    /// Distances from the two end faces.
    distances: [f64; 2],
    z: f64,
    truth: f64,
}

impl Sample {
    fn error(&self, gamma: f64) -> f64 {
        let share: f64 = self.distances.iter().map(|&s| transition(s, self.z, gamma)).sum();
        self.mirrored - share * self.on_face - self.truth
    }
}

/// Samples of the standard curves of both bodies, 0.1 C from the roller's corner and beyond.
fn samples((slenderness, length_ratio, nu): (f64, f64, f64)) -> Vec<Sample> {
    let [model, truth] = [EdgeModel::Guilbault, EdgeModel::QuarterSpace]
        .map(|model| SolvedScene::new(&scene(slenderness, length_ratio, nu, model)).unwrap());
    let mut all = Vec::new();
    for (kind, body) in BodyKind::ALL.into_iter().zip(model.scene.bodies.iter()) {
        // With a tiny factor only the faces themselves are corrected.
        let (mirrored, truth) = (model.field_with(kind, Some(1e-12), 1e-3), truth.field(kind));
        // The factor was calibrated on the curves in the planes of symmetry, the first seven.
        let curves = standard_curves(kind, slenderness, body.half).into_iter();
        let central = curves.filter(|c| CURVE_NAMES[..7].contains(&c.name));
        for [x, y, z] in central.flat_map(|c| c.points) {
            if !away_from_edge([x, y, z], slenderness, CORNER) {
                continue;
            }
            let inside = body.half * (1.0 - 1e-8);
            let yy = |y: f64| mirrored.at(y.min(inside), z, &[x])[0].yy;
            all.push(Sample {
                mirrored: yy(y),
                on_face: yy(body.half),
                distances: [body.half - y, body.half + y].map(|s| if s < 1e-9 { 0.0 } else { s }),
                z,
                truth: truth.at(y, z, &[x])[0].yy,
            });
        }
    }
    all
}

fn rms(samples: &[Sample], gamma: f64) -> f64 {
    let sum: f64 = samples.iter().map(|s| s.error(gamma).powi(2)).sum();
    (sum / samples.len() as f64).sqrt()
}

/// The least-squares factor, by golden-section search in its logarithm.
fn best(samples: &[Sample]) -> f64 {
    let (mut low, mut high) = (0.02f64.ln(), 50f64.ln());
    let part = 0.5 * (5f64.sqrt() - 1.0);
    while high - low > 1e-5 {
        let (a, b) = (high - part * (high - low), low + part * (high - low));
        if rms(samples, a.exp()) < rms(samples, b.exp()) { high = b } else { low = a }
    }
    (0.5 * (low + high)).exp()
}

#[test]
fn the_transition_factor_is_that_of_least_squares() {
    let fitted = [(5.0, 1.0, 0.3), (5.0, 0.5, 0.3), (20.0, 1.0, 0.3), (20.0, 0.5, 0.3)];
    let others = [
        (1.0, 1.0, 0.3),
        (2.0, 1.0, 0.3),
        (10.0, 0.75, 0.3),
        (100.0, 1.0, 0.3),
        (5.0, 0.95, 0.3),
        (5.0, 1.0, 0.0),
        (5.0, 1.0, 0.25),
        (5.0, 1.0, 0.45),
    ];
    let mut together = Vec::new();
    println!("| S_l | L_r | nu | rms without | rms | max | best gamma |");
    for case in fitted.into_iter().chain(others) {
        let samples = samples(case);
        let (without, with) = (rms(&samples, 1e-12), rms(&samples, GAMMA));
        let max = samples.iter().map(|s| s.error(GAMMA).abs()).fold(0.0, f64::max);
        let (slenderness, length_ratio, nu) = case;
        println!(
            "| {slenderness} | {length_ratio} | {nu} | {without:.3} | {with:.3} | {max:.3} | {:.2} |",
            best(&samples)
        );
        if fitted.contains(&case) {
            together.extend(samples);
        }
    }
    let gamma = best(&together);
    println!(
        "gamma {gamma:.4}: rms {:.4}, without {:.4}",
        rms(&together, gamma),
        rms(&together, 1e-12)
    );
    for g in [0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0] {
        println!("{g} {:.4}", rms(&together, g));
    }
    assert!((gamma - GAMMA).abs() <= 0.01, "gamma is {gamma}, the program has {GAMMA}");
}
