//! The tables of errors.

use crate::report::study_files::StudyFiles;
use serde_json::{Map, Value, json};

/// For each method a table of its errors, one row a case.
pub(super) fn tables(files: &StudyFiles) -> Vec<Value> {
    let study = &files.study;
    let far = study.header.iter().find(|h| h.starts_with("pressure_max_")).cloned();
    files
        .summary
        .methods
        .iter()
        .map(|method| {
            let rows: Vec<Value> = study
                .rows
                .iter()
                .filter(|r| study.text(r, "source") == method.name())
                .map(|r| {
                    let mut row = Map::new();
                    row.insert("case".to_string(), json!(study.text(r, "case")));
                    row.insert("err".to_string(), json!(study.text(r, "err")));
                    for name in [
                        "pressure_rms",
                        "pressure_max",
                        "stress_rms",
                        "stress_max",
                        "von_mises_rms",
                        "von_mises_max",
                        "critical_value",
                        "critical_depth",
                        "fem_error_pressure",
                        "fem_error_stress",
                    ] {
                        row.insert(name.to_string(), study.json(r, name));
                    }
                    let far = far.as_ref().map_or(Value::Null, |name| study.json(r, name));
                    row.insert("pressure_far".to_string(), far);
                    Value::Object(row)
                })
                .collect();
            json!({ "method": method, "rows": rows })
        })
        .collect()
}
