//! Fractions of p0 as text.

use crate::base::number::{fixed, significant};

/// The least number that is told from zero: below it lies what rounding leaves.
const ROUNDING: f64 = 1e-9;

/// Four digits after the point; one significant digit for smaller numbers.
pub fn fraction(v: f64) -> String {
    if (ROUNDING..5e-5).contains(&v.abs()) { significant(v, 1) } else { fixed(v, 4) }
}

#[cfg(test)]
mod tests {
    use super::fraction;

    #[test]
    fn small_numbers_are_told_from_zero_and_rounding_is_not() {
        let said = [0.02267, -2e-5, 6e-11, -3e-10, 0.0].map(fraction);
        assert_eq!(said, ["0.0227", "-2e-5", "0.0000", "0.0000", "0.0000"]);
    }
}
