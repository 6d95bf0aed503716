//! The contact pressure as a function of position.

use super::load::Load;
use crate::base::Panels;
use crate::kernels::strip;
use nalgebra::DMatrix;

/// The contact pressure as a function of position.
#[derive(Debug, Clone)]
pub struct Pressure {
    axis: Panels,
    half_widths: Vec<f64>,
    coefficients: Vec<Vec<f64>>,
}

impl Pressure {
    /// The pressure from the half-widths and the coefficients of the modes at the nodes of `axis`;
    /// missing modes of a node are zero.
    pub fn new(axis: Panels, half_widths: Vec<f64>, mut coefficients: Vec<Vec<f64>>) -> Self {
        let most = coefficients.iter().map(Vec::len).max().unwrap_or(0);
        coefficients.iter_mut().for_each(|c| c.resize(most, 0.0));
        Self { axis, half_widths, coefficients }
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
        let neighbours = self.neighbours(y.abs());
        if neighbours.is_empty() {
            return None;
        }
        let mut coefficients = vec![0.0; self.coefficients[0].len()];
        let mut half_width = 0.0;
        for (j, w) in neighbours {
            half_width += w * self.half_widths[j];
            for (sum, c) in coefficients.iter_mut().zip(&self.coefficients[j]) {
                *sum += w * c;
            }
        }
        Some((half_width, coefficients))
    }

    /// Pressure at (`x`, `y`) (p0).
    pub fn at(&self, x: f64, y: f64) -> f64 {
        self.modes(y).map_or(0.0, |(a, c)| strip::pressure(a, &c, x).max(0.0))
    }
}

impl Load for Pressure {
    fn axis(&self) -> &Panels {
        self.axis()
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        self.at(x, y)
    }

    fn transforms(&self, k: &[f64]) -> DMatrix<f64> {
        let mut modes = vec![0.0; self.coefficients[0].len()];
        DMatrix::from_fn(self.axis.len(), k.len(), |j, i| {
            strip::transforms(self.half_widths[j], k[i], &mut modes);
            modes.iter().zip(&self.coefficients[j]).map(|(t, c)| t * c).sum()
        })
    }

    fn endless(&self, j: usize, x: f64, z: f64) -> [f64; 3] {
        strip::stress(self.half_widths[j], &self.coefficients[j], x, z)
    }
}
