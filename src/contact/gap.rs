//! The gap between the bodies before they are loaded.

/// The gap between two unloaded bodies that touch at the origin, in units of C^2 / (2 R).
pub trait Gap: Sync {
    /// The gap at (`x`, `y`) (C).
    fn at(&self, x: f64, y: f64) -> f64;
}

/// A straight cylinder on a plane, with the parabola x^2 of Hertz's theory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Straight;

impl Gap for Straight {
    fn at(&self, x: f64, _y: f64) -> f64 {
        x * x
    }
}
