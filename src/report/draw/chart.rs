//! Figures: panels of curves, points, bars and maps, with one legend for all.
//!
//! Curves are told apart by colour, dash and marker together, so that a print without colour and a
//! reader who does not see it lose nothing. Colours are those of Okabe and Ito (2008).

use super::axis::{Axis, Tick, extent, limits, number};
use super::contour::{Map, colour};
use super::letters;
use super::picture::{Anchor, Colour, FAINT, INK, PAPER, Picture, Point, Style, TEXT, Text};
use crate::base::number::{significant, with_minus_signs};

/// Shape of a marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    Circle,
    Disc,
    Square,
    Triangle,
    Cross,
    Diamond,
}

/// How a source is drawn, everywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    pub colour: Colour,
    /// Length of dash and gap (px); `None` for a full line.
    pub dash: Option<(f64, f64)>,
    pub marker: Marker,
}

impl Look {
    fn line(self) -> Style {
        Style::stroked(self.colour, 2.0).dashed(self.dash)
    }
}

/// The look of a source by its name; sources that are not known look like FEM.
pub fn look(source: &str) -> Look {
    let look = |name, rgb, dash, marker| Look { colour: Colour { name, rgb }, dash, marker };
    let dash = |dash, gap| Some((dash, gap));
    match source {
        "half-space" => look("c-half-space", [0xd5, 0x5e, 0x00], dash(2.0, 3.0), Marker::Triangle),
        "mirror" => look("c-mirror", [0xb0, 0x60, 0x95], dash(5.0, 3.0), Marker::Cross),
        "guilbault" => look("c-guilbault", [0x00, 0x8c, 0x67], dash(9.0, 4.0), Marker::Square),
        "quarter-space" => look("c-quarter-space", [0x00, 0x72, 0xb2], None, Marker::Circle),
        _ => Look { colour: INK, dash: None, marker: Marker::Disc },
    }
}

/// One curve of a panel.
#[derive(Debug, Clone)]
pub struct Series {
    /// Name in the legend; curves of the same name share one entry, those without have none.
    pub name: String,
    pub look: Look,
    pub points: Vec<(f64, f64)>,
    /// Whether points are joined, and whether they are marked.
    pub line: bool,
    pub markers: bool,
    /// Half-height of a band around the points.
    pub band: Option<Vec<f64>>,
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

    /// Height of the band at a point, from and to; the point's own where there is no band.
    fn span(&self, i: usize) -> [f64; 2] {
        let half = self.band.as_ref().and_then(|b| b.get(i)).copied().unwrap_or(0.0);
        [self.points[i].1 - half, self.points[i].1 + half]
    }
}

/// A word at a place of a panel.
#[derive(Debug, Clone)]
pub struct Note {
    pub at: (f64, f64),
    pub text: String,
}

/// A straight line right across a panel with a word at its end.
#[derive(Debug, Clone)]
pub enum Rule {
    Horizontal(f64, String),
    Vertical(f64, String),
}

/// A range of x with another background.
#[derive(Debug, Clone, PartialEq)]
pub struct Shade {
    pub from: f64,
    pub to: f64,
    /// Name in the legend.
    pub name: String,
}

/// A horizontal bar.
#[derive(Debug, Clone)]
pub struct Bar {
    pub name: String,
    pub value: f64,
    pub colour: Colour,
    /// Drawn full instead of hollow.
    pub strong: bool,
}

/// One pair of axes.
#[derive(Debug, Clone, Default)]
pub struct Panel {
    pub title: String,
    pub x_label: String,
    pub y_label: String,
    pub series: Vec<Series>,
    pub notes: Vec<Note>,
    pub rules: Vec<Rule>,
    /// Bars from zero along x, the first on top; they take the place of series.
    pub bars: Vec<Bar>,
    /// A scalar as bands of colour with a colour bar; it takes the place of series.
    pub map: Option<Map>,
    /// A range of x that is set off from the rest.
    pub shade: Option<Shade>,
    /// Logarithmic axes x, y.
    pub log: (bool, bool),
    /// Names instead of numbers at x = 0, 1, ...
    pub x_names: Vec<String>,
    /// Limits that override those of the data.
    pub x_range: Option<(f64, f64)>,
    pub y_range: Option<(f64, f64)>,
}

/// A figure: a title and panels in a grid, with one legend for all.
#[derive(Debug, Clone, Default)]
pub struct Figure {
    pub title: String,
    pub columns: usize,
    pub panels: Vec<Panel>,
    /// Size of a panel (px).
    pub panel_size: (u32, u32),
}

const TITLE_HEIGHT: f64 = 34.0;
/// Where the legend begins, and the height of a row of it.
const LEGEND_LEFT: f64 = 16.0;
const LEGEND_TOP: f64 = TITLE_HEIGHT + 10.0;
const LEGEND_ROW: f64 = 26.0;
/// Length of a legend's sample, and the room between two entries.
const SAMPLE: f64 = 34.0;
const BETWEEN: f64 = 26.0;

/// Room above, below and to the right of a panel's axes.
const ABOVE: f64 = 30.0;
const BELOW: f64 = 46.0;
const RIGHT: f64 = 16.0;
/// Room on the left for the label of the axis, and between numbers and axis.
const LABEL: f64 = 25.0;
const GAP: f64 = 6.0;
/// Numbers beside each other need more room than numbers above each other.
const X_NUMBER: f64 = 60.0;
const Y_NUMBER: f64 = 42.0;
/// Least distance of a curve's markers.
const MARKERS_APART: f64 = 12.0;
/// Width of a colour bar, and its distance from the map.
const COLOUR_BAR: f64 = 18.0;
const BESIDE_MAP: f64 = 22.0;

impl Figure {
    /// A figure of one map, with the labels of its axes.
    pub fn of_map(title: String, [x_label, y_label]: [&str; 2], map: Map) -> Self {
        let (x_label, y_label) = (x_label.to_string(), y_label.to_string());
        let panel = Panel { x_label, y_label, map: Some(map), ..Panel::default() };
        Self { title, columns: 1, panels: vec![panel], panel_size: (820, 430) }
    }

    /// The figure as shapes.
    pub fn draw(&self) -> Picture {
        let columns = self.columns.max(1);
        let (width, height) = (f64::from(self.panel_size.0), f64::from(self.panel_size.1));
        let legend = self.legend(width * columns as f64);
        let top =
            TITLE_HEIGHT + legend.last().map_or(0.0, |(.., at)| at.1 - LEGEND_TOP + LEGEND_ROW);
        let rows = self.panels.len().div_ceil(columns);
        let size = (width * columns as f64, top + height * rows as f64 + 6.0);
        let mut picture = Picture::new(size, &*self.title);
        let title = Text::new(&*self.title, (14.0, 18.0), Anchor::Start);
        picture.text(Text { size: 15.0, bold: true, ..title });
        for (name, sample, (x, y)) in legend {
            sample.draw(&mut picture, (x, y));
            picture.text(Text::new(name, (x + SAMPLE + GAP, y), Anchor::Start));
        }
        // The same room on the left for all: axes stand above each other.
        let left = self.panels.iter().map(|p| p.room_on_the_left(height)).fold(0.0, f64::max);
        for (i, panel) in self.panels.iter().enumerate() {
            let place = (width * (i % columns) as f64, top + height * (i / columns) as f64);
            Plot::of(panel, place, (width, height), left).draw(&mut picture);
        }
        picture
    }

    /// The names in the legend, what they stand for, and where each entry begins; entries that leave
    /// no place for another one in `width` are followed by a new row.
    fn legend(&self, width: f64) -> Vec<(&str, Sample<'_>, Point)> {
        let series = self.panels.iter().flat_map(|p| &p.series);
        let series = series.map(|s| (s.name.as_str(), Sample::Series(s)));
        let shades = self.panels.iter().filter_map(|p| p.shade.as_ref());
        let shades = shades.map(|s| (s.name.as_str(), Sample::Shade));
        let mut all: Vec<(&str, Sample, Point)> = Vec::new();
        let (mut x, mut y) = (LEGEND_LEFT, LEGEND_TOP);
        for (name, sample) in series.chain(shades) {
            if name.is_empty() || all.iter().any(|(other, ..)| *other == name) {
                continue;
            }
            let entry = SAMPLE + GAP + letters::width(name, TEXT);
            if x > LEGEND_LEFT && x + entry > width {
                (x, y) = (LEGEND_LEFT, y + LEGEND_ROW);
            }
            all.push((name, sample, (x, y)));
            x += entry + BETWEEN;
        }
        all
    }
}

/// What stands before a name of the legend.
enum Sample<'a> {
    Series(&'a Series),
    Shade,
}

impl Sample<'_> {
    fn draw(&self, picture: &mut Picture, (x, y): Point) {
        match self {
            Sample::Series(series) => {
                if series.line {
                    picture.line(vec![(x, y), (x + SAMPLE, y)], series.look.line());
                }
                if series.markers {
                    draw_marker(picture, (x + 0.5 * SAMPLE, y), series.look);
                }
            }
            Sample::Shade => picture.rectangle((x, y - 7.0), (x + SAMPLE, y + 7.0), shade()),
        }
    }
}

/// The background of a [`Shade`].
fn shade() -> Style {
    Style::filled(FAINT).faded(0.7)
}

fn draw_marker(picture: &mut Picture, (x, y): Point, look: Look) {
    let line = Style::stroked(look.colour, 1.2);
    let hollow = Style::outlined(PAPER, look.colour, 1.2);
    let place = |points: &[Point]| points.iter().map(|(a, b)| (x + a, y + b)).collect::<Vec<_>>();
    match look.marker {
        Marker::Disc => picture.circle((x, y), 3.0, Style::filled(look.colour)),
        // Not filled: FEM's points are to be seen through it.
        Marker::Circle => picture.circle((x, y), 4.0, line),
        Marker::Square => picture.rectangle((x - 3.0, y - 3.0), (x + 3.0, y + 3.0), hollow),
        Marker::Triangle => {
            picture.area(vec![place(&[(0.0, -5.0), (4.0, 3.0), (-4.0, 3.0)])], hollow);
        }
        Marker::Diamond => {
            let corners = place(&[(0.0, -5.0), (5.0, 0.0), (0.0, 5.0), (-5.0, 0.0)]);
            picture.area(vec![corners], line);
        }
        Marker::Cross => {
            picture.line(place(&[(-4.0, -4.0), (4.0, 4.0)]), line);
            picture.line(place(&[(-4.0, 4.0), (4.0, -4.0)]), line);
        }
    }
}

impl Panel {
    /// Limits that show some values with a margin, for panels that are to be compared.
    pub fn limits_of(values: impl Iterator<Item = f64>) -> (f64, f64) {
        limits(values, false)
    }

    /// Limits of both axes.
    fn limits(&self) -> [(f64, f64); 2] {
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

    /// The axis along y of a panel of some height, from its top on.
    fn y_axis(&self, limits: (f64, f64), height: f64) -> Axis {
        let (top, bottom) = (ABOVE, height - BELOW);
        let down = self.map.as_ref().is_some_and(|m| m.down);
        let (from, to) = if down { (top, bottom) } else { (bottom, top) };
        Axis { low: limits.0, high: limits.1, log: self.log.1, from, to }
    }

    /// Room for the label of y and for numbers, or for the names of bars.
    fn room_on_the_left(&self, height: f64) -> f64 {
        let names = self.bars.iter().map(|b| letters::width(&b.name, TEXT));
        let ticks = || self.y_axis(self.limits()[1], height).ticks(Y_NUMBER).into_iter();
        let widths = |text: Option<String>| text.map(|t| letters::width(&t, TEXT));
        let widest = if self.bars.is_empty() {
            ticks().filter_map(|t| widths(t.text)).fold(0.0, f64::max)
        } else {
            names.fold(0.0, f64::max)
        };
        widest + GAP + if self.y_label.is_empty() { GAP } else { LABEL }
    }
}

/// A panel in its place: axes in pixels of the picture.
struct Plot<'a> {
    panel: &'a Panel,
    /// Place of the panel's corner, room for labels of the axes included.
    corner: Point,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    x: Axis,
    y: Axis,
}

/// The middle of the pixel at a place: lines one pixel wide are sharp there.
fn sharp(v: f64) -> f64 {
    v.floor() + 0.5
}

impl<'a> Plot<'a> {
    fn of(panel: &'a Panel, corner: Point, (width, height): Point, left: f64) -> Self {
        let [x, y] = panel.limits();
        let mut y = panel.y_axis(y, height);
        (y.from, y.to) = (y.from + corner.1, y.to + corner.1);
        let room = panel.map.as_ref().map_or(RIGHT, room_for_colours);
        let (left, right) = (corner.0 + left, corner.0 + width - room);
        let x = Axis { low: x.0, high: x.1, log: panel.log.0, from: left, to: right };
        let (top, bottom) = (corner.1 + ABOVE, corner.1 + height - BELOW);
        Self { panel, corner, left, right, top, bottom, x, y }
    }

    fn draw(&self, picture: &mut Picture) {
        if let Some(Shade { from, to, .. }) = self.panel.shade {
            let [a, b] = [from, to].map(|v| self.x.at(v.clamp(self.x.low, self.x.high)));
            picture.rectangle((a, self.top), (b, self.bottom), shade());
        }
        self.draw_grid(picture);
        self.draw_words(picture);
        if let Some(map) = &self.panel.map {
            self.draw_map(picture, map);
        }
        self.draw_bars(picture);
        self.draw_bands(picture);
        for series in &self.panel.series {
            self.draw_series(picture, series);
        }
        for (i, rule) in self.panel.rules.iter().enumerate() {
            self.draw_rule(picture, rule, i as f64);
        }
        self.draw_notes(picture);
        let corners = [(self.left, self.top), (self.right, self.bottom)];
        let [a, b] = corners.map(|(x, y)| (sharp(x), sharp(y)));
        picture.rectangle(a, b, Style::stroked(INK, 1.0));
    }

    /// Grid lines and numbers; a map has short marks in place of lines that it would hide.
    fn draw_grid(&self, picture: &mut Picture) {
        let panel = self.panel;
        let style = Style::stroked(if panel.map.is_some() { INK } else { FAINT }, 1.0);
        let line = |from: f64, to: f64| if panel.map.is_some() { (from, from) } else { (from, to) };
        let mut x_ticks = self.x.ticks(X_NUMBER);
        if !panel.x_names.is_empty() {
            let tick =
                |(i, name): (usize, &String)| Tick { value: i as f64, text: Some(name.clone()) };
            x_ticks = panel.x_names.iter().enumerate().map(tick).collect();
        }
        for tick in x_ticks {
            let at = sharp(self.x.at(tick.value));
            let (from, to) = line(self.bottom, self.top);
            let mark = if tick.text.is_some() { 5.0 } else { 0.0 };
            let style = if tick.text.is_some() { style } else { style.faded(0.5) };
            picture.line(vec![(at, from + mark), (at, to)], style);
            if let Some(text) = tick.text {
                picture.text(Text::new(text, (at, self.bottom + 14.0), Anchor::Middle));
            }
        }
        let y_ticks = if panel.bars.is_empty() { self.y.ticks(Y_NUMBER) } else { Vec::new() };
        for tick in y_ticks {
            let at = sharp(self.y.at(tick.value));
            let (from, to) = line(self.left, self.right);
            let mark = if tick.text.is_some() { 4.0 } else { 0.0 };
            let style = if tick.text.is_some() { style } else { style.faded(0.5) };
            picture.line(vec![(from - mark, at), (to, at)], style);
            if let Some(text) = tick.text {
                picture.text(Text::new(text, (self.left - GAP, at), Anchor::End));
            }
        }
    }

    /// The title and the labels of both axes.
    fn draw_words(&self, picture: &mut Picture) {
        // Bold letters are a tenth wider. A long title begins further left.
        let width = 1.1 * letters::width(&self.panel.title, TEXT);
        let at = self.left.min(self.right - width).max(self.corner.0 + GAP);
        let title = Text::new(&*self.panel.title, (at, self.top - 14.0), Anchor::Start);
        picture.text(Text { bold: true, ..title });
        let (x, y) = (0.5 * (self.left + self.right), 0.5 * (self.top + self.bottom));
        picture.text(Text::new(&*self.panel.x_label, (x, self.bottom + 33.0), Anchor::Middle));
        let label = Text::new(&*self.panel.y_label, (self.corner.0 + 12.0, y), Anchor::Middle);
        picture.text(Text { upright: true, ..label });
    }

    fn draw_map(&self, picture: &mut Picture, map: &Map) {
        let levels = map.levels();
        let place = |x: f64, y: f64| (self.x.at(x), self.y.at(y));
        let bands = levels.len() - 1;
        for (band, &level) in levels[..bands].iter().enumerate() {
            let rings = map.rings_above(level, place);
            let style = Style::filled(colour(band, bands));
            picture.area(rings.clone(), style);
            if band > 0 {
                let line = Style { fill: None, ..Style::stroked(PAPER, 0.8).faded(0.6) };
                picture.area(rings, line);
            }
        }
        if let Some(m) = map.maximum() {
            let (x, y) = place(m.at[0], m.at[1]);
            // In ink on paper, so that it is seen on every colour.
            for (colour, width, size) in [(PAPER, 5.0, 8.0), (INK, 2.0, 7.0)] {
                let style = Style::stroked(colour, width);
                picture.line(vec![(x - size, y), (x + size, y)], style);
                picture.line(vec![(x, y - size), (x, y + size)], style);
            }
            let value = with_minus_signs(&significant(m.value, 3));
            self.draw_label(picture, (x, y), &format!("max {value}"));
        }
        self.draw_colour_bar(picture, map, &levels);
    }

    /// The bands' colours with their levels and the scalar's name.
    fn draw_colour_bar(&self, picture: &mut Picture, map: &Map, levels: &[f64]) {
        let bands = levels.len() - 1;
        let left = sharp(self.right + BESIDE_MAP);
        let height = |i: usize| self.bottom - (self.bottom - self.top) * i as f64 / bands as f64;
        for band in 0..bands {
            let corners = [(left, height(band + 1)), (left + COLOUR_BAR, height(band))];
            picture.rectangle(corners[0], corners[1], Style::filled(colour(band, bands)));
        }
        for (i, text) in level_texts(levels).into_iter().enumerate() {
            let at = (left + COLOUR_BAR + GAP, height(i));
            picture.text(Text::new(text, at, Anchor::Start));
        }
        let [top, bottom] = [self.top, self.bottom].map(sharp);
        let style = Style::stroked(INK, 1.0);
        picture.rectangle((left, top), (left + COLOUR_BAR, bottom), style);
        let at = (self.right + room_for_colours(map) - 12.0, 0.5 * (self.top + self.bottom));
        let label = Text::new(&*map.label, at, Anchor::Middle);
        picture.text(Text { upright: true, ..label });
    }

    /// A word on paper beside a place of a map, within it.
    fn draw_label(&self, picture: &mut Picture, (x, y): Point, text: &str) {
        let width = letters::width(text, TEXT) + 8.0;
        let left = if x + 14.0 + width < self.right { x + 12.0 } else { x - 12.0 - width };
        let top = (y + 8.0).min(self.bottom - 22.0).max(self.top + 4.0);
        let corners = [(left, top), (left + width, top + 18.0)];
        picture.rectangle(corners[0], corners[1], Style::filled(PAPER).faded(0.85));
        picture.text(Text::new(text, (left + 4.0, top + 9.0), Anchor::Start));
    }

    fn draw_bars(&self, picture: &mut Picture) {
        for (i, bar) in self.panel.bars.iter().enumerate() {
            let [top, bottom] = [-0.32, 0.32].map(|d| sharp(self.y.at(i as f64 + d)));
            let [a, b] = [0.0, bar.value].map(|v| self.x.at(v));
            let style =
                Style { fill: bar.strong.then_some(bar.colour), ..Style::stroked(bar.colour, 1.0) };
            picture.rectangle(
                (sharp(a.min(b)), top),
                (sharp(a.max(b).max(a.min(b) + 1.0)), bottom),
                style,
            );
            let at = (self.left - GAP, 0.5 * (top + bottom));
            picture.text(Text::new(&*bar.name, at, Anchor::End));
        }
    }

    /// Bands lie below all curves.
    fn draw_bands(&self, picture: &mut Picture) {
        for series in self.panel.series.iter().filter(|s| s.band.is_some()) {
            let within = |v: f64| self.y.at(v.clamp(self.y.low, self.y.high));
            let shown = |i: &usize| self.x.shows(series.points[*i].0);
            let (lower, upper): (Vec<Point>, Vec<Point>) = (0..series.points.len())
                .filter(shown)
                .map(|i| {
                    let (x, [low, high]) = (self.x.at(series.points[i].0), series.span(i));
                    ((x, within(low)), (x, within(high)))
                })
                .unzip();
            let ring = upper.into_iter().chain(lower.into_iter().rev()).collect();
            picture.area(vec![ring], Style::filled(series.look.colour).faded(0.18));
        }
    }

    fn draw_series(&self, picture: &mut Picture, series: &Series) {
        let drawn = |p: &&(f64, f64)| self.x.takes(p.0) && self.y.takes(p.1);
        let points = series.points.iter().filter(drawn);
        if series.line {
            let pixels: Vec<Point> =
                points.clone().map(|p| (self.x.at(p.0), self.y.at(p.1))).collect();
            for part in clipped(&pixels, (self.left, self.top), (self.right, self.bottom)) {
                picture.line(part, series.look.line());
            }
        }
        if !series.markers {
            return;
        }
        // Markers as near as they can be without touching each other.
        let mut last: Option<Point> = None;
        for p in points.filter(|p| self.x.shows(p.0) && self.y.shows(p.1)) {
            let at = (self.x.at(p.0), self.y.at(p.1));
            if last.is_none_or(|l| (at.0 - l.0).hypot(at.1 - l.1) >= MARKERS_APART) {
                draw_marker(picture, at, series.look);
                last = Some(at);
            }
        }
    }

    /// A line right across; words of rules that nearly coincide stand beside each other, the
    /// `nth` further in.
    fn draw_rule(&self, picture: &mut Picture, rule: &Rule, nth: f64) {
        let style = Style::stroked(INK, 1.0).dashed(Some((6.0, 4.0)));
        match rule {
            Rule::Vertical(v, text) => {
                let x = sharp(self.x.at(*v));
                picture.line(vec![(x, self.bottom), (x, self.top)], style);
                // At the lower end, where the bars are short.
                let y = self.bottom - 10.0 - 15.0 * nth;
                let (x, anchor) = if x + 40.0 < self.right {
                    (x + 3.0, Anchor::Start)
                } else {
                    (x - 3.0, Anchor::End)
                };
                picture.text(Text::new(&**text, (x, y), anchor));
            }
            Rule::Horizontal(v, text) => {
                let y = sharp(self.y.at(*v));
                picture.line(vec![(self.left, y), (self.right, y)], style);
                let at = (self.right - 3.0 - 36.0 * nth, y - 8.0);
                picture.text(Text::new(&**text, at, Anchor::End));
            }
        }
    }

    /// Words beside their places: to the right where there is room, and moved up or down where they
    /// would lie on each other or leave the panel.
    fn draw_notes(&self, picture: &mut Picture) {
        let mut taken: Vec<(f64, f64, f64)> = Vec::new();
        for note in &self.panel.notes {
            let at = (self.x.at(note.at.0), self.y.at(note.at.1));
            let width = letters::width(&note.text, TEXT);
            let right = at.0 + 8.0 + width <= self.right;
            let from = if right { at.0 + 8.0 } else { at.0 - 8.0 - width };
            let free = |level: f64| {
                let apart = |&(a, b, l): &(f64, f64, f64)| {
                    from >= b || a >= from + width || (l - level).abs() >= 14.0
                };
                (self.top + 7.0..=self.bottom - 7.0).contains(&level) && taken.iter().all(apart)
            };
            let steps = (0..20).map(|step| 14.0 * f64::from(step));
            let mut levels = steps.flat_map(|d| [at.1 - d, at.1 + d]);
            let level = levels.find(|l| free(*l)).unwrap_or(at.1);
            taken.push((from, from + width, level));
            let (x, anchor) =
                if right { (from, Anchor::Start) } else { (from + width, Anchor::End) };
            picture.text(Text::new(&*note.text, (x, level), anchor));
        }
    }
}

/// Room on the right for a map's colour bar, its numbers and its name.
fn room_for_colours(map: &Map) -> f64 {
    let widths = level_texts(&map.levels()).into_iter().map(|t| letters::width(&t, TEXT));
    BESIDE_MAP + COLOUR_BAR + GAP + widths.fold(0.0, f64::max) + LABEL
}

fn level_texts(levels: &[f64]) -> Vec<String> {
    levels.iter().map(|v| number(*v, levels[1] - levels[0])).collect()
}

/// The parts of a line within the rectangle from `low` to `high` (Liang and Barsky 1984).
fn clipped(points: &[Point], low: Point, high: Point) -> Vec<Vec<Point>> {
    let mut parts: Vec<Vec<Point>> = Vec::new();
    let mut open = false;
    for ends in points.windows(2) {
        let (a, b) = (ends[0], ends[1]);
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for (start, step, low, high) in
            [(a.0, b.0 - a.0, low.0, high.0), (a.1, b.1 - a.1, low.1, high.1)]
        {
            if step != 0.0 {
                let (s, t) = ((low - start) / step, (high - start) / step);
                (from, to) = (from.max(s.min(t)), to.min(s.max(t)));
            } else if start < low || start > high {
                to = -1.0;
            }
        }
        if from > to {
            open = false;
            continue;
        }
        let at = |t: f64| (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1));
        match parts.last_mut() {
            Some(part) if open && from == 0.0 => part.push(at(to)),
            _ => parts.push(vec![at(from), at(to)]),
        }
        open = to == 1.0;
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_cut_where_it_leaves_the_axes() {
        let line = [(0.0, 0.0), (1.0, 2.0), (2.0, 0.0), (3.0, -4.0), (4.0, -4.0), (5.0, 0.0)];
        let parts = clipped(&line, (0.5, -1.0), (4.9, 1.0));
        let expected: [&[Point]; 3] = [
            &[(0.5, 1.0), (0.5, 1.0)],
            &[(1.5, 1.0), (2.0, 0.0), (2.25, -1.0)],
            &[(4.75, -1.0), (4.9, -0.4)],
        ];
        for (part, expected) in parts.iter().zip(expected) {
            assert_eq!(part.len(), expected.len());
            for (a, b) in part.iter().zip(expected) {
                assert!((a.0 - b.0).abs() + (a.1 - b.1).abs() < 1e-12, "{part:?}");
            }
        }
        assert_eq!(parts.len(), 3);
    }

    #[test]
    fn axes_leave_room_for_counted_points_only() {
        let mut series = Series::curve("s", look("fem"), vec![(0.0, 1.0), (1.0, 2.0), (2.0, 99.0)]);
        series.beyond = vec![false, false, true];
        let panel = Panel { series: vec![series.clone()], ..Default::default() };
        let [x, y] = panel.limits();
        assert!(x == (0.0, 2.0) && y.1 < 3.0 && y.0 < 1.0);
        series.band = Some(vec![5.0, 0.1, 0.1]);
        let [_, y] = Panel { series: vec![series], ..Default::default() }.limits();
        assert!(y.0 < -4.0 && y.1 > 6.0 && y.1 < 7.0);
    }

    #[test]
    fn a_legend_goes_on_in_a_new_row_before_it_is_cut() {
        let series = ["one", "a name of some length", "another name of some length"]
            .map(|name| Series::curve(name, look("fem"), vec![(0.0, 1.0), (1.0, 2.0)]));
        let panel = Panel { series: series.to_vec(), ..Default::default() };
        let figure = Figure { columns: 1, panels: vec![panel], ..Default::default() };
        let places = |width| figure.legend(width).iter().map(|(.., p)| *p).collect::<Vec<_>>();
        assert!(places(1000.0).iter().all(|(_, y)| *y == LEGEND_TOP));
        let [first, second, third] = places(400.0)[..] else { panic!("three names") };
        assert!(first.1 == second.1 && second.0 > first.0);
        assert_eq!(third, (LEGEND_LEFT, LEGEND_TOP + LEGEND_ROW));
    }

    #[test]
    fn a_map_has_axes_colours_and_its_maximum() {
        let axis: Vec<f64> = (0..=10).map(|i| 0.2 * f64::from(i)).collect();
        let values = axis.iter().flat_map(|z| axis.iter().map(move |y| (y - z * z).exp()));
        let (values, axes) = (values.collect(), [axis.clone(), axis.clone()]);
        let map = Map { label: "height (m)".into(), axes, down: true, values };
        let (x_label, y_label) = ("y / C".to_string(), "z / C".to_string());
        let panel = Panel { map: Some(map), x_label, y_label, ..Default::default() };
        let figure = Figure {
            columns: 1,
            panels: vec![panel],
            panel_size: (400, 300),
            ..Default::default()
        };
        let svg = figure.draw().to_svg();
        for word in ["max 7.39", "y / C", "z / C", "height (m)", ">2.0<"] {
            assert!(svg.contains(word), "{word}");
        }
        assert!(!svg.contains("NaN") && svg.len() < 20_000, "{}", svg.len());
        // Depth points down: the maximum, at z = 0, is marked at the top.
        let [_, y] = figure.panels[0].limits();
        let axis = figure.panels[0].y_axis(y, 300.0);
        assert!(axis.at(0.0) == ABOVE && axis.at(2.0) == 300.0 - BELOW);
    }
}
