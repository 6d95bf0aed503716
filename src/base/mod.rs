//! Materials, Hertz scales, the stress tensor, graded axes, wavenumbers, quadrature, whole files, locked folders,
//! limits of memory and the error type.

mod error;
mod files;
pub mod linear;
mod lock;
mod material;
mod memory;
mod panels;
mod quadrature;
mod scales;
mod tensor;
mod wavenumbers;

pub use error::{Error, Result};
pub use files::{prepare_folder, read_text, remove_if_there, write_set, write_whole};
pub use lock::Lock;
pub use material::Material;
pub use memory::check_memory;
pub use panels::Panels;
pub use quadrature::gauss_legendre;
pub use scales::HertzScales;
pub use tensor::StressTensor;
pub use wavenumbers::Wavenumbers;
