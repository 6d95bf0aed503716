//! Convolutions of fields that are even in x and y, on the quarter x, y > 0 of their cells.

use super::cosine::Cosine;
use super::ends::EndCorrection;
use super::linear::Linear;
use rayon::prelude::*;

/// Lines that a thread transforms one after the other: neighbours share the cache lines that they
/// gather.
pub(super) const LINES: usize = 8;

/// A convolution with a kernel that is even in x and y.
///
/// Padded with zeros to m numbers in a direction, an even field has the period 2 m and the cosine
/// transform X_k, and the convolution multiplies X_k with the kernel's own transform: m numbers in
/// place of 2 m.
pub(super) struct EvenConvolution {
    nx: usize,
    ny: usize,
    along_x: Cosine,
    along_y: Cosine,
    /// As [`super::influence::Table::spectrum`] gives it.
    spectrum: Vec<f64>,
    /// Added to what the kernel does, for each wavenumber in x.
    ends: Option<EndCorrection>,
    /// Transformed along x: for each y all wavenumbers in x.
    waves: Vec<f64>,
    /// The same convolved along y: for each wavenumber in x all y.
    filtered: Vec<f64>,
}

impl EvenConvolution {
    /// On a quarter of `nx` x `ny` cells, padded to `mx` x `my`. `spectrum` has the factors of the
    /// wavenumbers k <= mx in x, for each of them those l <= my in y, and the scale 1 / (mx my) in
    /// them.
    pub(super) fn new(
        [nx, ny]: [usize; 2],
        [mx, my]: [usize; 2],
        spectrum: Vec<f64>,
        ends: Option<EndCorrection>,
    ) -> Self {
        debug_assert_eq!(spectrum.len(), (mx + 1) * (my + 1));
        let (along_x, along_y) = (Cosine::new(mx), Cosine::new(my));
        let (waves, filtered) = (vec![0.0; ny * mx], vec![0.0; mx * ny]);
        Self { nx, ny, along_x, along_y, spectrum, ends, waves, filtered }
    }
}

impl Linear for EvenConvolution {
    fn apply(&mut self, x: &[f64], out: &mut [f64]) {
        let Self { nx, ny, along_x, along_y, spectrum, ends, waves, filtered } = self;
        let (nx, ny, mx, my) = (*nx, *ny, along_x.len(), along_y.len());
        waves.par_chunks_mut(LINES * mx).zip(x.par_chunks(LINES * nx)).for_each_init(
            || along_x.scratch(),
            |scratch, (waves, x)| {
                for (waves, x) in waves.chunks_exact_mut(mx).zip(x.chunks_exact(nx)) {
                    along_x.forward(scratch, nx, |i| x[i], |k, v| waves[k] = v);
                }
            },
        );
        let (waves, ends) = (&*waves, ends.as_ref());
        filtered.par_chunks_mut(LINES * ny).enumerate().for_each_init(
            || along_y.scratch(),
            |scratch, (block, filtered)| {
                for (k, filtered) in (block * LINES..).zip(filtered.chunks_exact_mut(ny)) {
                    let factors = &spectrum[k * (my + 1)..][..my];
                    let wave = |j| waves[j * mx + k];
                    along_y.filter(scratch, ny, wave, factors, |j, v| filtered[j] = v);
                }
                if let Some(ends) = ends {
                    let first = block * LINES;
                    let lines = filtered.len() / ny;
                    ends.add(first, |j| &waves[j * mx + first..][..lines], filtered);
                }
            },
        );
        let filtered = &*filtered;
        out.par_chunks_mut(LINES * nx).enumerate().for_each_init(
            || along_x.scratch(),
            |scratch, (block, out)| {
                for (j, out) in (block * LINES..).zip(out.chunks_exact_mut(nx)) {
                    along_x.backward(scratch, |k| filtered[k * ny + j], nx, |i, v| out[i] = v);
                }
            },
        );
    }
}
