//! One contact problem in SI units. The structs have the form of the case file: serde writes it,
//! and each field is declared once. `keys.rs` lists their numbers.

use crate::base::{HertzScales, Material};
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

/// A right circular cylinder with its axis along y.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Roller {
    /// Radius (m).
    pub radius_m: f64,
    /// Length along y (m).
    pub length_m: f64,
    /// Material.
    #[serde(flatten)]
    pub material: Material,
}

/// A rectangular block, deep and wide against the contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Block {
    /// Length along y (m), not shorter than the roller.
    pub length_m: f64,
    /// Material.
    #[serde(flatten)]
    pub material: Material,
}

/// The load that presses the roller on the block.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Load {
    /// Force (N), of the whole roller.
    pub force_n: f64,
}

/// The accuracy of the solution; not a part of the problem.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// Requested accuracy of the semi-analytical solution, as a fraction of p0.
    pub tolerance: f64,
}

impl Default for Accuracy {
    /// The accuracy of a case without its own.
    fn default() -> Self {
        Self { tolerance: 1e-3 }
    }
}

/// The cells of the engine on cells; no part of the problem.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cells {
    /// Half-width of their region across the contact (m).
    pub half_width_m: f64,
}

/// A contact problem in SI units. [`Case::check`] tells whether it is legal. A case that was read
/// from a file is legal.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Case {
    /// The case's name, unique in a study.
    pub name: String,
    /// The roller.
    pub roller: Roller,
    /// The block.
    pub block: Block,
    /// The load.
    pub load: Load,
    /// The accuracy.
    pub accuracy: Accuracy,
    /// The cells, where the case says anything of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cells: Option<Cells>,
}

/// The three factors of the study.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Factors {
    /// Load factor W = w / (E* R L1).
    pub load: f64,
    /// Contact slenderness S_l = L1 / (2 C).
    pub slenderness: f64,
    /// Contact length ratio L_r = L1 / L2.
    pub length_ratio: f64,
}

impl Factors {
    /// Legal range of W. Above it the half-width C exceeds a quarter of the radius, where no theory
    /// of small strains holds.
    pub const LOAD_RANGE: (f64, f64) = (1e-12, 0.05);
    /// Legal range of S_l.
    pub const SLENDERNESS_RANGE: (f64, f64) = (0.5, 1e4);
    /// Legal range of L_r.
    pub const LENGTH_RATIO_RANGE: (f64, f64) = (1e-3, 1.0);
}

/// Numbers of two cases that agree to this fraction are equal: formatting, reading and the
/// conversion to factors and back round them.
const SAME: f64 = 1e-9;

/// Reason why writing a case cannot fail.
const PLAIN: &str = "a case has the form of its file";

impl Case {
    /// Size above which case and study files are refused (bytes).
    pub const MAX_BYTES: u64 = 1 << 20;

    /// The case that has the dimensionless `factors`, with a roller of radius `radius_m` (m), and
    /// the default accuracy. Does not check its arguments; see [`Case::check`].
    pub fn from_factors(
        name: impl Into<String>,
        radius_m: f64,
        roller: Material,
        block: Material,
        factors: Factors,
    ) -> Self {
        let mut case = Self {
            name: name.into(),
            roller: Roller { radius_m, length_m: f64::NAN, material: roller },
            block: Block { length_m: f64::NAN, material: block },
            load: Load { force_n: f64::NAN },
            accuracy: Accuracy::default(),
            cells: None,
        };
        case.set_factors(factors);
        case
    }

    /// The same case with another tolerance.
    #[must_use]
    pub fn with_tolerance(self, tolerance: f64) -> Self {
        Self { accuracy: Accuracy { tolerance }, ..self }
    }

    /// Sets the lengths and the force from `factors`, the radius and the materials.
    pub(super) fn set_factors(&mut self, factors: Factors) {
        let e_star = self.roller.material.contact_modulus(&self.block.material);
        let radius_m = self.roller.radius_m;
        let c_m = 2.0 * radius_m * (factors.load / std::f64::consts::PI).sqrt();
        let length_m = 2.0 * c_m * factors.slenderness;
        self.roller.length_m = length_m;
        self.block.length_m = length_m / factors.length_ratio;
        self.load.force_n = factors.load * e_star * radius_m * length_m;
    }

    /// The Hertz line-contact scales.
    pub fn hertz(&self) -> HertzScales {
        let e_star = self.roller.material.contact_modulus(&self.block.material);
        HertzScales::new(e_star, self.roller.radius_m, self.roller.length_m, self.load.force_n)
    }

    /// W, S_l and L_r.
    pub fn factors(&self) -> Factors {
        let hertz = self.hertz();
        let (roller, force_n) = (self.roller, self.load.force_n);
        Factors {
            load: force_n / (hertz.e_star_pa * roller.radius_m * roller.length_m),
            slenderness: roller.length_m / (2.0 * hertz.c_m),
            length_ratio: roller.length_m / self.block.length_m,
        }
    }

    /// Whether `other` is the same problem apart from the name and the accuracy: all other entries
    /// of both case files agree, numbers to nine digits.
    pub fn is_same_problem(&self, other: &Case) -> bool {
        alike(&Value::Table(self.problem()), &Value::Table(other.problem()))
    }

    /// The case file but for the name and for how the case is to be solved.
    fn problem(&self) -> Table {
        let mut table = Table::try_from(self).expect(PLAIN);
        table.retain(|key, _| !["name", "accuracy", "cells"].contains(&key));
        table
    }

    /// The case file, from which [`Case::parse`] reads exactly this case.
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect(PLAIN)
    }
}

/// Whether two values are equal apart from rounding.
fn alike(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Float(a), Value::Float(b)) => (a - b).abs() <= SAME * a.abs().max(b.abs()),
        (Value::Array(a), Value::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| alike(a, b))
        }
        (Value::Table(a), Value::Table(b)) => {
            a.len() == b.len() && a.iter().all(|(key, a)| b.get(key).is_some_and(|b| alike(a, b)))
        }
        _ => a == b,
    }
}
