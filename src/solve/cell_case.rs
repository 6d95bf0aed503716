//! A case solved on uniform cells of constant pressure.

use super::cells::{PressureCell, largest};
use super::lines;
use super::options::Options;
use super::scene::Scene;
use super::shaping::Shaping;
use super::solved::{Solution, most_stressed, wanted_curves};
use super::solved_scene::Seconds;
use super::summary::{CriticalSummary, Summary};
use crate::base::{Error, HertzScales, Result, StressTensor};
use crate::body::EdgeModel;
use crate::case::Case;
use crate::cells::{CellField, CellPressure, CellProblem, Columns, Grid};
use crate::stress::curves::across_contact;
use crate::stress::round::LocalContact;
use crate::stress::{
    BodyField, BodyKind, CurveSpec, Curves, LineLoad, Load, PressureLine, RoundStress, StressCurve,
    Work, round,
};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// Cells across the contact, and most of them along it, where none are asked for.
const ACROSS: usize = 64;
const MOST_ALONG: usize = 512;

/// How many times as long as wide cells are at most where none are asked for.
const LONGEST: f64 = 16.0;

/// First half-width of the region (C), and its growth until it covers the contact.
const FIRST_WIDTH: f64 = 1.25;
const GROWTH: f64 = 1.25;
const MOST_GROWTHS: usize = 8;

/// Step of the difference quotient along x (C).
const STEP: f64 = 1e-4;

/// How a case was solved on cells.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct CellDetails {
    /// `cells`.
    pub engine: String,
    /// Cells across and along the contact.
    pub cells: [usize; 2],
    /// Half-width of the region of cells (m).
    pub half_width_m: f64,
    /// Relative residual asked for.
    pub tolerance: f64,
    /// Relative residual reached.
    pub residual: f64,
    /// Depth of the points whose approach is given (m).
    pub approach_reference_m: f64,
    /// The even tension of the squeezed roller (Pa).
    pub roller_diametral_tension_pa: f64,
}

/// A case's solution on cells.
#[derive(Debug, Clone, PartialEq)]
pub struct CellSolution {
    /// The solution, its pressure on every cell of the region.
    pub solution: Solution<CellDetails>,
    /// The pressures (p0) with their grid (C).
    pub pressure: CellPressure,
}

/// How a case is solved on cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellOptions {
    /// Cells across and along the contact; by its shape if none.
    pub counts: Option<[usize; 2]>,
    /// Relative residual of the iteration.
    pub tolerance: f64,
}

impl Default for CellOptions {
    fn default() -> Self {
        Self { counts: None, tolerance: 1e-8 }
    }
}

/// Refuses a case that cells do not take.
///
/// # Errors
/// [`Error::Value`] with what to do.
pub fn check_cells(case: &Case) -> Result<()> {
    case.check_force("cells take a force")?;
    let scene = Scene::new(case, EdgeModel::HalfSpace, None);
    if scene.slides {
        return Err(Error::Value {
            key: "sliding.friction".into(),
            value: format!("{:e}", case.sliding.friction),
            reason: "cells carry pressures only".into(),
            remedy: "solve this case with --engine line, or without friction".into(),
        });
    }
    if scene.is_symmetric() && case.block.radius_m.is_none() {
        return Ok(());
    }
    let reason = "cells take bodies with their middles at one place, parallel, on a flat block";
    Err(Error::Value {
        key: "--engine".into(),
        value: "cells".into(),
        reason: reason.into(),
        remedy: "solve this case with --engine line".into(),
    })
}

/// Solves `case` on cells; tells `progress` of the iteration's steps and its residual.
///
/// # Errors
/// [`Error::Value`] when `options` ask for what does not exist, and for cells that do not suit; else as
/// [`CellProblem::solve`].
pub fn solve_on_cells(
    case: &Case,
    options: &Options,
    cells: &CellOptions,
    progress: &dyn Fn(usize, f64),
) -> Result<CellSolution> {
    options.check(case)?;
    check_cells(case)?;
    let scene = Scene::new(case, options.method, options.psi);
    let start = Instant::now();
    let half_width = case.cells.map(|cells| cells.half_width_m / case.hertz().c_m);
    let first = grid(&scene, cells.counts, half_width.unwrap_or(FIRST_WIDTH))?;
    let mut problem = scene.on_cells(first, cells.tolerance);
    let setup = start.elapsed().as_secs_f64();
    let mut growths = if half_width.is_some() { 0 } else { MOST_GROWTHS };
    let pressure = loop {
        match problem.solve_telling(&scene.gap(), progress) {
            Err(Error::Uncovered { .. }) if growths > 0 => growths -= 1,
            found => break found?,
        }
        problem.grid = grid(&scene, cells.counts, problem.grid.half_width * GROWTH)?;
    };
    let solved = start.elapsed().as_secs_f64();
    let stressed = Stressed::new(case, &scene, options, &problem, &pressure);
    let total = start.elapsed().as_secs_f64();
    let seconds = Seconds { setup, contact: solved - setup, stress: total - solved, total };
    let solution = stressed.solution(case, &scene, &problem, &pressure, seconds);
    Ok(CellSolution { solution, pressure })
}

/// Stresses (p0) at the points of `options` under the `pressure` that [`solve_on_cells`] found for `case`.
///
/// # Errors
/// [`Error::Value`] that names the first point outside its body.
pub fn stress_on_cells(
    case: &Case,
    options: &Options,
    pressure: &CellPressure,
) -> Result<Vec<StressTensor>> {
    options.check(case)?;
    let scene = Scene::new(case, options.method, options.psi);
    let problem = scene.on_cells(pressure.grid, CellOptions::default().tolerance);
    Ok(Stressed::new(case, &scene, options, &problem, pressure).points)
}

/// Cells over the contact of `scene` up to `half_width` (C): `counts` of them, or in even numbers twice as long as
/// wide, longer only where there would be too many.
fn grid(scene: &Scene, counts: Option<[usize; 2]>, half_width: f64) -> Result<Grid> {
    let [nx, ny] = counts.unwrap_or_else(|| {
        let square = ACROSS as f64 * scene.half_length / half_width;
        let along = (0.5 * square).min(MOST_ALONG as f64).max(square / LONGEST);
        [ACROSS, (2 * (0.5 * along).ceil() as usize).max(ACROSS)]
    });
    Grid::new(nx, ny, half_width, scene.half_length)
}

/// Curves and points with their stresses.
struct Stressed {
    curves: Vec<StressCurve>,
    points: Vec<StressTensor>,
}

impl Stressed {
    fn new(
        case: &Case,
        scene: &Scene,
        options: &Options,
        problem: &CellProblem,
        pressure: &CellPressure,
    ) -> Self {
        let HertzScales { c_m, .. } = case.hertz();
        let specs = wanted_curves(scene, options);
        let places: Vec<(BodyKind, [f64; 3])> =
            options.points.iter().map(|p| (p.body, p.at_m.map(|v| v / c_m))).collect();
        let found = match &problem.free {
            None => sums(scene, pressure, &specs, &places),
            Some(free) => {
                let columns = Columns::new(pressure, free.axis());
                let moments = columns.moments(free.wavenumbers());
                let field = |kind: BodyKind| {
                    let body = &scene.bodies[kind];
                    let own = (body.half, body.nu);
                    let field = free.field(own, &columns, &moments, scene.tolerance);
                    BodyField::new(field, 1.0)
                };
                lines::stresses(free.shared(), field, &specs, &places)
            }
        };
        let shaping = Shaping::of(case);
        let shaped = |body: BodyKind, stress: &RoundStress| shaping.stress(body, stress);
        let curves = specs.into_iter().zip(&found.curves).map(|(spec, stresses)| StressCurve {
            body: spec.body,
            name: spec.name.to_string(),
            stress: stresses.iter().map(|s| shaped(spec.body, s)).collect(),
            at: spec.points,
            own_error: None,
        });
        let points = options.points.iter().zip(&found.points);
        let points = points.map(|(point, s)| shaped(point.body, s)).collect();
        Self { curves: curves.collect(), points }
    }

    fn solution(
        self,
        case: &Case,
        scene: &Scene,
        problem: &CellProblem,
        pressure: &CellPressure,
        seconds: Seconds,
    ) -> Solution<CellDetails> {
        let hertz = case.hertz();
        let HertzScales { c_m, p0_pa, .. } = hertz;
        let (grid, radius_m) = (&pressure.grid, case.roller.radius_m);
        let (a, b) = grid.half_sides();
        let cell = |(i, p): (usize, &f64)| PressureCell {
            x: grid.x(i % grid.nx),
            y: grid.y(i / grid.nx),
            dx: 2.0 * a,
            dy: 2.0 * b,
            p: *p,
        };
        let cells: Vec<PressureCell> = pressure.pressure.iter().enumerate().map(cell).collect();
        let carried: f64 = cells.iter().map(|c| c.p * p0_pa * (c.dx * c_m) * (c.dy * c_m)).sum();
        let top = largest(&cells);
        let lines = pressure_lines(scene, pressure);
        let critical = most_stressed(&self.curves, &scene.span());
        let approach = pressure.approach - problem.mean_displacement(pressure, radius_m / c_m);
        let summary = Summary {
            case: case.name.clone(),
            method: scene.model,
            hertz,
            load_n: case.load.force_n,
            approach_m: approach * c_m * c_m / (2.0 * case.equivalent_radius_m()),
            tilt_rad: 0.0,
            p_centre_pa: pressure.at(0.0, 0.0) * p0_pa,
            p_max_pa: top.p * p0_pa,
            p_max_at_m: [top.x, top.y].map(|v| (v * c_m).abs()),
            centre_of_pressure_m: [0.0; 2],
            contact_y_m: contact_ends(pressure).map(|y| y * c_m),
            converged: true,
            iterations: pressure.iterations,
            load_error_rel: (carried / case.load.force_n - 1.0).abs(),
            seconds,
            critical: critical.map(|critical| CriticalSummary::new(&critical, &hertz)),
            details: CellDetails {
                engine: "cells".into(),
                cells: [grid.nx, grid.ny],
                half_width_m: grid.half_width * c_m,
                tolerance: problem.tolerance,
                residual: pressure.residual,
                approach_reference_m: radius_m,
                roller_diametral_tension_pa: round::DIAMETRAL_TENSION * c_m / radius_m * p0_pa,
            },
        };
        let curves = Curves { hertz, pressure: lines, stress: self.curves };
        let line_loads = line_loads(pressure);
        Solution { summary, curves, cells, line_loads, points: self.points }
    }
}

/// Love's sums on `curves` and at single `points` (C), where no end is free of traction.
fn sums(
    scene: &Scene,
    pressure: &CellPressure,
    curves: &[CurveSpec],
    points: &[(BodyKind, [f64; 3])],
) -> lines::Stresses {
    let fields = BodyKind::ALL
        .map(|kind| (kind, scene.cell_field(kind, pressure).expect("no end is free of traction")));
    let at = |kind: BodyKind, at: &[f64; 3]| {
        let (_, field) = fields.iter().find(|f| f.0 == kind).expect("one a body");
        rounded(field, *at)
    };
    let curve = |spec: &CurveSpec| spec.points.par_iter().map(|p| at(spec.body, p)).collect();
    lines::Stresses {
        curves: curves.iter().map(curve).collect(),
        points: points.par_iter().map(|(kind, p)| at(*kind, p)).collect(),
        work: Work::default(),
    }
}

/// The stress at `x`, `y`, `z`, with what a round surface adds.
fn rounded(field: &CellField, [x, y, z]: [f64; 3]) -> RoundStress {
    let flat = field.at(x, y, z);
    // Nothing moves along x at x = 0, nor on the surface.
    let slope = if x == 0.0 || z == 0.0 {
        StressTensor::default()
    } else {
        (field.at(x + STEP, y, z) - field.at(x - STEP, y, z)) * (0.5 / STEP)
    };
    RoundStress::new(x, z, flat, &slope, &LocalContact::HERTZ)
}

/// The load per length of each row of cells.
fn line_loads(pressure: &CellPressure) -> Vec<LineLoad> {
    let grid = &pressure.grid;
    let (a, b) = grid.half_sides();
    let row = |(j, row): (usize, &[f64])| LineLoad {
        y: grid.y(j),
        weight: 2.0 * b,
        load: 2.0 * a * row.iter().sum::<f64>(),
        half_width: a * row.iter().filter(|p| **p > 0.0).count() as f64,
    };
    pressure.pressure.chunks_exact(grid.nx).enumerate().map(row).collect()
}

/// The ends along y of the cells that carry a pressure.
fn contact_ends(pressure: &CellPressure) -> [f64; 2] {
    let lines = line_loads(pressure);
    let loaded = || lines.iter().filter(|line| line.load > 0.0);
    let end =
        |line: Option<&LineLoad>, side: f64| line.map_or(0.0, |l| l.y + side * 0.5 * l.weight);
    [end(loaded().next(), -1.0), end(loaded().next_back(), 1.0)]
}

/// The pressures of the cells that the two standard lines go through.
fn pressure_lines(scene: &Scene, pressure: &CellPressure) -> Vec<PressureLine> {
    let line = |name: &str, at: Vec<[f64; 2]>| PressureLine {
        name: name.to_string(),
        p: at.iter().map(|&[x, y]| pressure.at(x, y)).collect(),
        at,
        own_error: None,
    };
    let along = scene.span().contact_line();
    vec![
        line("along-y", along.into_iter().map(|y| [0.0, y]).collect()),
        line("along-x", across_contact().into_iter().map(|x| [x, 0.0]).collect()),
    ]
}
