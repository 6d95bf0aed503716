//! The gap between the bodies before they are loaded.

use crate::base::Profile;

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

impl Shaped {
    /// Where the gap's curvature along y jumps, see [`Profile::kinks`].
    pub fn kinks(&self) -> Vec<f64> {
        let of = |(middle, profile): &(f64, Profile)| Some(profile.kinks()?.map(|y| middle + y));
        self.profiles.iter().filter_map(of).flatten().collect()
    }
}

impl Gap for Shaped {
    fn at(&self, x: f64, y: f64) -> f64 {
        let drops = self.profiles.iter().map(|(middle, profile)| profile.drop(y - middle));
        // Without a profile the steepness is zero.
        x * x + self.steepness * drops.sum::<f64>()
    }
}
