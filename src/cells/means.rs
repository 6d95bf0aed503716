//! Integrals of an axis's polynomials over cells.

use super::grid::Grid;
use crate::base::Panels;

/// What lies in one panel of a cell: the panel's index, and the cell's part in it with its own
/// nodes.
pub(super) type Part = (usize, Panels);

/// The parts of each cell along the line, of a `symmetric` contact of those on the axis's half.
pub(super) fn parts(axis: &Panels, grid: &Grid, symmetric: bool) -> Vec<Vec<Part>> {
    let length = 2.0 * grid.half_sides().1;
    let (from, count) = match symmetric {
        true => (0.0, grid.ny / 2),
        false => (-grid.half_length, grid.ny),
    };
    let of_cell = |j: usize| {
        let cell = [j, j + 1].map(|j| from + length * j as f64);
        let inside = |panel: usize| {
            let [from, to] = axis.panel(panel);
            let (from, to) = (from.max(cell[0]), to.min(cell[1]));
            (from < to).then(|| (panel, Panels::new(vec![from, to], axis.order())))
        };
        (0..axis.panel_count()).filter_map(inside).collect()
    };
    (0..count).map(of_cell).collect()
}

/// The integrals over a cell of `f(y)` times each polynomial of `axis` that is not zero there: its
/// node, and the integral.
pub(super) fn integrals(axis: &Panels, cell: &[Part], f: impl Fn(f64) -> f64) -> Vec<(usize, f64)> {
    let order = axis.order();
    let mut all = Vec::with_capacity(cell.len() * order);
    for (panel, part) in cell {
        let start = all.len();
        all.extend((0..order).map(|i| (panel * order + i, 0.0)));
        for (y, weight) in part.nodes().iter().zip(part.weights()) {
            let value = f(*y) * weight;
            let polynomials = axis.polynomials(*panel, *y);
            all[start..].iter_mut().zip(polynomials).for_each(|((_, sum), v)| *sum += v * value);
        }
    }
    all
}

/// The means of the polynomials of `axis` over the cells along the line, of a `symmetric` contact
/// over those on the axis's half.
pub(super) fn means(axis: &Panels, grid: &Grid, symmetric: bool) -> Vec<Vec<(usize, f64)>> {
    let length = 2.0 * grid.half_sides().1;
    let parts = parts(axis, grid, symmetric);
    parts.iter().map(|cell| integrals(axis, cell, |_| 1.0 / length)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_over_cells_are_those_of_polynomials() {
        let axis = Panels::new(vec![0.0, 1.7, 2.6, 3.0], 4);
        let grid = Grid::new(4, 10, 1.0, 3.0).unwrap();
        let all = means(&axis, &grid, true);
        let cubic = |y: f64| y * (1.0 - 0.3 * y * y);
        let integral = |y: f64| 0.5 * y * y - 0.075 * y.powi(4);
        for (j, means) in all.iter().enumerate() {
            let got: f64 = means.iter().map(|(node, m)| m * cubic(axis.nodes()[*node])).sum();
            let want = (integral(0.6 * (j + 1) as f64) - integral(0.6 * j as f64)) / 0.6;
            assert!((got - want).abs() < 1e-13, "{got} {want}");
        }
        // The cells add up to the line.
        let mut sums = vec![0.0; axis.len()];
        all.iter().flatten().for_each(|(node, mean)| sums[*node] += 0.6 * mean);
        for (sum, weight) in sums.iter().zip(axis.weights()) {
            assert!((sum - weight).abs() < 1e-13);
        }
    }
}
