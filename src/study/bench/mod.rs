//! Run time against error: the models at several tolerances and FEM on several meshes, timed in one
//! run on one machine.
//!
//! Two references are used, since neither serves for everything. FEM's finest mesh is independent
//! of the models, but has an error of its own, and differs from them in physics too (bodies of
//! finite width, no parabola). The quarter-space solution at the tightest tolerance is the limit
//! that the models' discretisation goes to. What "equal error" means is therefore stated twice: each
//! side against its own limit, and the models against FEM.

mod point;
mod record;
mod run;
mod speedup;
#[cfg(test)]
mod tests;

pub use point::{Against, BEST, BenchPoint, CURVES, CaseBench, Deviation, Origin, front};
pub use record::{Bench, Machine};
pub use run::{BenchSetup, FemMeshes, Mesh, run};
pub use speedup::{Speedup, speedups};
