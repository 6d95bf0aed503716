//! Modified Bessel functions K0 and K1, their incomplete integrals J and N, and the Bessel
//! functions of odd order that transform the pressure's modes.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::sync::OnceLock;

/// Euler's constant.
pub const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;

/// sqrt(x) e^x K0(x) as a polynomial in 2/x for x >= 2: Chebyshev interpolation of a
/// 40-digit evaluation, relative error below 7e-12.
const K0_TAIL: [f64; 13] = [
    1.253_314_137_307_885_8,
    -0.078_332_130_993_800_406,
    0.022_030_763_434_608_428,
    -0.011_470_973_467_172_591,
    0.008_742_126_947_419_203_1,
    -0.008_563_973_702_852_704_8,
    0.009_476_861_351_045_851_7,
    -0.010_251_706_662_216_917,
    0.009_507_797_387_683_614_9,
    -0.006_802_201_322_114_217_3,
    0.003_403_350_939_398_986_2,
    -0.001_042_990_227_730_418_4,
    0.000_146_122_425_752_057_96,
];

/// sqrt(x) e^x K1(x), likewise.
const K1_TAIL: [f64; 13] = [
    1.253_314_137_324_136_9,
    0.234_996_397_810_958_9,
    -0.036_718_018_523_456_218,
    0.016_060_286_087_696_153,
    -0.011_246_478_082_619_961,
    0.010_497_394_750_888_115,
    -0.011_292_739_123_434_261,
    0.012_022_209_202_416_574,
    -0.011_050_413_329_520_97,
    0.007_865_132_994_504_664_4,
    -0.003_922_856_845_806_458_2,
    0.001_199_781_531_760_471_9,
    -0.000_167_860_277_489_544_82,
];

/// Coefficients of y^n, y = x^2/4, in I0, in the regular part of K0, in I1/(x/2), and in the
/// regular part of K1 (Abramowitz and Stegun 1964, 9.6.10 to 9.6.13).
struct Series {
    i0: [f64; 12],
    k0: [f64; 12],
    i1: [f64; 12],
    k1: [f64; 12],
}

const SERIES: Series = {
    let mut s = Series { i0: [0.0; 12], k0: [0.0; 12], i1: [0.0; 12], k1: [0.0; 12] };
    let mut n = 0;
    let mut inverse = 1.0; // 1 / (n!)^2
    let mut psi = -EULER_GAMMA; // psi(n + 1)
    while n < 12 {
        let next = n as f64 + 1.0;
        s.i0[n] = inverse;
        s.k0[n] = inverse * psi;
        s.i1[n] = inverse / next;
        s.k1[n] = inverse / next * (psi + psi + 1.0 / next);
        inverse /= next * next;
        psi += 1.0 / next;
        n += 1;
    }
    s
};

#[inline]
fn horner<const N: usize>(coefficients: &[f64; N], t: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// K0(x) and K1(x), x > 0; relative error below 1e-11.
#[inline]
pub fn k0_k1(x: f64) -> (f64, f64) {
    if x < 2.0 {
        let half = 0.5 * x;
        let y = half * half;
        let ln = half.ln();
        let k0 = horner(&SERIES.k0, y) - ln * horner(&SERIES.i0, y);
        let k1 = 1.0 / x + half * (ln * horner(&SERIES.i1, y) - 0.5 * horner(&SERIES.k1, y));
        (k0, k1)
    } else {
        let t = 2.0 / x;
        let scale = (-x).exp() / x.sqrt();
        (scale * horner(&K0_TAIL, t), scale * horner(&K1_TAIL, t))
    }
}

/// K0(x), x > 0.
#[inline]
pub fn k0(x: f64) -> f64 {
    if x < 2.0 {
        let y = 0.25 * x * x;
        horner(&SERIES.k0, y) - (0.5 * x).ln() * horner(&SERIES.i0, y)
    } else {
        (-x).exp() / x.sqrt() * horner(&K0_TAIL, 2.0 / x)
    }
}

/// The pair of integrals that carry what a Poisson's ratio other than 1/2 adds,
///
/// J(u, v) = int_v^inf K0(r) dz and N(u, v) = -dJ/du = int_v^inf u K1(r)/r dz, r^2 = u^2 + z^2,
///
/// for u, v >= 0 with rho^2 = u^2 + v^2 > 0. Interpolated from a table of the integrals
///
/// J = cos f int e^(-rho C) C / (C^2 - sin^2 f) dt, N = sin f cos f int e^(-rho C) / (C^2 - sin^2 f) dt
///
/// over t in (0, inf), C = cosh t, u = rho sin f, v = rho cos f: from the Fourier form
/// J = int cos(s u) e^(-v sqrt(1+s^2)) / (1+s^2) ds by s = sinh t and the shift of t by i f.
/// Absolute error below 2e-6 (checked against quadrature).
#[inline]
pub fn incomplete(u: f64, v: f64, rho: f64) -> (f64, f64) {
    if rho < Table::FLOOR {
        let angle = v.atan2(u);
        let j = FRAC_PI_2 * (1.0 - u) + v * ((0.5 * rho).ln() + EULER_GAMMA - 1.0) + u * angle;
        return (j, FRAC_PI_2 - angle);
    }
    if rho >= Table::CEILING {
        return (0.0, 0.0);
    }
    static TABLE: OnceLock<Table> = OnceLock::new();
    TABLE.get_or_init(Table::build).at(u, v, rho)
}

/// J and N times e^rho: bilinear tensor Chebyshev polynomials on patches, one row of patches per
/// octave of rho, equal patches in u / (u + v).
struct Table {
    /// Monomial coefficients [patch][power of the octave's coordinate][power of the angle's].
    patches: Vec<[[[f64; 2]; Table::ORDER]; Table::ORDER]>,
}

impl Table {
    const ORDER: usize = 6;
    const ANGLES: usize = 6;
    /// Octaves of rho: 2^LOW up to 2^HIGH.
    const LOW: i32 = -11;
    const HIGH: i32 = 5;
    const FLOOR: f64 = 1.0 / 2048.0;
    const CEILING: f64 = 32.0;

    fn build() -> Self {
        let n = Self::ORDER;
        // Interpolation at Chebyshev nodes, expressed in powers (n = 6 keeps this well conditioned).
        let nodes: Vec<f64> =
            (0..n).map(|i| (std::f64::consts::PI * (i as f64 + 0.5) / n as f64).cos()).collect();
        let vandermonde = nalgebra::DMatrix::from_fn(n, n, |i, j| nodes[i].powi(j as i32));
        let inverse = vandermonde.try_inverse().expect("distinct nodes");
        let mut patches = Vec::new();
        for octave in Self::LOW..Self::HIGH {
            for angle in 0..Self::ANGLES {
                let mut values = [[[0.0; 2]; Self::ORDER]; Self::ORDER];
                for (i, row) in values.iter_mut().enumerate() {
                    let rho = 2f64.powi(octave) * (1.5 + 0.5 * nodes[i]);
                    for (j, value) in row.iter_mut().enumerate() {
                        let share = (angle as f64 + 0.5 + 0.5 * nodes[j]) / Self::ANGLES as f64;
                        *value = scaled_incomplete(rho, share.atan2(1.0 - share));
                    }
                }
                let mut patch = [[[0.0; 2]; Self::ORDER]; Self::ORDER];
                for (a, row) in patch.iter_mut().enumerate() {
                    for (b, coefficient) in row.iter_mut().enumerate() {
                        for (i, line) in values.iter().enumerate() {
                            for (j, value) in line.iter().enumerate() {
                                let weight = inverse[(a, i)] * inverse[(b, j)];
                                coefficient[0] += weight * value[0];
                                coefficient[1] += weight * value[1];
                            }
                        }
                    }
                }
                patches.push(patch);
            }
        }
        Self { patches }
    }

    #[inline]
    fn at(&self, u: f64, v: f64, rho: f64) -> (f64, f64) {
        // The binary exponent is the octave, the mantissa the place in it.
        let bits = rho.to_bits();
        let octave = ((bits >> 52) as i32) - 1023;
        let mantissa = f64::from_bits((bits & ((1 << 52) - 1)) | (1023 << 52));
        let a = 2.0 * mantissa - 3.0;
        let share = u / (u + v) * Self::ANGLES as f64;
        let angle = (share as usize).min(Self::ANGLES - 1);
        let b = 2.0 * (share - angle as f64) - 1.0;
        let patch = &self.patches[(octave - Self::LOW) as usize * Self::ANGLES + angle];
        let (mut j, mut n) = (0.0, 0.0);
        for row in patch.iter().rev() {
            let (mut row_j, mut row_n) = (0.0, 0.0);
            for c in row.iter().rev() {
                row_j = row_j * b + c[0];
                row_n = row_n * b + c[1];
            }
            j = j * a + row_j;
            n = n * a + row_n;
        }
        let decay = (-rho).exp();
        (j * decay, n * decay)
    }
}

/// e^rho J and e^rho N at u = rho sin f, v = rho cos f.
///
/// The integrand has a pole at t = i (pi/2 - f); its contribution (pi/2) e^(rho - u) to J and N is
/// subtracted in a form that stays integrable, and the trapezoidal rule converges geometrically for
/// the rest.
fn scaled_incomplete(rho: f64, f: f64) -> [f64; 2] {
    let (sin, cos) = f.sin_cos();
    if cos < 1e-12 {
        return [FRAC_PI_2 * (rho - rho * sin).exp(); 2];
    }
    // Subtract g(t) = e^(rho - u) cos f C / (sinh^2 t + cos^2 f), whose integral is
    // (pi/2) e^(rho - u), damped by nothing: the difference decays like e^(-t).
    // Then J's integrand is [e^(rho - rho C) - e^(rho - u)] C cos f / (sinh^2 t + cos^2 f), smooth at
    // the pole; N's is the same with sin f / C as a further factor on the first term.
    let pole = (rho - rho * sin).exp();
    let step = 0.02;
    let (mut j, mut n) = (0.0, 0.0);
    let mut t: f64 = 0.0;
    for i in 0..2000 {
        let c = t.cosh();
        let s = t.sinh();
        let factor = cos * c / (s * s + cos * cos);
        let weight = if i == 0 { 0.5 } else { 1.0 };
        let decay = (rho - rho * c).exp();
        j += weight * (decay - pole) * factor;
        n += weight * (decay * sin / c - pole) * factor;
        t += step;
        if factor * pole < 1e-13 * (1.0 + pole) {
            break;
        }
    }
    [FRAC_PI_2 * pole + step * j, FRAC_PI_2 * pole + step * n]
}

/// Bessel functions J1(s), J3(s), ..., of the first `out.len()` odd orders, s >= 0.
///
/// Upward recurrence from J0 and J1 where it is stable (s above the highest order), else Miller's
/// downward recurrence normalised by J0 + 2 sum J_2n = 1 (Abramowitz and Stegun 1964, 9.1.46).
/// Returns J0(s).
pub fn bessel_j_odd(s: f64, out: &mut [f64]) -> f64 {
    let highest = 2 * out.len();
    if s > highest as f64 {
        let (mut before, mut here) = bessel_j0_j1(s);
        let j0 = before;
        for order in 1..highest {
            if order % 2 == 1 {
                out[order / 2] = here;
            }
            (before, here) = (here, 2.0 * order as f64 / s * here - before);
        }
        return j0;
    }
    if s < 1e-8 {
        out.fill(0.0);
        if let Some(first) = out.first_mut() {
            *first = 0.5 * s;
        }
        return 1.0;
    }
    let start = 2 * ((highest + 18).max((s + 20.0) as usize) / 2);
    let (mut above, mut here) = (0.0, 1e-30);
    let mut norm = 0.0;
    for order in (1..=start).rev() {
        // `here` is proportional to J_order.
        if order % 2 == 0 {
            norm += 2.0 * here;
        } else if order / 2 < out.len() {
            out[order / 2] = here;
        }
        (above, here) = (here, 2.0 * order as f64 / s * here - above);
        if here.abs() > 1e200 {
            (above, here, norm) = (above * 1e-200, here * 1e-200, norm * 1e-200);
            out.iter_mut().for_each(|o| *o *= 1e-200);
        }
    }
    norm += here;
    out.iter_mut().for_each(|o| *o /= norm);
    here / norm
}

/// J0(s) and J1(s) for s > 2.
fn bessel_j0_j1(s: f64) -> (f64, f64) {
    if s < 25.0 {
        let mut odd = [0.0; 1];
        // Miller's recurrence serves moderate arguments too: ask for one order only.
        let start = 2 * ((s + 30.0) as usize / 2 + 5);
        let (mut above, mut here, mut norm) = (0.0, 1e-250, 0.0);
        for order in (1..=start).rev() {
            if order % 2 == 0 {
                norm += 2.0 * here;
            } else if order == 1 {
                odd[0] = here;
            }
            (above, here) = (here, 2.0 * order as f64 / s * here - above);
        }
        norm += here;
        return (here / norm, odd[0] / norm);
    }
    // Hankel's asymptotic expansions (Abramowitz and Stegun 1964, 9.2.5 to 9.2.10).
    let expansion = |mu: f64| {
        let (mut p, mut q, mut term) = (0.0, 0.0, 1.0);
        for n in 0..16 {
            match n % 4 {
                0 => p += term,
                1 => q += term,
                2 => p -= term,
                _ => q -= term,
            }
            let odd = (2 * n + 1) as f64;
            term *= (mu - odd * odd) / ((n + 1) as f64 * 8.0 * s);
        }
        (p, q)
    };
    let scale = (1.0 / (FRAC_PI_2 * s)).sqrt();
    let (sin0, cos0) = (s - FRAC_PI_4).sin_cos();
    let (p0, q0) = expansion(0.0);
    let (p1, q1) = expansion(4.0);
    // The phase of J1 lags that of J0 by a quarter turn.
    (scale * (p0 * cos0 - q0 * sin0), scale * (p1 * sin0 + q1 * cos0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn k0_and_k1_equal_reference_values() {
        // Abramowitz and Stegun 1964, table 9.8 (K0, K1 by multiplication with e^-x) and 40-digit
        // evaluations.
        let table = [
            (0.1, 2.427_069_024_702_017, 9.853_844_780_870_606),
            (1.0, 0.421_024_438_240_708_34, 0.601_907_230_197_234_6),
            (1.999, 0.11403383058923292, 0.14004984207710968),
            (2.0, 0.113_893_872_749_533_44, 0.139_865_881_816_522_43),
            (5.0, 0.003_691_098_334_042_594, 0.004_044_613_445_452_164),
            (10.0, 1.778_006_231_616_765e-5, 1.864_877_345_382_558_5e-5),
        ];
        for (x, want0, want1) in table {
            let (got0, got1) = k0_k1(x);
            assert!((got0 / want0 - 1.0).abs() < 2e-11, "K0({x}) = {got0}");
            assert!((got1 / want1 - 1.0).abs() < 2e-11, "K1({x}) = {got1}");
            assert_eq!(k0(x), got0);
        }
    }

    #[test]
    fn incomplete_integrals_equal_their_definition() {
        let axis = crate::base::Panels::new(
            std::iter::once(0.0).chain((-30..=6).map(|i| 2f64.powi(i))).collect(),
            12,
        );
        let mut worst: f64 = 0.0;
        for u in [1e-5f64, 1e-3, 0.02, 0.3, 1.0, 2.7, 9.0] {
            for v in [0.0f64, 1e-5, 1e-3, 0.02, 0.3, 1.0, 2.7, 9.0] {
                let (mut j, mut n) = (0.0, 0.0);
                for (z, w) in axis.nodes().iter().zip(axis.weights()) {
                    let r = u.hypot(z + v);
                    let (k0, k1) = k0_k1(r);
                    j += w * k0;
                    n += w * u * k1 / r;
                }
                let (got_j, got_n) = incomplete(u, v, u.hypot(v));
                worst = worst.max((got_j - j).abs()).max((got_n - n).abs());
                assert!((got_j - j).abs() < 2e-6, "J({u}, {v}) = {got_j}, {j}");
                // Just above the table's floor the leading terms of N are good to rho.
                assert!((got_n - n).abs() < 5e-4, "N({u}, {v}) = {got_n}, {n}");
            }
        }
        println!("worst {worst:e}");
    }

    #[test]
    fn odd_bessel_functions_solve_the_recurrence_and_known_values() {
        let mut out = [0.0; 4];
        for (s, j0, j1, j3) in [
            (1.0, 0.765_197_686_557_966_6, 0.440_050_585_744_933_5, 0.019_563_353_982_668_4),
            (7.0, 0.300_079_270_519_555_6, -0.004_682_823_482_345_8, -0.167_555_587_995_334_2),
            (20.0, 0.167_024_664_340_583_2, 0.066_833_124_175_850_05, -0.098_901_394_560_449_7),
            (50.0, 0.055_812_327_669_251_75, -0.097_511_828_125_175_14, 0.092_734_804_062_059_2),
        ] {
            let got0 = bessel_j_odd(s, &mut out);
            assert!((got0 - j0).abs() < 1e-12, "J0({s}) = {got0}");
            assert!((out[0] - j1).abs() < 1e-12, "J1({s}) = {}", out[0]);
            assert!((out[1] - j3).abs() < 1e-9, "J3({s}) = {}", out[1]);
        }
        let mut a = [0.0; 4];
        let mut b = [0.0; 4];
        bessel_j_odd(7.999_999_9, &mut a);
        bessel_j_odd(8.000_000_1, &mut b);
        for (a, b) in a.iter().zip(&b) {
            assert!((a - b).abs() < 1e-6);
        }
    }
}
