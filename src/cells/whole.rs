//! Convolutions of fields without symmetry, with their mirror images in y, and what free ends add.

use super::convolution::LINES;
use super::ends::EndCorrection;
use super::linear::Linear;
use super::plans::Plans;
use rayon::prelude::*;
use rustfft::num_complex::Complex;
use std::f64::consts::PI;

/// u = K * p + M * p', p' the field p mirrored in y = 0, for kernels K and M that are even in x, K
/// in y too. One transform of p serves both: p' has the coefficient of the opposite wavenumber in
/// y, turned by the phase of the mirror.
pub(super) struct WholeConvolution {
    nx: usize,
    ny: usize,
    /// Half the padded periods.
    half: [usize; 2],
    plans: Plans,
    /// Of K, and of the even and the odd part of M, as [`super::influence::Table::spectrum`] gives
    /// them.
    direct: Vec<f64>,
    images: Vec<f64>,
    odd_images: Vec<f64>,
    /// Added to what the kernels do, for each wavenumber in x.
    ends: Option<EndCorrection>,
    /// e^(-2 pi i l (ny - 1) / period): the mirror of cell j is cell ny - 1 - j.
    mirror: Vec<Complex<f64>>,
    waves: Vec<Complex<f64>>,
    filtered: Vec<Complex<f64>>,
}

impl WholeConvolution {
    /// On `nx` x `ny` cells, padded to the periods 2 `mx` and 2 `my`. `direct` and the even and the
    /// odd part of `images` have the factors of the wavenumbers k <= mx in x, for each of them
    /// those l <= my in y, and the scale 1 / (4 mx my) in them; what is zero is empty.
    pub(super) fn new(
        [nx, ny]: [usize; 2],
        [mx, my]: [usize; 2],
        direct: Vec<f64>,
        [images, odd_images]: [Vec<f64>; 2],
        ends: Option<EndCorrection>,
    ) -> Self {
        let turn = |l| {
            let turns = (l * (ny - 1)) % (2 * my);
            Complex::from_polar(1.0, -PI * turns as f64 / my as f64)
        };
        let zero = Complex::default();
        Self {
            nx,
            ny,
            half: [mx, my],
            plans: Plans::new([2 * mx, 2 * my]),
            direct,
            images,
            odd_images,
            ends,
            mirror: (0..2 * my).map(turn).collect(),
            waves: vec![zero; ny * (mx + 1)],
            filtered: vec![zero; (mx + 1) * ny],
        }
    }

    /// Convolves the transform along y of wavenumber `k` in x, in place.
    fn filter(&self, k: usize, transform: &mut [Complex<f64>]) {
        let my = self.half[1];
        let row = k * (my + 1)..(k + 1) * (my + 1);
        let direct = &self.direct[row.clone()];
        if self.images.is_empty() {
            let (low, high) = transform.split_at_mut(my + 1);
            low.iter_mut().zip(direct).for_each(|(v, d)| *v *= d);
            high.iter_mut().rev().zip(&direct[1..]).for_each(|(v, d)| *v *= d);
            return;
        }
        let (images, odd) = (&self.images[row.clone()], self.odd_images.get(row));
        for l in 0..=my {
            let opposite = (2 * my - l) % (2 * my);
            let (own, other) = (transform[l], transform[opposite]);
            let [to_own, to_other] =
                [(l, other), (opposite, own)].map(|(l, mirrored)| self.mirror[l] * mirrored);
            let factor = Complex::new(images[l], odd.map_or(0.0, |odd| odd[l]));
            transform[opposite] = direct[l] * other + factor.conj() * to_other;
            transform[l] = direct[l] * own + factor * to_own;
        }
    }
}

impl Linear for WholeConvolution {
    fn apply(&mut self, x: &[f64], out: &mut [f64]) {
        let (nx, ny, [mx, my]) = (self.nx, self.ny, self.half);
        let count = mx + 1;
        let zero = Complex::default();
        let mut waves = std::mem::take(&mut self.waves);
        let mut filtered = std::mem::take(&mut self.filtered);
        let this = &*self;
        waves.par_chunks_mut(count).zip(x.par_chunks(nx)).for_each_init(
            || (this.plans.forward_x.make_input_vec(), this.plans.forward_x.make_scratch_vec()),
            |(line, work), (waves, x)| {
                line[..nx].copy_from_slice(x);
                line[nx..].fill(0.0);
                let done = this.plans.forward_x.process_with_scratch(line, waves, work);
                done.expect("lengths are the plan's");
            },
        );
        filtered.par_chunks_mut(LINES * ny).enumerate().for_each_init(
            || {
                let (forward, backward) = (&this.plans.forward_y, &this.plans.backward_y);
                let work =
                    forward.get_inplace_scratch_len().max(backward.get_inplace_scratch_len());
                (vec![zero; 2 * my], vec![zero; work])
            },
            |(line, work), (block, filtered)| {
                for (k, filtered) in (block * LINES..).zip(filtered.chunks_exact_mut(ny)) {
                    (0..ny).for_each(|j| line[j] = waves[j * count + k]);
                    line[ny..].fill(zero);
                    this.plans.forward_y.process_with_scratch(line, work);
                    this.filter(k, line);
                    this.plans.backward_y.process_with_scratch(line, work);
                    filtered.copy_from_slice(&line[..ny]);
                }
                if let Some(ends) = &this.ends {
                    let first = block * LINES;
                    let lines = filtered.len() / ny;
                    ends.add(first, |j| &waves[j * count + first..][..lines], filtered);
                }
            },
        );
        out.par_chunks_mut(LINES * nx).enumerate().for_each_init(
            || {
                let backward = &this.plans.backward_x;
                let vectors = (backward.make_input_vec(), backward.make_output_vec());
                (vectors, backward.make_scratch_vec())
            },
            |((wave, line), work), (block, out)| {
                for (j, out) in (block * LINES..).zip(out.chunks_exact_mut(nx)) {
                    (0..count).for_each(|k| wave[k] = filtered[k * ny + j]);
                    // Real by construction, but for rounding.
                    wave[0].im = 0.0;
                    wave[mx].im = 0.0;
                    let done = this.plans.backward_x.process_with_scratch(wave, line, work);
                    done.expect("lengths are the plan's");
                    out.copy_from_slice(&line[..nx]);
                }
            },
        );
        (self.waves, self.filtered) = (waves, filtered);
    }
}
