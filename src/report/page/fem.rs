//! The page's data on FEM: times together with the models', and versions.

use crate::report::study_files::StudyFiles;
use crate::study::Timed;
use crate::study::bench::{Against, Speedup};
use serde_json::{Value, json};

/// Recorded times of FEM and models from one run, if the FEM curves of this run are recorded.
pub(super) fn timed(files: &StudyFiles) -> Option<Value> {
    let mut head: Option<&Timed> = None;
    let mut rows = Vec::new();
    for case in &files.summary.cases {
        let Some(timed) = case.provenance().and_then(|p| p.timed.as_ref()) else { continue };
        head.get_or_insert(timed);
        let methods = files.summary.methods.iter().map(|&method| {
            let row = files.row(&case.name, &method.into());
            let time = timed.methods.get(method.name());
            json!({
                "seconds": time.map(|t| t.0),
                "spread": time.map(|t| t.1),
                "ratio": row.map(|row| row.speedup),
                "ratio_spread": row.map(|row| row.speedup_spread),
            })
        });
        let methods: Vec<Value> = methods.collect();
        rows.push(json!({
            "case": case.name,
            "size": timed.size,
            "unknowns": timed.unknowns,
            "error": timed.error,
            "fem": { "seconds": timed.seconds.0, "spread": timed.seconds.1 },
            "methods": methods,
        }));
    }
    let head = head?;
    Some(json!({
        "date": head.date,
        "machine": head.machine,
        "command": head.command,
        "tolerance": head.tolerance,
        "rows": rows,
    }))
}

/// The recorded ratios at equal error: one row for each case, one entry for each level.
pub(super) fn equal_error(files: &StudyFiles) -> Option<Value> {
    let all = &files.summary.speedups;
    let mut levels: Vec<f64> = all.iter().map(|s| s.level).collect();
    levels.sort_by(|a, b| b.total_cmp(a));
    levels.dedup();
    let rows: Vec<Value> = files
        .summary
        .cases
        .iter()
        .filter_map(|case| {
            let is_own = |s: &&Speedup| s.against == Against::Limit && s.case == case.name;
            let own: Vec<&Speedup> = all.iter().filter(is_own).collect();
            let at = levels.iter().map(|level| own.iter().find(|s| s.level == *level));
            let at: Vec<_> = at.collect();
            (!own.is_empty()).then(|| json!({ "case": case.name, "at": at }))
        })
        .collect();
    (!rows.is_empty()).then(|| json!({ "levels": levels, "rows": rows }))
}

/// The versions of the FEM programs, with their cases.
pub(super) fn versions(files: &StudyFiles) -> Vec<Value> {
    let mut all: Vec<(String, Vec<&str>)> = Vec::new();
    for case in &files.summary.cases {
        let Some(provenance) = case.provenance() else { continue };
        let text: Vec<String> =
            provenance.versions.iter().map(|(name, v)| format!("{name} {v}")).collect();
        let text = text.join(", ");
        match all.iter_mut().find(|(t, _)| *t == text) {
            Some((_, cases)) => cases.push(&case.name),
            None => all.push((text, vec![&case.name])),
        }
    }
    let known = all.into_iter().filter(|(text, _)| !text.is_empty());
    known.map(|(text, cases)| json!({ "text": text, "cases": cases.join(", ") })).collect()
}
