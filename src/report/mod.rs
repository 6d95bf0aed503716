//! One file per form of output.

pub mod chart;
pub mod plots;
pub mod solution;
pub mod study_files;
pub mod table;

#[cfg(test)]
mod tests;
