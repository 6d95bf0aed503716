//! Fractions of p0 as text.

use crate::base::number::{fixed, significant};

/// Four digits after the point; one significant digit for smaller numbers.
pub fn fraction(v: f64) -> String {
    if v != 0.0 && v.abs() < 5e-5 { significant(v, 1) } else { fixed(v, 4) }
}
