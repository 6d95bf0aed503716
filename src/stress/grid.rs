//! Stresses on a rectangular grid of points, for example for volume plots.

use super::body_field::BodyField;
use super::round::RoundStress;
use crate::base::StressTensor;
use rayon::prelude::*;

/// Points at every combination of coordinates along x, y and z (units of C); z >= 0, and |y| at
/// most the body's half-length.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Grid {
    /// Coordinates across the contact, in any order.
    pub x: Vec<f64>,
    /// Coordinates along the contact, in any order.
    pub y: Vec<f64>,
    /// Depths, in any order.
    pub z: Vec<f64>,
}

impl Grid {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.x.len() * self.y.len() * self.z.len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Index of a point in arrays over the grid: x runs fastest, z slowest.
    pub fn index(&self, ix: usize, iy: usize, iz: usize) -> usize {
        (iz * self.y.len() + iy) * self.x.len() + ix
    }
}

/// The six stress components on a [`Grid`].
#[derive(Debug, Clone, PartialEq)]
pub struct GridStress {
    /// Number of points.
    points: usize,
    /// All values, component by component, each in the order of [`Grid::index`].
    values: Vec<f64>,
}

impl GridStress {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.points
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.points == 0
    }

    /// One component at all points, in the order of [`Grid::index`]; `component` counts as
    /// [`StressTensor::components`] does: xx, yy, zz, xy, xz, yz.
    pub fn component(&self, component: usize) -> &[f64] {
        &self.values[component * self.points..(component + 1) * self.points]
    }

    /// All values, shape \[component\]\[z\]\[y\]\[x\].
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The stress at one point, by its index.
    pub fn at(&self, index: usize) -> StressTensor {
        StressTensor::from_components(std::array::from_fn(|c| self.component(c)[index]))
    }
}

/// Coordinates grouped by what is computed once for them: their magnitude where the field is even.
struct Mirrored {
    /// The distinct magnitudes, in the order of their first appearance.
    distinct: Vec<f64>,
    /// For each coordinate its magnitude's index, and whether it is negative.
    of: Vec<(usize, bool)>,
    /// For each magnitude the first coordinate that has it.
    first: Vec<usize>,
}

impl Mirrored {
    /// Groups the coordinates; those of what is not `even` are each their own.
    fn new(coordinates: &[f64], even: bool) -> Self {
        let mut indices = std::collections::HashMap::new();
        let (mut distinct, mut first) = (Vec::new(), Vec::new());
        let of = coordinates
            .iter()
            .enumerate()
            .map(|(i, &v)| {
                let magnitude = if even { v.abs() } else { v };
                let index = *indices.entry(magnitude.to_bits()).or_insert_with(|| {
                    distinct.push(magnitude);
                    first.push(i);
                    distinct.len() - 1
                });
                (index, even && v < 0.0)
            })
            .collect();
        Self { distinct, of, first }
    }
}

/// Stresses of `field` on `grid`, in units of p0, computed on all threads of the current pool.
///
/// A line of points along x costs little more than one of its points, because [`BodyField::at`]
/// shares the kernels over x; lines are computed in parallel. The contact is even in x, and may be
/// so in y: points that are exact mirror images of other points of the grid are not computed again.
/// `shaped` says what becomes of the stress of a round body or under a traction; none for a flat
/// one under pressure alone. The memory is that of the result, 48 bytes per point, and one line for
/// each thread.
pub fn on_grid(
    field: &BodyField,
    grid: &Grid,
    shaped: Option<&(dyn Fn(&RoundStress) -> StressTensor + Sync)>,
) -> GridStress {
    let (points, nx) = (grid.len(), grid.x.len());
    let mut values = vec![0.0; 6 * points];
    if points == 0 {
        return GridStress { points, values };
    }
    let (x, y) = (Mirrored::new(&grid.x, true), Mirrored::new(&grid.y, field.is_symmetric()));
    let ny = grid.y.len();
    let mut parts = values.chunks_exact_mut(points);
    let [xx, yy, zz, xy, xz, yz] = std::array::from_fn(|_| {
        parts.next().expect("six components of as many points").par_chunks_exact_mut(nx)
    });
    (xx, yy, zz, xy, xz, yz).into_par_iter().enumerate().for_each(
        |(line, (xx, yy, zz, xy, xz, yz))| {
            let (iz, iy) = (line / ny, line % ny);
            let (magnitude, negative) = y.of[iy];
            if y.first[magnitude] != iy {
                return;
            }
            let (y, z) = (y.distinct[magnitude], grid.z[iz]);
            let own = match shaped {
                None => {
                    let flat = field.at(y, z, &x.distinct).into_iter();
                    flat.map(|s| RoundStress { flat: s.into(), ..RoundStress::default() }).collect()
                }
                Some(_) => field.round_at(y, z, &x.distinct),
            };
            for (ix, &(i, behind)) in x.of.iter().enumerate() {
                let s = if behind { own[i].mirrored_in_x() } else { own[i] };
                let s = shaped.map_or(s.flat.pressure, |shaped| shaped(&s));
                let s = if negative { s.mirrored(StressTensor::ODD_IN_Y) } else { s };
                (xx[ix], yy[ix], zz[ix]) = (s.xx, s.yy, s.zz);
                (xy[ix], xz[ix], yz[ix]) = (s.xy, s.xz, s.yz);
            }
        },
    );
    for (component, part) in values.chunks_exact_mut(points).enumerate() {
        for plane in part.chunks_exact_mut(nx * ny) {
            for (iy, &(magnitude, negative)) in y.of.iter().enumerate() {
                let from = y.first[magnitude];
                if from == iy {
                    continue;
                }
                plane.copy_within(from * nx..(from + 1) * nx, iy * nx);
                if negative != y.of[from].1 && StressTensor::ODD_IN_Y[component] {
                    plane[iy * nx..(iy + 1) * nx].iter_mut().for_each(|v| *v = -*v);
                }
            }
        }
    }
    GridStress { points, values }
}
