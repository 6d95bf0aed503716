//! The numbers behind the curves of the page: coordinates in C, values in p0, five digits after the
//! point.

use crate::base::HertzScales;
use crate::base::number::significant;
use crate::report::brought::{FileCurves, Of, of_case};
use crate::report::plots::in_p0;
use crate::report::study_files::StudyFiles;
use crate::report::study_rows::{CurveRow, OwnErrorRow, PressureRow};
use crate::report::study_summary::CaseSummary;
use crate::stress::{Quantity, Variable};
use crate::study::errors::POINTS;
use crate::study::{CONTACT, Engine, Source};
use serde::Serialize;
use serde_json::{Map, Value, json};

/// The data of the page's script.
pub(super) fn data(files: &StudyFiles) -> Value {
    let symbols: Map<String, Value> =
        Variable::all().map(|of| (of.name().to_string(), json!(in_p0(of)))).collect();
    let sources = files.sources();
    let brought = files.summary.cases.iter().flat_map(|case| &case.brought);
    let mut brought: Vec<Source> = brought.map(|file| Engine::brought(&file.name).into()).collect();
    brought.sort();
    brought.dedup();
    let sources: Vec<&Source> = sources.into_iter().chain(&brought).collect();
    let engines = sources.iter().filter_map(|source| source.engine());
    let references = engines.map(|e| json!({ "name": e, "title": e.title() }));
    let cases: Vec<Value> = files.summary.cases.iter().map(|case| case_data(files, case)).collect();
    json!({
        "cases": cases,
        "references": references.collect::<Vec<_>>(),
        "brought": brought,
        "sources": sources,
        "quantities": Variable::all().map(Variable::name).collect::<Vec<_>>(),
        "symbols": symbols,
        "range": files.summary.range,
    })
}

/// Curves and errors of one case, by `body/curve`.
fn case_data(files: &StudyFiles, case: &CaseSummary) -> Value {
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
        "ends": case.overlap().map(five_digits),
        "c_m": case.hertz.c_m,
        "p0_pa": case.hertz.p0_pa,
        "curves": curves(files, case),
        "errors": errors(files, name),
    })
}

/// A number with five digits after the point.
fn five_digits(value: f64) -> f64 {
    (value * 1e5).round() / 1e5
}

/// One curve with the values of all sources.
#[derive(Serialize)]
struct CurveData {
    /// The running coordinate.
    axis: &'static str,
    /// Its values (C).
    at: Vec<f64>,
    /// The points (C).
    points: Vec<[f64; 3]>,
    /// The values (p0) of each source and quantity.
    values: Map<String, Value>,
    /// The own errors (p0) of the reference, for each quantity.
    fem_error: Map<String, Value>,
    /// What differences are taken from, where it is not the first reference.
    #[serde(skip_serializing_if = "Option::is_none")]
    reference: Option<String>,
    /// Whether the points follow each other along a line.
    joined: bool,
}

impl CurveData {
    fn new(points_m: impl Iterator<Item = [f64; 3]>, c_m: f64) -> Self {
        let points: Vec<[f64; 3]> =
            points_m.map(|at_m| at_m.map(|v| five_digits(v / c_m))).collect();
        // The running coordinate is the one that varies most.
        let spread = |k: usize| {
            let all = points.iter().map(|p| p[k]);
            all.clone().fold(f64::MIN, f64::max) - all.fold(f64::MAX, f64::min)
        };
        let axis = (0..3).max_by(|&a, &b| spread(a).total_cmp(&spread(b))).unwrap_or(0);
        let at = points.iter().map(|p| p[axis]).collect();
        let (values, fem_error) = (Map::new(), Map::new());
        let axis = ["x", "y", "z"][axis];
        Self { axis, at, points, values, fem_error, reference: None, joined: true }
    }
}

/// The curves of every source in a case, by `body/curve`.
fn curves(files: &StudyFiles, case: &CaseSummary) -> Map<String, Value> {
    let HertzScales { c_m, p0_pa, .. } = case.hertz;
    let in_p0 = |value_pa: f64| five_digits(value_pa / p0_pa);
    let mut all: Vec<(String, CurveData)> = Vec::new();
    let own: Vec<&PressureRow> = files.pressure.iter().filter(|r| r.case == case.name).collect();
    for rows in own.chunk_by(|a, b| (&a.source, &a.line) == (&b.source, &b.line)) {
        let points = rows.iter().map(|r| [r.at_m[0], r.at_m[1], 0.0]);
        let key = format!("{CONTACT}/{}", rows[0].line);
        let curve = entry(&mut all, key, || CurveData::new(points, c_m));
        let p: Vec<f64> = rows.iter().map(|r| in_p0(r.p_pa)).collect();
        curve.values.insert(rows[0].source.to_string(), json!({ Variable::Pressure.name(): p }));
    }
    let own: Vec<&CurveRow> = files.curves.iter().filter(|r| r.case == case.name).collect();
    let place = |r: &CurveRow| (r.source.clone(), r.body, r.curve.clone());
    for rows in own.chunk_by(|a, b| place(a) == place(b)) {
        let key = format!("{}/{}", rows[0].body.name(), rows[0].curve);
        let curve = entry(&mut all, key, || CurveData::new(rows.iter().map(|r| r.at_m), c_m));
        let quantities = Quantity::ALL.map(|of| {
            let values: Vec<f64> = rows.iter().map(|r| in_p0(r.stress(of))).collect();
            (of.name().to_string(), json!(values))
        });
        let quantities: Map<String, Value> = quantities.into_iter().collect();
        curve.values.insert(rows[0].source.to_string(), Value::Object(quantities));
    }
    let first = files.sources().into_iter().find(|source| source.is_engine());
    let is_own = |r: &&OwnErrorRow| r.case == case.name && first == Some(&r.source);
    for row in files.fem_error.iter().filter(is_own) {
        let key = format!("{}/{}", row.body, row.curve);
        let Some((_, curve)) = all.iter_mut().find(|(k, _)| *k == key) else { continue };
        let stresses = Quantity::ALL.map(|of| (Variable::Stress(of), row.stress(of)));
        for (of, error_pa) in stresses.into_iter().chain([(Variable::Pressure, row.pressure_pa)]) {
            let list = curve.fem_error.entry(of.name()).or_insert_with(|| json!([]));
            let list = list.as_array_mut().expect("made above");
            list.extend(error_pa.map(|error_pa| json!(in_p0(error_pa))));
        }
    }
    all.extend(of_case(files, case).iter().flat_map(brought));
    all.into_iter().map(|(key, curve)| (key, json!(curve))).collect()
}

/// What stands before the name of a curve from a file.
fn brought_name(file: &str, curve: &str) -> String {
    format!("{file}: {curve}")
}

/// The curves of a file with the values of all sources on their points.
fn brought(file: &FileCurves) -> Vec<(String, CurveData)> {
    let Some((_, own)) = file.all.first() else { return Vec::new() };
    let new = |name: &str, points: Vec<[f64; 3]>| CurveData {
        reference: Some(file.summary.name.clone()),
        joined: name != POINTS,
        ..CurveData::new(points.into_iter(), 1.0)
    };
    let rounded = |values: Vec<f64>| json!(values.into_iter().map(five_digits).collect::<Vec<_>>());
    let mut all = Vec::new();
    for line in &own.pressure {
        let mut data = new(&line.name, line.at.iter().map(|[x, y]| [*x, *y, 0.0]).collect());
        let quantity = Variable::Pressure.name();
        for (source, curves) in &file.all {
            let Some(line) = curves.line(&line.name) else { continue };
            data.values.insert(source.to_string(), json!({ quantity: rounded(line.p.clone()) }));
        }
        if let Some(error) = &line.own_error {
            data.fem_error.insert(quantity.to_string(), rounded(error.clone()));
        }
        all.push((format!("{CONTACT}/{}", brought_name(&file.summary.name, &line.name)), data));
    }
    for curve in &own.stress {
        let mut data = new(&curve.name, curve.at.clone());
        let stated = |q: &Quantity| curve.stress.iter().any(|s| q.of(s).is_finite());
        let quantities: Vec<Quantity> = Quantity::ALL.into_iter().filter(stated).collect();
        for (source, curves) in &file.all {
            let Some(curve) = curves.curve(curve.body, &curve.name) else { continue };
            let values = |q: &Quantity| {
                let values = curve.stress.iter().map(|s| q.of(s)).collect();
                (q.name().to_string(), rounded(values))
            };
            let values: Map<String, Value> = quantities.iter().map(values).collect();
            data.values.insert(source.to_string(), Value::Object(values));
        }
        for (q, error) in
            curve.own_error.iter().flat_map(|e| quantities.iter().map(move |q| (q, e)))
        {
            let values = error.iter().map(|of_point| of_point[q.index()]).collect();
            data.fem_error.insert(q.name().to_string(), rounded(values));
        }
        let name = brought_name(&file.summary.name, &curve.name);
        all.push((format!("{}/{name}", curve.body.name()), data));
    }
    all
}

/// The curve of this key, made where there is none.
fn entry(
    all: &mut Vec<(String, CurveData)>,
    key: String,
    make: impl FnOnce() -> CurveData,
) -> &mut CurveData {
    let at = all.iter().position(|(k, _)| *k == key).unwrap_or_else(|| {
        all.push((key, make()));
        all.len() - 1
    });
    &mut all[at].1
}

/// The errors of every model in the case called `name`, by `body/curve` and quantity.
fn errors(files: &StudyFiles, name: &str) -> Map<String, Value> {
    let mut errors: Map<String, Value> = Map::new();
    let standard = files.errors.iter().map(|row| (row, row.curve.clone()));
    let brought = files
        .brought
        .iter()
        .map(|Of { reference, row }| (row, brought_name(reference, &row.curve)));
    for (row, curve) in standard.chain(brought).filter(|(row, _)| row.case == name) {
        let key = format!("{}/{curve}", row.body);
        let slot = &mut errors.entry(key).or_insert_with(|| json!({}))[row.variable.name()];
        // Pressure has a row for each range; the first is the one of the summaries.
        if slot.get(row.method.name()).is_none() {
            let [max, rms, l1] = [row.max, row.rms, row.l1].map(five_digits);
            slot[row.method.name()] = json!({ "max": max, "rms": rms, "l1": l1 });
            if let Some(own) = row.ref_error_max {
                slot["fem_error_max"] = json!(five_digits(own));
            }
        }
    }
    errors
}
