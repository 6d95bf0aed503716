//! Finite elements: the reader of recorded curves, and the driver that runs gmsh and FEniCSx.

mod driver;
mod jit_cache;
mod reference;
mod request;
mod result;
mod sum;
#[cfg(test)]
mod tests;
pub mod tools;

pub use driver::{Driver, FemSettings, LinearSolver, check_shape};
pub use reference::{ErrorEstimate, FemResults};
pub use result::{
    FemSummary, LINE_NAMES, MeshResult, MeshSummary, ResultTexts, check_points, wanted_curves,
    wanted_lines,
};
