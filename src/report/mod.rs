//! The files that the program writes.

pub mod bench;
pub mod brought;
pub mod cells;
pub mod columns;
pub mod comparison;
pub mod design;
pub mod draw;
pub mod effects_text;
pub mod fatigue;
pub mod field;
pub mod fraction;
pub mod gates;
pub mod page;
pub mod plots;
pub mod solution;
pub mod study_files;
pub mod study_rows;
pub mod study_summary;
pub mod summarise;
pub mod sweep;
#[cfg(feature = "parquet")]
mod sweep_parquet;
pub mod sweep_target;
pub mod table;
mod tables;
pub mod uncertainty;
pub mod verdict;
mod vtk;

#[cfg(test)]
mod tests;
