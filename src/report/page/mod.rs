//! `report.html` and `report.md`, from the files of a run, and the page of one solution.

mod effects;
mod errors;
mod explorer;
mod fem;
mod render;
mod solution;
mod solves;
mod times;
mod verification;
mod write;

pub use render::{fill, html, markdown};
pub use solution::{Label, of_solution};
pub use write::{NAMES, write, write_run};
