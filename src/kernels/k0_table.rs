//! K0 of many arguments at once, from a table.

use super::bessel::k0;
use multiversion::{multiversion, target::target_cfg_f};
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Coefficients of a row of [`K0_ROWS`], and the range of its rows in octaves of x: 2^LOW to 2^HIGH.
const ROW: usize = 10;
const LOW: i32 = -10;
const HIGH: i32 = 5;

/// K0 in half-octaves of x by polynomials in the place within, in [-1, 1].
static K0_ROWS: LazyLock<Vec<[f64; ROW]>> = LazyLock::new(|| {
    let row = |i: i32| {
        // The halves of an octave are equal in x.
        let octave = 2f64.powi(LOW + i / 2);
        let (from, width) = (octave * (1.0 + 0.5 * f64::from(i % 2)), 0.5 * octave);
        let node = |j: usize| (PI * (j as f64 + 0.5) / ROW as f64).cos();
        // Chebyshev coefficients, and their sum in powers.
        let mut powers = [0.0; ROW];
        let (mut before, mut here) = ([0.0; ROW], [0.0; ROW]);
        (before[0], here[1]) = (1.0, 1.0);
        for n in 0..ROW {
            let sum: f64 = (0..ROW)
                .map(|j| {
                    let angle = PI * n as f64 * (j as f64 + 0.5) / ROW as f64;
                    k0(from + width * 0.5 * (1.0 + node(j))) * angle.cos()
                })
                .sum();
            let c = sum * if n == 0 { 1.0 } else { 2.0 } / ROW as f64;
            powers.iter_mut().zip(&before).for_each(|(p, t)| *p += c * t);
            let mut next = before.map(|t| -t);
            for i in 1..ROW {
                next[i] += 2.0 * here[i - 1];
            }
            (before, here) = (here, next);
        }
        powers
    };
    (0..2 * (HIGH - LOW)).map(row).collect()
});

/// K0(`k` |u|) for all offsets u, none of them 0, into `out`; zero from `reach` on. From a table in the
/// range that contacts ask for most; absolute error below 1e-10.
pub fn k0_of_all(k: f64, offsets: &[f64], reach: f64, out: &mut Vec<f64>) {
    out.resize(offsets.len(), 0.0);
    look_up(&K0_ROWS, k, offsets, reach, out);
}

/// [`k0_of_all`], compiled for the processor's vector units too.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn look_up(rows: &[[f64; ROW]], k: f64, offsets: &[f64], reach: f64, out: &mut [f64]) {
    const MANTISSA: u32 = 52;
    const ONE: u64 = 1023 << MANTISSA;
    let times = |a: f64, b: f64, c: f64| -> f64 {
        if target_cfg_f!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
    };
    for (value, u) in out.iter_mut().zip(offsets) {
        let x = k * u.abs();
        let bits = x.to_bits();
        // An octave's half is the first digit of the mantissa; what follows is the place.
        let row = (bits >> (MANTISSA - 1)) as i64 - (2 * (1023 + i64::from(LOW)));
        let place = f64::from_bits((bits << 1) & ((1 << MANTISSA) - 1) | ONE);
        *value = match rows.get(row as usize) {
            _ if u.abs() >= reach => 0.0,
            Some(row) => {
                let t = 2.0 * place - 3.0;
                row.iter().rev().fold(0.0, |sum, c| times(sum, t, *c))
            }
            None => k0(x),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_of_k0_equals_it() {
        let (k, mut values) = (1.7, Vec::new());
        let mut offsets: Vec<f64> = (0..20_000).map(|i| 1e-4 * 1.000_7f64.powi(i)).collect();
        offsets.extend([-0.3, 1e-300, 400.0, 1e3]);
        k0_of_all(k, &offsets, 500.0, &mut values);
        let mut worst: f64 = 0.0;
        for (u, value) in offsets.iter().zip(&values) {
            let want = if *u < 500.0 { k0(k * u.abs()) } else { 0.0 };
            worst = worst.max((value - want).abs());
        }
        assert!(worst < 1e-10, "{worst:e}");
    }
}
