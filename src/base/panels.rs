//! Graded axes: panels with Gauss-Legendre nodes, on which functions are piecewise polynomials.

use super::quadrature::{gauss_legendre, legendre};

/// An axis divided into panels with the same number of Gauss-Legendre nodes each.
///
/// A function on the axis is given by its values at the nodes. On each panel it is the
/// interpolating polynomial, without continuity between panels: a pressure may jump at the roller's
/// end, and a steep end needs small panels only there.
#[derive(Debug, Clone, PartialEq)]
pub struct Panels {
    breaks: Vec<f64>,
    order: usize,
    nodes: Vec<f64>,
    weights: Vec<f64>,
    unit_nodes: Vec<f64>,
    barycentric: Vec<f64>,
}

impl Panels {
    /// Panels between ascending `breaks` (at least two), with `order` >= 1 nodes each.
    pub fn new(breaks: Vec<f64>, order: usize) -> Self {
        assert!(breaks.len() >= 2 && breaks.windows(2).all(|b| b[0] < b[1]), "{breaks:?}");
        let (unit_nodes, unit_weights) = gauss_legendre(order);
        let mut nodes = Vec::with_capacity(order * (breaks.len() - 1));
        let mut weights = Vec::with_capacity(nodes.capacity());
        for b in breaks.windows(2) {
            let (mid, half) = (0.5 * (b[0] + b[1]), 0.5 * (b[1] - b[0]));
            nodes.extend(unit_nodes.iter().map(|t| mid + half * t));
            weights.extend(unit_weights.iter().map(|w| half * w));
        }
        // Barycentric weights of Gauss nodes: 1 / prod (t_i - t_j).
        let barycentric = (0..order)
            .map(|i| {
                let others = (0..order).filter(|&j| j != i);
                1.0 / others.map(|j| unit_nodes[i] - unit_nodes[j]).product::<f64>()
            })
            .collect();
        Self { breaks, order, nodes, weights, unit_nodes, barycentric }
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there are no nodes (never, by construction).
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Number of panels.
    pub fn panel_count(&self) -> usize {
        self.breaks.len() - 1
    }

    /// Nodes of one panel.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Nodes, ascending.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Quadrature weights; they sum to the axis's length.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Ends of panel `i`.
    pub fn panel(&self, i: usize) -> [f64; 2] {
        [self.breaks[i], self.breaks[i + 1]]
    }

    /// All panel ends, ascending.
    pub fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// The last panel's end.
    pub fn end(&self) -> f64 {
        self.breaks[self.breaks.len() - 1]
    }

    /// The panel that contains `x`, or the nearest one if `x` lies outside the axis.
    pub fn panel_of(&self, x: f64) -> usize {
        self.breaks[1..self.breaks.len() - 1].partition_point(|&b| b <= x)
    }

    /// The interpolation at `x`: the nodes of its panel, each with its weight (an extrapolation if
    /// `x` lies outside the axis).
    pub fn interpolation(&self, x: f64) -> impl Iterator<Item = (usize, f64)> {
        let panel = self.panel_of(x);
        (panel * self.order..).zip(self.polynomials(panel, x))
    }

    /// Values at `x` of the Lagrange polynomials of panel `i`, by the barycentric formula.
    pub fn polynomials(&self, i: usize, x: f64) -> impl Iterator<Item = f64> {
        let [a, b] = self.panel(i);
        let t = (2.0 * x - a - b) / (b - a);
        let hit = self.unit_nodes.contains(&t);
        let product: f64 = self.unit_nodes.iter().map(|u| t - u).product();
        self.unit_nodes.iter().zip(&self.barycentric).map(move |(u, c)| match hit {
            true => f64::from(u8::from(*u == t)),
            false => product * c / (t - u),
        })
    }

    /// Integrals of each Lagrange polynomial of panel `i` times cos(`wavenumber` x) over the panel,
    /// into `out` (length `order`); exact for any wavenumber.
    ///
    /// From the Legendre expansion of the Lagrange polynomials and
    /// int P_n(t) e^(i w t) dt = 2 i^n j_n(w) (Abramowitz and Stegun 1964, 10.1.14).
    pub fn cosine_moments(&self, i: usize, wavenumber: f64, out: &mut [f64]) {
        let [a, b] = self.panel(i);
        let (mid, half) = (0.5 * (a + b), 0.5 * (b - a));
        let bessel = spherical_bessel(self.order, wavenumber * half);
        let (sin, cos) = (wavenumber * mid).sin_cos();
        for (local, o) in out.iter_mut().enumerate() {
            let weight = self.weights[i * self.order + local];
            let mut sum = 0.0;
            for (n, j) in bessel.iter().enumerate() {
                let phase = [cos, -sin, -cos, sin][n % 4];
                let p = legendre(n, self.unit_nodes[local]).0;
                sum += (2 * n + 1) as f64 * p * j * phase;
            }
            *o = weight * sum;
        }
    }
}

/// Spherical Bessel functions j_0(x) to j_(n-1)(x), x >= 0: the power series for small x, where the
/// upward recurrence loses digits, otherwise the recurrence.
fn spherical_bessel(n: usize, x: f64) -> Vec<f64> {
    let mut out = vec![0.0; n];
    if x > n as f64 + 1.0 {
        let (sin, cos) = x.sin_cos();
        out[0] = sin / x;
        if n > 1 {
            out[1] = (out[0] - cos) / x;
        }
        for m in 2..n {
            out[m] = (2 * m - 1) as f64 / x * out[m - 1] - out[m - 2];
        }
        return out;
    }
    let mut lead = 1.0;
    for (m, o) in out.iter_mut().enumerate() {
        if m > 0 {
            lead *= x / (2 * m + 1) as f64;
        }
        let (mut term, mut sum) = (1.0, 1.0);
        for i in 1..60 {
            term *= -0.5 * x * x / (i as f64 * (2 * (m + i) + 1) as f64);
            sum += term;
            if term.abs() < 1e-17 * sum.abs() {
                break;
            }
        }
        *o = lead * sum;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_interpolated_and_integrated_exactly() {
        let axis = Panels::new(vec![0.0, 0.5, 2.0, 3.0], 4);
        let f = |x: f64| 1.0 - 2.0 * x + 0.5 * x.powi(3);
        let values: Vec<f64> = axis.nodes().iter().map(|&x| f(x)).collect();
        for x in [0.0, 0.2, 0.5, 1.7, 3.0, axis.nodes()[5]] {
            let got: f64 = axis.interpolation(x).map(|(node, w)| w * values[node]).sum();
            assert!((got - f(x)).abs() < 1e-13, "{x}: {got}");
        }
        let integral: f64 = axis.weights().iter().zip(&values).map(|(w, v)| w * v).sum();
        assert!((integral - (3.0 - 9.0 + 81.0 / 8.0)).abs() < 1e-12);
    }

    #[test]
    fn cosine_moments_equal_fine_quadrature() {
        let axis = Panels::new(vec![1.0, 4.0], 5);
        let fine = Panels::new((0..=200).map(|i| 1.0 + 0.015 * f64::from(i)).collect(), 6);
        for k in [0.0, 1e-3, 0.3, 2.0, 3.9, 4.1, 40.0] {
            let mut got = [0.0; 5];
            axis.cosine_moments(0, k, &mut got);
            let mut want = [0.0; 5];
            for (x, w) in fine.nodes().iter().zip(fine.weights()) {
                for (s, b) in want.iter_mut().zip(axis.polynomials(0, *x)) {
                    *s += w * b * (k * x).cos();
                }
            }
            for (g, w) in got.iter().zip(&want) {
                assert!((g - w).abs() < 1e-12, "k = {k}: {got:?} {want:?}");
            }
        }
    }
}
