//! Case and study files. `cases/README.md` explains the format to users.

mod builtin;
mod case_file;
mod document;
#[cfg(feature = "cli")]
mod study_file;
#[cfg(feature = "cli")]
mod sweep_file;
#[cfg(all(test, feature = "cli"))]
mod tests;

pub use builtin::{BUILTIN_CASES, builtin_case};
#[cfg(feature = "cli")]
pub use {
    study_file::{DEFAULT_STUDY, Study},
    sweep_file::Sweep,
};

use crate::base::{HertzScales, Material};
use serde::{Deserialize, Serialize};

/// A right circular cylinder with its axis along y.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Roller {
    /// Radius (m).
    pub radius_m: f64,
    /// Length along y (m).
    pub length_m: f64,
    /// Material.
    pub material: Material,
}

/// A rectangular block, deep and wide against the contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Block {
    /// Length along y (m), not shorter than the roller.
    pub length_m: f64,
    /// Material.
    pub material: Material,
}

/// A validated contact problem in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Factors {
    /// Load factor w / (E* R L1).
    pub load: f64,
    /// Contact slenderness S_l = L1 / (2 C).
    pub slenderness: f64,
    /// Contact length ratio L_r = L1 / L2.
    pub length_ratio: f64,
}

impl Factors {
    /// Legal range of W. Above, the half-width C is more than a quarter of the radius, which no
    /// small-strain theory of contact covers.
    pub const LOAD_RANGE: (f64, f64) = (1e-12, 0.05);
    /// Legal range of S_l.
    pub const SLENDERNESS_RANGE: (f64, f64) = (0.5, 1e4);
    /// Legal range of L_r.
    pub const LENGTH_RATIO_RANGE: (f64, f64) = (1e-3, 1.0);
}

impl Case {
    /// Larger case and study files are refused unread: none comes near (bytes).
    pub const MAX_BYTES: u64 = 1 << 20;

    /// The accuracy that is asked for where a case does not say, as a fraction of p0.
    pub const DEFAULT_TOLERANCE: f64 = 1e-3;

    /// Legal range of lengths and radii (m).
    pub const LENGTH_RANGE: (f64, f64) = (1e-9, 1e4);

    /// Legal range of the load (N).
    pub const FORCE_RANGE: (f64, f64) = (1e-12, 1e15);

    /// Legal range of the tolerance.
    pub const TOLERANCE_RANGE: (f64, f64) = (1e-5, 1e-1);

    /// The case that has the dimensionless `factors`, with a roller of radius `radius_m` (m), and
    /// the default tolerance. Does not check its arguments: files are checked as they are read.
    pub fn from_factors(
        name: impl Into<String>,
        radius_m: f64,
        roller: Material,
        block: Material,
        factors: Factors,
    ) -> Self {
        let e_star = roller.contact_modulus(&block);
        let c_m = 2.0 * radius_m * (factors.load / std::f64::consts::PI).sqrt();
        let length_m = 2.0 * c_m * factors.slenderness;
        Self {
            name: name.into(),
            roller: Roller { radius_m, length_m, material: roller },
            block: Block { length_m: length_m / factors.length_ratio, material: block },
            force_n: factors.load * e_star * radius_m * length_m,
            tolerance: Self::DEFAULT_TOLERANCE,
        }
    }

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

    /// What that follows from factors is out of its legal range, in words.
    fn out_of_range(&self) -> Option<String> {
        let (length, force) = (Self::LENGTH_RANGE, Self::FORCE_RANGE);
        [
            ("the roller's length", self.roller.length_m, length, "m"),
            ("the block's length", self.block.length_m, length, "m"),
            ("the load", self.force_n, force, "N"),
        ]
        .into_iter()
        .find(|(_, value, (low, high), _)| !(*low..=*high).contains(value))
        .map(|(what, value, (low, high), unit)| {
            format!("{what} becomes {value:.3e} {unit} and must lie between {low:e} and {high:e}")
        })
    }

    /// Whether `other` is the same problem, whatever it is called and however accurately it is to be
    /// solved: bodies, materials and load agree to nine digits.
    pub fn is_same_problem(&self, other: &Case) -> bool {
        let numbers = |c: &Case| {
            let (roller, block) = (c.roller.material, c.block.material);
            [
                c.roller.radius_m,
                c.roller.length_m,
                c.block.length_m,
                c.force_n,
                roller.young_pa,
                block.young_pa,
                // 1 - nu^2 is what matters, and nu may be 0.
                1.0 + roller.poisson,
                1.0 + block.poisson,
            ]
        };
        numbers(self).iter().zip(numbers(other)).all(|(a, b)| (a - b).abs() <= 1e-9 * b)
    }

    /// The case file that [`Case::parse`] reads this case from, to the last digit.
    pub fn to_toml(&self) -> String {
        let (roller, block) = (self.roller, self.block);
        let body = |material: Material, length_m: f64| {
            let (young_pa, poisson) = (material.young_pa, material.poisson);
            format!("length_m = {length_m:?}\nyoung_pa = {young_pa:?}\npoisson = {poisson:?}\n")
        };
        format!(
            "name = \"{}\"\n[roller]\nradius_m = {:?}\n{}[block]\n{}[load]\nforce_n = {:?}\n\
             [accuracy]\ntolerance = {:?}\n",
            self.name,
            roller.radius_m,
            body(roller.material, roller.length_m),
            body(block.material, block.length_m),
            self.force_n,
            self.tolerance,
        )
    }
}
