//! The table of times.

use crate::report::study_files::StudyFiles;
use crate::study::{Engine, Source};
use serde_json::{Value, json};

/// Times, one row a case with a cell for each method and one for FEM.
pub(super) fn rows(files: &StudyFiles) -> Vec<Value> {
    let study = &files.study;
    let mut cases: Vec<&str> = Vec::new();
    for row in &study.rows {
        let case = study.text(row, "case");
        if !cases.contains(&case) {
            cases.push(case);
        }
    }
    let (methods, fem) = (&files.summary.methods, Source::from(Engine::fenicsx()));
    let of = |case: &str, source: &Source| {
        let found = study
            .rows
            .iter()
            .find(|r| study.text(r, "case") == case && study.text(r, "source") == source.name());
        found.map_or(Value::Null, |r| {
            json!({
                "source": source,
                "seconds": study.json(r, "seconds"),
                "spread": study.json(r, "seconds_spread"),
                "cold": study.json(r, "seconds_cold"),
                "all_threads": study.json(r, "seconds_all_threads"),
                "threads": study.text(r, "threads"),
                "unknowns": study.text(r, "unknowns"),
                "ratio": study.json(r, "speedup"),
                "ratio_spread": study.json(r, "speedup_spread"),
                "timed_on": study.text(r, "timed_on"),
            })
        })
    };
    cases
        .into_iter()
        .map(|case| {
            let methods: Vec<Value> = methods.iter().map(|m| of(case, &Source::from(*m))).collect();
            json!({ "case": case, "methods": methods, "fem": of(case, &fem) })
        })
        .collect()
}
