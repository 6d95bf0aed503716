//! One plot for each curve of each file: its points, and all sources on them.

use crate::report::draw::{Figure, Panel, Series, look};
use crate::report::plots::Shown;
use crate::stress::{Curves, Quantity, StressCurve, away_from_edges};
use crate::study::brought::{Comparison, FileRun};
use crate::study::errors::POINTS;
use crate::study::{Engine, Source};

/// The plots by the names of their files, in the order of the files and curves.
pub(super) fn figures(comparison: &Comparison) -> Vec<(String, Figure)> {
    let ends = comparison.case.overlap();
    let mut all: Vec<(String, Figure)> = Vec::new();
    for run in &comparison.files {
        let plots = Plots { run, ends, excluded: comparison.range.stress_c };
        let curves = &run.file.curves;
        let lines =
            curves.pressure.iter().map(|l| (format!("pressure-{}", l.name), plots.line(&l.name)));
        let stress =
            curves.stress.iter().map(|c| (format!("{}-{}", c.body.name(), c.name), plots.curve(c)));
        for (name, figure) in lines.chain(stress) {
            let number = all.len() + 1;
            all.push((
                format!("plots/{number:02}-{}.svg", plain(&format!("{}-{name}", run.file.name))),
                figure,
            ));
        }
    }
    all
}

/// A name of letters, digits, dots and hyphens alone.
fn plain(name: &str) -> String {
    name.chars()
        .map(|c| if c.is_ascii_alphanumeric() || ".-_".contains(c) { c } else { '-' })
        .collect()
}

/// A stress (p0) that is none.
const NOTHING: f64 = 1e-6;

/// The plots of a file.
struct Plots<'a> {
    run: &'a FileRun,
    ends: [f64; 2],
    excluded: f64,
}

/// The axis that a curve runs along: the one with the largest spread.
fn running(at: &[[f64; 3]]) -> usize {
    let spread = |k: usize| {
        let values = at.iter().map(|p| p[k]);
        values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
    };
    (0..3).max_by(|a, b| spread(*a).total_cmp(&spread(*b))).unwrap_or(0)
}

impl Plots<'_> {
    /// The sources that have a curve; the file's own points lie under the models' curves.
    fn sources(&self) -> impl Iterator<Item = (Source, &Curves)> {
        let own = (Engine::brought(&self.run.file.name).into(), &self.run.file.curves);
        std::iter::once(own).chain(self.run.sources.iter().rev().map(|(s, c)| (s.clone(), c)))
    }

    fn series(
        &self,
        source: &Source,
        at: &[[f64; 3]],
        values: Vec<f64>,
        curve: &str,
        band: Option<Vec<f64>>,
    ) -> Series {
        let axis = running(at);
        let name = match &band {
            Some(_) => format!("{} (band: the error it states)", source.title()),
            None => source.title().to_string(),
        };
        Series {
            name,
            look: look(source),
            beyond: at.iter().map(|p| !away_from_edges(*p, self.ends, self.excluded)).collect(),
            points: at.iter().zip(values).map(|(p, v)| (p[axis], v)).collect(),
            line: !source.is_engine() && curve != POINTS,
            markers: true,
            band,
        }
    }

    fn panel(&self, title: String, y_label: String, at: &[[f64; 3]], series: Vec<Series>) -> Panel {
        let x_label = ["x / C", "y / C", "z / C"][running(at)].to_string();
        Panel { title, x_label, y_label, series, ..Panel::default() }
    }

    /// What stays the same along a curve, in words.
    fn place(at: &[[f64; 3]]) -> String {
        let axis = running(at);
        let fixed = |k: &usize| {
            let first = at.first().map_or(0.0, |p| p[*k]);
            at.iter()
                .all(|p| (p[*k] - first).abs() < 1e-6)
                .then(|| format!("{} = {first:.3} C", ["x", "y", "z"][*k]))
        };
        (0..3).filter(|k| *k != axis).filter_map(|k| fixed(&k)).collect::<Vec<_>>().join(", ")
    }

    fn line(&self, name: &str) -> Figure {
        let own = self.run.file.curves.line(name).expect("a line of the file");
        let at: Vec<[f64; 3]> = own.at.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
        let series = self.sources().filter_map(|(source, curves)| {
            let line = curves.line(name)?;
            Some(self.series(&source, &at, line.p.clone(), name, line.own_error.clone()))
        });
        let place = Self::place(&at);
        let panel = self.panel(place, Shown::Pressure.symbol(), &at, series.collect());
        Figure {
            title: format!("{}: contact pressure, {name}", self.run.file.name),
            columns: 1,
            panels: vec![panel],
            panel_size: (820, 330),
        }
    }

    fn curve(&self, own: &StressCurve) -> Figure {
        // What vanishes by symmetry is not worth a panel.
        let stated = |q: &Quantity| {
            let all = self.sources().filter_map(|(_, curves)| curves.curve(own.body, &own.name));
            let values = all.flat_map(|c| &c.stress).map(|s| q.of(s).abs());
            own.stress.iter().any(|s| q.of(s).is_finite()) && values.fold(0.0, f64::max) > NOTHING
        };
        let panels = Quantity::ALL.into_iter().filter(stated).map(|q| {
            let series = self.sources().filter_map(|(source, curves)| {
                let curve = curves.curve(own.body, &own.name)?;
                let values = curve.stress.iter().map(|s| q.of(s)).collect();
                let band =
                    curve.own_error.as_ref().map(|e| e.iter().map(|v| v[q.index()]).collect());
                Some(self.series(&source, &own.at, values, &own.name, band))
            });
            let symbol = Shown::Stress(q).symbol();
            self.panel(symbol.clone(), symbol, &own.at, series.collect())
        });
        let place = Self::place(&own.at);
        let place = if place.is_empty() { place } else { format!(" ({place})") };
        Figure {
            title: format!("{}: {}, {}{place}", self.run.file.name, own.body.name(), own.name),
            columns: 3,
            panels: panels.collect(),
            panel_size: (380, 290),
        }
    }
}
