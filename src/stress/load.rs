//! What a stress field needs to know of the pressure on its body.

use crate::base::{Panels, Wavenumbers};
use nalgebra::DMatrix;
use std::fmt::Debug;

/// A pressure (p0) that is even in x and y, with a profile across the contact at each node of an axis along it.
pub trait Load: Debug + Sync {
    /// Axis along the contact, from its middle to its end.
    fn axis(&self) -> &Panels;

    /// The pressure at (`x`, `y`).
    fn at(&self, x: f64, y: f64) -> f64;

    /// Fourier transforms over x: a column for each of the wavenumbers `k`, over the nodes.
    fn transforms(&self, k: &[f64]) -> DMatrix<f64>;

    /// Stresses xx, zz and xz at (`x`, `z`) under an endless contact with the pressure of node `j`.
    fn endless(&self, j: usize, x: f64, z: f64) -> [f64; 3];

    /// Transforms with the quadrature over the wavenumbers, see [`Wavenumbers::moments`]: a row for
    /// each of the coarse ones, over the nodes.
    fn moments(&self, wavenumbers: &Wavenumbers) -> DMatrix<f64> {
        let n = self.axis().len();
        let transforms = self.transforms(wavenumbers.fine().nodes());
        let moments = wavenumbers.moments(transforms.as_slice(), n);
        DMatrix::from_row_slice(wavenumbers.coarse().len(), n, &moments)
    }

    /// The nodes whose values interpolate to `y` >= 0, with their weights; none outside the contact.
    fn neighbours(&self, y: f64) -> Vec<(usize, f64)> {
        let axis = self.axis();
        let inside = y <= axis.end() * (1.0 + 1e-12);
        if inside { axis.interpolation(y).collect() } else { Vec::new() }
    }
}
