//! The pressures of cells.

use super::grid::Grid;

/// Parts of the length by which a place may be beyond it for rounding.
const SAME: f64 = 1e-12;

/// The pressures of a [`super::CellProblem`].
#[derive(Debug, Clone, PartialEq)]
pub struct CellPressure {
    /// The cells.
    pub grid: Grid,
    /// Pressure of each cell (p0), x fastest.
    pub pressure: Vec<f64>,
    /// The gap under them over each cell (C^2 / (2 R)), zero in the contact but for the residual.
    pub gap: Vec<f64>,
    /// Approach of far points (C^2 / (2 R)).
    pub approach: f64,
    /// Tilt of far points (C / (2 R)): that which is held, or the one that the load's arm causes.
    pub tilt: f64,
    /// Applications of the compliance on the finest grid.
    pub iterations: usize,
    /// Relative residual.
    pub residual: f64,
}

impl CellPressure {
    /// Pressures without a contact that they belong to.
    #[cfg(test)]
    pub(super) fn of(grid: Grid, pressure: Vec<f64>) -> Self {
        let (approach, tilt, residual) = (0.0, 0.0, 0.0);
        Self { grid, pressure, gap: Vec::new(), approach, tilt, iterations: 0, residual }
    }

    /// Real contact area (C^2): that of the cells under pressure.
    pub fn contact_area(&self) -> f64 {
        let (a, b) = self.grid.half_sides();
        4.0 * a * b * self.pressure.iter().filter(|p| **p > 0.0).count() as f64
    }

    /// Mean gap (C^2 / (2 R)) over the cells within C of the line x = 0, or over those next to it
    /// if they are wider.
    pub fn mean_gap(&self) -> f64 {
        let grid = &self.grid;
        let next = (0..grid.nx).map(|i| grid.x(i).abs()).fold(f64::INFINITY, f64::min);
        let within = (next * (1.0 + 1e-9)).max(1.0);
        let near = self.gap.iter().enumerate();
        let near = near.filter(|(i, _)| grid.x(i % grid.nx).abs() <= within);
        let (sum, count) = near.fold((0.0, 0), |(sum, n), (_, gap)| (sum + gap.max(0.0), n + 1));
        sum / f64::from(count)
    }

    /// Shares of the contact area whose pressure lies in each of `bins` equal parts between zero
    /// and the largest pressure, lowest first.
    pub fn histogram(&self, bins: usize) -> Vec<f64> {
        let largest = self.pressure.iter().fold(0.0, |m: f64, p| m.max(*p));
        let mut shares = vec![0.0; bins];
        let pressed = || self.pressure.iter().filter(|p| **p > 0.0);
        let one = 1.0 / pressed().count() as f64;
        for p in pressed() {
            shares[((p / largest * bins as f64) as usize).min(bins - 1)] += one;
        }
        shares
    }

    /// The pressure (p0) of the cell that holds (`x`, `y`); zero outside the region.
    pub fn at(&self, x: f64, y: f64) -> f64 {
        let Grid { nx, ny, half_width, half_length } = self.grid;
        let inside = x.abs() <= half_width && y.abs() <= half_length * (1.0 + SAME);
        let index = |v: f64, half: f64, n: usize| {
            ((0.5 * (v / half + 1.0) * n as f64).max(0.0) as usize).min(n - 1)
        };
        let cell = index(y, half_length, ny) * nx + index(x, half_width, nx);
        if inside { self.pressure[cell] } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn area_and_histogram_are_those_of_the_pressed_cells() {
        let grid = Grid::new(4, 4, 1.0, 2.0).unwrap();
        let mut pressure = vec![0.0; 16];
        (pressure[1], pressure[5], pressure[6], pressure[11]) = (0.1, 0.4, 0.9, 1.0);
        let cells = CellPressure::of(grid, pressure);
        assert_eq!((cells.contact_area(), cells.histogram(4)), (2.0, vec![0.25, 0.25, 0.0, 0.5]));
        assert_eq!(cells.at(0.2, 0.9), 0.0);
        assert_eq!(
            [cells.at(-0.1, -0.9), cells.at(0.1, -0.9), cells.at(1.5, 0.0)],
            [0.4, 0.9, 0.0]
        );
    }
}
