//! The numbers behind the curves of the page: coordinates in C, values in p0, five digits after the
//! point.

use crate::base::HertzScales;
use crate::base::number::significant;
use crate::report::plots;
use crate::report::study_files::StudyFiles;
use crate::report::study_summary::CaseSummary;
use crate::study::{Engine, Source};
use serde_json::{Map, Value, json};

/// All that the page's script draws.
pub(super) fn data(files: &StudyFiles) -> Value {
    let mut symbols = Map::new();
    for (name, symbol) in plots::SYMBOLS {
        symbols.insert(name.to_string(), json!(symbol));
    }
    let quantities: Vec<&str> = plots::SYMBOLS.iter().map(|(name, _)| *name).collect();
    let models = files.summary.methods.iter().copied().map(Source::from);
    let sources: Vec<Source> = models.chain([Engine::fenicsx().into()]).collect();
    let cases: Vec<Value> =
        files.summary.cases.iter().map(|case| case_data(files, case, &quantities)).collect();
    json!({
        "cases": cases,
        "sources": sources,
        "quantities": quantities,
        "symbols": symbols,
        "range": files.summary.range,
    })
}

/// A number of the explorer's data, five digits after the point.
fn rounded_off(value: f64) -> Value {
    json!((value * 1e5).round() / 1e5)
}

/// Curves and errors of one case, by `body/curve`.
fn case_data(files: &StudyFiles, case: &CaseSummary, quantities: &[&str]) -> Value {
    let name = &case.name;
    let label = format!(
        "{name} (W {}, S_l {}, L_r {})",
        significant(case.load, 5),
        significant(case.slenderness, 5),
        significant(case.length_ratio, 5)
    );
    json!({
        "name": name,
        "label": label,
        "S_l": case.slenderness,
        "c_m": case.hertz.c_m,
        "p0_pa": case.hertz.p0_pa,
        "curves": curves(files, name, &case.hertz, quantities),
        "errors": errors(files, name),
    })
}

/// The curves of every source in the case called `name`.
fn curves(
    files: &StudyFiles,
    name: &str,
    hertz: &HertzScales,
    quantities: &[&str],
) -> Map<String, Value> {
    let HertzScales { c_m, p0_pa, .. } = *hertz;
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
    curves.values_mut().for_each(find_axis);
    curves
}

/// Tells a curve's running coordinate and its values.
fn find_axis(curve: &mut Value) {
    let points: Vec<Vec<f64>> = serde_json::from_value(curve["points"].clone()).unwrap_or_default();
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

/// The errors of every model in the case called `name`.
fn errors(files: &StudyFiles, name: &str) -> Map<String, Value> {
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
    errors
}
