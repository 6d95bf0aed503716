//! What free ends add to the stresses of a mirrored half-space under any pressures of cells.
//!
//! The cells themselves and their images are Love's ([`super::CellField`]), so that a rough
//! pressure is summed as it is. What free ends add to that, the field by free ends less that by
//! mirrored ones, is smooth but at the corner, and taken from the pressures on the nodes that carry
//! the ends ([`super::FreeEnds`]), for their part that is even and for that which is odd in x.

use super::ends::{FreeBody, FreeEnds};
use super::pressure::CellPressure;
use super::profile::nodal;
use crate::base::{Panels, Parity, StressTensor};
use crate::kernels::strip;
use crate::stress::{Field, Load};
use nalgebra::{DMatrix, DVector};

/// One part in x of the pressures of cells, as waves alone: of fields that only count as
/// differences.
#[derive(Debug)]
struct Part<'a> {
    axis: &'a Panels,
    parity: Parity,
    /// Half a cell's width, and the places of the cells across with x >= 0.
    half: f64,
    places: Vec<f64>,
    /// The part at these places: a row for each node.
    nodal: DMatrix<f64>,
    /// Its integrals along the line.
    whole: Vec<f64>,
}

/// Both parts in x of a pressure, with their moments.
#[derive(Debug)]
pub struct EndLoads<'a> {
    ends: &'a FreeEnds,
    parts: [(Part<'a>, DMatrix<f64>); 2],
}

/// The stresses of one body.
#[derive(Debug)]
pub struct EndStress<'a> {
    /// By free and by mirrored ends, for each part.
    fields: [[Field<'a>; 2]; 2],
}

impl<'a> EndLoads<'a> {
    /// The pressures of `cells` on the nodes of `ends`, which are not those of a symmetric contact.
    pub fn new(ends: &'a FreeEnds, cells: &CellPressure) -> Self {
        let nx = cells.grid.nx;
        let (half, count) = (cells.grid.half_sides().0, nx - nx / 2);
        let parts = Parity::BOTH.map(|parity| {
            let nodal = nodal(cells, ends.axis(), false, None, count, |row, i| {
                // The cell in the middle of an odd number stands for both sides.
                let share = if nx % 2 == 1 && i == 0 { 0.5 } else { 1.0 };
                share * 0.5 * (row[nx / 2 + i] + parity.sign() * row[count - 1 - i])
            });
            let places = (0..count).map(|i| cells.grid.x(nx / 2 + i)).collect();
            let weights = DVector::from_column_slice(ends.axis().weights());
            let whole = nodal.tr_mul(&weights).iter().copied().collect();
            let part = Part { axis: ends.axis(), parity, half, places, nodal, whole };
            let moments = ends.moments(&part);
            (part, moments)
        });
        Self { ends, parts }
    }

    /// The stresses that free ends add in `body`, see [`FreeEnds::fields`].
    pub fn stress(&self, body: &FreeBody, tolerance: f64) -> EndStress<'_> {
        let fields = self
            .parts
            .each_ref()
            .map(|(part, moments)| self.ends.fields(body, part, moments, tolerance));
        EndStress { fields }
    }
}

impl EndStress<'_> {
    /// What is added at (x, `y`, `z`) for each x of `xs`. On an end face the tractions of the sum
    /// are zero, which only the caller can tell. At the points with a far one of `places` for x it
    /// is the whole stress, that of the resultants.
    pub fn at(&self, y: f64, z: f64, xs: &[f64], places: &[f64]) -> Vec<StressTensor> {
        let mut sums = vec![StressTensor::default(); xs.len()];
        let (far, near): (Vec<usize>, Vec<usize>) =
            (0..xs.len()).partition(|i| self.is_far(places[*i], z));
        let of = |points: &[usize]| -> Vec<f64> { points.iter().map(|i| xs[*i]).collect() };
        let (far_xs, near_xs) = (of(&far), of(&near));
        for [freed, mirrored] in &self.fields {
            for (i, s) in far.iter().zip(freed.by_resultants(y, z, &far_xs)) {
                sums[*i] += s.pressure;
            }
            let [own, all] = [freed, mirrored].map(|field| field.by_waves(y, z, &near_xs));
            for (i, (own, all)) in near.iter().zip(own.iter().zip(all)) {
                sums[*i] += own.pressure - all.pressure;
            }
        }
        sums
    }

    /// Whether the point (`x`, `z`) is far, so that [`EndStress::at`] gives all of its stress.
    pub fn is_far(&self, x: f64, z: f64) -> bool {
        self.fields[0][0].is_far(x, z)
    }

    /// What the skin of a round surface adds there, see [`Field::skin_at`].
    pub fn skin_at(&self, y: f64, z: f64, xs: &[f64]) -> Vec<StressTensor> {
        let [even, odd] = self.fields.each_ref().map(|[freed, _]| freed.skin_at(y, z, xs));
        even.into_iter().zip(odd).map(|(even, odd)| even + odd).collect()
    }
}

impl Load for Part<'_> {
    fn axis(&self) -> &Panels {
        self.axis
    }

    fn is_symmetric(&self) -> bool {
        false
    }

    fn parity_across(&self) -> Parity {
        self.parity
    }

    fn at(&self, _x: f64, _y: f64) -> f64 {
        0.0
    }

    fn transforms(&self, k: &[f64]) -> DMatrix<f64> {
        let wave = |i: usize, j: usize| {
            let (k, x) = (k[j], self.places[i]);
            let at = match self.parity {
                Parity::Even => (k * x).cos(),
                Parity::Odd => (k * x).sin(),
            };
            // On either side.
            2.0 * at * strip::uniform_transform(self.half, k)
        };
        &self.nodal * DMatrix::from_fn(self.places.len(), k.len(), wave)
    }

    fn endless(&self, _y: f64, _x: f64, _z: f64) -> [f64; 3] {
        [0.0; 3]
    }

    fn endless_of_all(&self, x: f64, z: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (place, load) in self.places.iter().zip(&self.whole) {
            let [own, opposite] = [x - place, x + place].map(|x| strip::uniform(self.half, x, z));
            for (sum, (own, opposite)) in sum.iter_mut().zip(own.into_iter().zip(opposite)) {
                *sum += load * (own + self.parity.sign() * opposite);
            }
        }
        sum
    }

    fn neighbours(&self, _y: f64) -> Vec<(usize, f64)> {
        Vec::new()
    }
}
