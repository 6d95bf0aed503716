//! Wavenumbers across the contact, on two levels.

use super::{Panels, gauss_legendre};
use std::f64::consts::PI;
use std::ops::Range;

/// Number of coarse nodes in the interpolation to a fine node, from its panel and its neighbours.
const WIDTH: usize = 7;

/// Part of the largest wavenumber from which on waves fade, by a squared cosine, to nothing at the
/// largest one. What an abrupt end leaves out oscillates across the whole contact and has either
/// sign: next to the line's end, where nodes are closer together than the shortest waves are long,
/// it would be as large as all that tells them apart.
const FADES: f64 = 0.7;

/// How many fine nodes more a panel has than coarse ones, for the product with the transform; none
/// where that turns by no more than a part of the phase that the coarse nodes follow. There their
/// rule is exact for both, which interpolation is not.
const MORE: usize = 2;
const TURNS: f64 = 0.25;

/// Largest half-phase w, by the number of nodes, for which Gauss's rule integrates cos(w t) over
/// [-1, 1] within a thousandth. The more nodes a piece has, the fewer a radian takes: 1.2 with five
/// of them, 0.7 with sixteen.
const PHASES: [f64; 17] =
    [0.0, 0.0, 0.6, 1.6, 2.8, 4.2, 5.7, 7.2, 8.8, 10.5, 12.1, 13.8, 15.5, 17.2, 19.0, 20.8, 22.5];

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
    fine: Vec<f64>,
    /// The distance x up to which the fine nodes resolve cos(k x).
    across: f64,
    /// For each fine node: the first coarse node of its interpolation, and the position in `basis`
    /// of the weights of this node and those that follow.
    shares: Vec<(usize, Range<usize>)>,
    basis: Vec<f64>,
    /// The weights of the fine nodes.
    weights: Vec<f64>,
}

impl Wavenumbers {
    /// Nodes of `coarse`, and fine ones that integrate products with cos(k x) up to the distance
    /// `across` for x: a panel is divided into equal pieces with as many nodes each as follow that.
    /// Panels of long waves have the same nodes on both levels.
    pub fn new(coarse: Panels, across: f64) -> Self {
        let (mut fine, mut gauss, mut panels) = (Vec::new(), Vec::new(), Vec::new());
        for panel in 0..coarse.panel_count() {
            let [a, b] = coarse.panel(panel);
            let phase = 0.5 * (b - a) * across;
            let turns = phase > TURNS * PHASES[coarse.order().min(PHASES.len() - 1)];
            let least = coarse.order() + if turns { MORE } else { 0 };
            let pieces = (phase / PHASES[PHASES.len() - 1]).ceil().max(1.0);
            let follows = |most: &f64| *most >= phase / pieces;
            let wanted = PHASES.iter().position(follows).unwrap_or(PHASES.len() - 1);
            let (nodes, weights) = gauss_legendre(wanted.max(least));
            let half = 0.5 * (b - a) / pieces;
            for piece in 0..pieces as usize {
                let middle = a + (2 * piece + 1) as f64 * half;
                fine.extend(nodes.iter().map(|t| middle + half * t));
                gauss.extend(weights.iter().map(|w| half * w));
                panels.extend(std::iter::repeat_n(panel, nodes.len()));
            }
        }
        let places: Vec<f64> = coarse.nodes().iter().map(|k| k.ln()).collect();
        let width = coarse.order().max(WIDTH).min(places.len());
        let mut shares = Vec::with_capacity(fine.len());
        let mut basis = Vec::with_capacity(width * fine.len());
        for (&k, panel) in fine.iter().zip(panels) {
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
        let weights = fine.iter().zip(gauss).map(|(k, w)| w * part(k / coarse.end())).collect();
        Self { coarse, fine, across, shares, basis, weights }
    }

    /// The same coarse nodes, with fine nodes that also resolve cos(k x) up to that `x` times a
    /// transform that is 1 wide.
    pub fn resolving(&self, x: f64) -> Self {
        Self::new(self.coarse.clone(), self.across.max(x + 1.0))
    }

    /// The nodes of the slow factor.
    pub fn coarse(&self) -> &Panels {
        &self.coarse
    }

    /// The nodes of the oscillating factor.
    pub fn fine(&self) -> &[f64] {
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
        let numbers = Wavenumbers::new(Panels::new(vec![0.0, 1.0, 2.5, 6.0, 16.0], 6), 4.0);
        let fine = numbers.fine();
        // int_0^inf e^(-3k/2) cos(3 k) dk, and with sin.
        let values: Vec<f64> =
            fine.iter().flat_map(|k| [(3.0 * k).cos(), (3.0 * k).sin()]).collect();
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
        assert!(first == 0 && (weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        let last = fine.len() - 1;
        let (first, weights) = numbers.interpolation(last);
        let sum: f64 =
            weights.iter().zip(&numbers.coarse().nodes()[first..]).map(|(w, k)| w * k.ln()).sum();
        assert!((sum - fine[last].ln()).abs() < 1e-12);
    }

    #[test]
    fn long_waves_have_one_rule_for_both_factors() {
        let numbers = Wavenumbers::new(Panels::new(vec![0.0, 0.1, 0.5, 2.5], 5), 2.0);
        let coarse = numbers.coarse().nodes();
        let same = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-12;
        assert!(numbers.fine().iter().zip(coarse).take(10).all(same));
        assert!(numbers.fine().len() > coarse.len());
        for i in 0..10 {
            let (first, weights) = numbers.interpolation(i);
            for (j, weight) in weights.iter().enumerate() {
                let own = if first + j == i { 1.0 } else { 0.0 };
                assert!((weight - own).abs() < 1e-9, "{i} {j}: {weight}");
            }
        }
    }

    #[test]
    fn rules_follow_the_phases_that_they_are_said_to() {
        for (count, phase) in PHASES.iter().enumerate().skip(2) {
            let (nodes, weights) = gauss_legendre(count);
            let error = |w: f64| {
                let cosines = nodes.iter().zip(&weights).map(|(t, weight)| weight * (w * t).cos());
                (cosines.sum::<f64>() - 2.0 * w.sin() / w).abs()
            };
            let worst = (1..=100).map(|i| error(0.01 * f64::from(i) * phase)).fold(0.0, f64::max);
            assert!(worst < 1.1e-3 && error(phase + 0.2) > 1e-3, "{count}: {worst:e}");
        }
    }

    #[test]
    fn an_end_of_slowly_decaying_waves_leaves_little_out() {
        let numbers = Wavenumbers::new(Panels::new(vec![0.0, 1.0, 3.0, 9.0, 27.0], 8), 4.0);
        let (k, weights) = (numbers.fine(), numbers.weights());
        let wave = |k: f64| (3.0 * k).cos() / (1.0 + k);
        let faded: f64 = k.iter().zip(weights).map(|(k, w)| w * wave(*k)).sum();
        let whole = Panels::new((0..=9).map(|i| 3.0 * f64::from(i)).collect(), 16);
        let cut: f64 = whole.nodes().iter().zip(whole.weights()).map(|(k, w)| w * wave(*k)).sum();
        // int_0^inf: g(3) of Abramowitz and Stegun (1964), 5.2.13.
        let exact = 0.079_221_5;
        assert!((faded - exact).abs() < 1e-4 && (cut - exact).abs() > 1e-3, "{faded} {cut}");
    }
}
