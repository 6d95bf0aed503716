//! The grid of cells.

use crate::base::{Error, Result};

/// Cells that are more than this many times as long as wide, or as wide as long, resolve one
/// direction only.
const SLENDEREST: f64 = 20.0;

/// Fewest cells across the contact and along it.
const FEWEST: usize = 4;

/// Uniform cells over |x| <= `half_width`, |y| <= `half_length` (C).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Cells across the contact.
    pub nx: usize,
    /// Cells along the contact.
    pub ny: usize,
    /// Half-width X of the region (C).
    pub half_width: f64,
    /// Half-length S of the contact (C).
    pub half_length: f64,
}

impl Grid {
    /// `nx` x `ny` cells.
    ///
    /// # Errors
    /// [`Error::Value`] for fewer than four cells in a direction, and for cells more than twenty
    /// times as long as wide or as wide as long.
    pub fn new(nx: usize, ny: usize, half_width: f64, half_length: f64) -> Result<Self> {
        let grid = Self { nx, ny, half_width, half_length };
        let refuse = |reason: String, remedy: String| {
            let (key, value) = ("cells".into(), format!("{nx},{ny}"));
            Err(Error::Value { key, value, reason, remedy })
        };
        if nx < FEWEST || ny < FEWEST {
            let reason = "too few cells resolve nothing".into();
            return refuse(reason, format!("take {FEWEST} or more in each direction"));
        }
        let (a, b) = grid.half_sides();
        let ratio = b / a;
        if !(1.0 / SLENDEREST..=SLENDEREST).contains(&ratio) {
            let (times, long, wide) =
                if ratio > 1.0 { (ratio, "long", "wide") } else { (1.0 / ratio, "wide", "long") };
            let reason = format!("the cells are {times:.0} times as {long} as {wide}");
            // Cells twice as long as wide suit a line contact.
            let balanced = |along: f64| (along.ceil() as usize).max(FEWEST);
            let along = balanced(0.5 * half_length / a);
            return refuse(reason, format!("keep below {SLENDEREST}, e.g. with {nx},{along}"));
        }
        Ok(grid)
    }

    /// Half-sides a and b of a cell (C).
    pub fn half_sides(&self) -> (f64, f64) {
        (self.half_width / self.nx as f64, self.half_length / self.ny as f64)
    }

    /// x of the centres of the cells (C).
    pub fn x(&self, i: usize) -> f64 {
        centre(i, self.nx, self.half_width)
    }

    /// y of the centres of the cells (C).
    pub fn y(&self, j: usize) -> f64 {
        centre(j, self.ny, self.half_length)
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.nx * self.ny
    }

    /// Whether there are no cells (never, by construction).
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Values of `f(x, y)` at the centres, x fastest.
    pub fn sample(&self, f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        let xs: Vec<f64> = (0..self.nx).map(|i| self.x(i)).collect();
        (0..self.ny).flat_map(|j| xs.iter().map(|x| f(*x, self.y(j))).collect::<Vec<_>>()).collect()
    }
}

/// The centre of cell `i` of `n` over [-`half`, `half`], exactly opposite to that of cell n - 1 -
/// i.
fn centre(i: usize, n: usize, half: f64) -> f64 {
    half * ((2 * i + 1) as f64 - n as f64) / n as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_fill_the_region() {
        let grid = Grid::new(5, 8, 1.5, 6.0).unwrap();
        assert_eq!(grid.half_sides(), (0.3, 0.75));
        assert_eq!([grid.x(0), grid.x(2), grid.x(4)], [-1.2, 0.0, 1.2]);
        assert_eq!([grid.y(0), grid.y(7)], [-5.25, 5.25]);
        assert_eq!(grid.sample(|x, _| x)[5..10], grid.sample(|x, _| x)[..5]);
    }

    #[test]
    fn cells_that_resolve_one_direction_only_are_refused() {
        let said = Grid::new(512, 16, 1.3, 50.0).unwrap_err().to_string();
        let wanted = "cells = 512,16 is not valid: the cells are 1231 times as long as wide; keep below 20, \
                      e.g. with 512,9847";
        assert_eq!(said, wanted);
        let said = Grid::new(4, 4000, 1.3, 5.0).unwrap_err().to_string();
        assert!(said.contains("260 times as wide as long"), "{said}");
        assert!(Grid::new(3, 100, 1.3, 5.0).is_err());
        assert!(Grid::new(64, 64, f64::NAN, 5.0).is_err());
    }
}
