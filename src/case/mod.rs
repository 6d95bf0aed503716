//! Case and study files.

use crate::base::{HertzScales, Material};

/// A right circular cylinder with its axis along y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roller {
    /// Radius (m).
    pub radius_m: f64,
    /// Length along y (m).
    pub length_m: f64,
    /// Material.
    pub material: Material,
}

/// A rectangular block, deep and wide against the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block {
    /// Length along y (m), not shorter than the roller.
    pub length_m: f64,
    /// Material.
    pub material: Material,
}

/// A validated contact problem in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// The case's name, unique in a study.
    pub name: String,
    /// The roller.
    pub roller: Roller,
    /// The block.
    pub block: Block,
    /// Load (N).
    pub force_n: f64,
    /// Requested accuracy of the semi-analytical solution, as a fraction of p0.
    pub tolerance: f64,
}

/// The three factors of the study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factors {
    /// Load factor w / (E* R L1).
    pub load: f64,
    /// Contact slenderness S_l = L1 / (2 C).
    pub slenderness: f64,
    /// Contact length ratio L_r = L1 / L2.
    pub length_ratio: f64,
}

impl Case {
    /// The accuracy that is asked for where a case does not say, as a fraction of p0.
    pub const DEFAULT_TOLERANCE: f64 = 1e-3;

    /// The Hertz line-contact scales.
    pub fn hertz(&self) -> HertzScales {
        let e_star = self.roller.material.contact_modulus(&self.block.material);
        HertzScales::new(e_star, self.roller.radius_m, self.roller.length_m, self.force_n)
    }

    /// W, S_l and L_r.
    pub fn factors(&self) -> Factors {
        let hertz = self.hertz();
        Factors {
            load: self.force_n / (hertz.e_star_pa * self.roller.radius_m * self.roller.length_m),
            slenderness: self.roller.length_m / (2.0 * hertz.c_m),
            length_ratio: self.roller.length_m / self.block.length_m,
        }
    }
}
