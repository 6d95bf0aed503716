//! All gates on a run.

use super::accepted::{Baseline, Change};
use super::number::numbers;
use super::outcome::{GateOutcome, Kind};
use super::thresholds::{Gate, Gates};
use crate::body::EdgeModel;
use crate::study::run::{Role, StudyRun};
use std::collections::BTreeMap;

/// Evaluates all gates on a run. `baseline` are the accepted numbers for the drift gates, one for
/// each method; without them (and with a `[drift]` in the file) the drift gates fail.
pub fn evaluate(run: &StudyRun, gates: &Gates, baseline: Option<&Baseline>) -> Vec<GateOutcome> {
    let all = numbers(run);
    let failed = |method: EdgeModel| -> Vec<String> {
        run.cases
            .iter()
            .filter(|c| c.methods.iter().any(|m| m.source == method.into() && m.result.is_err()))
            .map(|c| c.case.name.clone())
            .collect()
    };
    let own = gates.gate.iter().filter(|gate| run.methods.contains(&gate.method));
    let (speed, accuracy): (Vec<&Gate>, Vec<&Gate>) = own.partition(|gate| gate.is_speedup());
    let outcome = |gate: &&Gate| gate.evaluate(&all, &failed(gate.method));
    let mut outcomes = vec![coverage(run)];
    outcomes.extend(accuracy.iter().map(outcome));
    // The speed of a wrong solution is worth nothing: a speed-up counts only if every accuracy gate
    // of its method holds.
    let inaccurate: Vec<String> =
        outcomes.iter().filter(|o| !o.passed).map(|o| o.method.clone()).collect();
    let speed =
        speed.iter().map(outcome).map(|outcome| match inaccurate.contains(&outcome.method) {
            true => GateOutcome {
                passed: false,
                note: "not counted: an accuracy gate of this method failed".to_string(),
                ..outcome
            },
            false => outcome,
        });
    outcomes.extend(speed);
    if let Some(drift) = &gates.drift {
        let live = run.cases.iter().any(|c| c.reference().is_some_and(|r| r.provenance.live));
        let limit = if live { drift.live } else { drift.recorded };
        let now = Baseline::of(run);
        let accepted = gates.methods();
        let methods = run.methods.iter().filter(|&method| accepted.contains(method));
        outcomes.extend(methods.map(|&method| {
            let of_model = |all: &Baseline| all.of_model(&run.study, method);
            drift_gate(method, limit, &of_model(&now), baseline.map(of_model))
        }));
    }
    if outcomes.len() == 1 {
        let note = "no gate of the thresholds file applies to this run";
        outcomes.push(GateOutcome::nothing("any gate", None, Kind::Coverage, note));
    }
    for outcome in &mut outcomes {
        outcome.study.clone_from(&run.study);
    }
    outcomes
}

/// Every corner and the centre of the study must have a reference to be compared with; in a study
/// without a design every case.
fn coverage(run: &StudyRun) -> GateOutcome {
    let designed = run.cases.iter().any(|c| c.role != Role::Extra);
    let design: Vec<_> = run.cases.iter().filter(|c| !designed || c.role != Role::Extra).collect();
    let missing: Vec<&str> =
        design.iter().filter(|c| c.reference().is_none()).map(|c| c.case.name.as_str()).collect();
    let compared = run.cases.iter().filter(|c| c.reference().is_some()).count();
    GateOutcome {
        study: String::new(),
        name: "every case of the design has a FEM answer".to_string(),
        method: "all".to_string(),
        kind: Kind::Coverage,
        passed: missing.is_empty() && compared > 0,
        value: Some((design.len() - missing.len()) as f64),
        limit: design.len() as f64,
        margin: Some(-(missing.len() as f64)),
        compared,
        note: if missing.is_empty() {
            format!("{compared} cases compared")
        } else {
            format!("no FEM answer for {}", missing.join(", "))
        },
    }
}

/// The drift of one model's numbers in one study, `now` against those of the `baseline`.
fn drift_gate(
    method: EdgeModel,
    limit: f64,
    now: &Baseline,
    baseline: Option<Baseline>,
) -> GateOutcome {
    let accepted = baseline.unwrap_or_default();
    let compared: usize = now.numbers.values().map(BTreeMap::len).sum();
    // Changes beyond the limit, and the largest change.
    let beyond = accepted.changes(now, limit);
    let largest = accepted.changes(now, -1.0).iter().filter_map(Change::size).fold(0.0, f64::max);
    let has_others = !accepted.distances_c().is_superset(&now.distances_c());
    let comparable = compared > 0 && !accepted.numbers.is_empty() && !has_others;
    let note = if compared == 0 {
        "nothing was compared".to_string()
    } else if accepted.numbers.is_empty() {
        "there are no accepted numbers of this study and model: accept them with `edgeline gate --accept`"
            .to_string()
    } else if has_others {
        let list = |all: &Baseline| Vec::from_iter(all.distances_c()).join(" and ");
        format!(
            "accepted numbers are those outside {} C, and this run has those outside {} C: leave out \
             --exclude and --exclude-pressure, or accept its own with `edgeline gate --accept`",
            list(&accepted),
            list(now)
        )
    } else {
        match beyond.first() {
            None => "nothing moved".to_string(),
            Some(first) => {
                let more = beyond.len() - 1;
                let rest = if more > 0 { format!(" (and {more} more)") } else { String::new() };
                format!("{}{rest}", first.describe())
            }
        }
    };
    GateOutcome {
        study: String::new(),
        name: "drift from the accepted numbers".to_string(),
        method: method.name().to_string(),
        kind: Kind::Drift,
        passed: compared > 0 && beyond.is_empty(),
        value: comparable.then_some(largest),
        limit,
        margin: comparable.then_some(limit - largest),
        compared,
        note,
    }
}
