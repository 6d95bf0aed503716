//! The pressure of cells as a stress field takes it: a profile across the contact at each node
//! along it.

use super::pressure::CellPressure;
use super::profile::nodal;
use crate::base::Panels;
use crate::kernels::strip;
use crate::stress::Load;
use crate::stress::round::LocalContact;
use nalgebra::DMatrix;

/// The part of the pressure of cells that is even in x, at the nodes of an axis along the contact:
/// uniform across each cell, and along the line the polynomials next to what has their means.
#[derive(Debug)]
pub struct Columns<'a> {
    axis: &'a Panels,
    symmetric: bool,
    /// Outer edges x > 0 of the cells across.
    edges: Vec<f64>,
    /// The pressure as a sum of uniform ones up to each edge: a row for each node.
    steps: DMatrix<f64>,
}

impl<'a> Columns<'a> {
    /// The pressures of `cells` at the nodes of `axis`, which ends where they do; of a `symmetric`
    /// contact, with even numbers of cells, the axis is the half y > 0. At the ends of the line the
    /// pressure goes like s^-m of the distance s, m of `exponents`, zero where it is finite.
    pub fn new(
        cells: &CellPressure,
        axis: &'a Panels,
        symmetric: bool,
        exponents: [f64; 2],
    ) -> Self {
        let nx = cells.grid.nx;
        let a = cells.grid.half_sides().0;
        let count = nx - nx / 2;
        let even = |row: &[f64], i: usize| 0.5 * (row[nx / 2 + i] + row[count - 1 - i]);
        let nodal = nodal(cells, axis, symmetric, Some(exponents), count, even);
        let next = |node: usize, i: usize| if i < count { nodal[(node, i)] } else { 0.0 };
        let steps =
            DMatrix::from_fn(axis.len(), count, |node, i| nodal[(node, i)] - next(node, i + 1));
        let edges = (1..=count).map(|i| a * (2 * i - nx % 2) as f64).collect();
        Self { axis, symmetric, edges, steps }
    }
}

impl Load for Columns<'_> {
    fn axis(&self) -> &Panels {
        self.axis
    }

    fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    /// That of Hertz under the load at `y`.
    fn local_contact(&self, y: f64) -> LocalContact {
        let load = |j: usize| -> f64 {
            self.edges
                .iter()
                .zip(self.steps.row(j).iter())
                .map(|(edge, step)| 2.0 * edge * step)
                .sum()
        };
        LocalContact::carrying(self.neighbours(y).into_iter().map(|(j, w)| w * load(j)).sum())
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        let i = self.edges.partition_point(|edge| *edge <= x.abs());
        let own = |(j, share): (usize, f64)| share * self.steps.row(j).iter().skip(i).sum::<f64>();
        self.neighbours(y).into_iter().map(own).sum()
    }

    fn transforms(&self, k: &[f64]) -> DMatrix<f64> {
        let (edges, steps) = (&self.edges, &self.steps);
        let wave = |i: usize, j: usize| strip::uniform_transform(edges[i], k[j]);
        steps * DMatrix::from_fn(edges.len(), k.len(), wave)
    }

    fn endless(&self, y: f64, x: f64, z: f64) -> [f64; 3] {
        let neighbours = self.neighbours(y);
        let mut sum = [0.0; 3];
        for (i, edge) in self.edges.iter().enumerate() {
            let step: f64 = neighbours.iter().map(|(j, w)| w * self.steps[(*j, i)]).sum();
            let own = strip::uniform(*edge, x, z);
            sum.iter_mut().zip(own).for_each(|(sum, s)| *sum += step * s);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::super::grid::Grid;
    use super::*;

    #[test]
    fn columns_carry_the_cells_pressures() {
        // The same all along: 1 and 0.25 on the two inner cells of a half.
        let grid = Grid::new(6, 8, 1.5, 4.0).unwrap();
        let across = [0.0, 0.25, 1.0, 1.0, 0.25, 0.0];
        let pressure = across.repeat(grid.ny);
        let cells = CellPressure::of(grid, pressure);
        let axis = Panels::new(vec![0.0, 2.3, 3.5, 4.0], 4);
        let columns = Columns::new(&cells, &axis, true, [0.0; 2]);
        let k = 1.3f64;
        let want = 2.0 * (0.75 * (0.5 * k).sin() + 0.25 * (1.0 * k).sin()) / k;
        for got in columns.transforms(&[k]).iter() {
            assert!((got - want).abs() < 1e-13, "{got} {want}");
        }
        for y in [0.0, -1.7, 3.9] {
            let inside = columns.endless(y, 0.7, 0.0);
            assert!(
                inside
                    .iter()
                    .zip([-0.25, -0.25, 0.0])
                    .all(|(got, want)| (got - want).abs() < 1e-13)
            );
        }
        assert!((columns.at(-0.7, -3.9) - 0.25).abs() < 1e-13);
        assert_eq!([columns.at(0.0, 4.1), columns.at(1.2, 0.0)], [0.0; 2]);
    }
}
