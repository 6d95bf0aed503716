//! The files of `edgeline bench`: `pareto.csv`, `pareto.svg` and `bench.json`.

use super::draw::{Figure, Look, Marker, Panel, Series, look};
use super::table::{by_name, columns, to_csv};
use crate::base::Result;
use crate::host::write_set;
use crate::study::bench::{Against, Bench, BenchPoint, CaseBench, Deviation, Origin, front};
use crate::study::factorial::median;
use crate::study::{Engine, Source};
use serde_json::Value;
use std::path::Path;

/// Writes the three files into an existing folder, `bench.json` last: its presence means that the
/// run is complete.
///
/// # Errors
/// [`crate::base::Error::Io`] when a file cannot be written.
pub fn write(bench: &Bench, folder: &Path) -> Result<()> {
    let files = [
        ("pareto.csv", to_csv(&pareto_rows(bench), &bench.range).into_bytes()),
        ("pareto.svg", figure(bench).draw().to_svg().into_bytes()),
        ("bench.json", json(bench).into_bytes()),
    ];
    write_set(folder, &files)
}

/// The text of `bench.json`, with a line for each case, point and ratio, so that versions of a
/// record can be compared line by line.
pub fn json(bench: &Bench) -> String {
    let value = serde_json::to_value(bench).expect("a run is plain numbers and words");
    let mut text = String::new();
    lines(&value, 0, &mut text);
    text.push('\n');
    text
}

/// Adds a value. The run itself and lists of objects have a line for each entry; any other value is
/// on one line.
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

/// Time and error of a point, if it has both.
fn pair(point: &BenchPoint, against: Against) -> Option<(f64, f64)> {
    Some((point.seconds()?, point.error(against)?))
}

/// The front in a case of the points whose times may be compared with each other.
fn front_of(case: &CaseBench, origin: Origin, against: Against) -> Vec<(f64, f64)> {
    let points = case.points.iter().filter(|p| p.origin == origin);
    front(points.filter_map(|p| pair(p, against)).collect())
}

/// A row of `pareto.csv`: one point of a case. Errors are in p0, times in seconds.
#[derive(Debug, Clone, PartialEq)]
struct ParetoRow {
    case: String,
    source: Source,
    origin: Origin,
    /// A model's tolerance, a mesh's relative element size or the number of cells.
    setting: f64,
    unknowns: Option<u64>,
    err: Option<String>,
    seconds: Option<f64>,
    seconds_spread: Option<f64>,
    repeats: Option<usize>,
    threads: Option<usize>,
    seconds_cold: Option<f64>,
    seconds_all_threads: Option<f64>,
    all_threads: Option<usize>,
    timed_on: String,
    to_fem: [Option<f64>; MEASURES.len()],
    /// Whether no other point of the case and origin is better in both time and error: yes or no.
    front_fem: Option<String>,
    to_limit: [Option<f64>; MEASURES.len()],
    front_limit: Option<String>,
}

/// A measure of a deviation.
type Measure = fn(&Deviation) -> f64;

/// The measures of a deviation by their names.
const MEASURES: [(&str, Measure); 5] = [
    ("worst_rms", |d| d.worst_rms),
    ("pressure_rms", |d| d.pressure_rms),
    ("pressure_max", |d| d.pressure_max),
    ("stress_rms", |d| d.stress_rms),
    ("stress_max", |d| d.stress_max),
];

by_name!(Origin);

columns!(ParetoRow, _layout, {
    case,
    source,
    origin,
    setting,
    unknowns,
    err,
    seconds,
    seconds_spread,
    repeats,
    threads,
    seconds_cold,
    seconds_all_threads,
    all_threads,
    timed_on,
    to_fem => MEASURES.map(|(name, _)| format!("{name}_to_fem")),
    front_fem,
    to_limit => MEASURES.map(|(name, _)| format!("{name}_to_limit")),
    front_limit,
});

/// The rows of `pareto.csv`.
fn pareto_rows(bench: &Bench) -> Vec<ParetoRow> {
    let of_case = |case: &CaseBench| -> Vec<ParetoRow> {
        case.points.iter().map(|point| pareto_row(case, point)).collect()
    };
    bench.cases.iter().flat_map(of_case).collect()
}

fn pareto_row(case: &CaseBench, point: &BenchPoint) -> ParetoRow {
    let (time, all) = (point.timing.as_ref(), point.all_threads.as_ref());
    let measures =
        |deviation: Option<Deviation>| MEASURES.map(|(_, measure)| deviation.as_ref().map(measure));
    let is_on_front = |against: Against| {
        let own = pair(point, against)?;
        let is_on = front_of(case, point.origin, against).contains(&own);
        Some(if is_on { "yes" } else { "no" }.to_string())
    };
    ParetoRow {
        case: case.case.name.clone(),
        source: point.source.clone(),
        origin: point.origin,
        setting: point.setting,
        unknowns: point.unknowns,
        err: point.err.clone(),
        seconds: time.map(|t| t.median_s),
        seconds_spread: time.filter(|t| t.repeats > 1).map(|t| t.spread_s()),
        repeats: time.map(|t| t.repeats),
        threads: time.map(|t| t.threads),
        seconds_cold: time.and_then(|t| t.cold_s),
        seconds_all_threads: all.map(|t| t.median_s),
        all_threads: all.map(|t| t.threads),
        timed_on: point.machine.clone().unwrap_or_else(|| "this machine".to_string()),
        to_fem: measures(point.to_fem),
        front_fem: is_on_front(Against::Fem),
        to_limit: measures(point.to_limit),
        front_limit: is_on_front(Against::Limit),
    }
}

/// One entry of a panel: its source, and its time and error.
struct Entry<'a> {
    source: &'a Source,
    origin: Origin,
    setting: f64,
    at: (f64, f64),
}

fn entries(case: &CaseBench, against: Against) -> Vec<Entry<'_>> {
    let entry = |p: &'_ BenchPoint| pair(p, against).map(|at| (p.setting, at));
    case.points
        .iter()
        .filter_map(|p| {
            let (setting, at) = entry(p)?;
            Some(Entry { source: &p.source, origin: p.origin, setting, at })
        })
        .collect()
}

/// The median time and the worst error of each point over all cases that have it.
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
    let ink = look(&Engine::fenicsx().into());
    let recorded = Look { marker: Marker::Plus, dash: Some((2.0, 4.0)), ..ink };
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
    let line = Look { dash: Some((1.0, 3.0)), ..ink };
    let front = Series { markers: false, ..Series::curve("front of the models", line, best) };
    let curves = sources.iter().map(|&(source, origin)| {
        let own = look(source);
        let title = source.title();
        let (name, look) = match origin {
            Origin::Model | Origin::Cells => (source.name().to_string(), own),
            Origin::LiveFem => (format!("{title}, this run"), own),
            Origin::RecordedFem => (format!("{title}, recorded on its own machine"), recorded),
        };
        Series::curve(&name, look, points(&|e| e.source == source && e.origin == origin))
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

/// Run time against error: all cases together if there are several, then each case. A reference
/// that no case has is left out.
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
    use crate::report::table::from_csv;

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
    fn the_table_is_read_as_it_is_written() {
        let record = Bench::recorded().unwrap();
        let text = to_csv(&pareto_rows(&record), &record.range);
        let rows: Vec<ParetoRow> = from_csv(&text, Path::new("t"), &record.range).unwrap();
        assert_eq!(to_csv(&rows, &record.range), text);
        assert!(rows.iter().any(|r| r.front_fem.as_deref() == Some("yes")));
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
        serde_json::to_value(Deviation {
            worst_rms: worst,
            pressure_rms: 0.0,
            pressure_max: 0.0,
            stress_rms: 0.0,
            stress_max: 0.0,
        })
        .unwrap()
    }
}
