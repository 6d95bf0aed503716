//! Tests that run the program.

mod bench;
mod brought;
mod cli;
mod compare;
mod corpora;
mod design;
mod docs;
mod explore;
mod fatigue;
mod faults;
mod gate;
mod recorded;
mod study;
#[path = "../support/mod.rs"]
mod support;
mod sweep;
