//! Even and odd parts of what a body that is symmetric about its middle plane carries.

/// The part of a load, or of a field, that is even or odd in y about a body's middle plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Parity {
    /// Alike on both sides.
    Even,
    /// Of the other sign on the other side.
    Odd,
}

impl Parity {
    /// Both parts.
    pub const BOTH: [Parity; 2] = [Parity::Even, Parity::Odd];

    /// The factor of the other side: 1 or -1.
    pub fn sign(self) -> f64 {
        match self {
            Parity::Even => 1.0,
            Parity::Odd => -1.0,
        }
    }
}
