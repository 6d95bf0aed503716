//! The plots of effects: half-normal, Pareto and interactions, for each model.

use crate::base::number::significant;
use crate::body::EdgeModel;
use crate::case::FactorKey;
use crate::report::draw::{Bar, Figure, Look, Marker, Note, Panel, Rule, Series, look};
use crate::report::effects_text::{label, told_of};
use crate::report::study_files::StudyFiles;
use crate::report::study_rows::{EffectRow, StudyRow};
use crate::report::study_summary::RoleName;
use crate::study::Source;
use crate::study::factorial::Verdict;
use crate::study::response::Response;

/// The effects on one response of one model.
struct EffectRows<'a> {
    files: &'a StudyFiles,
    response: Response,
    look: Look,
    rows: Vec<&'a EffectRow>,
}

impl<'a> EffectRows<'a> {
    fn of(files: &'a StudyFiles, method: EdgeModel, response: Response) -> Option<Self> {
        let own = |row: &&EffectRow| row.method == method && row.response == response;
        let rows: Vec<&EffectRow> = files.effects.iter().filter(own).collect();
        (!rows.is_empty()).then(|| Self { files, response, look: look(&method.into()), rows })
    }

    /// Lenth's limits, which are the same in all rows.
    fn limits(&self) -> impl Iterator<Item = (f64, String)> {
        let first = self.rows.first();
        let (me, sme) = (first.and_then(|r| r.me), first.and_then(|r| r.sme));
        let all = [me.map(|v| (v, "ME".to_string())), sme.map(|v| (v, "SME".to_string()))];
        all.into_iter().flatten()
    }

    /// The name of an effect on a plot.
    fn title(&self, row: &EffectRow) -> String {
        match row.term.split(" x ").collect::<Vec<_>>()[..] {
            [main] => factor(self.files, main).0,
            _ => self.short(row),
        }
    }

    /// The name of an effect by letters, where the factors have them.
    fn short(&self, row: &EffectRow) -> String {
        let short = row.term.split(" x ").map(|name| factor(self.files, name).1);
        short.collect::<Vec<_>>().join(" × ")
    }

    /// The unit of the response on a plot, and how many of it are one of the files'.
    fn plotted(&self) -> (&'static str, f64) {
        match self.response.unit() {
            "Pa" => ("MPa", 1e-6),
            "m" => ("µm", 1e6),
            unit => (unit, 1.0),
        }
    }

    fn half_normal(&self) -> Panel {
        let (unit, scale) = self.plotted();
        let point = |r: &&EffectRow| (r.half_normal_quantile, scale * r.effect.abs());
        let points: Vec<(f64, f64)> = self.rows.iter().map(point).collect();
        // Names of those that stand out, and of the largest two in any case: the small ones lie
        // close together and are noise.
        let mut largest: Vec<f64> = points.iter().map(|p| p.1).collect();
        largest.sort_by(|a, b| b.total_cmp(a));
        let second = largest.get(1).copied().unwrap_or(0.0);
        let notes = self.rows.iter().zip(&points).filter_map(|(row, &at)| {
            let named = at.1 >= second || row.verdict != Some(Verdict::Noise);
            named.then(|| Note { at, text: self.short(row) })
        });
        Panel {
            title: label(self.response),
            x_label: "half-normal quantile".to_string(),
            y_label: format!("|effect| ({unit})"),
            series: vec![Series::marks("", self.look, points.clone())],
            notes: notes.collect(),
            rules: self
                .limits()
                .map(|(v, name)| Rule::Horizontal(scale * v, name))
                .chain([Rule::Horizontal(0.0, String::new())])
                .collect(),
            // Fifteen effects reach 2.13; names stand beside the points.
            x_range: Some((0.0, points.iter().map(|p| 1.15 * p.0).fold(2.1, f64::max))),
            ..Default::default()
        }
    }

    fn pareto(&self) -> Panel {
        let (unit, scale) = self.plotted();
        let bar = |row: &&EffectRow| Bar {
            name: self.title(row),
            value: scale * row.effect.abs(),
            colour: self.look.colour,
            strong: row.verdict == Some(Verdict::Active),
        };
        let mut bars: Vec<Bar> = self.rows.iter().map(bar).collect();
        bars.sort_by(|a, b| b.value.total_cmp(&a.value));
        Panel {
            title: label(self.response),
            x_label: format!("|effect| ({unit}); full: beyond SME"),
            bars,
            rules: self.limits().map(|(v, name)| Rule::Vertical(scale * v, name)).collect(),
            ..Default::default()
        }
    }
}

/// A factor on a plot: its name, and its letter where names may be long.
fn factor(files: &StudyFiles, name: &str) -> (String, String) {
    let summary = &files.summary;
    let place = summary.factors.iter().position(|f| f.name == name);
    let letter = place.and_then(|i| summary.design.as_ref()?.letters.get(i).copied());
    match letter.filter(|_| !summary.further_factors.is_empty()) {
        Some(letter) => (format!("{letter} = {name}"), letter.to_string()),
        None => (name.to_string(), name.to_string()),
    }
}

/// What an axis says of a factor: what it is called there, and its unit.
fn with_unit(called: String, name: &str) -> String {
    match FactorKey::find(name).and_then(FactorKey::unit) {
        Some(unit) => format!("{called} ({unit})"),
        None => called,
    }
}

/// Most interactions of a response that are drawn.
const MOST_INTERACTIONS: usize = 6;

/// Interaction plots of a response: its mean over the corners at each pair of levels of two
/// factors, all in the same limits. Of many pairs those with the largest effects are drawn.
fn interactions(of: &EffectRows) -> Vec<Panel> {
    let files = of.files;
    let Some(method) = of.rows.first().map(|row| row.method) else { return Vec::new() };
    let source = Source::from(method);
    let is_corner = |row: &&StudyRow| row.source == source && row.role == RoleName::Corner;
    let corners: Vec<&StudyRow> = files.study.iter().filter(is_corner).collect();
    let names = || files.summary.factors.iter().map(|f| f.name.as_str()).enumerate();
    let size = |[a, b]: [&str; 2]| {
        let name = format!("{a} x {b}");
        of.rows.iter().find(|row| row.term == name).map_or(0.0, |row| row.effect.abs())
    };
    let mut pairs: Vec<[&str; 2]> =
        names().flat_map(|(i, a)| names().skip(i + 1).map(move |(_, b)| [a, b])).collect();
    if pairs.len() > MOST_INTERACTIONS {
        pairs.sort_by(|a, b| size(*b).total_cmp(&size(*a)));
        pairs.truncate(MOST_INTERACTIONS);
    }
    let mut panels: Vec<Panel> = pairs
        .into_iter()
        .map(|pair| Panel {
            y_label: format!("mean of the corners ({})", of.plotted().0),
            ..interaction(&corners, of, pair)
        })
        .collect();
    let means = panels.iter().flat_map(|p| &p.series).flat_map(|s| &s.points).map(|p| p.1);
    let range = Panel::limits_of(means);
    for panel in &mut panels {
        panel.y_range = Some(range);
    }
    panels
}

/// Means of a response over the first factor's levels, a line for each level of the second.
fn interaction(corners: &[&StudyRow], of: &EffectRows, [a, b]: [&str; 2]) -> Panel {
    let files = of.files;
    let [first, second] = [a, b].map(|name| factor(files, name));
    let levels = |factor: &str| {
        let mut all: Vec<f64> =
            corners.iter().filter_map(|row| files.factor(row, factor)).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    };
    let (_, scale) = of.plotted();
    let mean = |x: f64, line: f64| -> Option<f64> {
        let at = |row: &StudyRow, factor, level| files.factor(row, factor) == Some(level);
        let here = corners.iter().filter(|row| at(row, a, x) && at(row, b, line));
        let all: Vec<f64> = here.filter_map(|row| row.response(of.response)).collect();
        (!all.is_empty()).then(|| scale * all.iter().sum::<f64>() / all.len() as f64)
    };
    let colour = of.look.colour;
    let looks = [
        Look { colour, dash: Some((6.0, 4.0)), marker: Marker::Square },
        Look { colour, dash: None, marker: Marker::Circle },
    ];
    let (mut series, mut notes) = (Vec::new(), Vec::new());
    for (line, look) in levels(b).into_iter().zip(looks) {
        let at = levels(a).into_iter().enumerate();
        let means: Vec<(f64, f64)> =
            at.filter_map(|(i, x)| Some((i as f64, mean(x, line)?))).collect();
        let text = format!("{} = {}", second.1, level(line));
        notes.extend(means.last().map(|at| Note { at: *at, text }));
        series.push(Series::curve("", look, means));
    }
    Panel {
        title: format!("{}: {} × {}", label(of.response), first.1, second.1),
        x_label: match second.1 == b {
            true => with_unit(first.0, a),
            false => format!("{}; lines: {}", with_unit(first.0, a), second.0),
        },
        series,
        notes,
        x_names: levels(a).into_iter().map(level).collect(),
        ..Default::default()
    }
}

/// A level of a factor as text.
fn level(value: f64) -> String {
    significant(value, 5)
}

/// The plots of all models, by name.
pub(super) fn figures(files: &StudyFiles) -> Vec<(String, Figure)> {
    files.summary.methods.iter().flat_map(|&method| of_method(files, method)).collect()
}

fn of_method(files: &StudyFiles, method: EdgeModel) -> Vec<(String, Figure)> {
    let chosen = told_of(|response| files.effects.iter().any(|row| row.response == response));
    let of: Vec<EffectRows> =
        chosen.into_iter().filter_map(|r| EffectRows::of(files, method, r)).collect();
    if of.is_empty() {
        return Vec::new();
    }
    let figure = |title: &str, panels: Vec<Panel>, columns, panel_size| Figure {
        title: format!("{method}: {title}"),
        columns,
        panels,
        panel_size,
    };
    // Four panels stand better in two rows than as three and one.
    let columns = if of.len() == 4 { 2 } else { 3 };
    let half_normal = of.iter().map(EffectRows::half_normal).collect();
    let pareto = of.iter().map(EffectRows::pareto).collect();
    let interactions = of.iter().flat_map(interactions).collect();
    vec![
        (
            format!("half-normal-{method}"),
            figure("half-normal plot of the effects", half_normal, columns, (380, 320)),
        ),
        (format!("pareto-{method}"), figure("effects by size", pareto, columns, (380, 300))),
        (format!("interactions-{method}"), figure("interactions", interactions, 3, (380, 270))),
    ]
}
