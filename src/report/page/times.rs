//! The table of times.

use crate::report::study_files::StudyFiles;
use crate::study::Source;
use serde_json::{Value, json};

/// Times: the names of the models and of the references, and one row a case with a cell for each of
/// them, in the same order.
pub(super) fn table(files: &StudyFiles) -> Value {
    let (engines, models): (Vec<&Source>, Vec<&Source>) =
        files.sources().into_iter().partition(|source| source.is_engine());
    let titles = |sources: &[&Source]| -> Vec<String> {
        sources.iter().map(|source| source.title().to_string()).collect()
    };
    let cells = |case: &str, sources: &[&Source]| -> Vec<Value> {
        sources.iter().map(|source| cell(files, case, source)).collect()
    };
    // Live FEM is divided by the time of the most complete model.
    let best = files.summary.methods.last().map(|&method| Source::from(method));
    let row = |case: &str| {
        json!({
            "case": case,
            "methods": cells(case, &models),
            "references": cells(case, &engines),
            "best": best.as_ref().map(|best| cell(files, case, best)),
        })
    };
    let rows = files.summary.cases.iter().map(|case| row(&case.name));
    json!({
        "methods": titles(&models),
        "engines": titles(&engines),
        "rows": rows.collect::<Vec<_>>(),
    })
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
