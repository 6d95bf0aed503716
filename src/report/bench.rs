//! The files of `edgeline bench`: `pareto.csv`, `pareto.svg` and `bench.json`.

use super::draw::{Figure, Look, Marker, Panel, Series, look};
use super::table::{Table, number, optional};
use crate::base::Result;
use crate::host::write_set;
use crate::study::Source;
use crate::study::bench::{Accuracy, Against, Bench, CaseBench, Origin, Point, front};
use crate::study::factorial::median;
use serde_json::Value;
use std::path::Path;

/// Writes the three files into a folder that is there; `bench.json`, which says that the run is
/// complete, last.
///
/// # Errors
/// [`crate::base::Error::Io`] when a file cannot be written.
pub fn write(bench: &Bench, folder: &Path) -> Result<()> {
    let files = [
        ("pareto.csv", table(bench).to_csv().into_bytes()),
        ("pareto.svg", figure(bench).draw().to_svg().into_bytes()),
        ("bench.json", json(bench).into_bytes()),
    ];
    write_set(folder, &files)
}

/// The text of `bench.json`: a line for each case, point and ratio, so that versions of a record can
/// be compared line by line.
pub fn json(bench: &Bench) -> String {
    let value = serde_json::to_value(bench).expect("a run is plain numbers and words");
    let mut text = String::new();
    lines(&value, 0, &mut text);
    text.push('\n');
    text
}

/// Adds a value: the run itself and lists of objects with a line for each entry, all else on one
/// line.
fn lines(value: &Value, depth: usize, text: &mut String) {
    let inner = "\n".to_string() + &"  ".repeat(depth + 1);
    let outer = "\n".to_string() + &"  ".repeat(depth);
    let listed = |v: &Value| v.as_array().is_some_and(|a| a.iter().any(Value::is_object));
    match value {
        Value::Object(map) if depth == 0 || map.values().any(listed) => {
            for (i, (key, v)) in map.iter().enumerate() {
                let start = if i == 0 { "{" } else { "," };
                text.push_str(&format!("{start}{inner}{}: ", Value::from(key.as_str())));
                lines(v, depth + 1, text);
            }
            text.push_str(&outer);
            text.push('}');
        }
        Value::Array(list) if listed(value) => {
            for (i, v) in list.iter().enumerate() {
                text.push(if i == 0 { '[' } else { ',' });
                text.push_str(&inner);
                lines(v, depth + 1, text);
            }
            text.push_str(&outer);
            text.push(']');
        }
        _ => text.push_str(&value.to_string()),
    }
}

/// Time and error of a point, where it has both.
fn pair(point: &Point, against: Against) -> Option<(f64, f64)> {
    Some((point.seconds()?, point.error(against)?))
}

/// The front in a case of the points whose times may be compared with each other.
fn front_of(case: &CaseBench, origin: Origin, against: Against) -> Vec<(f64, f64)> {
    let points = case.points.iter().filter(|p| p.origin == origin);
    front(points.filter_map(|p| pair(p, against)).collect())
}

/// One row for each case and point. Errors are in p0, times in seconds; `setting` is a model's
/// tolerance or a mesh's relative element size; `front_fem` and `front_limit` say whether no other
/// point of the case and `origin` is better in both time and error.
fn table(bench: &Bench) -> Table {
    let mut header = ["case", "source", "origin", "setting", "unknowns", "err"].to_vec();
    header.extend(["seconds", "seconds_spread", "repeats", "threads", "seconds_cold"]);
    header.extend(["seconds_all_threads", "all_threads", "timed_on"]);
    let mut header: Vec<String> = header.into_iter().map(String::from).collect();
    for reference in ["fem", "limit"] {
        for name in ["worst_rms", "pressure_rms", "pressure_max", "stress_rms", "stress_max"] {
            header.push(format!("{name}_to_{reference}"));
        }
        header.push(format!("front_{reference}"));
    }
    let mut table = Table::new(header);
    for case in &bench.cases {
        for point in &case.points {
            table.push(row(case, point));
        }
    }
    table
}

/// The cells of a point in the table's order.
fn row(case: &CaseBench, point: &Point) -> Vec<String> {
    let time = point.timing.as_ref();
    let text = |v: Option<String>| v.unwrap_or_default();
    let origin = match point.origin {
        Origin::Model => "model",
        Origin::LiveFem => "live-fem",
        Origin::RecordedFem => "recorded-fem",
    };
    let mut row = vec![
        case.case.name.clone(),
        point.source.to_string(),
        origin.to_string(),
        number(point.setting),
        text(point.unknowns.map(|u| u.to_string())),
        text(point.err.clone()),
        optional(time.map(|t| t.median_s)),
        optional(time.filter(|t| t.repeats > 1).map(|t| t.spread_s())),
        text(time.map(|t| t.repeats.to_string())),
        text(time.map(|t| t.threads.to_string())),
        optional(time.and_then(|t| t.cold_s)),
        optional(point.all_threads.map(|t| t.median_s)),
        text(point.all_threads.map(|t| t.threads.to_string())),
        point.machine.clone().unwrap_or_else(|| "this machine".to_string()),
    ];
    for (accuracy, against) in [(point.to_fem, Against::Fem), (point.to_limit, Against::Limit)] {
        let get = |f: fn(&Accuracy) -> f64| optional(accuracy.as_ref().map(f));
        let on_front = match pair(point, against) {
            Some(p) if front_of(case, point.origin, against).contains(&p) => "yes",
            Some(_) => "no",
            None => "",
        };
        row.extend([
            get(|a| a.worst_rms),
            get(|a| a.pressure_rms),
            get(|a| a.pressure_max),
            get(|a| a.stress_rms),
            get(|a| a.stress_max),
            on_front.to_string(),
        ]);
    }
    row
}

/// One entry of a panel: where it belongs, and its time and error.
struct Entry<'a> {
    source: &'a Source,
    origin: Origin,
    setting: f64,
    at: (f64, f64),
}

fn entries(case: &CaseBench, against: Against) -> Vec<Entry<'_>> {
    let entry = |p: &'_ Point| pair(p, against).map(|at| (p.setting, at));
    case.points
        .iter()
        .filter_map(|p| {
            let (setting, at) = entry(p)?;
            Some(Entry { source: &p.source, origin: p.origin, setting, at })
        })
        .collect()
}

/// Over all cases that have a point: its median time and worst error.
fn summed_up(cases: &[CaseBench], against: Against) -> Vec<Entry<'_>> {
    let mut groups: Vec<(Entry, Vec<f64>)> = Vec::new();
    for entry in cases.iter().flat_map(|c| entries(c, against)) {
        let same = |e: &Entry| {
            e.source == entry.source && e.origin == entry.origin && e.setting == entry.setting
        };
        match groups.iter_mut().find(|(e, _)| same(e)) {
            Some((first, times)) => {
                times.push(entry.at.0);
                first.at.1 = first.at.1.max(entry.at.1);
            }
            None => {
                let times = vec![entry.at.0];
                groups.push((entry, times));
            }
        }
    }
    groups.into_iter().map(|(e, times)| Entry { at: (median(times), e.at.1), ..e }).collect()
}

fn panel(title: String, entries: &[Entry]) -> Panel {
    let recorded = Look { marker: Marker::Diamond, dash: Some((2.0, 4.0)), ..look("fem") };
    let mut sources: Vec<(&Source, Origin)> = Vec::new();
    for e in entries {
        if !sources.contains(&(e.source, e.origin)) {
            sources.push((e.source, e.origin));
        }
    }
    let points = |chosen: &dyn Fn(&Entry) -> bool| -> Vec<(f64, f64)> {
        let mut all: Vec<&Entry> = entries.iter().filter(|e| chosen(e)).collect();
        all.sort_by(|a, b| b.setting.total_cmp(&a.setting));
        all.into_iter().map(|e| e.at).collect()
    };
    let best = front(points(&|e| e.origin == Origin::Model));
    let line = Look { dash: Some((1.0, 3.0)), ..look("fem") };
    let front = Series { markers: false, ..Series::curve("front of the models", line, best) };
    let curves = sources.iter().map(|&(source, origin)| {
        let own = look(source.name());
        let (name, look) = match origin {
            Origin::Model => (source.name(), own),
            Origin::LiveFem => ("FEM, this run", own),
            Origin::RecordedFem => ("FEM, recorded on its own machine", recorded),
        };
        Series::curve(name, look, points(&|e| e.source == source && e.origin == origin))
    });
    Panel {
        title,
        x_label: "seconds a case (one thread)".to_string(),
        y_label: "worst RMS error of a curve / p0".to_string(),
        series: std::iter::once(front).chain(curves).collect(),
        log: (true, true),
        ..Default::default()
    }
}

/// Run time against error: all cases together where there are several, then each; against what at least
/// one case has.
fn figure(bench: &Bench) -> Figure {
    let titles: Vec<(Against, String)> = [
        (Against::Fem, "against FEM's finest mesh".to_string()),
        (Against::Limit, format!("against quarter-space at {:e}", bench.limit)),
    ]
    .into_iter()
    .filter(|(against, _)| bench.cases.iter().any(|case| !entries(case, *against).is_empty()))
    .collect();
    let several = bench.cases.len() > 1;
    let together = titles.iter().filter(|_| several).map(|(against, title)| {
        let title = format!("all cases (median time, worst error), {title}");
        panel(title, &summed_up(&bench.cases, *against))
    });
    let each = bench.cases.iter().flat_map(|case| {
        titles.iter().map(move |(against, title)| {
            let entries = entries(case, *against);
            let missing = if entries.is_empty() { " (this case has none)" } else { "" };
            panel(format!("{}, {title}{missing}", case.case.name), &entries)
        })
    });
    Figure {
        title: "Run time against error".to_string(),
        columns: titles.len().max(1),
        panels: together.chain(each).collect(),
        panel_size: (560, 380),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_times_of_all_cases_are_summed_up_by_median_and_worst() {
        let point = |setting: f64, seconds: f64, error: f64| {
            let accuracy = json_accuracy(error);
            serde_json::from_value(serde_json::json!({
                "source": "mirror", "origin": "model", "setting": setting,
                "timing": { "threads": 1, "cold_s": null, "median_s": seconds,
                            "quartiles_s": [seconds, seconds], "repeats": 1 },
                "to_fem": accuracy,
            }))
            .unwrap()
        };
        let case = |seconds: f64, error: f64| CaseBench {
            case: crate::case::builtin_case("flush-short").unwrap().unwrap(),
            fem_reference: None,
            points: vec![point(1e-2, seconds, error), point(1e-3, 2.0 * seconds, error)],
        };
        let cases = [case(1.0, 0.1), case(3.0, 0.4), case(2.0, 0.2)];
        let all = summed_up(&cases, Against::Fem);
        let pairs: Vec<_> = all.iter().map(|e| (e.setting, e.at)).collect();
        assert_eq!(pairs, [(1e-2, (2.0, 0.4)), (1e-3, (4.0, 0.4))]);
        assert!(summed_up(&cases, Against::Limit).is_empty());
        assert_eq!(front_of(&cases[0], Origin::Model, Against::Fem), [(1.0, 0.1)]);
    }

    #[test]
    fn the_text_is_the_record() {
        let record = Bench::recorded().unwrap();
        let text = json(&record);
        assert_eq!(Bench::parse(&text, Path::new("b")).unwrap(), record);
        let points: usize = record.cases.iter().map(|c| c.points.len()).sum();
        let most = 30 + 6 * record.cases.len() + points + record.speedups.len();
        assert!(text.lines().count() <= most, "{text}");
        assert_eq!(
            text,
            include_str!("../../results/bench.json"),
            "the record is as it was written"
        );
    }

    #[test]
    fn what_no_case_has_is_not_drawn() {
        let mut bench = Bench::recorded().unwrap();
        assert_eq!(figure(&bench).panels.len(), 2 * (1 + bench.cases.len()));
        for point in &mut bench.cases[0].points {
            point.to_fem = None;
        }
        let panels = figure(&bench).panels;
        assert!(panels[2].title.ends_with("(this case has none)"), "{}", panels[2].title);
        for point in bench.cases.iter_mut().flat_map(|c| &mut c.points) {
            point.to_fem = None;
        }
        let figure = figure(&bench);
        assert_eq!((figure.panels.len(), figure.columns), (1 + bench.cases.len(), 1));
    }

    fn json_accuracy(worst: f64) -> serde_json::Value {
        serde_json::to_value(Accuracy {
            worst_rms: worst,
            pressure_rms: 0.0,
            pressure_max: 0.0,
            stress_rms: 0.0,
            stress_max: 0.0,
        })
        .unwrap()
    }
}
