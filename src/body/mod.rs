//! A finite body's compliance per wavenumber; the four edge models, one file each, differ only in
//! their [`End`].

pub mod axes;
mod contact_line;
mod corner;
mod end;
mod finite;
mod fold;
mod guilbault;
mod half_space;
mod long_waves;
mod mirror;
mod model;
mod part;
mod quarter_space;
mod skin;
mod skin_waves;
mod stack;
pub mod stencil;

pub use axes::Resolution;
pub use contact_line::Generatrix;
pub use corner::corner_exponent;
pub use end::End;
pub use finite::{Body, FreeEnds, Layer, Shape};
pub use fold::Fold;
pub use guilbault::{GAMMA, guilbault_psi, transition};
pub use model::EdgeModel;
pub use part::Part;
pub use skin::{SkinLine, Skins};
pub use skin_waves::Skin;
pub use stack::{LoadedLine, Placed, Stack};
