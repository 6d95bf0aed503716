//! The run of a study: every case by every method, paired with FEM.

use super::errors::{
    CriticalPoint, ErrorRow, ErrorSummary, Range, compare, critical_point, summarise,
};
use super::sampled::Sampled;
use super::timing::{self, Timing};
use crate::base::Result;
use crate::body::EdgeModel;
use crate::case::{Case, Study};
use crate::solve::Solution;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// FEM's answer for one case, and where it comes from.
#[derive(Debug, Clone)]
pub struct Reference {
    /// Its curves in units of C and p0; the source is `fem`.
    pub sampled: Sampled,
    /// Where it comes from and what it cost.
    pub provenance: Provenance,
}

/// Where a FEM answer comes from. What a record does not state is `None`.
#[derive(Debug, Clone, Default, Serialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize)]
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

/// Solves cases that share a scene by one edge model, one answer a case in their order.
pub type Solver<'a> = dyn Fn(&[Case], EdgeModel) -> Vec<Result<Solution>> + Sync + 'a;

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
    /// The solution in SI units.
    pub solution: Solution,
    /// The same on the standard points, in units of C and p0.
    pub sampled: Sampled,
    /// The most stressed place outside the range left out.
    pub critical: Option<CriticalPoint>,
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
    pub reference_critical: Option<CriticalPoint>,
    /// The methods, in the order asked for.
    pub methods: Vec<MethodRun>,
}

/// A factor of the design that has two levels.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Factor {
    /// `W`, `S_l` or `L_r`.
    pub name: &'static str,
    /// Its low level.
    pub low: f64,
    /// Its high level.
    pub high: f64,
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
    /// Methods to run.
    pub methods: Vec<EdgeModel>,
    /// Range of the errors.
    pub range: Range,
    /// Warm repeats of the timing; 0 leaves the timing out.
    pub repeats: usize,
    /// Solves cases that differ only in scale by one method, one result each, in order.
    pub solver: &'a Solver<'a>,
    /// Seconds of one case by one method on this many threads in a process of its own, where that
    /// can be measured.
    pub cold: &'a dyn Fn(&Case, EdgeModel, usize) -> Option<f64>,
    /// FEM's answer for a case, or why there is none.
    pub reference: &'a dyn Fn(&Case) -> std::result::Result<Reference, String>,
    /// Called with the number of steps done and of all steps, and what was just done.
    pub progress: &'a (dyn Fn(usize, usize, &str) + Sync),
}

/// What cases must have in common to be one problem in units of C and p0: all but the scale.
/// Numbers that differ by rounding only are the same.
pub fn problem_key(case: &Case) -> String {
    let factors = case.factors();
    let stiffness = case.roller.material.young_pa / case.block.material.young_pa;
    let (nu_roller, nu_block) = (case.roller.material.poisson, case.block.material.poisson);
    format!(
        "{:.9e} {:.9e} {nu_roller:e} {nu_block:e} {stiffness:.9e} {:e}",
        factors.slenderness, factors.length_ratio, case.tolerance
    )
}

/// Indices of the cases of each problem, in the order of first appearance.
fn groups(cases: &[Case]) -> Vec<Vec<usize>> {
    let mut order: Vec<(String, Vec<usize>)> = Vec::new();
    for (i, case) in cases.iter().enumerate() {
        let key = problem_key(case);
        match order.iter_mut().find(|(k, _)| *k == key) {
            Some((_, members)) => members.push(i),
            None => order.push((key, vec![i])),
        }
    }
    order.into_iter().map(|(_, members)| members).collect()
}

/// The factors with two levels, and the coded levels of a case. A factor with one level is not a
/// factor; with three or more levels of any there is no two-level design.
fn design(study: &Study) -> Vec<Factor> {
    let levels = [
        ("W", &study.load_levels),
        ("S_l", &study.slenderness_levels),
        ("L_r", &study.length_ratio_levels),
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

/// Value of the factor called `name` for a case.
fn factor_value(case: &Case, name: &str) -> f64 {
    let factors = case.factors();
    match name {
        "W" => factors.load,
        "S_l" => factors.slenderness,
        _ => factors.length_ratio,
    }
}

fn role(case: &Case, study: &Study, factors: &[Factor]) -> Role {
    if study.corners.iter().any(|c| c.name == case.name) {
        let code = |f: &Factor| {
            let middle = (f.low * f.high).sqrt();
            if factor_value(case, f.name) > middle { 1 } else { -1 }
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
    let groups = groups(&cases);
    let jobs: Vec<(&Vec<usize>, EdgeModel)> =
        groups.iter().flat_map(|g| setup.methods.iter().map(move |&m| (g, m))).collect();
    let timings = if setup.repeats > 0 { jobs.len() } else { 0 };
    let steps = cases.len() + jobs.len() + timings;
    let done = std::sync::atomic::AtomicUsize::new(0);
    let step = |what: &str| {
        let n = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
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

    let members = |group: &[usize]| group.iter().map(|&i| cases[i].clone()).collect::<Vec<_>>();
    let solved: Vec<Vec<Result<Solution>>> = jobs
        .par_iter()
        .map(|(group, method)| {
            let solutions = (setup.solver)(&members(group), *method);
            step(&format!("{method}, {}", cases[group[0]].name));
            solutions
        })
        .collect();

    // Timing runs alone, after everything else, and on one case of each problem: the others of the
    // group only differ in scale.
    let mut timing: Vec<Vec<Timing>> = vec![Vec::new(); jobs.len()];
    if setup.repeats > 0 {
        for (slot, (group, method)) in timing.iter_mut().zip(&jobs) {
            let one = vec![cases[group[0]].clone()];
            let work = || (setup.solver)(&one, *method).into_iter().collect::<Result<Vec<_>>>();
            *slot = [1, 0]
                .into_iter()
                .filter_map(|threads| timing::measure(threads, setup.repeats, work).ok())
                .map(|t| Timing { cold_s: (setup.cold)(&one[0], *method, t.threads), ..t })
                .collect();
            step(&format!("timing {method}, {}", one[0].name));
        }
    }

    let mut runs: Vec<CaseRun> = cases
        .iter()
        .zip(references)
        .map(|(case, reference)| {
            let half_length = case.factors().slenderness;
            CaseRun {
                case: case.clone(),
                role: role(case, study, &factors),
                reference_critical: reference
                    .as_ref()
                    .ok()
                    .and_then(|r| critical_point(&r.sampled, half_length, setup.range.stress_c)),
                reference,
                methods: Vec::new(),
            }
        })
        .collect();
    for (((group, method), solutions), timing) in jobs.iter().zip(solved).zip(timing) {
        for (&i, solution) in group.iter().zip(solutions) {
            let answer = solution.map_err(|e| e.to_string()).and_then(|solution| {
                answer(&runs[i], solution, &setup.range).map_err(|e| e.to_string())
            });
            runs[i].methods.push(MethodRun { method: *method, answer, timing: timing.clone() });
        }
    }
    StudyRun {
        study: study.name.clone(),
        factors,
        methods: setup.methods.clone(),
        range: setup.range.clone(),
        cases: runs,
        solves: jobs.len(),
    }
}

/// Compares a solution with its case's reference.
fn answer(run: &CaseRun, solution: Solution, range: &Range) -> Result<Answer> {
    let half_length = run.case.factors().slenderness;
    let sampled = Sampled::from_solution(&solution);
    let errors = match &run.reference {
        Ok(r) => compare(&run.case.name, half_length, &r.sampled, &sampled, range)?,
        Err(_) => Vec::new(),
    };
    Ok(Answer {
        critical: critical_point(&sampled, half_length, range.stress_c),
        summary: summarise(&errors, range),
        solution,
        sampled,
        errors,
    })
}
