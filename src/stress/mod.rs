//! Stresses at points, standard curves, critical points.

pub mod curves;

pub use curves::{BodyKind, CurveSpec};
