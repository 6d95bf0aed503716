//! A figure: panels in a grid with a title and one legend for all.

use super::contour::Map;
use super::letters;
use super::panel::{Panel, Series};
use super::picture::{Anchor, Picture, Point, TEXT, Text};
use super::plot::{GAP, Plot, draw_marker, room_on_the_left, shade};

/// A figure: a title and panels in a grid, with one legend for all.
#[derive(Debug, Clone, Default)]
pub struct Figure {
    /// Title above all.
    pub title: String,
    /// Number of panels beside each other.
    pub columns: usize,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
    /// Size of a panel (px).
    pub panel_size: (u32, u32),
}

const TITLE_HEIGHT: f64 = 34.0;
/// Size of the title's letters, and how much wider bold ones are.
const TITLE: f64 = 15.0;
const BOLD: f64 = 1.15;
/// Where the legend begins, and the height of a row of it.
const LEGEND_LEFT: f64 = 16.0;
const LEGEND_TOP: f64 = TITLE_HEIGHT + 10.0;
const LEGEND_ROW: f64 = 26.0;
/// Length of a legend's sample, and the room between two entries.
const SAMPLE: f64 = 34.0;
const BETWEEN: f64 = 26.0;

impl Figure {
    /// A figure of one map, with the labels of its axes.
    pub fn of_map(title: String, [x_label, y_label]: [&str; 2], map: Map) -> Self {
        let (x_label, y_label) = (x_label.to_string(), y_label.to_string());
        let panel = Panel { x_label, y_label, map: Some(map), ..Panel::default() };
        Self { title, columns: 1, panels: vec![panel], panel_size: (820, 430) }
    }

    /// The same figure with a title above its panel, for what leaves no room beside the title.
    #[must_use]
    pub fn of_what(mut self, what: &str) -> Self {
        self.panels.iter_mut().for_each(|panel| panel.title = what.to_string());
        self
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
        // A long name is written in smaller letters rather than cut.
        let room = (size.0 - 28.0) / (BOLD * letters::width(&self.title, TITLE));
        picture.text(Text { size: TITLE * room.min(1.0), bold: true, ..title });
        for (name, sample, (x, y)) in legend {
            sample.draw(&mut picture, (x, y));
            picture.text(Text::new(name, (x + SAMPLE + GAP, y), Anchor::Start));
        }
        // The same room on the left for all: axes stand above each other.
        let left = self.panels.iter().map(|p| room_on_the_left(p, height)).fold(0.0, f64::max);
        for (i, panel) in self.panels.iter().enumerate() {
            let place = (width * (i % columns) as f64, top + height * (i / columns) as f64);
            Plot::of(panel, place, (width, height), left).draw(&mut picture);
        }
        picture
    }

    /// The names in the legend, what they stand for, and where each entry begins; entries that
    /// leave no place for another one in `width` are followed by a new row. What has no point in
    /// any panel is not named.
    fn legend(&self, width: f64) -> Vec<(&str, Sample<'_>, Point)> {
        let series = self.panels.iter().flat_map(|p| &p.series);
        let series =
            series.filter(|s| !s.points.is_empty()).map(|s| (s.name.as_str(), Sample::Series(s)));
        let shades = self.panels.iter().flat_map(|p| &p.shades);
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

#[cfg(test)]
mod tests {
    use super::super::panel::{Bar, Note, Rule, look};
    use super::super::picture::INK;
    use super::*;
    use crate::study::Engine;

    #[test]
    fn a_legend_goes_on_in_a_new_row_before_it_is_cut() {
        let series = ["one", "a name of some length", "another name of some length"].map(|name| {
            Series::curve(name, look(&Engine::fenicsx().into()), vec![(0.0, 1.0), (1.0, 2.0)])
        });
        let nothing = Series { name: "nothing".into(), points: Vec::new(), ..series[0].clone() };
        let series = [&[nothing], &series[..]].concat();
        let panel = Panel { series, ..Default::default() };
        let figure = Figure { columns: 1, panels: vec![panel], ..Default::default() };
        let places = |width| figure.legend(width).iter().map(|(.., p)| *p).collect::<Vec<_>>();
        assert!(places(1000.0).iter().all(|(_, y)| *y == LEGEND_TOP));
        let [first, second, third] = places(400.0)[..] else { panic!("three names") };
        assert!(first.1 == second.1 && second.0 > first.0);
        assert_eq!(third, (LEGEND_LEFT, LEGEND_TOP + LEGEND_ROW));
    }

    #[test]
    fn words_stand_off_level_lines_and_the_frame() {
        let rules = vec![Rule::Horizontal(1.0, "ME".into()), Rule::Horizontal(1.99, "SME".into())];
        let notes = vec![Note { at: (0.5, 1.01), text: "W".into() }];
        let look = look(&Engine::fenicsx().into());
        let series = vec![Series::marks("", look, vec![(0.5, 1.01)])];
        let (x_range, y_range) = (Some((0.0, 1.0)), Some((0.0, 2.0)));
        let panel = Panel { series, notes, rules, x_range, y_range, ..Default::default() };
        let (panels, panel_size) = (vec![panel], (380, 320));
        let svg = Figure { columns: 1, panels, panel_size, ..Default::default() }.draw().to_svg();
        let height = |text: &str| {
            let before = svg.split(&format!(">{text}<")).next().unwrap();
            let y = before.rsplit(" y=\"").next().unwrap().split('"').next().unwrap();
            y.parse::<f64>().unwrap()
        };
        // The word of the line lies 8 above it, and the note's own place 2.
        assert!((height("W") - height("ME") - 8.0).abs() > 10.0, "{}", height("W"));
        // The line lies on the frame, and its word below it.
        assert!(height("SME") > height("2.0"), "{}", height("SME"));
    }

    #[test]
    fn a_long_title_is_not_cut() {
        let title = |name: &str| Figure { title: name.into(), columns: 1, ..Default::default() };
        let size = |name: &str| {
            let panels = vec![Panel::default()];
            let svg = Figure { panels, panel_size: (820, 430), ..title(name) }.draw().to_svg();
            let before = svg.split(&format!(">{name}<")).next().unwrap();
            let size = before.rsplit("font-size=\"").next().unwrap().split('"').next().unwrap();
            size.parse::<f64>().unwrap()
        };
        assert_eq!(size("flush-short"), TITLE);
        let long = "W".repeat(64);
        assert!(letters::width(&long, size(&long)) < 780.0 && size(&long) > 8.0);
    }

    #[test]
    fn a_number_at_the_right_end_is_not_cut() {
        let bar = |value| Bar { name: String::new(), value, colour: INK, strong: true };
        let panel = Panel { bars: vec![bar(0.002_499), bar(0.001)], ..Default::default() };
        let figure = Figure {
            columns: 1,
            panels: vec![panel],
            panel_size: (380, 300),
            ..Default::default()
        };
        let svg = figure.draw().to_svg();
        let before = svg.split(">0.0025<").next().unwrap();
        let x = before.rsplit(" x=\"").next().unwrap().split('"').next().unwrap();
        let right = x.parse::<f64>().unwrap() + 0.5 * letters::width("0.0025", TEXT);
        assert!(right < 380.0 && right > 360.0, "{right}");
    }

    #[test]
    fn a_map_has_axes_colours_and_its_maximum() {
        let axis: Vec<f64> = (0..=10).map(|i| 0.2 * f64::from(i)).collect();
        let values = axis.iter().flat_map(|z| axis.iter().map(move |y| (y - z * z).exp()));
        let (values, axes) = (values.collect(), [axis.clone(), axis.clone()]);
        let map =
            Map { label: "height (m)".into(), axes, down: true, values, limit: f64::INFINITY };
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
        let height = |text: &str| {
            let before = svg.split(text).next().unwrap();
            let y = before.rsplit(" y=\"").next().unwrap().split('"').next().unwrap();
            y.parse::<f64>().unwrap()
        };
        assert!(height(">max 7.39") < height(">y / C") - 50.0);
    }
}
