//! Bessel functions of odd order, which transform the pressure's modes.

use std::f64::consts::PI;

/// From here on Hankel's expansions have no error beyond rounding.
const FAR: f64 = 24.0;

/// Terms of Hankel's expansions: the first one left out is below 2e-15 at [`FAR`].
const TERMS: usize = 20;

/// Terms of P, and of Q, in powers of 1 / s^2, for J0 and J1.
const EXPANSIONS: [[[f64; 2]; TERMS / 2]; 2] = [expansion(0.0), expansion(4.0)];

/// The terms of P and Q for 4 nu^2 = `mu` (Abramowitz and Stegun 1964, 9.2.9 and 9.2.10).
const fn expansion(mu: f64) -> [[f64; 2]; TERMS / 2] {
    let mut terms = [[0.0; 2]; TERMS / 2];
    let (mut term, mut i) = (1.0, 0);
    while i < TERMS {
        let sign = if i / 2 % 2 == 0 { 1.0 } else { -1.0 };
        terms[i / 2][i % 2] = sign * term;
        i += 1;
        let odd = (2 * i - 1) as f64;
        term *= (mu - odd * odd) / (8 * i) as f64;
    }
    terms
}

/// J0(s) and J1(s), s >= [`FAR`], by Hankel's expansions (Abramowitz and Stegun 1964, 9.2.5).
fn far(s: f64) -> [f64; 2] {
    let (inverse, (sin, cos)) = (1.0 / s, s.sin_cos());
    let square = inverse * inverse;
    let [[p0, q0], [p1, q1]] = EXPANSIONS.map(|terms| {
        let sum = |[p, q]: [f64; 2], term: &[f64; 2]| [p * square + term[0], q * square + term[1]];
        terms.iter().rev().fold([0.0; 2], sum)
    });
    // sqrt(2 / (pi s)) times the cosine and the sine of s - pi / 4.
    let amplitude = (inverse / PI).sqrt();
    let (cos, sin) = (amplitude * (cos + sin), amplitude * (sin - cos));
    [p0 * cos - q0 * inverse * sin, p1 * sin + q1 * inverse * cos]
}

/// Bessel functions J1(s), J3(s), ..., of the first `out.len()` odd orders, s >= 0.
///
/// Upward recurrence from J0 and J1 where it is stable (s above the highest order), otherwise
/// Miller's downward recurrence normalised by J0 + 2 sum J_2n = 1 (Abramowitz and Stegun 1964,
/// 9.1.46). Returns J0(s).
pub fn bessel_j_odd(s: f64, out: &mut [f64]) -> f64 {
    let (highest, step) = (2 * out.len(), 2.0 / s);
    if s > highest as f64 {
        let [j0, j1] = if s < FAR { [libm::j0(s), libm::j1(s)] } else { far(s) };
        let (mut before, mut here) = (j0, j1);
        for order in 1..highest {
            if order % 2 == 1 {
                out[order / 2] = here;
            }
            (before, here) = (here, order as f64 * step * here - before);
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
    // Starts at an order whose value (s / 2)^n / n! is below 1e-15.
    let start = 2 * ((highest + 4).max((2.4 * s + 15.0) as usize) / 2);
    let (mut above, mut here) = (0.0, 1e-30);
    let mut norm = 0.0;
    for order in (1..=start).rev() {
        // `here` is proportional to J_order.
        if order % 2 == 0 {
            norm += 2.0 * here;
        } else if order / 2 < out.len() {
            out[order / 2] = here;
        }
        (above, here) = (here, order as f64 * step * here - above);
        if here.abs() > 1e200 {
            (above, here, norm) = (above * 1e-200, here * 1e-200, norm * 1e-200);
            out.iter_mut().for_each(|o| *o *= 1e-200);
        }
    }
    norm += here;
    out.iter_mut().for_each(|o| *o /= norm);
    here / norm
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hankels_expansions_equal_the_functions() {
        for i in 0..20_000 {
            let s = FAR * (1.0 + 1e-3 * f64::from(i)).powi(2);
            for (got, want) in far(s).into_iter().zip([libm::j0(s), libm::j1(s)]) {
                assert!((got - want).abs() < 3e-16 + 2e-15 / s.sqrt(), "{s}: {got} {want}");
            }
        }
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
