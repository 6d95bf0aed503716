//! The contact of a case on cells, with the tilt that its load or its pose asks for.

use super::cell_deep::DeepMotion;
use super::scene::{Scene, Tilt};
use crate::base::{Error, Result, Secants};
use crate::case::Case;
use crate::cells::{CellPressure, CellProblem, CellTilt, Detrend, Grid, Heights, RoughGap, WIDER};
use crate::contact::{Gap, Shaped};

/// Most contacts that are solved until a tilt is reached that is held.
const MOST_TRIALS: usize = 10;

/// Error of a tilt that is held, as the displacement of the line's end (C^2 / (2 R)).
const TILT_ERROR: f64 = 1e-6;

/// Most cells in a direction of the grid on which such a tilt is sought first.
const SEARCH: usize = 96;

/// Depth to which surfaces may penetrate each other beyond the cells, as a part of the height up to
/// which the parabola between smooth bodies can touch.
const PENETRATION: f64 = 1e-6;

/// A contact on cells.
pub(super) struct CellContact<'a> {
    /// The problem, with the tilt of far points.
    pub problem: CellProblem,
    scene: &'a Scene,
    smooth: Shaped,
    /// Heights less their mean, with C and the unit of gaps (m).
    heights: Option<(Heights, [f64; 2])>,
    /// Their mean (C^2 / (2 R)). It changes the approach alone, and where it is large beside their
    /// range it would take digits of everything.
    mean_height: f64,
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
        let heights = case.heights();
        Self {
            problem: scene.on_cells(grid, tolerance),
            scene,
            smooth: scene.gap_on_cells(),
            mean_height: heights.as_ref().map_or(0.0, |heights| heights.mean_m() / unit_m),
            heights: heights.map(|heights| (heights.without(Detrend::Mean), [c_m, unit_m])),
            progress,
            depth,
        }
    }

    /// The pressures, and the approach and the tilt at the depth of the roller's radius.
    ///
    /// Far points tilt against those at this depth, as the load lies along the line, so that a tilt
    /// that is held has to be sought: first on few cells.
    ///
    /// # Errors
    /// As [`CellProblem::solve`]; [`Error::Uncovered`] also where heights touch beyond the cells,
    /// and [`Error::NotConverged`] where a held tilt is not reached.
    pub fn solve(&self) -> Result<(CellPressure, DeepMotion)> {
        let (mut pressure, mut motion) = self.solve_within()?;
        self.check_beyond(&pressure)?;
        pressure.approach -= self.mean_height;
        motion.approach -= self.mean_height;
        Ok((pressure, motion))
    }

    /// [`CellContact::solve`], whatever lies beyond the cells.
    fn solve_within(&self) -> Result<(CellPressure, DeepMotion)> {
        match self.scene.tilt {
            Tilt::Held(wanted) if !self.scene.span().symmetric => {
                let mut few = self.problem.clone();
                few.grid.nx = few.grid.nx.min(SEARCH);
                few.grid.ny = few.grid.ny.min(SEARCH);
                let (mut far, mut secants) = (wanted, Secants::new());
                if few.grid != self.problem.grid {
                    self.held(&few, wanted, &mut far, &mut secants)?;
                    secants = secants.of_another();
                }
                self.held(&self.problem, wanted, &mut far, &mut secants)
            }
            _ => {
                let pressure = self.pressed(&self.problem, None)?;
                let motion = self.motion(&self.problem, &pressure);
                Ok((pressure, motion))
            }
        }
    }

    /// The motion at the depth of the roller's radius.
    fn motion(&self, problem: &CellProblem, pressure: &CellPressure) -> DeepMotion {
        DeepMotion::new(self.scene, problem, pressure, self.depth)
    }

    /// The pressures of `problem`, from those `first` on the same cells if there are some.
    fn pressed(&self, problem: &CellProblem, first: Option<&CellPressure>) -> Result<CellPressure> {
        self.with_gap(&problem.grid, |gap| problem.solve_telling(gap, first, self.progress))?
    }

    /// The answer of `of` to the gap before loading on the cells of `grid`.
    fn with_gap<T>(&self, grid: &Grid, of: impl FnOnce(&dyn Gap) -> T) -> Result<T> {
        match &self.heights {
            None => Ok(of(&self.smooth)),
            Some((heights, [c_m, unit_m])) => {
                RoughGap::new(&self.smooth, heights, grid, *c_m, *unit_m).map(|gap| of(&gap))
            }
        }
    }

    /// Refuses a contact whose surfaces penetrate each other beyond the cells, as far as there are
    /// heights: asperities stand there on their own.
    fn check_beyond(&self, pressure: &CellPressure) -> Result<()> {
        let Some((heights, [c_m, unit_m])) = &self.heights else { return Ok(()) };
        let grid = &pressure.grid;
        let (a, _) = grid.half_sides();
        // A profile may be counted from anywhere, and the approach with it.
        let rows = (0..grid.ny).map(|j| self.smooth.at(0.0, grid.y(j)));
        let lowest = rows.fold(f64::INFINITY, f64::min);
        let closed = pressure.approach + pressure.tilt.abs() * grid.half_length - lowest;
        // Where the parabola alone is higher than all that closes it nothing touches.
        let most = (closed + heights.highest_m() / unit_m).max(0.0);
        let reach = most.sqrt().min(heights.half_spans_m()[0] / c_m);
        let more = ((reach - grid.half_width - a) / (2.0 * a) + 1.0).max(0.0) as usize;
        if more == 0 {
            return Ok(());
        }
        let nx = grid.nx + 2 * more;
        let wide = Grid { nx, half_width: a * nx as f64, ..*grid };
        let none = vec![0.0; more];
        let row = |row: &[f64]| [&none[..], row, &none].concat();
        let padded = CellPressure {
            grid: wide,
            pressure: pressure.pressure.chunks_exact(grid.nx).flat_map(row).collect(),
            gap: Vec::new(),
            ..*pressure
        };
        let problem = CellProblem { grid: wide, ..self.problem.clone() };
        let gaps = self.with_gap(&wide, |gap| problem.gaps(gap, &padded))?;
        let beyond = |i: usize| !(more..more + grid.nx).contains(&(i % nx));
        let deep = |gap: f64| gap < -PENETRATION * most;
        let touched = gaps.iter().enumerate().filter(|(i, gap)| beyond(*i) && deep(**gap));
        let place = |i: usize| (wide.x(i % nx).abs(), wide.y(i / nx));
        let Some((i, _)) = touched.max_by(|a, b| place(a.0).0.total_cmp(&place(b.0).0)) else {
            return Ok(());
        };
        let (x, y) = place(i);
        Err(Error::Uncovered {
            half_width: grid.half_width,
            touched: x + a,
            reason: format!(
                "beyond them heights touch, as at |x| = {x:.4} C and {y:.4} C from their middle"
            ),
            remedy: WIDER.into(),
        })
    }

    /// The contact on the cells of `problem` whose tilt at the depth is the `wanted` one, by
    /// `secants` over that of `far` points, from one to try first.
    fn held(
        &self,
        problem: &CellProblem,
        wanted: f64,
        far: &mut f64,
        secants: &mut Secants,
    ) -> Result<(CellPressure, DeepMotion)> {
        let mut problem = problem.clone();
        let mut pressed: Option<CellPressure> = None;
        let mut off = f64::INFINITY;
        for _ in 0..MOST_TRIALS {
            problem.tilt = CellTilt::Held(*far);
            let mut found = self.pressed(&problem, pressed.as_ref())?;
            found.iterations += pressed.map_or(0, |last| last.iterations);
            let motion = self.motion(&problem, &found);
            off = motion.tilt - wanted;
            if off.abs() * self.scene.half_length <= TILT_ERROR {
                return Ok((found, motion));
            }
            *far = secants.next(*far, off);
            pressed = Some(found);
        }
        Err(Error::NotConverged {
            iterations: MOST_TRIALS,
            residual: off.abs(),
            remedy: "the held tilt was not reached: give the load's eccentricity_m instead".into(),
        })
    }
}
