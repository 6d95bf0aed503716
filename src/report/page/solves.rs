//! The details of the solver, and the work of each solve.

use crate::base::number::significant;
use crate::body::EdgeModel;
use crate::report::study_files::StudyFiles;
use crate::solve::{Details, WorkSummary};
use serde_json::{Map, Value, json};

/// Names and texts of some values.
type Named = Vec<(String, String)>;

/// One row of the details: the case, the model and its numbers.
type Row<'a> = (&'a str, EdgeModel, Named);

/// The details of the solutions without their work: the numbers that all solutions share, and the
/// others with one row for each case and method.
pub(super) fn details(files: &StudyFiles) -> Option<Value> {
    let of_case = files.summary.cases.iter().flat_map(|case| {
        case.details().map(|(method, details)| (case.name.as_str(), method, named(details)))
    });
    let rows: Vec<Row> = of_case.collect();
    let mut names: Vec<&String> = Vec::new();
    for (name, _) in rows.iter().flat_map(|(_, _, numbers)| numbers) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let value = |numbers: &Named, name: &str| -> String {
        let found = numbers.iter().find(|(k, _)| k == name);
        found.map(|(_, v)| v.clone()).unwrap_or_default()
    };
    let first = &rows.first()?.2;
    let (same, other): (Vec<&String>, Vec<&String>) = names.into_iter().partition(|name| {
        rows.iter().all(|(_, _, numbers)| value(numbers, name) == value(first, name))
    });
    let same: Vec<Value> =
        same.iter().map(|n| json!({ "name": n, "value": value(first, n) })).collect();
    let table: Vec<Value> = rows
        .iter()
        .map(|(case, method, numbers)| {
            let values: Vec<String> = other.iter().map(|n| value(numbers, n)).collect();
            json!({ "case": case, "method": method, "values": values })
        })
        .collect();
    Some(json!({ "same": same, "names": other, "rows": table }))
}

/// The numbers of `details` without its work, by their names in the file.
fn named(details: &Details) -> Named {
    let details = Details { work: None, ..details.clone() };
    let mut all = Vec::new();
    flatten("", &json!(details), &mut all);
    all
}

fn flatten(prefix: &str, value: &Value, all: &mut Named) {
    match value {
        Value::Object(map) => {
            for (key, v) in map {
                let name = if prefix.is_empty() { key.clone() } else { format!("{prefix} {key}") };
                flatten(&name.replace('_', " "), v, all);
            }
        }
        Value::Number(n) => {
            let text = n.as_u64().map_or_else(
                || n.as_f64().map_or_else(String::new, |v| significant(v, 5)),
                |whole| whole.to_string(),
            );
            all.push((prefix.to_string(), text));
        }
        Value::String(s) => all.push((prefix.to_string(), s.clone())),
        Value::Bool(b) => all.push((prefix.to_string(), b.to_string())),
        // A cell has no room for a list; the file has it.
        Value::Array(_) | Value::Null => {}
    }
}

/// The work of a model on a problem, and the cases of this problem.
struct Worked<'a> {
    method: EdgeModel,
    lengths: [f64; 2],
    work: &'a WorkSummary,
    cases: Vec<&'a str>,
}

/// The evaluations done, and those avoided by reason. Cases of one problem share a row.
pub(super) fn work(files: &StudyFiles) -> Option<Value> {
    let mut all: Vec<Worked> = Vec::new();
    for case in &files.summary.cases {
        let lengths = [case.slenderness, case.length_ratio];
        for (method, details) in case.details() {
            let Some(work) = &details.work else { continue };
            let same = |w: &&mut Worked| (w.method, w.lengths, w.work) == (method, lengths, work);
            match all.iter_mut().find(same) {
                Some(worked) => worked.cases.push(&case.name),
                None => all.push(Worked { method, lengths, work, cases: vec![&case.name] }),
            }
        }
    }
    let reasons: Vec<String> = by_reason(all.first()?.work).keys().cloned().collect();
    let rows = all.iter().map(|worked| {
        let by_reason: Vec<u64> =
            by_reason(worked.work).values().filter_map(Value::as_u64).collect();
        let (done, avoided) = (worked.work.done, by_reason.iter().sum::<u64>());
        let all = (done + avoided).max(1) as f64;
        json!({
            "method": worked.method,
            "cases": worked.cases.join(", "),
            "done": done,
            "avoided": avoided,
            "share": (100.0 * avoided as f64 / all).round() as u64,
            "by_reason": by_reason,
        })
    });
    Some(json!({ "reasons": reasons, "rows": rows.collect::<Vec<_>>() }))
}

/// The evaluations avoided, by their names in the file.
fn by_reason(work: &WorkSummary) -> Map<String, Value> {
    match json!(work.avoided) {
        Value::Object(map) => map,
        _ => Map::new(),
    }
}
