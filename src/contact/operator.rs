//! The compliance as an operator, from pressure to displacement.

use super::solution::ContactSolution;
use crate::base::{Panels, Wavenumbers};
use crate::kernels::strip;
use multiversion::multiversion;
use nalgebra::DMatrix;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// The elastic response of both bodies together.
pub trait Operator {
    /// The representation of the contact pressure.
    type Pressure;

    /// Surface displacements of both bodies together (C^2 / (2 R)) caused by `pressure` at the
    /// nodes along the line: a row for each of `places`, which are distances from x = 0 in
    /// half-widths of each node.
    fn displacements(&self, pressure: &Self::Pressure, places: &[f64]) -> Vec<Vec<f64>>;
}

/// The compliance of both bodies together, one matrix per wavenumber.
#[derive(Debug, Clone)]
pub struct Compliance<'a> {
    /// Wavenumbers > 0 and their quadrature over (0, infinity).
    pub wavenumbers: &'a Wavenumbers,
    /// C(k) at the coarse wavenumbers: displacement at the axis's nodes per pressure at the nodes;
    /// it tends to 2 pi / k times the identity for large k.
    pub matrices: &'a [DMatrix<f64>],
}

/// [`Compliance`] at the nodes of an axis, split into the plane, screened part in closed form and
/// the remainder at all fine wavenumbers.
pub struct LineOperator<'a> {
    /// The compliance.
    pub compliance: &'a Compliance<'a>,
    /// Axis along the contact.
    pub axis: &'a Panels,
    remainders: Remainders,
}

/// Entries of the compliance that are interpolated side by side.
const SIDE: usize = 8;

/// Distance at which the logarithmic kernel of the local, plane part is screened, so that the
/// remainder for the quadrature over wavenumbers is finite at k = 0 and decays quickly.
const SCREEN: f64 = 2.0;

/// Points of the Gauss-Chebyshev rule for the screened part, smooth over the contact.
const SCREEN_POINTS: usize = 12;

/// The plane, screened part of C(k), on its diagonal.
pub(super) fn plane(k: f64) -> f64 {
    -2.0 * PI / k * (-k * SCREEN).exp_m1()
}

impl<'a> LineOperator<'a> {
    /// The operator on the nodes of `axis`; `negligible` is the largest displacement that one entry
    /// neglects in a sum over `LineOperator::count` wavenumbers.
    pub fn new(compliance: &'a Compliance<'a>, axis: &'a Panels, negligible: f64) -> Self {
        Self { compliance, axis, remainders: Remainders::new(compliance, axis.len(), negligible) }
    }

    /// C(k) less its [`plane`] part, from node `j` to node `i`, at all fine wavenumbers.
    pub(super) fn entries(&self, i: usize, j: usize) -> &[f64] {
        let (all, at) = (self.remainders.wavenumbers, j * self.axis.len() + i);
        &self.remainders.entries[at * all..(at + 1) * all]
    }

    /// Number of leading wavenumbers of [`LineOperator::entries`] that are not negligible: short
    /// waves act only at their own node and near the line's end.
    pub(super) fn count(&self, i: usize, j: usize) -> usize {
        self.remainders.counts[j * self.axis.len() + i]
    }
}

impl Operator for LineOperator<'_> {
    type Pressure = ContactSolution;

    /// Sums all wavenumbers, because the check includes what the solver neglects.
    fn displacements(&self, pressure: &ContactSolution, places: &[f64]) -> Vec<Vec<f64>> {
        let nodes = self.axis.len();
        let mut rows = vec![vec![0.0; nodes]; places.len()];
        let fine = self.compliance.wavenumbers.fine();
        // All wavenumbers of each node.
        let transforms: Vec<_> = fine.iter().map(|k| pressure.transform(*k)).collect();
        let transforms: Vec<Vec<f64>> =
            (0..nodes).map(|j| transforms.iter().map(|t| t[j]).collect()).collect();
        let mut amplitudes = vec![0.0; fine.len()];
        let mut modes = Vec::new();
        for (i, &a) in pressure.half_widths.iter().enumerate() {
            amplitudes.fill(0.0);
            for (j, transforms) in transforms.iter().enumerate() {
                let caused = self.entries(i, j).iter().zip(transforms).map(|(e, t)| e * t);
                amplitudes.iter_mut().zip(caused).for_each(|(sum, caused)| *sum += caused);
            }
            let c = &pressure.coefficients[i];
            for (row, &t) in rows.iter_mut().zip(places) {
                let waves = fine.iter().zip(self.compliance.wavenumbers.weights()).zip(&amplitudes);
                let waves = waves.map(|((k, w), s)| w / (PI * PI) * s * (k * t * a).cos());
                row[i] = waves.sum();
                modes.resize(c.len(), 0.0);
                strip::logarithmic(a, t, &mut modes);
                row[i] += 2.0 / PI * modes.iter().zip(c).map(|(l, c)| l * c).sum::<f64>();
                for ([cos, sin, _], weight) in screened(a, t) {
                    row[i] += weight * sin * strip::pressure(1.0, c, cos);
                }
            }
        }
        rows
    }
}

/// C(k) at the fine wavenumbers, less its [`plane`] part.
struct Remainders {
    /// All wavenumbers, for each row of each column.
    entries: Vec<f64>,
    wavenumbers: usize,
    /// Number of wavenumbers that are not negligible, for each row of each column.
    counts: Vec<usize>,
}

impl Remainders {
    /// Interpolates the remainders from the coarse wavenumbers; `negligible` is the largest
    /// displacement that one entry neglects.
    fn new(compliance: &Compliance, nodes: usize, negligible: f64) -> Self {
        let numbers = compliance.wavenumbers;
        let coarse: Vec<_> = numbers
            .coarse()
            .nodes()
            .iter()
            .zip(compliance.matrices)
            .map(|(&k, c)| c - DMatrix::identity(nodes, nodes) * plane(k))
            .collect();
        let fine = numbers.fine();
        let shares: Vec<_> = (0..fine.len()).map(|i| numbers.interpolation(i)).collect();
        // The singular mode's transform, pi J0(k), decays most slowly.
        // What falls like a power of k leaves about k times its last value.
        let limit = |k: &f64| negligible * PI / (k * (0.8 / k.sqrt()).min(1.0));
        let limits: Vec<f64> = fine.iter().map(limit).collect();
        let all = fine.len();
        let mut entries = vec![0.0; nodes * nodes * all];
        let mut counts = vec![0; nodes * nodes];
        let mut own = vec![[0.0; SIDE]; coarse.len()];
        let chunks = entries.chunks_mut(SIDE * all).zip(counts.chunks_mut(SIDE));
        for (chunk, (entries, counts)) in chunks.enumerate() {
            let at = chunk * SIDE..chunk * SIDE + counts.len();
            for (own, matrix) in own.iter_mut().zip(&coarse) {
                own[..at.len()].copy_from_slice(&matrix.as_slice()[at.clone()]);
            }
            interpolate(&own, &shares, entries);
            for (count, entries) in counts.iter_mut().zip(entries.chunks_exact(all)) {
                let relevant = entries.iter().zip(&limits).rposition(|(e, limit)| e.abs() > *limit);
                *count = relevant.map_or(0, |last| last + 1);
            }
        }
        Self { entries, wavenumbers: all, counts }
    }
}

/// Interpolates up to [`SIDE`] functions from their values at the coarse wavenumbers: all fine
/// values of the first one, then those of the next.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn interpolate(coarse: &[[f64; SIDE]], shares: &[(usize, &[f64])], fine: &mut [f64]) {
    let all = shares.len();
    for (i, (first, weights)) in shares.iter().enumerate() {
        let mut sums = [0.0; SIDE];
        for (weight, values) in weights.iter().zip(&coarse[*first..]) {
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
        }
        fine[i..].iter_mut().step_by(all).zip(sums).for_each(|(fine, sum)| *fine = sum);
    }
}

/// Points x' = cos(f) of Gauss-Chebyshev's rule of the first kind: cos f, sin f and 2 cos 2 f.
pub(super) type ScreenPoint = [f64; 3];

static SCREEN_RULE: LazyLock<[ScreenPoint; SCREEN_POINTS]> = LazyLock::new(|| {
    std::array::from_fn(|q| {
        let angle = PI * (2 * q + 1) as f64 / (2 * SCREEN_POINTS) as f64;
        [angle.cos(), angle.sin(), 2.0 * (2.0 * angle).cos()]
    })
});

/// The screening of the plane part at x = `t` `half_width`, (1 / pi) int ln((x - x')^2 + d^2) p(x')
/// dx', by Gauss-Chebyshev: points of x' / `half_width`, and weights of p sin(f) there.
pub(super) fn screened(half_width: f64, t: f64) -> impl Iterator<Item = (ScreenPoint, f64)> {
    SCREEN_RULE.iter().map(move |point| {
        let offset = half_width * (t - point[0]);
        let kernel = 0.5 * (offset * offset + SCREEN * SCREEN).ln();
        (*point, 2.0 / PI * kernel * half_width * PI / SCREEN_POINTS as f64)
    })
}
