//! Graded axes: panels with Gauss-Legendre nodes, on which functions are piecewise polynomials.

use super::quadrature::{crowded_legendre, gauss_legendre, legendre};
use std::ops::Range;

/// An axis divided into panels with the same number of Gauss-Legendre nodes each.
///
/// A function on the axis is given by its values at the nodes. On each panel it is the
/// interpolating polynomial, without continuity between panels: a pressure may jump at the roller's
/// end, and a steep end needs small panels only there. A load that grows without bound towards a
/// [`Corner`] does so like the corner's [`Growth`].
#[derive(Debug, Clone, PartialEq)]
pub struct Panels {
    breaks: Vec<f64>,
    order: usize,
    nodes: Vec<f64>,
    weights: Vec<f64>,
    unit_nodes: Vec<f64>,
    barycentric: Vec<f64>,
    corners: Vec<Corner>,
    /// The corner towards which the loads of each panel grow.
    laws: Vec<Option<Corner>>,
    /// The inverse of its power at the nodes.
    leveled: Vec<f64>,
    /// Its logarithm at the nodes, and how much of it a unit at each of them has; none without.
    logarithms: Vec<f64>,
    shares: Vec<f64>,
    /// A rule for integrals on (0, 1) of what is steep at 0.
    steep_rule: Vec<(f64, f64)>,
}

/// A place towards which the loads on an axis grow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// The place.
    pub at: f64,
    /// 1 if the loads are at larger coordinates, -1 if at smaller ones.
    pub side: f64,
    /// How they grow.
    pub growth: Growth,
    /// The distance up to which loads have this growth.
    pub reach: f64,
}

/// How loads grow towards a [`Corner`], at the distance s from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Growth {
    /// Like s^-m, with m in (0, 1): they are polynomials times this power.
    Power(f64),
    /// Like ln s, which stands in the place of the highest power of their polynomials.
    Logarithm,
}

/// The least distance from a corner, in the panel's lengths: loads are bounded there.
const NEAREST: f64 = 1e-9;

/// Distance, as a part of an axis's largest coordinate, that is rounding.
const ROUNDING: f64 = 1e-12;

/// Nodes beyond a panel's own, and the power of the map that crowds them, for integrals at a
/// corner.
const MORE_NODES: usize = 6;
const POWER: i32 = 4;

impl Corner {
    /// The exponent of a power, if that is how loads grow.
    pub fn exponent(&self) -> Option<f64> {
        match self.growth {
            Growth::Power(exponent) => Some(exponent),
            Growth::Logarithm => None,
        }
    }

    /// Whether the loads between `a` and `b` have the power.
    fn governs(&self, [a, b]: [f64; 2]) -> bool {
        let [near, far] = if self.side > 0.0 { [a, b] } else { [b, a] };
        // A panel may end just there, but for rounding.
        let reach = self.reach * (1.0 + 1e-9);
        self.side * (near - self.at) >= 0.0 && self.side * (far - self.at) <= reach
    }

    /// The power at `x`, in a panel of the given `length`; 1 where loads have none.
    fn power(&self, x: f64, length: f64) -> f64 {
        self.exponent().map_or(1.0, |exponent| self.distance(x, length).powf(-exponent))
    }

    /// The distance of `x`, in a panel of the given `length`.
    fn distance(&self, x: f64, length: f64) -> f64 {
        (x - self.at).abs().max(NEAREST * length)
    }
}

impl Panels {
    /// The same panels with loads that grow towards `corners`, at which panels end. The weights
    /// integrate these loads.
    #[must_use]
    pub fn with_corners(mut self, corners: &[Corner]) -> Self {
        self.corners = corners.to_vec();
        if !corners.is_empty() {
            self.steep_rule = crowded_legendre(self.order + MORE_NODES, POWER);
        }
        for panel in 0..self.panel_count() {
            let ends = self.panel(panel);
            let Some(law) = corners.iter().find(|c| c.governs(ends)) else { continue };
            self.laws[panel] = Some(*law);
            let own = panel * self.order..(panel + 1) * self.order;
            for (leveled, x) in self.leveled[own.clone()].iter_mut().zip(&self.nodes[own.clone()]) {
                *leveled = 1.0 / law.power(*x, ends[1] - ends[0]);
            }
            if self.logarithm_of(panel).is_some() {
                self.set_logarithm(law, own, ends[1] - ends[0]);
            }
            if self.corner_of(panel).is_some() {
                let mut moments = vec![0.0; self.order];
                self.integrate(panel, ends, |_| 1.0, &mut moments);
                self.weights[panel * self.order..][..self.order].copy_from_slice(&moments);
            }
        }
        self
    }

    /// Lets the loads at the nodes `own` of a panel of the given `length` have a logarithm. In
    /// theirs, less the polynomial through its values at the nodes, the highest power is to vanish.
    fn set_logarithm(&mut self, law: &Corner, own: Range<usize>, length: f64) {
        let highest = |values: &[f64]| -> f64 {
            values.iter().zip(&self.barycentric).map(|(value, c)| c * value).sum()
        };
        let logarithms: Vec<f64> =
            self.nodes[own.clone()].iter().map(|x| law.distance(*x, length).ln()).collect();
        let shares: Vec<f64> = self.barycentric.iter().map(|c| c / highest(&logarithms)).collect();
        self.logarithms.resize(self.nodes.len(), 0.0);
        self.shares.resize(self.nodes.len(), 0.0);
        self.logarithms[own.clone()].copy_from_slice(&logarithms);
        self.shares[own].copy_from_slice(&shares);
    }

    /// The corner towards which the loads of panel `i` have a logarithm, if any.
    fn logarithm_of(&self, i: usize) -> Option<&Corner> {
        let law = self.laws[i].as_ref()?;
        (law.growth == Growth::Logarithm && self.order > 1).then_some(law)
    }

    /// The corners towards which loads grow.
    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// The corner towards which the loads of panel `i` grow, if any.
    pub fn law_of(&self, i: usize) -> Option<Corner> {
        self.laws[i]
    }

    /// The corner at which panel `i` ends, if any.
    pub fn corner_of(&self, i: usize) -> Option<Corner> {
        self.laws[i].filter(|law| self.panel(i).contains(&law.at))
    }

    /// The integrals of each of the [`Panels::loads`] of panel `i` between two places of it; those
    /// of parts sum to the weights, but for rounding.
    pub fn integrals(&self, i: usize, part: [f64; 2]) -> Vec<f64> {
        let mut all = vec![0.0; self.order];
        if self.laws[i].is_some() {
            self.integrate(i, part, |_| 1.0, &mut all);
            return all;
        }
        let rule = Self::new(part.to_vec(), self.order);
        for (x, w) in rule.nodes.iter().zip(&rule.weights) {
            all.iter_mut().zip(self.polynomials(i, *x)).for_each(|(sum, own)| *sum += w * own);
        }
        all
    }

    /// The integrals of the loads of panel `i`, which have a power, times a `factor` over a part.
    fn integrate(&self, i: usize, [a, b]: [f64; 2], factor: impl Fn(f64) -> f64, out: &mut [f64]) {
        let [near, far] = if self.laws[i].is_some_and(|c| c.side < 0.0) { [b, a] } else { [a, b] };
        out.fill(0.0);
        for (t, w) in &self.steep_rule {
            let x = near + (far - near) * t;
            let weight = w * (b - a) * factor(x);
            out.iter_mut().zip(self.loads(i, x)).for_each(|(sum, own)| *sum += weight * own);
        }
    }

    /// Values at `x` of the loads of panel `i` that are 1 at one of its nodes and 0 at the others:
    /// its polynomials, times the power of a corner or beside its logarithm.
    pub fn loads(&self, i: usize, x: f64) -> impl Iterator<Item = f64> {
        let [a, b] = self.panel(i);
        let own = i * self.order..(i + 1) * self.order;
        let power = self.laws[i].map_or(1.0, |law| law.power(x, b - a));
        let leveled = &self.leveled[own.clone()];
        // The logarithm less the polynomial through its values at the nodes.
        let (rest, shares) = match self.logarithm_of(i) {
            None => (0.0, leveled),
            Some(law) => {
                let known = &self.logarithms[own.clone()];
                let between: f64 = self.polynomials(i, x).zip(known).map(|(p, l)| p * l).sum();
                (law.distance(x, b - a).ln() - between, &self.shares[own])
            }
        };
        let values = self.polynomials(i, x).zip(leveled).zip(shares);
        values.map(move |((value, leveled), share)| value * leveled * power + rest * share)
    }

    /// The load at `x` from those at the nodes of its panel, with weights; see
    /// [`Panels::interpolation`]. Nearer to a corner than the nodes are, a power is that of the
    /// outermost one. Beside the axis, but for rounding, there is no load and no node.
    pub fn load_interpolation(&self, x: f64) -> impl Iterator<Item = (usize, f64)> {
        let [first, end] = [self.breaks[0], self.end()];
        let rounding = self.rounding();
        let is_loaded = (first - rounding..=end + rounding).contains(&x);
        let panels = self.panels_at(x).filter(move |_| is_loaded);
        panels.flat_map(move |(panel, share)| {
            let own = &self.nodes[panel * self.order..(panel + 1) * self.order];
            let bounded = match self.corner_of(panel) {
                Some(Corner { growth: Growth::Logarithm, .. }) | None => x,
                Some(corner) if corner.at < own[0] => x.max(own[0]),
                Some(_) => x.min(own[self.order - 1]),
            };
            let loads = self.loads(panel, bounded).map(move |load| share * load);
            (panel * self.order..).zip(loads)
        })
    }

    /// The same axis in units of length that are 1 / `factor` of the present ones.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let breaks = self.breaks.iter().map(|x| factor * x).collect();
        let corner = |c: &Corner| Corner { at: factor * c.at, reach: factor * c.reach, ..*c };
        let corners: Vec<Corner> = self.corners.iter().map(corner).collect();
        Self::new(breaks, self.order).with_corners(&corners)
    }

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
        let laws = vec![None; breaks.len() - 1];
        let leveled = vec![1.0; nodes.len()];
        let corners = Vec::new();
        Self {
            breaks,
            order,
            nodes,
            weights,
            unit_nodes,
            barycentric,
            corners,
            laws,
            leveled,
            logarithms: Vec::new(),
            shares: Vec::new(),
            steep_rule: Vec::new(),
        }
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

    /// The panels that stand for `x`, with their shares: its own, and at a break, but for rounding,
    /// both alike. What an integral over the axis tends to there is the mean of both, too.
    pub fn panels_at(&self, x: f64) -> impl Iterator<Item = (usize, f64)> + use<> {
        let panel = self.panel_of(x);
        let rounding = self.rounding();
        let [starts, ends] = self.panel(panel).map(|end| (x - end).abs() <= rounding);
        let beside = match (starts, ends) {
            (true, _) => panel.checked_sub(1),
            (_, true) => Some(panel + 1).filter(|next| *next < self.panel_count()),
            _ => None,
        };
        let share = if beside.is_some() { 0.5 } else { 1.0 };
        [Some(panel), beside].into_iter().flatten().map(move |panel| (panel, share))
    }

    /// Distance that is rounding.
    pub fn rounding(&self) -> f64 {
        ROUNDING * self.breaks[0].abs().max(self.end().abs())
    }

    /// The interpolation at `x`: the nodes of its panel, each with its weight (an extrapolation if
    /// `x` lies outside the axis); at a break the mean of both panels' polynomials.
    pub fn interpolation(&self, x: f64) -> impl Iterator<Item = (usize, f64)> {
        self.panels_at(x).flat_map(move |(panel, share)| {
            let values = self.polynomials(panel, x).map(move |value| share * value);
            (panel * self.order..).zip(values)
        })
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

    /// Integrals of each of the [`Panels::loads`] of panel `i` times cos(`wavenumber` x) over the
    /// panel, into `out` (length `order`); exact for any wavenumber where they are polynomials, and
    /// for waves longer than the panel where they are not.
    ///
    /// From the Legendre expansion of the Lagrange polynomials and
    /// int P_n(t) e^(i w t) dt = 2 i^n j_n(w) (Abramowitz and Stegun 1964, 10.1.14).
    pub fn cosine_moments(&self, i: usize, wavenumber: f64, out: &mut [f64]) {
        if self.laws[i].is_some() {
            self.integrate(i, self.panel(i), |x| (wavenumber * x).cos(), out);
            return;
        }
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
    fn loads_have_a_logarithm_beside_polynomials() {
        let corner = Corner { at: 3.0, side: -1.0, growth: Growth::Logarithm, reach: 1.0 };
        for order in [2, 4, 7] {
            let breaks = vec![0.0, 2.0, 2.9, 3.0];
            let axis = Panels::new(breaks, order).with_corners(&[corner]);
            // Beside the logarithm the polynomials have a degree less.
            let g = |x: f64| if order > 2 { 1.5 - x + 0.3 * x.powi(order as i32 - 2) } else { 0.7 };
            let f = |x: f64| if x < 2.0 { g(x) } else { g(x) - 0.4 * (3.0 - x).ln() };
            let values: Vec<f64> = axis.nodes().iter().map(|x| f(*x)).collect();
            for x in [0.7, 2.01, 2.6, 2.95, 2.9999] {
                let got: f64 = axis.load_interpolation(x).map(|(node, w)| w * values[node]).sum();
                assert!((got - f(x)).abs() < 1e-9, "{order} {x}: {got} {}", f(x));
            }
            // int_2.9^3 -0.4 ln (3 - x) dx, and the polynomials by Gauss's rule.
            let (nodes, weights) = gauss_legendre(order);
            let rule = nodes.iter().zip(&weights);
            let smooth: f64 = rule.map(|(t, w)| 0.05 * w * g(2.95 + 0.05 * t)).sum();
            let exact = smooth - 0.4 * 0.1 * (0.1f64.ln() - 1.0);
            let own = 2 * order..3 * order;
            let got: f64 = own.map(|j| axis.weights()[j] * values[j]).sum();
            assert!((got - exact).abs() < 1e-6, "{order}: {got} {exact}");
        }
    }

    #[test]
    fn loads_grow_towards_corners_and_are_integrated() {
        let corner = |at, side| Corner { at, side, growth: Growth::Power(0.3), reach: 1.2 };
        let corners = [corner(-1.0, 1.0), corner(3.0, -1.0)];
        let breaks = vec![-1.0, -0.9, -0.4, 0.0, 1.9, 2.5, 2.9, 3.0];
        let axis = Panels::new(breaks, 4).with_corners(&corners);
        // (x + 1)^-0.3 (2 - x + x^3) beside the first corner, the same from the second one.
        let g = |x: f64| 2.0 - x + x.powi(3);
        let f = |x: f64| match x {
            _ if x < 0.0 => (x + 1.0).powf(-0.3) * g(x),
            _ if x < 1.9 => g(x),
            _ => (3.0 - x).powf(-0.3) * g(x),
        };
        let values: Vec<f64> = axis.nodes().iter().map(|x| f(*x)).collect();
        for x in [-0.98, -0.7, 0.3, 2.0, 2.7, 2.99] {
            let got: f64 = axis.load_interpolation(x).map(|(node, w)| w * values[node]).sum();
            assert!((got - f(x)).abs() < 1e-10 * f(x).abs(), "{x}: {got} {}", f(x));
        }
        // Where panels meet it is the mean of both.
        let mean: f64 = axis.load_interpolation(1.9).map(|(node, w)| w * values[node]).sum();
        let sides = 0.5 * (g(1.9) + 1.1f64.powf(-0.3) * g(1.9));
        assert!((mean - sides).abs() < 1e-10 * sides, "{mean} {sides}");
        // At the corner itself it is bounded.
        let end: f64 = axis.load_interpolation(3.0).map(|(node, w)| w * values[node]).sum();
        assert!((end - values[values.len() - 1]).abs() < 1e-10 * end, "{end}");
        // Beside the axis nothing acts, but for rounding.
        assert_eq!([-1.1, 3.1, 40.0].map(|x| axis.load_interpolation(x).count()), [0; 3]);
        assert_eq!([-1.0 - 1e-13, 3.0 + 1e-13].map(|x| axis.load_interpolation(x).count()), [4; 2]);
        let fine = |from: f64, to: f64| {
            let (nodes, weights) = gauss_legendre(40);
            let own = nodes.iter().zip(&weights).map(|(t, w)| (0.5 * (1.0 + t), 0.5 * w));
            // Crowded at both ends.
            own.map(|(t, w)| {
                let (s, ds) = (t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t));
                let (u, du) = (s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s));
                let x = from + (to - from) * u;
                w * ds * du * (to - from) * f(x)
            })
            .sum::<f64>()
        };
        for panel in [0, 6] {
            let [a, b] = axis.panel(panel);
            let own = panel * 4..panel * 4 + 4;
            let got: f64 = own.map(|j| axis.weights()[j] * values[j]).sum();
            assert!((got - fine(a, b)).abs() < 1e-6 * got.abs(), "{got} {}", fine(a, b));
        }
        // Lengths twice as long.
        let (double, n) = (axis.scaled(2.0), axis.len());
        assert!((double.weights()[n - 1] - 2.0 * axis.weights()[n - 1]).abs() < 1e-12);
        assert_eq!(double.corner_of(6).map(|c| c.at), Some(6.0));
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
