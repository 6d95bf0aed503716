//! Tests of the numerics, which need the library alone.

mod analytic;
mod approached;
mod benchmarks;
mod cells;
mod common;
mod eccentric;
mod ends;
mod fields;
mod first_order;
mod imports;
mod layering;
mod profiles;
mod real_scenes;
mod refinement;
mod scenes;
mod sliding;
mod verification;
