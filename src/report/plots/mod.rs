//! The plots of a study, from the files of its run, and those of one solution.

mod all;
mod case;
mod effects;
mod origin;
mod solution;
mod symbol;
mod times;

pub use all::{all, named};
pub use origin::{PROGRAM, origin};
pub use solution::of_solution;
pub use symbol::{in_p0, symbol_of};
