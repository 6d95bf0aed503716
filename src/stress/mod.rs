//! Stresses at points, on standard curves and at critical points, and the form of results on them.

mod answer;
mod body_field;
mod critical;
pub mod curves;
mod far;
pub mod field;
mod flat;
pub mod grid;
mod load;
mod pressure;
mod quantity;
pub mod round;
mod skin;
mod slow_change;
mod target;
mod waves;
mod work;

pub use crate::base::BodyKind;
pub use answer::{Curves, PressureLine, StressCurve};
pub use body_field::BodyField;
pub use critical::{Critical, EDGE, away_from_edge, away_from_edges};
pub use curves::{CurveSpec, Span};
pub use field::Field;
pub use flat::FlatStress;
pub use grid::{Grid, GridStress};
pub use load::{Load, Traction};
pub use pressure::{LineLoad, Pressure};
pub use quantity::{Quantity, Variable};
pub use round::RoundStress;
pub use slow_change::SlowChange;
pub use work::Work;
