//! A panel in its place: axes, grid, curves, bars and maps as shapes.

use super::axis::{Axis, Tick, number};
use super::contour::{Map, colour};
use super::letters;
use super::panel::{Look, Marker, Panel, Rule, Series, Shade};
use super::picture::{Anchor, FAINT, INK, PAPER, Picture, Point, Style, TEXT, Text};
use crate::base::number::{significant, with_minus_signs};

/// Room above, below and to the right of a panel's axes.
const ABOVE: f64 = 30.0;
const BELOW: f64 = 46.0;
const RIGHT: f64 = 16.0;
/// Room on the left for the label of the axis, and between numbers and axis.
const LABEL: f64 = 25.0;
pub const GAP: f64 = 6.0;
/// Height of a line of words (pixels).
const LINE: f64 = 14.0;
/// Numbers beside each other need more room than numbers above each other.
const X_NUMBER: f64 = 60.0;
const Y_NUMBER: f64 = 42.0;
/// Least distance of a curve's markers.
const MARKERS_APART: f64 = 12.0;
/// Width of a colour bar, and its distance from the map.
const COLOUR_BAR: f64 = 18.0;
const BESIDE_MAP: f64 = 22.0;

/// A panel in its place: axes in pixels of the picture.
pub struct Plot<'a> {
    panel: &'a Panel,
    /// Place of the panel's corner, room for labels of the axes included.
    corner: Point,
    /// Where that room ends on the right.
    edge: f64,
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
    /// Places a panel of some size; `left` is the room for numbers and the label of y.
    pub fn of(panel: &'a Panel, corner: Point, (width, height): Point, left: f64) -> Self {
        let [x, y] = panel.limits();
        let mut y = y_axis(panel, y, height);
        (y.from, y.to) = (y.from + corner.1, y.to + corner.1);
        let room = panel.map.as_ref().map_or(RIGHT, room_for_colours);
        let (left, right) = (corner.0 + left, corner.0 + width - room);
        let x = Axis { low: x.0, high: x.1, log: panel.log.0, from: left, to: right };
        let (top, bottom) = (corner.1 + ABOVE, corner.1 + height - BELOW);
        Self { panel, corner, edge: corner.0 + width, left, right, top, bottom, x, y }
    }

    /// Adds the panel's shapes.
    pub fn draw(&self, picture: &mut Picture) {
        for Shade { from, to, .. } in &self.panel.shades {
            let [from, to] = [from.max(self.x.low), to.min(self.x.high)];
            if from < to {
                let corners = [(from, self.top), (to, self.bottom)];
                let [a, b] = corners.map(|(x, y)| (self.x.at(x), y));
                picture.rectangle(a, b, shade());
            }
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
        if self.x.is_crowded(&x_ticks) {
            x_ticks = self.x.ticks(2.0 * X_NUMBER);
        }
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
                // A number at the very end is moved, not cut.
                let at = at.min(self.edge - 0.5 * letters::width(&text, TEXT) - 2.0);
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
        // On a line as near as they can be without touching each other; points that are not joined
        // are data.
        let mut last: Option<Point> = None;
        for p in points.filter(|p| self.x.shows(p.0) && self.y.shows(p.1)) {
            let at = (self.x.at(p.0), self.y.at(p.1));
            let apart = |l: Point| (at.0 - l.0).hypot(at.1 - l.1) >= MARKERS_APART;
            if !series.line || last.is_none_or(apart) {
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
                picture.text(Text::new(&**text, self.start_of_level(*v, nth), Anchor::Start));
            }
        }
    }

    /// Words beside their places: to the right where there is room, and moved up or down where they
    /// would lie on a point, on each other or outside the panel, with a line to their place.
    fn draw_notes(&self, picture: &mut Picture) {
        let mut taken = self.taken();
        for note in &self.panel.notes {
            let at = (self.x.at(note.at.0), self.y.at(note.at.1));
            let width = letters::width(&note.text, TEXT);
            let right = at.0 + 8.0 + width <= self.right;
            let from = if right { at.0 + 8.0 } else { at.0 - 8.0 - width };
            let free = |level: f64| {
                let apart = |&(a, b, l): &(f64, f64, f64)| {
                    from >= b || a >= from + width || (l - level).abs() >= LINE
                };
                (self.top + 7.0..=self.bottom - 7.0).contains(&level) && taken.iter().all(apart)
            };
            let steps = (0..40).map(|step| 0.5 * LINE * f64::from(step));
            let mut levels = steps.flat_map(|d| [at.1 - d, at.1 + d]);
            let level = levels.find(|l| free(*l)).unwrap_or(at.1);
            taken.push((from, from + width, level));
            let (x, anchor) =
                if right { (from, Anchor::Start) } else { (from + width, Anchor::End) };
            if (level - at.1).abs() > 0.5 * LINE {
                let away = if right { -2.0 } else { 2.0 };
                picture.line(vec![at, (x + away, level)], Style::stroked(INK, 0.7).faded(0.6));
            }
            picture.text(Text::new(&*note.text, (x, level), anchor));
        }
    }

    /// The places of points, of level lines and of their words: from, to, and height.
    fn taken(&self) -> Vec<(f64, f64, f64)> {
        let points = self.panel.series.iter().filter(|s| s.markers).flat_map(|s| &s.points);
        let mark = |p: &(f64, f64)| (self.x.at(p.0) - 5.0, self.x.at(p.0) + 5.0, self.y.at(p.1));
        let words = self.panel.rules.iter().enumerate().filter_map(|(i, rule)| match rule {
            Rule::Horizontal(v, text) => {
                let (x, y) = self.start_of_level(*v, i as f64);
                Some((x, x + letters::width(text, TEXT), y))
            }
            Rule::Vertical(..) => None,
        });
        let levels = self.panel.rules.iter().filter_map(|rule| match rule {
            Rule::Horizontal(v, _) => Some((self.left, self.right, self.y.at(*v))),
            Rule::Vertical(..) => None,
        });
        points.map(mark).chain(words).chain(levels).collect()
    }

    /// Where the word of a level line begins, the `nth` one of the panel: on the left, for points
    /// that lie so high are on the right.
    fn start_of_level(&self, v: f64, nth: f64) -> Point {
        let line = sharp(self.y.at(v));
        // Below a line that leaves no room above it.
        let y = if line - 15.0 < self.top { line + 9.0 } else { line - 8.0 };
        (self.left + 3.0 + 36.0 * nth, y)
    }
}

/// The background of a [`Shade`].
pub fn shade() -> Style {
    Style::filled(FAINT).faded(0.7)
}

/// Draws a marker.
pub fn draw_marker(picture: &mut Picture, (x, y): Point, look: Look) {
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
        Marker::Plus => {
            picture.line(place(&[(-5.0, 0.0), (5.0, 0.0)]), line);
            picture.line(place(&[(0.0, -5.0), (0.0, 5.0)]), line);
        }
    }
}

/// The axis along y of a panel of some height, from its top on.
fn y_axis(panel: &Panel, limits: (f64, f64), height: f64) -> Axis {
    let (top, bottom) = (ABOVE, height - BELOW);
    let down = panel.map.as_ref().is_some_and(|m| m.down);
    let (from, to) = if down { (top, bottom) } else { (bottom, top) };
    Axis { low: limits.0, high: limits.1, log: panel.log.1, from, to }
}

/// Room for the label of y and for numbers, or for the names of bars.
pub fn room_on_the_left(panel: &Panel, height: f64) -> f64 {
    let names = panel.bars.iter().map(|b| letters::width(&b.name, TEXT));
    let ticks = || y_axis(panel, panel.limits()[1], height).ticks(Y_NUMBER).into_iter();
    let widths = |text: Option<String>| text.map(|t| letters::width(&t, TEXT));
    let widest = if panel.bars.is_empty() {
        ticks().filter_map(|t| widths(t.text)).fold(0.0, f64::max)
    } else {
        names.fold(0.0, f64::max)
    };
    widest + GAP + if panel.y_label.is_empty() { GAP } else { LABEL }
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
}
