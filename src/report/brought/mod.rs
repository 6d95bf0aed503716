//! Brought curves in files: tables, summary and plots, of a comparison and of a study.

mod plots;
mod rows;
mod study;
mod summary;

pub use plots::{Plots, plain};
pub use rows::{Of, of_curves, of_errors, of_pressure};
pub use study::{FileCurves, of_case};
pub use summary::{FileSummary, SourceErrors, Worst};
