//! What an error is of, and how errors are measured. Files hold the names.

use crate::stress::Variable;
use serde::{Deserialize, Deserializer, de};

/// What an error is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Of {
    /// The six components of the stress together; its name is `stress`.
    Components,
    /// One variable.
    Variable(Variable),
}

impl Of {
    /// The name used in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Components => "stress",
            Self::Variable(variable) => variable.name(),
        }
    }

    /// What has this name.
    pub fn from_name(name: &str) -> Option<Self> {
        if name == Self::Components.name() {
            return Some(Self::Components);
        }
        Variable::from_name(name).map(Self::Variable)
    }

    /// Whether an error of `variable` is one of it.
    pub fn takes(self, variable: Variable) -> bool {
        match self {
            Self::Components => variable.is_component(),
            Self::Variable(own) => own == variable,
        }
    }
}

/// The measure of an error over the points of curves, see [`super::errors`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// The largest magnitude.
    Max,
    /// Root mean square.
    Rms,
    /// Mean magnitude.
    L1,
}

impl Measure {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Max, Self::Rms, Self::L1];

    /// The name used in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Max => "max",
            Self::Rms => "rms",
            Self::L1 => "l1",
        }
    }
}

impl<'de> Deserialize<'de> for Measure {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        let found = Self::ALL.into_iter().find(|measure| measure.name() == name);
        found
            .ok_or_else(|| de::Error::custom(format!("measure = {name:?} is none of max, rms, l1")))
    }
}
