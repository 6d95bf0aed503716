//! The contact of a case on cells, with the tilt that its load or its pose asks for.

use super::cell_deep::DeepMotion;
use super::on_cells::Placed;
use super::scene::{Scene, Tilt};
use crate::base::{Error, Result};
use crate::case::Case;
use crate::cells::{CellPressure, CellProblem, CellTilt, Grid, Heights, RoughGap};

/// Most contacts that are solved until a tilt is reached that is held.
const MOST_TRIALS: usize = 10;

/// Error of a tilt that is held, as the displacement of the line's end (C^2 / (2 R)).
const TILT_ERROR: f64 = 1e-6;

/// Most cells in a direction of the grid on which such a tilt is sought first.
const SEARCH: usize = 96;

/// A contact on cells.
pub(super) struct CellContact<'a> {
    /// The problem, with the tilt of far points.
    pub problem: CellProblem,
    scene: &'a Scene,
    smooth: Placed,
    /// Heights with C and the unit of gaps (m).
    heights: Option<(Heights, [f64; 2])>,
    progress: &'a dyn Fn(usize, f64),
    /// The depth of the roller's radius (C).
    depth: f64,
}

impl<'a> CellContact<'a> {
    /// The contact of `case`, whose scene is `scene`, on the cells of `grid`.
    pub fn new(
        case: &Case,
        scene: &'a Scene,
        grid: Grid,
        tolerance: f64,
        progress: &'a dyn Fn(usize, f64),
    ) -> Self {
        let c_m = case.hertz().c_m;
        let unit_m = case.gap_unit_m();
        let depth = case.roller.radius_m / c_m;
        Self {
            problem: scene.on_cells(grid, tolerance),
            scene,
            smooth: scene.gap_on_cells(),
            heights: case.heights().map(|heights| (heights, [c_m, unit_m])),
            progress,
            depth,
        }
    }

    /// The pressures, and the approach and the tilt at the depth of the roller's radius.
    ///
    /// Far points tilt against those at this depth. Where the tilt is held, by how much is taken
    /// from the smooth surfaces: heights change the load's distribution at their own scale, not
    /// along the contact.
    ///
    /// # Errors
    /// As [`CellProblem::solve`]; [`Error::NotConverged`] where a held tilt is not reached.
    pub fn solve(&self) -> Result<(CellPressure, DeepMotion)> {
        let mut problem = self.problem.clone();
        if let Tilt::Held(wanted) = self.scene.tilt
            && !self.scene.is_symmetric()
        {
            let Grid { nx, ny, .. } = problem.grid;
            problem.grid.nx = nx.min(SEARCH);
            problem.grid.ny = ny.min(SEARCH);
            let (first, _) = self.held(&problem, wanted, wanted)?;
            problem.grid = self.problem.grid;
            let (smooth, motion) = self.held(&problem, wanted, first.tilt)?;
            if self.heights.is_none() {
                return Ok((smooth, motion));
            }
            problem.tilt = CellTilt::Held(smooth.tilt);
        }
        let pressure = self.with_heights(&problem)?;
        let motion = self.motion(&problem, &pressure);
        Ok((pressure, motion))
    }

    /// The motion at the depth of the roller's radius.
    fn motion(&self, problem: &CellProblem, pressure: &CellPressure) -> DeepMotion {
        DeepMotion::new(self.scene, problem, pressure, self.depth)
    }

    fn without_heights(&self, problem: &CellProblem) -> Result<CellPressure> {
        problem.solve_telling(&self.smooth, self.progress)
    }

    fn with_heights(&self, problem: &CellProblem) -> Result<CellPressure> {
        match &self.heights {
            None => self.without_heights(problem),
            Some((heights, [c_m, unit_m])) => {
                let gap = RoughGap::new(&self.smooth, heights, &problem.grid, *c_m, *unit_m)?;
                problem.solve_telling(&gap, self.progress)
            }
        }
    }

    /// Mean gap (C^2 / (2 R)) under `pressure` over the cells within C of the line x = 0, or over
    /// those next to it if they are wider.
    pub fn mean_gap(&self, pressure: &CellPressure) -> f64 {
        let grid = &pressure.grid;
        let problem = CellProblem { grid: *grid, ..self.problem.clone() };
        let gaps = match &self.heights {
            None => problem.gaps(&self.smooth, pressure),
            Some((heights, [c_m, unit_m])) => {
                let gap = RoughGap::new(&self.smooth, heights, grid, *c_m, *unit_m);
                problem.gaps(&gap.expect("the contact was solved with it"), pressure)
            }
        };
        let next = (0..grid.nx).map(|i| grid.x(i).abs()).fold(f64::INFINITY, f64::min);
        let within = (next * (1.0 + 1e-9)).max(1.0);
        let near: Vec<f64> = gaps
            .iter()
            .enumerate()
            .filter(|(i, _)| grid.x(i % grid.nx).abs() <= within)
            .map(|(_, gap)| gap.max(0.0))
            .collect();
        near.iter().sum::<f64>() / near.len() as f64
    }

    /// The smooth contact whose tilt at the depth is `wanted`, and this tilt, from the tilt `first`
    /// of far points.
    fn held(
        &self,
        problem: &CellProblem,
        wanted: f64,
        first: f64,
    ) -> Result<(CellPressure, DeepMotion)> {
        let mut problem = problem.clone();
        let mut far = first;
        let mut last: Option<[f64; 2]> = None;
        for _ in 0..MOST_TRIALS {
            problem.tilt = CellTilt::Held(far);
            let found = self.without_heights(&problem)?;
            let motion = self.motion(&problem, &found);
            let off = motion.tilt - wanted;
            if off.abs() * self.scene.half_length <= TILT_ERROR {
                return Ok((found, motion));
            }
            let next = match last {
                Some([before, was]) if was != off => far - off * (far - before) / (off - was),
                _ => far - off,
            };
            last = Some([far, off]);
            far = next;
        }
        Err(Error::NotConverged {
            iterations: MOST_TRIALS,
            residual: last.map_or(f64::INFINITY, |[_, off]| off.abs()),
            remedy: "the held tilt was not reached: give the load's eccentricity_m instead".into(),
        })
    }
}
