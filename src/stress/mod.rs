//! Stresses at points, on standard curves and at critical points, and the form of results on them.

mod answer;
mod critical;
pub mod curves;
pub mod field;
pub mod grid;
mod load;
mod pressure;
mod quantity;
pub mod round;
mod waves;

pub use crate::base::BodyKind;
pub use answer::{Curves, PressureLine, StressCurve};
pub use critical::{Critical, EDGE, away_from_edge};
pub use curves::CurveSpec;
pub use field::{Field, Work};
pub use grid::{Grid, GridStress};
pub use load::Load;
pub use pressure::Pressure;
pub use quantity::Quantity;
pub use round::RoundStress;
