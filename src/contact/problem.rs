//! A contact along a line, as the solver takes it.

use super::gap::Gap;
use super::operator::Compliance;
use super::slices::Slices;
use crate::base::Panels;

/// What is known of the bodies' tilt, in units of C / (2 R), and of the load's moment, the integral
/// of y p in units of C^3 p0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rotation {
    /// The bodies are held at this tilt.
    Held(f64),
    /// They are free to tilt under a load of this moment.
    Free(f64),
    /// They are held by a spring: the tilt is that of the spring's far end less what the load's
    /// moment turns it back.
    Sprung {
        /// The tilt of the far end, which is the bodies' own without a moment.
        tilt: f64,
        /// The turn by a unit moment (1 / (2 C^2 R p0)).
        compliance: f64,
    },
}

/// Two bodies that are pressed together along a line. Lengths are in units of C, pressures of p0.
#[derive(Clone, Copy)]
pub struct Problem<'a> {
    /// The compliance of both bodies at the nodes of `axis`.
    pub compliance: &'a Compliance<'a>,
    /// Axis along the contact.
    pub axis: &'a Panels,
    /// Whether the axis begins at the contact's other end; else it begins in a plane of symmetry,
    /// and holds one half of the contact.
    pub both_ends: bool,
    /// The gap between the bodies before they are loaded.
    pub gap: &'a dyn Gap,
    /// The load on the axis, the integral of p (C^2 p0).
    pub load: f64,
    /// What is known of the tilt.
    pub rotation: Rotation,
    /// Whether the axis ends before the bodies do, where the pressure goes to zero.
    pub open: [bool; 2],
    /// Whether the contact may end before the axis does.
    pub recedes: [bool; 2],
    /// The length (C) within which the gap turns at each end of the axis, see
    /// [`super::Shaped::turns_within`].
    pub turns: [f64; 2],
    /// A first guess of the half-widths; one everywhere without.
    pub guess: Option<&'a Slices>,
}

/// An unknown rigid motion.
pub(super) struct Motion {
    /// Displacement of a node at y.
    pub displacement: fn(f64) -> f64,
    /// Its equation: `share` times the integral of the pressure times this displacement, and `own`
    /// times the motion itself, sum to `resultant`.
    pub share: f64,
    pub own: f64,
    pub resultant: f64,
}

impl Problem<'_> {
    /// The gap before the load, with a tilt that is held.
    pub(super) fn gap(&self, x: f64, y: f64) -> f64 {
        match self.rotation {
            Rotation::Held(tilt) => self.gap.at(x, y) - tilt * y,
            Rotation::Free(_) | Rotation::Sprung { .. } => self.gap.at(x, y),
        }
    }

    /// Whether the contact may end before the bodies do.
    pub(super) fn may_end(&self) -> bool {
        self.recedes.contains(&true)
    }

    /// The unknown rigid motions: the approach, and the tilt if it is not held.
    pub(super) fn motions(&self) -> Vec<Motion> {
        let approach = Motion { displacement: |_| 1.0, share: 1.0, own: 0.0, resultant: self.load };
        let tilt = |share, own, resultant| Motion { displacement: |y| y, share, own, resultant };
        match self.rotation {
            Rotation::Held(_) => vec![approach],
            Rotation::Free(moment) => vec![approach, tilt(1.0, 0.0, moment)],
            Rotation::Sprung { tilt: sum, compliance } => {
                vec![approach, tilt(compliance, 1.0, sum)]
            }
        }
    }

    /// Distance of `y` from the nearer end of the axis that is an end of the contact.
    pub(super) fn distance_to_end(&self, y: f64) -> f64 {
        let before = if self.both_ends { y - self.axis.breaks()[0] } else { f64::INFINITY };
        before.min(self.axis.end() - y)
    }

    /// The side of the end of the contact next to `y`.
    pub(super) fn side_of(&self, y: f64) -> usize {
        usize::from(!self.both_ends || y - self.axis.breaks()[0] >= self.axis.end() - y)
    }

    /// Whether the pressure grows without limit towards the end next to `y`.
    pub(super) fn is_steep(&self, y: f64) -> bool {
        let end = [self.axis.breaks()[0], self.axis.end()][self.side_of(y)];
        let corners = self.axis.corners().iter();
        corners.filter(|corner| corner.exponent().is_some()).any(|corner| corner.at == end)
    }
}
