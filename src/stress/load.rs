//! What a stress field needs to know of the pressure on its body.

use super::round::LocalContact;
use super::slow_change::SlowChange;
use crate::base::{Panels, Parity, Wavenumbers};
use nalgebra::DMatrix;
use std::fmt::Debug;

/// A pressure (p0) that is even in x, unless it says otherwise, with a profile across the contact
/// at each node of an axis along it.
pub trait Load: Debug + Sync {
    /// Axis along the contact: all of it, or the half from its middle to its end.
    fn axis(&self) -> &Panels;

    /// Whether the pressure is even in y, and the axis holds its half at y >= 0.
    fn is_symmetric(&self) -> bool {
        true
    }

    /// The place on the axis that stands for `y`.
    fn on_axis(&self, y: f64) -> f64 {
        if self.is_symmetric() { y.abs() } else { y }
    }

    /// Whether the pressure is even or odd in x; the transforms of an odd one are those with sin(k
    /// x).
    fn parity_across(&self) -> Parity {
        Parity::Even
    }

    /// The contact's ends along y.
    fn ends(&self) -> [f64; 2] {
        let [from, to] = [self.axis().breaks()[0], self.axis().end()];
        if self.is_symmetric() { [-to, to] } else { [from, to] }
    }

    /// The plane contact with the load at `y`; that of the mean load if it is much the same
    /// everywhere.
    fn local_contact(&self, _y: f64) -> LocalContact {
        LocalContact::HERTZ
    }

    /// The pressure at (`x`, `y`).
    fn at(&self, x: f64, y: f64) -> f64;

    /// Fourier transforms over x: a column for each of the wavenumbers `k`, over the nodes.
    fn transforms(&self, k: &[f64]) -> DMatrix<f64>;

    /// Stresses xx, zz and xz at (`x`, `z`) under an endless contact with the pressure at `y`.
    fn endless(&self, y: f64, x: f64, z: f64) -> [f64; 3];

    /// How the load changes slowly along the line at `y`, as far as waves up to `k_max` leave it to
    /// a closed form.
    fn slow_change(&self, _y: f64, _k_max: f64) -> SlowChange {
        SlowChange::default()
    }

    /// The integral of [`Load::endless`] over the line.
    fn endless_of_all(&self, x: f64, z: f64) -> [f64; 3] {
        let sides = if self.is_symmetric() { 2.0 } else { 1.0 };
        let mut sum = [0.0; 3];
        for (y, weight) in self.axis().nodes().iter().zip(self.axis().weights()) {
            let own = self.endless(*y, x, z);
            sum.iter_mut().zip(own).for_each(|(sum, s)| *sum += sides * weight * s);
        }
        sum
    }

    /// Transforms with the quadrature over the wavenumbers, see [`Wavenumbers::moments`]: a row for
    /// each of the coarse ones, over the nodes.
    fn moments(&self, wavenumbers: &Wavenumbers) -> DMatrix<f64> {
        let n = self.axis().len();
        let transforms = self.transforms(wavenumbers.fine());
        let moments = wavenumbers.moments(transforms.as_slice(), n);
        DMatrix::from_row_slice(wavenumbers.coarse().len(), n, &moments)
    }

    /// The nodes whose values interpolate to `y`, with their weights; none outside the contact.
    fn neighbours(&self, y: f64) -> Vec<(usize, f64)> {
        self.axis().load_interpolation(self.on_axis(y)).collect()
    }
}

/// A [`Load`] whose pressure may act as a traction along x instead.
pub trait Traction: Load {
    /// Stresses xx, zz and xz at (`x`, `z`) under an endless contact with the pressure at `y` as a
    /// traction along +x.
    fn endless_along(&self, y: f64, x: f64, z: f64) -> [f64; 3];
}
