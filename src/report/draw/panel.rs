//! What a figure is made of: panels of curves, points, bars and maps.
//!
//! Curves are told apart by colour, dash and marker together, so that a print without colour and a
//! reader who does not see it lose nothing. Colours are those of Okabe and Ito (2008).

use super::axis::{extent, limits};
use super::contour::Map;
use super::picture::{Colour, INK, Style};
use crate::body::EdgeModel;
use crate::fem::Code;
use crate::study::{Engine, Source};

/// Shape of a marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    /// A hollow circle.
    Circle,
    /// A small full circle.
    Disc,
    /// A hollow square.
    Square,
    /// A hollow triangle.
    Triangle,
    /// A diagonal cross.
    Cross,
    /// An upright cross.
    Plus,
    /// A hollow diamond.
    Diamond,
}

/// How a source is drawn, everywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// Colour of line and markers.
    pub colour: Colour,
    /// Length of dash and gap (px); `None` for a full line.
    pub dash: Option<(f64, f64)>,
    /// Shape of the markers.
    pub marker: Marker,
}

impl Look {
    /// The style of a curve.
    pub fn line(self) -> Style {
        Style::stroked(self.colour, 2.0).dashed(self.dash)
    }
}

/// The look of a source.
pub fn look(source: &Source) -> Look {
    let look = |name, rgb, dash, marker| Look { colour: Colour { name, rgb }, dash, marker };
    let dash = |dash, gap| Some((dash, gap));
    match source {
        Source::Model(EdgeModel::HalfSpace) => {
            look("c-half-space", [0xd5, 0x5e, 0x00], dash(2.0, 3.0), Marker::Triangle)
        }
        Source::Model(EdgeModel::Mirror) => {
            look("c-mirror", [0xb0, 0x60, 0x95], dash(5.0, 3.0), Marker::Cross)
        }
        Source::Model(EdgeModel::Guilbault) => {
            look("c-guilbault", [0x00, 0x8c, 0x67], dash(9.0, 4.0), Marker::Square)
        }
        Source::Model(EdgeModel::QuarterSpace) => {
            look("c-quarter-space", [0x00, 0x72, 0xb2], None, Marker::Circle)
        }
        Source::Engine(engine) if *engine == Engine::published() => {
            look("c-guilbault-cells", [0x7a, 0x5c, 0x00], dash(1.0, 2.0), Marker::Diamond)
        }
        Source::Engine(engine) => {
            let marker = match Code::ALL.map(Engine::of).iter().position(|code| code == engine) {
                Some(0) => Marker::Disc,
                Some(_) => Marker::Diamond,
                // Curves from a file.
                None => Marker::Plus,
            };
            Look { colour: INK, dash: None, marker }
        }
    }
}

/// One curve of a panel.
#[derive(Debug, Clone)]
pub struct Series {
    /// Name in the legend; curves of the same name share one entry, those without have none.
    pub name: String,
    /// How it is drawn.
    pub look: Look,
    /// Values along both axes, in the order in which they are joined.
    pub points: Vec<(f64, f64)>,
    /// Whether points are joined.
    pub line: bool,
    /// Whether points are marked.
    pub markers: bool,
    /// Where a band begins and ends at each point, in values of y.
    pub band: Option<Vec<[f64; 2]>>,
    /// Points that the axes need not make room for, such as those at a singular edge.
    pub beyond: Vec<bool>,
}

impl Series {
    /// Points that are marked and not joined.
    pub fn marks(name: &str, look: Look, points: Vec<(f64, f64)>) -> Self {
        let name = name.to_string();
        Self { name, look, points, line: false, markers: true, band: None, beyond: Vec::new() }
    }

    /// Points that are marked and joined.
    pub fn curve(name: &str, look: Look, points: Vec<(f64, f64)>) -> Self {
        Self { line: true, ..Self::marks(name, look, points) }
    }

    /// The same with a band of these half-heights around the points.
    #[must_use]
    pub fn within(self, errors: Option<Vec<f64>>) -> Self {
        let around = |(point, error): (&(f64, f64), f64)| [point.1 - error, point.1 + error];
        let band = errors.map(|errors| self.points.iter().zip(errors).map(around).collect());
        Self { band, ..self }
    }

    /// Where the band begins and ends at a point; the point's own value where there is no band.
    pub(super) fn span(&self, i: usize) -> [f64; 2] {
        let band = self.band.as_ref().and_then(|band| band.get(i));
        band.copied().unwrap_or([self.points[i].1; 2])
    }
}

/// A word at a place of a panel.
#[derive(Debug, Clone)]
pub struct Note {
    /// Values along both axes.
    pub at: (f64, f64),
    /// The word.
    pub text: String,
}

/// A straight line right across a panel with a word at its end.
#[derive(Debug, Clone)]
pub enum Rule {
    /// At a value of y.
    Horizontal(f64, String),
    /// At a value of x.
    Vertical(f64, String),
}

/// A range of x with another background.
#[derive(Debug, Clone, PartialEq)]
pub struct Shade {
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// Name in the legend.
    pub name: String,
}

/// A horizontal bar.
#[derive(Debug, Clone)]
pub struct Bar {
    /// Name beside it.
    pub name: String,
    /// Where it ends.
    pub value: f64,
    /// Colour of its border, and of its inside if `strong`.
    pub colour: Colour,
    /// Drawn full instead of hollow.
    pub strong: bool,
}

/// One pair of axes.
#[derive(Debug, Clone, Default)]
pub struct Panel {
    /// Title above the axes.
    pub title: String,
    /// Name of x, with its unit.
    pub x_label: String,
    /// Name of y, with its unit.
    pub y_label: String,
    /// Curves, the first lowest.
    pub series: Vec<Series>,
    /// Words at places.
    pub notes: Vec<Note>,
    /// Lines right across.
    pub rules: Vec<Rule>,
    /// Bars from zero along x, the first on top; they take the place of series.
    pub bars: Vec<Bar>,
    /// A scalar as bands of colour below the series, with a colour bar; its limits are the axes'.
    pub map: Option<Map>,
    /// Ranges of x that are set off from the rest; those beyond its limits are not drawn.
    pub shades: Vec<Shade>,
    /// Logarithmic axes x, y.
    pub log: (bool, bool),
    /// Names instead of numbers at x = 0, 1, ...
    pub x_names: Vec<String>,
    /// Limits of x that override those of the data.
    pub x_range: Option<(f64, f64)>,
    /// Limits of y that override those of the data.
    pub y_range: Option<(f64, f64)>,
}

impl Panel {
    /// Limits that show some values with a margin, for panels that are to be compared.
    pub fn limits_of(values: impl Iterator<Item = f64>) -> (f64, f64) {
        limits(values, false)
    }

    /// Limits of both axes.
    pub(super) fn limits(&self) -> [(f64, f64); 2] {
        if let Some(map) = &self.map {
            return map.axes.each_ref().map(|axis| match axis[..] {
                [first, .., last] => (first, last),
                _ => (0.0, 1.0),
            });
        }
        let rule = |horizontal: bool| {
            self.rules.iter().filter_map(move |r| match r {
                Rule::Horizontal(v, _) => horizontal.then_some(*v),
                Rule::Vertical(v, _) => (!horizontal).then_some(*v),
            })
        };
        if !self.bars.is_empty() {
            let values = self.bars.iter().map(|b| b.value).chain([0.0]).chain(rule(false));
            return [limits(values, false), (self.bars.len() as f64 - 0.4, -0.6)];
        }
        let xs = self.series.iter().flat_map(|s| &s.points).map(|p| p.0).chain(rule(false));
        let x = match (self.x_range, self.x_names.len()) {
            (Some(range), _) => range,
            // Curves go from border to border.
            (None, 0) if self.series.iter().any(|s| s.line) && !self.log.0 => match extent(xs) {
                (low, high) if low < high => (low, high),
                (only, _) => limits([only].into_iter(), false),
            },
            (None, 0) => limits(xs, self.log.0),
            // Room on the right for the words at the lines' ends.
            (None, n) => (-0.25, n as f64 - 0.45),
        };
        let counted = |s: &Series, i: usize| {
            let p = s.points[i].0;
            let within = p >= x.0 - 1e-9 && p <= x.1 + 1e-9;
            within && !s.beyond.get(i).copied().unwrap_or(false)
        };
        let ys = self
            .series
            .iter()
            .flat_map(|s| (0..s.points.len()).filter(|&i| counted(s, i)).flat_map(|i| s.span(i)));
        [x, self.y_range.unwrap_or_else(|| limits(ys.chain(rule(true)), self.log.1))]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_leave_room_for_counted_points_only() {
        let mut series = Series::curve(
            "s",
            look(&Engine::fenicsx().into()),
            vec![(0.0, 1.0), (1.0, 2.0), (2.0, 99.0)],
        );
        series.beyond = vec![false, false, true];
        let panel = Panel { series: vec![series.clone()], ..Default::default() };
        let [x, y] = panel.limits();
        assert!(x == (0.0, 2.0) && y.1 < 3.0 && y.0 < 1.0);
        let series = series.within(Some(vec![5.0, 0.1, 0.1]));
        let [_, y] = Panel { series: vec![series], ..Default::default() }.limits();
        assert!(y.0 < -4.0 && y.1 > 6.0 && y.1 < 7.0);
    }
}
