//! The plots of effects: half-normal, Pareto and interactions, for each model.

use crate::base::number::significant;
use crate::body::EdgeModel;
use crate::report::draw::{Bar, Figure, Look, Marker, Note, Panel, Rule, Series, look};
use crate::report::effects_text::{TOLD, label};
use crate::report::study_files::StudyFiles;
use crate::report::study_rows::{EffectRow, StudyRow};
use crate::report::study_summary::RoleName;
use crate::study::factorial::Verdict;
use crate::study::response::Response;
use crate::study::{FactorName, Source};

/// The effects on one response of one model.
struct EffectRows<'a> {
    response: Response,
    look: Look,
    rows: Vec<&'a EffectRow>,
}

impl<'a> EffectRows<'a> {
    fn of(files: &'a StudyFiles, method: EdgeModel, response: Response) -> Option<Self> {
        let own = |row: &&EffectRow| row.method == method && row.response == response;
        let rows: Vec<&EffectRow> = files.effects.iter().filter(own).collect();
        (!rows.is_empty()).then(|| Self { response, look: look(&method.into()), rows })
    }

    /// Lenth's limits, which are the same in all rows.
    fn limits(&self) -> impl Iterator<Item = (f64, String)> {
        let first = self.rows.first();
        let (me, sme) = (first.and_then(|r| r.me), first.and_then(|r| r.sme));
        let all = [me.map(|v| (v, "ME".to_string())), sme.map(|v| (v, "SME".to_string()))];
        all.into_iter().flatten()
    }

    fn half_normal(&self) -> Panel {
        let points: Vec<(f64, f64)> =
            self.rows.iter().map(|r| (r.half_normal_quantile, r.effect.abs())).collect();
        // Names of those that stand out, and of the largest two in any case: the small ones lie
        // close together and are noise.
        let mut largest: Vec<f64> = points.iter().map(|p| p.1).collect();
        largest.sort_by(|a, b| b.total_cmp(a));
        let second = largest.get(1).copied().unwrap_or(0.0);
        let notes = self.rows.iter().zip(&points).filter_map(|(row, &at)| {
            let named = at.1 >= second || row.verdict != Some(Verdict::Noise);
            named.then(|| Note { at, text: title(row) })
        });
        Panel {
            title: label(self.response),
            x_label: "half-normal quantile".to_string(),
            y_label: format!("|effect| ({})", self.response.unit()),
            series: vec![Series::marks("", self.look, points.clone())],
            notes: notes.collect(),
            rules: self
                .limits()
                .map(|(v, name)| Rule::Horizontal(v, name))
                .chain([Rule::Horizontal(0.0, String::new())])
                .collect(),
            x_range: Some((0.0, 2.1)),
            ..Default::default()
        }
    }

    fn pareto(&self) -> Panel {
        let bar = |row: &&EffectRow| Bar {
            name: title(row),
            value: row.effect.abs(),
            colour: self.look.colour,
            strong: row.verdict == Some(Verdict::Active),
        };
        let mut bars: Vec<Bar> = self.rows.iter().map(bar).collect();
        bars.sort_by(|a, b| b.value.total_cmp(&a.value));
        Panel {
            title: label(self.response),
            x_label: format!("|effect| ({}); full: beyond SME", self.response.unit()),
            bars,
            rules: self.limits().map(|(v, name)| Rule::Vertical(v, name)).collect(),
            ..Default::default()
        }
    }
}

/// The name of an effect on a plot.
fn title(row: &EffectRow) -> String {
    row.term.replace(" x ", " × ")
}

/// Interaction plots of a response: its mean over the corners at each pair of levels of two
/// factors, all in the same limits.
fn interactions(files: &StudyFiles, method: EdgeModel, response: Response) -> Vec<Panel> {
    let source = Source::from(method);
    let is_corner = |row: &&StudyRow| row.source == source && row.role == RoleName::Corner;
    let corners: Vec<&StudyRow> = files.study.iter().filter(is_corner).collect();
    let names: Vec<FactorName> = files.summary.factors.iter().map(|f| f.name).collect();
    let pairs =
        names.iter().enumerate().flat_map(|(i, a)| names[i + 1..].iter().map(move |b| [*a, *b]));
    let mut panels: Vec<Panel> = pairs
        .map(|pair| Panel {
            y_label: format!("mean of the corners ({})", response.unit()),
            ..interaction(&corners, look(&source), response, pair)
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
fn interaction(
    corners: &[&StudyRow],
    Look { colour, .. }: Look,
    response: Response,
    [a, b]: [FactorName; 2],
) -> Panel {
    let levels = |factor: FactorName| {
        let mut all: Vec<f64> = corners.iter().map(|row| row.factor(factor)).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    };
    let mean = |x: f64, line: f64| -> Option<f64> {
        let here = corners.iter().filter(|row| row.factor(a) == x && row.factor(b) == line);
        let all: Vec<f64> = here.filter_map(|row| row.response(response)).collect();
        (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
    };
    let looks = [
        Look { colour, dash: Some((6.0, 4.0)), marker: Marker::Square },
        Look { colour, dash: None, marker: Marker::Circle },
    ];
    let (mut series, mut notes) = (Vec::new(), Vec::new());
    for (line, look) in levels(b).into_iter().zip(looks) {
        let at = levels(a).into_iter().enumerate();
        let means: Vec<(f64, f64)> =
            at.filter_map(|(i, x)| Some((i as f64, mean(x, line)?))).collect();
        let text = format!("{} = {}", b.name(), level(line));
        notes.extend(means.last().map(|at| Note { at: *at, text }));
        series.push(Series::curve("", look, means));
    }
    Panel {
        title: format!("{}: {} × {}", label(response), a.name(), b.name()),
        x_label: a.name().to_string(),
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
    let of: Vec<EffectRows> =
        TOLD.iter().filter_map(|r| EffectRows::of(files, method, *r)).collect();
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
    let interactions = of.iter().flat_map(|e| interactions(files, method, e.response)).collect();
    vec![
        (
            format!("half-normal-{method}"),
            figure("half-normal plot of the effects", half_normal, columns, (380, 320)),
        ),
        (format!("pareto-{method}"), figure("effects by size", pareto, columns, (380, 300))),
        (format!("interactions-{method}"), figure("interactions", interactions, 3, (380, 270))),
    ]
}
