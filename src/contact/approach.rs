//! The approach of the bodies, relative to points at a depth.

use super::operator::{Compliance, plane};
use crate::base::Panels;
use nalgebra::{DVector, Matrix3, Vector3};
use std::f64::consts::PI;

/// Wavenumber (1/C) below which a displacement at a depth is computed as its difference from that
/// of the surface.
const LONG: f64 = 0.6;

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
    /// alpha, beta, gamma of alpha / k + beta + gamma ln k below the first panel's end, whatever the bodies' extent.
    fit: Vector3<f64>,
}

impl Reference {
    /// That of a load whose pressure has the `transform` at the nodes, for any wavenumber.
    pub fn new(compliance: &Compliance, transform: impl Fn(f64) -> DVector<f64>) -> Self {
        let wavenumbers = compliance.wavenumbers;
        let fine = wavenumbers.fine().clone();
        let numbers = fine.nodes();
        // The remainder beyond the plane, screened part is interpolated, as in the contact itself.
        let rests: Vec<DVector<f64>> = wavenumbers
            .coarse()
            .nodes()
            .iter()
            .zip(compliance.matrices)
            .map(|(&k, c)| c.row_mean_tr().add_scalar(-plane(k) / c.nrows() as f64))
            .collect();
        let mean_at = |(i, &k): (usize, &f64)| -> f64 {
            let transform = transform(k);
            let (first, shares) = wavenumbers.interpolation(i);
            let rests =
                shares.iter().zip(&rests[first..]).map(|(w, rest)| w * rest.dot(&transform));
            plane(k) * transform.mean() + rests.sum::<f64>()
        };
        let means: Vec<f64> = numbers.iter().enumerate().map(mean_at).collect();
        let ends = [0, fine.order() / 2, fine.order() - 1];
        let rows = ends.map(|i| [1.0 / numbers[i], 1.0, numbers[i].ln()]);
        let system = Matrix3::from_fn(|i, j| rows[i][j]);
        let fit = system.lu().solve(&Vector3::from(ends.map(|i| means[i]))).unwrap_or_default();
        Self { fine, means, fit }
    }

    /// The displacement at `depth` (C), in units of C^2 / (2 R).
    pub fn at(&self, depth: f64) -> f64 {
        let numbers = self.fine.nodes();
        let first = self.fine.breaks()[1];
        let top = self.fine.breaks().partition_point(|k| *k < LONG).min(self.fine.panel_count());
        let top = self.fine.breaks()[top];
        let below = numbers.partition_point(|k| *k < top);
        let own = fading_panels(depth, first, top);
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
        let Self { fine, means, fit } = self;
        let numbers = fine.nodes();
        if k < fine.breaks()[1] {
            return fit[0] / k + fit[1] + fit[2] * k.ln();
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
/// break at `first`.
fn fading_panels(depth: f64, first: f64, top: f64) -> Panels {
    let smallest = (1e-3 / depth).min(first);
    let steps = ((top / smallest).ln() / 1.1f64).ceil().max(1.0) as i32;
    let graded = |i| smallest * (top / smallest).powf(f64::from(i) / f64::from(steps));
    let mut breaks: Vec<f64> = std::iter::once(0.0).chain((0..=steps).map(graded)).collect();
    breaks.push(first);
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|a, b| (*a - *b).abs() <= 1e-9 * *a);
    Panels::new(breaks, 6)
}
