//! One file per form of output.

pub mod chart;
pub mod gates;
pub mod page;
pub mod plots;
pub mod solution;
pub mod study_files;
pub mod table;
mod verdict;

#[cfg(test)]
mod tests;
