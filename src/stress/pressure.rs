//! The contact pressure as a function of position.

use super::load::{Load, Traction};
use super::round::LocalContact;
use super::slow_change::SlowChange;
use crate::base::Panels;
use crate::kernels::strip;
use nalgebra::DMatrix;
use std::f64::consts::FRAC_PI_2;

/// The contact pressure as a function of position.
#[derive(Debug, Clone)]
pub struct Pressure {
    axis: Panels,
    /// Whether the axis holds one half of a contact that is symmetric in y.
    symmetric: bool,
    half_widths: Vec<f64>,
    coefficients: Vec<Vec<f64>>,
    /// The [`fading`] wavenumbers (1 / C).
    fading: Vec<f64>,
}

/// The load per length at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineLoad {
    /// The place (C).
    pub y: f64,
    /// Length that it stands for in the sum of the load (C).
    pub weight: f64,
    /// The load per length (C p0).
    pub load: f64,
    /// Half-width of the contact (C); zero without contact.
    pub half_width: f64,
}

/// Change of the phase of the pressure's transform over half a panel, per node, that a polynomial
/// through the nodes still follows; and the least wavenumber that is faded out, in lengths of the
/// panel.
const PHASE: f64 = 0.2;
const SHORTEST: f64 = 20.0;

/// A change of the half-width (C) over a panel that has no effect.
const LEVEL: f64 = 1e-9;

/// The length (C) over which changes along the line are taken.
const CHANGE: f64 = 2e-5;

/// Slopes of the half-width up to which a load changes slowly along the line, and from which on it
/// does not.
const SLOW: f64 = 0.15;
const FAST: f64 = 0.25;

/// The wavenumber at each node from which the pressure's transform is faded out.
///
/// Towards the contact's edge the transform turns by the phase k a(y). Where the half-width changes
/// over a panel, the polynomial through the nodes cannot follow it for short waves, and would make
/// loads that vary along the line from node to node. The field of such waves is the endless
/// contact's, which is known without them. At a panel's ends the wavenumber is the geometric mean
/// of both panels'.
fn fading(axis: &Panels, half_widths: &[f64]) -> Vec<f64> {
    let order = axis.order();
    let panels: Vec<f64> = (0..axis.panel_count())
        .map(|i| {
            let own = &half_widths[i * order..(i + 1) * order];
            let [low, high] = own
                .iter()
                .fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], a| [low.min(*a), high.max(*a)]);
            let [a, b] = axis.panel(i);
            (2.0 * PHASE * order as f64 / (high - low).max(LEVEL)).max(SHORTEST / (b - a)).ln()
        })
        .collect();
    let last = panels.len() - 1;
    let at = |j: usize| {
        let i = j / order;
        let [a, b] = axis.panel(i);
        let [from, to] = [i.saturating_sub(1), (i + 1).min(last)]
            .map(|beside| if beside == i { panels[i] } else { 0.5 * (panels[i] + panels[beside]) });
        (from + (to - from) * (axis.nodes()[j] - a) / (b - a)).exp()
    };
    (0..axis.len()).map(at).collect()
}

impl Pressure {
    /// The pressure from the half-widths and the coefficients of the modes at the nodes of `axis`;
    /// missing modes of a node are zero. The axis of a `symmetric` pressure holds its half at y >=
    /// 0.
    pub fn new(
        axis: Panels,
        symmetric: bool,
        half_widths: Vec<f64>,
        mut coefficients: Vec<Vec<f64>>,
    ) -> Self {
        let most = coefficients.iter().map(Vec::len).max().unwrap_or(0);
        coefficients.iter_mut().for_each(|c| c.resize(most, 0.0));
        let fading = fading(&axis, &half_widths);
        Self { axis, symmetric, half_widths, coefficients, fading }
    }

    /// The same pressure in units of length and of pressure that are 1 / `factor` of the present
    /// ones.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let scale = |values: &Vec<f64>| values.iter().map(|v| factor * v).collect();
        Self::new(
            self.axis.scaled(factor),
            self.symmetric,
            scale(&self.half_widths),
            self.coefficients.iter().map(scale).collect(),
        )
    }

    /// Axis along the contact.
    pub fn axis(&self) -> &Panels {
        &self.axis
    }

    /// Half-width and modes at node `j`.
    pub fn at_node(&self, j: usize) -> (f64, &[f64]) {
        (self.half_widths[j], &self.coefficients[j])
    }

    /// Half-width and modes at `y`; none outside the contact.
    pub fn modes(&self, y: f64) -> Option<(f64, Vec<f64>)> {
        let neighbours = self.neighbours(y);
        if neighbours.is_empty() {
            return None;
        }
        // Towards an open end half-widths fall like the root of the distance, their squares evenly;
        // the pressure falls with them, and their ratio is smooth.
        let between = self.axis.interpolation(self.on_axis(y));
        let square: f64 = between.map(|(j, w)| w * self.half_widths[j].powi(2)).sum();
        let half_width = square.max(0.0).sqrt();
        let mut coefficients = vec![0.0; self.coefficients[0].len()];
        for (j, w) in neighbours.into_iter().filter(|(j, _)| self.half_widths[*j] > 0.0) {
            let share = w * half_width / self.half_widths[j];
            for (sum, c) in coefficients.iter_mut().zip(&self.coefficients[j]) {
                *sum += share * c;
            }
        }
        Some((half_width, coefficients))
    }

    /// [`Pressure::modes`] where the contact has a width.
    fn in_contact(&self, y: f64) -> Option<(f64, Vec<f64>)> {
        self.modes(y).filter(|(half_width, _)| *half_width > 0.0)
    }

    /// Pressure at (`x`, `y`) (p0).
    pub fn at(&self, x: f64, y: f64) -> f64 {
        self.modes(y).map_or(0.0, |(a, c)| strip::pressure(a, &c, x).max(0.0))
    }

    /// The stresses `of` a plane contact with the half-width and the modes at `y`.
    ///
    /// Between nodes with different half-widths, polynomials through the stresses of the nodes
    /// would not follow the vertical tangent at the contact's edge. Next to a singular end they are
    /// what the rest of the field has as its load.
    fn plane(&self, y: f64, of: impl Fn(f64, &[f64]) -> [f64; 3]) -> [f64; 3] {
        let singular = self.axis.corner_of(self.axis.panel_of(self.on_axis(y))).is_some();
        if !singular {
            return self.in_contact(y).map_or([0.0; 3], |(a, c)| of(a, &c));
        }
        let mut sum = [0.0; 3];
        for (j, weight) in self.neighbours(y) {
            let own = of(self.half_widths[j], &self.coefficients[j]);
            sum.iter_mut().zip(own).for_each(|(sum, s)| *sum += weight * s);
        }
        sum
    }

    /// The load per length at node `j`.
    fn line_load(&self, j: usize) -> f64 {
        let (half_width, modes) = self.at_node(j);
        strip::cumulative(half_width, modes, half_width)
    }

    /// The load per length at every node.
    pub fn line_loads(&self) -> Vec<LineLoad> {
        let nodes = self.axis.nodes().iter().zip(self.axis.weights()).enumerate();
        let at = |(j, (&y, &weight))| {
            let (half_width, load) = (self.half_widths[j], self.line_load(j));
            LineLoad { y, weight, load, half_width: if load > 0.0 { half_width } else { 0.0 } }
        };
        nodes.map(at).collect()
    }

    /// The load per length along the whole contact, in ascending order of y.
    pub fn whole_line(&self) -> Vec<LineLoad> {
        let half = self.line_loads();
        if !self.symmetric {
            return half;
        }
        let mirrored = half.iter().rev().map(|line| LineLoad { y: -line.y, ..*line });
        mirrored.chain(half.iter().copied()).collect()
    }
}

impl Load for Pressure {
    fn axis(&self) -> &Panels {
        self.axis()
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        self.at(x, y)
    }

    fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    fn local_contact(&self, y: f64) -> LocalContact {
        match self.in_contact(y) {
            Some((half_width, modes)) => {
                let load = strip::cumulative(half_width, &modes, half_width);
                LocalContact::endless(half_width, load / (FRAC_PI_2 * half_width))
            }
            None => LocalContact::endless(0.0, 0.0),
        }
    }

    fn transforms(&self, k: &[f64]) -> DMatrix<f64> {
        let mut modes = vec![0.0; self.coefficients[0].len()];
        DMatrix::from_fn(self.axis.len(), k.len(), |j, i| {
            strip::transforms(self.half_widths[j], k[i], &mut modes);
            let sum: f64 = modes.iter().zip(&self.coefficients[j]).map(|(t, c)| t * c).sum();
            sum / (1.0 + (k[i] / self.fading[j]).powi(4))
        })
    }

    fn endless(&self, y: f64, x: f64, z: f64) -> [f64; 3] {
        self.plane(y, |a, c| strip::stress(a, c, x, z))
    }

    fn slow_change(&self, y: f64, k_max: f64) -> SlowChange {
        let place = self.on_axis(y);
        let order = self.axis.order();
        let mut change = SlowChange::default();
        for (panel, share) in self.axis.panels_at(place) {
            let own = &self.fading[panel * order..(panel + 1) * order];
            let least = own.iter().copied().fold(f64::INFINITY, f64::min);
            let faded = (k_max / least).log2().clamp(0.0, 1.0);
            // Towards a singular end slopes are steep, and those of what is interpolated are not
            // what waves have: half-widths are polynomials there, loads powers.
            if faded == 0.0 || self.axis.law_of(panel).is_some() {
                continue;
            }
            // At a break the polynomials of both sides differ, and their difference is no slope.
            let [from, to] = self.axis.panel(panel);
            let middle = place.min(to - CHANGE).max(from + CHANGE);
            let middle = if self.symmetric { middle.copysign(y) } else { middle };
            let sides = [middle + 0.5 * CHANGE, middle - 0.5 * CHANGE];
            let [Some((after, more)), Some((before, less))] = sides.map(|y| self.in_contact(y))
            else {
                continue;
            };
            let slow = (FAST - ((after - before) / CHANGE).abs()) / (FAST - SLOW);
            let factor = share * faded * slow.clamp(0.0, 1.0) / CHANGE;
            if factor > 0.0 {
                let mut load = 0.0;
                for (y, factor) in sides.into_iter().zip([factor, -factor]) {
                    for (j, weight) in self.neighbours(y) {
                        change.nodes.push((j, factor * weight));
                        load += factor * weight * self.line_load(j);
                    }
                }
                // The waves' load is interpolated between nodes, and that of the interpolated
                // half-width and modes has another slope, which long waves would show at any depth.
                let [ahead, behind] = [(after, &more), (before, &less)]
                    .map(|(a, modes)| strip::cumulative(a, modes, a));
                let both = ahead + behind;
                let rest = if both > 0.0 { (load / factor - ahead + behind) / both } else { 0.0 };
                let [ahead, behind] = [factor * (1.0 + rest), factor * (rest - 1.0)];
                change.contacts.extend([(ahead, after, more), (behind, before, less)]);
            }
        }
        change
    }
}

impl Traction for Pressure {
    fn endless_along(&self, y: f64, x: f64, z: f64) -> [f64; 3] {
        self.plane(y, |a, c| strip::stress_along(a, c, x, z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::{Corner, Growth};
    use std::f64::consts::PI;

    #[test]
    fn stresses_on_the_surface_are_those_of_the_local_pressure() {
        // Half-widths that fall along the line: x = 0.95 is inside the contact at some nodes of a
        // panel, not at others.
        let axis = Panels::new(vec![0.0, 3.0, 6.0], 5);
        let half_widths: Vec<f64> = axis.nodes().iter().map(|y| 1.05 - 0.031 * y).collect();
        let coefficients = half_widths.iter().map(|a| vec![*a, -0.02]).collect();
        let pressure = Pressure::new(axis, true, half_widths, coefficients);
        for i in 0..=60 {
            let y = 0.1 * f64::from(i);
            for x in [0.0, 0.6, 0.9, 0.95] {
                let [xx, zz, xz] = pressure.endless(y, x, 0.0);
                let inside = x < 1.05 - 0.031 * y;
                let p = if inside { pressure.at(x, y) } else { 0.0 };
                let off = (xx + p).abs().max((zz + p).abs()).max(xz.abs());
                assert!(off < 1e-12, "{x} {y}: {xx} {zz} {xz}, {p}");
            }
        }
        assert_eq!(pressure.endless(6.1, 0.0, 0.5), [0.0; 3]);
    }

    /// Under an ellipse the pressure is that between nodes, too, as close to the tip as they are
    /// and in the middle of a long panel; polynomials through the pressures at nodes miss it by
    /// 0.02.
    #[test]
    fn an_elliptical_pressure_is_that_between_nodes() {
        let axis = Panels::new(vec![0.0, 22.0, 32.0, 37.0, 40.0], 3);
        let ellipse = |y: f64| (1.0 - (y / 40.0).powi(2)).sqrt();
        let half_widths: Vec<f64> = axis.nodes().iter().map(|y| ellipse(*y)).collect();
        let coefficients = half_widths.iter().map(|a| vec![*a]).collect();
        let pressure = Pressure::new(axis, true, half_widths, coefficients);
        for i in 0..400 {
            let y = 0.1 * f64::from(i);
            for x in [0.0, 0.3, 0.7] {
                let want = (1.0 - x * x - (y / 40.0).powi(2)).max(0.0).sqrt();
                let got = pressure.at(x, y);
                assert!((got - want).abs() < 1e-6, "{x} {y}: {got}, {want}");
            }
        }
    }

    /// Changes along the line are slopes, at breaks the mean of those of both panels, which do not
    /// meet there; what hardly changes, or changes much, has no closed form.
    #[test]
    fn changes_along_the_line_are_slopes() {
        let axis = Panels::new(vec![0.0, 3.0, 6.0], 5);
        let of_slopes = |slopes: [f64; 2]| {
            let panel = |y: f64| usize::from(y >= 3.0);
            let half_width =
                |y: &f64| 1.6 + 1e-5 * panel(*y) as f64 - slopes[panel(*y)] * (y - 3.0);
            let half_widths: Vec<f64> = axis.nodes().iter().map(half_width).collect();
            let coefficients = half_widths.iter().map(|a| vec![*a]).collect();
            Pressure::new(axis.clone(), true, half_widths, coefficients)
        };
        let k_max = 1e3;
        let pressure = of_slopes([0.1, 0.05]);
        for (y, slope) in [(0.7, 0.1), (3.0, 0.075), (-3.0, 0.075), (4.1, 0.05), (-5.9999, 0.05)] {
            let change = pressure.slow_change(y, k_max);
            // The load is pi a^2 / 2, and at x = 0 the pressure is a.
            let a = 1.6 - slope * (f64::abs(y) - 3.0);
            let (load, [_, _, cosine]) = (change.load(), change.potentials(0.0, 0.0));
            assert!((load + PI * a * slope * y.signum()).abs() < 1e-4, "{y}: {load}");
            assert!((cosine + slope * y.signum()).abs() < 1e-6, "{y}: {cosine}");
            let node = |(j, weight): &(usize, f64)| weight * pressure.half_widths[*j];
            let sum: f64 = change.nodes.iter().map(node).sum();
            assert!((sum + slope * y.signum()).abs() < 1e-6, "{y}: {sum}");
            assert!(pressure.slow_change(y, 1.0).contacts.is_empty());
        }
        assert!(of_slopes([0.0; 2]).slow_change(1.0, k_max).contacts.is_empty());
        assert!(of_slopes([0.26; 2]).slow_change(1.0, k_max).contacts.is_empty());
        let half = of_slopes([0.2; 2]).slow_change(1.0, k_max);
        assert!((half.contacts[0].0 * CHANGE - 0.5).abs() < 1e-6, "{half:?}");
    }

    /// Between nodes the product of half-width and modes is not the load that waves interpolate;
    /// the closed form has the latter. Towards a singular end there is none.
    #[test]
    fn changes_along_the_line_have_the_load_of_the_waves() {
        let corner = Corner { at: 6.0, side: -1.0, growth: Growth::Power(0.2), reach: 1.0 };
        let axis = Panels::new(vec![0.0, 3.0, 5.2, 6.0], 4).with_corners(&[corner]);
        let half_width = |y: &f64| 1.6 - 0.05 * (2.0 * y).sin();
        let half_widths: Vec<f64> = axis.nodes().iter().map(half_width).collect();
        let coefficients = half_widths.iter().map(|a| vec![a.powi(3), -0.1]).collect();
        let pressure = Pressure::new(axis, true, half_widths, coefficients);
        for y in [-4.4, 0.3, 1.7, 3.0, 4.1] {
            let change = pressure.slow_change(y, 1e3);
            let own = |(j, weight): &(usize, f64)| weight * pressure.line_load(*j);
            let waves: f64 = change.nodes.iter().map(own).sum();
            assert!((change.load() - waves).abs() < 1e-9, "{y}: {} {waves}", change.load());
            assert!(waves.abs() > 1e-3);
        }
        assert!(pressure.slow_change(5.5, 1e3).contacts.is_empty());
    }
}
