//! `report.html` and `report.md`, from the files of a run.

mod effects;
mod errors;
mod explorer;
mod fem;
mod render;
mod solves;
mod times;
mod write;

pub use render::{html, markdown};
pub use write::{write, write_run};
