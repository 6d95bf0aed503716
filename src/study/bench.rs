//! Run time against error: the models at several tolerances and FEM on several meshes, timed in one
//! run on one machine.
//!
//! Two references are used, since neither serves for everything. FEM's finest mesh is independent
//! of the models, but has an error of its own, and differs from them in physics too (bodies of
//! finite width, no parabola). The quarter-space solution at the tightest tolerance is the limit
//! that the models' discretisation goes to. What "equal error" means is therefore stated twice: each
//! side against its own limit, and the models against FEM.

use super::errors::{ErrorRow, Range, compare, summarise};
use super::live::repeated;
use super::reference::from_fem;
use super::run::{Setup as StudySetup, Solver, Timed, run as run_study};
use super::sampled::Sampled;
use super::timing::{Ratio, Timing};
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::{Case, Study};
use crate::fem::{self, Driver, MeshResult};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The record of a run with live FEM that is built into the program.
const RECORD: &str = include_str!("../../results/bench.json");

/// The layout of the record that this version writes and reads.
const SCHEMA: u32 = 1;

/// The model whose ratio to FEM is stated; at the tightest tolerance it is the models' limit.
pub const BEST: EdgeModel = EdgeModel::QuarterSpace;

/// Curves of both bodies whose worst RMS is [`Accuracy::worst_rms`].
pub const CURVES: [&str; 3] = ["surface-along-y", "surface-along-x", "depth-end"];

/// How far an answer is from a reference (p0), outside the range that is left out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// The largest RMS of any one curve: of the pressure on its two lines, and of each stress on
    /// [`CURVES`]. This is the "error" of run time against error.
    pub worst_rms: f64,
    /// RMS of the pressure over both lines.
    pub pressure_rms: f64,
    /// Largest difference of the pressure.
    pub pressure_max: f64,
    /// RMS of the six stresses over all standard curves of both bodies.
    pub stress_rms: f64,
    /// Largest difference of a stress.
    pub stress_max: f64,
}

impl Accuracy {
    /// From the rows of a comparison over `range`; `None` when nothing was compared.
    pub fn of(rows: &[ErrorRow], range: &Range) -> Option<Self> {
        let summary = summarise(rows, range)?;
        let pressure_c = range.pressure_c.first()?;
        let counts = |r: &&ErrorRow| match r.quantity.as_str() {
            "pressure" => r.excluded_c == *pressure_c,
            quantity => quantity.starts_with("sigma_") && CURVES.contains(&r.curve.as_str()),
        };
        let [pressure_max, pressure_rms] = *summary.pressure.first()?;
        let [stress_max, stress_rms] = summary.stress;
        Some(Self {
            worst_rms: rows.iter().filter(counts).map(|r| r.rms).reduce(f64::max)?,
            pressure_rms,
            pressure_max,
            stress_rms,
            stress_max,
        })
    }

    /// Of `answer` against `reference`, both of `case`.
    fn between(case: &Case, reference: &Sampled, answer: &Sampled, range: &Range) -> Option<Self> {
        let half_length = case.factors().slenderness;
        // Both sides are sampled at the standard points, so that a comparison has no way to fail.
        let rows = compare(&case.name, half_length, reference, answer, range).ok()?;
        Self::of(&rows, range)
    }
}

/// Where a point's time was taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// A model, in this run.
    Model,
    /// FEM, in this run.
    LiveFem,
    /// FEM, when and where it was recorded.
    RecordedFem,
}

/// One way to solve a case: what it took, and how good it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// The model's name, or `fem`.
    pub source: String,
    /// Where the time was taken.
    pub origin: Origin,
    /// A model's tolerance (p0); a mesh's relative element size.
    pub setting: f64,
    /// Unknowns of both bodies (FEM).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unknowns: Option<u64>,
    /// Times on one thread; FEM's on one thread a process.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub timing: Option<Timing>,
    /// Times on all threads (models).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub all_threads: Option<Timing>,
    /// The processor where that is not of this run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub machine: Option<String>,
    /// Against FEM's finest mesh; for that mesh itself its difference to the next finest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to_fem: Option<Accuracy>,
    /// Against quarter-space at the tightest tolerance; none for that solution itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to_limit: Option<Accuracy>,
    /// Why there is no answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub err: Option<String>,
}

impl Point {
    /// A point that neither was timed nor compared.
    fn new(source: &str, origin: Origin, setting: f64) -> Self {
        Self {
            source: source.to_string(),
            origin,
            setting,
            unknowns: None,
            timing: None,
            all_threads: None,
            machine: None,
            to_fem: None,
            to_limit: None,
            err: None,
        }
    }

    /// Median seconds.
    pub fn seconds(&self) -> Option<f64> {
        Some(self.timing.as_ref()?.median_s)
    }

    /// The error against a reference.
    pub fn error(&self, against: Against) -> Option<f64> {
        let accuracy = match against {
            Against::Fem => self.to_fem,
            Against::Limit => self.to_limit,
        };
        Some(accuracy?.worst_rms)
    }
}

/// A reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Against {
    /// FEM's finest mesh.
    Fem,
    /// Quarter-space at the tightest tolerance.
    Limit,
}

/// All ways to solve one case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseBench {
    /// The case; its tolerance means nothing here.
    pub case: Case,
    /// The FEM mesh that is the reference, in words.
    pub fem_reference: Option<String>,
    /// The points.
    pub points: Vec<Point>,
}

/// FEM against [`BEST`] at an error that both stay within, timed in one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Speedup {
    /// The case.
    pub case: String,
    /// The error that both stay within (p0).
    pub level: f64,
    /// What the model's error is taken against; FEM's is always that to its own finest mesh.
    pub against: Against,
    /// Relative element size of the fastest mesh within the level, its unknowns, and its error.
    pub size: f64,
    pub unknowns: Option<u64>,
    pub fem_error: f64,
    /// Median seconds and spread.
    pub fem_seconds: (f64, f64),
    /// The fastest tolerance within the level, and the error there.
    pub tolerance: f64,
    pub model_error: f64,
    /// Median seconds and spread on one thread.
    pub model_seconds: (f64, f64),
    /// FEM's time over the model's.
    pub ratio: Ratio,
}

/// The machine of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Its processor.
    pub processor: String,
    /// Threads that it runs.
    pub threads: usize,
}

/// A run, as `bench.json` holds it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Bench {
    /// Layout of the file.
    pub schema: u32,
    /// Version of the program.
    pub version: String,
    /// When it ran (UTC, ISO 8601); empty when nothing was recorded yet.
    pub date: String,
    /// The command.
    pub command: String,
    /// Where.
    pub machine: Machine,
    /// The range of the errors.
    pub range: Range,
    /// Errors at which FEM and [`BEST`] are compared (p0).
    pub levels: Vec<f64>,
    /// The tolerance of the models' limit (p0).
    pub limit: f64,
    /// The cases.
    pub cases: Vec<CaseBench>,
    /// The ratios.
    pub speedups: Vec<Speedup>,
}

impl Bench {
    /// A run with the ratios that its cases allow. `levels` and `limit` as in the fields.
    pub fn new(
        date: String,
        command: String,
        machine: Machine,
        limit: f64,
        levels: Vec<f64>,
        cases: Vec<CaseBench>,
    ) -> Self {
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION").to_string(),
            date,
            command,
            machine,
            range: Range::default(),
            speedups: speedups(&cases, &levels),
            levels,
            limit,
            cases,
        }
    }

    /// Parses the text of a `bench.json` that stands at `path`.
    ///
    /// # Errors
    /// [`Error::File`] when it is none, or of another layout.
    pub fn parse(text: &str, path: &Path) -> Result<Self> {
        let refuse = |line, message: String| Error::File {
            path: path.to_path_buf(),
            line,
            message,
            remedy: "make it anew with `edgeline bench --fem live`".to_string(),
        };
        let bench: Self =
            serde_json::from_str(text).map_err(|e| refuse(Some(e.line()), e.to_string()))?;
        if bench.schema != SCHEMA {
            let message = format!("has schema {}, this program reads {SCHEMA}", bench.schema);
            return Err(refuse(None, message));
        }
        Ok(bench)
    }

    /// The record that is built into the program.
    ///
    /// # Errors
    /// As [`Bench::parse`].
    pub fn recorded() -> Result<Self> {
        Self::parse(RECORD, Path::new("results/bench.json"))
    }

    /// The ratios of `case`, under its own name.
    pub fn speedups_of(&self, case: &Case) -> Vec<Speedup> {
        let found = self.cases.iter().find(|c| c.case.is_same_problem(case));
        let named = |s: &&Speedup| found.is_some_and(|c| c.case.name == s.case);
        let own = self.speedups.iter().filter(named);
        own.map(|s| Speedup { case: case.name.clone(), ..s.clone() }).collect()
    }

    /// Times of the finest live mesh of `case` and of the models at its tolerance.
    pub fn timed(&self, case: &Case) -> Option<Timed> {
        let found = self.cases.iter().find(|c| c.case.is_same_problem(case))?;
        let live = found.points.iter().filter(|p| p.origin == Origin::LiveFem);
        let fem =
            live.filter(|p| p.timing.is_some()).min_by(|a, b| a.setting.total_cmp(&b.setting))?;
        let same = |p: &&Point| (p.setting / case.tolerance - 1.0).abs() < 1e-9;
        let models = found.points.iter().filter(|p| p.origin == Origin::Model).filter(same);
        let methods: std::collections::BTreeMap<_, _> =
            models.filter_map(|p| Some((p.source.clone(), p.timing?.with_spread()))).collect();
        (!methods.is_empty()).then(|| Timed {
            date: self.date.clone(),
            machine: self.machine.processor.clone(),
            command: self.command.clone(),
            size: fem.setting,
            unknowns: fem.unknowns.unwrap_or(0),
            seconds: fem.timing.map(|t| t.with_spread()).expect("filtered above"),
            error: fem.error(Against::Fem),
            tolerance: case.tolerance,
            methods,
        })
    }
}

/// A mesh and its times.
pub struct Mesh {
    /// The result.
    pub result: MeshResult,
    /// The times of its runs.
    pub timing: Timing,
}

/// FEM's part in a case.
pub struct FemMeshes {
    /// The record of the case, if there is one.
    pub recorded: Option<fem::Reference>,
    /// Meshes of this run, by relative element size, or why one failed.
    pub live: Vec<(f64, std::result::Result<Mesh, String>)>,
}

impl FemMeshes {
    /// Runs `case` by each driver `repeats` times in folders below `folder`. A mesh that fails is
    /// kept with its reason.
    pub fn run(
        recorded: Option<fem::Reference>,
        drivers: &[(f64, Driver)],
        repeats: usize,
        case: &Case,
        folder: &Path,
        progress: &dyn Fn(&str),
    ) -> Self {
        let live = drivers
            .iter()
            .map(|(size, driver)| {
                let folder = folder.join(format!("size-{size}"));
                let run = repeated(driver, repeats, case, &folder, progress);
                let mesh = run.map(|(result, timing)| Mesh { result, timing });
                (*size, mesh.map_err(|e| e.to_string()))
            })
            .collect();
        Self { recorded, live }
    }

    /// The finest mesh as the reference. Of two that are equally fine the recorded one counts.
    fn reference(&self, case: &Case) -> Option<FemReference> {
        let recorded = self.recorded.iter().flat_map(|r| &r.meshes).map(|m| ("recorded", m));
        let live = self.live.iter().filter_map(|(_, m)| Some(("live", &m.as_ref().ok()?.result)));
        let mut all: Vec<(&'static str, &MeshResult)> = recorded.chain(live).collect();
        all.sort_by(|a, b| a.1.size.total_cmp(&b.1.size));
        all.dedup_by(|a, b| a.1.size == b.1.size);
        let (source, finest) = *all.first()?;
        Some(FemReference {
            finest: sampled(case, finest, source),
            next: all.get(1).map(|(source, mesh)| sampled(case, mesh, source)),
            size: finest.size,
            words: format!("{source}, size {}", finest.size),
        })
    }
}

/// FEM's finest mesh as a reference.
struct FemReference {
    finest: Sampled,
    /// The mesh after it, whose difference is what the finest says of its own error.
    next: Option<Sampled>,
    size: f64,
    words: String,
}

/// One mesh at the standard points, in units of C and p0.
fn sampled(case: &Case, mesh: &MeshResult, source: &'static str) -> Sampled {
    let meshes = vec![mesh.clone()];
    from_fem(&fem::Reference { case: case.clone(), source, meshes, errors: Vec::new() }).sampled
}

/// What a run needs.
pub struct Setup<'a> {
    /// Models to run.
    pub methods: Vec<EdgeModel>,
    /// Tolerances (p0), each once.
    pub tolerances: Vec<f64>,
    /// Repeats of the timing, at least 1.
    pub repeats: usize,
    /// Solves cases that differ only in scale by one method.
    pub solver: &'a Solver<'a>,
    /// Seconds in a process of its own, as in [`StudySetup::cold`].
    pub cold: &'a dyn Fn(&Case, EdgeModel, usize) -> Option<f64>,
    /// FEM's part in a case.
    pub fem: &'a dyn Fn(&Case) -> FemMeshes,
    /// Called with the number of steps done and of all steps, and what was just done.
    pub progress: &'a (dyn Fn(usize, usize, &str) + Sync),
}

/// One sampled answer of a point.
type Answered = (Point, Option<Sampled>);

/// Runs every case on FEM's meshes, and then by every model at every tolerance. What fails is kept
/// with its reason.
pub fn run(cases: &[Case], setup: &Setup) -> Vec<CaseBench> {
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
    let references: Vec<_> = cases.iter().zip(&fem).map(|(c, f)| f.reference(c)).collect();
    let mut points: Vec<Vec<Answered>> = vec![Vec::new(); cases.len()];
    for (stage, &tolerance) in setup.tolerances.iter().enumerate() {
        let of_stage = models_at(cases, tolerance, setup, stage + 1);
        for (all, more) in points.iter_mut().zip(of_stage) {
            all.extend(more);
        }
    }
    let limit = setup.tolerances.iter().copied().fold(f64::INFINITY, f64::min);
    cases
        .iter()
        .zip(&fem)
        .zip(references)
        .zip(points)
        .map(|(((case, meshes), reference), mut points)| {
            points.extend(fem_points(case, meshes));
            assess(case, points, reference, limit, &Range::default())
        })
        .collect()
}

/// The points of all models at one tolerance, one list a case.
fn models_at(cases: &[Case], tolerance: f64, setup: &Setup, stage: usize) -> Vec<Vec<Answered>> {
    let stages = setup.tolerances.len() + 1;
    let study = Study {
        name: "bench".to_string(),
        load_levels: Vec::new(),
        slenderness_levels: Vec::new(),
        length_ratio_levels: Vec::new(),
        corners: Vec::new(),
        centre: None,
        extra: cases.iter().map(|c| Case { tolerance, ..c.clone() }).collect(),
    };
    let run = run_study(
        &study,
        &StudySetup {
            methods: setup.methods.clone(),
            range: Range::default(),
            repeats: setup.repeats,
            solver: setup.solver,
            cold: setup.cold,
            // Compared later: the references are the same at every tolerance.
            reference: &|_| Err("compared later".to_string()),
            progress: &|done, all, what| {
                let whole = 100 * (stage * all + done) / all;
                (setup.progress)(whole, 100 * stages, &format!("tolerance {tolerance:e}: {what}"));
            },
        },
    );
    let of_method = |m: super::MethodRun| {
        let (sampled, err) = match m.answer {
            Ok(answer) => (Some(answer.sampled), None),
            Err(message) => (None, Some(message)),
        };
        // No time counts for an answer that was not computed.
        let timing = |i: usize| sampled.as_ref().and(m.timing.get(i)).copied();
        let point = Point {
            timing: timing(0),
            all_threads: timing(1),
            err,
            ..Point::new(m.method.name(), Origin::Model, tolerance)
        };
        (point, sampled)
    };
    run.cases.into_iter().map(|c| c.methods.into_iter().map(of_method).collect()).collect()
}

/// The points of FEM, live meshes first.
fn fem_points(case: &Case, meshes: &FemMeshes) -> Vec<Answered> {
    let point = |origin, setting| Point::new("fem", origin, setting);
    let live = meshes.live.iter().map(|(size, mesh)| match mesh {
        Ok(mesh) => (
            Point {
                unknowns: Some(mesh.result.summary.unknowns as u64),
                timing: Some(mesh.timing),
                ..point(Origin::LiveFem, *size)
            },
            Some(sampled(case, &mesh.result, "live")),
        ),
        Err(message) => {
            (Point { err: Some(message.clone()), ..point(Origin::LiveFem, *size) }, None)
        }
    });
    let recorded = meshes.recorded.iter().flat_map(|r| &r.meshes).map(|mesh| {
        let seconds = mesh.summary.total_seconds();
        let point = Point {
            unknowns: Some(mesh.summary.unknowns as u64),
            timing: Some(Timing::new(mesh.summary.ranks, &[seconds])),
            machine: Some(mesh.summary.processor().to_string()),
            ..point(Origin::RecordedFem, mesh.size)
        };
        (point, Some(sampled(case, mesh, "recorded")))
    });
    live.chain(recorded).collect()
}

/// Compares the points of a case with both references.
fn assess(
    case: &Case,
    points: Vec<Answered>,
    reference: Option<FemReference>,
    limit: f64,
    range: &Range,
) -> CaseBench {
    let is_limit = |p: &Point| p.source == BEST.name() && p.setting == limit;
    let limit = points.iter().find(|(p, _)| is_limit(p)).and_then(|(_, s)| s.clone());
    // The finest mesh against itself would be exact.
    let own = reference
        .as_ref()
        .and_then(|r| Accuracy::between(case, &r.finest, r.next.as_ref()?, range));
    let points = points
        .into_iter()
        .map(|(mut point, sampled)| {
            let Some(sampled) = sampled else { return point };
            point.to_fem = reference.as_ref().and_then(|r| {
                if point.source == "fem" && point.setting <= r.size {
                    return own;
                }
                Accuracy::between(case, &r.finest, &sampled, range)
            });
            if !is_limit(&point) {
                point.to_limit = limit
                    .as_ref()
                    .and_then(|limit| Accuracy::between(case, limit, &sampled, range));
            }
            point
        })
        .collect();
    CaseBench { case: case.clone(), fem_reference: reference.map(|r| r.words), points }
}

/// FEM against [`BEST`] at each level, where both were timed in this run and stay within it.
pub fn speedups(cases: &[CaseBench], levels: &[f64]) -> Vec<Speedup> {
    let mut all = Vec::new();
    for case in cases {
        for &level in levels {
            for against in [Against::Limit, Against::Fem] {
                all.extend(speedup(case, level, against));
            }
        }
    }
    all
}

fn speedup(case: &CaseBench, level: f64, against: Against) -> Option<Speedup> {
    let fastest = |chosen: &dyn Fn(&Point) -> bool, against: Against| {
        let within = |p: &&Point| chosen(p) && p.error(against).is_some_and(|e| e <= level);
        let timed = case.points.iter().filter(within).filter_map(|p| Some((p, p.timing?)));
        timed.min_by(|a, b| a.1.median_s.total_cmp(&b.1.median_s))
    };
    let (fem, fem_time) = fastest(&|p| p.origin == Origin::LiveFem, Against::Fem)?;
    let best = |p: &Point| p.origin == Origin::Model && p.source == BEST.name();
    let (model, model_time) = fastest(&best, against)?;
    Some(Speedup {
        case: case.case.name.clone(),
        level,
        against,
        size: fem.setting,
        unknowns: fem.unknowns,
        fem_error: fem.error(Against::Fem)?,
        fem_seconds: fem_time.with_spread(),
        tolerance: model.setting,
        model_error: model.error(against)?,
        model_seconds: model_time.with_spread(),
        ratio: Ratio::new(fem_time.with_spread(), model_time.with_spread()),
    })
}

/// Of pairs of time and error those that no other beats in both, fastest first.
pub fn front(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut best = f64::INFINITY;
    points.retain(|&(_, error)| {
        let better = error < best;
        best = best.min(error);
        better
    });
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::synthetic;

    /// Two cases of the built-in study that differ only in load, on made-up answers.
    fn cases() -> Vec<Case> {
        let study = Study::built_in();
        let names = ["w1e-4_sl5_lr1", "w1e-3_sl5_lr1"];
        study.corners.into_iter().filter(|c| names.contains(&c.name.as_str())).collect()
    }

    fn bench() -> Vec<CaseBench> {
        run(
            &cases(),
            &Setup {
                methods: vec![EdgeModel::Mirror, BEST],
                tolerances: vec![1e-2, 1e-3, 1e-4],
                repeats: 2,
                solver: &synthetic::solve_to_tolerance,
                cold: &|_, _, threads| Some(threads as f64),
                fem: &|case| synthetic::fem_meshes(case, &[2.0, 1.0], &[1.4]),
                progress: &|done, all, _| assert!(done <= all),
            },
        )
    }

    fn find<'a>(case: &'a CaseBench, source: &str, origin: Origin, setting: f64) -> &'a Point {
        let is_it = |p: &&Point| p.source == source && p.origin == origin && p.setting == setting;
        case.points.iter().find(is_it).unwrap()
    }

    #[test]
    fn errors_are_those_of_the_made_up_answers() {
        for case in bench() {
            assert_eq!(case.fem_reference.as_deref(), Some("recorded, size 1"));
            // Two models at three tolerances, two recorded meshes and a live one.
            assert_eq!(case.points.len(), 6 + 3);
            // Off by its tolerance in every normal stress, and so is the limit.
            let loose = find(&case, "quarter-space", Origin::Model, 1e-2);
            let to_limit = loose.to_limit.unwrap();
            assert!((to_limit.worst_rms - (1e-2 - 1e-4)).abs() < 1e-12, "{to_limit:?}");
            assert!((to_limit.stress_max - (1e-2 - 1e-4)).abs() < 1e-12, "{to_limit:?}");
            let to_fem = loose.to_fem.unwrap();
            assert!((to_fem.pressure_max - (1e-2 - synthetic::mesh_shift(1.0))).abs() < 1e-12);
            assert!(find(&case, "quarter-space", Origin::Model, 1e-4).to_limit.is_none());
            assert!(find(&case, "mirror", Origin::Model, 1e-4).to_limit.unwrap().worst_rms > 0.01);
            // Meshes against the finest, which says of itself what the next one is off by.
            let off = |a: f64| synthetic::mesh_shift(a) - synthetic::mesh_shift(1.0);
            for (origin, size, error) in [
                (Origin::RecordedFem, 2.0, off(2.0)),
                (Origin::LiveFem, 1.4, off(1.4)),
                (Origin::RecordedFem, 1.0, off(1.4)),
            ] {
                let point = find(&case, "fem", origin, size);
                assert!((point.error(Against::Fem).unwrap() - error).abs() < 1e-12, "{point:?}");
                assert_eq!(point.machine.is_some(), origin == Origin::RecordedFem);
            }
            assert_eq!(loose.timing.unwrap().cold_s, Some(1.0));
            assert!(loose.all_threads.is_some());
        }
    }

    #[test]
    fn only_times_of_this_run_are_divided_and_only_within_the_level() {
        let mut cases = bench();
        for case in &mut cases {
            for point in case.points.iter_mut().filter(|p| p.origin == Origin::Model) {
                // A time that is known, ten times as long for a tenth of the tolerance.
                point.timing =
                    Some(Timing::new(1, &[0.9e-5 / point.setting, 1.1e-5 / point.setting]));
            }
        }
        let fem_error = synthetic::mesh_shift(1.4) - synthetic::mesh_shift(1.0);
        let all = speedups(&cases, &[fem_error * 1.01, fem_error * 0.99]);
        // The tighter level is reached by no live mesh; each case at the other against both.
        assert_eq!(all.len(), 2 * 2, "{all:?}");
        for s in &all {
            assert_eq!((s.size, s.tolerance), (1.4, 1e-3));
            assert!((s.model_seconds.0 - 0.01).abs() < 1e-12);
            let expected = s.fem_seconds.0 / 0.01;
            assert!((s.ratio.value - expected).abs() < 1e-9 * expected);
            let share = (s.fem_seconds.1 / s.fem_seconds.0).hypot(0.1);
            assert!((s.ratio.plus_minus - expected * share).abs() < 1e-9 * expected);
        }
        // Without a live mesh there is no ratio, however good the record is.
        cases.iter_mut().for_each(|c| c.points.retain(|p| p.origin != Origin::LiveFem));
        assert!(speedups(&cases, &[1.0]).is_empty());
    }

    #[test]
    fn the_built_in_record_survives_its_file_and_finds_its_cases() {
        let record = Bench::recorded().unwrap();
        assert!(record.speedups.iter().all(|s| s.fem_error <= s.level && s.model_error <= s.level));
        let text = serde_json::to_string(&record).unwrap();
        assert_eq!(Bench::parse(&text, Path::new("b")).unwrap(), record);
        let other = text.replacen("\"schema\":1", "\"schema\":9", 1);
        assert!(Bench::parse(&other, Path::new("b")).unwrap_err().to_string().contains("schema 9"));

        let made_up = Bench { cases: bench(), ..record };
        for case in cases() {
            let timed = made_up.timed(&Case { tolerance: 1e-3, ..case.clone() }).unwrap();
            assert_eq!((timed.size, timed.methods.len()), (1.4, 2));
            assert!(made_up.timed(&Case { tolerance: 3e-3, ..case }).is_none());
        }
    }

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let points = vec![(3.0, 0.1), (1.0, 0.5), (2.0, 0.6), (2.0, 0.3), (4.0, 0.1), (5.0, 0.01)];
        assert_eq!(front(points), [(1.0, 0.5), (2.0, 0.3), (3.0, 0.1), (5.0, 0.01)]);
    }
}
