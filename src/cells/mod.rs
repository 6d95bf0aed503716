//! Contact on uniform cells of constant pressure.
//!
//! The method of the study that the package reproduces, as published: a flexibility matrix by Eqs.
//! 2 and 3 with each cell's images in the end faces, a contact iteration, stresses by Love's sums
//! (Eqs. 4 to 10). Any gap may be asked for; the accuracy is the grid's.
//!
//! # Conventions
//!
//! - Lengths are in units of C, pressures and stresses of p0, displacements and gaps of
//!   C^2 / (2 R).
//! - Cells are 2a x 2b and fill |x| <= X, |y| <= S: centres x_i = (2 i + 1) a - X,
//!   y_j = (2 j + 1) b - S.
//!   Fields over the grid have x as the index that runs fastest: cell (i, j) is at j nx + i.
//! - The displacement is u = (1/pi) sum f p, f of [`crate::kernels::deflection`], with the shares
//!   of the two bodies in the compliance adding up to one.
//! - A symmetric contact is solved on the quarter x, y > 0, whose cells are the whole grid's.
//! - Transforms carry no scale forwards; the spectra of the kernels hold the scale of both ways.
//!   Sequences are padded with zeros to at least twice the grid, so that nothing wraps around.

mod columns;
mod convolution;
mod cosine;
mod end_stress;
mod ends;
mod field;
mod grid;
mod heights;
mod heights_file;
mod influence;
mod layer;
mod linear;
mod means;
mod plans;
mod pressure;
mod problem;
mod profile;
mod solver;
mod whole;
#[cfg(feature = "cli")]
mod x3p;

pub use columns::Columns;
pub use end_stress::{EndLoads, EndStress};
pub use ends::{FreeBody, FreeEnds};
pub use field::{CellField, FieldEnd};
pub use grid::Grid;
pub use heights::{Detrend, Heights, RoughGap};
pub use influence::Images;
pub use layer::{Layer, add_ends, layer};
pub use pressure::CellPressure;
pub(crate) use problem::WIDER;
pub use problem::{CellProblem, CellTilt};
