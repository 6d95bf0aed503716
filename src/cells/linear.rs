//! What the solver needs to know of an operator.

/// A linear map of fields over the cells.
pub(super) trait Linear {
    /// Writes what `x` is mapped to into `out`, of the same length. Does not depend on the number
    /// of threads.
    fn apply(&mut self, x: &[f64], out: &mut [f64]);
}
