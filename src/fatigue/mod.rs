//! Measures of fatigue of the history of stresses that a point of a material goes through.

mod ball;
mod measures;

pub use ball::{Ball, smallest_ball};
pub use measures::{
    Extreme, Measures, Parameters, Plane, dang_van, fatemi_socie, largest, shear_amplitude,
    shear_range,
};
