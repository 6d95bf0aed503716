//! A half-space in plane strain under a pressure on a strip, as a sum of modes.
//!
//! The pressure on |x| <= a is p(x) = sum_m c_m sqrt(1 - t^2) U_2m(t), t = x/a; the Hertz pressure
//! is the first mode alone. Every integral of these modes that the contact needs has a closed form.

use super::bessel_table::tabulated_j_odd;
use std::f64::consts::{FRAC_PI_2, LN_2, PI};

/// Plane-strain stresses xx, zz, xz at (`x`, `z` >= 0) of the modes `coefficients` on
/// |x| <= `half_width`; yy is nu (xx + zz).
///
/// With zeta = (x + i z)/a: F(zeta) = int p(t')/(zeta - t') dt' = pi sum c_m (zeta - sqrt(zeta^2 -
/// 1))^(2m+1) (Mason and Handscomb, Chebyshev Polynomials, 2003, section 9.5.1), and the line-load
/// solution (Johnson 1985, Eq. 2.23) sums to pi xx = Im F + Re(z F'), pi zz = Im F - Re(z F'), pi
/// xz = -Im(z F'). On the surface inside the strip the result is the limit from z > 0: xx = zz =
/// -p, xz = 0.
pub fn stress(half_width: f64, coefficients: &[f64], x: f64, z: f64) -> [f64; 3] {
    let [_, f, g, h] = potential(half_width, coefficients, x, z);
    [f + g, f - g, -h]
}

/// As [`stress`], of the modes as a traction along x on the surface, towards +x. With F as there,
/// the tangential line load (Johnson 1985, Eq. 2.22) sums to pi xx = -2 Re F + Im(z F'), pi zz =
/// -Im(z F'), pi xz = Im F + Re(z F').
pub fn stress_along(half_width: f64, coefficients: &[f64], x: f64, z: f64) -> [f64; 3] {
    let [e, f, g, h] = potential(half_width, coefficients, x, z);
    [h - 2.0 * e, -h, f + g]
}

/// Harmonic functions of the modes' pressure with the transform P(k): the integrals over k / pi of
/// P e^(-k z) sin(k x) / k, P e^(-k z) sin(k x) and P e^(-k z) cos(k x), at (`x`, `z` >= 0).
///
/// The last two are the real part of F / pi, see [`stress`], and minus its imaginary part; the
/// first is the integral of the last along x. With w = zeta - sqrt(zeta^2 - 1), dzeta is
/// (1 - w^-2) / 2 dw.
pub fn potentials(half_width: f64, coefficients: &[f64], x: f64, z: f64) -> [f64; 3] {
    let (root, (wr, wi)) = inverse_sum(half_width, x, z);
    let [re, im, ..] = potential_of(root, (wr, wi), coefficients, z / half_width);
    let (size, angle) = (wr.hypot(wi), wi.atan2(wr));
    let mut along = 0.0;
    for (m, c) in coefficients.iter().enumerate() {
        let n = 2.0 * m as f64;
        let power = |n: f64| size.powf(n) * (n * angle).sin() / n;
        let below = if m == 0 { angle + FRAC_PI_2 } else { power(n) };
        along += 0.5 * c * (below - power(n + 2.0));
    }
    [half_width * along, re, -im]
}

/// Real and imaginary part of F / pi and of z F' / pi, see [`stress`].
fn potential(half_width: f64, coefficients: &[f64], x: f64, z: f64) -> [f64; 4] {
    let (root, w) = inverse_sum(half_width, x, z);
    potential_of(root, w, coefficients, z / half_width)
}

/// [`potential`] by what [`inverse_sum`] gives, at the depth `d` in half-widths.
fn potential_of(
    (re, im): (f64, f64),
    (wr, wi): (f64, f64),
    coefficients: &[f64],
    d: f64,
) -> [f64; 4] {
    // Powers w^(2m+1); dw/dzeta = -w / sqrt(zeta^2 - 1).
    let (sqr, sqi) = (wr * wr - wi * wi, 2.0 * wr * wi);
    let (mut pr, mut pi) = (wr, wi);
    let (mut fr, mut fi, mut gr, mut gi) = (0.0, 0.0, 0.0, 0.0);
    for (m, c) in coefficients.iter().enumerate() {
        let order = (2 * m + 1) as f64;
        fr += c * pr;
        fi += c * pi;
        gr += c * order * pr;
        gi += c * order * pi;
        (pr, pi) = (pr * sqr - pi * sqi, pr * sqi + pi * sqr);
    }
    // Im F = pi fi; z F' = -pi d (gr + i gi) / (re + i im) = pi (hr + i hi).
    let root2 = re * re + im * im;
    let (hr, hi) = if d > 0.0 && root2 > 0.0 {
        (-d * (gr * re + gi * im) / root2, -d * (gi * re - gr * im) / root2)
    } else {
        (0.0, 0.0)
    };
    [fr, fi, hr, hi]
}

/// The root of zeta^2 - 1 and w = zeta - sqrt(zeta^2 - 1), see [`stress`]: real and imaginary
/// parts.
fn inverse_sum(half_width: f64, x: f64, z: f64) -> ((f64, f64), (f64, f64)) {
    let (t, d) = (x / half_width, z / half_width);
    // The root of zeta^2 - 1 with a positive imaginary part in the upper half plane, and a real one
    // of the sign of t. Its smaller part follows from the larger one: as a difference it would
    // vanish far away and next to the surface.
    let modulus = (t - 1.0).hypot(d) * (t + 1.0).hypot(d);
    let a = (t - 1.0) * (t + 1.0) - d * d;
    let (re, im) = if modulus == 0.0 {
        (0.0, 0.0)
    } else if a >= 0.0 {
        let re = (0.5 * (modulus + a)).sqrt().copysign(t);
        (re, t * d / re)
    } else {
        let im = (0.5 * (modulus - a)).sqrt();
        (t * d / im, im)
    };
    // w = zeta - sqrt(zeta^2 - 1), the branch with |w| <= 1, as the inverse of the sum: for z >= 0
    // its imaginary part is <= 0.
    let (sum_re, sum_im) = (t + re, d + im);
    let norm = sum_re * sum_re + sum_im * sum_im;
    ((re, im), (sum_re / norm, -sum_im / norm))
}

/// Plane-strain stresses xx, zz, xz at (`x`, `z` >= 0) of the unit pressure on |x'| <= `half_width`
/// (Johnson 1985, Eqs. 2.30); the mean of both sides where the pressure jumps on the surface.
pub fn uniform(half_width: f64, x: f64, z: f64) -> [f64; 3] {
    // Of the pressure on x' <= x - u, per 1 / pi, with the angle theta from the surface.
    let beyond = |u: f64| {
        if u == 0.0 && z == 0.0 {
            return [-FRAC_PI_2, -FRAC_PI_2, 0.0];
        }
        let (angle, square) = (z.atan2(u), u * u + z * z);
        let sine = u * z / square;
        [-angle - sine, -angle + sine, -z * z / square]
    };
    let [right, left] = [beyond(x - half_width), beyond(x + half_width)];
    std::array::from_fn(|i| (right[i] - left[i]) / PI)
}

/// Fourier transform at the wavenumber `k` >= 0 of the unit pressure on |x'| <= `half_width`.
pub fn uniform_transform(half_width: f64, k: f64) -> f64 {
    if k == 0.0 { 2.0 * half_width } else { 2.0 * (k * half_width).sin() / k }
}

/// Pressure of the modes at `x`.
pub fn pressure(half_width: f64, coefficients: &[f64], x: f64) -> f64 {
    let t = x / half_width;
    if t.abs() >= 1.0 {
        return 0.0;
    }
    (1.0 - t * t).sqrt() * even_polynomial(coefficients, t)
}

/// sum c_m U_2m(t), by Clenshaw's recurrence in U_(n+2) = (4 t^2 - 2) U_n - U_(n-2).
fn even_polynomial(coefficients: &[f64], t: f64) -> f64 {
    let factor = 4.0 * t * t - 2.0;
    let (mut above, mut here) = (0.0, 0.0);
    for c in coefficients.iter().rev() {
        (above, here) = (here, c + factor * here - above);
    }
    // U_0 = 1 and U_2 = factor + 1, so the recurrence's start U_(-2) = -1 adds -above * (-1).
    here + above
}

/// Integral of the modes' pressure from -`half_width` to `x`.
pub fn cumulative(half_width: f64, coefficients: &[f64], x: f64) -> f64 {
    // sqrt(1-t^2) U_n = sin((n+1) f), t = cos f, and dt = -sin f df.
    let f = (x / half_width).clamp(-1.0, 1.0).acos();
    let back = PI - f;
    let mut sum = 0.0;
    for (m, c) in coefficients.iter().enumerate() {
        let n = (2 * m) as f64;
        // int sin((n+1) g) sin g dg from f to pi.
        let low = if m == 0 { back } else { -(n * f).sin() / n };
        let high = -((n + 2.0) * f).sin() / (n + 2.0);
        sum += 0.5 * c * (low - high);
    }
    half_width * sum
}

/// Fourier transforms int p(x) cos(k x) dx of each mode with unit coefficient on |x| <=
/// `half_width`, into `out`: pi a (2m+1) (-1)^m J_(2m+1)(k a) / (k a). Returns that of the mode
/// 1/sqrt(1 - t^2), pi a J_0(k a) (Abramowitz and Stegun 1964, 9.1.20 and 9.1.21).
pub fn transforms(half_width: f64, k: f64, out: &mut [f64]) -> f64 {
    let s = k * half_width;
    let j0 = tabulated_j_odd(s, out);
    for (m, o) in out.iter_mut().enumerate() {
        let sign = if m % 2 == 0 { 1.0 } else { -1.0 };
        // J_1(s)/s tends to 1/2; the others vanish.
        let ratio = if s > 1e-8 {
            *o / s
        } else if m == 0 {
            0.5
        } else {
            0.0
        };
        *o = PI * half_width * (2 * m + 1) as f64 * sign * ratio;
    }
    PI * half_width * j0
}

/// -int ln|x - x'| p(x') dx' at x = `t` `half_width` of each mode with unit coefficient, into
/// `out`; returns that of the mode 1/sqrt(1 - t^2).
///
/// From -int ln|t - t'| T_n(t') / sqrt(1 - t'^2) dt' = (pi / n) T_n(t), pi ln 2 for n = 0 (Mason
/// and Handscomb 2003, section 9.5.2) and sqrt(1-t^2) U_n = (T_n - T_(n+2)) / (2 sqrt(1-t^2)). For
/// |t| > 1 and even n it is (pi / n) w^n, w = |t| - sqrt(t^2 - 1), and pi ln(2 w) for n = 0: the
/// expansion of the logarithm in powers of w.
pub fn logarithmic(half_width: f64, t: f64, out: &mut [f64]) -> f64 {
    let angle = t.clamp(-1.0, 1.0).acos();
    let outside = t.abs().max(1.0) + (t * t - 1.0).max(0.0).sqrt();
    let potential = |n: usize| {
        if n == 0 {
            PI * (LN_2 - (half_width * outside).ln())
        } else if outside > 1.0 {
            PI / n as f64 * outside.powi(-(n as i32))
        } else {
            PI / n as f64 * (n as f64 * angle).cos()
        }
    };
    for (m, o) in out.iter_mut().enumerate() {
        *o = 0.5 * half_width * (potential(2 * m) - potential(2 * m + 2));
    }
    half_width * potential(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::gauss_legendre;

    const MODES: [f64; 3] = [1.0, -0.2, 0.05];

    /// Integral of f(x') p(x') over the strip by Gauss quadrature in the angle.
    fn integrate(a: f64, c: &[f64], f: impl Fn(f64) -> f64) -> f64 {
        let (g, w) = gauss_legendre(400);
        g.iter()
            .zip(&w)
            .map(|(g, w)| {
                let angle = 0.5 * PI * (1.0 + g);
                let x = a * angle.cos();
                0.5 * PI * w * a * angle.sin() * pressure(a, c, x) * f(x)
            })
            .sum()
    }

    #[test]
    fn stresses_are_the_sum_of_line_loads() {
        let a = 1.3;
        for (x, z) in [(0.0, 0.4), (0.7, 0.5), (-0.7, 0.5), (2.0, 0.8), (-3.0, 0.3), (1.3, 0.9)] {
            let got = stress(a, &MODES, x, z);
            let load = |i: usize| {
                integrate(a, &MODES, |s| {
                    let (d, r2) = (x - s, (x - s).powi(2) + z * z);
                    -2.0 / PI * [d * d * z, z.powi(3), d * z * z][i] / (r2 * r2)
                })
            };
            for (i, g) in got.iter().enumerate() {
                assert!((g - load(i)).abs() < 1e-9, "{i} at {x} {z}: {g} {}", load(i));
            }
            let along = |i: usize| {
                integrate(a, &MODES, |s| {
                    let (d, r2) = (x - s, (x - s).powi(2) + z * z);
                    -2.0 / PI * [d.powi(3), d * z * z, d * d * z][i] / (r2 * r2)
                })
            };
            for (i, g) in stress_along(a, &MODES, x, z).iter().enumerate() {
                assert!((g - along(i)).abs() < 1e-9, "{i} at {x} {z}: {g} {}", along(i));
            }
        }
        let on_surface = stress(a, &MODES, 0.6, 0.0);
        let p = pressure(a, &MODES, 0.6);
        assert!((on_surface[0] + p).abs() < 1e-12 && (on_surface[1] + p).abs() < 1e-12);
        assert!(stress(a, &MODES, 2.0, 0.0).iter().all(|s| s.abs() < 1e-12));
        assert!(stress(a, &MODES, a, 0.0).iter().all(|s| s.is_finite()));
    }

    #[test]
    fn potentials_are_integrals_over_line_loads() {
        let a = 1.3;
        for (x, z) in [(0.4, 0.0), (-0.7, 0.0), (2.0, 0.0), (0.7, 0.5), (-2.5, 0.8), (0.0, 1.0)] {
            let got = potentials(a, &MODES, x, z);
            // Of a line load at s, over pi: the angle from below it, and its conjugate functions.
            let load = |i: usize| {
                integrate(a, &MODES, |s| {
                    let (d, r2) = (x - s, (x - s).powi(2) + z * z);
                    [d.atan2(z), d / r2, z / r2][i] / PI
                })
            };
            if z == 0.0 {
                // The angle jumps at the load.
                let want = cumulative(a, &MODES, x) - cumulative(a, &MODES, 0.0);
                assert!((got[0] - want).abs() < 1e-12, "{x}: {} {want}", got[0]);
                assert!((got[2] - pressure(a, &MODES, x)).abs() < 1e-12);
                continue;
            }
            for (i, got) in got.into_iter().enumerate() {
                assert!((got - load(i)).abs() < 1e-9, "{i} at {x} {z}: {got} {}", load(i));
            }
        }
    }

    #[test]
    fn far_away_the_strip_is_a_line_load() {
        // Of all modes the first alone carries a force, a pi / 2.
        let (a, nearest) = (1.3, 1e-6);
        let force = 0.5 * PI * a * MODES[0];
        for (x, z) in [(1e5, 3.0), (-1e7, 3.0), (1e9, 1e9), (1e12, 0.5), (2.0, 1e9), (1e30, 1e20)] {
            let square: f64 = x * x + z * z;
            let scale = -2.0 * force / PI * z / square / square;
            let want = [scale * x * x, scale * z * z, scale * x * z];
            let got = stress(a, &MODES, x, z);
            let off = got.iter().zip(&want).fold(0.0, |m: f64, (g, w)| m.max((g - w).abs()));
            assert!(off < nearest * (scale * square).abs(), "at {x} {z}: {got:?} {want:?}");
        }
    }

    #[test]
    fn a_hertz_traction_pulls_behind_the_contact() {
        // Johnson 1985, Eqs. 7.6 and 7.8: -2 q x / a within the contact, and beyond it.
        for x in [-1.0, -0.4, 0.7, 1.0] {
            assert!((stress_along(1.0, &[1.0], x, 0.0)[0] + 2.0 * x).abs() < 1e-13, "{x}");
        }
        let beyond = stress_along(1.0, &[1.0], -2.0, 0.0)[0];
        assert!((beyond - 2.0 * (2.0 - 3f64.sqrt())).abs() < 1e-13);
        assert!((stress_along(1.0, &[1.0], 0.6, 0.0)[2] + 0.8).abs() < 1e-13);
    }

    #[test]
    fn hertz_is_the_first_mode() {
        for z in [0.1, 0.786, 3.0] {
            let got = stress(1.0, &[1.0], 0.0, z);
            let root = (1.0f64 + z * z).sqrt();
            assert!((got[0] + (1.0 + 2.0 * z * z) / root - 2.0 * z).abs() < 1e-13);
            assert!((got[1] + 1.0 / root).abs() < 1e-13);
        }
    }

    #[test]
    fn integrals_of_modes_equal_quadrature() {
        let a = 0.8;
        assert!((cumulative(a, &MODES, a) - integrate(a, &MODES, |_| 1.0)).abs() < 1e-12);
        let half = integrate(a, &MODES, |x| if x < 0.3 { 1.0 } else { 0.0 });
        assert!((cumulative(a, &MODES, 0.3) - half).abs() < 1e-2);
        assert!((cumulative(a, &MODES, 0.0) * 2.0 - cumulative(a, &MODES, a)).abs() < 1e-14);
        let slope = (cumulative(a, &MODES, 0.3001) - cumulative(a, &MODES, 0.2999)) / 2e-4;
        assert!((slope - pressure(a, &MODES, 0.3)).abs() < 1e-6);
        for k in [0.0, 0.1, 3.0, 30.0] {
            let mut out = [0.0; 3];
            transforms(a, k, &mut out);
            let got: f64 = out.iter().zip(MODES).map(|(o, c)| o * c).sum();
            let want = integrate(a, &MODES, |x| (k * x).cos());
            assert!((got - want).abs() < 1e-10, "k = {k}: {got} {want}");
        }
        for t in [1.02, 3.0] {
            let mut out = [0.0; 3];
            logarithmic(a, t, &mut out);
            let got: f64 = out.iter().zip(MODES).map(|(o, c)| o * c).sum();
            let want = integrate(a, &MODES, |s| -(t * a - s).ln());
            assert!((got - want).abs() < 1e-10, "at {t}: {got} {want}");
        }
        let mut out = [0.0; 3];
        logarithmic(a, 0.4, &mut out);
        let got: f64 = out.iter().zip(MODES).map(|(o, c)| o * c).sum();
        // Panels in the angle, graded towards the logarithm's pole.
        let pole = 0.4f64.acos();
        let graded = |end: f64| (0..=40).map(move |i| pole + (end - pole) * 0.5f64.powi(i));
        let mut breaks: Vec<f64> = graded(0.0).chain(graded(PI)).collect();
        breaks.push(pole);
        breaks.sort_by(f64::total_cmp);
        let axis = crate::base::Panels::new(breaks, 12);
        let x = 0.4 * a;
        let want: f64 = axis
            .nodes()
            .iter()
            .zip(axis.weights())
            .map(|(g, w)| {
                let s = a * g.cos();
                w * a * g.sin() * pressure(a, &MODES, s) * -(x - s).abs().ln()
            })
            .sum();
        assert!((got - want).abs() < 1e-10, "{got} {want}");
    }
}
