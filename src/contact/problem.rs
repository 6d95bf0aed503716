//! A contact along a line, as the solver takes it.

use super::gap::Gap;
use super::operator::Compliance;
use super::slices::Slices;
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
    /// held.
    pub moment: Option<f64>,
    /// The tilt that is held (C / (2 R)); of no effect with a moment.
    pub tilt: f64,
    /// Whether the axis ends before the bodies do, where the pressure goes to zero.
    pub open: [bool; 2],
    /// Whether the contact may end before the axis does.
    pub recedes: [bool; 2],
    /// A first guess of the half-widths; one everywhere without.
    pub guess: Option<&'a Slices>,
}

/// An unknown rigid motion.
pub(super) struct Motion {
    /// Displacement of a node at y.
    pub displacement: fn(f64) -> f64,
    /// The integral of the pressure times this displacement.
    pub resultant: f64,
}

impl Problem<'_> {
    /// The gap before the load, with a tilt that is held.
    pub(super) fn gap(&self, x: f64, y: f64) -> f64 {
        let tilt = if self.moment.is_some() { 0.0 } else { self.tilt };
        self.gap.at(x, y) - tilt * y
    }

    /// Whether the contact may end before the bodies do.
    pub(super) fn may_end(&self) -> bool {
        self.recedes.contains(&true)
    }

    /// The unknown rigid motions: the approach, and the tilt if it is free.
    pub(super) fn motions(&self) -> Vec<Motion> {
        let approach = Motion { displacement: |_| 1.0, resultant: self.load };
        let tilt = self.moment.map(|moment| Motion { displacement: |y| y, resultant: moment });
        std::iter::once(approach).chain(tilt).collect()
    }

    /// Distance of `y` from the nearer end of the axis that is an end of the contact.
    pub(super) fn distance_to_end(&self, y: f64) -> f64 {
        let before = if self.both_ends { y - self.axis.breaks()[0] } else { f64::INFINITY };
        before.min(self.axis.end() - y)
    }
}
