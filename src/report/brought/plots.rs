//! One plot for each curve of a file: its points, and all sources on them.

use crate::base::number::fixed;
use crate::report::draw::{Figure, Panel, Series, look};
use crate::report::plots::in_p0;
use crate::stress::{Curves, PressureLine, Quantity, StressCurve, Variable, away_from_edges};
use crate::study::Source;
use crate::study::errors::POINTS;

/// Letters of a plot's name; file systems take 255 bytes.
const LONGEST: usize = 160;

/// A name of letters, digits, dots, underscores and hyphens alone, without the end of a long one:
/// what tells names apart has to stand in front.
pub fn plain(name: &str) -> String {
    let one = |c: char| if c.is_ascii_alphanumeric() || ".-_".contains(c) { c } else { '-' };
    name.chars().take(LONGEST).map(one).collect()
}

/// A stress (p0) that is none.
const NOTHING: f64 = 1e-6;

/// What the plots of a file show.
pub struct Plots<'a> {
    /// What its curves are called.
    pub name: &'a str,
    /// The file's own curves, then those of all sources on its points.
    pub all: Vec<(Source, &'a Curves)>,
    /// The ends of the contact (C).
    pub ends: [f64; 2],
    /// Up to this distance from them stresses are not compared (C).
    pub excluded: f64,
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
    /// The plots by body and curve, in the order of the curves.
    pub fn figures(&self) -> Vec<(String, Figure)> {
        let own = self.own();
        let lines = own.pressure.iter().map(|l| (format!("pressure-{}", l.name), self.line(l)));
        let curves =
            own.stress.iter().map(|c| (format!("{}-{}", c.body.name(), c.name), self.curve(c)));
        lines.chain(curves).collect()
    }

    /// The file's own curves.
    fn own(&self) -> &Curves {
        self.all.first().expect("the file's own curves").1
    }

    /// The sources as they lie upon each other: the file's own points under the models' curves.
    fn sources(&self) -> impl Iterator<Item = &(Source, &Curves)> {
        self.all.iter().take(1).chain(self.all.iter().skip(1).rev())
    }

    fn series(
        &self,
        source: &Source,
        at: &[[f64; 3]],
        values: Vec<f64>,
        curve: &str,
        errors: Option<Vec<f64>>,
    ) -> Series {
        let axis = running(at);
        let name = match &errors {
            Some(_) => format!("{} (band: the error it states)", source.title()),
            None => source.title().to_string(),
        };
        let points = at.iter().zip(values).map(|(p, v)| (p[axis], v)).collect();
        let series = Series {
            beyond: at.iter().map(|p| !away_from_edges(*p, self.ends, self.excluded)).collect(),
            line: !source.is_engine() && curve != POINTS,
            ..Series::marks(&name, look(source), points)
        };
        series.within(errors)
    }

    fn panel(&self, title: String, y_label: String, at: &[[f64; 3]], series: Vec<Series>) -> Panel {
        let x_label = ["x / C", "y / C", "z / C"][running(at)].to_string();
        Panel { title, x_label, y_label, series, ..Panel::default() }
    }

    /// What stays the same along a curve, in words.
    fn place(at: &[[f64; 3]]) -> String {
        let axis = running(at);
        let constant = |k: &usize| {
            let first = at.first().map_or(0.0, |p| p[*k]);
            at.iter()
                .all(|p| (p[*k] - first).abs() < 1e-6)
                .then(|| format!("{} = {} C", ["x", "y", "z"][*k], fixed(first, 3)))
        };
        (0..3).filter(|k| *k != axis).filter_map(|k| constant(&k)).collect::<Vec<_>>().join(", ")
    }

    fn line(&self, own: &PressureLine) -> Figure {
        let name = &own.name;
        let at: Vec<[f64; 3]> = own.at.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
        let series = self.sources().filter_map(|(source, curves)| {
            let line = curves.line(name)?;
            Some(self.series(source, &at, line.p.clone(), name, line.own_error.clone()))
        });
        let place = Self::place(&at);
        let panel = self.panel(place, in_p0(Variable::Pressure), &at, series.collect());
        Figure {
            title: format!("{}: contact pressure, {name}", self.name),
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
                Some(self.series(source, &own.at, values, &own.name, band))
            });
            let symbol = in_p0(Variable::Stress(q));
            self.panel(symbol.clone(), symbol, &own.at, series.collect())
        });
        let place = Self::place(&own.at);
        let place = if place.is_empty() { place } else { format!(" ({place})") };
        Figure {
            title: format!("{}: {}, {}{place}", self.name, own.body.name(), own.name),
            columns: 3,
            panels: panels.collect(),
            panel_size: (380, 290),
        }
    }
}
