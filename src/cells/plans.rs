//! Plans of the transforms of padded fields.

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

/// Plans of two-dimensional transforms of real fields: real ones along x, complex ones along y.
pub(super) struct Plans {
    pub(super) forward_x: Arc<dyn RealToComplex<f64>>,
    pub(super) backward_x: Arc<dyn ComplexToReal<f64>>,
    pub(super) forward_y: Arc<dyn Fft<f64>>,
    pub(super) backward_y: Arc<dyn Fft<f64>>,
}

impl Plans {
    /// Plans for the periods `px` in x and `py` in y.
    pub(super) fn new([px, py]: [usize; 2]) -> Self {
        let (mut real, mut complex) = (RealFftPlanner::new(), FftPlanner::new());
        Self {
            forward_x: real.plan_fft_forward(px),
            backward_x: real.plan_fft_inverse(px),
            forward_y: complex.plan_fft_forward(py),
            backward_y: complex.plan_fft_inverse(py),
        }
    }
}
