//! One contact problem in SI units. The structs have the form of the case file: serde writes it,
//! and each field is declared once. `keys.rs` lists their numbers.

use super::profile::ProfileSpec;
use super::surface::Surface;
use crate::base::{BodyKind, HertzScales, Material, profile};
use crate::cells::Heights;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use toml::{Table, Value};

/// A circular cylinder with its axis along y, and its profile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Roller {
    /// Radius (m).
    pub radius_m: f64,
    /// Length along y (m).
    pub length_m: f64,
    /// Material.
    #[serde(flatten)]
    pub material: Material,
    /// Drop of the generatrix; none if it is straight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub profile: Option<ProfileSpec>,
}

/// A block, deep and wide against the contact: rectangular, or a raceway.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Block {
    /// Length along y (m).
    pub length_m: f64,
    /// Material.
    #[serde(flatten)]
    pub material: Material,
    /// Radius of a raceway (m), negative if it is concave; none for a flat surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius_m: Option<f64>,
    /// Drop of the generatrix; none if it is straight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub profile: Option<ProfileSpec>,
}

/// The load that presses the roller on the block: a force, or the approach that it is to cause.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Load {
    /// Force (N), of the whole roller; not a number where `approach_m` gives the load.
    #[serde(default = "unknown", skip_serializing_if = "is_unknown")]
    pub force_n: f64,
    /// Approach (m) of points one roller radius below the surfaces at the roller's middle, in place
    /// of the force.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub approach_m: Option<f64>,
    /// y of the force's line of action from the roller's middle (m). The roller is then free to
    /// tilt; without it the tilt is held.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub eccentricity_m: Option<f64>,
}

fn unknown() -> f64 {
    f64::NAN
}

fn is_unknown(v: &f64) -> bool {
    v.is_nan()
}

impl PartialEq for Load {
    /// Forces that are not known are equal.
    fn eq(&self, other: &Self) -> bool {
        let Self { force_n, approach_m, eccentricity_m } = self;
        let same_force = *force_n == other.force_n || force_n.is_nan() && other.force_n.is_nan();
        same_force && *approach_m == other.approach_m && *eccentricity_m == other.eccentricity_m
    }
}

/// How the bodies stand to each other.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// The tilt that is held (rad); positive where the side of larger y is pressed deeper. It is
    /// that of the lines x = 0 at the depth of one roller radius in both bodies, by least squares
    /// over the contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tilt_rad: Option<f64>,
    /// y of the block's middle from the roller's (m).
    #[serde(default, skip_serializing_if = "is_zero")]
    pub offset_m: f64,
}

fn is_zero(v: &f64) -> bool {
    *v == 0.0
}

impl Pose {
    /// Whether the bodies are parallel and their middles at one place.
    pub fn is_plain(&self) -> bool {
        *self == Self::default()
    }
}

/// The sliding of the bodies on each other, across the contact.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Sliding {
    /// Traction along x in pressures: that on the block along +x, that on the roller along -x.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub friction: f64,
}

impl Sliding {
    /// Whether there is none.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

/// What measures of fatigue need to know; no part of the contact. A measure without its numbers is
/// not computed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Fatigue {
    /// Dang Van's factor of the hydrostatic stress.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dang_van_alpha: Option<f64>,
    /// Dang Van's limit (Pa).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dang_van_beta_pa: Option<f64>,
    /// Fatemi and Socie's k.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fatemi_socie_k: Option<f64>,
    /// Yield stress (Pa).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yield_pa: Option<f64>,
    /// Residual stress across the contact (Pa).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual_xx_pa: Option<f64>,
    /// Residual stress along the contact (Pa).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual_yy_pa: Option<f64>,
}

impl Fatigue {
    /// Whether nothing is given.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

/// The accuracy of the solution; not a part of the problem.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// Requested accuracy of the semi-analytical solution, as a fraction of p0.
    pub tolerance: f64,
    /// Whether what round surfaces and free ends make of each other is taken in, to first order in
    /// C / R: the pressure then depends on W.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub first_order: bool,
}

impl Default for Accuracy {
    /// The accuracy of a case without its own.
    fn default() -> Self {
        Self { tolerance: 1e-3, first_order: false }
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
    /// How the bodies stand to each other.
    #[serde(default, skip_serializing_if = "Pose::is_plain")]
    pub pose: Pose,
    /// How they slide on each other.
    #[serde(default, skip_serializing_if = "Sliding::is_none")]
    pub sliding: Sliding,
    /// What measures of fatigue need to know.
    #[serde(default, skip_serializing_if = "Fatigue::is_none")]
    pub fatigue: Fatigue,
    /// The rough surface, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surface: Option<Surface>,
    /// The accuracy.
    pub accuracy: Accuracy,
    /// The cells, where the case says anything of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cells: Option<Cells>,
}

/// The three factors of the study.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Factors {
    /// Load factor W = w / (E* R L), L the length of the shorter body.
    pub load: f64,
    /// Contact slenderness S_l = L / (2 C).
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
    pub const LENGTH_RATIO_RANGE: (f64, f64) = (1e-3, 1e3);
}

/// Numbers of two cases that agree to this fraction are equal: formatting, reading and the
/// conversion to factors and back round them.
const SAME: f64 = 1e-9;

/// Reason why writing a case cannot fail.
const PLAIN: &str = "a case has the form of its file";

impl Case {
    /// The heights of the rough surface (m), if there is one.
    pub fn heights(&self) -> Option<Heights> {
        self.surface.as_ref()?.heights()
    }

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
            roller: Roller { radius_m, length_m: f64::NAN, material: roller, profile: None },
            block: Block { length_m: f64::NAN, material: block, radius_m: None, profile: None },
            load: Load { force_n: f64::NAN, approach_m: None, eccentricity_m: None },
            pose: Pose::default(),
            sliding: Sliding::default(),
            fatigue: Fatigue::default(),
            surface: None,
            accuracy: Accuracy::default(),
            cells: None,
        };
        case.set_factors(factors);
        case
    }

    /// The same case with another tolerance.
    #[must_use]
    pub fn with_tolerance(self, tolerance: f64) -> Self {
        let accuracy = Accuracy { tolerance, ..self.accuracy };
        Self { accuracy, ..self }
    }

    /// Sets the lengths and the force from `factors`, the radius and the materials.
    pub(super) fn set_factors(&mut self, factors: Factors) {
        let e_star = self.contact_modulus();
        let radius_m = self.equivalent_radius_m();
        let c_m = 2.0 * radius_m * (factors.load / std::f64::consts::PI).sqrt();
        let shorter_m = 2.0 * c_m * factors.slenderness;
        let ratio = factors.length_ratio;
        self.roller.length_m = if ratio > 1.0 { shorter_m * ratio } else { shorter_m };
        self.block.length_m = if ratio > 1.0 { shorter_m } else { shorter_m / ratio };
        self.load.force_n = factors.load * e_star * radius_m * shorter_m;
        self.load.approach_m = None;
    }

    /// The same case under another force (N), which takes the place of an approach.
    #[must_use]
    pub fn with_force(self, force_n: f64) -> Self {
        let load = Load { force_n, approach_m: None, ..self.load };
        Self { load, ..self }
    }

    /// E* (Pa).
    pub fn contact_modulus(&self) -> f64 {
        self.roller.material.contact_modulus(&self.block.material)
    }

    /// Radius of the cylinder whose gap to a plane is that of the bodies (m).
    pub fn equivalent_radius_m(&self) -> f64 {
        let roller_m = self.roller.radius_m;
        self.block.radius_m.map_or(roller_m, |block_m| 1.0 / (1.0 / roller_m + 1.0 / block_m))
    }

    /// C^2 / (2 R) (m), R the equivalent radius: the gap between the round bodies at x = C. Gaps,
    /// drops and displacements are in this unit.
    pub fn gap_unit_m(&self) -> f64 {
        self.hertz().c_m.powi(2) / (2.0 * self.equivalent_radius_m())
    }

    /// Length of the shorter body (m), on which W, S_l, C and p0 rest.
    pub fn shorter_m(&self) -> f64 {
        self.roller.length_m.min(self.block.length_m)
    }

    /// The material of a body.
    pub fn material(&self, body: BodyKind) -> &Material {
        match body {
            BodyKind::Block => &self.block.material,
            BodyKind::Roller => &self.roller.material,
        }
    }

    /// Length of a body (m).
    pub(super) fn length_m(&self, body: BodyKind) -> f64 {
        match body {
            BodyKind::Block => self.block.length_m,
            BodyKind::Roller => self.roller.length_m,
        }
    }

    /// y of both ends of a body, from the roller's middle (m).
    pub fn ends_m(&self, body: BodyKind) -> [f64; 2] {
        let middle = match body {
            BodyKind::Block => self.pose.offset_m,
            BodyKind::Roller => 0.0,
        };
        let half = 0.5 * self.length_m(body);
        [middle - half, middle + half]
    }

    /// Where both bodies are: y of its ends, from the roller's middle (m).
    pub fn overlap_m(&self) -> [f64; 2] {
        let [block, roller] = BodyKind::ALL.map(|body| self.ends_m(body));
        [block[0].max(roller[0]), block[1].min(roller[1])]
    }

    /// [`Case::overlap_m`] in units of C.
    pub fn overlap(&self) -> [f64; 2] {
        let c_m = self.hertz().c_m;
        self.overlap_m().map(|y| y / c_m)
    }

    /// The Hertz line-contact scales.
    pub fn hertz(&self) -> HertzScales {
        let (e_star, radius_m) = (self.contact_modulus(), self.equivalent_radius_m());
        HertzScales::new(e_star, radius_m, self.shorter_m(), self.load.force_n)
    }

    /// W, S_l and L_r.
    pub fn factors(&self) -> Factors {
        let hertz = self.hertz();
        let shorter_m = self.shorter_m();
        Factors {
            load: self.load.force_n / (hertz.e_star_pa * self.equivalent_radius_m() * shorter_m),
            slenderness: shorter_m / (2.0 * hertz.c_m),
            length_ratio: self.roller.length_m / self.block.length_m,
        }
    }

    /// Whether `other` is the same problem apart from the name and the accuracy: all other entries
    /// of both case files agree, numbers to nine digits, and so does what stands in the files that
    /// they name.
    pub fn is_same_problem(&self, other: &Case) -> bool {
        self.contents() == other.contents()
            && alike(&Value::Table(self.problem()), &Value::Table(other.problem()))
    }

    /// What stands in the files that the case names.
    fn contents(&self) -> ([Option<Arc<profile::Table>>; 2], Option<Arc<Heights>>) {
        let table = |body| self.profile_spec(body)?.table.clone();
        (
            BodyKind::ALL.map(table),
            self.surface.as_ref().and_then(|surface| surface.samples.clone()),
        )
    }

    /// The case file but for the name, the paths of other files, what is made of the stresses, and
    /// how the case is to be solved.
    fn problem(&self) -> Table {
        let mut case = self.clone();
        for spec in [&mut case.block.profile, &mut case.roller.profile].into_iter().flatten() {
            spec.file = None;
        }
        if let Some(surface) = &mut case.surface {
            surface.heights = Default::default();
        }
        let mut table = Table::try_from(&case).expect(PLAIN);
        table.retain(|key, _| !["name", "fatigue", "accuracy", "cells"].contains(&key));
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
