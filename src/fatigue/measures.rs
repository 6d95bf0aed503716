//! Measures of fatigue on a history: the stresses of one material point, in the order of time. All
//! are in the unit of the stresses.

use super::ball::smallest_ball;
use crate::base::StressTensor;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI};

/// The largest value of a history, and when it occurs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// Its number in the history.
    pub at: usize,
}

/// A plane through the material and Fatemi and Socie's measure on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// The measure, a shear strain.
    pub value: f64,
    /// The plane's unit normal.
    pub normal: [f64; 3],
}

/// What the measures need to know of a material; those without their numbers are not computed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Parameters {
    /// Dang Van's factor of the hydrostatic stress.
    pub alpha: Option<f64>,
    /// Fatemi and Socie's k over the yield stress, one over a stress, and the shear modulus.
    pub fatemi_socie: Option<[f64; 2]>,
    /// A stress that stays at all times.
    pub residual: StressTensor,
}

/// All measures of one history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measures {
    /// Range of sigma_xz.
    pub shear_range: f64,
    /// The largest shear stress.
    pub tau_max: Extreme,
    /// The largest von Mises stress.
    pub von_mises: Extreme,
    /// Dang Van's measure.
    pub dang_van: Option<Extreme>,
    /// Fatemi and Socie's measure.
    pub fatemi_socie: Option<Plane>,
}

impl Measures {
    /// The measures of a `history` of at least one stress. The residual stress is added to it for
    /// the largest shear and von Mises stress too.
    pub fn of(history: &[StressTensor], parameters: &Parameters) -> Self {
        let Parameters { alpha, fatemi_socie: strain, residual } = *parameters;
        let whole: Vec<StressTensor> = history.iter().map(|s| *s + residual).collect();
        Self {
            shear_range: shear_range(&whole),
            tau_max: largest(whole.iter().map(StressTensor::tau_max)),
            von_mises: largest(whole.iter().map(StressTensor::von_mises)),
            dang_van: alpha.map(|alpha| dang_van(&whole, alpha)),
            fatemi_socie: strain.map(|[factor, modulus]| fatemi_socie(&whole, factor, modulus)),
        }
    }
}

/// The largest of some values.
pub fn largest(values: impl Iterator<Item = f64>) -> Extreme {
    let start = Extreme { value: f64::NEG_INFINITY, at: 0 };
    values.enumerate().fold(
        start,
        |most, (at, value)| {
            if value > most.value { Extreme { value, at } } else { most }
        },
    )
}

/// The range of sigma_xz, the shear in planes parallel to the surface (Lundberg and Palmgren, Acta
/// Polytechnica, Mechanical Engineering Series 1, no. 3, 1947).
pub fn shear_range(history: &[StressTensor]) -> f64 {
    let [low, high] = history
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], s| [low.min(s.xz), high.max(s.xz)]);
    high - low
}

/// Dang Van's measure: the largest tau_a(t) + `alpha` sigma_H(t), both at the same instant. sigma_H
/// is the mean normal stress, tau_a the largest shear stress of the deviator less its mean in the
/// history, the centre of the smallest ball around the deviators (Dang Van, Griveau and Message, in
/// Biaxial and Multiaxial Fatigue, EGF 3, 1989; Dang Van, ASTM STP 1191, 1993). The ball is that of
/// elastic shakedown.
pub fn dang_van(history: &[StressTensor], alpha: f64) -> Extreme {
    let deviators: Vec<[f64; 5]> = history.iter().map(deviator).collect();
    let centre = tensor(&smallest_ball(&deviators).centre);
    largest(history.iter().map(|s| {
        // A mean normal stress changes no shear stress.
        (*s - centre).tau_max() + alpha * (s.xx + s.yy + s.zz) / 3.0
    }))
}

/// Coordinates of a stress's deviator, whose distances are those of the tensors, sqrt(s : s).
fn deviator(s: &StressTensor) -> [f64; 5] {
    const SIXTH: f64 = 0.408_248_290_463_863;
    const TWICE: f64 = std::f64::consts::SQRT_2;
    [
        FRAC_1_SQRT_2 * (s.xx - s.yy),
        SIXTH * (2.0 * s.zz - s.xx - s.yy),
        TWICE * s.xy,
        TWICE * s.xz,
        TWICE * s.yz,
    ]
}

/// The deviator of these coordinates.
fn tensor(&[a, b, c, d, e]: &[f64; 5]) -> StressTensor {
    const SIXTH: f64 = 0.408_248_290_463_863;
    StressTensor {
        xx: FRAC_1_SQRT_2 * a - SIXTH * b,
        yy: -FRAC_1_SQRT_2 * a - SIXTH * b,
        zz: 2.0 * SIXTH * b,
        xy: FRAC_1_SQRT_2 * c,
        xz: FRAC_1_SQRT_2 * d,
        yz: FRAC_1_SQRT_2 * e,
    }
}

/// Angle (rad) between the planes of the first search, and that to which the plane is found.
const FIRST_ANGLE: f64 = PI / 18.0;
const LAST_ANGLE: f64 = PI / 720.0;

/// Fatemi and Socie's measure: the largest (dgamma / 2) (1 + `factor` sigma_n,max) over all planes
/// (Fatigue and Fracture of Engineering Materials and Structures 11, 149, 1988). The amplitude of
/// the shear strain is the radius of the smallest circle around the path of the shear stress in the
/// plane over the shear `modulus` (Papadopoulos, Fatigue and Fracture of Engineering Materials and
/// Structures 21, 269, 1998), sigma_n,max the largest normal stress, of which pressure does not
/// heal: none counts below -1 / `factor`.
///
/// Planes are searched over half of the sphere, 10 degrees apart, and then around the best one
/// until it stays within a quarter of a degree.
pub fn fatemi_socie(history: &[StressTensor], factor: f64, modulus: f64) -> Plane {
    let on = |[polar, around]: [f64; 2]| {
        let (sin, cos) = polar.sin_cos();
        let normal = [sin * around.cos(), sin * around.sin(), cos];
        let (shear, stress) = on_plane(history, polar, around);
        let value = shear / modulus * (1.0 + factor * stress).max(0.0);
        ([polar, around], Plane { value, normal })
    };
    let rings = (FRAC_PI_2 / FIRST_ANGLE).round() as usize;
    let ring = |i: usize| {
        let polar = FIRST_ANGLE * i as f64;
        let count = ((2.0 * PI * polar.sin() / FIRST_ANGLE).ceil() as usize).max(1);
        (0..count).map(move |j| [polar, 2.0 * PI * j as f64 / count as f64])
    };
    let better = |a: ([f64; 2], Plane), b: ([f64; 2], Plane)| {
        if b.1.value > a.1.value { b } else { a }
    };
    let mut best = (0..=rings).flat_map(ring).map(on).reduce(better).expect("planes");
    let mut step = 0.5 * FIRST_ANGLE;
    while step > LAST_ANGLE {
        let [polar, around] = best.0;
        let wide = step / polar.sin().max(step);
        let beside = [[step, 0.0], [-step, 0.0], [0.0, wide], [0.0, -wide]]
            .map(|[up, aside]| on([polar + up, around + aside]));
        let next = beside.into_iter().fold(best, better);
        if next.0 == best.0 {
            step *= 0.5;
        }
        best = next;
    }
    let [x, y, z] = best.1.normal;
    let side = if z < 0.0 { -1.0 } else { 1.0 };
    Plane { normal: [side * x, side * y, side * z], ..best.1 }
}

/// Amplitude of the shear stress and largest normal stress on the plane with a normal at the angles
/// `polar` from z and `around` it from x.
fn on_plane(history: &[StressTensor], polar: f64, around: f64) -> (f64, f64) {
    let ((s, c), (sa, ca)) = (polar.sin_cos(), around.sin_cos());
    let (normal, down, aside) = ([s * ca, s * sa, c], [c * ca, c * sa, -s], [-sa, ca, 0.0]);
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let mut highest = f64::NEG_INFINITY;
    let path: Vec<[f64; 2]> = history
        .iter()
        .map(|t| {
            let traction = [
                dot(&[t.xx, t.xy, t.xz], &normal),
                dot(&[t.xy, t.yy, t.yz], &normal),
                dot(&[t.xz, t.yz, t.zz], &normal),
            ];
            highest = highest.max(dot(&traction, &normal));
            [dot(&traction, &down), dot(&traction, &aside)]
        })
        .collect();
    (shear_amplitude(&path), highest)
}

/// The radius of the smallest circle around a path.
pub fn shear_amplitude(path: &[[f64; 2]]) -> f64 {
    smallest_ball(path).radius
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector, SymmetricEigen};
    use proptest::prelude::RngCore;
    use proptest::test_runner::{RngAlgorithm, TestRng};

    fn random(count: usize, random: &mut TestRng) -> Vec<StressTensor> {
        let mut number = || 2.0 * random.next_u64() as f64 / u64::MAX as f64 - 1.0;
        (0..count)
            .map(|_| StressTensor::from_components(std::array::from_fn(|_| number())))
            .collect()
    }

    fn norm(s: &StressTensor) -> f64 {
        (s.xx.powi(2)
            + s.yy.powi(2)
            + s.zz.powi(2)
            + 2.0 * (s.xy.powi(2) + s.xz.powi(2) + s.yz.powi(2)))
        .sqrt()
    }

    fn whole_deviator(s: &StressTensor) -> StressTensor {
        let mean = (s.xx + s.yy + s.zz) / 3.0;
        *s - StressTensor { xx: mean, yy: mean, zz: mean, ..Default::default() }
    }

    /// Dang Van's measure from its definition: of all balls through up to six deviators, with their
    /// centre in these deviators' hull, the smallest one that contains the others.
    fn by_brute_force(history: &[StressTensor], alpha: f64) -> f64 {
        let all: Vec<StressTensor> = history.iter().map(whole_deviator).collect();
        let mut best = (f64::INFINITY, StressTensor::default());
        for chosen in 1u32..1 << all.len() {
            if chosen.count_ones() > 6 {
                continue;
            }
            let on: Vec<_> =
                (0..all.len()).filter(|i| chosen >> i & 1 == 1).map(|i| all[i]).collect();
            // Equal distances from all of them, in their affine hull: shares with the sum 1.
            let n = on.len();
            let inner = |a: &StressTensor, b: &StressTensor| {
                0.25 * (norm(&(*a + *b)).powi(2) - norm(&(*a - *b)).powi(2))
            };
            let system = DMatrix::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
                (true, true) => 2.0 * inner(&on[i], &on[j]),
                (false, false) => 0.0,
                _ => 1.0,
            });
            let right =
                DVector::from_fn(n + 1, |i, _| if i < n { inner(&on[i], &on[i]) } else { 1.0 });
            let Some(shares) = system.lu().solve(&right) else { continue };
            let centre: StressTensor = on.iter().zip(shares.iter()).map(|(s, w)| *s * *w).sum();
            let radius = norm(&(on[0] - centre));
            let around = all.iter().all(|s| norm(&(*s - centre)) <= radius * (1.0 + 1e-9));
            if around && radius < best.0 {
                best = (radius, centre);
            }
        }
        let at = |(s, d): (&StressTensor, &StressTensor)| {
            let off = *d - best.1;
            let matrix = nalgebra::Matrix3::new(
                off.xx, off.xy, off.xz, off.xy, off.yy, off.yz, off.xz, off.yz, off.zz,
            );
            let principal = SymmetricEigen::new(matrix).eigenvalues;
            0.5 * (principal.max() - principal.min()) + alpha * (s.xx + s.yy + s.zz) / 3.0
        };
        history.iter().zip(&all).map(at).fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn dang_van_is_that_of_brute_force() {
        let mut source = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
        for round in 0..50 {
            let history = random(4 + round % 7, &mut source);
            let (got, want) = (dang_van(&history, 0.3).value, by_brute_force(&history, 0.3));
            assert!((got - want).abs() < 1e-6 * want.abs().max(1.0), "{round}: {got} {want}");
        }
    }

    #[test]
    fn extrema_of_different_instants_are_another_number() {
        // Sheared while pressed, and later pulled without shear.
        let pressed = StressTensor { xx: -1.0, yy: -1.0, zz: -1.0, xz: 1.0, ..Default::default() };
        let back = StressTensor { xz: -1.0, ..pressed };
        let pulled = StressTensor { xx: 0.9, yy: 0.9, zz: 0.9, ..Default::default() };
        let history = [pressed, back, pulled];
        let found = dang_van(&history, 0.5);
        assert!((found.value - 0.5).abs() < 1e-12 && found.at == 0, "{found:?}");
        let shear = history.iter().map(|s| s.tau_max()).fold(0.0, f64::max);
        let mean = history.iter().map(|s| (s.xx + s.yy + s.zz) / 3.0).fold(f64::MIN, f64::max);
        assert!((shear + 0.5 * mean - found.value).abs() > 0.9);
    }

    #[test]
    fn a_constant_stress_leaves_dang_vans_shear_alone() {
        let mut source = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
        let history = random(20, &mut source);
        let residual = StressTensor { xx: -0.3, yy: -0.6, ..Default::default() };
        let own = |residual| {
            let parameters = Parameters { alpha: Some(0.2), residual, ..Default::default() };
            Measures::of(&history, &parameters).dang_van.unwrap()
        };
        let (with, without) = (own(residual), own(StressTensor::default()));
        assert!((with.value - without.value + 0.2 * 0.3).abs() < 1e-9);
        assert_eq!(with.at, without.at);
    }

    #[test]
    fn fatemi_and_socie_find_the_plane_of_largest_shear() {
        // Fully reversed shear in planes of z, under a tension on one of the two kinds of planes of
        // largest shear.
        let shear = |xz: f64| StressTensor { xz, xx: 0.5, ..Default::default() };
        let history: Vec<_> =
            (0..40).map(|i| shear((2.0 * PI * f64::from(i) / 40.0).sin())).collect();
        let found = fatemi_socie(&history, 0.6, 10.0);
        // Of all planes, by a fine net.
        let mut best: f64 = 0.0;
        for i in 0..=360 {
            let polar = f64::from(i) * PI / 360.0;
            for around in [0.0, 0.3, FRAC_PI_2] {
                let (amplitude, normal) = on_plane(&history, polar, around);
                best = best.max(amplitude / 10.0 * (1.0 + 0.6 * normal));
            }
        }
        assert!((found.value - best).abs() < 1e-3 * best, "{found:?} {best}");
        assert!(found.normal[0].abs() > 0.98 && found.value > 0.129, "{found:?}");
        // Without the normal stress the two are alike.
        assert!((fatemi_socie(&history, 0.0, 10.0).value - 0.1).abs() < 1e-4);
    }
}
