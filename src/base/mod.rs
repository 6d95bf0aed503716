//! Materials, Hertz scales, the stress tensor, graded axes, wavenumbers, quadrature and the error type.

mod error;
pub mod linear;
mod material;
mod panels;
mod quadrature;
mod scales;
mod tensor;
mod wavenumbers;

pub use error::{Error, Result};
pub use material::Material;
pub use panels::Panels;
pub use quadrature::gauss_legendre;
pub use scales::HertzScales;
pub use tensor::StressTensor;
pub use wavenumbers::Wavenumbers;
