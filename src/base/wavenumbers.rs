//! Wavenumbers across the contact, on two levels.

use super::Panels;
use std::ops::Range;

/// Quadrature over the wavenumbers of a product: one factor varies slowly and is costly, and is
/// computed at the coarse nodes; the other, the transform of the contact pressure, oscillates with
/// the contact's width, is cheap, and is asked for at the fine nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Wavenumbers {
    coarse: Panels,
    fine: Panels,
    /// Of each coarse panel: its fine nodes.
    members: Vec<Range<usize>>,
    /// Lagrange polynomials of the coarse panel at each fine node, `order` a node.
    basis: Vec<f64>,
}

impl Wavenumbers {
    /// Nodes of `coarse`, whose panels are cut for the fine nodes into equal parts no wider than
    /// `widest`. A panel that needs no cut has the same nodes on both levels.
    pub fn new(coarse: Panels, widest: f64) -> Self {
        let order = coarse.order();
        let mut breaks = vec![coarse.breaks()[0]];
        let mut members = Vec::with_capacity(coarse.panel_count());
        for panel in 0..coarse.panel_count() {
            let [a, b] = coarse.panel(panel);
            let parts = ((b - a) / widest).ceil().max(1.0) as usize;
            let first = (breaks.len() - 1) * order;
            breaks.extend((1..parts).map(|i| a + (b - a) * i as f64 / parts as f64));
            breaks.push(b);
            members.push(first..(breaks.len() - 1) * order);
        }
        let fine = Panels::new(breaks, order);
        let mut basis = Vec::with_capacity(order * fine.len());
        for (panel, nodes) in members.iter().enumerate() {
            for node in nodes.clone() {
                basis.extend(coarse.polynomials(panel, fine.nodes()[node]));
            }
        }
        Self { coarse, fine, members, basis }
    }

    /// The same coarse nodes, with fine ones for an `oscillation` cos(k x) up to that x besides.
    pub fn resolving(&self, oscillation: f64) -> Self {
        let widest = (0..self.fine.panel_count())
            .map(|i| self.fine.panel(i)[1] - self.fine.panel(i)[0])
            .fold(0.0, f64::max);
        // Gauss's rule of n nodes integrates cos(w t) over [-1, 1] well for w up to about n - 1.
        let wanted = 2.0 * (self.coarse.order() as f64 - 1.0).max(1.0) / oscillation;
        Self::new(self.coarse.clone(), widest.min(wanted))
    }

    /// The nodes of what varies slowly.
    pub fn coarse(&self) -> &Panels {
        &self.coarse
    }

    /// The nodes of what oscillates.
    pub fn fine(&self) -> &Panels {
        &self.fine
    }

    /// What interpolates from the coarse nodes to a fine node: the first coarse node, and a weight
    /// for it and each of those that follow.
    pub fn interpolation(&self, fine: usize) -> (usize, &[f64]) {
        let order = self.coarse.order();
        let panel = self.members.partition_point(|m| m.end <= fine);
        (panel * order, &self.basis[fine * order..(fine + 1) * order])
    }

    /// The integrals of the coarse nodes' polynomials times an oscillating function: `values` holds
    /// at `columns` places each the function at the fine nodes, one fine node after the other; the result
    /// the same at the coarse nodes. The integral of the product with a slow factor is the sum over
    /// the coarse nodes of the factor times these.
    pub fn moments(&self, values: &[f64], columns: usize) -> Vec<f64> {
        let order = self.coarse.order();
        let mut moments = vec![0.0; self.coarse.len() * columns];
        for (panel, nodes) in self.members.iter().enumerate() {
            for node in nodes.clone() {
                let weight = self.fine.weights()[node];
                let from = &values[node * columns..(node + 1) * columns];
                for (i, basis) in self.basis[node * order..(node + 1) * order].iter().enumerate() {
                    let coarse = panel * order + i;
                    let into = &mut moments[coarse * columns..(coarse + 1) * columns];
                    into.iter_mut().zip(from).for_each(|(m, v)| *m += weight * basis * v);
                }
            }
        }
        moments
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_slow_and_oscillating_factors_are_integrated() {
        let numbers = Wavenumbers::new(Panels::new(vec![0.0, 1.0, 4.0, 16.0], 6), 1.5);
        let fine = numbers.fine();
        // int_0^16 e^(-k/8) cos(3 k) dk, and with sin.
        let values: Vec<f64> =
            fine.nodes().iter().flat_map(|k| [(3.0 * k).cos(), (3.0 * k).sin()]).collect();
        let moments = numbers.moments(&values, 2);
        let mut got = [0.0; 2];
        for (k, m) in numbers.coarse().nodes().iter().zip(moments.chunks(2)) {
            (0..2).for_each(|i| got[i] += (-k / 8.0).exp() * m[i]);
        }
        // (1 - e^(s T)) / -s with s = -1/8 + 3i.
        let (scale, r) = (1.0 / (1.0 / 64.0 + 9.0), (-2f64).exp());
        let (c, s) = (48f64.cos(), 48f64.sin());
        let exact = [
            scale * (0.125 + r * (3.0 * s - 0.125 * c)),
            scale * (3.0 - r * (3.0 * c + 0.125 * s)),
        ];
        for i in 0..2 {
            assert!((got[i] - exact[i]).abs() < 2e-6, "{got:?} {exact:?}");
        }
        let (first, weights) = numbers.interpolation(0);
        assert!(first == 0 && weights[0] == 1.0);
        let last = fine.len() - 1;
        let (first, weights) = numbers.interpolation(last);
        let sum: f64 =
            weights.iter().zip(&numbers.coarse().nodes()[first..]).map(|(w, k)| w * k).sum();
        assert!((sum - fine.nodes()[last]).abs() < 1e-12);
    }
}
