//! A solved case: the scene's solution with the case's own scales and roller. It gives pressures
//! and stresses at any points.

use super::approached::{approach_m, with_force};
use super::cells::{PressureCell, largest, load_error, pressure_cells};
use super::edge::{Side, edge_strength};
use super::extent::{Extent, check_points};
use super::grid::check_grid;
use super::lines;
use super::options::Options;
use super::scene::Scene;
use super::shaping::Shaping;
use super::solved_scene::{Seconds, SolvedScene};
use super::summary::{CriticalSummary, Details, Summary, WorkSummary};
use crate::base::{HertzScales, Result, StressTensor};
use crate::body::EdgeModel;
use crate::case::Case;
use crate::stress::curves::{Span, across_contact, curves_on};
use crate::stress::grid::on_grid;
use crate::stress::{
    BodyKind, Critical, CurveSpec, Curves, EDGE, Grid, GridStress, LineLoad, Load, PressureLine,
    RoundStress, StressCurve, away_from_edges,
};
use std::sync::Arc;
use std::time::Instant;

/// A case whose contact is solved. Lengths are in units of C, stresses and pressures in units of
/// p0.
#[derive(Debug, Clone)]
pub struct SolvedCase {
    case: Case,
    options: Options,
    hertz: HertzScales,
    scene: Arc<SolvedScene>,
}

/// The solution of a case by one method; `D` is what its engine says besides.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution<D = Details> {
    /// The results in numbers, in SI units.
    pub summary: Summary<D>,
    /// The contact pressure on the two standard lines, and stresses on the curves of the options.
    pub curves: Curves,
    /// The contact pressure in cells.
    pub cells: Vec<PressureCell>,
    /// The load per length along the whole contact, in ascending order of y.
    pub line_loads: Vec<LineLoad>,
    /// Stresses at the extra points (p0), in their order.
    pub points: Vec<StressTensor>,
}

impl<D> Solution<D> {
    /// The same with other details.
    pub fn map_details<E>(self, of: impl FnOnce(D) -> E) -> Solution<E> {
        let Self { summary, curves, cells, line_loads, points } = self;
        Solution { summary: summary.map_details(of), curves, cells, line_loads, points }
    }
}

/// The stresses of the curves and points of [`Options`] before the roller's round shape is added.
/// Cases of one scene share them.
pub(super) struct SharedStresses {
    specs: Vec<CurveSpec>,
    found: lines::Stresses,
    seconds: f64,
}

impl SolvedCase {
    /// Solves the contact of `case`.
    ///
    /// # Errors
    /// [`Error::Value`] when `options` name an unknown curve or a point outside its body, or where
    /// no legal force causes the approach that the case asks for; [`Error::NotConverged`] and
    /// [`Error::Unsound`] as [`SolvedScene::new`].
    ///
    /// [`Error::Value`]: crate::base::Error::Value
    /// [`Error::NotConverged`]: crate::base::Error::NotConverged
    /// [`Error::Unsound`]: crate::base::Error::Unsound
    pub fn new(case: &Case, options: &Options) -> Result<Self> {
        let (case, scene) = with_force(case, options)?;
        Ok(Self::of_scene(&case, options, Arc::new(scene)))
    }

    /// A case whose scene is already solved.
    pub(super) fn of_scene(case: &Case, options: &Options, scene: Arc<SolvedScene>) -> Self {
        let hertz = case.hertz();
        Self { case: case.clone(), options: options.clone(), hertz, scene }
    }

    /// The case; with the force that was found, if the approach was given.
    pub fn case(&self) -> &Case {
        &self.case
    }

    /// The edge model.
    pub fn method(&self) -> EdgeModel {
        self.options.method
    }

    /// The scales.
    pub fn hertz(&self) -> &HertzScales {
        &self.hertz
    }

    /// The scene's solution, which does not depend on the roller's radius.
    pub(super) fn scene(&self) -> &Arc<SolvedScene> {
        &self.scene
    }

    /// Whether the contact is symmetric about y = 0.
    pub fn is_symmetric(&self) -> bool {
        self.scene.scene.is_symmetric()
    }

    /// Approach of points one roller radius below the surfaces (m).
    pub(super) fn approach_m(&self) -> f64 {
        approach_m(&self.scene.approaches(), &self.case)
    }

    /// y of the line of action of the pressure's resultant (m).
    pub(super) fn centre_of_pressure_m(&self) -> f64 {
        centre_of_pressure(&self.scene) * self.hertz.c_m
    }

    /// Tilt of the lines x = 0 one roller radius below the surfaces (rad).
    pub(super) fn tilt_rad(&self) -> f64 {
        let radius = self.case.roller.radius_m / self.hertz.c_m;
        let slope = self.hertz.c_m / (2.0 * self.case.equivalent_radius_m());
        self.scene.tilt(radius) * slope
    }

    /// The contact pressure (p0) at `x`, `y` (C).
    pub fn pressure(&self, x: f64, y: f64) -> f64 {
        self.scene.pressure.at(x, y)
    }

    /// Stresses (p0) of `body` at `points` x, y, z (C); z is the depth into that body.
    ///
    /// # Errors
    /// [`crate::base::Error::Value`] that names the first point outside the body.
    pub fn stress(&self, body: BodyKind, points: &[[f64; 3]]) -> Result<Vec<StressTensor>> {
        let in_m = |at: &[f64; 3]| (body, at.map(|v| v * self.hertz.c_m));
        check_points(&self.case, points.iter().map(in_m))?;
        let places: Vec<_> = points.iter().map(|at| (body, *at)).collect();
        let found = self.scene.stresses(&[], &places).points;
        Ok(found.iter().map(|s| self.shaped(body, s)).collect())
    }

    /// The six stress components of `body` (p0) at every point of `grid` (C).
    ///
    /// Runs on all threads of the current pool. Coordinates that mirror each other exactly in x = 0
    /// or in y = 0 are computed once.
    ///
    /// # Errors
    /// [`crate::base::Error::Value`] when the grid is empty, too large, or leaves the body.
    pub fn on_grid(&self, body: BodyKind, grid: &Grid) -> Result<GridStress> {
        check_grid(&self.case, body, grid)?;
        // The body's end may exceed itself by rounding.
        let [from, to] = Extent::of(&self.case, body).ends_m().map(|y| y / self.hertz.c_m);
        let y = grid.y.iter().map(|y| y.clamp(from, to)).collect();
        let grid = Grid { y, ..grid.clone() };
        let shaped = |s: &RoundStress| self.shaped(body, s);
        let round: Option<&(dyn Fn(&RoundStress) -> StressTensor + Sync)> =
            Shaping::of(&self.case).adds_to(body).then_some(&shaped as _);
        Ok(on_grid(&self.scene.field(body), &grid, round))
    }

    /// The complete solution.
    pub fn solution(&self) -> Solution {
        self.solution_with(&self.stresses())
    }

    /// The stresses of the curves and points of the options.
    pub(super) fn stresses(&self) -> SharedStresses {
        let start = Instant::now();
        let (scene, options) = (&self.scene.scene, &self.options);
        let specs = wanted_curves(scene, options);
        let points: Vec<_> =
            options.points.iter().map(|p| (p.body, p.at_m.map(|v| v / self.hertz.c_m))).collect();
        let found = self.scene.stresses(&specs, &points);
        SharedStresses { specs, found, seconds: start.elapsed().as_secs_f64() }
    }

    /// The complete solution with known stresses.
    pub(super) fn solution_with(&self, stresses: &SharedStresses) -> Solution {
        let curves = Curves {
            hertz: self.hertz,
            pressure: self.pressure_lines(),
            stress: self.stress_curves(stresses),
        };
        let points = self.options.points.iter().zip(&stresses.found.points);
        let points = points.map(|(point, s)| self.shaped(point.body, s)).collect();
        let cells = pressure_cells(&self.scene);
        let critical = most_stressed(&curves, &self.scene.scene.span());
        let summary = self.summary(stresses, critical, &cells);
        let line_loads = self.scene.pressure.whole_line();
        Solution { summary, curves, cells, line_loads, points }
    }

    /// C / R of a body, negative for a concave one.
    pub(super) fn curvature(&self, body: BodyKind) -> f64 {
        Shaping::of(&self.case).curvatures[body]
    }

    /// The stress of a body (p0) with what its radius and the friction add.
    fn shaped(&self, body: BodyKind, stress: &RoundStress) -> StressTensor {
        Shaping::of(&self.case).stress(body, stress)
    }

    /// The pressure on the two standard lines.
    fn pressure_lines(&self) -> Vec<PressureLine> {
        let span = self.scene.scene.span();
        let (along, across) = (span.contact_line(), across_contact());
        PressureLine::standard(along, across, span.centre(), |[x, y]| self.pressure(x, y))
    }

    fn stress_curves(&self, stresses: &SharedStresses) -> Vec<StressCurve> {
        let curves = stresses.specs.iter().zip(&stresses.found.curves);
        curves
            .map(|(spec, found)| StressCurve {
                body: spec.body,
                name: spec.name.to_string(),
                stress: found.iter().map(|s| self.shaped(spec.body, s)).collect(),
                at: spec.points.clone(),
                own_error: None,
            })
            .collect()
    }

    fn summary(
        &self,
        stresses: &SharedStresses,
        critical: Option<CriticalSummary>,
        cells: &[PressureCell],
    ) -> Summary {
        let HertzScales { c_m, p0_pa, .. } = self.hertz;
        let (case, solved) = (&self.case, &self.scene);
        let top = largest(cells);
        Summary {
            case: case.name.clone(),
            method: solved.scene.model,
            hertz: self.hertz,
            load_n: case.load.force_n,
            approach_m: self.approach_m(),
            tilt_rad: self.tilt_rad(),
            p_centre_pa: self.pressure(0.0, solved.scene.span().centre()) * p0_pa,
            p_max_pa: top.p * p0_pa,
            p_max_at_m: place_of(solved, top).map(|v| v * c_m),
            centre_of_pressure_m: [0.0, self.centre_of_pressure_m()],
            contact_y_m: solved.ends().map(|y| y * c_m),
            converged: solved.converged(),
            iterations: solved.contact.iterations,
            load_error_rel: load_error(cells, case),
            seconds: Seconds {
                stress: stresses.seconds,
                total: solved.seconds.total + stresses.seconds,
                ..solved.seconds
            },
            critical,
            details: self.details(stresses),
        }
    }

    fn details(&self, stresses: &SharedStresses) -> Details {
        let solved = &self.scene;
        let alike = solved.bodies_shared() && self.options.bodies.len() > 1;
        Details {
            tolerance: self.case.accuracy.tolerance,
            resolution: solved.resolution,
            wavenumbers: [solved.wavenumbers.coarse().len(), solved.wavenumbers.fine().len()],
            contact_nodes: solved.pressure.axis().len(),
            edge: edge_strength(solved, Side::Positive),
            edge_neg: (!solved.pressure.is_symmetric())
                .then(|| edge_strength(solved, Side::Negative))
                .flatten(),
            coarser: solved.contact.coarser,
            profile_residual: solved.profile_residual(),
            edge_residual: solved.contact.residual,
            condition: solved.condition,
            bodies_shared: solved.bodies_shared(),
            work: Some(WorkSummary::new(&stresses.found.work, alike)),
            approach_reference_m: self.case.roller.radius_m,
            roller_diametral_tension_pa: Shaping::of(&self.case).roller_tension()
                * self.hertz.p0_pa,
            stiffness: None,
        }
    }
}

/// The standard curves that `options` ask for.
pub(super) fn wanted_curves(scene: &Scene, options: &Options) -> Vec<CurveSpec> {
    let bodies = BodyKind::ALL.into_iter().zip(scene.bodies.iter());
    let wanted = bodies.filter(|(kind, _)| options.bodies.contains(kind));
    let all = wanted.flat_map(|(kind, body)| curves_on(kind, &scene.span(), body.ends()));
    all.filter(|curve| options.wants(curve.name)).collect()
}

/// y of the line of action of the pressure's resultant (C).
fn centre_of_pressure(scene: &SolvedScene) -> f64 {
    if scene.pressure.is_symmetric() {
        return 0.0;
    }
    let lines = scene.pressure.line_loads();
    let sum = |of: fn(f64) -> f64| -> f64 {
        lines.iter().map(|line| of(line.y) * line.weight * line.load).sum()
    };
    sum(|y| y) / sum(|_| 1.0)
}

/// x and y of the cell of largest pressure; the positive ones where mirror images have the same.
pub(super) fn place_of(scene: &SolvedScene, cell: &PressureCell) -> [f64; 2] {
    let y = if scene.pressure.is_symmetric() { cell.y.abs() } else { cell.y };
    [cell.x.abs(), y]
}

/// The most stressed point of the curves outside the surroundings of the overlap's edges.
pub(super) fn most_stressed(curves: &Curves, span: &Span) -> Option<CriticalSummary> {
    let points = curves.stress.iter().flat_map(|curve| {
        let values = curve.stress.iter().map(StressTensor::von_mises);
        curve.at.iter().zip(values).map(|(at, value)| (curve.body, *at, value))
    });
    let away = points.filter(|(_, at, _)| away_from_edges(*at, span.ends, EDGE));
    Critical::largest(away).map(|critical| CriticalSummary::new(&critical, &curves.hertz))
}
