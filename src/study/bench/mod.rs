//! Run time against error: the models at several tolerances and FEM on several meshes, timed in one
//! run on one machine.
//!
//! There are two references, because neither suffices alone. FEM's finest mesh is independent of
//! the models, but it has an error of its own and different physics (bodies of finite width, no
//! parabola). The quarter-space solution at the tightest tolerance is the limit of the models'
//! discretisation. Equal error is therefore stated twice: each side against its own limit, and both
//! against FEM.
//!
//! Several FEM codes may run. Errors are taken against the finest mesh of the first one, and at
//! each error the fastest mesh of any code is what the models are compared with.

mod point;
mod record;
mod run;
mod speedup;
#[cfg(test)]
mod tests;

pub use point::{Against, BEST, BenchPoint, CURVES, CaseBench, Deviation, Origin, front};
pub use record::{Bench, Machine};
pub use run::{BenchSetup, FemMeshes, Mesh, MeshOf, run};
pub use speedup::{CodeTime, CodeTimes, Speedup, code_times, published_speedups, speedups};
