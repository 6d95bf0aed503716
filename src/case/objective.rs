//! What is made smallest when a profile is designed.

use serde::{Deserialize, Serialize};

/// The largest value of it over both bodies is made smallest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Objective {
    /// Von Mises stress.
    VonMises,
    /// Contact pressure.
    Pressure,
    /// Range of tau_xz while the contact passes.
    TauXz,
}

impl Objective {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::VonMises, Self::Pressure, Self::TauXz];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::VonMises => "von_mises",
            Self::Pressure => "pressure",
            Self::TauXz => "tau_xz",
        }
    }

    /// Its name in words.
    pub fn label(self) -> &'static str {
        match self {
            Self::VonMises => "von Mises stress",
            Self::Pressure => "pressure",
            Self::TauXz => "range of tau_xz",
        }
    }
}
