//! The command line: one file a subcommand, and one for each thing that several of them need.

mod bench;
mod brought;
mod cases;
mod cold;
mod compare;
mod deck;
mod design;
mod doctor;
mod explore;
mod extras;
mod fatigue;
mod fem;
mod fem_options;
mod gate;
mod output;
pub mod points;
mod program;
mod progress;
mod provenance;
mod published;
mod records;
mod reference;
mod report;
mod solve;
mod study;
mod study_options;
mod sweep;
mod uncertain_options;
pub mod values;

pub use program::run;
