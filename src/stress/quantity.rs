//! The scalars of a stress that are compared and drawn.

use crate::base::StressTensor;

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
