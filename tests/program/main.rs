//! Tests that run the program.

mod bench;
mod cli;
mod corpora;
mod faults;
mod gate;
mod study;
#[path = "../support/mod.rs"]
mod support;
