//! Closed forms only: pure functions, no allocation.

pub mod bessel;
pub mod plate;
pub mod strip;
pub mod wave;
