//! The rows of a run's tables.

use super::study_rows::{CurveRow, EffectRow, OwnErrorRow, PressureRow, StudyRow};
use super::study_summary::RoleName;
use super::table::Short;
use crate::base::StressTensor;
use crate::case::two_level::{TwoLevel, short, sum};
use crate::stress::{Critical, Curves, PressureLine, Quantity, StressCurve};
use crate::study::effects::{self, Effects};
use crate::study::factorial::half_normal_quantile;
use crate::study::response::{self, Found, Response};
use crate::study::{CONTACT, CaseRun, ErrorRow, MethodRun, Range, ReferenceRun, Source, StudyRun};

/// The machine of a time that was taken in the run.
const HERE: &str = "this machine";

/// One row for each case and source. Errors are in p0, depths in C. The seconds of a model are the
/// median of warm repeats on one thread, those of FEM the wall-clock time of all stages.
pub fn study(run: &StudyRun) -> Vec<StudyRow> {
    let of_case = |case: &CaseRun| -> Vec<StudyRow> {
        let methods = case.methods.iter().map(|m| method_row(case, m, &run.range));
        let references = case.references.iter().map(|r| reference_row(case, r, &run.range));
        let factors: Vec<Option<Short>> =
            run.further.iter().map(|key| key.of(&case.case).map(Short)).collect();
        let with_factors = |row: StudyRow| StudyRow { factors: factors.clone(), ..row };
        methods.chain(references).map(with_factors).collect()
    };
    run.cases.iter().flat_map(of_case).collect()
}

impl StudyRow {
    /// The row of a source without a result.
    fn without_result(case: &CaseRun, source: Source, range: &Range) -> Self {
        let (factors, hertz) = (case.case.factors(), case.case.hertz());
        Self {
            case: case.case.name.clone(),
            source,
            role: RoleName::of(&case.role),
            load: factors.load,
            slenderness: factors.slenderness,
            length_ratio: factors.length_ratio,
            c_m: hertz.c_m,
            p0_pa: hertz.p0_pa,
            load_n: case.case.load.force_n,
            err: None,
            converged: None,
            iterations: None,
            load_error_rel: None,
            approach_m: None,
            p_centre_pa: None,
            p_max_pa: None,
            p_max_at_m: [None; 2],
            critical_body: None,
            critical_von_mises_pa: None,
            critical_at_m: [None; 3],
            responses: vec![None; Response::errors().count()],
            pressure_further: vec![None; 2 * range.pressure_c.len().saturating_sub(1)],
            fem_error_pressure: None,
            fem_error_stress: None,
            seconds: None,
            seconds_spread: None,
            seconds_cold: None,
            seconds_all_threads: None,
            threads: None,
            speedup: None,
            speedup_spread: None,
            stages: [None; 3],
            timed_on: None,
            unknowns: None,
            factors: Vec::new(),
        }
    }

    /// The row with the most stressed point.
    fn with_critical(self, critical: Option<Critical>) -> Self {
        let Some(critical) = critical else { return self };
        Self {
            critical_body: Some(critical.body),
            critical_von_mises_pa: Some(critical.value * self.p0_pa),
            critical_at_m: critical.at.map(|v| Some(v * self.c_m)),
            ..self
        }
    }
}

fn method_row(case: &CaseRun, m: &MethodRun, range: &Range) -> StudyRow {
    let row = StudyRow::without_result(case, m.source.clone(), range);
    let result = match &m.result {
        Ok(result) => result,
        Err(message) => return StudyRow { err: Some(message.clone()), ..row },
    };
    let (solved, errors) = (&result.solution.summary, result.summary.as_ref());
    let (one, all) = (m.timing.first(), m.timing.get(1));
    let ratio = response::speedup(case, m);
    let further = errors.map(|e| e.pressure.iter().skip(1).flatten().map(|v| Some(*v)).collect());
    StudyRow {
        converged: Some(solved.converged),
        iterations: Some(solved.iterations),
        load_error_rel: Some(solved.load_error_rel),
        approach_m: Found::Approach.of(result),
        p_centre_pa: Found::CentrePressure.of(result),
        p_max_pa: Found::LargestPressure.of(result),
        p_max_at_m: solved.p_max_at_m.map(Some),
        responses: Response::errors().map(|response| response.value(case, m)).collect(),
        pressure_further: further.unwrap_or_else(|| row.pressure_further.clone()),
        fem_error_pressure: errors.and_then(|e| e.ref_error_pressure),
        fem_error_stress: errors.and_then(|e| e.ref_error_stress),
        seconds: one.map(|t| t.median_s),
        seconds_spread: one.filter(|t| t.repeats > 1).map(|t| t.spread_s()),
        seconds_cold: one.and_then(|t| t.cold_s),
        seconds_all_threads: all.map(|t| t.median_s),
        threads: all.map(|t| t.threads),
        speedup: ratio.map(|r| r.value),
        speedup_spread: ratio.map(|r| r.plus_minus),
        stages: [solved.seconds.setup, solved.seconds.contact, solved.seconds.stress].map(Some),
        timed_on: Some(HERE.to_string()),
        ..row.with_critical(result.critical)
    }
}

fn reference_row(case: &CaseRun, r: &ReferenceRun, range: &Range) -> StudyRow {
    let row = StudyRow::without_result(case, r.engine.clone().into(), range);
    let reference = match &r.result {
        Ok(reference) => reference,
        Err(message) => return StudyRow { err: Some(message.clone()), ..row },
    };
    let p_centre = reference.curves.line("along-y").and_then(|line| line.p.first());
    // The rows of the methods have the own error of the first reference, over the same points.
    let is_first = case.references.first().is_some_and(|first| first.engine == r.engine);
    let results = case.methods.iter().filter_map(|m| m.result.as_ref().ok());
    let own = results.filter(|_| is_first).find_map(|result| result.summary.as_ref());
    let from = &reference.provenance;
    let here = from.live.then(|| HERE.to_string());
    StudyRow {
        p_centre_pa: p_centre.map(|p| p * row.p0_pa),
        fem_error_pressure: own.and_then(|e| e.ref_error_pressure),
        fem_error_stress: own.and_then(|e| e.ref_error_stress),
        seconds: from.seconds,
        seconds_spread: from.seconds_spread,
        timed_on: here.or_else(|| from.machine.clone()),
        unknowns: from.unknowns,
        ..row.with_critical(r.critical)
    }
}

/// The curves of every source of every case.
fn sources(run: &StudyRun) -> impl Iterator<Item = (&CaseRun, Source, &Curves)> {
    run.cases.iter().flat_map(|case| {
        let methods = case.methods.iter().filter_map(move |m| {
            let result = m.result.as_ref().ok()?;
            Some((case, m.source.clone(), &result.solution.curves))
        });
        let references = case.references.iter().filter_map(move |r| {
            let reference = r.result.as_ref().ok()?;
            Some((case, r.engine.clone().into(), &reference.curves))
        });
        methods.chain(references)
    })
}

/// The stresses of a source in a case (Pa).
pub fn curve_rows(case: &str, source: &Source, curves: &Curves) -> Vec<CurveRow> {
    let hertz = curves.hertz;
    let of_curve = |curve: &StressCurve| {
        let row = |(at, stress): (&[f64; 3], &StressTensor)| CurveRow {
            case: case.to_string(),
            source: source.clone(),
            body: curve.body,
            curve: curve.name.clone(),
            at_m: at.map(|v| v * hertz.c_m),
            stress_pa: Quantity::ALL.map(|quantity| quantity.of(stress) * hertz.p0_pa),
        };
        curve.at.iter().zip(&curve.stress).map(row).collect::<Vec<_>>()
    };
    curves.stress.iter().flat_map(of_curve).collect()
}

/// The contact pressure of a source in a case (Pa).
pub fn pressure_rows(case: &str, source: &Source, curves: &Curves) -> Vec<PressureRow> {
    let hertz = curves.hertz;
    let of_line = |line: &PressureLine| {
        let row = |(at, p): (&[f64; 2], &f64)| PressureRow {
            case: case.to_string(),
            source: source.clone(),
            line: line.name.clone(),
            at_m: at.map(|v| v * hertz.c_m),
            p_pa: p * hertz.p0_pa,
        };
        line.at.iter().zip(&line.p).map(row).collect::<Vec<_>>()
    };
    curves.pressure.iter().flat_map(of_line).collect()
}

/// The stresses of every source on the standard curves (Pa).
pub fn curves(run: &StudyRun) -> Vec<CurveRow> {
    let rows = |(case, source, curves): (&CaseRun, Source, &Curves)| {
        curve_rows(&case.case.name, &source, curves)
    };
    sources(run).flat_map(rows).collect()
}

/// The contact pressure of every source on the pressure lines (Pa).
pub fn pressure(run: &StudyRun) -> Vec<PressureRow> {
    let rows = |(case, source, curves): (&CaseRun, Source, &Curves)| {
        pressure_rows(&case.case.name, &source, curves)
    };
    sources(run).flat_map(rows).collect()
}

/// The own errors of the references (Pa), one row for each point that has one.
pub fn own_errors(run: &StudyRun) -> Vec<OwnErrorRow> {
    let references = run.cases.iter().flat_map(|case| {
        case.references.iter().filter_map(move |r| Some((case, r, r.result.as_ref().ok()?)))
    });
    let mut rows = Vec::new();
    for (case, run, reference) in references {
        let hertz = reference.curves.hertz;
        let row = |body: &str, curve: &str, at: [f64; 3]| OwnErrorRow {
            case: case.case.name.clone(),
            body: body.to_string(),
            curve: curve.to_string(),
            at_m: at.map(|v| v * hertz.c_m),
            pressure_pa: None,
            stress_pa: [None; Quantity::ALL.len()],
            source: run.engine.clone().into(),
        };
        for line in &reference.curves.pressure {
            rows.extend(line.at.iter().zip(line.own_error.iter().flatten()).map(|(at, e)| {
                let pressure_pa = Some(e * hertz.p0_pa);
                OwnErrorRow { pressure_pa, ..row(CONTACT, &line.name, [at[0], at[1], 0.0]) }
            }));
        }
        for curve in &reference.curves.stress {
            rows.extend(curve.at.iter().zip(curve.own_error.iter().flatten()).map(|(at, e)| {
                let stress_pa = e.map(|v| Some(v * hertz.p0_pa));
                OwnErrorRow { stress_pa, ..row(curve.body.name(), &curve.name, *at) }
            }));
        }
    }
    rows
}

/// The errors of every model in every case (p0, C).
pub fn errors(run: &StudyRun) -> Vec<ErrorRow> {
    let results = run.cases.iter().flat_map(|c| &c.methods).filter_map(|m| m.result.as_ref().ok());
    results.flat_map(|result| result.errors.iter().cloned()).collect()
}

/// The effects on every response of every model.
pub fn effects(run: &StudyRun, all: &[Effects]) -> Vec<EffectRow> {
    let fractional = run.design.as_ref().is_some_and(TwoLevel::is_fractional);
    let of_response = |e: &Effects| -> Vec<EffectRow> {
        let a = &e.analysis;
        let mut order: Vec<usize> = (0..a.effects.len()).collect();
        order.sort_by(|&i, &j| a.effects[i].value.abs().total_cmp(&a.effects[j].value.abs()));
        let rank = |i: usize| order.iter().position(|&j| j == i).expect("every effect is ranked");
        let row = |(i, effect): (usize, &crate::study::factorial::Effect)| EffectRow {
            method: e.method,
            response: e.response,
            unit: e.response.unit().to_string(),
            term: effects::term(&run.factors, &effect.factors),
            effect: effect.value,
            half_normal_quantile: half_normal_quantile(rank(i), a.effects.len()),
            pse: a.lenth.map(|l| l.pse),
            me: a.lenth.map(|l| l.me),
            sme: a.lenth.map(|l| l.sme),
            verdict: a.lenth.map(|l| l.verdict(effect.value)),
            mean: a.mean,
            centre: e.centre,
            curvature: a.curvature,
            aliases: fractional.then(|| sum(short(&effect.aliases))).into_iter().collect(),
        };
        a.effects.iter().enumerate().map(row).collect()
    };
    all.iter().flat_map(of_response).collect()
}
