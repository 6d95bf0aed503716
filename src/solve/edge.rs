//! Strength of the contact pressure at the contact's end.
//!
//! [`crate::body::corner_exponent`] gives the law of the corner.

use super::solved_scene::SolvedScene;
use crate::base::BodyKind;
use nalgebra::{DMatrix, DVector, SVD};
use serde::{Deserialize, Serialize};

/// Range of distances from the end (C) for the fit of an unbounded pressure: farther away it is not
/// a power of the distance, and nearer it is not resolved.
pub const SINGULAR_RANGE: [f64; 2] = [0.02, 0.1];

/// The range for a finite pressure.
pub const FINITE_RANGE: [f64; 2] = [0.02, 0.15];

/// Points of a fit, equally spaced in the logarithm of the distance.
const POINTS: usize = 25;

/// The pressure p(x = 0) near the contact's end, s the distance from it in units of C; pressures in
/// units of p0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum EdgeStrength {
    /// p = `factor` s^-`exponent`: it grows without bound.
    Singular {
        /// Fitted exponent m.
        exponent: f64,
        /// Fitted factor K, the law's pressure at s = 1 (p0).
        factor: f64,
        /// The exponent of the corner itself, s -> 0.
        corner_exponent: f64,
        /// Range of s of the fit (C).
        range_c: [f64; 2],
        /// Largest deviation of p from the fit, relative to p.
        residual: f64,
    },
    /// p = `limit` + `log_slope` s ln(1/s) + `slope` s.
    Finite {
        /// Pressure at the end (p0).
        limit: f64,
        /// Factor of s ln(1/s) (p0/C).
        log_slope: f64,
        /// Factor of s (p0/C).
        slope: f64,
        /// Range of s of the fit (C).
        range_c: [f64; 2],
        /// Largest deviation of p from the fit (p0).
        residual: f64,
    },
    /// The contact ends before the bodies do, and p falls to zero.
    Zero {
        /// y of the contact's end (C).
        at_c: f64,
    },
}

/// The two ends of the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// At the larger y.
    Positive,
    /// At the smaller y.
    Negative,
}

impl Side {
    /// 1 or -1.
    fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
        }
    }

    /// The side's one of two ends that ascend.
    fn of<T: Copy>(self, ends: [T; 2]) -> T {
        match self {
            Self::Positive => ends[1],
            Self::Negative => ends[0],
        }
    }
}

/// The strength of one end of a solved scene; none if the model follows neither law: with images
/// weighted by psi > 1 in both bodies, the pressure at flush ends oscillates in ln s.
pub fn edge_strength(solved: &SolvedScene, side: Side) -> Option<EdgeStrength> {
    let scene = &solved.scene;
    if side.of(solved.open) {
        return Some(EdgeStrength::Zero { at_c: side.of(solved.ends()) });
    }
    let oscillates = |kind| scene.end(kind).image_weight.is_some_and(|psi| psi > 1.0);
    match side.of(scene.corner_exponents()) {
        Some(m) => Some(singular(solved, side, m, SINGULAR_RANGE)),
        None if BodyKind::ALL.into_iter().any(oscillates) => None,
        None => Some(finite(solved, side, FINITE_RANGE)),
    }
}

/// Distances of a fit, and the pressures there.
fn samples(solved: &SolvedScene, side: Side, [low, high]: [f64; 2]) -> Vec<(f64, f64)> {
    let end = side.of(solved.scene.overlap());
    (0..POINTS)
        .map(|i| {
            let s = low * (high / low).powf(i as f64 / (POINTS - 1) as f64);
            (s, solved.pressure.at(0.0, end - side.sign() * s))
        })
        .collect()
}

/// Least-squares fit of `values` by the functions whose values are the rows of `basis`.
fn least_squares<const N: usize>(basis: &[[f64; N]], values: &[f64]) -> [f64; N] {
    let matrix = DMatrix::from_fn(basis.len(), N, |i, j| basis[i][j]);
    let right = DVector::from_column_slice(values);
    let solution = SVD::new(matrix, true, true).solve(&right, 1e-12).expect("both factors");
    std::array::from_fn(|i| solution[i])
}

/// Fits K s^-m on a range of s (C); `corner_exponent` is passed through.
pub fn singular(
    solved: &SolvedScene,
    side: Side,
    corner_exponent: f64,
    range_c: [f64; 2],
) -> EdgeStrength {
    let samples = samples(solved, side, range_c);
    let basis: Vec<_> = samples.iter().map(|(s, _)| [1.0, -s.ln()]).collect();
    let values: Vec<f64> = samples.iter().map(|(_, p)| p.ln()).collect();
    let [log_factor, exponent] = least_squares(&basis, &values);
    let off = |(b, v): (&[f64; 2], &f64)| (v - log_factor - b[1] * exponent).abs();
    let residual = basis.iter().zip(&values).map(off).fold(0.0, f64::max);
    let factor = log_factor.exp();
    EdgeStrength::Singular { exponent, factor, corner_exponent, range_c, residual }
}

/// Fits limit + log_slope s ln(1/s) + slope s on a range of s (C).
pub fn finite(solved: &SolvedScene, side: Side, range_c: [f64; 2]) -> EdgeStrength {
    let samples = samples(solved, side, range_c);
    let basis: Vec<_> = samples.iter().map(|(s, _)| [1.0, -s * s.ln(), *s]).collect();
    let values: Vec<f64> = samples.iter().map(|(_, p)| *p).collect();
    let [limit, log_slope, slope] = least_squares(&basis, &values);
    let off = |(b, v): (&[f64; 3], &f64)| (v - limit - b[1] * log_slope - b[2] * slope).abs();
    let residual = basis.iter().zip(&values).map(off).fold(0.0, f64::max);
    EdgeStrength::Finite { limit, log_slope, slope, range_c, residual }
}
