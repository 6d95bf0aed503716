//! The approach of the bodies, relative to points at a depth.

use super::operator::{Compliance, plane};
use crate::base::Panels;
use nalgebra::{DVector, Matrix3, Vector3};
use std::f64::consts::PI;

/// Wavenumber (1/C) below which a displacement at a depth is computed as its difference from that
/// of the surface.
const LONG: f64 = 0.6;

/// Wavenumber times half-length of the shorter body from which the displacements of bodies that end are accurate: the
/// equations of their faces are close to singular for longer waves.
const SHORT: f64 = 0.15;

/// What is known of the displacements by long waves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LongWaves {
    /// The wavenumber (1/C) times the mean displacement (C^2 / (2 R)) along the line, for vanishing wavenumbers.
    pub limit: f64,
    /// Half of the length of the shorter body (C).
    pub half: f64,
}

impl LongWaves {
    /// Those of bodies with these limits and half-lengths.
    pub fn of(bodies: impl Iterator<Item = (f64, f64)>) -> Self {
        bodies.fold(Self { limit: 0.0, half: f64::INFINITY }, |all, (limit, half)| Self {
            limit: all.limit + limit,
            half: all.half.min(half),
        })
    }
}

/// The mean displacement along the line that the load causes at any depth: with the kernel e^(-k depth) the logarithmic
/// growth of the displacement with the extent of the bodies cancels in the difference from the approach.
///
/// The error of the contact's few nodes for displacements like 1/k and ln k cancels too: below a
/// wavenumber the sum over the same nodes is taken, less the integral of the part that decays with
/// depth.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    fine: Panels,
    /// The mean displacement along the line of each fine wavenumber.
    means: Vec<f64>,
    /// Wavenumber below which the mean is a fit.
    short: f64,
    fit: Fit,
}

/// The mean displacement by long waves.
#[derive(Debug, Clone, PartialEq)]
enum Fit {
    /// alpha, beta, gamma of alpha / k + beta + gamma ln k, whatever the bodies' extent.
    Any(Vector3<f64>),
    /// alpha, beta, gamma of alpha / k + beta + gamma k, with the alpha of [`LongWaves`].
    Known([f64; 3]),
}

impl Reference {
    /// That of a load whose pressure has the `transform` at the nodes of the line, for any wavenumber; `weights` are
    /// those of the nodes' quadrature, `long` is what is known of long waves.
    pub fn new(
        compliance: &Compliance,
        weights: &[f64],
        long: Option<LongWaves>,
        transform: impl Fn(f64) -> DVector<f64>,
    ) -> Self {
        // The nodes crowd at the ends: a mean of equal shares would be one of the ends.
        let shares = DVector::from_column_slice(weights) / weights.iter().sum::<f64>();
        let wavenumbers = compliance.wavenumbers;
        let fine = wavenumbers.fine().clone();
        let numbers = fine.nodes();
        // The remainder beyond the plane, screened part is interpolated, as in the contact itself.
        let rests: Vec<DVector<f64>> = wavenumbers
            .coarse()
            .nodes()
            .iter()
            .zip(compliance.matrices)
            .map(|(&k, c)| c.tr_mul(&shares) - &shares * plane(k))
            .collect();
        let mean_at = |(i, &k): (usize, &f64)| -> f64 {
            let transform = transform(k);
            let (first, basis) = wavenumbers.interpolation(i);
            let rests = basis.iter().zip(&rests[first..]).map(|(w, rest)| w * rest.dot(&transform));
            plane(k) * transform.dot(&shares) + rests.sum::<f64>()
        };
        let means: Vec<f64> = numbers.iter().enumerate().map(mean_at).collect();
        let (short, fit) = match long {
            Some(LongWaves { limit, half }) => {
                let last = numbers.len() - 1;
                let near = numbers.partition_point(|k| k * half < SHORT).min(last - 1);
                let far = numbers.partition_point(|k| *k < 2.0 * numbers[near]).min(last);
                let rest = |i: usize| means[i] - limit / numbers[i];
                let slope = (rest(far) - rest(near)) / (numbers[far] - numbers[near]);
                let fit = [limit, rest(near) - slope * numbers[near], slope];
                (numbers[near], Fit::Known(fit))
            }
            None => {
                let ends = [0, fine.order() / 2, fine.order() - 1];
                let rows = ends.map(|i| [1.0 / numbers[i], 1.0, numbers[i].ln()]);
                let system = Matrix3::from_fn(|i, j| rows[i][j]);
                let fit = system.lu().solve(&Vector3::from(ends.map(|i| means[i])));
                (fine.breaks()[1], Fit::Any(fit.unwrap_or_default()))
            }
        };
        Self { fine, means, short, fit }
    }

    /// The displacement at `depth` (C), in units of C^2 / (2 R).
    pub fn at(&self, depth: f64) -> f64 {
        let numbers = self.fine.nodes();
        let top = self.fine.breaks().partition_point(|k| *k < LONG).min(self.fine.panel_count());
        let top = self.fine.breaks()[top];
        let below = numbers.partition_point(|k| *k < top);
        let own = fading_panels(depth, self.short, top);
        let faded: f64 = own
            .nodes()
            .iter()
            .zip(own.weights())
            .map(|(&k, w)| -(-k * depth).exp_m1() * w * self.mean(k))
            .sum();
        let terms = || numbers.iter().zip(self.fine.weights()).zip(&self.means);
        let long: f64 = terms().take(below).map(|((_, w), m)| w * m).sum();
        let short: f64 = terms().skip(below).map(|((k, w), m)| w * (-k * depth).exp() * m).sum();
        (long - faded + short) / (PI * PI)
    }

    /// Memory that it takes (bytes).
    pub fn bytes(&self) -> usize {
        // The nodes, their weights and their means.
        size_of::<Self>() + 3 * size_of::<f64>() * self.means.len()
    }

    /// The mean displacement of the wavenumber `k`.
    fn mean(&self, k: f64) -> f64 {
        let (numbers, means) = (self.fine.nodes(), &self.means);
        if k < self.short {
            return match &self.fit {
                Fit::Any(fit) => fit[0] / k + fit[1] + fit[2] * k.ln(),
                Fit::Known([limit, constant, slope]) => limit / k + constant + slope * k,
            };
        }
        // k times the mean is smooth in ln k: 2 pi / k for waves shorter than the line.
        let from = numbers.partition_point(|n| *n < k).saturating_sub(2).min(numbers.len() - 4);
        let at: [f64; 4] = std::array::from_fn(|i| numbers[from + i].ln());
        let term = |i: usize| -> f64 {
            let basis = (0..4).filter(|j| *j != i).map(|j| (k.ln() - at[j]) / (at[i] - at[j]));
            numbers[from + i] * means[from + i] * basis.product::<f64>()
        };
        (0..4).map(term).sum::<f64>() / k
    }
}

/// Panels that resolve e^(-k `depth`) and the decay of the mean up to the wavenumber `top`, with a
/// break at `first`, if that is less.
fn fading_panels(depth: f64, first: f64, top: f64) -> Panels {
    let first = first.min(top);
    let smallest = (1e-3 / depth).min(first);
    let steps = ((top / smallest).ln() / 1.1f64).ceil().max(1.0) as i32;
    let graded = |i| smallest * (top / smallest).powf(f64::from(i) / f64::from(steps));
    let mut breaks: Vec<f64> = std::iter::once(0.0).chain((0..=steps).map(graded)).collect();
    breaks.push(first);
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|a, b| (*a - *b).abs() <= 1e-9 * *a);
    Panels::new(breaks, 6)
}
