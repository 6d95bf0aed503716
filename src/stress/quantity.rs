//! What is compared and drawn: the contact pressure, and the scalars of a stress.

use crate::base::StressTensor;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::fmt;

/// A scalar of a stress tensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quantity {
    /// A component of the stress tensor, by its index in [`StressTensor::components`].
    Stress(u8),
    /// Von Mises equivalent stress.
    VonMises,
    /// Largest shear stress.
    TauMax,
}

impl Quantity {
    /// All quantities of a stress, in the order of the files' columns.
    pub const ALL: [Quantity; 8] = [
        Quantity::Stress(0),
        Quantity::Stress(1),
        Quantity::Stress(2),
        Quantity::Stress(3),
        Quantity::Stress(4),
        Quantity::Stress(5),
        Quantity::VonMises,
        Quantity::TauMax,
    ];

    /// Its place in [`Quantity::ALL`].
    pub fn index(self) -> usize {
        match self {
            Quantity::Stress(i) => usize::from(i),
            Quantity::VonMises => 6,
            Quantity::TauMax => 7,
        }
    }

    /// The name used in files, e.g. `sigma_yy`.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Stress(i) => StressTensor::NAMES[usize::from(i)],
            Quantity::VonMises => "von_mises",
            Quantity::TauMax => "tau_max",
        }
    }

    /// Its value, in the tensor's unit.
    pub fn of(self, stress: &StressTensor) -> f64 {
        match self {
            Quantity::Stress(i) => stress.components()[usize::from(i)],
            Quantity::VonMises => stress.von_mises(),
            Quantity::TauMax => stress.tau_max(),
        }
    }
}

/// The contact pressure, or a scalar of the stress. Files hold its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variable {
    /// The contact pressure.
    Pressure,
    /// A scalar of the stress.
    Stress(Quantity),
}

impl Variable {
    /// The pressure, then the stresses in the order of the files' columns.
    pub fn all() -> impl Iterator<Item = Self> {
        std::iter::once(Self::Pressure).chain(Quantity::ALL.map(Self::Stress))
    }

    /// The name used in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pressure => "pressure",
            Self::Stress(quantity) => quantity.name(),
        }
    }

    /// The variable of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().find(|variable| variable.name() == name)
    }

    /// Whether it is one of the six components of the stress.
    pub fn is_component(self) -> bool {
        matches!(self, Self::Stress(Quantity::Stress(_)))
    }
}

impl fmt::Display for Variable {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Serialize for Variable {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for Variable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        Self::from_name(&name)
            .ok_or_else(|| de::Error::custom(format!("there is no variable '{name}'")))
    }
}
