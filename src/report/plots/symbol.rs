//! What curves show, with its name in files and its symbol on axes.

use crate::stress::Quantity;

/// What a curve shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// The contact pressure.
    Pressure,
    /// A scalar of the stress.
    Stress(Quantity),
}

impl Shown {
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

    /// The symbol, as a fraction of p0.
    pub fn symbol(self) -> String {
        let symbol = match self {
            Self::Pressure => "p",
            Self::Stress(quantity) => symbol(quantity),
        };
        format!("{symbol} / p0")
    }
}

/// The symbol of a scalar of the stress.
pub(super) fn symbol(quantity: Quantity) -> &'static str {
    ["σxx", "σyy", "σzz", "σxy", "σxz", "σyz", "von Mises", "τmax"][quantity.index()]
}
