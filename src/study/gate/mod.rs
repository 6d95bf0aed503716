//! Accuracy gates: limits for the numbers of a study, and the drift from the numbers that were
//! accepted last.
//!
//! A gate takes the worst of all numbers that it selects. A gate that selects nothing fails: a
//! wrong filter must not look like a pass. Each built-in study has thresholds of its own.

mod accepted;
mod evaluate;
mod number;
mod outcome;
mod thresholds;

pub use accepted::{Baseline, Change};
pub use evaluate::evaluate;
pub use number::{Number, NumberOf, Whole, numbers, of_errors};
pub use outcome::{GateOutcome, Kind};
pub use thresholds::{Drift, Gate, Gates, Selected, parse};

#[cfg(test)]
mod tests;
