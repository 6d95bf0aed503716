//! The stress of a body with a flat surface under all that may act on the contact.

use crate::base::StressTensor;
use std::ops::{Mul, Sub};

/// A stress under the contact's pressure, and under the same as a traction along +x.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FlatStress {
    /// Under the pressure.
    pub pressure: StressTensor,
    /// Under the traction, if the contact carries one.
    pub traction: StressTensor,
}

impl FlatStress {
    /// The stress at the mirror image in the plane x = 0, in which a traction changes its
    /// direction.
    #[must_use]
    pub fn mirrored_in_x(&self) -> Self {
        Self {
            pressure: self.pressure.mirrored(StressTensor::ODD_IN_X),
            traction: self.traction.mirrored(StressTensor::ODD_IN_X) * -1.0,
        }
    }
}

impl From<StressTensor> for FlatStress {
    /// Without a traction.
    fn from(pressure: StressTensor) -> Self {
        Self { pressure, ..Self::default() }
    }
}

impl Sub for FlatStress {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { pressure: self.pressure - other.pressure, traction: self.traction - other.traction }
    }
}

impl Mul<f64> for FlatStress {
    type Output = Self;
    fn mul(self, k: f64) -> Self {
        Self { pressure: self.pressure * k, traction: self.traction * k }
    }
}
