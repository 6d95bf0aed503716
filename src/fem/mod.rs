//! Finite elements: the reader of recorded curves, and the driver that runs gmsh and FEniCSx.

mod reference;
mod result;
#[cfg(test)]
mod tests;

pub use reference::{ErrorEstimate, Reference};
pub use result::{FemSummary, LINE_NAMES, MeshResult, check_points, wanted_curves, wanted_lines};
