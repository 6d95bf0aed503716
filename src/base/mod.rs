//! Materials, Hertz scales, profiles, the stress tensor, graded axes, wavenumbers, quadrature,
//! splines, the error type, and numbers as text.

mod bodies;
mod error;
pub mod linear;
mod material;
pub(crate) mod number;
mod panels;
mod parity;
pub mod profile;
mod quadrature;
mod samples;
mod scales;
mod secants;
mod spline;
pub mod stop;
mod tensor;
mod wavenumbers;

pub use bodies::{BodyKind, PerBody, ledge};
pub(crate) use error::worse;
pub use error::{Error, Result};
pub use material::Material;
pub use panels::{Corner, Growth, Panels};
pub use parity::Parity;
pub use profile::{Kink, Profile};
pub use quadrature::{crowded_legendre, gauss_legendre};
pub use samples::Samples;
pub use scales::HertzScales;
pub(crate) use secants::Secants;
pub use spline::spline;
pub use tensor::StressTensor;
pub use wavenumbers::Wavenumbers;
