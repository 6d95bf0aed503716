//! Stresses at points, standard curves, critical points.

pub mod curves;
pub mod field;
pub mod grid;

pub use curves::{BodyKind, CurveSpec};
pub use field::{Field, Pressure, Work};
pub use grid::{Grid, GridStress};
