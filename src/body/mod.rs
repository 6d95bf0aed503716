//! A finite body's compliance per wavenumber; the four edge models differ only in how they fill it.

mod model;

pub use model::EdgeModel;
