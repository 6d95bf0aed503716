//! Stresses at points, on standard curves and at critical points.

pub mod curves;
pub mod field;
pub mod grid;
mod pressure;
pub mod round;
mod waves;

pub use crate::base::BodyKind;
pub use curves::CurveSpec;
pub use field::{Field, Work};
pub use grid::{Grid, GridStress};
pub use pressure::Pressure;
pub use round::RoundStress;
