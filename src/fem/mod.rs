//! Finite elements: the reader of recorded curves, and the driver that runs gmsh and a code.

mod code;
mod driver;
mod jit_cache;
mod reference;
mod request;
mod result;
mod settings;
mod sum;
#[cfg(test)]
mod tests;
pub mod tools;

pub use code::Code;
pub use driver::{DECK_FILES, Driver};
pub use reference::{ErrorEstimate, FemResults};
pub use result::{
    FemSummary, LINE_NAMES, MeshResult, MeshSummary, ResultTexts, check_points, wanted_curves,
    wanted_lines,
};
pub use settings::{FemSettings, LinearSolver};
