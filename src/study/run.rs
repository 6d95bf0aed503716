//! The run of a study: every case by every method, paired with FEM.

use super::errors::{ErrorRow, ErrorSummary, Range, compare, critical_point, summarise};
use super::models::{Attempt, Jobs, Models};
use super::published::PublishedAttempt;
use super::source::{Engine, Source};
use super::timing::Timing;
use crate::base::Result;
use crate::body::EdgeModel;
use crate::case::two_level::TwoLevel;
use crate::case::{Case, FactorKey, Study};
use crate::solve::{CellDetails, Details, Solution};
use crate::stress::{Critical, Curves};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The curves that an engine has for one case.
#[derive(Debug, Clone)]
pub struct Reference {
    /// The curves.
    pub curves: Curves,
    /// Where they come from and what they cost.
    pub provenance: Provenance,
    /// Relative size of their mesh, where they have one.
    pub size: Option<f64>,
    /// The curves of coarser meshes and their sizes, finest first.
    pub coarser: Vec<(f64, Curves)>,
}

/// Where reference curves come from. What a record does not state is `None`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Whether they were computed in this run, on this machine. Only then may their time be divided
    /// by a time of this run.
    pub live: bool,
    /// When they were computed.
    pub date: Option<String>,
    /// The machine's processor.
    pub machine: Option<String>,
    /// The command that computes them again.
    pub command: Option<String>,
    /// Unknowns of both bodies.
    pub unknowns: Option<u64>,
    /// Wall-clock seconds of all stages; the median where it was repeated.
    pub seconds: Option<f64>,
    /// Half the spread of the repeats (s).
    pub seconds_spread: Option<f64>,
    /// Seconds of each stage.
    pub stages: BTreeMap<String, f64>,
    /// Versions of the programs used.
    pub versions: BTreeMap<String, String>,
    /// Times of FEM and of the models from one run on one machine, if there is a record of them: if
    /// the curves are not of this run, only the ratio of these times may be stated.
    pub timed: Option<Timed>,
}

/// Times of FEM and of the models that solved the same case in one run on one machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Timed {
    /// The date.
    pub date: String,
    /// The machine's processor.
    pub machine: String,
    /// The command.
    pub command: String,
    /// Relative element size of the FEM mesh; 1 is the production mesh.
    pub size: f64,
    /// Unknowns of both bodies.
    pub unknowns: u64,
    /// Median seconds of all stages of FEM, and spread.
    pub seconds: (f64, f64),
    /// FEM's error on that mesh (p0): the largest RMS of one curve (see
    /// [`super::bench::Deviation::worst_rms`]), where it is known.
    pub error: Option<f64>,
    /// The models' tolerance.
    pub tolerance: f64,
    /// Median seconds and spread of each model on one thread.
    pub methods: BTreeMap<String, (f64, f64)>,
}

/// The role of a case in its study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Role {
    /// A corner of the design, with the coded levels of the design's factors.
    Corner(Vec<i8>),
    /// The centre point.
    Centre,
    /// A further case.
    Extra,
}

/// The details of a solution by the engine of its method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum MethodDetails {
    /// A model on the line.
    Line(Box<Details>),
    /// The published method on cells.
    Cells(Box<CellDetails>),
}

/// The result of one method for one case.
#[derive(Debug, Clone)]
pub struct MethodResult {
    /// The solution.
    pub solution: Solution<MethodDetails>,
    /// The most stressed point outside the excluded range.
    pub critical: Option<Critical>,
    /// Errors against the case's first reference; empty without one.
    pub errors: Vec<ErrorRow>,
    /// The errors in summary.
    pub summary: Option<ErrorSummary>,
}

/// One method on one case.
#[derive(Debug, Clone)]
pub struct MethodRun {
    /// The method: a model, or the published method on cells.
    pub source: Source,
    /// Its result, or the error in words.
    pub result: std::result::Result<MethodResult, String>,
    /// Repeated timing on one thread and on all; empty without timing.
    pub timing: Vec<Timing>,
}

/// One reference for one case.
#[derive(Debug, Clone)]
pub struct ReferenceRun {
    /// The engine.
    pub engine: Engine,
    /// Its curves, or why there are none.
    pub result: std::result::Result<Reference, String>,
    /// The most stressed point outside the excluded range.
    pub critical: Option<Critical>,
}

/// One case of a run.
#[derive(Debug, Clone)]
pub struct CaseRun {
    /// The case.
    pub case: Case,
    /// Its role in the study.
    pub role: Role,
    /// The references. Errors are taken against the first.
    pub references: Vec<ReferenceRun>,
    /// The models in the order of the study, then the published method.
    pub methods: Vec<MethodRun>,
}

impl CaseRun {
    /// The curves that errors are taken against: those of the first reference.
    pub fn reference(&self) -> Option<&Reference> {
        self.references.first()?.result.as_ref().ok()
    }

    /// The most stressed point of the first reference outside the excluded range.
    pub fn reference_critical(&self) -> Option<Critical> {
        self.references.first()?.critical
    }
}

/// A factor of the design, with its two levels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Factor {
    /// Its name.
    pub name: String,
    /// Its low level.
    pub low: f64,
    /// Its high level.
    pub high: f64,
}

impl Factor {
    fn of((key, [low, high]): (FactorKey, [f64; 2])) -> Self {
        Self { name: key.name().to_string(), low, high }
    }
}

/// A study that has been run.
#[derive(Debug, Clone)]
pub struct StudyRun {
    /// The study's name.
    pub study: String,
    /// The factors with two levels; empty when a factor has more than two.
    pub factors: Vec<Factor>,
    /// The two-level design of these factors, if there are any.
    pub design: Option<TwoLevel>,
    /// The factors that the study varies beside W, S_l and L_r.
    pub further: Vec<FactorKey>,
    /// The models.
    pub methods: Vec<EdgeModel>,
    /// The range of the errors.
    pub range: Range,
    /// The cases, in the study's order.
    pub cases: Vec<CaseRun>,
    /// Number of contact problems solved; cases that differ only in W share one.
    pub solves: usize,
}

/// The curves of an engine, or why there are none.
pub type FoundReference = (Engine, std::result::Result<Reference, String>);

/// The input of a run besides the study.
pub struct StudySetup<'a> {
    /// The models.
    pub models: Models<'a>,
    /// Range of the errors.
    pub range: Range,
    /// Finds the references of a case, the one that errors are taken against first.
    pub references: &'a dyn Fn(&Case) -> Vec<FoundReference>,
    /// Called after each step with the number of finished steps, the number of all steps and the
    /// step's name.
    pub progress: &'a (dyn Fn(usize, usize, &str) + Sync),
}

/// The role of a case in its study.
fn role(case: &Case, study: &Study) -> Role {
    if study.corners.iter().any(|c| c.name == case.name) {
        let code = |(key, [low, high]): (FactorKey, [f64; 2])| {
            let value = key.of(case).unwrap_or(f64::NAN);
            if value > 0.5 * (low + high) { 1 } else { -1 }
        };
        Role::Corner(study.pairs().into_iter().map(code).collect())
    } else if study.centre.as_ref().is_some_and(|c| c.name == case.name) {
        Role::Centre
    } else {
        Role::Extra
    }
}

/// Runs the study. A case or method that fails is kept with its error; the others still run.
pub fn run(study: &Study, setup: &StudySetup) -> StudyRun {
    let cases: Vec<Case> = study.cases().cloned().collect();
    let jobs = Jobs::new(&cases, &setup.models);
    let published = setup.models.published;
    let steps = cases.len() + jobs.steps() + published.map_or(0, |_| cases.len());
    let done = AtomicUsize::new(0);
    let step = |what: &str| {
        let n = done.fetch_add(1, Ordering::Relaxed) + 1;
        (setup.progress)(n, steps, what);
    };

    let references: Vec<Vec<ReferenceRun>> = cases
        .iter()
        .map(|case| {
            let found = (setup.references)(case);
            step(&format!("FEM of {}", case.name));
            found.into_iter().map(|found| reference_run(case, found, &setup.range)).collect()
        })
        .collect();
    let runs =
        cases.iter().zip(references).zip(jobs.run(&step)).map(|((case, references), attempts)| {
            let reference = references.first().and_then(|r| r.result.as_ref().ok());
            let compared = |source: Source, solution, timing| {
                method_run(case, reference, (source, solution, timing), &setup.range)
            };
            let model = |Attempt { method, solution, timing }| {
                let line = |details| MethodDetails::Line(Box::new(details));
                compared(method.into(), solution.map(|s: Solution| s.map_details(line)), timing)
            };
            let on_cells = |solve| {
                let timed = setup.models.repeats > 0;
                let PublishedAttempt { solution, timing } =
                    PublishedAttempt::new(solve, timed, case, None);
                let source = Engine::published();
                step(&format!("{}, {}", source.title(), case.name));
                let cells = |details| MethodDetails::Cells(Box::new(details));
                let solution = solution.map(|s| s.map_details(cells));
                compared(source.into(), solution, timing.into_iter().collect())
            };
            let models = attempts.into_iter().map(model);
            let methods = models.chain(published.map(on_cells)).collect();
            CaseRun { case: case.clone(), role: role(case, study), methods, references }
        });
    StudyRun {
        study: study.name.clone(),
        cases: runs.collect(),
        factors: study.pairs().into_iter().map(Factor::of).collect(),
        design: study.design.clone(),
        further: study.further(),
        methods: setup.models.methods.clone(),
        range: setup.range.clone(),
        solves: jobs.solves(),
    }
}

/// Looks for the most stressed point of a reference.
fn reference_run(case: &Case, (engine, result): FoundReference, range: &Range) -> ReferenceRun {
    let ends = case.overlap();
    let critical =
        result.as_ref().ok().and_then(|r| critical_point(&r.curves, ends, range.stress_c));
    ReferenceRun { engine, result, critical }
}

/// Compares an attempt with its case's reference.
fn method_run(
    case: &Case,
    reference: Option<&Reference>,
    (source, solution, timing): (Source, Result<Solution<MethodDetails>>, Vec<Timing>),
    range: &Range,
) -> MethodRun {
    let ends = case.overlap();
    let compared = |solution: Solution<MethodDetails>| {
        let own = (&source, &solution.curves);
        let errors = match reference {
            Some(r) => compare(&case.name, ends, &r.curves, own, range)?,
            None => Vec::new(),
        };
        Ok(MethodResult {
            critical: critical_point(&solution.curves, ends, range.stress_c),
            summary: summarise(&errors, range),
            solution,
            errors,
        })
    };
    let result: Result<MethodResult> = solution.and_then(compared);
    MethodRun { result: result.map_err(|e| e.to_string()), source, timing }
}
