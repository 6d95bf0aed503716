//! Stresses under all cells at one depth, by transforms.
//!
//! Love's stresses of a cell at the distances of all others are a kernel; with the pressures, and
//! with those mirrored in y = 0 for the images, they make a convolution for each of the six
//! components. Of a cell's stresses xy and xz change their sign with x, xy and yz with y.

use super::cosine::good_length;
use super::end_stress::EndStress;
use super::field::{CellField, FieldEnd};
use super::grid::Grid;
use super::plans::Plans;
use super::pressure::CellPressure;
use crate::base::{Panels, StressTensor};
use crate::body::transition;
use crate::kernels::love;
use rayon::prelude::*;
use rustfft::num_complex::Complex;

/// The six components (p0) under every cell, x fastest: xx, yy, zz, xy, xz, yz.
pub type Layer = [Vec<f64>; 6];

/// Two-dimensional transforms of fields over a grid, padded with zeros to twice its size.
struct Padded {
    nx: usize,
    ny: usize,
    /// Periods in x and y.
    periods: [usize; 2],
    plans: Plans,
}

impl Padded {
    fn new(grid: &Grid) -> Self {
        let periods = [grid.nx, grid.ny].map(|n| 2 * good_length(n));
        Self { nx: grid.nx, ny: grid.ny, periods, plans: Plans::new(periods) }
    }

    /// The transform of the field with the rows `row(j)` of each j < period, none where it is zero:
    /// for each wavenumber in x all those in y.
    fn forward(&self, row: impl Fn(usize, &mut [f64]) -> bool + Sync) -> Vec<Complex<f64>> {
        let [px, py] = self.periods;
        let count = px / 2 + 1;
        let mut rows = vec![Complex::default(); py * count];
        rows.par_chunks_mut(count).enumerate().for_each(|(j, out)| {
            let mut line = vec![0.0; px];
            if row(j, &mut line) {
                self.plans.forward_x.process(&mut line, out).expect("lengths are the plan's");
            }
        });
        let mut all = vec![Complex::default(); count * py];
        all.par_chunks_mut(py).enumerate().for_each(|(k, line)| {
            line.iter_mut().enumerate().for_each(|(j, v)| *v = rows[j * count + k]);
            self.plans.forward_y.process(line);
        });
        all
    }

    /// The field over the grid that has this transform.
    fn backward(&self, mut all: Vec<Complex<f64>>) -> Vec<f64> {
        let [px, py] = self.periods;
        all.par_chunks_mut(py).for_each(|line| self.plans.backward_y.process(line));
        let scale = 1.0 / (px * py) as f64;
        let mut field = vec![0.0; self.nx * self.ny];
        field.par_chunks_mut(self.nx).enumerate().for_each(|(j, out)| {
            let mut wave: Vec<_> = (0..=px / 2).map(|k| all[k * py + j]).collect();
            // Real by construction, but for rounding.
            (wave[0].im, wave[px / 2].im) = (0.0, 0.0);
            let mut line = vec![0.0; px];
            self.plans.backward_x.process(&mut wave, &mut line).expect("lengths are the plan's");
            out.iter_mut().zip(line).for_each(|(out, v)| *out = scale * v);
        });
        field
    }

    /// The transform of pressures.
    fn pressure(&self, pressure: &[f64], mirrored: bool) -> Vec<Complex<f64>> {
        self.forward(|j, line| {
            if j >= self.ny {
                return false;
            }
            let from = if mirrored { self.ny - 1 - j } else { j };
            line[..self.nx].copy_from_slice(&pressure[from * self.nx..][..self.nx]);
            true
        })
    }

    /// The transform of component `c` of a kernel given for the distances 0 to nx - 1 in x and 1 -
    /// ny to ny - 1 in y.
    fn kernel(&self, rows: &[Vec<StressTensor>], c: usize) -> Vec<Complex<f64>> {
        let ([px, py], ny) = (self.periods, self.ny);
        let sign = if StressTensor::ODD_IN_X[c] { -1.0 } else { 1.0 };
        self.forward(|j, line| {
            let apart = match j {
                j if j < ny => j + ny - 1,
                j if j + ny > py => j + ny - 1 - py,
                _ => return false,
            };
            for (i, stress) in rows[apart].iter().enumerate() {
                let value = stress.components()[c];
                line[i] = value;
                if i > 0 {
                    line[px - i] = sign * value;
                }
            }
            true
        })
    }
}

/// Love's stresses at the depth `z` of a cell under the unit pressure, at the distances of
/// [`Padded::kernel`], summed over cells at `shifts` along y.
fn kernel(grid: &Grid, nu: f64, z: f64, shifts: &[f64]) -> Vec<Vec<StressTensor>> {
    let (a, b) = grid.half_sides();
    let row = |j: usize| {
        let y = 2.0 * b * (j as f64 - (grid.ny - 1) as f64);
        let at = |i: usize| {
            let x = 2.0 * a * i as f64;
            shifts.iter().map(|shift| love::stress(x, y - shift, z, a, b, nu)).sum()
        };
        (0..grid.nx).map(at).collect()
    };
    (0..2 * grid.ny - 1).into_par_iter().map(row).collect()
}

/// The stresses of a body with Poisson's ratio `nu` at the depth `z` (C) under each cell: sums of
/// Love's over cells and images, with the correction of [`CellField::at`].
pub fn layer(cells: &CellPressure, end: FieldEnd, nu: f64, z: f64) -> Layer {
    let grid = &cells.grid;
    let plan = Padded::new(grid);
    let mut parts = vec![(plan.pressure(&cells.pressure, false), kernel(grid, nu, z, &[0.0]))];
    if end.mirrored {
        let shifts = end.faces().map(|face| 2.0 * face);
        parts.push((plan.pressure(&cells.pressure, true), kernel(grid, nu, z, &shifts)));
    }
    let component = |c: usize| {
        let mut sum = vec![Complex::default(); parts[0].0.len()];
        for (pressure, rows) in &parts {
            let kernel = plan.kernel(rows, c);
            sum.par_iter_mut()
                .zip(pressure.par_iter().zip(kernel))
                .for_each(|(sum, (p, k))| *sum += p * k);
        }
        plan.backward(sum)
    };
    let mut layer: Layer = std::array::from_fn(component);
    if let Some(gamma) = end.gamma {
        let field = CellField::new(cells, FieldEnd { gamma: None, ..end }, nu);
        for face in end.faces() {
            let on_face: Vec<f64> =
                (0..grid.nx).into_par_iter().map(|i| field.at(grid.x(i), face, z).yy).collect();
            for (j, row) in layer[1].chunks_exact_mut(grid.nx).enumerate() {
                let share = transition((face - grid.y(j)).abs(), z, gamma);
                row.iter_mut().zip(&on_face).for_each(|(yy, face)| *yy -= share * face);
            }
        }
    }
    layer
}

/// Adds what free ends do, known on the nodes of `axis` along the contact, to a layer at the depth
/// `z` (C); at far points it takes the layer's place.
pub fn add_ends(layer: &mut Layer, grid: &Grid, axis: &Panels, ends: &EndStress, z: f64) {
    let xs: Vec<f64> = (0..grid.nx).map(|i| grid.x(i)).collect();
    let far: Vec<usize> = (0..grid.nx).filter(|i| ends.is_far(xs[*i], z)).collect();
    for row in layer.iter_mut().flat_map(|field| field.chunks_exact_mut(grid.nx)) {
        far.iter().for_each(|i| row[*i] = 0.0);
    }
    let rows: Vec<Vec<StressTensor>> =
        axis.nodes().par_iter().map(|y| ends.at(*y, z, &xs, &xs)).collect();
    for j in 0..grid.ny {
        for (node, weight) in axis.interpolation(grid.y(j)) {
            for (i, stress) in rows[node].iter().enumerate() {
                let all = layer.iter_mut().zip(stress.components());
                all.for_each(|(field, s)| field[j * grid.nx + i] += weight * s);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_the_sums_at_their_places() {
        let grid = Grid::new(7, 10, 1.2, 4.0).unwrap();
        let pressure = (0..grid.len()).map(|i| ((i * i) as f64).sin().max(0.0)).collect();
        let cells = CellPressure::of(grid, pressure);
        let plain = FieldEnd { half: 4.7, middle: 0.4, mirrored: false, gamma: None };
        let mirrored = FieldEnd { mirrored: true, ..plain };
        for (end, z) in
            [(plain, 0.0), (mirrored, 0.37), (FieldEnd { gamma: Some(2.0), ..mirrored }, 0.9)]
        {
            let layer = layer(&cells, end, 0.3, z);
            let field = CellField::new(&cells, end, 0.3);
            for (i, j) in [(0, 0), (3, 4), (6, 9), (2, 8)] {
                let want = field.at(grid.x(i), grid.y(j), z).components();
                for (c, want) in want.iter().enumerate() {
                    let got = layer[c][j * grid.nx + i];
                    assert!((got - want).abs() < 1e-12, "{end:?} {i} {j} {c}: {got} {want}");
                }
            }
        }
    }
}
