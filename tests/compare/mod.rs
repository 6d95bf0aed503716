//! Comparisons in which a NaN never passes for small.

use edgeline::base::StressTensor;

/// The larger one; a NaN wins.
pub fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// Largest difference of two stresses' components.
pub fn apart(a: &StressTensor, b: &StressTensor) -> f64 {
    let pairs = a.components().into_iter().zip(b.components());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, worse)
}
