//! What a cell and its images in the end faces displace, and the spectra of these kernels.

use super::grid::Grid;
use super::pressure::CellPressure;
use crate::base::Parity;
use crate::kernels::{deflection, round};
use rayon::prelude::*;
use realfft::RealFftPlanner;
use rustfft::num_complex::Complex;
use std::f64::consts::PI;

/// Distances along the line that differ by less than this part of a cell are one.
const SAME: f64 = 1e-9;

/// A place along y, and the weight of what acts there.
type Shift = (f64, f64);

/// The cell itself.
const ITSELF: Shift = (0.0, 1.0);

/// Images of every cell in the two end faces of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Images {
    /// Half-length H of the body (C): the end faces are H from its middle.
    pub half: f64,
    /// Place y of its middle (C), from that of the cells.
    pub middle: f64,
    /// Weight of an image in the displacement: the body's share of the compliance times psi, Eq.
    /// 3's (1 - nu^2) / E in parts of 1 / E*.
    pub weight: f64,
}

impl Images {
    /// Twice the places of both faces: the image in the face at H of what acts at y' is at 2 H -
    /// y'. Each with the weight.
    fn shifts(&self) -> [Shift; 2] {
        [1.0, -1.0].map(|side| (2.0 * (self.middle + side * self.half), self.weight))
    }

    /// The shifts and weights whose sum is the even or the odd part in y of what a pressure
    /// displaces that is mirrored in y = 0 and shifted to both faces.
    fn parted(&self, parity: Parity) -> [Shift; 4] {
        let [one, other] = self.shifts();
        let own = |(shift, weight): Shift| (shift, 0.5 * weight);
        let opposite = |(shift, weight): Shift| (-shift, 0.5 * parity.sign() * weight);
        [own(one), opposite(one), own(other), opposite(other)]
    }
}

/// What a body's round surface adds to the displacement by every cell and its images.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RoundImages {
    /// The images; the weight is the body's share of the compliance times its C / R.
    pub images: Images,
    /// Poisson's ratio.
    pub nu: f64,
    /// The distance from a force at which the surface is taken not to move (C).
    pub zero: f64,
}

impl RoundImages {
    /// The cell itself.
    fn itself(&self) -> Shift {
        (0.0, self.images.weight)
    }

    /// What is added by a cell of these half-sides at the distance (`x`, `y`) from its centre.
    fn influence(&self, x: f64, y: f64, (a, b): (f64, f64)) -> f64 {
        round::rectangle([x, y], [a, b], self.nu, self.zero)
    }

    /// What is added on the line x = 0, at `y`, by all cells and their images.
    pub fn displacement(&self, cells: &CellPressure, y: f64) -> f64 {
        let grid = &cells.grid;
        let half_sides = grid.half_sides();
        let [one, other] = self.images.shifts().map(|(shift, _)| shift);
        let row = |(j, row): (usize, &[f64])| -> f64 {
            let at = grid.y(j);
            let places = [at, one - at, other - at].map(|place| y - place);
            let all = |x: f64| places.map(|v| self.influence(x, v, half_sides)).iter().sum::<f64>();
            let loaded = row.iter().enumerate().filter(|(_, p)| **p != 0.0);
            loaded.map(|(i, p)| p * all(grid.x(i))).sum()
        };
        let rows: Vec<f64> =
            cells.pressure.par_chunks_exact(grid.nx).enumerate().map(row).collect();
        self.images.weight * rows.iter().sum::<f64>()
    }
}

/// Eq. 3: displacement u at the distance (`x`, `y`) from the centre of a cell of half-sides `a` and
/// `b` under the unit pressure.
pub(super) fn influence(x: f64, y: f64, (a, b): (f64, f64)) -> f64 {
    deflection::rectangle(x, y, a, b) / PI
}

/// Displacements over the distances i 2a, i <= `mx`, and j 2b, j <= `my`, x fastest.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table {
    mx: usize,
    my: usize,
    values: Vec<f64>,
}

impl Table {
    /// The displacement by the cell itself, between bodies of which some are `round`.
    pub(super) fn direct(grid: &Grid, sides: [usize; 2], round: &[RoundImages]) -> Self {
        Self::rounded(grid, sides, &[ITSELF], round, |body| vec![body.itself()])
    }

    /// The part that is even, or odd, in y of the displacements by all images. Without bodies off
    /// the cells' middle there is no odd part.
    pub(super) fn images(
        grid: &Grid,
        sides: [usize; 2],
        images: &[Images],
        round: &[RoundImages],
        parity: Parity,
    ) -> Self {
        let shifts: Vec<_> = images.iter().flat_map(|own| own.parted(parity)).collect();
        Self::rounded(grid, sides, &shifts, round, |body| body.images.parted(parity).to_vec())
    }

    /// The displacement by an even pressure, whose images are shifted only. In one sum, as the cell
    /// and its images share most distances.
    pub(super) fn even(
        grid: &Grid,
        sides: [usize; 2],
        images: &[Images],
        round: &[RoundImages],
    ) -> Self {
        let with = |itself, images: &[Images]| -> Vec<_> {
            let images = images.iter().flat_map(|own| own.parted(Parity::Even));
            [itself].into_iter().chain(images).collect()
        };
        let shifts = with(ITSELF, images);
        Self::rounded(grid, sides, &shifts, round, |body| with(body.itself(), &[body.images]))
    }

    /// The displacement by cells at `shifts`, and what round surfaces add by cells at their `own`.
    fn rounded(
        grid: &Grid,
        sides: [usize; 2],
        shifts: &[Shift],
        round: &[RoundImages],
        own: impl Fn(&RoundImages) -> Vec<Shift>,
    ) -> Self {
        let mut all = Self::sum(grid, sides, shifts, influence);
        for body in round {
            let added = Self::sum(grid, sides, &own(body), |x, y, cell| body.influence(x, y, cell));
            all.values.iter_mut().zip(added.values).for_each(|(sum, own)| *sum += own);
        }
        all
    }

    /// The weighted sum of the influences, by `kernel`, of cells at `shifts` along y.
    fn sum(
        grid: &Grid,
        [mx, my]: [usize; 2],
        shifts: &[Shift],
        kernel: impl Fn(f64, f64, (f64, f64)) -> f64 + Sync,
    ) -> Self {
        let (a, b) = grid.half_sides();
        let place = |j: usize, shift: f64| (2.0 * b * j as f64 - shift).abs();
        // Images of bodies that are whole numbers of cells long share most distances.
        let mut places: Vec<f64> =
            (0..=my).flat_map(|j| shifts.iter().map(move |s| place(j, s.0))).collect();
        places.sort_by(f64::total_cmp);
        places.dedup_by(|next, kept| *next - *kept < SAME * b);
        let row = |y: &f64| -> Vec<f64> {
            (0..=mx).map(|i| kernel(2.0 * a * i as f64, *y, (a, b))).collect()
        };
        let rows: Vec<Vec<f64>> = places.par_iter().map(row).collect();
        let mut values = vec![0.0; (mx + 1) * (my + 1)];
        for (j, sum) in values.chunks_exact_mut(mx + 1).enumerate() {
            for &(shift, weight) in shifts {
                let y = place(j, shift);
                let row = &rows[places.partition_point(|p| *p + SAME * b <= y).min(rows.len() - 1)];
                sum.iter_mut().zip(row).for_each(|(sum, f)| *sum += weight * f);
            }
        }
        Self { mx, my, values }
    }

    /// The transform of the table continued to the periods 2 mx and 2 my, times `scale`: evenly in
    /// x, in y with its own `parity`. It has that parity too; that of an odd table is imaginary,
    /// and this its imaginary part. For each wavenumber k <= mx in x those l <= my in y.
    pub(super) fn spectrum(&self, parity: Parity, scale: f64) -> Vec<f64> {
        let (nx, ny) = (self.mx + 1, self.my + 1);
        let mut along_x = self.values.clone();
        along_x
            .par_chunks_mut(nx)
            .for_each_init(|| HalfTransform::new(self.mx), |t, row| t.even(row));
        let mut spectrum = vec![0.0; nx * ny];
        spectrum.par_chunks_mut(ny).enumerate().for_each_init(
            || HalfTransform::new(self.my),
            |transform, (k, row)| {
                row.iter_mut().enumerate().for_each(|(j, v)| *v = scale * along_x[j * nx + k]);
                match parity {
                    Parity::Even => transform.even(row),
                    Parity::Odd => transform.odd(row),
                }
            },
        );
        spectrum
    }
}

/// The transforms of real sequences x_0 to x_m that are continued to the period 2 m.
pub(super) struct HalfTransform {
    plan: std::sync::Arc<dyn realfft::RealToComplex<f64>>,
    period: Vec<f64>,
    spectrum: Vec<Complex<f64>>,
    work: Vec<Complex<f64>>,
}

impl HalfTransform {
    /// Of sequences up to x_m.
    pub(super) fn new(m: usize) -> Self {
        let plan = RealFftPlanner::new().plan_fft_forward(2 * m);
        let (period, spectrum, work) =
            (plan.make_input_vec(), plan.make_output_vec(), plan.make_scratch_vec());
        Self { plan, period, spectrum, work }
    }

    /// The transform of `x` continued evenly (DCT-I), in place.
    pub(super) fn even(&mut self, x: &mut [f64]) {
        self.transform(x, 1.0);
        x.iter_mut().zip(&self.spectrum).for_each(|(x, s)| *x = s.re);
    }

    /// The imaginary part of the transform of `x` continued oddly (DST-I), in place; x_0 and x_m
    /// count as zero.
    pub(super) fn odd(&mut self, x: &mut [f64]) {
        let m = x.len() - 1;
        (x[0], x[m]) = (0.0, 0.0);
        self.transform(x, -1.0);
        x.iter_mut().zip(&self.spectrum).for_each(|(x, s)| *x = s.im);
    }

    fn transform(&mut self, x: &[f64], sign: f64) {
        let m = x.len() - 1;
        self.period[..=m].copy_from_slice(x);
        (1..m).for_each(|i| self.period[2 * m - i] = sign * x[i]);
        self.plan
            .process_with_scratch(&mut self.period, &mut self.spectrum, &mut self.work)
            .expect("lengths are the plan's");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_are_where_the_faces_put_them() {
        let grid = Grid::new(4, 6, 1.2, 3.0).unwrap();
        let cell = grid.half_sides();
        // One body whose ends are the contact's, one that is not a whole number of cells long.
        let images = [
            Images { half: 3.0, middle: 0.0, weight: 0.7 },
            Images { half: 4.17, middle: 0.4, weight: 0.6 },
        ];
        let [even, odd] =
            Parity::BOTH.map(|parity| Table::images(&grid, [4, 6], &images, &[], parity));
        for (i, j, k) in [(0, 0, 0), (3, 2, 5), (1, 5, 5)] {
            // From (x, y) = cell (0, k) to cell (i, j).
            let (x, y, from) = (grid.x(i) - grid.x(0), grid.y(j), grid.y(k));
            let image = |i: &Images| {
                let face = |h: f64| influence(x, y - (2.0 * (i.middle + h) - from), cell);
                i.weight * (face(i.half) + face(-i.half))
            };
            let want: f64 = images.iter().map(image).sum();
            // Mirrored in y = 0 it is at -from, in cell ny - 1 - k.
            let mirrored = grid.ny - 1 - k;
            let (at, sign) = (j.abs_diff(mirrored) * 5 + i, if j < mirrored { -1.0 } else { 1.0 });
            let got = even.values[at] + sign * odd.values[at];
            assert!((got / want - 1.0).abs() < 1e-13, "{got} {want}");
        }
        let both = Table::even(&grid, [4, 6], &images, &[]);
        let direct = influence(grid.x(3) - grid.x(0), grid.y(4) - grid.y(0), cell);
        let want = direct + even.values[4 * 5 + 3];
        assert!((both.values[4 * 5 + 3] / want - 1.0).abs() < 1e-14);
    }
}
