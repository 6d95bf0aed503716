//! The table of times.

use crate::report::study_files::StudyFiles;
use crate::study::Source;
use serde_json::{Value, json};

/// Times, one row a case with a cell for each model and each reference.
pub(super) fn rows(files: &StudyFiles) -> Vec<Value> {
    let (engines, models): (Vec<&Source>, Vec<&Source>) =
        files.sources().into_iter().partition(|source| source.is_engine());
    let cells = |case: &str, sources: &[&Source]| -> Vec<Value> {
        sources.iter().map(|source| cell(files, case, source)).collect()
    };
    let cases = files.summary.cases.iter().map(|case| case.name.as_str());
    let row = |case| {
        let (methods, references) = (cells(case, &models), cells(case, &engines));
        json!({ "case": case, "methods": methods, "references": references })
    };
    cases.map(row).collect()
}

/// The times of a source in a case.
fn cell(files: &StudyFiles, case: &str, source: &Source) -> Value {
    let Some(row) = files.row(case, source) else { return Value::Null };
    json!({
        "source": source,
        "seconds": row.seconds,
        "spread": row.seconds_spread,
        "cold": row.seconds_cold,
        "all_threads": row.seconds_all_threads,
        "threads": row.threads,
        "unknowns": row.unknowns,
        "ratio": row.speedup,
        "ratio_spread": row.speedup_spread,
        "timed_on": row.timed_on,
    })
}
