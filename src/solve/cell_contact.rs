//! The contact of a case on cells, with the tilt that its load or its pose asks for.

use super::cells::{contact_ends, line_loads};
use super::on_cells::Placed;
use super::scene::{Scene, SceneBody, Tilt};
use super::tilt::{self, Touch};
use crate::base::{BodyKind, Error, Panels, Parity, PerBody, Result, Wavenumbers};
use crate::body::{Shape, Stack};
use crate::case::Case;
use crate::cells::{CellPressure, CellProblem, CellTilt, Columns, Grid, Heights, RoughGap};
use crate::stress::{Field, Load};

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
    deep: Option<DeepTilt<'a>>,
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
            deep: (!scene.is_symmetric()).then(|| DeepTilt::new(scene, depth)),
        }
    }

    /// The pressures, and the tilt at the depth of the roller's radius (C / (2 R)).
    ///
    /// Far points tilt against those at this depth. By how much is taken from the smooth surfaces: heights change
    /// the load's distribution at their own scale, not along the contact.
    ///
    /// # Errors
    /// As [`CellProblem::solve`]; [`Error::NotConverged`] where a held tilt is not reached.
    pub fn solve(&mut self) -> Result<(CellPressure, f64)> {
        let Some(deep) = &self.deep else {
            return Ok((self.with_heights(&self.problem)?, 0.0));
        };
        let mut problem = self.problem.clone();
        let (smooth, tilt) = match self.scene.tilt {
            Tilt::Held(wanted) => {
                let Grid { nx, ny, .. } = problem.grid;
                problem.grid.nx = nx.min(SEARCH);
                problem.grid.ny = ny.min(SEARCH);
                let (first, _) = self.held(&problem, deep, wanted, wanted)?;
                problem.grid = self.problem.grid;
                self.held(&problem, deep, wanted, first.tilt)?
            }
            Tilt::Free(_) => {
                let smooth = self.without_heights(&problem)?;
                let tilt = deep.of(&smooth);
                (smooth, tilt)
            }
        };
        if self.heights.is_none() {
            return Ok((smooth, tilt));
        }
        if let Tilt::Held(_) = self.scene.tilt {
            problem.tilt = CellTilt::Held(smooth.tilt);
        }
        let rough = self.with_heights(&problem)?;
        let tilt = tilt + rough.tilt - smooth.tilt;
        Ok((rough, tilt))
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

    /// Mean gap (C^2 / (2 R)) under `pressure` over the cells within C of the line x = 0.
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
        let near: Vec<f64> = gaps
            .iter()
            .enumerate()
            .filter(|(i, _)| grid.x(i % grid.nx).abs() <= 1.0)
            .map(|(_, gap)| gap.max(0.0))
            .collect();
        near.iter().sum::<f64>() / near.len() as f64
    }

    /// The smooth contact whose tilt at the depth is `wanted`, and this tilt, from the tilt `first` of far points.
    fn held(
        &self,
        problem: &CellProblem,
        deep: &DeepTilt,
        wanted: f64,
        first: f64,
    ) -> Result<(CellPressure, f64)> {
        let mut problem = problem.clone();
        let mut far = first;
        let mut last: Option<[f64; 2]> = None;
        for _ in 0..MOST_TRIALS {
            problem.tilt = CellTilt::Held(far);
            let found = self.without_heights(&problem)?;
            let tilt = deep.of(&found);
            let off = tilt - wanted;
            if off.abs() * self.scene.half_length <= TILT_ERROR {
                return Ok((found, tilt));
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

/// What the tilt at a depth is computed with: the bodies on nodes along the contact.
struct DeepTilt<'a> {
    scene: &'a Scene,
    depth: f64,
    axis: Panels,
    wavenumbers: Wavenumbers,
    stacks: PerBody<Stack>,
}

impl<'a> DeepTilt<'a> {
    /// The tilt of `scene` at `depth` (C).
    fn new(scene: &'a Scene, depth: f64) -> Self {
        let resolution = scene.resolution(scene.tolerance, None);
        let ends = [-scene.half_length, scene.half_length];
        let (axis, _) = resolution.contact_line(ends, [None; 2], &[], false);
        let longest = scene.bodies.iter().fold(0.0, |m: f64, b| m.max(b.half));
        let wavenumbers = resolution.wavenumbers(longest, Parity::Odd);
        let coarse = wavenumbers.coarse().nodes();
        let stack = |kind: BodyKind| {
            let SceneBody { half, middle, nu, .. } = scene.bodies[kind];
            let place = (scene.off_middle(middle), Shape { half, nu });
            Stack::new(&axis, (false, false), place, scene.end(kind), (&resolution, coarse))
        };
        let stacks = PerBody { block: stack(BodyKind::Block), roller: stack(BodyKind::Roller) };
        Self { scene, depth, stacks, axis, wavenumbers }
    }

    /// The tilt (C / (2 R)) under the pressures of cells on smooth surfaces.
    fn of(&self, pressure: &CellPressure) -> f64 {
        let scene = self.scene;
        let columns = Columns::new(pressure, &self.axis, false, scene.end_exponents());
        let moments = columns.moments(&self.wavenumbers);
        let field = |kind: BodyKind| {
            let stack = &self.stacks[kind];
            Field::new(stack, &self.wavenumbers, &columns, &moments, None, scene.tolerance)
        };
        let fields = PerBody { block: field(BodyKind::Block), roller: field(BodyKind::Roller) };
        let below = |kind: BodyKind, y: f64, zs: &[f64]| {
            let rows = fields[kind].down(&[0.0], scene.off_middle(y), zs);
            rows.iter().map(|row| row[0].pressure).collect()
        };
        let loads = line_loads(pressure, scene.middle);
        let moment = loads.iter().map(|l| l.weight * l.load * l.y).sum();
        let touch = Touch { ends: contact_ends(&loads), moment };
        tilt::tilt(scene, &below, &touch, self.depth)
    }
}
