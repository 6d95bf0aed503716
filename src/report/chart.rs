//! Panels of curves, points and bars as SVG.
//!
//! Curves are told apart by colour, dash and marker together, so that a print without colour and a
//! reader who does not see it lose nothing. Colours are those of Okabe and Ito (2008). Colours that
//! mean "ink" and "paper" are written as [`INK`] and [`PAPER`], which the page replaces by its own
//! scheme's.

use crate::base::number::{fixed, significant, with_minus_signs};
use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// The colour of text and axes.
pub const INK: RGBColor = RGBColor(0x1a, 0x1a, 0x1a);
/// The colour of the background.
pub const PAPER: RGBColor = RGBColor(0xff, 0xff, 0xff);
/// The colour of grid lines.
pub const FAINT: RGBColor = RGBColor(0xdd, 0xdd, 0xdd);

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
    pub colour: RGBColor,
    /// Length of dash and gap (px); `None` for a full line.
    pub dash: Option<(i32, i32)>,
    pub marker: Marker,
}

/// The look of a source by its name; sources that are not known look like FEM.
pub fn look(source: &str) -> Look {
    let look = |r, g, b, dash, marker| Look { colour: RGBColor(r, g, b), dash, marker };
    match source {
        "half-space" => look(0xd5, 0x5e, 0x00, Some((2, 3)), Marker::Triangle),
        "mirror" => look(0xb0, 0x60, 0x95, Some((5, 3)), Marker::Cross),
        "guilbault" => look(0x00, 0x8c, 0x67, Some((9, 4)), Marker::Square),
        "quarter-space" => look(0x00, 0x72, 0xb2, None, Marker::Circle),
        _ => Look { colour: INK, dash: None, marker: Marker::Disc },
    }
}

/// One curve of a panel.
#[derive(Debug, Clone)]
pub struct Series {
    /// Name in the legend; curves of the same name share one entry.
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

    /// Indices of the points that the axes make room for.
    fn counted(&self) -> impl Iterator<Item = usize> {
        (0..self.points.len()).filter(|&i| !self.beyond.get(i).copied().unwrap_or(false))
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
    /// Logarithmic axes x, y.
    pub log: (bool, bool),
    /// Names instead of numbers at x = 0, 1, ...
    pub x_names: Vec<String>,
    /// Limits that override those of the data.
    pub x_range: Option<(f64, f64)>,
}

/// A horizontal bar.
#[derive(Debug, Clone)]
pub struct Bar {
    pub name: String,
    pub value: f64,
    /// Drawn full instead of hollow.
    pub strong: bool,
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

const FONT: &str = "sans-serif";

/// Makes the built-in font known for pictures; SVG leaves letters to its viewer. It has no bold
/// letters of its own.
pub fn register_font() {
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| {
        for style in [FontStyle::Normal, FontStyle::Bold] {
            let font = include_bytes!("font/labels.ttf");
            // The only fault that there is would be a font that cannot be parsed.
            if plotters::style::register_font(FONT, style, font).is_err() {
                unreachable!("the built-in font can be parsed");
            }
        }
    });
}

const TITLE_HEIGHT: i32 = 34;
/// Where the legend begins, and the height of a row of it.
const LEGEND_LEFT: i32 = 16;
const LEGEND_TOP: i32 = TITLE_HEIGHT + 10;
const LEGEND_HEIGHT: i32 = 26;
/// Mean width of a character relative to the font's size, as SVG viewers' sans-serif has it.
const CHARACTER: f64 = 0.55;

type Fault = DrawingAreaErrorKind<std::io::Error>;

impl Figure {
    /// Draws the figure as SVG.
    pub fn to_svg(&self) -> String {
        let rows = self.panels.len().div_ceil(self.columns.max(1));
        let width = self.panel_size.0 * self.columns as u32;
        let legend = self.legend(width as i32);
        let legend_height = legend.last().map_or(0, |(_, (_, y))| y - LEGEND_TOP + LEGEND_HEIGHT);
        let height = self.panel_size.1 * rows as u32 + (TITLE_HEIGHT + legend_height) as u32 + 6;
        let mut text = String::new();
        {
            let root = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
            // Drawing into a string has no way to fail but a fault of this module.
            self.draw(&root, &legend, legend_height).expect("a string takes every drawing");
        }
        text
    }

    /// The first series of every name, and where its entry begins; entries that leave no place for another one in
    /// `width` are followed by a new row.
    fn legend(&self, width: i32) -> Vec<(&Series, (i32, i32))> {
        let mut all: Vec<&Series> = Vec::new();
        for s in self.panels.iter().flat_map(|p| &p.series).filter(|s| !s.name.is_empty()) {
            if !all.iter().any(|a| a.name == s.name) {
                all.push(s);
            }
        }
        let (mut x, mut y) = (LEGEND_LEFT, LEGEND_TOP);
        let place = |s: &Series| {
            let entry = 40 + (s.name.len() as f64 * 13.0 * CHARACTER) as i32;
            if x > LEGEND_LEFT && x + entry > width {
                (x, y) = (LEGEND_LEFT, y + LEGEND_HEIGHT);
            }
            let place = (x, y);
            x += entry + 26;
            place
        };
        let places: Vec<(i32, i32)> = all.iter().copied().map(place).collect();
        all.into_iter().zip(places).collect()
    }

    fn draw<B: DrawingBackend<ErrorType = std::io::Error>>(
        &self,
        root: &DrawingArea<B, Shift>,
        legend: &[(&Series, (i32, i32))],
        legend_height: i32,
    ) -> Result<(), Fault> {
        root.fill(&PAPER)?;
        let bold = FontDesc::new(FontFamily::Name(FONT), 16.0, FontStyle::Bold).color(&INK);
        root.draw(&Text::new(self.title.clone(), (14, 10), bold))?;
        for &(s, (x, y)) in legend {
            draw_line(root, &[(x, y), (x + 34, y)], s.look, s.line)?;
            if s.markers {
                draw_marker(root, (x + 17, y), s.look)?;
            }
            let style = (FONT, 13).into_font().color(&INK).pos(Pos::new(HPos::Left, VPos::Center));
            root.draw(&Text::new(s.name.clone(), (x + 40, y), style))?;
        }
        let (_, body) = root.split_vertically(TITLE_HEIGHT + legend_height);
        let rows = self.panels.len().div_ceil(self.columns.max(1));
        for (panel, area) in self.panels.iter().zip(body.split_evenly((rows, self.columns))) {
            panel.draw(&area)?;
        }
        Ok(())
    }
}

/// A line in pixels, dashed by hand: short segments between points would otherwise lose the
/// pattern.
fn draw_line<B: DrawingBackend<ErrorType = std::io::Error>>(
    area: &DrawingArea<B, Shift>,
    points: &[(i32, i32)],
    look: Look,
    visible: bool,
) -> Result<(), Fault> {
    if !visible || points.len() < 2 {
        return Ok(());
    }
    let style = look.colour.stroke_width(2);
    match look.dash {
        None => area.draw(&PathElement::new(points.to_vec(), style)),
        Some((dash, gap)) => area.draw(&DashedPathElement::new(points.to_vec(), dash, gap, style)),
    }
}

fn draw_marker<B: DrawingBackend<ErrorType = std::io::Error>>(
    area: &DrawingArea<B, Shift>,
    (x, y): (i32, i32),
    look: Look,
) -> Result<(), Fault> {
    let line = look.colour.stroke_width(1);
    let paper = PAPER.filled();
    match look.marker {
        Marker::Disc => area.draw(&Circle::new((x, y), 3, look.colour.filled())),
        Marker::Circle => {
            // Not filled: FEM's points are to be seen through it.
            area.draw(&Circle::new((x, y), 4, line))
        }
        Marker::Square => {
            area.draw(&Rectangle::new([(x - 3, y - 3), (x + 3, y + 3)], paper))?;
            area.draw(&Rectangle::new([(x - 3, y - 3), (x + 3, y + 3)], line))
        }
        Marker::Triangle => {
            let corners = vec![(x, y - 5), (x + 4, y + 3), (x - 4, y + 3)];
            area.draw(&Polygon::new(corners.clone(), paper))?;
            let outline: Vec<_> = corners.iter().chain(&corners[..1]).copied().collect();
            area.draw(&PathElement::new(outline, line))
        }
        Marker::Diamond => {
            let corners = vec![(x, y - 5), (x + 5, y), (x, y + 5), (x - 5, y), (x, y - 5)];
            area.draw(&PathElement::new(corners, line))
        }
        Marker::Cross => {
            area.draw(&PathElement::new(vec![(x - 4, y - 4), (x + 4, y + 4)], line))?;
            area.draw(&PathElement::new(vec![(x - 4, y + 4), (x + 4, y - 4)], line))
        }
    }
}

/// Number of an axis, as short as it can be.
fn tick(value: f64, step: f64) -> String {
    if value.abs() < 1e-9 * step.abs() {
        return "0".to_string();
    }
    if step.abs() < 0.99e-5 || value.abs() >= 1e5 {
        return with_minus_signs(&significant(value, 2));
    }
    let digits = (-step.abs().log10().floor()).clamp(0.0, 6.0) as usize;
    with_minus_signs(&fixed(value, digits))
}

/// A round step that divides a range into about `parts` parts.
fn nice_step(low: f64, high: f64, parts: f64) -> f64 {
    let rough = (high - low) / parts;
    let decade = 10f64.powf(rough.log10().floor());
    let share = rough / decade;
    decade
        * if share < 1.5 {
            1.0
        } else if share < 3.5 {
            2.0
        } else if share < 7.5 {
            5.0
        } else {
            10.0
        }
}

/// An axis in pixels.
struct Axis {
    low: f64,
    high: f64,
    log: bool,
    from: i32,
    to: i32,
}

impl Axis {
    fn at(&self, value: f64) -> i32 {
        let share = if self.log {
            (value.max(1e-300).ln() - self.low.ln()) / (self.high.ln() - self.low.ln())
        } else {
            (value - self.low) / (self.high - self.low)
        };
        self.from + (share * f64::from(self.to - self.from)).round() as i32
    }

    fn ticks(&self) -> Vec<(f64, String)> {
        if self.log {
            let (low, high) = (self.low.log10(), self.high.log10());
            let minor: &[f64] = if high - low > 2.5 { &[1.0] } else { &[1.0, 2.0, 5.0] };
            let mut all = Vec::new();
            for decade in low.floor() as i32..=high.ceil() as i32 {
                for m in minor {
                    let v = m * 10f64.powi(decade);
                    if v >= self.low * 0.999 && v <= self.high * 1.001 {
                        let text = if (-3..4).contains(&decade) {
                            tick(v, v)
                        } else {
                            format!("{m}e{decade}")
                        };
                        all.push((v, text));
                    }
                }
            }
            return all;
        }
        // Numbers beside each other need more room than numbers above each other.
        let sideways = self.to > self.from;
        let room = f64::from((self.to - self.from).abs()) / if sideways { 60.0 } else { 42.0 };
        let step = nice_step(self.low, self.high, room.clamp(2.0, 6.0));
        let first = (self.low / step - 1e-9).ceil() as i64;
        let last = (self.high / step + 1e-9).floor() as i64;
        (first..=last).map(|i| (i as f64 * step, tick(i as f64 * step, step))).collect()
    }
}

/// Limits of some values with a margin; a log axis takes positive values only.
fn limits(values: impl Iterator<Item = f64>, log: bool) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for v in values.filter(|v| v.is_finite() && (!log || *v > 0.0)) {
        (low, high) = (low.min(v), high.max(v));
    }
    if low > high {
        return if log { (1.0, 10.0) } else { (0.0, 1.0) };
    }
    if log {
        return (low / 1.6, high * 1.6);
    }
    // Nothing but rounding is between them, the stress sums' single precision included: a flat line in the middle.
    if high - low < (1e-9 * high.abs()).max(1e-7) {
        let half = 0.1 * high.abs().max(1e-3);
        return (low - half, high + half);
    }
    let margin = 0.06 * (high - low);
    // A quantity that has no negative values gets no negative axis.
    (if low == 0.0 { 0.0 } else { low - margin }, high + margin)
}

impl Panel {
    fn axes(&self, width: i32, height: i32, left: i32) -> (Axis, Axis) {
        let (x_low, x_high) = self.x_range.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        let shown = move |p: &&(f64, f64)| p.0 >= x_low - 1e-9 && p.0 <= x_high + 1e-9;
        let points = || self.series.iter().flat_map(|s| &s.points);
        let counted = || self.series.iter().flat_map(|s| s.counted().map(|i| &s.points[i]));
        let vertical = self.rules.iter().filter_map(|r| match r {
            Rule::Vertical(v, _) => Some(*v),
            Rule::Horizontal(..) => None,
        });
        let horizontal = self.rules.iter().filter_map(|r| match r {
            Rule::Horizontal(v, _) => Some(*v),
            Rule::Vertical(..) => None,
        });
        let (mut x, y) = if self.bars.is_empty() {
            let bands = self.series.iter().flat_map(|s| {
                let band = s.band.as_deref().unwrap_or_default();
                let pairs = s.counted().filter_map(|i| Some((s.points[i], band.get(i)?)));
                pairs.filter(|(p, _)| shown(&p)).flat_map(|(p, e)| [p.1 - e, p.1 + e])
            });
            let x = limits(points().map(|p| p.0).chain(vertical), self.log.0);
            let y = counted().filter(shown).map(|p| p.1);
            (x, limits(y.chain(bands).chain(horizontal), self.log.1))
        } else {
            let bars = self.bars.iter().map(|b| b.value).chain([0.0]);
            (limits(bars.chain(vertical), false), (self.bars.len() as f64 - 0.4, -0.6))
        };
        if !self.x_names.is_empty() {
            // Room on the right for the words at the lines' ends.
            x = (-0.25, self.x_names.len() as f64 - 0.45);
        }
        let (x_low, x_high) = self.x_range.unwrap_or(x);
        (
            Axis { low: x_low, high: x_high, log: self.log.0, from: left, to: width - 16 },
            Axis { low: y.0, high: y.1, log: self.log.1, from: height - 46, to: 30 },
        )
    }

    fn draw<B: DrawingBackend<ErrorType = std::io::Error>>(
        &self,
        area: &DrawingArea<B, Shift>,
    ) -> Result<(), Fault> {
        let (width, height) = area.dim_in_pixel();
        let (width, height) = (width as i32, height as i32);
        let longest = self.bars.iter().map(|b| b.name.len()).max();
        // Room for the axis label and for numbers of seven characters.
        let left = longest.map_or(78, |n| (n as f64 * 12.0 * CHARACTER) as i32 + 22);
        let (x, y) = self.axes(width, height, left);
        let small = |h, v| (FONT, 13).into_font().color(&INK).pos(Pos::new(h, v));

        // Grid, ticks and frame.
        let x_ticks: Vec<(f64, String)> = if self.x_names.is_empty() {
            x.ticks()
        } else {
            self.x_names.iter().enumerate().map(|(i, n)| (i as f64, n.clone())).collect()
        };
        for (v, text) in x_ticks {
            let at = x.at(v);
            area.draw(&PathElement::new(vec![(at, y.to), (at, y.from)], FAINT))?;
            let style = small(HPos::Center, VPos::Top);
            area.draw(&Text::new(text, (at, y.from + 6), style))?;
        }
        if self.bars.is_empty() {
            for (v, text) in y.ticks() {
                let at = y.at(v);
                area.draw(&PathElement::new(vec![(x.from, at), (x.to, at)], FAINT))?;
                let style = small(HPos::Right, VPos::Center);
                area.draw(&Text::new(text, (x.from - 6, at), style))?;
            }
        }
        let title = FontDesc::new(FontFamily::Name(FONT), 14.0, FontStyle::Bold).color(&INK);
        area.draw(&Text::new(self.title.clone(), (x.from, 8), title))?;
        area.draw(&Text::new(
            self.x_label.clone(),
            ((x.from + x.to) / 2, y.from + 24),
            small(HPos::Center, VPos::Top),
        ))?;
        let upright = (FONT, 13)
            .into_font()
            .transform(FontTransform::Rotate270)
            .color(&INK)
            .pos(Pos::new(HPos::Center, VPos::Top));
        area.draw(&Text::new(self.y_label.clone(), (6, (y.from + y.to) / 2), upright))?;

        self.draw_bars(area, &x, &y)?;
        self.draw_series(area, &x, &y)?;

        for (i, rule) in self.rules.iter().enumerate() {
            let style = INK.stroke_width(1);
            // Words of rules that nearly coincide stand beside each other.
            let i = i as i32;
            let (ends, at, text, pos) = match rule {
                Rule::Vertical(v, text) => {
                    // At the lower end, where the bars are short.
                    let at = x.at(*v);
                    let room = at + 40 < x.to;
                    let (place, side) =
                        if room { (at + 3, HPos::Left) } else { (at - 3, HPos::Right) };
                    let pos = Pos::new(side, VPos::Bottom);
                    (vec![(at, y.from), (at, y.to)], (place, y.from - 3 - 15 * i), text, pos)
                }
                Rule::Horizontal(v, text) => {
                    let at = y.at(*v);
                    let pos = Pos::new(HPos::Right, VPos::Bottom);
                    (vec![(x.from, at), (x.to, at)], (x.to - 3 - 34 * i, at - 2), text, pos)
                }
            };
            area.draw(&DashedPathElement::new(ends, 6, 4, style))?;
            let style = (FONT, 12).into_font().color(&INK).pos(pos);
            area.draw(&Text::new(text.clone(), at, style))?;
        }
        self.draw_notes(area, &x, &y)?;
        area.draw(&Rectangle::new([(x.from, y.to), (x.to, y.from)], INK.stroke_width(1)))
    }

    /// Words beside their places: to the right where there is room, and moved up or down where they
    /// would lie on each other or leave the panel.
    fn draw_notes<B: DrawingBackend<ErrorType = std::io::Error>>(
        &self,
        area: &DrawingArea<B, Shift>,
        x: &Axis,
        y: &Axis,
    ) -> Result<(), Fault> {
        let mut taken: Vec<(i32, i32, i32)> = Vec::new();
        for note in &self.notes {
            let at = (x.at(note.at.0), y.at(note.at.1));
            let width = (note.text.chars().count() as f64 * 12.0 * CHARACTER) as i32;
            let right = at.0 + 8 + width <= x.to;
            let from = if right { at.0 + 8 } else { at.0 - 8 - width };
            let free = |level: i32| {
                let apart = |&(a, b, l): &(i32, i32, i32)| {
                    from >= b || a >= from + width || (l - level).abs() >= 13
                };
                (y.to + 6..=y.from - 6).contains(&level) && taken.iter().all(apart)
            };
            let levels = (0..20).flat_map(|step| [at.1 - 13 * step, at.1 + 13 * step]);
            let level = levels.into_iter().find(|l| free(*l)).unwrap_or(at.1);
            taken.push((from, from + width, level));
            let (place, side) =
                if right { (at.0 + 8, HPos::Left) } else { (at.0 - 8, HPos::Right) };
            let style = (FONT, 13).into_font().color(&INK).pos(Pos::new(side, VPos::Center));
            area.draw(&Text::new(note.text.clone(), (place, level), style))?;
        }
        Ok(())
    }

    fn draw_bars<B: DrawingBackend<ErrorType = std::io::Error>>(
        &self,
        area: &DrawingArea<B, Shift>,
        x: &Axis,
        y: &Axis,
    ) -> Result<(), Fault> {
        let colour = look("quarter-space").colour;
        for (i, bar) in self.bars.iter().enumerate() {
            let (top, bottom) = (y.at(i as f64 - 0.32), y.at(i as f64 + 0.32));
            let (a, b) = (x.at(0.0).min(x.at(bar.value)), x.at(0.0).max(x.at(bar.value)));
            let box_ = [(a, top), (b.max(a + 1), bottom)];
            if bar.strong {
                area.draw(&Rectangle::new(box_, colour.filled()))?;
            }
            area.draw(&Rectangle::new(box_, colour.stroke_width(1)))?;
            let style = (FONT, 13).into_font().color(&INK).pos(Pos::new(HPos::Right, VPos::Center));
            let at = (x.from - 6, (top + bottom) / 2);
            area.draw(&Text::new(bar.name.clone(), at, style))?;
        }
        Ok(())
    }

    fn draw_series<B: DrawingBackend<ErrorType = std::io::Error>>(
        &self,
        area: &DrawingArea<B, Shift>,
        x: &Axis,
        y: &Axis,
    ) -> Result<(), Fault> {
        let inside = |p: &(f64, f64)| {
            let on = |axis: &Axis, v: f64| v.is_finite() && (!axis.log || v > 0.0);
            on(x, p.0) && on(y, p.1) && p.0 >= x.low - 1e-9 && p.0 <= x.high + 1e-9
        };
        for s in &self.series {
            if let Some(band) = &s.band {
                let pairs = || s.points.iter().zip(band).filter(|(p, _)| inside(p));
                let within = |v: f64| y.at(v.clamp(y.low, y.high));
                let upper = pairs().map(|(p, e)| (x.at(p.0), within(p.1 + e)));
                let lower = pairs().map(|(p, e)| (x.at(p.0), within(p.1 - e)));
                let lower: Vec<_> = lower.collect();
                let outline: Vec<_> = upper.chain(lower.into_iter().rev()).collect();
                area.draw(&Polygon::new(outline, s.look.colour.mix(0.18).filled()))?;
            }
        }
        for s in &self.series {
            let points: Vec<(f64, f64)> = s.points.iter().filter(|p| inside(p)).copied().collect();
            let pixel = |p: (f64, f64)| (x.at(p.0), y.at(p.1));
            for run in clipped(&points, y.low, y.high) {
                let pixels: Vec<(i32, i32)> = run.into_iter().map(pixel).collect();
                draw_line(area, &pixels, s.look, s.line)?;
            }
            if !s.markers {
                continue;
            }
            // Markers as near as they can be without touching each other.
            let mut last: Option<(i32, i32)> = None;
            for p in points.into_iter().filter(|p| p.1 >= y.low && p.1 <= y.high).map(pixel) {
                let far = |(a, b): (i32, i32)| (p.0 - a).pow(2) + (p.1 - b).pow(2) >= 12 * 12;
                if last.is_none_or(far) {
                    draw_marker(area, p, s.look)?;
                    last = Some(p);
                }
            }
        }
        Ok(())
    }
}

/// The parts of a polyline between two heights, cut where it leaves them.
fn clipped(points: &[(f64, f64)], low: f64, high: f64) -> Vec<Vec<(f64, f64)>> {
    let mut runs: Vec<Vec<(f64, f64)>> = vec![Vec::new()];
    let inside = |p: (f64, f64)| p.1 >= low && p.1 <= high;
    let cut = |a: (f64, f64), b: (f64, f64)| {
        let level = if a.1.max(b.1) > high { high } else { low };
        let share = (level - a.1) / (b.1 - a.1);
        (a.0 + share * (b.0 - a.0), level)
    };
    for (i, &p) in points.iter().enumerate() {
        let before = i.checked_sub(1).map(|j| points[j]);
        match (before.filter(|&q| inside(q) != inside(p)), inside(p)) {
            (Some(q), true) => runs.push(vec![cut(q, p), p]),
            (Some(q), false) => {
                if let Some(run) = runs.last_mut() {
                    run.push(cut(q, p));
                }
            }
            (None, true) => {
                if let Some(run) = runs.last_mut() {
                    run.push(p);
                }
            }
            (None, false) => {}
        }
    }
    runs.retain(|r| r.len() > 1);
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_cut_where_it_leaves_the_axes() {
        let runs = clipped(&[(0.0, 0.0), (1.0, 2.0), (2.0, 0.0), (3.0, -4.0)], -1.0, 1.0);
        let expected: [&[(f64, f64)]; 2] =
            [&[(0.0, 0.0), (0.5, 1.0)], &[(1.5, 1.0), (2.0, 0.0), (2.25, -1.0)]];
        assert_eq!(runs, expected);
    }

    #[test]
    fn axes_leave_room_for_counted_points_only() {
        let mut series = Series::curve("s", look("fem"), vec![(0.0, 1.0), (1.0, 2.0), (2.0, 99.0)]);
        series.beyond = vec![false, false, true];
        let panel = Panel { series: vec![series], ..Default::default() };
        let (x, y) = panel.axes(400, 300, 60);
        assert!(x.high > 2.0 && y.high < 3.0 && y.low < 1.0);
    }

    #[test]
    fn rounding_is_drawn_as_a_flat_line() {
        let (low, high) = limits([-2e-8, 0.0, 1e-8].into_iter(), false);
        assert!(low < -1e-5 && high > 1e-5);
        let (low, high) = limits([-2e-6, 0.0, 1e-6].into_iter(), false);
        assert!(low > -3e-6 && high < 2e-6);
    }

    #[test]
    fn a_legend_goes_on_in_a_new_row_before_it_is_cut() {
        let series = ["one", "a name of some length", "another name of some length"]
            .map(|name| Series::curve(name, look("fem"), vec![(0.0, 1.0), (1.0, 2.0)]));
        let panel = Panel { series: series.to_vec(), ..Default::default() };
        let figure = Figure { columns: 1, panels: vec![panel], ..Default::default() };
        let places = |width| figure.legend(width).iter().map(|(_, p)| *p).collect::<Vec<_>>();
        assert!(places(1000).iter().all(|(_, y)| *y == LEGEND_TOP));
        let [first, second, third] = places(400)[..] else { panic!("three names") };
        assert!(first.1 == second.1 && second.0 > first.0);
        assert_eq!(third, (LEGEND_LEFT, LEGEND_TOP + LEGEND_HEIGHT));
    }

    #[test]
    fn ticks_are_round_and_spelt_out() {
        let axis = Axis { low: -0.11, high: 0.42, log: false, from: 0, to: 300 };
        let texts: Vec<String> = axis.ticks().into_iter().map(|t| t.1).collect();
        assert_eq!(texts, ["\u{2212}0.1", "0", "0.1", "0.2", "0.3", "0.4"]);
        let log = Axis { low: 2e-5, high: 3.0, log: true, from: 0, to: 300 };
        let texts: Vec<String> = log.ticks().into_iter().map(|t| t.1).collect();
        assert_eq!(texts, ["1e-4", "0.001", "0.01", "0.1", "1"]);
    }
}
