//! The run of a study: every case by every method, paired with FEM.

use super::errors::{ErrorRow, ErrorSummary, Range, compare, critical_point, summarise};
use super::models::{Attempt, Models, Work};
use super::source::Engine;
use super::timing::Timing;
use crate::base::Result;
use crate::body::EdgeModel;
use crate::case::{Case, Study};
use crate::solve::Solution;
use crate::stress::{Critical, Curves};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

/// FEM's answer for one case, and where it comes from.
#[derive(Debug, Clone)]
pub struct Reference {
    /// The engine that computed it.
    pub engine: Engine,
    /// Its curves.
    pub curves: Curves,
    /// Where it comes from and what it cost.
    pub provenance: Provenance,
}

/// Where a FEM answer comes from. What a record does not state is `None`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Whether it was computed in this run, on this machine. Only then may its time be divided by
    /// a time of this run.
    pub live: bool,
    /// When it was computed.
    pub date: Option<String>,
    /// The machine's processor.
    pub machine: Option<String>,
    /// The command that computes it again.
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
    /// Times of FEM and of the models from one run on one machine, where there is a record of them:
    /// the ones whose ratio may be stated when the FEM answer is not of this run.
    pub timed: Option<Timed>,
}

/// Times of FEM and of the models that solved the same case in one run on one machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Timed {
    /// When it was.
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
    /// [`super::bench::Accuracy::worst_rms`]), where it is known.
    pub error: Option<f64>,
    /// The models' tolerance.
    pub tolerance: f64,
    /// Median seconds and spread of each model on one thread.
    pub methods: BTreeMap<String, (f64, f64)>,
}

/// The part that a case plays in its study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Role {
    /// A corner of the design, with the coded levels of the design's factors.
    Corner(Vec<i8>),
    /// The centre point.
    Centre,
    /// A further case.
    Extra,
}

/// What one method made of one case.
#[derive(Debug, Clone)]
pub struct Answer {
    /// The solution.
    pub solution: Solution,
    /// The most stressed place outside the range left out.
    pub critical: Option<Critical>,
    /// Errors against FEM; empty without a reference.
    pub errors: Vec<ErrorRow>,
    /// The errors summed up.
    pub summary: Option<ErrorSummary>,
}

/// One method on one case.
#[derive(Debug, Clone)]
pub struct MethodRun {
    /// The method.
    pub method: EdgeModel,
    /// Its answer, or what went wrong in words.
    pub answer: std::result::Result<Answer, String>,
    /// Repeated timing on one thread and on all, where it was asked for.
    pub timing: Vec<Timing>,
}

/// One case of a run.
#[derive(Debug, Clone)]
pub struct CaseRun {
    /// The case.
    pub case: Case,
    /// Its part in the study.
    pub role: Role,
    /// FEM's answer, or why there is none.
    pub reference: std::result::Result<Reference, String>,
    /// FEM's most stressed place outside the range left out.
    pub reference_critical: Option<Critical>,
    /// The methods, in the order asked for.
    pub methods: Vec<MethodRun>,
}

/// A factor of the design that has two levels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Factor {
    /// Which one.
    pub name: FactorName,
    /// Its low level.
    pub low: f64,
    /// Its high level.
    pub high: f64,
}

/// A factor of the study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum FactorName {
    /// The load factor W.
    #[serde(rename = "W")]
    Load,
    /// The slenderness S_l.
    #[serde(rename = "S_l")]
    Slenderness,
    /// The length ratio L_r.
    #[serde(rename = "L_r")]
    LengthRatio,
}

impl FactorName {
    /// The name used in files.
    pub fn name(self) -> &'static str {
        match self {
            FactorName::Load => "W",
            FactorName::Slenderness => "S_l",
            FactorName::LengthRatio => "L_r",
        }
    }

    /// Its value for a case.
    fn of(self, case: &Case) -> f64 {
        let factors = case.factors();
        match self {
            FactorName::Load => factors.load,
            FactorName::Slenderness => factors.slenderness,
            FactorName::LengthRatio => factors.length_ratio,
        }
    }
}

/// A study that has been run.
#[derive(Debug, Clone)]
pub struct StudyRun {
    /// The study's name.
    pub study: String,
    /// The factors with two levels; empty when a factor has more than two.
    pub factors: Vec<Factor>,
    /// The methods asked for.
    pub methods: Vec<EdgeModel>,
    /// The range of the errors.
    pub range: Range,
    /// The cases, in the study's order.
    pub cases: Vec<CaseRun>,
    /// Number of contact problems solved; cases that differ only in W share one.
    pub solves: usize,
}

/// What a run needs besides the study.
pub struct Setup<'a> {
    /// The models.
    pub models: Models<'a>,
    /// Range of the errors.
    pub range: Range,
    /// FEM's answer for a case, or why there is none.
    pub reference: &'a dyn Fn(&Case) -> std::result::Result<Reference, String>,
    /// Called with the number of steps done and of all steps, and what was just done.
    pub progress: &'a (dyn Fn(usize, usize, &str) + Sync),
}

/// The factors with two levels, and the coded levels of a case. A factor with one level is not a
/// factor; with three or more levels of any there is no two-level design.
fn design(study: &Study) -> Vec<Factor> {
    let levels = [
        (FactorName::Load, &study.load_levels),
        (FactorName::Slenderness, &study.slenderness_levels),
        (FactorName::LengthRatio, &study.length_ratio_levels),
    ];
    if levels.iter().any(|(_, l)| l.len() > 2) {
        return Vec::new();
    }
    levels
        .into_iter()
        .filter(|(_, l)| l.len() == 2)
        .map(|(name, l)| Factor { name, low: l[0].min(l[1]), high: l[0].max(l[1]) })
        .collect()
}

fn role(case: &Case, study: &Study, factors: &[Factor]) -> Role {
    if study.corners.iter().any(|c| c.name == case.name) {
        let code = |f: &Factor| {
            let middle = (f.low * f.high).sqrt();
            if f.name.of(case) > middle { 1 } else { -1 }
        };
        Role::Corner(factors.iter().map(code).collect())
    } else if study.centre.as_ref().is_some_and(|c| c.name == case.name) {
        Role::Centre
    } else {
        Role::Extra
    }
}

/// Runs the study. A case or method that fails is kept with its reason; nothing stops the rest.
pub fn run(study: &Study, setup: &Setup) -> StudyRun {
    let cases: Vec<Case> = study.cases().cloned().collect();
    let factors = design(study);
    let work = Work::new(&cases, &setup.models);
    let steps = cases.len() + work.steps();
    let done = AtomicUsize::new(0);
    let step = |what: &str| {
        let n = done.fetch_add(1, Ordering::Relaxed) + 1;
        (setup.progress)(n, steps, what);
    };

    let references: Vec<_> = cases
        .iter()
        .map(|case| {
            let reference = (setup.reference)(case);
            step(&format!("FEM of {}", case.name));
            reference
        })
        .collect();

    let attempts = work.run(&step);
    let runs = cases
        .iter()
        .zip(references)
        .zip(attempts)
        .map(|((case, reference), attempts)| {
            let answer = |attempt: Attempt| MethodRun {
                method: attempt.method,
                answer: attempt
                    .solution
                    .and_then(|s| answer(case, &reference, (attempt.method, s), &setup.range))
                    .map_err(|e| e.to_string()),
                timing: attempt.timing,
            };
            let half_length = case.factors().slenderness;
            CaseRun {
                case: case.clone(),
                role: role(case, study, &factors),
                reference_critical: reference
                    .as_ref()
                    .ok()
                    .and_then(|r| critical_point(&r.curves, half_length, setup.range.stress_c)),
                methods: attempts.into_iter().map(answer).collect(),
                reference,
            }
        })
        .collect();
    StudyRun {
        study: study.name.clone(),
        factors,
        methods: setup.models.methods.clone(),
        range: setup.range.clone(),
        solves: work.solves(),
        cases: runs,
    }
}

/// Compares a solution with its case's reference.
fn answer(
    case: &Case,
    reference: &std::result::Result<Reference, String>,
    (method, solution): (EdgeModel, Solution),
    range: &Range,
) -> Result<Answer> {
    let half_length = case.factors().slenderness;
    let own = (&method.into(), &solution.curves);
    let errors = match reference {
        Ok(r) => compare(&case.name, half_length, &r.curves, own, range)?,
        Err(_) => Vec::new(),
    };
    Ok(Answer {
        critical: critical_point(&solution.curves, half_length, range.stress_c),
        summary: summarise(&errors, range),
        solution,
        errors,
    })
}
