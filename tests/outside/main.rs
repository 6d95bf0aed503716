//! The program with external tools: finite elements, a browser, VTK, Cargo.

mod browser;
mod calculix;
mod chromium;
mod explore;
mod fem;
mod field;
mod supply;
#[path = "../support/mod.rs"]
mod support;
