//! The program as its users meet it, and the files it reads: what runs the built program.

mod bench;
mod cli;
mod corpora;
mod faults;
mod gate;
mod study;
#[path = "../support/mod.rs"]
mod support;
