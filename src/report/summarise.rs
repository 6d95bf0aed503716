//! The summary of a study's run: the content of `summary.json`.

use super::brought::FileSummary;
use super::effects_text;
use super::study_summary::{
    CaseMethod, CaseReference, CaseSummary, DesignSummary, FemError, FemOrigin, MethodSummary,
    Program, PublishedSummary, RoleName, Span, StudySummary,
};
use super::verdict;
use crate::body::EdgeModel;
use crate::case::FactorKey;
use crate::case::two_level::{TwoLevel, Word, positive, short, sum};
use crate::study::bench::{Machine, Speedup};
use crate::study::brought::FileRun;
use crate::study::effects::{Effects, NotAnalysed};
use crate::study::gate::GateOutcome;
use crate::study::response::Response;
use crate::study::verification::VerificationRow;
use crate::study::{
    CaseRun, Engine, Factor, MethodDetails, MethodRun, ReferenceRun, Role, Source, StudyRun,
};

/// The facts about a run beside its numbers.
pub struct Context<'a> {
    /// When it ran (UTC, ISO 8601).
    pub date: &'a str,
    /// The command.
    pub command: &'a str,
    /// The origin of the FEM curves.
    pub fem: FemOrigin,
    /// The machine.
    pub machine: Machine,
    /// Wall-clock seconds of the whole run.
    pub seconds: f64,
    /// Outcomes of the gates.
    pub gates: &'a [GateOutcome],
    /// Recorded ratios at equal error; empty if FEM runs live.
    pub speedups: &'a [Speedup],
    /// The same of the published method at the error that it reaches.
    pub published_speedups: &'a [Speedup],
    /// Differences beside the numerical uncertainty of both sides.
    pub verification: &'a [VerificationRow],
    /// Curves from files, compared.
    pub brought: &'a [FileRun],
}

/// The summary of a run.
pub fn study_summary(
    run: &StudyRun,
    context: &Context,
    effects: &[Effects],
    not_analysed: &[NotAnalysed],
) -> StudySummary {
    let mut summary = StudySummary {
        program: Program {
            name: env!("CARGO_PKG_NAME").to_string(),
            version: env!("CARGO_PKG_VERSION").to_string(),
        },
        study: run.study.clone(),
        date: context.date.to_string(),
        command: context.command.to_string(),
        fem: context.fem,
        machine: context.machine.clone(),
        seconds: context.seconds,
        methods: run.methods.clone(),
        range: run.range.clone(),
        factors: run.factors.clone(),
        design: run.design.as_ref().map(|design| design_summary(run, design)),
        further_factors: run.further.iter().map(|key| key.name().to_string()).collect(),
        contact_problems_solved: run.solves,
        published: published(run),
        published_speedups: context.published_speedups.to_vec(),
        method_summary: run.methods.iter().map(|m| worst(run, *m, context.gates)).collect(),
        fem_error: fem_error(run),
        gates_hold: !context.gates.is_empty() && context.gates.iter().all(|g| g.passed),
        gates: context.gates.to_vec(),
        effects_in_words: effects_text::told(run, effects),
        speedups: context.speedups.to_vec(),
        not_done: not_done(run, not_analysed, context.brought),
        cases: run.cases.iter().map(|case| case_summary(run, case, context.brought)).collect(),
        verdict: Vec::new(),
    };
    summary.verdict = verdict::sentences(&summary);
    summary
}

/// The design of a run.
fn design_summary(run: &StudyRun, design: &TwoLevel) -> DesignSummary {
    let mean = |factor: &Factor| {
        let by_ratio = FactorKey::find(&factor.name).is_some_and(FactorKey::is_by_ratio);
        if by_ratio { "geometric" } else { "arithmetic" }.to_string()
    };
    let has_centre = run.cases.iter().any(|case| case.role == Role::Centre);
    let fractional = design.is_fractional();
    let estimated = |set: &Vec<Word>| {
        let set = positive(set);
        sum(&[&set[..1], short(&set[1..])].concat())
    };
    DesignSummary {
        name: design.to_string(),
        runs: 1 << design.basic(),
        resolution: design.resolution(),
        letters: (0..design.factors()).map(TwoLevel::letter).collect(),
        defining_relation: design.defining_relation().iter().map(Word::to_string).collect(),
        aliases: design.aliases().iter().filter(|_| fractional).map(estimated).collect(),
        centre: run.factors.iter().filter(|_| has_centre).map(mean).collect(),
    }
}

fn case_summary(study: &StudyRun, run: &CaseRun, brought: &[FileRun]) -> CaseSummary {
    let (case, factors) = (&run.case, run.case.factors());
    let own = brought.iter().filter(|file| file.case == case.name);
    let method = |m: &MethodRun| {
        let Source::Model(method) = m.source else { return None };
        let part = match &m.result {
            Ok(result) => match &result.solution.summary.details {
                MethodDetails::Line(details) => {
                    CaseMethod::Solved { timing: m.timing.clone(), details: details.clone() }
                }
                MethodDetails::Cells(_) => return None,
            },
            Err(err) => CaseMethod::Failed { err: err.clone() },
        };
        Some((method, part))
    };
    CaseSummary {
        name: case.name.clone(),
        role: RoleName::of(&run.role),
        load: factors.load,
        slenderness: factors.slenderness,
        length_ratio: factors.length_ratio,
        factors: study.further.iter().map(|key| key.of(case)).collect(),
        hertz: case.hertz(),
        overlap_m: case.overlap_m(),
        load_n: case.load.force_n,
        tolerance: case.accuracy.tolerance,
        roller: case.roller.clone(),
        block: case.block.clone(),
        eccentricity_m: case.load.eccentricity_m,
        pose: case.pose,
        sliding: case.sliding,
        fem: run.references.first().map_or_else(
            || CaseReference::Missing { missing: "the study has no reference".to_string() },
            case_reference,
        ),
        references: run
            .references
            .iter()
            .skip(1)
            .map(|r| (r.engine.clone(), case_reference(r)))
            .collect(),
        brought: own.map(|file| FileSummary::of(file, &study.range)).collect(),
        methods: run.methods.iter().filter_map(method).collect(),
    }
}

fn case_reference(run: &ReferenceRun) -> CaseReference {
    match &run.result {
        Ok(reference) => CaseReference::Found(Box::new(reference.provenance.clone())),
        Err(reason) => CaseReference::Missing { missing: reason.clone() },
    }
}

/// What is missing: analyses, then comparisons and solves, one sentence each.
fn not_done(run: &StudyRun, not_analysed: &[NotAnalysed], brought: &[FileRun]) -> Vec<String> {
    let mut all: Vec<String> = not_analysed.iter().map(effects_text::not_analysed).collect();
    for c in &run.cases {
        for r in &c.references {
            if let Err(reason) = &r.result {
                let (name, engine) = (&c.case.name, r.engine.title());
                all.push(format!("{name} is not compared with {engine}: {reason}"));
            }
        }
        for m in &c.methods {
            if let Err(message) = &m.result {
                all.push(format!("{} by {} failed: {message}", c.case.name, m.source));
            }
        }
    }
    for FileRun { case, file, left_out, .. } in brought.iter().filter(|f| !f.left_out.is_empty()) {
        let (name, left_out) = (&file.name, left_out.join(", "));
        all.push(format!("{name} ({case}): all points are next to an edge: {left_out}"));
    }
    all
}

fn fem_error(run: &StudyRun) -> FemError {
    let summaries = || {
        let methods = run.cases.iter().flat_map(|c| &c.methods);
        methods.filter_map(|m| m.result.as_ref().ok()?.summary.as_ref())
    };
    FemError {
        pressure: summaries().filter_map(|s| s.ref_error_pressure).reduce(f64::max),
        stress: summaries().filter_map(|s| s.ref_error_stress).reduce(f64::max),
    }
}

/// The errors of the published method over all cases, if it was compared in any.
fn published(run: &StudyRun) -> Option<PublishedSummary> {
    let own = Source::from(Engine::published());
    let runs = || run.cases.iter().flat_map(|c| c.methods.iter().map(move |m| (c, m)));
    let runs = || runs().filter(|(_, m)| m.source == own);
    let values = |response: Response| runs().filter_map(move |(c, m)| response.value(c, m));
    let span = |response: Response| {
        let all = values(response).map(|v| Span { low: v, high: v });
        all.reduce(|a, b| Span { low: a.low.min(b.low), high: a.high.max(b.high) })
    };
    let seconds = runs().filter_map(|(_, m)| Some(m.timing.first()?.median_s));
    Some(PublishedSummary {
        cases: values(Response::STRESS_RMS).count(),
        pressure_rms: span(Response::PRESSURE_RMS)?,
        pressure_max: span(Response::PRESSURE_MAX)?,
        stress_rms: span(Response::STRESS_RMS)?,
        stress_max: span(Response::STRESS_MAX)?,
        seconds: seconds.reduce(f64::max),
    })
}

/// The worst numbers of one model over all cases.
fn worst(run: &StudyRun, method: EdgeModel, gates: &[GateOutcome]) -> MethodSummary {
    let runs = || {
        run.cases.iter().flat_map(move |c| {
            c.methods.iter().filter(move |m| m.source == method.into()).map(move |m| (c, m))
        })
    };
    let values = |response: Response| runs().filter_map(move |(c, m)| response.value(c, m));
    let largest = |response: Response| values(response).reduce(f64::max);
    let decades = values(Response::Log10Speedup).map(|d| (d, d));
    let decades = decades.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    let compared = |m: &MethodRun| m.result.as_ref().is_ok_and(|result| result.summary.is_some());
    let own = || gates.iter().filter(|g| g.method == method.name());
    MethodSummary {
        method,
        cases: runs().count(),
        failed: runs().filter(|(_, m)| m.result.is_err()).count(),
        compared: runs().filter(|(_, m)| compared(m)).count(),
        pressure_rms: largest(Response::PRESSURE_RMS),
        pressure_max: largest(Response::PRESSURE_MAX),
        stress_rms: largest(Response::STRESS_RMS),
        stress_max: largest(Response::STRESS_MAX),
        von_mises_rms: largest(Response::VON_MISES_RMS),
        von_mises_max: largest(Response::VON_MISES_MAX),
        seconds: runs().filter_map(|(_, m)| Some(m.timing.first()?.median_s)).reduce(f64::max),
        speedup: decades.map(|(a, b)| Span { low: 10f64.powf(a), high: 10f64.powf(b) }),
        gates: own().count(),
        gates_passed: own().filter(|g| g.passed).count(),
    }
}
