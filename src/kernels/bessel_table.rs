//! Bessel functions from tables, for many values: those of [`super::bessel`] on rows of arguments,
//! as polynomials of the position within a row, in [-1, 1].

use super::bessel::k0;
use super::bessel_j::bessel_j_odd;
use super::patches::chebyshev_node;
use multiversion::{multiversion, target::target_cfg_f};
use nalgebra::SMatrix;
use std::sync::LazyLock;

/// Coefficients of a row of [`K0_ROWS`], and the range of its rows in octaves of x: 2^LOW to
/// 2^HIGH.
const K0_ORDER: usize = 10;
const LOW: i32 = -10;
const HIGH: i32 = 5;

/// K0 in half-octaves of x.
static K0_ROWS: LazyLock<Vec<[f64; K0_ORDER]>> = LazyLock::new(|| {
    let row = |i: i32| {
        // The halves of an octave are equal in x.
        let octave = 2f64.powi(LOW + i / 2);
        let (from, width) = (octave * (1.0 + 0.5 * f64::from(i % 2)), 0.5 * octave);
        polynomials(|place| [k0(from + width * 0.5 * (1.0 + place))])[0]
    };
    (0..2 * (HIGH - LOW)).map(row).collect()
});

/// Orders, coefficients, width and number of the rows of [`J_ROWS`].
const J_COUNT: usize = 8;
const J_ORDER: usize = 9;
const J_WIDTH: f64 = 0.5;
const J_NUMBER: usize = 48;

/// J0, J1, J3, and on in odd orders.
static J_ROWS: LazyLock<Vec<[[f64; J_ORDER]; J_COUNT]>> = LazyLock::new(|| {
    let row = |i: usize| {
        polynomials(|place| {
            let mut values = [0.0; J_COUNT];
            let s = J_WIDTH * (i as f64 + 0.5 * (1.0 + place));
            values[0] = bessel_j_odd(s, &mut values[1..]);
            values
        })
    };
    (0..J_NUMBER).map(row).collect()
});

/// Polynomials of `N` coefficients through C functions at the Chebyshev nodes.
fn polynomials<const N: usize, const C: usize>(
    functions: impl Fn(f64) -> [f64; C],
) -> [[f64; N]; C] {
    let values: [[f64; C]; N] = std::array::from_fn(|j| functions(chebyshev_node(N, j)));
    let inverse = to_powers::<N>();
    std::array::from_fn(|c| {
        std::array::from_fn(|power| (0..N).map(|j| inverse[(power, j)] * values[j][c]).sum())
    })
}

/// Matrix from values at the `N` Chebyshev nodes to coefficients of powers; it is well conditioned
/// for so few nodes.
pub(super) fn to_powers<const N: usize>() -> SMatrix<f64, N, N> {
    let powers = SMatrix::<f64, N, N>::from_fn(|j, power| chebyshev_node(N, j).powi(power as i32));
    powers.try_inverse().expect("distinct nodes")
}

/// J1(s), J3(s), ..., of the first `out.len()` odd orders, s >= 0; returns J0(s). Absolute error
/// below 1e-12 besides that of `bessel_j_odd`.
pub fn tabulated_j_odd(s: f64, out: &mut [f64]) -> f64 {
    let around = s / J_WIDTH;
    match J_ROWS.get(around as usize) {
        // Small arguments keep their relative accuracy.
        Some(row) if out.len() < J_COUNT && s >= J_WIDTH => {
            let place = 2.0 * (around - around.floor()) - 1.0;
            let at = |row: &[f64; J_ORDER]| row.iter().rev().fold(0.0, |sum, c| sum * place + c);
            out.iter_mut().zip(&row[1..]).for_each(|(o, row)| *o = at(row));
            at(&row[0])
        }
        _ => bessel_j_odd(s, out),
    }
}

/// K0(`k` |u|) for all offsets u, none of them 0, into `out`; zero beyond `reach`. A table covers
/// the range that contacts use most; absolute error below 1e-10.
pub fn k0_of_all(k: f64, offsets: &[f64], reach: f64, out: &mut Vec<f64>) {
    out.resize(offsets.len(), 0.0);
    look_up(&K0_ROWS, k, offsets, reach, out);
}

/// [`k0_of_all`], compiled for the processor's vector units.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn look_up(rows: &[[f64; K0_ORDER]], k: f64, offsets: &[f64], reach: f64, out: &mut [f64]) {
    const MANTISSA: u32 = 52;
    const ONE: u64 = 1023 << MANTISSA;
    let times = |a: f64, b: f64, c: f64| -> f64 {
        if target_cfg_f!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
    };
    for (value, u) in out.iter_mut().zip(offsets) {
        let x = k * u.abs();
        let bits = x.to_bits();
        // The half of an octave is the first digit of the mantissa; the rest is the position.
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

    #[test]
    fn table_of_j_equals_it() {
        let mut worst: f64 = 0.0;
        for count in [1, 4, J_COUNT - 1, J_COUNT, 12] {
            for i in 0..4000 {
                let s = 0.008 * f64::from(i);
                let (mut got, mut want) = (vec![0.0; count], vec![0.0; count]);
                worst =
                    worst.max((tabulated_j_odd(s, &mut got) - bessel_j_odd(s, &mut want)).abs());
                for (got, want) in got.iter().zip(&want) {
                    worst = worst.max((got - want).abs());
                }
            }
        }
        assert!(worst < 2e-12, "{worst:e}");
    }
}
