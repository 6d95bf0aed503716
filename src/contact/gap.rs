//! The gap between the bodies before they are loaded.

use crate::base::{Kink, Profile};
use crate::body::Generatrix;

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

/// Cylinders with profiles, on top of Hertz's parabola.
#[derive(Debug, Clone, PartialEq)]
pub struct Shaped {
    /// Place of each profiled body's middle, and its profile, in units of C.
    pub profiles: Vec<(f64, Profile)>,
    /// 2 R / C: C in units of C^2 / (2 R).
    pub steepness: f64,
}

/// Distance (C) over which the change of a gap's slope is looked at.
const BESIDE: f64 = 0.05;

impl Shaped {
    /// The same gap with places along y that are counted from `origin`.
    #[must_use]
    pub fn counted_from(mut self, origin: f64) -> Self {
        self.profiles.iter_mut().for_each(|(middle, _)| *middle -= origin);
        self
    }

    /// The gap along the line x = 0.
    pub fn generatrix(&self) -> Generatrix<'_> {
        let drop = Box::new(|y: f64| self.at(0.0, y));
        Generatrix { drop, kinks: self.kinks(), points: self.points() }
    }

    /// Where the gap's curvature along y jumps, see [`Profile::kinks`].
    pub fn kinks(&self) -> Vec<Kink> {
        let of = |(middle, profile): &(f64, Profile)| -> Vec<Kink> {
            let placed = |Kink { at, jump }| Kink { at: middle + at, jump: self.steepness * jump };
            profile.kinks().into_iter().map(placed).collect()
        };
        self.profiles.iter().flat_map(of).collect()
    }

    /// The points of measured profiles, see [`Profile::points`].
    fn points(&self) -> Vec<f64> {
        let of = |(middle, profile): &(f64, Profile)| -> Vec<f64> {
            profile.points().iter().map(|y| middle + y).collect()
        };
        self.profiles.iter().flat_map(of).collect()
    }

    /// The length (C) within which the gap's slope along y grows by e towards the place `y`, from
    /// the side on which `inward` points; infinite where it does not grow.
    pub fn turns_within(&self, y: f64, inward: f64) -> f64 {
        let slope = |y: f64| -> f64 {
            self.profiles.iter().map(|(middle, profile)| profile.slope(y - middle)).sum::<f64>()
        };
        let growth = (slope(y) / slope(y + inward * BESIDE)).ln();
        if growth > 0.0 { BESIDE / growth } else { f64::INFINITY }
    }
}

impl Gap for Shaped {
    fn at(&self, x: f64, y: f64) -> f64 {
        let drops = self.profiles.iter().map(|(middle, profile)| profile.drop(y - middle));
        // Without a profile the steepness is zero.
        x * x + self.steepness * drops.sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ln(1 / (1 - k t^2)) has the slope 2 k t / (1 - k t^2): near t = 1 it grows by e within (1 -
    /// k) / (2 k).
    #[test]
    fn a_gap_turns_within_the_length_of_its_profiles_end() {
        let profile = |k| Profile::Logarithm { amplitude: 1.0, k, start: 0.0, span: 50.0 };
        let gap = |profiles| Shaped { profiles, steepness: 1.0 };
        for k in [0.9, 0.96, 0.99] {
            let shaped = gap(vec![(3.0, profile(k))]);
            let length = 50.0 * (1.0 - k) / (2.0 * k);
            for (end, inward) in [(53.0, -1.0), (-47.0, 1.0)] {
                let found = shaped.turns_within(end, inward);
                assert!((found / length - 1.0).abs() < 0.15, "{k}: {found}, not {length}");
            }
        }
        // A crown turns within its length, and a straight gap nowhere.
        let crown = gap(vec![(0.0, Profile::Arc { straight: 0.0, radius: 1e4 })]);
        assert!((crown.turns_within(20.0, -1.0) / 20.0 - 1.0).abs() < 0.01);
        assert_eq!(gap(vec![]).turns_within(5.0, -1.0), f64::INFINITY);
    }
}
