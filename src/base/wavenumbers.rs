//! Wavenumbers across the contact, on two levels.

use super::Panels;
use std::f64::consts::PI;
use std::ops::Range;

/// Number of coarse nodes in the interpolation to a fine node, from its panel and its neighbours.
const WIDTH: usize = 5;

/// Part of the largest wavenumber from which on waves fade, by a squared cosine, to nothing at the
/// largest one. What an abrupt end leaves out oscillates across the whole contact and has either
/// sign: next to the line's end, where nodes are closer together than the shortest waves are long,
/// it would be as large as all that tells them apart.
const FADES: f64 = 0.7;

/// The part of a wave that counts, by its wavenumber as a part of the largest one.
fn part(share: f64) -> f64 {
    let faded = ((share - FADES) / (1.0 - FADES)).max(0.0);
    (0.5 * PI * faded).cos().powi(2)
}

/// Quadrature of a product over all wavenumbers; beyond the largest one it is negligible. One
/// factor varies slowly and is costly; it is computed at the coarse nodes. The other, the transform
/// of the contact pressure, oscillates with the contact's width and is cheap; it is evaluated at
/// the fine nodes.
///
/// Between the coarse nodes the slow factor is a polynomial in ln k: the effect of a load at a
/// distance d depends on k d, so it varies at the same rate in every decade, for every d.
#[derive(Debug, Clone, PartialEq)]
pub struct Wavenumbers {
    coarse: Panels,
    fine: Panels,
    /// For each fine node: the first coarse node of its interpolation, and the position in `basis`
    /// of the weights of this node and those that follow.
    shares: Vec<(usize, Range<usize>)>,
    basis: Vec<f64>,
    /// The weights of the fine nodes.
    weights: Vec<f64>,
}

impl Wavenumbers {
    /// Nodes of `coarse`. For the fine nodes its panels are divided into equal parts no wider than
    /// `widest`; an undivided panel has the same nodes on both levels.
    pub fn new(coarse: Panels, widest: f64) -> Self {
        let order = coarse.order();
        let mut breaks = vec![coarse.breaks()[0]];
        let mut panels = Vec::new();
        for panel in 0..coarse.panel_count() {
            let [a, b] = coarse.panel(panel);
            let parts = ((b - a) / widest).ceil().max(1.0) as usize;
            breaks.extend((1..parts).map(|i| a + (b - a) * i as f64 / parts as f64));
            breaks.push(b);
            panels.extend(std::iter::repeat_n(panel, parts * order));
        }
        let fine = Panels::new(breaks, order);
        let places: Vec<f64> = coarse.nodes().iter().map(|k| k.ln()).collect();
        let width = order.max(WIDTH).min(places.len());
        let mut shares = Vec::with_capacity(fine.len());
        let mut basis = Vec::with_capacity(width * fine.len());
        for (&k, panel) in fine.nodes().iter().zip(panels) {
            let start = basis.len();
            // Towards k = 0 there are no further coarse nodes, and the slow factor stays finite.
            let first = if panel == 0 {
                basis.extend(coarse.polynomials(panel, k));
                0
            } else {
                let place = k.ln();
                let first = around(&places, place, width);
                basis.extend(polynomials(&places[first..first + width], place));
                first
            };
            shares.push((first, start..basis.len()));
        }
        let weights =
            fine.nodes().iter().zip(fine.weights()).map(|(k, w)| w * part(k / fine.end()));
        let weights = weights.collect();
        Self { coarse, fine, shares, basis, weights }
    }

    /// The same coarse nodes, with fine nodes that also resolve an `oscillation` cos(k x) up to
    /// that x.
    pub fn resolving(&self, oscillation: f64) -> Self {
        let widest = (0..self.fine.panel_count())
            .map(|i| self.fine.panel(i)[1] - self.fine.panel(i)[0])
            .fold(0.0, f64::max);
        // Gauss's rule of n nodes integrates cos(w t) over [-1, 1] well for w up to about n - 1.
        let wanted = 2.0 * (self.coarse.order() as f64 - 1.0).max(1.0) / oscillation;
        Self::new(self.coarse.clone(), widest.min(wanted))
    }

    /// The nodes of the slow factor.
    pub fn coarse(&self) -> &Panels {
        &self.coarse
    }

    /// The nodes of the oscillating factor.
    pub fn fine(&self) -> &Panels {
        &self.fine
    }

    /// The weights of the fine nodes: Gauss's, which fade towards the largest one.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The interpolation from the coarse nodes to a fine node: the first coarse node, and the
    /// weights of this node and those that follow.
    pub fn interpolation(&self, fine: usize) -> (usize, &[f64]) {
        let (first, basis) = &self.shares[fine];
        (*first, &self.basis[basis.clone()])
    }

    /// Integrals of the interpolation weights of the coarse nodes times an oscillating function.
    /// `values` holds the function at `columns` places for each fine node, one fine node after the
    /// other; the result has the same form for the coarse nodes. The integral of the product with a
    /// slow factor is the sum over the coarse nodes of the factor times these.
    pub fn moments(&self, values: &[f64], columns: usize) -> Vec<f64> {
        let mut moments = vec![0.0; self.coarse.len() * columns];
        for (node, (from, weight)) in values.chunks_exact(columns).zip(&self.weights).enumerate() {
            let (first, shares) = self.interpolation(node);
            let into = moments[first * columns..].chunks_exact_mut(columns);
            for (into, share) in into.zip(shares) {
                into.iter_mut().zip(from).for_each(|(m, v)| *m += weight * share * v);
            }
        }
        moments
    }
}

/// The first of `width` consecutive ones of the ascending `places`, with equally many on either
/// side of `place`; an odd one is on the nearer side.
fn around(places: &[f64], place: f64, width: usize) -> usize {
    let above = places.partition_point(|p| *p <= place);
    let nearer = |&p: &f64| above == 0 || p - place < place - places[above - 1];
    let odd = width % 2 == 1 && places.get(above).is_some_and(nearer);
    (above + usize::from(odd)).saturating_sub(width.div_ceil(2)).min(places.len() - width)
}

/// Values at `x` of the Lagrange polynomials of `nodes`.
fn polynomials(nodes: &[f64], x: f64) -> impl Iterator<Item = f64> {
    (0..nodes.len()).map(move |i| {
        let others = nodes.iter().enumerate().filter(|(j, _)| *j != i);
        others.map(|(_, node)| (x - node) / (nodes[i] - node)).product()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_slow_and_oscillating_factors_are_integrated() {
        let numbers = Wavenumbers::new(Panels::new(vec![0.0, 1.0, 2.5, 6.0, 16.0], 6), 1.5);
        let fine = numbers.fine();
        // int_0^inf e^(-3k/2) cos(3 k) dk, and with sin.
        let values: Vec<f64> =
            fine.nodes().iter().flat_map(|k| [(3.0 * k).cos(), (3.0 * k).sin()]).collect();
        let moments = numbers.moments(&values, 2);
        let mut got = [0.0; 2];
        for (k, m) in numbers.coarse().nodes().iter().zip(moments.chunks(2)) {
            (0..2).for_each(|i| got[i] += (-1.5 * k).exp() * m[i]);
        }
        let exact = [1.5, 3.0].map(|part| part / (1.5 * 1.5 + 3.0 * 3.0));
        for i in 0..2 {
            assert!((got[i] - exact[i]).abs() < 2e-6, "{got:?} {exact:?}");
        }
        let (first, weights) = numbers.interpolation(0);
        assert!(first == 0 && weights[0] == 1.0);
        let last = fine.len() - 1;
        let (first, weights) = numbers.interpolation(last);
        let sum: f64 =
            weights.iter().zip(&numbers.coarse().nodes()[first..]).map(|(w, k)| w * k.ln()).sum();
        assert!((sum - fine.nodes()[last].ln()).abs() < 1e-12);
    }

    #[test]
    fn an_end_of_slowly_decaying_waves_leaves_little_out() {
        let numbers = Wavenumbers::new(Panels::new(vec![0.0, 1.0, 3.0, 9.0, 27.0], 8), 2.0);
        let (k, weights) = (numbers.fine().nodes(), numbers.weights());
        let wave = |k: f64| (3.0 * k).cos() / (1.0 + k);
        let faded: f64 = k.iter().zip(weights).map(|(k, w)| w * wave(*k)).sum();
        let cut: f64 = k.iter().zip(numbers.fine().weights()).map(|(k, w)| w * wave(*k)).sum();
        // int_0^inf: g(3) of Abramowitz and Stegun (1964), 5.2.13.
        let exact = 0.079_221_5;
        assert!((faded - exact).abs() < 1e-4 && (cut - exact).abs() > 1e-3, "{faded} {cut}");
    }
}
