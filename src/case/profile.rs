//! The profile of a body as a case gives it.

use crate::base::profile;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::Arc;

/// The kinds of profiles, by their names in files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ProfileKind {
    /// A circular arc of `radius_m`.
    Crown,
    /// `amplitude_m` ln(1 / (1 - k (2 y / L)^2)).
    Logarithmic,
    /// Lundberg's: logarithmic, for constant pressure under `design_force_n`; without a limit at
    /// the ends.
    Lundberg,
    /// Johns and Gohar's: as Lundberg's, with a limit at the ends.
    JohnsGohar,
    /// That of ISO/TS 16281.
    #[serde(rename = "iso-16281")]
    Iso16281,
    /// Fujiwara and Kawase's.
    Fujiwara,
    /// A straight part of `straight_m`, then arcs of `radius_m` tangent to it.
    Relief,
    /// Measured drops in a `file`.
    Table,
}

impl ProfileKind {
    /// All kinds.
    pub const ALL: [Self; 8] = [
        Self::Crown,
        Self::Logarithmic,
        Self::Lundberg,
        Self::JohnsGohar,
        Self::Iso16281,
        Self::Fujiwara,
        Self::Relief,
        Self::Table,
    ];

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Crown => "crown",
            Self::Logarithmic => "logarithmic",
            Self::Lundberg => "lundberg",
            Self::JohnsGohar => "johns-gohar",
            Self::Iso16281 => "iso-16281",
            Self::Fujiwara => "fujiwara",
            Self::Relief => "relief",
            Self::Table => "table",
        }
    }

    /// Whether its drop is that of both bodies together, so that one of them has it.
    pub(super) fn is_of_both(self) -> bool {
        match self {
            Self::Lundberg | Self::JohnsGohar | Self::Iso16281 | Self::Fujiwara => true,
            Self::Crown | Self::Logarithmic | Self::Relief | Self::Table => false,
        }
    }

    /// The numbers that it needs.
    pub fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Crown => &["radius_m"],
            Self::Logarithmic => &["amplitude_m", "k"],
            Self::Lundberg | Self::JohnsGohar => &["design_force_n"],
            Self::Iso16281 | Self::Table => &[],
            Self::Fujiwara => &["design_force_n", "k1", "k2", "zm_m"],
            Self::Relief => &["straight_m", "radius_m"],
        }
    }
}

/// A profile: its kind and the numbers that the kind needs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProfileSpec {
    /// The kind.
    pub kind: ProfileKind,
    /// Radius of a crown or of a relief's arcs (m).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius_m: Option<f64>,
    /// Factor of a logarithmic profile (m).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude_m: Option<f64>,
    /// k of a logarithmic profile, between 0 and 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub k: Option<f64>,
    /// Force for which the profile is made (N).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub design_force_n: Option<f64>,
    /// K1 of Fujiwara's profile.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub k1: Option<f64>,
    /// K2 of Fujiwara's profile.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub k2: Option<f64>,
    /// Drop of Fujiwara's profile at the end (m).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub zm_m: Option<f64>,
    /// Length of the straight part of a relief (m), all of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub straight_m: Option<f64>,
    /// The file of a table.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// The drops in it.
    #[serde(skip)]
    pub table: Option<Arc<profile::Table>>,
}

impl ProfileSpec {
    /// The numbers that profiles have.
    pub const NUMBERS: [&'static str; 8] =
        ["radius_m", "amplitude_m", "k", "design_force_n", "k1", "k2", "zm_m", "straight_m"];

    /// The radius of an arc that drops by `drop_m` over `arc_m` from where it begins (m).
    pub fn arc_radius_m(arc_m: f64, drop_m: f64) -> f64 {
        (arc_m * arc_m + drop_m * drop_m) / (2.0 * drop_m)
    }

    /// A profile of this kind, without numbers yet.
    pub fn new(kind: ProfileKind) -> Self {
        Self {
            kind,
            radius_m: None,
            amplitude_m: None,
            k: None,
            design_force_n: None,
            k1: None,
            k2: None,
            zm_m: None,
            straight_m: None,
            file: None,
            table: None,
        }
    }

    /// The number called `key`.
    pub(super) fn number(&self, key: &str) -> Option<f64> {
        self.clone().number_mut(key).and_then(|number| *number)
    }

    /// The place of the number called `key`; none if profiles have no such number.
    pub fn number_mut(&mut self, key: &str) -> Option<&mut Option<f64>> {
        Some(match key {
            "radius_m" => &mut self.radius_m,
            "amplitude_m" => &mut self.amplitude_m,
            "k" => &mut self.k,
            "design_force_n" => &mut self.design_force_n,
            "k1" => &mut self.k1,
            "k2" => &mut self.k2,
            "zm_m" => &mut self.zm_m,
            "straight_m" => &mut self.straight_m,
            _ => return None,
        })
    }
}
