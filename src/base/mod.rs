//! Materials, Hertz scales, the stress tensor, quadrature and the error type.

mod error;
mod material;
mod scales;
mod tensor;

pub use error::{Error, Result};
pub use material::Material;
pub use scales::HertzScales;
pub use tensor::StressTensor;
