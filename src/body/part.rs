//! The parts of the loads on a body.

use crate::base::Parity;

/// A part of the loads on a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Whether it is even or odd about the body's middle.
    pub parity: Parity,
    /// Whether there is an odd part. Beside an end without a load both parts have the power of the
    /// other end, and cancel: their axes begin alike at the corner.
    pub bends: bool,
    /// Whether the contact may carry a traction along x.
    pub slides: bool,
}

impl Part {
    /// Loads that are even about the body's middle, all of them, without a traction.
    pub const EVEN: Self = Self { parity: Parity::Even, bends: false, slides: false };
}
