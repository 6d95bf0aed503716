//! The verdict of a study in words, from its summary.

use super::brought::FileSummary;
use super::fraction::fraction;
use super::study_summary::{
    CaseSummary, FemError, FemOrigin, PublishedSummary, Span, StudySummary,
};
use crate::base::number::{duration, ratio_with_spread, rounded};
use crate::body::EdgeModel;
use crate::study::Source;
use crate::study::bench::{Against, Speedup};
use crate::study::gate::GateOutcome;
use crate::study::timing::Ratio;

/// Sentences for the head of a report, the most important first.
pub fn sentences(summary: &StudySummary) -> Vec<String> {
    let mut all = vec![gates(&summary.gates)];
    all.extend(accuracy(summary));
    all.extend(fem_error(&summary.fem_error));
    all.extend(time(summary));
    all.extend(equal_error(&summary.speedups));
    if let Some(own) = &summary.published {
        all.push(published(own));
        // Without a time of its own here, nothing says what the ratios on record are about.
        all.extend(own.seconds.and_then(|_| published_time(&summary.published_speedups)));
    }
    all.extend(summary.cases.iter().flat_map(brought));
    all
}

/// How far quarter-space and the codes are off the curves from files.
fn brought(case: &CaseSummary) -> Vec<String> {
    let shown = |source: &Source| source.is_engine() || *source == EdgeModel::QuarterSpace.into();
    let of_file = |file: &FileSummary| {
        let sources = file.errors.iter().map(|e| &e.source).filter(|source| shown(source));
        let parts =
            sources.filter_map(|s| Some(format!("{} in {}", s.title(), file.differences(s)?)));
        let parts: Vec<String> = parts.collect();
        let said =
            if parts.is_empty() { "nothing was compared".to_string() } else { parts.join("; ") };
        format!("Largest differences from {} in {}: {said}.", file.name, case.name)
    };
    case.brought.iter().map(of_file).collect()
}

/// The deviations of the models from FEM.
fn accuracy(summary: &StudySummary) -> Vec<String> {
    // The last method is the most complete one. For the others the largest error is given.
    let Some((best, others)) = summary.method_summary.split_last() else { return Vec::new() };
    let name = best.method;
    let first = match (best.pressure_rms, best.stress_rms, best.stress_max) {
        (Some(p), Some(s), Some(max)) => format!(
            "{name} is off FEM by {} p0 RMS in pressure, {} p0 RMS in the stresses and {} p0 at \
             most, in the worst of {} cases, at least {} C from the contact's edges.",
            fraction(p),
            fraction(s),
            fraction(max),
            best.compared,
            summary.range.stress_c,
        ),
        _ => format!("{name} could not be compared with FEM in any case."),
    };
    let missed = others.iter().filter_map(|m| {
        let (p, s) = (fraction(m.pressure_max?), fraction(m.stress_max?));
        Some(format!("{} by up to {p} p0 in pressure and {s} p0 in a stress", m.method))
    });
    let missed: Vec<String> = missed.collect();
    let others = format!("The simpler models miss: {}.", missed.join("; "));
    std::iter::once(first).chain((!missed.is_empty()).then_some(others)).collect()
}

fn gates(gates: &[GateOutcome]) -> String {
    let failed = gates.iter().filter(|g| !g.passed);
    let failed: Vec<String> = failed.map(|g| format!("{} ({})", g.name, g.method)).collect();
    match (gates.len(), failed.len()) {
        (0, _) => {
            "No accuracy gate was evaluated: the built-in ones belong to the built-in studies, and \
                   edgeline gate takes others."
                .to_string()
        }
        (n, 0) => format!("All {n} accuracy gates hold."),
        (n, k) => format!("{k} of {n} accuracy gates fail: {}.", failed.join("; ")),
    }
}

/// The largest own error of FEM.
fn fem_error(own: &FemError) -> Option<String> {
    Some(format!(
        "FEM itself changes by up to {} p0 in pressure and {} p0 in a stress from its second finest \
         mesh to the finest, over the same range.",
        fraction(own.pressure?),
        fraction(own.stress?)
    ))
}

fn time(summary: &StudySummary) -> Option<String> {
    let best = summary.method_summary.last()?;
    let mut text = format!(
        "{} takes {} a case on one thread of this machine",
        best.method,
        duration(best.seconds?)
    );
    let times = || summary.cases.iter().filter_map(|c| c.provenance()?.seconds);
    if let (Some(slow), Some(fast)) = (times().reduce(f64::max), times().reduce(f64::min)) {
        let live = summary.fem == FemOrigin::Live;
        let whose = if live { "in this run" } else { "on the machine of the record" };
        let (fast, slow) = (duration(fast), duration(slow));
        let span = if fast == slow { fast } else { format!("{fast} to {slow}") };
        text.push_str(&format!("; FEM's finest meshes took {span} {whose}"));
        match best.speedup {
            Some(Span { low, high }) if live => text.push_str(&format!(
                ", {} to {} times as long in one run on one machine",
                rounded(low),
                rounded(high)
            )),
            _ if !live => text.push_str(", which is not divided by a time of this one"),
            _ => {}
        }
    }
    text.push('.');
    Some(text)
}

/// The recorded ratios at the smallest error that a recorded FEM mesh reached.
fn equal_error(speedups: &[Speedup]) -> Option<String> {
    let own = || speedups.iter().filter(|s| s.against == Against::Limit);
    let level = own().map(|s| s.level).reduce(f64::min)?;
    let here: Vec<&Speedup> = own().filter(|s| s.level == level).collect();
    let ratios = || here.iter().map(|s| s.ratio);
    let low = ratios().min_by(|a, b| a.value.total_cmp(&b.value))?;
    let high = ratios().max_by(|a, b| a.value.total_cmp(&b.value))?;
    let cases = if here.len() == 1 { "case" } else { "cases" };
    let codes =
        if here.iter().all(|s| s.engine.is_fenicsx()) { "FEM" } else { "the faster FEM code" };
    let in_words = |ratio: &Ratio| ratio_with_spread(ratio.value, ratio.plus_minus);
    let span = match here.len() {
        1 => in_words(&low),
        _ => format!("{} to {}", in_words(&low), in_words(&high)),
    };
    Some(format!(
        "Timed in one run on one machine and each right to {level} p0 of its own limit, {codes} took {span} \
         times as long as quarter-space ({} {cases}).",
        here.len()
    ))
}

/// How far the published method is off FEM.
fn published(own: &PublishedSummary) -> String {
    format!(
        "The published method on uniform cells (guilbault-cells) is off FEM by {} to {} p0 RMS in pressure and {} to {} p0 RMS in the \
         stresses, by up to {} and {} p0, in {} cases.",
        fraction(own.pressure_rms.low),
        fraction(own.pressure_rms.high),
        fraction(own.stress_rms.low),
        fraction(own.stress_rms.high),
        fraction(own.pressure_max.high),
        fraction(own.stress_max.high),
        own.cases
    )
}

/// The sentence of the source's abstract, with the record's numbers.
fn published_time(speedups: &[Speedup]) -> Option<String> {
    let low = speedups.iter().min_by(|a, b| a.ratio.value.total_cmp(&b.ratio.value))?;
    let high = speedups.iter().max_by(|a, b| a.ratio.value.total_cmp(&b.ratio.value))?;
    let errors = || speedups.iter().map(|s| s.model_error);
    Some(format!(
        "Timed in one run on one machine, the published method on uniform cells is {} to {} times faster \
         than FEM at the error that it reaches, {} to {} p0 RMS in the worst curve, and no grid takes it lower; its source claims more than 125 times.",
        ratio_with_spread(low.ratio.value, low.ratio.plus_minus),
        ratio_with_spread(high.ratio.value, high.ratio.plus_minus),
        fraction(errors().fold(f64::INFINITY, f64::min)),
        fraction(errors().fold(0.0, f64::max)),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Engine;
    use crate::study::gate::Kind;

    #[test]
    fn failed_gates_are_named() {
        let good = GateOutcome {
            study: "factorial".to_string(),
            name: "stress".to_string(),
            method: "mirror".to_string(),
            kind: Kind::Limit,
            passed: true,
            value: None,
            limit: 0.1,
            margin: None,
            compared: 0,
            note: String::new(),
        };
        let bad = GateOutcome { name: "pressure".to_string(), passed: false, ..good.clone() };
        assert_eq!(gates(&[bad, good]), "1 of 2 accuracy gates fail: pressure (mirror).");
    }

    #[test]
    fn ratios_of_the_record_are_those_at_the_smallest_error() {
        let one = |level: f64, against: Against, value: f64| Speedup {
            case: "a".to_string(),
            level,
            against,
            engine: Engine::fenicsx(),
            size: 1.0,
            unknowns: None,
            fem_error: level,
            fem_seconds: (value, 0.02 * value),
            tolerance: level,
            model_error: level,
            model_seconds: (1.0, 0.0),
            ratio: Ratio { value, plus_minus: 0.02 * value },
        };
        let speedups = [
            one(0.02, Against::Limit, 9e4),
            one(0.005, Against::Limit, 2100.0),
            one(0.005, Against::Fem, 1.0),
            one(0.005, Against::Limit, 8000.0),
        ];
        let text = equal_error(&speedups).unwrap();
        assert!(text.contains("right to 0.005 p0"), "{text}");
        assert!(text.contains("2,100 ± 42 to 8,000 ± 160 times as long"), "{text}");
        assert!(text.ends_with("(2 cases)."), "{text}");
        let text = equal_error(&speedups[..2]).unwrap();
        assert!(text.contains("took 2,100 ± 42 times as long") && text.ends_with("(1 case)."));
        assert!(equal_error(&[]).is_none());
    }
}
