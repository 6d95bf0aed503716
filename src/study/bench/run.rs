//! The run of a bench: every case on FEM's meshes and by every model at every tolerance, compared
//! with both references.

use super::point::{BEST, BenchPoint, CaseBench, Deviation, Origin};
use crate::case::Case;
use crate::fem::{self, Code, Driver, MeshResult};
use crate::stress::Curves;
use crate::study::errors::Range;
use crate::study::live::repeated;
use crate::study::models::{Attempt, Jobs, Models};
use crate::study::published::{GRIDS, PublishedAttempt};
use crate::study::source::{Engine, Source};
use crate::study::timing::Timing;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A code and the relative element size of its mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshOf {
    /// The code.
    pub code: Code,
    /// The size; 1 is the production mesh.
    pub size: f64,
}

/// A mesh and its times.
pub struct Mesh {
    /// The result.
    pub result: MeshResult,
    /// The times of its runs.
    pub timing: Timing,
}

/// The FEM meshes of a case.
pub struct FemMeshes {
    /// The record of the case by the first code, if there is one.
    pub recorded: Option<fem::FemResults>,
    /// Meshes of this run, or why one failed.
    pub live: Vec<(MeshOf, std::result::Result<Mesh, String>)>,
}

impl FemMeshes {
    /// Runs `case` by each driver `repeats` times in folders below `folder`. A mesh that fails is
    /// kept with its error.
    pub fn run(
        recorded: Option<fem::FemResults>,
        drivers: &[(MeshOf, Driver)],
        repeats: usize,
        case: &Case,
        folder: &Path,
        progress: &dyn Fn(&str),
    ) -> Self {
        let live = drivers
            .iter()
            .map(|(of, driver)| {
                let MeshOf { code, size } = of;
                let folder = match code {
                    Code::Fenicsx => folder.join(format!("size-{size}")),
                    _ => folder.join(format!("{}-size-{size}", code.name())),
                };
                let run = repeated(driver, repeats, case, &folder, progress);
                let mesh = run.map(|(result, timing)| Mesh { result, timing });
                (*of, mesh.map_err(|e| e.to_string()))
            })
            .collect();
        Self { recorded, live }
    }

    /// The finest mesh of the first code that has one; of two equally fine meshes the recorded one.
    fn reference(&self) -> Option<FemReference> {
        Code::ALL.into_iter().find_map(|code| self.reference_of(code))
    }

    /// The finest mesh of a code as the reference.
    fn reference_of(&self, code: Code) -> Option<FemReference> {
        let recorded = self.recorded.iter().filter(|_| code == Code::ALL[0]);
        let recorded = recorded.flat_map(|r| &r.meshes).map(|m| ("recorded", m));
        let live = self.live.iter().filter(|(of, _)| of.code == code);
        let live = live.filter_map(|(_, m)| Some(("live", &m.as_ref().ok()?.result)));
        let mut all: Vec<(&'static str, &MeshResult)> = recorded.chain(live).collect();
        all.sort_by(|a, b| a.1.size.total_cmp(&b.1.size));
        all.dedup_by(|a, b| a.1.size == b.1.size);
        let (source, finest) = *all.first()?;
        Some(FemReference {
            source: Engine::of(code).into(),
            finest: finest.curves.clone(),
            next: all.get(1).map(|(_, mesh)| mesh.curves.clone()),
            size: finest.size,
            words: format!("{source}, size {}", finest.size),
        })
    }
}

/// FEM's finest mesh as a reference.
struct FemReference {
    /// The code.
    source: Source,
    finest: Curves,
    /// The next mesh; its difference from the finest is the finest mesh's own error.
    next: Option<Curves>,
    size: f64,
    words: String,
}

/// The input of a run.
pub struct BenchSetup<'a> {
    /// The models, timed at least once.
    pub models: Models<'a>,
    /// Tolerances (p0), each once.
    pub tolerances: Vec<f64>,
    /// The FEM meshes of a case.
    pub fem: &'a dyn Fn(&Case) -> FemMeshes,
    /// Called after each step with the number of finished steps, the number of all steps and the
    /// step's name.
    pub progress: &'a (dyn Fn(usize, usize, &str) + Sync),
}

/// A point with its curves.
type WithCurves = (BenchPoint, Option<Curves>);

/// Runs every case on FEM's meshes, and then by every model at every tolerance. A failed solve is
/// kept with its error.
pub fn run(cases: &[Case], setup: &BenchSetup) -> Vec<CaseBench> {
    let stages = setup.tolerances.len() + 1;
    let fem: Vec<FemMeshes> = cases
        .iter()
        .enumerate()
        .map(|(i, case)| {
            let meshes = (setup.fem)(case);
            let done = 100 * (i + 1) / cases.len();
            (setup.progress)(done, 100 * stages, &format!("FEM of {}", case.name));
            meshes
        })
        .collect();
    let references: Vec<_> = fem.iter().map(FemMeshes::reference).collect();
    let mut points: Vec<Vec<WithCurves>> = vec![Vec::new(); cases.len()];
    for (stage, &tolerance) in setup.tolerances.iter().enumerate() {
        let of_stage = models_at(cases, tolerance, &setup.models, &|done, all, what| {
            let whole = 100 * ((stage + 1) * all + done) / all;
            (setup.progress)(whole, 100 * stages, &format!("tolerance {tolerance:e}: {what}"));
        });
        for (all, more) in points.iter_mut().zip(of_stage) {
            all.extend(more);
        }
    }
    for (case, points) in cases.iter().zip(&mut points) {
        points.extend(published_points(case, &setup.models));
    }
    let limit = setup.tolerances.iter().copied().fold(f64::INFINITY, f64::min);
    cases
        .iter()
        .zip(&fem)
        .zip(references)
        .zip(points)
        .map(|(((case, meshes), reference), mut points)| {
            points.extend(fem_points(meshes));
            assess(case, points, reference, limit, &Range::default())
        })
        .collect()
}

/// The points of all models at one tolerance, one list for each case. `step` is called with the
/// number of finished steps, the number of all steps and the step's name.
fn models_at(
    cases: &[Case],
    tolerance: f64,
    models: &Models,
    step: &(dyn Fn(usize, usize, &str) + Sync),
) -> Vec<Vec<WithCurves>> {
    let cases: Vec<Case> = cases.iter().map(|c| c.clone().with_tolerance(tolerance)).collect();
    let jobs = Jobs::new(&cases, models);
    let done = AtomicUsize::new(0);
    let attempts =
        jobs.run(&|what| step(done.fetch_add(1, Ordering::Relaxed) + 1, jobs.steps(), what));
    let of_model = |attempt: Attempt| {
        let (curves, err) = match attempt.solution {
            Ok(solution) => (Some(solution.curves), None),
            Err(e) => (None, Some(e.to_string())),
        };
        // A failed solve has no time.
        let timing = |i: usize| curves.as_ref().and(attempt.timing.get(i)).copied();
        let point = BenchPoint {
            timing: timing(0),
            all_threads: timing(1),
            err,
            ..BenchPoint::new(attempt.method, Origin::Model, tolerance)
        };
        (point, curves)
    };
    attempts.into_iter().map(|all| all.into_iter().map(of_model).collect()).collect()
}

/// The points of the published method, coarsest grid first.
fn published_points(case: &Case, models: &Models) -> Vec<WithCurves> {
    let on_grid = |solve| {
        move |grid: [usize; 2]| {
            let attempt = PublishedAttempt::new(solve, models.repeats > 0, case, Some(grid));
            let point = BenchPoint {
                timing: attempt.timing,
                err: attempt.solution.as_ref().err().map(|e| e.to_string()),
                ..BenchPoint::new(Engine::published(), Origin::Cells, (grid[0] * grid[1]) as f64)
            };
            (point, attempt.solution.ok().map(|solution| solution.curves))
        }
    };
    models.published.map_or_else(Vec::new, |solve| GRIDS.map(on_grid(solve)).into())
}

/// The points of FEM, live meshes first.
fn fem_points(meshes: &FemMeshes) -> Vec<WithCurves> {
    let live_of = |of: &MeshOf| BenchPoint::new(Engine::of(of.code), Origin::LiveFem, of.size);
    let live = meshes.live.iter().map(|(of, mesh)| match mesh {
        Ok(mesh) => (
            BenchPoint {
                unknowns: Some(mesh.result.summary.unknowns as u64),
                timing: Some(mesh.timing),
                ..live_of(of)
            },
            Some(mesh.result.curves.clone()),
        ),
        Err(message) => (BenchPoint { err: Some(message.clone()), ..live_of(of) }, None),
    });
    let recorded = meshes.recorded.iter().flat_map(|r| &r.meshes).map(|mesh| {
        let seconds = mesh.summary.total_seconds();
        let point = BenchPoint {
            unknowns: Some(mesh.summary.unknowns as u64),
            timing: Some(Timing::new(mesh.summary.ranks, &[seconds])),
            machine: Some(mesh.summary.processor().to_string()),
            ..BenchPoint::new(Engine::of(Code::ALL[0]), Origin::RecordedFem, mesh.size)
        };
        (point, Some(mesh.curves.clone()))
    });
    live.chain(recorded).collect()
}

/// Compares the points of a case with both references.
fn assess(
    case: &Case,
    points: Vec<WithCurves>,
    reference: Option<FemReference>,
    limit: f64,
    range: &Range,
) -> CaseBench {
    let is_limit = |p: &BenchPoint| p.source == BEST.into() && p.setting == limit;
    let limit = points.iter().find(|(p, _)| is_limit(p)).and_then(|(_, s)| s.clone());
    // Against itself the finest mesh would have no error.
    let own = reference
        .as_ref()
        .and_then(|r| Deviation::between(case, &r.finest, (&r.source, r.next.as_ref()?), range));
    let points = points
        .into_iter()
        .map(|(mut point, curves)| {
            let Some(curves) = curves else { return point };
            let source = point.source.clone();
            point.to_fem = reference.as_ref().and_then(|r| {
                if point.source == r.source && point.setting <= r.size {
                    return own;
                }
                Deviation::between(case, &r.finest, (&source, &curves), range)
            });
            if !is_limit(&point) {
                point.to_limit = limit
                    .as_ref()
                    .and_then(|limit| Deviation::between(case, limit, (&source, &curves), range));
            }
            point
        })
        .collect();
    CaseBench { case: case.clone(), fem_reference: reference.map(|r| r.words), points }
}
