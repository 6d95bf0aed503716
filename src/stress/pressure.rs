//! The contact pressure as a function of position.

use super::load::{Load, Traction};
use super::round::LocalContact;
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
const PHASE: f64 = 0.25;
const SHORTEST: f64 = 20.0;

/// A change of the half-width (C) over a panel that has no effect.
const LEVEL: f64 = 1e-9;

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
        Self { axis, symmetric, half_widths, coefficients }
    }

    /// The same pressure in units of length and of pressure that are 1 / `factor` of the present
    /// ones.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let scale = |values: &Vec<f64>| values.iter().map(|v| factor * v).collect();
        Self {
            axis: self.axis.scaled(factor),
            symmetric: self.symmetric,
            half_widths: scale(&self.half_widths),
            coefficients: self.coefficients.iter().map(scale).collect(),
        }
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
        let mut coefficients = vec![0.0; self.coefficients[0].len()];
        // Towards an open end half-widths fall like the root of the distance, their squares evenly.
        let between = self.axis.interpolation(self.on_axis(y));
        let square: f64 = between.map(|(j, w)| w * self.half_widths[j].powi(2)).sum();
        let half_width = square.max(0.0).sqrt();
        for (j, w) in neighbours {
            for (sum, c) in coefficients.iter_mut().zip(&self.coefficients[j]) {
                *sum += w * c;
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

    /// The load per length at every node.
    pub fn line_loads(&self) -> Vec<LineLoad> {
        let nodes = self.axis.nodes().iter().zip(self.axis.weights()).enumerate();
        let at = |(j, (&y, &weight))| {
            let (half_width, modes) = self.at_node(j);
            let load = strip::cumulative(half_width, modes, half_width);
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
        let fading = fading(&self.axis, &self.half_widths);
        let mut modes = vec![0.0; self.coefficients[0].len()];
        DMatrix::from_fn(self.axis.len(), k.len(), |j, i| {
            strip::transforms(self.half_widths[j], k[i], &mut modes);
            let sum: f64 = modes.iter().zip(&self.coefficients[j]).map(|(t, c)| t * c).sum();
            sum / (1.0 + (k[i] / fading[j]).powi(4))
        })
    }

    fn endless(&self, y: f64, x: f64, z: f64) -> [f64; 3] {
        self.plane(y, |a, c| strip::stress(a, c, x, z))
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
}
