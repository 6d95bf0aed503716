//! Gauss-Legendre quadrature and interpolation on panels.

use std::f64::consts::PI;

/// Nodes (ascending, in (-1, 1)) and weights of the Gauss-Legendre rule with `n` >= 1 points.
///
/// Newton's method on the Legendre polynomial from Tricomi's first guess; accurate to rounding for
/// the orders used here (n <= 64).
pub fn gauss_legendre(n: usize) -> (Vec<f64>, Vec<f64>) {
    let mut nodes = vec![0.0; n];
    let mut weights = vec![0.0; n];
    for i in 0..n.div_ceil(2) {
        let mut t = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..100 {
            let (value, derivative) = legendre(n, t);
            slope = derivative;
            let step = value / derivative;
            t -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        nodes[i] = -t;
        nodes[n - 1 - i] = t;
        weights[i] = 2.0 / ((1.0 - t * t) * slope * slope);
        weights[n - 1 - i] = weights[i];
    }
    (nodes, weights)
}

/// Nodes (in (0, 1)) and weights of a rule with `n` points for functions that are steep at 0: those
/// of Gauss, crowded there by the map t^`power`.
pub fn crowded_legendre(n: usize, power: i32) -> Vec<(f64, f64)> {
    let (nodes, weights) = gauss_legendre(n);
    let crowded = |(t, w): (&f64, &f64)| {
        let t = 0.5 * (1.0 + t);
        (t.powi(power), 0.5 * w * f64::from(power) * t.powi(power - 1))
    };
    nodes.iter().zip(&weights).map(crowded).collect()
}

/// Legendre polynomial P_n(t) and its derivative, |t| < 1, by the three-term recurrence.
pub fn legendre(n: usize, t: f64) -> (f64, f64) {
    let (mut before, mut here) = (1.0, t);
    if n == 0 {
        return (1.0, 0.0);
    }
    for m in 2..=n {
        let m = m as f64;
        (before, here) = (here, ((2.0 * m - 1.0) * t * here - (m - 1.0) * before) / m);
    }
    (here, n as f64 * (t * here - before) / (t * t - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crowded_rules_integrate_what_is_steep() {
        for (n, power) in [(8, 3), (10, 4)] {
            let integral = |f: fn(f64) -> f64| -> f64 {
                crowded_legendre(n, power).iter().map(|(t, w)| w * f(*t)).sum()
            };
            assert!((integral(|_| 1.0) - 1.0).abs() < 1e-13);
            assert!((integral(f64::ln) + 1.0).abs() < 1e-4);
            assert!((integral(|t| t.powf(-0.3)) - 1.0 / 0.7).abs() < 1e-5);
        }
    }

    #[test]
    fn rules_are_exact_for_polynomials() {
        for n in 1..=32 {
            let (x, w) = gauss_legendre(n);
            for power in 0..2 * n {
                let sum: f64 = x.iter().zip(&w).map(|(x, w)| w * x.powi(power as i32)).sum();
                let exact = if power % 2 == 0 { 2.0 / (power as f64 + 1.0) } else { 0.0 };
                assert!((sum - exact).abs() < 1e-13, "n = {n}, power = {power}: {sum}");
            }
        }
    }
}
