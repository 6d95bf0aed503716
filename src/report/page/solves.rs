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
        same.iter().map(|n| json!({ "name": words(n), "value": value(first, n) })).collect();
    let table: Vec<Value> = rows
        .iter()
        .map(|(case, method, numbers)| {
            let values: Vec<String> = other.iter().map(|n| value(numbers, n)).collect();
            json!({ "case": case, "method": method, "values": values })
        })
        .collect();
    let names: Vec<String> = other.iter().map(|n| words(n)).collect();
    Some(json!({ "same": same, "names": names, "rows": table }))
}

/// What the numbers of every solution are, by their names in the file.
const WORDS: [(&str, &str); 20] = [
    ("tolerance", "tolerance (p0)"),
    ("resolution order", "nodes per panel"),
    ("resolution corner", "panel at a corner (C)"),
    ("resolution corner_ratio", "growth of panels at a corner"),
    ("resolution ratio", "growth of panels"),
    ("resolution modes", "modes across the contact"),
    ("resolution k_max", "largest wavenumber (1/C)"),
    ("resolution k_order", "nodes per panel of wavenumbers"),
    ("resolution k_across", "distance across that wavenumbers resolve (C)"),
    ("resolution k_ratio", "growth of panels of wavenumbers"),
    ("resolution k_min", "first panel of wavenumbers (1/C)"),
    ("resolution images", "images"),
    ("resolution face_reach", "length of end faces (decay lengths)"),
    ("resolution reach", "reach of loads (decay lengths)"),
    ("contact_nodes", "nodes along the line"),
    ("edge_residual", "residual at the contact's edge (p0)"),
    ("condition", "condition number"),
    ("bodies_shared", "one computation for both bodies"),
    ("approach_reference_m", "depth of the approach's points (m)"),
    ("roller_diametral_tension_pa", "diametral tension of the roller (Pa)"),
];

/// The number called `name` in words; those that only some solutions have keep their names.
fn words(name: &str) -> String {
    match (WORDS.iter().find(|(own, _)| *own == name), name.strip_suffix("_c")) {
        (Some((_, words)), _) => words.to_string(),
        (None, Some(length)) => format!("{} (C)", length.replace('_', " ")),
        (None, None) => name.replace('_', " "),
    }
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
                flatten(&name, v, all);
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
