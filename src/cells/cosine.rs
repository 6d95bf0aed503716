//! The cosine transform of a sequence that is even about its first cell's edge.

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex;
use std::f64::consts::PI;
use std::sync::Arc;

/// Cosine transforms of length m: X_k = sum_i x_i cos(pi k (2 i + 1) / (2 m)) (DCT-II), and back.
///
/// One real transform of the same length does it (Makhoul 1980, IEEE Trans. ASSP 28, 27): with v
/// the even places of x followed by the odd ones backwards and V its transform, X_k = Re(w_k V_k)
/// and X_(m-k) = -Im(w_k V_k), w_k = e^(-i pi k / 2m).
pub(super) struct Cosine {
    length: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    backward: Arc<dyn ComplexToReal<f64>>,
    /// w_k for k up to m/2.
    turns: Vec<Complex<f64>>,
}

/// What one thread works in.
pub(super) struct Scratch {
    /// v.
    line: Vec<f64>,
    /// V.
    half: Vec<Complex<f64>>,
    work: Vec<Complex<f64>>,
}

impl Cosine {
    /// Transforms of length `m` > 0.
    pub(super) fn new(m: usize) -> Self {
        let mut planner = RealFftPlanner::new();
        let turn = |k| Complex::from_polar(1.0, -PI * k as f64 / (2 * m) as f64);
        Self {
            length: m,
            forward: planner.plan_fft_forward(m),
            backward: planner.plan_fft_inverse(m),
            turns: (0..=m / 2).map(turn).collect(),
        }
    }

    /// m.
    pub(super) fn len(&self) -> usize {
        self.length
    }

    pub(super) fn scratch(&self) -> Scratch {
        let work = self.forward.get_scratch_len().max(self.backward.get_scratch_len());
        let zero = Complex::default();
        Scratch {
            line: vec![0.0; self.length],
            half: vec![zero; self.turns.len()],
            work: vec![zero; work],
        }
    }

    /// The transform of `x(i)`, i < `count`, zero beyond; calls `put(k, X_k)` for every k.
    pub(super) fn forward(
        &self,
        scratch: &mut Scratch,
        count: usize,
        x: impl Fn(usize) -> f64,
        mut put: impl FnMut(usize, f64),
    ) {
        self.load(scratch, count, x);
        let m = self.length;
        for (k, (v, w)) in scratch.half.iter().zip(&self.turns).enumerate() {
            let turned = w * v;
            put(k, turned.re);
            if k > 0 && 2 * k < m {
                put(m - k, -turned.im);
            }
        }
    }

    /// m times the sequence that has the transform X(k) = `x(k)`; calls `put(i, x_i)` for i <
    /// `count`.
    pub(super) fn backward(
        &self,
        scratch: &mut Scratch,
        x: impl Fn(usize) -> f64,
        count: usize,
        put: impl FnMut(usize, f64),
    ) {
        let m = self.length;
        for (k, (v, w)) in scratch.half.iter_mut().zip(&self.turns).enumerate() {
            let mirrored = if k == 0 { 0.0 } else { x(m - k) };
            *v = w.conj() * Complex::new(x(k), -mirrored);
        }
        self.unload(scratch, count, put);
    }

    /// Transforms `x(i)`, i < `count`, multiplies X_k with `factors`[k] and transforms back.
    pub(super) fn filter(
        &self,
        scratch: &mut Scratch,
        count: usize,
        x: impl Fn(usize) -> f64,
        factors: &[f64],
        put: impl FnMut(usize, f64),
    ) {
        self.load(scratch, count, x);
        let m = self.length;
        let (low, high) = factors.split_at(1);
        scratch.half[0] *= low[0];
        let pairs = high.iter().zip(high.iter().rev()).zip(&self.turns[1..]);
        for (v, ((own, mirrored), w)) in scratch.half[1..].iter_mut().zip(pairs) {
            let turned = w * *v;
            *v = w.conj() * Complex::new(own * turned.re, mirrored * turned.im);
        }
        debug_assert_eq!(factors.len(), m);
        self.unload(scratch, count, put);
    }

    fn load(&self, scratch: &mut Scratch, count: usize, x: impl Fn(usize) -> f64) {
        let (m, line) = (self.length, &mut scratch.line);
        line.fill(0.0);
        (0..count.div_ceil(2)).for_each(|i| line[i] = x(2 * i));
        (0..count / 2).for_each(|i| line[m - 1 - i] = x(2 * i + 1));
        self.forward
            .process_with_scratch(line, &mut scratch.half, &mut scratch.work)
            .expect("lengths are the plan's");
    }

    fn unload(&self, scratch: &mut Scratch, count: usize, mut put: impl FnMut(usize, f64)) {
        let m = self.length;
        // Real by construction, but for rounding.
        scratch.half[0].im = 0.0;
        if m.is_multiple_of(2) {
            scratch.half[m / 2].im = 0.0;
        }
        self.backward
            .process_with_scratch(&mut scratch.half, &mut scratch.line, &mut scratch.work)
            .expect("lengths are the plan's");
        let line = &scratch.line;
        (0..count.div_ceil(2)).for_each(|i| put(2 * i, line[i]));
        (0..count / 2).for_each(|i| put(2 * i + 1, line[m - 1 - i]));
    }
}

/// The least length for a transform, even and without prime factors above 5, that is not below `n`.
pub(super) fn good_length(n: usize) -> usize {
    let smooth = |mut m: usize| {
        for prime in [2, 3, 5] {
            while m.is_multiple_of(prime) {
                m /= prime;
            }
        }
        m == 1
    };
    (n.max(2)..).find(|&m| m % 2 == 0 && smooth(m)).expect("powers of two have no end")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transforms_are_the_sums_they_stand_for() {
        for m in [1, 2, 5, 6, 10, 16] {
            let cosine = Cosine::new(m);
            let mut scratch = cosine.scratch();
            let count = m - m / 3;
            let x: Vec<f64> = (0..count).map(|i| ((i * i + 1) as f64).sin()).collect();
            let mut spectrum = vec![f64::NAN; m];
            cosine.forward(&mut scratch, count, |i| x[i], |k, v| spectrum[k] = v);
            for (k, got) in spectrum.iter().enumerate() {
                let term = |i: usize| x[i] * (PI * (k * (2 * i + 1)) as f64 / (2 * m) as f64).cos();
                let want: f64 = (0..count).map(term).sum();
                assert!((got - want).abs() < 1e-13, "{m} {k}: {got} {want}");
            }
            let mut back = vec![f64::NAN; m];
            cosine.backward(&mut scratch, |k| spectrum[k], m, |i, v| back[i] = v / m as f64);
            let off = |(i, b): (usize, &f64)| (b - x.get(i).unwrap_or(&0.0)).abs();
            assert!(back.iter().enumerate().map(off).fold(0.0, f64::max) < 1e-14);
            let factors: Vec<f64> = (0..m).map(|k| 1.0 / (1 + k) as f64).collect();
            let mut filtered = vec![f64::NAN; m];
            cosine.filter(&mut scratch, count, |i| x[i], &factors, |i, v| filtered[i] = v);
            let mut wanted = vec![f64::NAN; m];
            cosine.backward(&mut scratch, |k| spectrum[k] * factors[k], m, |i, v| wanted[i] = v);
            for (got, want) in filtered[..count].iter().zip(&wanted) {
                assert!((got - want).abs() < 1e-13, "{m}: {got} {want}");
            }
        }
    }

    #[test]
    fn good_lengths_are_even_and_smooth() {
        assert_eq!([1, 2, 7, 97, 481, 512].map(good_length), [2, 2, 8, 100, 486, 512]);
    }
}
