//! The plots of a study, from the files of its run.

mod all;
mod case;
mod effects;
mod symbol;
mod times;

pub use all::{all, named};
pub use symbol::Shown;
