//! A finite body's compliance per wavenumber; the four edge models differ only in how they fill it.

pub mod axes;
mod finite;
mod model;
pub mod stencil;

pub use axes::Resolution;
pub use finite::{Body, Layer};
pub use model::EdgeModel;
