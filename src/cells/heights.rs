//! Measured surfaces: heights on a regular grid, and the gap of a contact with them.

use super::grid::Grid;
use crate::base::number::{significant, stated};
use crate::base::{Error, Result};
use crate::contact::Gap;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Heights of a surface over a regular grid, positive out of the body: sample (i, j) lies at
/// x = (i - (nx - 1) / 2) dx and y alike, so that the middle of the samples is that of the contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Heights {
    shape: [usize; 2],
    /// dx and dy (m).
    steps_m: [f64; 2],
    /// Heights (m), y fastest.
    values_m: Arc<[f64]>,
}

/// What is taken off heights before they are used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Detrend {
    /// Their mean.
    Mean,
    /// The plane that fits them best (least squares).
    Plane,
}

impl Detrend {
    /// All of them.
    pub const ALL: [Detrend; 2] = [Detrend::Mean, Detrend::Plane];

    /// The name in case files.
    pub fn name(self) -> &'static str {
        match self {
            Detrend::Mean => "mean",
            Detrend::Plane => "plane",
        }
    }
}

impl Heights {
    /// `shape` heights, y fastest, `steps_m` apart (m).
    ///
    /// # Errors
    /// [`Error::Value`] for fewer than two samples in a direction, a number of values that is not
    /// that of the shape, steps that are no lengths, and a value that is not finite.
    pub fn new(shape: [usize; 2], steps_m: [f64; 2], values_m: Vec<f64>) -> Result<Self> {
        let refuse = |key: &str, value: String, reason: &str, remedy: &str| {
            let (key, reason, remedy) = (key.into(), reason.into(), remedy.into());
            Err(Error::Value { key, value, reason, remedy })
        };
        let [nx, ny] = shape;
        if nx < 2 || ny < 2 || nx * ny != values_m.len() {
            let value = format!("{nx} x {ny} with {} values", values_m.len());
            let reason =
                "a surface has two samples or more in each direction, and a height for each";
            return refuse("heights", value, reason, "give an array of the shape (nx, ny)");
        }
        for (step, key) in steps_m.into_iter().zip(["dx_m", "dy_m"]) {
            if !(step.is_finite() && step > 0.0) {
                let value = stated(step);
                return refuse(
                    key,
                    value,
                    "a length greater than zero belongs here",
                    "give it in metres",
                );
            }
        }
        if let Some(hole) = values_m.iter().position(|v| !v.is_finite()) {
            let value = format!("{} at [{}, {}]", values_m[hole], hole / ny, hole % ny);
            let remedy = "fill holes before, for example with SurfaceTopography";
            return refuse("heights", value, "a finite height belongs here", remedy);
        }
        Ok(Self { shape, steps_m, values_m: values_m.into() })
    }

    /// The same heights `steps_m` apart (m).
    #[must_use]
    pub fn with_steps(&self, steps_m: [f64; 2]) -> Self {
        Self { steps_m, ..self.clone() }
    }

    /// Distances of the samples across and along (m).
    pub fn steps_m(&self) -> [f64; 2] {
        self.steps_m
    }

    /// Samples across and along.
    pub fn shape(&self) -> [usize; 2] {
        self.shape
    }

    /// Half of what the samples span across and along (m).
    pub fn half_spans_m(&self) -> [f64; 2] {
        [0, 1].map(|i| 0.5 * (self.shape[i] - 1) as f64 * self.steps_m[i])
    }

    /// The highest less the lowest height (m).
    pub fn range_m(&self) -> f64 {
        self.highest_m() + self.values_m.iter().fold(f64::NEG_INFINITY, |m: f64, v| m.max(-v))
    }

    /// The highest height (m).
    pub fn highest_m(&self) -> f64 {
        self.values_m.iter().fold(f64::NEG_INFINITY, |m: f64, v| m.max(*v))
    }

    /// Their mean (m).
    pub fn mean_m(&self) -> f64 {
        self.values_m.iter().sum::<f64>() / self.values_m.len() as f64
    }

    /// The height (m) at (`x_m`, `y_m`), linear between samples; beyond the last ones theirs.
    pub fn at(&self, x_m: f64, y_m: f64) -> f64 {
        let half = self.half_spans_m();
        let place = |i: usize, v: f64| {
            let last = self.shape[i] - 1;
            let at = ((v + half[i]) / self.steps_m[i]).clamp(0.0, last as f64);
            let below = (at as usize).min(last - 1);
            (below, at - below as f64)
        };
        let ((i, s), (j, t)) = (place(0, x_m), place(1, y_m));
        let value = |i: usize, j: usize| self.values_m[i * self.shape[1] + j];
        let row = |i: usize| (1.0 - t) * value(i, j) + t * value(i, j + 1);
        (1.0 - s) * row(i) + s * row(i + 1)
    }

    /// The same heights without their mean or their plane.
    #[must_use]
    pub fn without(self, what: Detrend) -> Self {
        let [nx, ny] = self.shape;
        let mean = self.mean_m();
        // Counted from the middle, the two slopes and the mean are orthogonal.
        let from_middle = |i: usize, n: usize| i as f64 - 0.5 * (n - 1) as f64;
        let slope = |along: &dyn Fn(usize) -> f64| {
            let terms = || self.values_m.iter().enumerate().map(|(at, h)| (along(at), h));
            let square: f64 = terms().map(|(u, _)| u * u).sum();
            terms().map(|(u, h)| u * h).sum::<f64>() / square
        };
        let (x, y) = (|at: usize| from_middle(at / ny, nx), |at: usize| from_middle(at % ny, ny));
        let [across, along] = match what {
            Detrend::Mean => [0.0; 2],
            Detrend::Plane => [slope(&x), slope(&y)],
        };
        let rest = |(at, h): (usize, &f64)| h - (mean + across * x(at) + along * y(at));
        Self { values_m: self.values_m.iter().enumerate().map(rest).collect(), ..self }
    }
}

/// A gap with a rough surface on one side: the smooth gap less the heights.
pub struct RoughGap<'a> {
    smooth: &'a dyn Gap,
    heights: &'a Heights,
    c_m: f64,
    unit_m: f64,
}

impl<'a> RoughGap<'a> {
    /// The gap over the cells of `grid` where the surface's heights come on top of the `smooth`
    /// one; `c_m` is the length C and `unit_m` the unit of gaps, C^2 / (2 R) (m).
    ///
    /// # Errors
    /// As [`Heights::check_covers`].
    pub fn new(
        smooth: &'a dyn Gap,
        heights: &'a Heights,
        grid: &Grid,
        c_m: f64,
        unit_m: f64,
    ) -> Result<Self> {
        heights.check_covers(grid, c_m)?;
        Ok(Self { smooth, heights, c_m, unit_m })
    }
}

impl Heights {
    /// Refuses cells, in units of `c_m` (m), whose centres are not all within the samples.
    ///
    /// # Errors
    /// [`Error::Value`] that names the direction.
    pub fn check_covers(&self, grid: &Grid, c_m: f64) -> Result<()> {
        let (a, b) = grid.half_sides();
        let wanted = [grid.half_width - a, grid.half_length - b].map(|half| half * c_m);
        let spans = self.half_spans_m().into_iter().zip(wanted).zip(["x", "y"]);
        for ((span, wanted), axis) in spans {
            if span < wanted * (1.0 - 1e-9) {
                let [nx, ny] = self.shape;
                let [span, wanted] = [span, wanted].map(|v| significant(v, 4));
                return Err(Error::Value {
                    key: "surface.heights".into(),
                    value: format!("{nx} x {ny} samples"),
                    reason: format!(
                        "along {axis} they reach {span} m to either side of the middle, and the \
                         cells {wanted} m"
                    ),
                    remedy: "give more samples, or check dx_m and dy_m; along x, [cells] half_width_m makes the region smaller"
                        .into(),
                });
            }
        }
        Ok(())
    }
}

impl Gap for RoughGap<'_> {
    fn at(&self, x: f64, y: f64) -> f64 {
        self.smooth.at(x, y) - self.heights.at(x * self.c_m, y * self.c_m) / self.unit_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Straight;

    fn plane() -> Heights {
        // 3 x 4 samples of 1 + 2 x + 5 y, 0.5 and 0.25 m apart.
        let value = |k: usize| {
            let (x, y) = (0.5 * (k / 4) as f64 - 0.5, 0.25 * (k % 4) as f64 - 0.375);
            1.0 + 2.0 * x + 5.0 * y
        };
        Heights::new([3, 4], [0.5, 0.25], (0..12).map(value).collect()).unwrap()
    }

    #[test]
    fn heights_are_linear_between_samples_and_lose_what_is_asked_for() {
        let heights = plane();
        assert_eq!((heights.shape(), heights.half_spans_m()), ([3, 4], [0.5, 0.375]));
        for (x, y) in [(0.0, 0.0), (0.31, -0.2), (-0.5, 0.375)] {
            assert!((heights.at(x, y) - (1.0 + 2.0 * x + 5.0 * y)).abs() < 1e-14);
        }
        assert_eq!(heights.at(9.0, 9.0), heights.at(0.5, 0.375));
        let [no_mean, no_plane] =
            [Detrend::Mean, Detrend::Plane].map(|d| heights.clone().without(d));
        assert!((no_mean.at(0.2, 0.1) - 0.9).abs() < 1e-14);
        assert!(no_plane.at(0.2, 0.1).abs() < 1e-14 && no_plane.at(-0.5, 0.3).abs() < 1e-14);
    }

    #[test]
    fn what_is_no_surface_is_refused() {
        let said =
            |shape, steps, values| Heights::new(shape, steps, values).unwrap_err().to_string();
        assert!(said([1, 4], [1.0; 2], vec![0.0; 4]).contains("two samples or more"));
        assert!(said([2, 2], [1.0; 2], vec![0.0; 5]).contains("2 x 2 with 5 values"));
        assert!(said([2, 2], [1.0, 0.0], vec![0.0; 4]).starts_with("dy_m = 0 is not valid"));
        let holes = said([2, 2], [1.0; 2], vec![0.0, 0.0, f64::NAN, 0.0]);
        assert!(holes.starts_with("heights = NaN at [1, 0] is not valid"), "{holes}");
    }

    #[test]
    fn a_rough_gap_is_the_smooth_one_less_the_heights() {
        let heights = plane();
        let grid = Grid::new(4, 4, 0.05, 0.05).unwrap();
        let gap = RoughGap::new(&Straight, &heights, &grid, 10.0, 2.0).unwrap();
        let want = Straight.at(0.01, 0.02) - 0.5 * (1.0 + 2.0 * 0.1 + 5.0 * 0.2);
        assert!((gap.at(0.01, 0.02) - want).abs() < 1e-14);
        let said = RoughGap::new(&Straight, &heights, &grid, 20.0, 2.0).err().unwrap().to_string();
        assert!(said.contains("along x") && said.contains("cells 0.75 m"), "{said}");
    }
}
