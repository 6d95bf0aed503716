//! Curves from anywhere: read from a file, and compared with the models and recorded FEM at its own
//! points.

mod beside;
mod between;
mod columns;
mod compared;
mod file;
mod statements;

pub use beside::{Beside, FileRun, GATED, OnPoints};
pub use compared::{Comparison, Limits, UNSTATED_ERROR};
pub use file::{BroughtFile, MAX_BYTES};
pub use statements::{KEYS, Statements, System};
