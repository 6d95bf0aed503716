//! Stresses under a traction along x: known solutions, and the laws of any stress field. Lengths
//! are in units of C, stresses in units of p0; the traction on the block is the pressure along +x
//! unless a friction is named.

use crate::common::{apart, case, free_ends, half_of, near, scene, small, worse};
use crate::fields::{LIMITS, Random, SCENES, imbalance};
use edgeline::base::{Panels, StressTensor, gauss_legendre};
use edgeline::body::EdgeModel;
use edgeline::case::{Case, ProfileKind, ProfileSpec, Sliding};
use edgeline::kernels::strip;
use edgeline::solve::{Options, Scene, SolvedCase, SolvedScene};
use edgeline::stress::{BodyField, BodyKind};
use std::f64::consts::{FRAC_PI_2, PI};

/// A contact of equal materials that slide on each other.
fn sliding(slenderness: f64, length_ratio: f64, nu: f64, model: EdgeModel) -> SolvedScene {
    let scene = Scene { slides: true, ..scene(slenderness, length_ratio, nu, model) };
    SolvedScene::new(&scene).unwrap()
}

/// The stress under the traction alone.
fn dragged(field: &BodyField, [x, y, z]: [f64; 3]) -> StressTensor {
    field.round_at(y, z, &[x])[0].flat.traction
}

/// Middle of a long contact: plane strain under the pressure and the traction (Johnson, Contact
/// Mechanics, 1985, section 7.1; McEwen, Philosophical Magazine 40, 1949).
#[test]
fn long_contact_is_plane_strain_with_friction() {
    // In the middle the load per length is 0.4 % below its mean. Without Poisson's effect plane
    // strain has no stress on the end faces of a flush body, of any length, and holds everywhere.
    let cases = [
        (200.0, 0.3, EdgeModel::Mirror, &[0.0][..]),
        (5.0, 0.0, EdgeModel::QuarterSpace, &[0.0, 4.5, 5.0]),
    ];
    for (slenderness, nu, model, ys) in cases {
        let solved = sliding(slenderness, 1.0, nu, model);
        let field = solved.field(BodyKind::Block);
        let width = solved.pressure.at(0.0, 0.0);
        let mut worst: f64 = 0.0;
        for y in ys {
            for z in [0.0, 0.02, 0.1, 0.3, 0.5, 0.7861, 1.0, 1.5, 2.0, 3.0, 5.0] {
                for x in [-3.0, -1.4, -0.7, 0.0, 0.5, 0.7, 1.4, 2.0] {
                    let [xx, zz, xz] = strip::stress_along(width, &[width], x, z);
                    let want =
                        StressTensor { xx, yy: nu * (xx + zz), zz, xz, ..Default::default() };
                    worst = worse(worst, apart(&dragged(&field, [x, *y, z]), &want));
                }
            }
        }
        small(&format!("difference from plane strain, nu = {nu}"), worst, 2e-3);
        // The tension behind the contact, next to its edge.
        near("tension behind", dragged(&field, [-0.95, 0.0, 0.0]).xx, 2.0 * 0.95, 4e-3);
    }
}

/// A contact that a strong crown makes a circle: Hamilton's surface stresses within it (Proceedings
/// of the Institution of Mechanical Engineers 197C, 1983) and below it the sum of Cerruti's point
/// loads.
#[test]
fn a_circular_contact_has_hamiltons_stresses() {
    let mut case = case(1e-5, 20.0, 1.0).with_tolerance(1e-3);
    (case.roller.radius_m, case.roller.length_m) = (0.02, 0.03);
    (case.block.length_m, case.load.force_n) = (0.03, 3000.0);
    let mut crown = ProfileSpec::new(ProfileKind::Crown);
    crown.radius_m = Some(case.roller.radius_m);
    case.roller.profile = Some(crown);
    case.sliding = Sliding { friction: 0.3 };
    // Hertz's circle (Johnson 1985, Eqs. 4.22 and 4.24).
    let (force, radius, modulus) =
        (case.load.force_n, case.roller.radius_m, case.contact_modulus());
    let a_m = (0.75 * force * radius / modulus).cbrt();
    let top_pa = 1.5 * force / (PI * a_m * a_m);
    let solved = SolvedCase::new(&case, &Options::new(EdgeModel::QuarterSpace)).unwrap();
    let without = Case { sliding: Sliding::default(), ..case.clone() };
    let without = SolvedCase::new(&without, &Options::new(EdgeModel::QuarterSpace)).unwrap();
    let (a, top, nu) = (a_m / solved.hertz().c_m, top_pa / solved.hertz().p0_pa, 0.3);
    let added = |x: f64, y: f64, z: f64| {
        let [with, without] = [&solved, &without]
            .map(|s| s.stress(BodyKind::Block, &[[a * x, a * y, a * z]]).unwrap()[0]);
        (with - without) * (1.0 / (0.3 * top))
    };
    let mut worst: f64 = 0.0;
    for (x, y) in [(0.5, 0.0), (-0.8, 0.0), (-0.3, 0.6), (0.4, -0.4), (0.0, 0.8)] {
        let got = added(x, y, 0.0);
        let want = StressTensor {
            xx: -FRAC_PI_2 * x * (0.25 * nu + 1.0),
            yy: -0.375 * PI * nu * x,
            xy: 0.25 * PI * y * (0.5 * nu - 1.0),
            xz: -(1.0 - x * x - y * y).sqrt(),
            ..Default::default()
        };
        worst = worse(worst, apart(&got, &want));
    }
    let (nodes, weights) = gauss_legendre(40);
    for at in
        [[0.3, 0.0, 0.4], [-0.9, 0.0, 0.3], [0.4, 0.7, 0.5], [-1.2, 0.8, 0.7], [0.0, 1.5, 1.0]]
    {
        let mut want = StressTensor::default();
        for (r, wr) in nodes.iter().zip(&weights) {
            // Area r dr dphi, r = sin(t), under sqrt(1 - r^2) = cos(t).
            let t = 0.25 * PI * (1.0 + r);
            let load = 0.25 * PI * wr * t.cos().powi(2) * t.sin();
            for i in 0..80 {
                let phi = 2.0 * PI * (f64::from(i) + 0.5) / 80.0;
                let (x, y) = (t.sin() * phi.cos(), t.sin() * phi.sin());
                want += cerruti(nu, at[0] - x, at[1] - y, at[2]) * (load * 2.0 * PI / 80.0);
            }
        }
        worst = worse(worst, apart(&added(at[0], at[1], at[2]), &want));
    }
    small("difference, in peak tractions", worst, 5e-3);
}

/// A unit force along x on a half-space (Johnson 1985, Eqs. 3.76).
fn cerruti(nu: f64, x: f64, y: f64, z: f64) -> StressTensor {
    let big = (x * x + y * y + z * z).sqrt();
    let (sum, free) = (big + z, 1.0 - 2.0 * nu);
    let spread = 1.0 / (big.powi(3) * sum.powi(2)) + 2.0 / (big.powi(2) * sum.powi(3));
    let flat = 1.0 / (big * sum.powi(2));
    let radial = -3.0 / big.powi(5);
    let stress = StressTensor {
        xx: radial * x.powi(3) + free * x * (big.powi(-3) - 3.0 * flat + x * x * spread),
        yy: radial * x * y * y + free * x * (big.powi(-3) - flat + y * y * spread),
        zz: radial * x * z * z,
        xy: radial * x * x * y + free * y * (x * x * spread - flat),
        xz: radial * x * x * z,
        yz: radial * x * y * z,
    };
    stress * (1.0 / (2.0 * PI))
}

/// The models without freed faces are sums of point loads: of all the contact, and of its images.
#[test]
fn tractions_and_their_images_are_sums_of_point_loads() {
    for (model, faces) in [(EdgeModel::HalfSpace, &[][..]), (EdgeModel::Mirror, &[1.0, -1.0])] {
        let solved = sliding(2.0, 0.8, 0.3, model);
        let half = half_of(&solved.scene, BodyKind::Block);
        let field = solved.field(BodyKind::Block);
        let axis = solved.pressure.axis();
        for at in [[0.4, 1.0, 0.5], [-0.8, 1.9, 0.6], [-1.5, 2.2, 0.5], [0.2, 0.0, 1.5]] {
            let mut want = StressTensor::default();
            for (y, w) in axis.nodes().iter().zip(axis.weights()) {
                let (width, modes) = solved.pressure.modes(*y).unwrap();
                for i in 0..60 {
                    let angle = PI * (f64::from(i) + 0.5) / 60.0;
                    let x = width * angle.cos();
                    let p = strip::pressure(width, &modes, x);
                    let load = p * w * width * angle.sin() * PI / 60.0;
                    for y in [*y, -y] {
                        for y in faces.iter().map(|face| 2.0 * face * half - y).chain([y]) {
                            want += cerruti(0.3, at[0] - x, at[1] - y, at[2]) * load;
                        }
                    }
                }
            }
            small(&format!("{model} at {at:?}"), apart(&dragged(&field, at), &want), 3e-3);
        }
    }
}

/// The tractions on the end faces, at 40 x 40 points of each.
#[test]
fn end_faces_are_free_under_a_traction() {
    for (slenderness, length_ratio, nu) in
        [(5.0, 1.0, 0.3), (5.0, 0.5, 0.3), (20.0, 1.0, 0.3), (1.0, 1.0, 0.3), (5.0, 0.99, 0.45)]
    {
        let solved = sliding(slenderness, length_ratio, nu, EdgeModel::QuarterSpace);
        free_ends(&solved, &format!("{slenderness} {length_ratio} {nu}"), |field, y, z, xs| {
            field.round_at(y, z, xs).iter().map(|s| s.flat.traction).collect()
        });
    }
}

/// The force along x through a plane below the contact is that on the surface. Beyond X it is that
/// of a line load's x^2 z / r^4, 2 z / (pi X) of the whole.
#[test]
fn planes_carry_the_tangential_load() {
    const FAR: f64 = 100.0;
    for (slenderness, length_ratio) in [(5.0, 1.0), (5.0, 0.5)] {
        let solved = sliding(slenderness, length_ratio, 0.3, EdgeModel::QuarterSpace);
        let half = half_of(&solved.scene, BodyKind::Block);
        let field = solved.field(BodyKind::Block);
        let graded = |length: f64, first: f64| {
            let steps = (0..).map(|i| first * 1.6f64.powi(i)).take_while(move |s| 1.4 * s < length);
            [0.0].into_iter().chain(steps).chain([length]).collect::<Vec<_>>()
        };
        let mut breaks: Vec<f64> =
            graded(slenderness, 0.05).iter().rev().map(|s| slenderness - s).collect();
        if half > slenderness {
            breaks.extend(graded(half - slenderness, 0.05)[1..].iter().map(|s| slenderness + s));
        }
        let (along, across) = (Panels::new(breaks, 4), Panels::new(graded(FAR, 0.5), 6));
        for depth in [0.5, 2.0] {
            let lines = along.nodes().iter().zip(along.weights()).map(|(&y, w)| {
                let stresses = field.round_at(y, depth, across.nodes());
                let xz = stresses.iter().map(|s| -s.flat.traction.xz);
                w * xz.zip(across.weights()).map(|(s, w)| s * w).sum::<f64>()
            });
            let force = 4.0 * lines.sum::<f64>() / solved.scene.load + 4.0 / PI * depth / FAR;
            near(&format!("{slenderness} {length_ratio} at {depth}"), force, 1.0, 3e-3);
        }
    }
}

/// A friction of the other sign is the mirror image, both bodies see opposite tractions, and what
/// is added is in proportion to the friction.
#[test]
fn frictions_mirror_and_superpose() {
    let solved = |friction: f64| {
        let case = Case { sliding: Sliding { friction }, ..case(1e-5, 5.0, 1.0) };
        SolvedCase::new(&case, &Options::new(EdgeModel::QuarterSpace)).unwrap()
    };
    let [none, some, twice] = [0.0, 0.2, 0.4].map(solved);
    for [x, y, z] in [[0.0, 0.0, 0.5], [0.7, 4.9, 0.2], [-0.3, -4.5, 0.0], [1.0, 5.0, 1.0]] {
        let at = |s: &SolvedCase, kind, x| s.stress(kind, &[[x, y, z]]).unwrap()[0];
        for kind in BodyKind::ALL {
            let [a, b, c] = [&none, &some, &twice].map(|s| at(s, kind, x));
            small("superposition", apart(&(b + b - a), &c), 1e-12);
            // The friction's part is odd in x but for xy and xz.
            let [a, b] = [&none, &some].map(|s| at(s, kind, -x));
            let turned = (b - a).mirrored(StressTensor::ODD_IN_X) * -1.0;
            let own = at(&some, kind, x) - at(&none, kind, x);
            small("mirror image", apart(&turned, &own), 1e-12);
        }
        // Flush bodies of one material differ by their round shape alone, by friction times C / R.
        let round = 0.2 * some.hertz().c_m / case(1e-5, 5.0, 1.0).roller.radius_m;
        let [block, roller] = BodyKind::ALL.map(|kind| at(&some, kind, x) - at(&none, kind, x));
        small("opposite tractions", apart(&block, &(roller * -1.0)), 2.0 * round);
    }
}

/// A traction's field has no divergence and a harmonic trace, in random scenes of all kinds.
#[test]
fn fields_of_tractions_are_in_equilibrium_and_compatible() {
    let mut random = Random::new();
    for _ in 0..SCENES {
        let case = Case { sliding: Sliding { friction: 1.0 }, ..random.case() };
        let scene = Scene::new(&case, EdgeModel::QuarterSpace, None);
        let solved = SolvedScene::new(&scene).unwrap();
        for kind in BodyKind::ALL {
            let field = solved.field(kind);
            for _ in 0..8 {
                let place = random.place(scene.half_length, half_of(&scene, kind));
                let [divergence, laplacian] = imbalance(|at| dragged(&field, at), place);
                let at = format!("{} at {place:.3?}, {scene:?}", kind.name());
                small(&format!("divergence, {at}"), divergence, LIMITS[0]);
                small(&format!("Laplacian of the trace, {at}"), laplacian, LIMITS[1]);
            }
        }
    }
}

/// The stresses of a load off the middle are those of a symmetric one where both are the same
/// scene.
#[test]
fn a_whole_line_and_its_half_agree() {
    let symmetric = sliding(5.0, 0.6, 0.3, EdgeModel::QuarterSpace);
    let tilt = edgeline::solve::Tilt::Free(0.0);
    let whole = SolvedScene::new(&Scene { tilt, ..symmetric.scene.clone() }).unwrap();
    for kind in BodyKind::ALL {
        let fields = [&symmetric, &whole].map(|s| s.field(kind));
        for at in [[0.5, 4.2, 0.3], [-0.7, -4.9, 0.6], [0.0, 4.0, 0.5], [-1.2, 2.0, 0.0]] {
            let [half, whole] = fields.each_ref().map(|field| dragged(field, at));
            small(&format!("{} at {at:?}", kind.name()), apart(&half, &whole), 3e-3);
        }
    }
}
