//! Closed forms as pure functions, and tables of those that are evaluated often.

pub mod bessel;
mod bessel_j;
pub mod bessel_table;
pub mod boussinesq;
pub mod corners;
pub mod deflection;
pub mod hertz;
pub mod line_load;
pub mod love;
pub mod patches;
pub mod plate;
pub mod round;
pub mod strip;
pub mod wave;
