//! A contact along a line, as the solver takes it.

use super::gap::Gap;
use super::operator::Compliance;
use crate::base::Panels;

/// Two bodies that are pressed together along a line. Lengths are in units of C, pressures of p0.
#[derive(Clone, Copy)]
pub struct Problem<'a> {
    /// The compliance of both bodies at the nodes of `axis`.
    pub compliance: &'a Compliance<'a>,
    /// Axis along the contact.
    pub axis: &'a Panels,
    /// Whether the axis begins at the contact's other end; else it begins in a plane of symmetry, and
    /// holds one half of the contact.
    pub both_ends: bool,
    /// The gap between the bodies before they are loaded.
    pub gap: &'a dyn Gap,
    /// The load on the axis, the integral of p (C^2 p0).
    pub load: f64,
    /// The load's moment, the integral of y p (C^3 p0), of bodies that are free to tilt; none where they are
    /// held parallel.
    pub moment: Option<f64>,
}

impl Problem<'_> {
    /// Rigid motions that are unknown, as displacements at y, each with the integral of p times it:
    /// the approach, and the tilt.
    pub(super) fn motions(&self) -> Vec<(fn(f64) -> f64, f64)> {
        let mut motions: Vec<(fn(f64) -> f64, f64)> = vec![(|_| 1.0, self.load)];
        if let Some(moment) = self.moment {
            motions.push((|y| y, moment));
        }
        motions
    }

    /// Distance of `y` from the nearer end of the contact.
    pub(super) fn from_end(&self, y: f64) -> f64 {
        let before = if self.both_ends { y - self.axis.breaks()[0] } else { f64::INFINITY };
        before.min(self.axis.end() - y)
    }
}
