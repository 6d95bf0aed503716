//! One case and one edge model to one solution, in SI units.

pub mod edge;
mod grid;
mod key;
mod scene;

use crate::base::{Error, HertzScales, Result, StressTensor};
use crate::body::EdgeModel;
use crate::case::Case;
use crate::kernels::strip;
use crate::stress::{BodyKind, CurveSpec, Field, RoundStress, Work, curves, round};
use rayon::prelude::*;
use serde::Serialize;
use serde_json::json;
use std::time::Instant;

pub use grid::{MOST_GRID_POINTS, solve_on_grid};
pub use key::{END_DISTANCES, KeyResults, key_results};
pub use scene::{Scene, SceneBody, SceneKey, Seconds, SolvedScene};

/// What to compute.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The edge model of both bodies.
    pub method: EdgeModel,
    /// Bodies whose curves are wanted.
    pub bodies: Vec<BodyKind>,
    /// Names of the standard curves that are wanted; all by default.
    pub curves: Vec<String>,
    /// Extra points, in their order.
    pub points: Vec<Point>,
    /// Factor of the images of `guilbault` in place of [`crate::body::guilbault_psi`].
    pub psi: Option<f64>,
}

impl Options {
    /// All standard curves of both bodies.
    pub fn new(method: EdgeModel) -> Self {
        Self {
            method,
            bodies: BodyKind::ALL.to_vec(),
            curves: curves::CURVE_NAMES.iter().map(|s| s.to_string()).collect(),
            points: Vec::new(),
            psi: None,
        }
    }
}

/// A point in a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// The body.
    pub body: BodyKind,
    /// x, y, z (m); z is the depth into the body, >= 0.
    pub at_m: [f64; 3],
}

/// A cell of the contact pressure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PressureCell {
    /// Centre across the contact (m).
    pub x_m: f64,
    /// Place along the contact (m).
    pub y_m: f64,
    /// Width (m).
    pub dx_m: f64,
    /// Length (m).
    pub dy_m: f64,
    /// Mean pressure (Pa), >= 0; the sum of p dx dy over the cells is the load.
    pub p_pa: f64,
}

/// Pressure on a line of points.
#[derive(Debug, Clone, PartialEq)]
pub struct PressureLine {
    /// `along-y` (x = 0) or `along-x` (y = 0).
    pub name: &'static str,
    /// Points x, y (m).
    pub at_m: Vec<[f64; 2]>,
    /// Pressure at the points (Pa).
    pub p_pa: Vec<f64>,
}

/// Stresses along a standard curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// The body.
    pub body: BodyKind,
    /// The curve's name.
    pub name: &'static str,
    /// Points x, y, z (m).
    pub at_m: Vec<[f64; 3]>,
    /// Stresses at the points (Pa).
    pub stress_pa: Vec<StressTensor>,
}

/// The most stressed place of the standard curves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Critical {
    /// The body.
    pub body: BodyKind,
    /// The measure, `von_mises`.
    pub measure: &'static str,
    /// Its value (Pa).
    pub value_pa: f64,
    /// Where: x, y, z (m).
    pub at_m: [f64; 3],
}

/// The solution of a case by one method.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The case's name.
    pub case: String,
    /// The edge model.
    pub method: EdgeModel,
    /// The scales.
    pub hertz: HertzScales,
    /// Load (N).
    pub load_n: f64,
    /// Approach of the bodies' far points that the model implies (m).
    pub approach_m: f64,
    /// Pressure at the contact's centre (Pa).
    pub p_centre_pa: f64,
    /// Largest pressure of the cells (Pa).
    pub p_max_pa: f64,
    /// Its place x, y (m).
    pub p_max_at_m: [f64; 2],
    /// Whether the contact iteration reached its tolerance.
    pub converged: bool,
    /// Iterations of the contact solve.
    pub iterations: usize,
    /// |load of the pressure - load| / load.
    pub load_error_rel: f64,
    /// Time spent.
    pub seconds: Seconds,
    /// The most stressed place.
    pub critical: Option<Critical>,
    /// The contact pressure in cells.
    pub cells: Vec<PressureCell>,
    /// The contact pressure on the two standard lines.
    pub lines: Vec<PressureLine>,
    /// The standard curves asked for.
    pub curves: Vec<Curve>,
    /// Stresses at the extra points (Pa), in their order.
    pub points: Vec<StressTensor>,
    /// What was chosen and what was skipped, for `summary.json` (axes, wavenumbers, counts).
    pub details: serde_json::Value,
}

/// Solves `case` with one method.
///
/// # Errors
/// [`Error::NotConverged`] when the contact iteration does not settle, and [`Error::Value`] when a
/// point of `options` lies outside its body.
pub fn solve(case: &Case, options: &Options) -> Result<Solution> {
    solve_group(std::slice::from_ref(case), options).pop().expect("one case, one solution")
}

/// Solves cases that differ in scale only together: the first one's scene is solved once, and every
/// case gets its own scales, approach and roller. A case of another scene is solved by itself.
pub fn solve_group(cases: &[Case], options: &Options) -> Vec<Result<Solution>> {
    let mut shared: Option<(SceneKey, SceneAnswer)> = None;
    cases
        .iter()
        .map(|case| {
            check_points(case, options)?;
            let scene = Scene::new(case, options.method, options.psi);
            // Extra points are given in metres, so they are another case's own.
            let own = !options.points.is_empty();
            let fits = !own && shared.as_ref().is_some_and(|(key, _)| *key == scene.key());
            if !fits {
                let answer = SceneAnswer::new(&scene, case, options)?;
                shared = Some((scene.key(), answer));
            }
            let (_, answer) = shared.as_ref().expect("solved above");
            Ok(answer.scaled(case, options))
        })
        .collect()
}

/// Refuses points outside their body.
fn check_points(case: &Case, options: &Options) -> Result<()> {
    for (i, point) in options.points.iter().enumerate() {
        let half = 0.5
            * match point.body {
                BodyKind::Block => case.block.length_m,
                BodyKind::Roller => case.roller.length_m,
            };
        let [x, y, z] = point.at_m;
        let bad = if !(x.is_finite() && y.is_finite() && z.is_finite()) {
            "every coordinate must be a finite number"
        } else if z < 0.0 {
            "z is the depth into the body and must not be negative"
        } else if y.abs() > half * (1.0 + 1e-9) {
            "y lies beyond the body's end face"
        } else {
            continue;
        };
        return Err(Error::Value {
            key: format!("point {} ({})", i + 1, point.body.name()),
            value: format!("[{x}, {y}, {z}] m"),
            reason: bad.into(),
            remedy: format!("keep |y| <= {half} m and z >= 0"),
        });
    }
    Ok(())
}

/// Cells of the written pressure across the contact (C).
const CELL: f64 = 0.05;

/// A scene's pressures and stresses in units of C and p0.
struct SceneAnswer {
    solved: SolvedScene,
    seconds: Seconds,
    cells: Vec<PressureCell>,
    lines: Vec<PressureLine>,
    curves: Vec<CurveStress>,
    points: Vec<RoundStress>,
    work: Work,
}

/// A standard curve and the stresses at its points.
type CurveStress = (CurveSpec, Vec<RoundStress>);

impl SceneAnswer {
    fn new(scene: &Scene, case: &Case, options: &Options) -> Result<Self> {
        let start = Instant::now();
        let solved = SolvedScene::new(scene)?;
        let before = start.elapsed().as_secs_f64();
        let (curves, points, work) = stresses(&solved, case, options);
        let mut seconds = solved.seconds;
        seconds.total = start.elapsed().as_secs_f64();
        seconds.stress = seconds.total - before;
        let cells = pressure_cells(&solved);
        let lines = pressure_lines(&solved);
        Ok(Self { solved, seconds, cells, lines, curves, points, work })
    }

    /// In a case's own units, with what its own radius adds.
    fn scaled(&self, case: &Case, options: &Options) -> Solution {
        let hertz = case.hertz();
        let (c, p0) = (hertz.c_m, hertz.p0_pa);
        let curvature = c / case.roller.radius_m;
        let stress = |body: BodyKind, s: &RoundStress| match body {
            BodyKind::Block => s.flat * p0,
            BodyKind::Roller => s.at(curvature) * p0,
        };
        let curves: Vec<Curve> = self
            .curves
            .iter()
            .map(|(curve, stresses)| Curve {
                body: curve.body,
                name: curve.name,
                at_m: curve.points.iter().map(|at| at.map(|v| v * c)).collect(),
                stress_pa: stresses.iter().map(|s| stress(curve.body, s)).collect(),
            })
            .collect();
        let lines = self
            .lines
            .iter()
            .map(|line| PressureLine {
                name: line.name,
                at_m: line.at_m.iter().map(|at| at.map(|v| v * c)).collect(),
                p_pa: line.p_pa.iter().map(|p| p * p0).collect(),
            })
            .collect();
        let cells: Vec<PressureCell> = self
            .cells
            .iter()
            .map(|cell| PressureCell {
                x_m: cell.x_m * c,
                y_m: cell.y_m * c,
                dx_m: cell.dx_m * c,
                dy_m: cell.dy_m * c,
                p_pa: cell.p_pa * p0,
            })
            .collect();
        let carried: f64 = cells.iter().map(|cell| cell.p_pa * cell.dx_m * cell.dy_m).sum();
        let top = cells.iter().max_by(|a, b| a.p_pa.total_cmp(&b.p_pa)).expect("cells");
        let unit = c * c / (2.0 * case.roller.radius_m);
        let reference = case.roller.radius_m;
        let solved = &self.solved;
        Solution {
            case: case.name.clone(),
            method: options.method,
            hertz,
            load_n: case.load.force_n,
            approach_m: solved.approach(reference / c) * unit,
            p_centre_pa: solved.pressure.at(0.0, 0.0) * p0,
            p_max_pa: top.p_pa,
            p_max_at_m: [top.x_m.abs(), top.y_m.abs()],
            converged: true,
            iterations: solved.contact.iterations,
            load_error_rel: (carried / case.load.force_n - 1.0).abs(),
            seconds: self.seconds,
            critical: critical(&curves, 0.5 * case.roller.length_m, c),
            points: self
                .points
                .iter()
                .zip(&options.points)
                .map(|(s, point)| stress(point.body, s))
                .collect(),
            details: json!({
                "tolerance": case.accuracy.tolerance,
                "resolution": solved.resolution,
                "wavenumbers": [solved.wavenumbers.coarse().len(), solved.wavenumbers.fine().len()],
                "contact_nodes": solved.pressure.axis().len(),
                "edge": edge::edge_strength(solved),
                "edge_residual": solved.contact.residual,
                "condition": solved.condition,
                "bodies_shared": solved.bodies_shared(),
                "work": {
                    "done": self.work.done,
                    "avoided": {
                        "sources beyond a wave's reach": self.work.beyond_reach,
                        "end faces beyond a wave's reach": self.work.ends,
                        "wavenumbers that have faded": self.work.faded,
                        "the other body is alike":
                            if solved.bodies_shared() && options.bodies.len() > 1 {
                                self.work.done
                            } else {
                                0
                            },
                    },
                },
                "approach_reference_m": reference,
                "roller_diametral_tension_pa": round::DIAMETRAL_TENSION * curvature * p0,
            }),
            cells,
            lines,
            curves,
        }
    }
}

/// The most stressed point of the curves outside 0.1 C of the roller's corner, where the stress of
/// a sharp corner is a property of the sampling.
fn critical(curves: &[Curve], half_length_m: f64, c_m: f64) -> Option<Critical> {
    let mut best: Option<Critical> = None;
    for curve in curves {
        for (at, stress) in curve.at_m.iter().zip(&curve.stress_pa) {
            let from_corner = (at[1].abs() - half_length_m).hypot(at[2]);
            let value_pa = stress.von_mises();
            if from_corner >= 0.0999 * c_m && best.is_none_or(|b| value_pa > b.value_pa) {
                best =
                    Some(Critical { body: curve.body, measure: "von_mises", value_pa, at_m: *at });
            }
        }
    }
    best
}

/// Mean pressures of cells that are `CELL` wide and as long as a node's quadrature weight, so that
/// their sum is the solution's load.
fn pressure_cells(solved: &SolvedScene) -> Vec<PressureCell> {
    let pressure = &solved.pressure;
    let axis = pressure.axis();
    let mut cells = Vec::new();
    // Alike to either side of both planes of symmetry: computed once.
    let profile = |j: usize| -> Vec<f64> {
        let (a, coefficients) = pressure.at_node(j);
        let reach = (a / CELL - 0.5).ceil().max(0.0) as i32;
        let carried = |i: i32| strip::cumulative(a, coefficients, (f64::from(i) - 0.5) * CELL);
        let sums: Vec<f64> = (0..=reach + 1).map(carried).collect();
        sums.windows(2).map(|sum| ((sum[1] - sum[0]) / CELL).max(0.0)).collect()
    };
    let profiles: Vec<Vec<f64>> = (0..axis.len()).map(profile).collect();
    let nodes = axis.nodes().iter().zip(axis.weights()).zip(&profiles);
    let sides = nodes.clone().rev().map(|n| (-1.0, n)).chain(nodes.map(|n| (1.0, n)));
    for (side, ((&y, &dy), profile)) in sides {
        let reach = profile.len() as i32 - 1;
        for i in -reach..=reach {
            let p = profile[i.unsigned_abs() as usize];
            let x = f64::from(i) * CELL;
            cells.push(PressureCell { x_m: x, y_m: side * y, dx_m: CELL, dy_m: dy, p_pa: p });
        }
    }
    cells
}

/// The pressure on the two standard lines.
fn pressure_lines(solved: &SolvedScene) -> Vec<PressureLine> {
    let line = |name, at: Vec<[f64; 2]>| PressureLine {
        name,
        p_pa: at.iter().map(|&[x, y]| solved.pressure.at(x, y)).collect(),
        at_m: at,
    };
    let along = curves::contact_line(solved.scene.half_length);
    let across = curves::across_contact();
    vec![
        line("along-y", along.into_iter().map(|y| [0.0, y]).collect()),
        line("along-x", across.into_iter().map(|x| [x, 0.0]).collect()),
    ]
}

/// Points of one body that share much of their computation.
struct Line {
    body: BodyKind,
    along: Along,
    /// Coordinates (C), and where the stress belongs.
    points: Vec<([f64; 3], Slot)>,
}

/// Which points belong to one [`Line`] (coordinates in C).
#[derive(Clone, Copy, PartialEq)]
enum Along {
    /// Those along x, at y and z.
    X(f64, f64),
    /// Those along y in the plane x = 0, at z.
    Y(f64),
    /// Those along z, at y, in the plane x = 0.
    Z(f64),
    /// Those along z, at y, off the plane x = 0.
    OffZ(f64),
}

/// Where a stress belongs: a standard curve's point, or an extra point.
#[derive(Clone, Copy)]
enum Slot {
    Curve(usize, usize),
    Extra(usize),
}

/// Stresses of the standard curves and of the extra points that `options` asks for.
fn stresses(
    solved: &SolvedScene,
    case: &Case,
    options: &Options,
) -> (Vec<CurveStress>, Vec<RoundStress>, Work) {
    let scene = &solved.scene;
    let mut curves = Vec::new();
    for (kind, body) in BodyKind::ALL.into_iter().zip(scene.bodies.iter()) {
        if options.bodies.contains(&kind) {
            let all = curves::standard_curves(kind, scene.half_length, body.half);
            curves.extend(all.into_iter().filter(|c| options.curves.iter().any(|n| n == c.name)));
        }
    }
    let lines = lines(solved, &curves, case.hertz().c_m, &options.points);
    let fields: Vec<_> = BodyKind::ALL
        .into_iter()
        .filter(|&k| lines.iter().any(|l| l.body == k))
        .map(|k| (k, solved.field(k)))
        .collect();
    let values: Vec<Vec<RoundStress>> = lines
        .par_iter()
        .map(|line| {
            let (_, field) = fields.iter().find(|f| f.0 == line.body).expect("one a body");
            line.stresses(field)
        })
        .collect();
    let mut out: Vec<CurveStress> = curves
        .into_iter()
        .map(|curve| {
            let stresses = vec![RoundStress::default(); curve.points.len()];
            (curve, stresses)
        })
        .collect();
    let mut points = vec![RoundStress::default(); options.points.len()];
    for (line, values) in lines.iter().zip(values) {
        for ((_, slot), value) in line.points.iter().zip(values) {
            match *slot {
                Slot::Curve(i, j) => out[i].1[j] = value,
                Slot::Extra(i) => points[i] = value,
            }
        }
    }
    let work = fields.iter().map(|(_, field)| field.work()).sum();
    (out, points, work)
}

/// The points of `curves` and the extra ones, line by line.
fn lines(solved: &SolvedScene, curves: &[CurveSpec], c_m: f64, extra: &[Point]) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    let mut add = |kind: BodyKind, along: Along, at: [f64; 3], slot: Slot| {
        // What both bodies share in the computation they share in the result.
        let body = if solved.bodies_shared() { BodyKind::Block } else { kind };
        let index = lines.iter().position(|l| l.body == body && l.along == along);
        let index = index.unwrap_or_else(|| {
            lines.push(Line { body, along, points: Vec::new() });
            lines.len() - 1
        });
        lines[index].points.push((at, slot));
    };
    for (i, curve) in curves.iter().enumerate() {
        let same = |axis: usize| curve.points.windows(2).all(|p| p[0][axis] == p[1][axis]);
        let fixed = [0, 1, 2].map(same);
        for (j, &at) in curve.points.iter().enumerate() {
            let [x, y, z] = at;
            let along = match fixed {
                [true, true, _] if x == 0.0 => Along::Z(y),
                [true, true, _] => Along::OffZ(y),
                [true, _, true] if x == 0.0 => Along::Y(z),
                _ => Along::X(y, z),
            };
            add(curve.body, along, at, Slot::Curve(i, j));
        }
    }
    for (i, point) in extra.iter().enumerate() {
        let at = point.at_m.map(|v| v / c_m);
        add(point.body, Along::X(at[1], at[2]), at, Slot::Extra(i));
    }
    lines
}

impl Line {
    /// The stresses at the points, in their order.
    fn stresses(&self, field: &Field) -> Vec<RoundStress> {
        let coordinate = |axis: usize| self.points.iter().map(|p| p.0[axis]).collect::<Vec<_>>();
        match self.along {
            Along::X(y, z) => field.round_at(y, z, &coordinate(0)),
            Along::Y(z) => field.round_along(z, &coordinate(1)),
            Along::Z(y) | Along::OffZ(y) => {
                // Points at one depth share their sums over the loads.
                let distinct = |mut all: Vec<f64>| {
                    all.sort_by(f64::total_cmp);
                    all.dedup();
                    all
                };
                let (xs, zs) = (distinct(coordinate(0)), distinct(coordinate(2)));
                let all = field.round_down(&xs, y, &zs);
                let place = |all: &[f64], v: f64| all.partition_point(|a| *a < v);
                let at = |(at, _): &([f64; 3], Slot)| all[place(&zs, at[2])][place(&xs, at[0])];
                self.points.iter().map(at).collect()
            }
        }
    }
}
