//! `report.html` and `report.md`, from the files of a run.

use super::plots;
use super::study_files::StudyFiles;
use super::table::Table;
use crate::base::number::{
    duration, duration_with_spread, fixed, rounded, significant, with_minus_signs,
};
use crate::base::{Error, Result};
use crate::host::{prepare_folder, write_set};
use minijinja::{Environment, context};
use serde_json::{Map, Value, json};
use std::path::Path;

const PAGE: &str = include_str!("page/page.html");
const MARKDOWN: &str = include_str!("page/report.md");
const STYLE: &str = include_str!("page/page.css");
const SCRIPT: &str = include_str!("page/page.js");

/// What holds for every study, however it comes out.
const CAVEATS: [&str; 5] = [
    "W, S_l and L_r are defined here as W = w / (E* R L1), S_l = L1 / (2 C) and L_r = L1 / L2; the \
     paper names the factors, its formulas and levels are not in the text that we have.",
    "The stress correction of guilbault is a reconstruction: the formula of its transition factor \
     is not in the text that we have.",
    "For L_r < 1 the pressure grows without bound towards the roller's edge. Peaks there are those \
     of a mesh, so the surroundings of the edge are left out and the rest of the curves compared.",
    "The models take both bodies for half-spaces with end faces and the gap for a parabola. A real \
     roller also carries a nearly uniform tension across its diameter of the order of p0 C / (2 R).",
    "FEM's own error is the difference of its two finest meshes: an estimate, not a bound.",
];

/// Writes all files of a run into `folder`: its tables, the plots and the page that are made of them,
/// and `summary.json`, which says that the run is complete, last.
///
/// # Errors
/// As [`write()`].
pub fn write_run(files: &StudyFiles, folder: &Path) -> Result<()> {
    let made = made(files)?.into_iter();
    write_with_plots(folder, made.chain(files.contents()).collect())
}

/// Writes `report.html`, `report.md` and `plots/*.svg` into `folder`.
///
/// # Errors
/// [`Error::Io`] when a file cannot be written, [`Error::File`] when the run's files lack what the
/// page shows.
pub fn write(files: &StudyFiles, folder: &Path) -> Result<()> {
    write_with_plots(folder, made(files)?)
}

fn write_with_plots(folder: &Path, contents: Vec<(String, Vec<u8>)>) -> Result<()> {
    prepare_folder(&folder.join("plots"))?;
    write_set(folder, &contents)
}

/// What is made of a run's own files, by name: plots, Markdown and the page.
fn made(files: &StudyFiles) -> Result<Vec<(String, Vec<u8>)>> {
    let plots = plots::all(files).into_iter();
    let mut made: Vec<(String, Vec<u8>)> =
        plots.map(|(name, svg)| (format!("plots/{name}"), svg.into_bytes())).collect();
    made.push(("report.md".to_string(), markdown(files)?.into_bytes()));
    made.push(("report.html".to_string(), html(files)?.into_bytes()));
    Ok(made)
}

/// The page.
///
/// # Errors
/// [`Error::File`] when the run's files lack what the page shows.
pub fn html(files: &StudyFiles) -> Result<String> {
    // "<" inside the data would let a name end the script element.
    let data = explorer_data(files).to_string().replace('<', "\\u003c");
    let time_plot = plots::named(files, "time-error").unwrap_or_default();
    render("page.html", PAGE, files, context! { data, time_plot, css => STYLE, js => SCRIPT })
}

/// The same tables as Markdown.
///
/// # Errors
/// As [`html`].
pub fn markdown(files: &StudyFiles) -> Result<String> {
    render("report.md", MARKDOWN, files, context! {})
}

fn render(
    name: &str,
    template: &str,
    files: &StudyFiles,
    more: minijinja::Value,
) -> Result<String> {
    let mut environment = Environment::new();
    let dash = || "–".to_string();
    environment.add_filter("p0", move |v: minijinja::Value| {
        as_number(&v).map_or_else(dash, |v| with_minus_signs(&fixed(v, 4)))
    });
    environment
        .add_filter("ratio", move |v: minijinja::Value| as_number(&v).map_or_else(dash, rounded));
    environment.add_filter("typeset", |text: String| typeset(&text));
    environment.add_filter("seconds", move |v: minijinja::Value| {
        as_number(&v).map_or_else(dash, duration)
    });
    environment.add_filter("with_spread", move |v: minijinja::Value, spread: minijinja::Value| {
        match (as_number(&v), as_number(&spread)) {
            (Some(v), Some(spread)) => duration_with_spread(v, spread),
            (Some(v), None) => duration(v),
            (None, _) => dash(),
        }
    });
    environment.add_filter("short", move |v: minijinja::Value| {
        as_number(&v).map_or_else(dash, |v| with_minus_signs(&significant(v, 5)))
    });
    let fault = |e: minijinja::Error| Error::File {
        path: name.into(),
        line: None,
        message: format!("{e:#}"),
        remedy: "run the study again with this version".to_string(),
    };
    environment.add_template(name, template).map_err(fault)?;
    let base = context! {
        s => files.summary,
        caveats => CAVEATS,
        error_tables => error_tables(files),
        times => times(files),
        any_ratio => files.study.rows.iter().any(|r| !files.study.text(r, "log10_speedup").is_empty()),
        effects => effects(files),
        details => details(files),
        work => work(files),
        timed => timed(files),
        equal_error => equal_error(files),
        fem_versions => fem_versions(files),
    };
    environment
        .get_template(name)
        .and_then(|t| t.render(context! { ..more, ..base }))
        .map_err(fault)
}

/// Minus signs instead of hyphens before digits, which also keeps lines from breaking there.
fn typeset(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut before = ' ';
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        let number = rest.peek().is_some_and(char::is_ascii_digit);
        out.push(if c == '-' && number && " (e".contains(before) { '−' } else { c });
        before = c;
    }
    out
}

fn as_number(value: &minijinja::Value) -> Option<f64> {
    f64::try_from(value.clone()).ok().filter(|v| v.is_finite())
}

/// A cell as a JSON number, or null.
fn cell(table: &Table, row: &[String], name: &str) -> Value {
    table.number(row, name).map_or(Value::Null, |v| json!(v))
}

fn methods(files: &StudyFiles) -> Vec<&str> {
    files.summary["methods"].as_array().into_iter().flatten().filter_map(Value::as_str).collect()
}

/// For each method a table of its errors, one row a case.
fn error_tables(files: &StudyFiles) -> Vec<Value> {
    let study = &files.study;
    let far = study.header.iter().find(|h| h.starts_with("pressure_max_")).cloned();
    methods(files)
        .into_iter()
        .map(|method| {
            let rows: Vec<Value> = study
                .rows
                .iter()
                .filter(|r| study.text(r, "source") == method)
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
                        row.insert(name.to_string(), cell(study, r, name));
                    }
                    let far = far.as_ref().map_or(Value::Null, |name| cell(study, r, name));
                    row.insert("pressure_far".to_string(), far);
                    Value::Object(row)
                })
                .collect();
            json!({ "method": method, "rows": rows })
        })
        .collect()
}

/// Times, one row a case with a cell for each method and one for FEM.
fn times(files: &StudyFiles) -> Vec<Value> {
    let study = &files.study;
    let mut cases: Vec<&str> = Vec::new();
    for row in &study.rows {
        let case = study.text(row, "case");
        if !cases.contains(&case) {
            cases.push(case);
        }
    }
    let of = |case: &str, source: &str| {
        let found = study
            .rows
            .iter()
            .find(|r| study.text(r, "case") == case && study.text(r, "source") == source);
        found.map_or(Value::Null, |r| {
            json!({
                "source": source,
                "seconds": cell(study, r, "seconds"),
                "spread": cell(study, r, "seconds_spread"),
                "cold": cell(study, r, "seconds_cold"),
                "all_threads": cell(study, r, "seconds_all_threads"),
                "threads": study.text(r, "threads"),
                "unknowns": study.text(r, "unknowns"),
                "ratio": cell(study, r, "speedup"),
                "ratio_spread": cell(study, r, "speedup_spread"),
                "timed_on": study.text(r, "timed_on"),
            })
        })
    };
    cases
        .into_iter()
        .map(|case| {
            let methods: Vec<Value> = methods(files).iter().map(|m| of(case, m)).collect();
            json!({ "case": case, "methods": methods, "fem": of(case, "fem") })
        })
        .collect()
}

/// For each method what its effects say in words, and their plots.
fn effects(files: &StudyFiles) -> Vec<Value> {
    methods(files)
        .into_iter()
        .filter_map(|method| {
            let told = files.summary["effects_in_words"].as_array()?;
            let words: Vec<&str> = told
                .iter()
                .filter(|t| t["method"] == method)
                .filter_map(|t| t["text"].as_str())
                .collect();
            let plots: Vec<String> = ["half-normal", "pareto", "interactions"]
                .into_iter()
                .filter_map(|kind| plots::named(files, &format!("{kind}-{method}")))
                .collect();
            (!words.is_empty()).then(|| json!({ "method": method, "words": words, "plots": plots }))
        })
        .collect()
}

/// Names and texts of some values.
type Named = Vec<(String, String)>;

/// The numbers of each solution's `details` but its work: those that are the same in all, and the
/// others, one row a case and method.
fn details(files: &StudyFiles) -> Option<Value> {
    fn flatten(prefix: &str, value: &Value, all: &mut Named) {
        match value {
            Value::Object(map) => {
                for (key, v) in map.iter().filter(|(key, _)| *key != "work") {
                    let name =
                        if prefix.is_empty() { key.clone() } else { format!("{prefix} {key}") };
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
            // Lists have no place in a table's cell; the file has them.
            Value::Array(_) | Value::Null => {}
        }
    }
    let mut rows: Vec<(Value, String, Named)> = Vec::new();
    for case in files.summary["cases"].as_array()? {
        for (method, run) in case["methods"].as_object()? {
            let mut numbers = Vec::new();
            flatten("", &run["details"], &mut numbers);
            if !numbers.is_empty() {
                rows.push((case["name"].clone(), method.clone(), numbers));
            }
        }
    }
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
    let first = rows.first()?.2.clone();
    let (same, other): (Vec<&String>, Vec<&String>) = names.into_iter().partition(|name| {
        rows.iter().all(|(_, _, numbers)| value(numbers, name) == value(&first, name))
    });
    let same: Vec<Value> =
        same.iter().map(|n| json!({ "name": n, "value": value(&first, n) })).collect();
    let rows: Vec<Value> = rows
        .iter()
        .map(|(case, method, numbers)| {
            let values: Vec<String> = other.iter().map(|n| value(numbers, n)).collect();
            json!({ "case": case, "method": method, "values": values })
        })
        .collect();
    Some(json!({ "same": same, "names": other, "rows": rows }))
}

/// What the solves did and what they could leave out, by reason (`details.work`); cases that are
/// one problem have one row.
fn work(files: &StudyFiles) -> Option<Value> {
    let mut reasons: Vec<String> = Vec::new();
    let mut rows: Vec<([Value; 3], Vec<String>, Value)> = Vec::new();
    for case in files.summary["cases"].as_array()? {
        for (method, run) in case["methods"].as_object()? {
            let work = &run["details"]["work"];
            if work["done"].as_u64().is_none() {
                continue;
            }
            for reason in work["avoided"].as_object().into_iter().flat_map(Map::keys) {
                if !reasons.contains(reason) {
                    reasons.push(reason.clone());
                }
            }
            let name = case["name"].as_str().unwrap_or_default().to_string();
            let problem = [json!(method), case["S_l"].clone(), case["L_r"].clone()];
            match rows.iter_mut().find(|(p, _, w)| *p == problem && w == work) {
                Some((_, cases, _)) => cases.push(name),
                None => rows.push((problem, vec![name], work.clone())),
            }
        }
    }
    let rows: Vec<Value> = rows
        .into_iter()
        .map(|([method, ..], cases, work)| {
            let count = |reason: &String| work["avoided"][reason].as_u64().unwrap_or(0);
            let by_reason: Vec<u64> = reasons.iter().map(count).collect();
            let (done, avoided) =
                (work["done"].as_u64().unwrap_or(0), by_reason.iter().sum::<u64>());
            let all = (done + avoided).max(1) as f64;
            json!({
                "method": method,
                "cases": cases.join(", "),
                "done": done,
                "avoided": avoided,
                "share": (100.0 * avoided as f64 / all).round() as u64,
                "by_reason": by_reason,
            })
        })
        .collect();
    (!rows.is_empty()).then(|| json!({ "reasons": reasons, "rows": rows }))
}

/// FEM and models timed in one run, where the run's FEM curves are from elsewhere.
fn timed(files: &StudyFiles) -> Option<Value> {
    let all_times = times(files);
    let mut head = None;
    let mut rows = Vec::new();
    for case in files.summary["cases"].as_array()? {
        let timed = &case["fem"]["timed"];
        if !timed.is_object() {
            continue;
        }
        head.get_or_insert(timed);
        let ratios = all_times.iter().find(|row| row["case"] == case["name"])?;
        let methods: Vec<Value> = methods(files)
            .iter()
            .enumerate()
            .map(|(i, m)| {
                json!({
                    "seconds": timed["methods"][m][0],
                    "spread": timed["methods"][m][1],
                    "ratio": ratios["methods"][i]["ratio"],
                    "ratio_spread": ratios["methods"][i]["ratio_spread"],
                })
            })
            .collect();
        rows.push(json!({
            "case": case["name"],
            "size": timed["size"],
            "unknowns": timed["unknowns"],
            "error": timed["error"],
            "fem": { "seconds": timed["seconds"][0], "spread": timed["seconds"][1] },
            "methods": methods,
        }));
    }
    let head = head?;
    Some(json!({
        "date": head["date"],
        "machine": head["machine"],
        "command": head["command"],
        "tolerance": head["tolerance"],
        "rows": rows,
    }))
}

/// The ratios at equal error of the record, one row a case and one entry a level.
fn equal_error(files: &StudyFiles) -> Option<Value> {
    let all = files.summary["speedups"].as_array()?;
    let mut levels: Vec<f64> = all.iter().filter_map(|s| s["level"].as_f64()).collect();
    levels.sort_by(|a, b| b.total_cmp(a));
    levels.dedup();
    let own = |s: &&Value| s["against"] == "limit";
    let rows: Vec<Value> = files.summary["cases"]
        .as_array()?
        .iter()
        .filter(|case| all.iter().filter(own).any(|s| s["case"] == case["name"]))
        .map(|case| {
            let at = |level: &f64| {
                let is_it = |s: &&Value| s["case"] == case["name"] && s["level"] == *level;
                all.iter().filter(own).find(is_it).cloned().unwrap_or(Value::Null)
            };
            json!({ "case": case["name"], "at": levels.iter().map(at).collect::<Vec<_>>() })
        })
        .collect();
    (!rows.is_empty()).then(|| json!({ "levels": levels, "rows": rows }))
}

/// The versions that FEM ran with, and of which cases.
fn fem_versions(files: &StudyFiles) -> Vec<Value> {
    let mut all: Vec<(String, Vec<&str>)> = Vec::new();
    for case in files.summary["cases"].as_array().into_iter().flatten() {
        let Some(versions) = case["fem"]["versions"].as_object() else { continue };
        let text: Vec<String> = versions
            .iter()
            .map(|(name, v)| format!("{name} {}", v.as_str().unwrap_or_default()))
            .collect();
        let (text, name) = (text.join(", "), case["name"].as_str().unwrap_or_default());
        match all.iter_mut().find(|(t, _)| *t == text) {
            Some((_, cases)) => cases.push(name),
            None => all.push((text, vec![name])),
        }
    }
    let known = all.into_iter().filter(|(text, _)| !text.is_empty());
    known.map(|(text, cases)| json!({ "text": text, "cases": cases.join(", ") })).collect()
}

/// The numbers behind the curves: coordinates in C, values in p0, five digits after the point.
fn explorer_data(files: &StudyFiles) -> Value {
    let mut symbols = Map::new();
    for (name, symbol) in plots::SYMBOLS {
        symbols.insert(name.to_string(), json!(symbol));
    }
    let quantities: Vec<&str> = plots::SYMBOLS.iter().map(|(name, _)| *name).collect();
    let mut sources: Vec<&str> = methods(files);
    sources.push("fem");
    let cases: Vec<Value> = files.summary["cases"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|case| case_data(files, case, &quantities))
        .collect();
    json!({
        "cases": cases,
        "sources": sources,
        "quantities": quantities,
        "symbols": symbols,
        "range": files.summary["range"],
    })
}

/// A number of the explorer's data, five digits after the point.
fn rounded_off(value: f64) -> Value {
    json!((value * 1e5).round() / 1e5)
}

/// Curves and errors of one case, by `body/curve`.
fn case_data(files: &StudyFiles, case: &Value, quantities: &[&str]) -> Value {
    let name = case["name"].as_str().unwrap_or_default();
    let number = |v: &Value| v.as_f64().unwrap_or(f64::NAN);
    let (c_m, p0_pa) = (number(&case["hertz"]["c_m"]), number(&case["hertz"]["p0_pa"]));
    let mut curves: Map<String, Value> = Map::new();

    // Adds a value of a source at a point; the first source that comes to a curve brings the
    // points along, and every source has the same.
    let mut add = |key: String,
                   source: &str,
                   at: [f64; 3],
                   values: Vec<(&str, f64)>,
                   part: &str| {
        let curve = curves.entry(key).or_insert_with(
            || json!({ "points": [], "owner": source, "values": {}, "fem_error": {} }),
        );
        if curve["owner"] == source && part == "values" {
            let point: Vec<Value> = at.iter().map(|v| rounded_off(v / c_m)).collect();
            curve["points"].as_array_mut().expect("made above").push(json!(point));
        }
        let holder = if part == "values" {
            let holder = curve[part].as_object_mut().expect("made above");
            holder.entry(source).or_insert_with(|| json!({})).as_object_mut().expect("an object")
        } else {
            curve[part].as_object_mut().expect("made above")
        };
        for (quantity, value) in values {
            let list = holder.entry(quantity).or_insert_with(|| json!([]));
            list.as_array_mut().expect("a list").push(rounded_off(value / p0_pa));
        }
    };
    let pressure = &files.pressure;
    for row in pressure.rows.iter().filter(|r| pressure.text(r, "case") == name) {
        let get = |column| pressure.number(row, column).unwrap_or(f64::NAN);
        let key = format!("contact/{}", pressure.text(row, "line"));
        let values = vec![("pressure", get("p_pa"))];
        add(key, pressure.text(row, "source"), [get("x_m"), get("y_m"), 0.0], values, "values");
    }
    for (table, part) in [(&files.curves, "values"), (&files.fem_error, "fem_error")] {
        let columns: Vec<(&str, usize)> = quantities
            .iter()
            .filter_map(|&q| Some((q, table.column(&format!("{q}_pa"))?)))
            .collect();
        for row in table.rows.iter().filter(|r| table.text(r, "case") == name) {
            let get = |column| table.number(row, column).unwrap_or(f64::NAN);
            let key = format!("{}/{}", table.text(row, "body"), table.text(row, "curve"));
            let at = [get("x_m"), get("y_m"), get("z_m")];
            let values =
                columns.iter().filter_map(|&(q, c)| Some((q, row[c].parse().ok()?))).collect();
            add(key, table.text(row, "source"), at, values, part);
        }
    }
    for curve in curves.values_mut() {
        let points: Vec<Vec<f64>> =
            serde_json::from_value(curve["points"].clone()).unwrap_or_default();
        // The running coordinate is the one that varies.
        let spread = |k: usize| {
            let all = points.iter().map(|p| p[k]);
            all.clone().fold(f64::MIN, f64::max) - all.fold(f64::MAX, f64::min)
        };
        let axis = (0..3).max_by(|&a, &b| spread(a).total_cmp(&spread(b))).unwrap_or(0);
        let map = curve.as_object_mut().expect("made above");
        map.remove("owner");
        map.insert("axis".to_string(), json!(["x", "y", "z"][axis]));
        map.insert("at".to_string(), json!(points.iter().map(|p| p[axis]).collect::<Vec<_>>()));
    }

    let errors_table = &files.errors;
    let mut errors: Map<String, Value> = Map::new();
    for row in errors_table.rows.iter().filter(|r| errors_table.text(r, "case") == name) {
        let text = |column| errors_table.text(row, column);
        let key = format!("{}/{}", text("body"), text("curve"));
        let of_curve = errors.entry(key).or_insert_with(|| json!({}));
        let slot = &mut of_curve[text("quantity")];
        // Pressure has a row for each range; the first is the one of the summaries.
        if slot.get(text("method")).is_none() {
            let get = |column| errors_table.number(row, column).map_or(Value::Null, rounded_off);
            slot[text("method")] = json!({ "max": get("max"), "rms": get("rms"), "l1": get("l1") });
            let own = get("fem_error_max");
            if !own.is_null() {
                slot["fem_error_max"] = own;
            }
        }
    }
    let label = format!(
        "{name} (W {}, S_l {}, L_r {})",
        significant(number(&case["W"]), 5),
        significant(number(&case["S_l"]), 5),
        significant(number(&case["L_r"]), 5)
    );
    json!({
        "name": name,
        "label": label,
        "S_l": case["S_l"],
        "c_m": c_m,
        "p0_pa": p0_pa,
        "curves": curves,
        "errors": errors,
    })
}
