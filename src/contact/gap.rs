//! The gap between the bodies before they are loaded.

/// The gap between two bodies that touch at the origin, in units of C^2 / (2 R).
pub trait Gap: Sync {
    /// The gap at (`x`, `y`) (C).
    fn at(&self, x: f64, y: f64) -> f64;
}

/// A straight cylinder on a plane, by the parabola that Hertz's theory takes for it: x^2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Straight;

impl Gap for Straight {
    fn at(&self, x: f64, _y: f64) -> f64 {
        x * x
    }
}
