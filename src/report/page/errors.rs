//! The tables of errors.

use crate::report::study_files::StudyFiles;
use crate::report::study_rows::StudyRow;
use crate::study::response::Response;
use crate::study::{Engine, Source};
use serde_json::{Map, Value, json};

/// For each method a table of its errors, one row a case.
pub(super) fn tables(files: &StudyFiles) -> Vec<Value> {
    let table = |source: Source| {
        let own = files.study.iter().filter(|row| row.source == source);
        json!({ "method": source.name(), "rows": own.map(row).collect::<Vec<_>>() })
    };
    let models = files.summary.methods.iter().copied().map(Source::from);
    let published = files.summary.published.iter().map(|_| Engine::published().into());
    models.chain(published).map(table).collect()
}

/// The errors of a model in a case: all responses by their names, and those of the reference
/// itself.
fn row(row: &StudyRow) -> Value {
    let errors: Map<String, Value> =
        Response::errors().map(|r| (r.name(), json!(row.response(r)))).collect();
    json!({
        "case": row.case,
        "err": row.err,
        "errors": errors,
        // The largest error outside the second range.
        "pressure_far": row.pressure_further.first().copied().flatten(),
        "fem_error_pressure": row.fem_error_pressure,
        "fem_error_stress": row.fem_error_stress,
    })
}
