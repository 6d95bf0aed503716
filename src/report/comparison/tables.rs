//! The tables of a comparison.

use crate::report::brought::{of_curves, of_errors, of_pressure};
use crate::report::table::to_csv;
use crate::study::brought::Comparison;

/// `errors.csv`, `curves.csv` and `pressure.csv`.
pub(super) fn tables(comparison: &Comparison) -> [(String, String); 3] {
    let Comparison { files, range, .. } = comparison;
    [
        ("errors.csv", to_csv(&of_errors(files), range)),
        ("curves.csv", to_csv(&of_curves(files), range)),
        ("pressure.csv", to_csv(&of_pressure(files), range)),
    ]
    .map(|(name, text)| (name.to_string(), text))
}
