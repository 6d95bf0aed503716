//! The numerics: what needs the library alone.

mod analytic;
mod common;
mod ends;
mod imports;
mod layering;
mod scenes;
mod verification;
