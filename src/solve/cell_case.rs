//! A case solved on uniform cells of constant pressure.

use super::cell_contact::CellContact;
use super::cell_deep::DeepMotion;
use super::cell_stress::Stressed;
use super::cells::{PressureCell, contact_ends, largest, line_loads, load_error};
use super::options::Options;
use super::scene::Scene;
use super::shaping::Shaping;
use super::solved::{Solution, most_stressed};
use super::solved_scene::Seconds;
use super::summary::{CriticalSummary, Summary};
use crate::base::number::stated;
use crate::base::{Error, HertzScales, Result, StressTensor};
use crate::body::EdgeModel;
use crate::case::Case;
use crate::cells::{CellPressure, CellProblem, Grid, Heights};
use crate::stress::curves::across_contact;
use crate::stress::{Curves, LineLoad, PressureLine};
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

/// Most cells in a direction where heights ask for as many as they have.
const MOST_SAMPLES: usize = 1024;

/// Most cells in a direction.
pub const MOST_CELLS: usize = 65536;

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
    /// Real contact area (m^2): that of the cells under pressure.
    #[serde(default)]
    pub contact_area_m2: f64,
    /// Mean gap over the cells within C of the line x = 0 (m).
    #[serde(default)]
    pub mean_gap_m: f64,
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
    /// y of the grid's middle, that of the overlap (C).
    pub middle: f64,
}

impl CellSolution {
    /// The pressure at (`x`, `y`) (p0); `y` (C) counts from the roller's middle, as everywhere but
    /// on the grid itself.
    pub fn pressure_at(&self, x: f64, y: f64) -> f64 {
        self.pressure.at(x, y - self.middle)
    }
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

/// Refuses a case that cells do not take, by this `method` and with these options; the first grid
/// that is tried for others.
///
/// # Errors
/// [`Error::Value`] with what to do.
pub fn check_cells(case: &Case, method: EdgeModel, cells: &CellOptions) -> Result<Grid> {
    case.check_force("cells take a force")?;
    let scene = Scene::new(case, method, None);
    if scene.slides {
        return Err(Error::Value {
            key: "sliding.friction".into(),
            value: stated(case.sliding.friction),
            reason: "cells carry pressures only".into(),
            remedy: match case.surface {
                Some(_) => "remove [sliding], or [surface] for --engine line",
                None => "solve this case with --engine line, or without friction",
            }
            .into(),
        });
    }
    let region = Region::new(case, &scene, cells);
    let grid = region.first()?;
    if let Some(heights) = case.heights() {
        check_steps(case, &heights)?;
        heights.check_covers(&grid, case.hertz().c_m)?;
    }
    Ok(grid)
}

/// Refuses heights of which no two lie over the contact: they are no roughness of it, and their
/// distances most likely of another unit.
fn check_steps(case: &Case, heights: &Heights) -> Result<()> {
    let [from, to] = case.overlap_m();
    let sides_m = [2.0 * case.hertz().c_m, to - from];
    let names = [("surface.dx_m", "wide"), ("surface.dy_m", "long")];
    for ((step_m, side_m), (key, how)) in heights.steps_m().into_iter().zip(sides_m).zip(names) {
        if step_m > side_m {
            return Err(Error::Value {
                key: key.into(),
                value: format!("{step_m:e}"),
                reason: format!(
                    "neighbouring heights are further apart than the contact is {how}, {side_m:.3e} m"
                ),
                remedy: "give the distance in metres: a micrometre is 1e-6".into(),
            });
        }
    }
    Ok(())
}

/// The region of the cells.
struct Region {
    half_length: f64,
    counts: Option<[usize; 2]>,
    /// Half-width that is given (C).
    given: Option<f64>,
    /// Half-spans and distances of the heights across and along (C).
    samples: Option<([f64; 2], [f64; 2])>,
    c_m: f64,
}

impl Region {
    fn new(case: &Case, scene: &Scene, cells: &CellOptions) -> Self {
        let c_m = case.hertz().c_m;
        let samples = case.surface.as_ref().zip(case.heights()).map(|(surface, heights)| {
            let steps = [surface.dx_m, surface.dy_m];
            (heights.half_spans_m().map(|v| v / c_m), steps.map(|v| v / c_m))
        });
        let given = case.cells.map(|cells| cells.half_width_m / c_m);
        Self { half_length: scene.half_length, counts: cells.counts, given, samples, c_m }
    }

    /// The first grid to try.
    fn first(&self) -> Result<Grid> {
        self.grid(self.given.unwrap_or(FIRST_WIDTH))
    }

    /// A wider grid than that of an `error` that tells how wide it has to be.
    ///
    /// # Errors
    /// The `error` itself where the half-width is given, and where there are no more heights.
    fn wider(&self, error: Error) -> Result<Grid> {
        let Error::Uncovered { half_width, touched, ref reason, .. } = error else {
            return Err(error);
        };
        if self.given.is_some() {
            return Err(error);
        }
        let next = self.grid(touched.max(half_width * GROWTH))?;
        if next.half_width > half_width * (1.0 + 1e-9) {
            return Ok(next);
        }
        let (reason, remedy) = (
            format!("{reason}, where the heights end"),
            "give heights that reach farther along x, or check dx_m".into(),
        );
        Err(Error::Uncovered { half_width, touched, reason, remedy })
    }

    /// Cells over the contact up to `half_width` (C), less where it is not given and the heights
    /// end before.
    fn grid(&self, half_width: f64) -> Result<Grid> {
        let [nx, ny] = match self.counts {
            Some(counts) => counts,
            None => self.counts(half_width)?,
        };
        let covered = |([span, _], _): ([f64; 2], _)| span * nx as f64 / (nx as f64 - 1.0);
        let most = match self.given {
            Some(_) => f64::INFINITY,
            None => self.samples.map_or(f64::INFINITY, covered),
        };
        let grid = Grid::new(nx, ny, half_width.min(most), self.half_length);
        match self.samples {
            Some((_, steps)) if self.counts.is_none() => grid.map_err(|e| self.unlike(steps, e)),
            _ => grid,
        }
    }

    /// The error about cells that follow from the `steps` between the samples (C).
    fn unlike(&self, steps: [f64; 2], error: Error) -> Error {
        let Error::Value { reason, .. } = error else { return error };
        let [dx_m, dy_m] = steps.map(|step| stated(step * self.c_m));
        Error::Value {
            key: "surface.dx_m".into(),
            reason: format!("with dy_m = {dy_m}, {reason}"),
            value: dx_m,
            remedy: "check both distances of the samples (m), or give --cells".into(),
        }
    }

    /// Even numbers of cells twice as long as wide, longer only where there would be too many, and
    /// wider only over a contact that is much shorter than wide; with heights as many as samples.
    ///
    /// # Errors
    /// [`Error::Value`] where a given half-width takes too many.
    fn counts(&self, half_width: f64) -> Result<[usize; 2]> {
        let even = |n: f64| 2.0 * (0.5 * n).ceil();
        let ratio = self.half_length / half_width;
        let fewest = self.fewest(half_width);
        let (nx, ny) = if let Some((_, steps)) = self.samples {
            let sides = [half_width, self.half_length];
            let samples = |i: usize| (2.0 * sides[i] / steps[i]).min(MOST_SAMPLES as f64);
            (even(samples(0).max(fewest)), even(samples(1).max(ACROSS as f64)))
        } else {
            (fewest, (0.5 * fewest * ratio).clamp(ACROSS as f64, MOST_ALONG as f64))
        };
        // As many in each direction as the slenderest cells ask for.
        let across = nx.max(ny / (LONGEST * ratio));
        let counts = [across, ny.max(across * ratio / LONGEST)];
        let counts = counts.map(even);
        if counts.iter().any(|n| *n > MOST_CELLS as f64) {
            return Err(Error::Value {
                key: "cells.half_width_m".into(),
                value: stated(half_width * self.c_m),
                reason: format!(
                    "it takes {:.0} x {:.0} cells, more than {MOST_CELLS} in a direction",
                    counts[0], counts[1]
                ),
                remedy: "give one that just covers the contact, none, or --cells".into(),
            });
        }
        Ok(counts.map(|n| n as usize))
    }

    /// Fewest cells across a region of this `half_width` (C). A region that follows the contact of
    /// smooth bodies has as many whatever the width; in one that is given, or that heights widen,
    /// the contact may be narrow, and cells are as wide as in the first region at most.
    fn fewest(&self, half_width: f64) -> f64 {
        let fine = ACROSS as f64 * (half_width / FIRST_WIDTH).max(1.0);
        match (self.given, self.samples) {
            (Some(_), _) => fine,
            (None, Some(_)) => fine.min(MOST_SAMPLES as f64),
            (None, None) => ACROSS as f64,
        }
    }
}

/// Solves `case` on cells; tells `progress` of the iteration's steps and its residual.
///
/// # Errors
/// [`Error::Value`] when `options` ask for what does not exist, and for cells that do not suit;
/// else as [`CellProblem::solve`].
pub fn solve_on_cells(
    case: &Case,
    options: &Options,
    cells: &CellOptions,
    progress: &dyn Fn(usize, f64),
) -> Result<CellSolution> {
    options.check(case)?;
    check_cells(case, options.method, cells)?;
    let scene = Scene::new(case, options.method, options.psi);
    let start = Instant::now();
    let region = Region::new(case, &scene, cells);
    let mut contact = CellContact::new(case, &scene, region.first()?, cells.tolerance, progress);
    let setup = start.elapsed().as_secs_f64();
    let (pressure, motion) = covering(&mut contact, &region)?;
    let problem = contact.problem;
    let solved = start.elapsed().as_secs_f64();
    let stressed = Stressed::new(case, &scene, options, &problem, &pressure);
    let total = start.elapsed().as_secs_f64();
    let seconds = Seconds { setup, contact: solved - setup, stress: total - solved, total };
    let found = Found { case, scene: &scene, problem: &problem, pressure: &pressure, motion };
    let solution = found.solution(stressed, seconds);
    Ok(CellSolution { solution, pressure, middle: scene.middle })
}

/// The pressures of `contact` and its motion on cells of `region` that cover it.
fn covering(contact: &mut CellContact, region: &Region) -> Result<(CellPressure, DeepMotion)> {
    let mut growths = MOST_GROWTHS;
    loop {
        match contact.solve() {
            Err(error @ Error::Uncovered { .. }) if growths > 0 => {
                growths -= 1;
                contact.problem.grid = region.wider(error)?;
            }
            found => return found,
        }
    }
}

/// A contact under one of several loads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadStep {
    /// Load (N).
    pub force_n: f64,
    /// Approach of points one roller radius deep (m).
    pub approach_m: f64,
    /// Mean gap over the cells within C of the line x = 0, C that of the case's own load (m).
    pub mean_gap_m: f64,
    /// Real contact area (m^2).
    pub contact_area_m2: f64,
    /// Largest pressure (Pa).
    pub p_max_pa: f64,
}

/// Solves the contact of `case` on cells under each of `forces` (N) in place of its own, each as if
/// it were the only one.
///
/// # Errors
/// As [`solve_on_cells`].
pub fn loads_on_cells(
    case: &Case,
    options: &Options,
    cells: &CellOptions,
    forces: &[f64],
    progress: &dyn Fn(usize, f64),
) -> Result<Vec<LoadStep>> {
    check_cells(case, options.method, cells)?;
    let scene = Scene::new(case, options.method, options.psi);
    let region = Region::new(case, &scene, cells);
    let first = region.first()?;
    let mut contact = CellContact::new(case, &scene, first, cells.tolerance, progress);
    let HertzScales { c_m, p0_pa, .. } = case.hertz();
    let unit_m = case.gap_unit_m();
    let step = |&force_n: &f64| {
        // Another force may have widened the region, and so its cells.
        contact.problem.grid = first;
        contact.problem.load = scene.load * force_n / case.load.force_n;
        let (pressure, motion) = covering(&mut contact, &region)?;
        Ok(LoadStep {
            force_n,
            approach_m: motion.approach * unit_m,
            mean_gap_m: pressure.mean_gap() * unit_m,
            contact_area_m2: pressure.contact_area() * c_m * c_m,
            p_max_pa: pressure.pressure.iter().fold(0.0, |m: f64, p| m.max(*p)) * p0_pa,
        })
    };
    forces.iter().map(step).collect()
}

/// Stresses (p0) at the points of `options` under the `pressure` that [`solve_on_cells`] found for
/// `case`.
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

/// What was found of a case.
struct Found<'a> {
    case: &'a Case,
    scene: &'a Scene,
    problem: &'a CellProblem,
    pressure: &'a CellPressure,
    /// The motion at the depth of the roller's radius.
    motion: DeepMotion,
}

impl Found<'_> {
    fn solution(&self, stressed: Stressed, seconds: Seconds) -> Solution<CellDetails> {
        let (pressure, hertz) = (self.pressure, self.case.hertz());
        let (grid, middle) = (&pressure.grid, self.scene.middle);
        let (a, b) = grid.half_sides();
        let cell = |(i, p): (usize, &f64)| PressureCell {
            x: grid.x(i % grid.nx),
            y: grid.y(i / grid.nx) + middle,
            dx: 2.0 * a,
            dy: 2.0 * b,
            p: *p,
        };
        let cells: Vec<PressureCell> = pressure.pressure.iter().enumerate().map(cell).collect();
        let line_loads = line_loads(pressure, middle);
        let curves = Curves {
            hertz,
            pressure: pressure_lines(self.scene, pressure),
            stress: stressed.curves,
        };
        let critical = most_stressed(&curves, &self.scene.span());
        let summary = self.summary(&cells, &line_loads, critical, seconds);
        Solution { summary, curves, cells, line_loads, points: stressed.points }
    }

    fn summary(
        &self,
        cells: &[PressureCell],
        line_loads: &[LineLoad],
        critical: Option<CriticalSummary>,
        seconds: Seconds,
    ) -> Summary<CellDetails> {
        let (case, scene, pressure) = (self.case, self.scene, self.pressure);
        let hertz = case.hertz();
        let HertzScales { c_m, p0_pa, .. } = hertz;
        let slope = c_m / (2.0 * case.equivalent_radius_m());
        let top = largest(cells);
        // Mirror images have the same pressure.
        let mirrored = |v: f64, even: bool| if even { v.abs() } else { v };
        let even = scene.span().symmetric;
        Summary {
            case: case.name.clone(),
            method: scene.model,
            hertz,
            load_n: case.load.force_n,
            approach_m: self.motion.approach * c_m * slope,
            tilt_rad: self.motion.tilt * slope,
            p_centre_pa: pressure.at(0.0, scene.off_middle(scene.span().centre())) * p0_pa,
            p_max_pa: top.p * p0_pa,
            p_max_at_m: [mirrored(top.x, !scene.rough), mirrored(top.y, even)].map(|v| v * c_m),
            centre_of_pressure_m: if even { [0.0; 2] } else { centre(cells).map(|v| v * c_m) },
            contact_y_m: contact_ends(line_loads).at.map(|y| y * c_m),
            converged: true,
            iterations: pressure.iterations,
            load_error_rel: load_error(cells, case),
            seconds,
            critical,
            details: self.details(),
        }
    }

    fn details(&self) -> CellDetails {
        let (case, grid) = (self.case, &self.pressure.grid);
        let HertzScales { c_m, p0_pa, .. } = case.hertz();
        let radius_m = case.roller.radius_m;
        CellDetails {
            engine: "cells".into(),
            cells: [grid.nx, grid.ny],
            half_width_m: grid.half_width * c_m,
            tolerance: self.problem.tolerance,
            residual: self.pressure.residual,
            contact_area_m2: self.pressure.contact_area() * c_m * c_m,
            mean_gap_m: self.pressure.mean_gap() * case.gap_unit_m(),
            approach_reference_m: radius_m,
            roller_diametral_tension_pa: Shaping::of(case).roller_tension() * p0_pa,
        }
    }
}

/// x and y of the line of action of the pressures' resultant (C).
fn centre(cells: &[PressureCell]) -> [f64; 2] {
    let sum = |of: fn(&PressureCell) -> f64| cells.iter().map(|c| c.p * of(c)).sum::<f64>();
    let total = sum(|_| 1.0);
    [sum(|c| c.x) / total, sum(|c| c.y) / total]
}

/// The pressures of the cells that the two standard lines go through.
fn pressure_lines(scene: &Scene, pressure: &CellPressure) -> Vec<PressureLine> {
    let (span, grid) = (scene.span(), &pressure.grid);
    // A rough contact has other pressures on every cell.
    let (across, along): (Vec<f64>, Vec<f64>) = match scene.rough {
        true => (
            (0..grid.nx).map(|i| grid.x(i)).collect(),
            (0..grid.ny).map(|j| grid.y(j) + scene.middle).collect(),
        ),
        false => (across_contact(), span.contact_line()),
    };
    let p = |[x, y]: [f64; 2]| pressure.at(x, scene.off_middle(y));
    PressureLine::standard(along, across, span.centre(), p)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A region over a contact of half-length 5 C with samples that are 1 C apart, or smooth.
    fn region(given: Option<f64>, rough: bool) -> Region {
        let samples = rough.then_some(([100.0, 5.0], [1.0, 1.0]));
        Region { half_length: 5.0, counts: None, given, samples, c_m: 1e-4 }
    }

    #[test]
    fn cells_of_a_wider_region_are_no_wider() {
        for rough in [false, true] {
            let first = region(None, rough).first().unwrap();
            for half_width in [0.5, FIRST_WIDTH, 10.0, 400.0] {
                let grid = region(Some(half_width), rough).first().unwrap();
                let (widest, across) = (first.half_sides().0, grid.half_sides().0);
                assert!(across <= widest * (1.0 + 1e-12), "{half_width}: {across} {widest}");
                assert!(grid.nx <= 64.max((51.2 * half_width) as usize + 2), "{grid:?}");
                assert!(grid.ny >= first.ny && grid.half_width == half_width, "{grid:?}");
            }
            // Heights that touch far out take no more cells than fine heights do.
            let touched = region(None, rough).grid(50.0).unwrap();
            assert_eq!(touched.nx, if rough { MOST_SAMPLES } else { ACROSS });
        }
    }

    #[test]
    fn cells_over_a_contact_much_shorter_than_wide_suit_it() {
        for half_length in [1e-3, 0.02, 0.3] {
            let grid = Region { half_length, ..region(None, false) }.first().unwrap();
            let (a, b) = grid.half_sides();
            assert!(a <= LONGEST * b * (1.0 + 1e-9) && grid.ny >= ACROSS, "{grid:?}");
        }
    }

    #[test]
    fn a_region_that_takes_too_many_cells_is_refused() {
        for (half_width, counts) in [(1e5, "5120000 x 128"), (1e-5, "64 x 2000000")] {
            let said = region(Some(half_width), false).first().unwrap_err().to_string();
            let value = stated(half_width * 1e-4);
            assert!(
                said.starts_with(&format!("cells.half_width_m = {value} is not valid")),
                "{said}"
            );
            assert!(said.contains(counts) && said.contains("--cells"), "{said}");
        }
    }
}
