//! One file per form of output.

pub mod solution;
