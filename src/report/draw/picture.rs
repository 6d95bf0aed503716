//! A picture as a list of shapes, and its SVG.

use super::letters;
use super::png;
use std::fmt::Write;

/// A place in pixels, from the left and from the top.
pub type Point = (f64, f64);

/// A colour; one with a name is a part that a page may colour by its own scheme.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Colour {
    /// Name of the page's variable without its dashes; empty for a colour that stays as it is.
    pub name: &'static str,
    /// Red, green, blue.
    pub rgb: [u8; 3],
}

/// Text and axes.
pub const INK: Colour = Colour { name: "ink", rgb: [0x1a; 3] };
/// The background.
pub const PAPER: Colour = Colour { name: "paper", rgb: [0xff; 3] };
/// Grid lines.
pub const FAINT: Colour = Colour { name: "faint", rgb: [0xdd; 3] };

/// How a shape is painted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    pub fill: Option<Colour>,
    pub stroke: Option<Colour>,
    /// Width of the stroke (px).
    pub width: f64,
    /// Length of dash and gap (px); `None` for a full line.
    pub dash: Option<(f64, f64)>,
    /// 1 hides what is below, 0 is not seen.
    pub opacity: f64,
}

impl Style {
    /// The inside.
    pub fn filled(colour: Colour) -> Self {
        Self { fill: Some(colour), stroke: None, width: 0.0, dash: None, opacity: 1.0 }
    }

    /// The outline, `width` pixels wide.
    pub fn stroked(colour: Colour, width: f64) -> Self {
        Self { fill: None, stroke: Some(colour), width, dash: None, opacity: 1.0 }
    }

    /// Inside and outline.
    pub fn outlined(fill: Colour, colour: Colour, width: f64) -> Self {
        Self { fill: Some(fill), ..Self::stroked(colour, width) }
    }

    /// The same with dashes.
    pub fn dashed(self, dash: Option<(f64, f64)>) -> Self {
        Self { dash, ..self }
    }

    /// The same with what is below shining through.
    pub fn faded(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }
}

/// Which end of a text stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// A text in ink; `at` is half as high as a capital letter.
#[derive(Debug, Clone, PartialEq)]
pub struct Text {
    pub at: Point,
    pub text: String,
    /// Size of the letters (px).
    pub size: f64,
    pub anchor: Anchor,
    pub bold: bool,
    /// Read from below.
    pub upright: bool,
}

/// Usual size of letters (px).
pub const TEXT: f64 = 12.0;
/// Half the height of a capital letter in parts of the letters' size.
const HALF_HEIGHT: f64 = 0.36;

impl Text {
    /// Plain letters of the usual size.
    pub fn new(text: impl Into<String>, at: Point, anchor: Anchor) -> Self {
        Self { at, text: text.into(), size: TEXT, anchor, bold: false, upright: false }
    }

    /// Where the base line begins, if the letters are those of [`letters`].
    pub fn start(&self) -> Point {
        let share = match self.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5,
            Anchor::End => 1.0,
        };
        let (back, down) = (share * letters::width(&self.text, self.size), HALF_HEIGHT * self.size);
        let (x, y) = self.at;
        if self.upright { (x + down, y + back) } else { (x - back, y + down) }
    }
}

/// What a picture is made of.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Straight lines through points; if closed, rings whose inside is filled together (non-zero
    /// winding).
    Path {
        lines: Vec<Vec<Point>>,
        closed: bool,
        style: Style,
    },
    Circle {
        centre: Point,
        radius: f64,
        style: Style,
    },
    Text(Text),
}

/// Shapes on paper, the first lowest.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Width and height (px).
    pub size: (f64, f64),
    /// What it shows, for those who do not see it.
    pub description: String,
    pub shapes: Vec<Shape>,
}

impl Picture {
    /// Blank paper.
    pub fn new(size: (f64, f64), description: impl Into<String>) -> Self {
        let mut picture = Self { size, description: description.into(), shapes: Vec::new() };
        picture.rectangle((0.0, 0.0), size, Style::filled(PAPER));
        picture
    }

    /// A line through points.
    pub fn line(&mut self, points: Vec<Point>, style: Style) {
        self.shapes.push(Shape::Path { lines: vec![points], closed: false, style });
    }

    /// An area within rings.
    pub fn area(&mut self, rings: Vec<Vec<Point>>, style: Style) {
        self.shapes.push(Shape::Path { lines: rings, closed: true, style });
    }

    /// A rectangle between two opposite corners.
    pub fn rectangle(&mut self, a: Point, b: Point, style: Style) {
        self.area(vec![vec![a, (b.0, a.1), b, (a.0, b.1)]], style);
    }

    /// A circle.
    pub fn circle(&mut self, centre: Point, radius: f64, style: Style) {
        self.shapes.push(Shape::Circle { centre, radius, style });
    }

    /// A text.
    pub fn text(&mut self, text: Text) {
        self.shapes.push(Shape::Text(text));
    }

    /// The picture as SVG, which stands alone.
    pub fn to_svg(&self) -> String {
        self.svg(|colour| {
            let [r, g, b] = colour.rgb;
            format!("#{r:02x}{g:02x}{b:02x}")
        })
    }

    /// The picture as SVG for a page that has a variable for each named colour.
    pub fn to_themed_svg(&self) -> String {
        self.svg(|colour| match colour.name {
            "" => format!("rgb({},{},{})", colour.rgb[0], colour.rgb[1], colour.rgb[2]),
            name => format!("var(--{name})"),
        })
    }

    /// The picture as PNG.
    pub fn to_png(&self) -> Vec<u8> {
        png::encode(self)
    }

    fn svg(&self, paint: impl Fn(Colour) -> String) -> String {
        let ((w, h), label) = (self.size, escaped(&self.description));
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" \
             viewBox=\"0 0 {w} {h}\" role=\"img\" aria-label=\"{label}\" \
             font-family=\"sans-serif\">\n"
        );
        for shape in &self.shapes {
            match shape {
                Shape::Path { lines, closed, style } => {
                    let end = if *closed { "Z" } else { "" };
                    let data: String = lines.iter().map(|line| path(line) + end).collect();
                    let style = attributes(style, &paint);
                    add(&mut text, format_args!("<path d=\"{data}\"{style}/>"));
                }
                Shape::Circle { centre, radius, style } => {
                    let (x, y, r) = (short(centre.0), short(centre.1), short(*radius));
                    let style = attributes(style, &paint);
                    add(
                        &mut text,
                        format_args!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\"{style}/>"),
                    );
                }
                Shape::Text(t) => add(&mut text, format_args!("{}", letters_of(t, &paint(INK)))),
            }
        }
        text + "</svg>\n"
    }
}

/// Adds a line.
fn add(text: &mut String, line: std::fmt::Arguments) {
    writeln!(text, "{line}").expect("a string takes every text");
}

fn letters_of(t: &Text, ink: &str) -> String {
    let (x, y) = t.at;
    let down = HALF_HEIGHT * t.size;
    let place = if t.upright {
        format!("transform=\"translate({} {})rotate(-90)\"", short(x + down), short(y))
    } else {
        format!("x=\"{}\" y=\"{}\"", short(x), short(y + down))
    };
    let anchor = match t.anchor {
        Anchor::Start => "",
        Anchor::Middle => " text-anchor=\"middle\"",
        Anchor::End => " text-anchor=\"end\"",
    };
    let weight = if t.bold { " font-weight=\"bold\"" } else { "" };
    let (size, words) = (short(t.size), escaped(&t.text));
    format!("<text {place} font-size=\"{size}\"{anchor}{weight} fill=\"{ink}\">{words}</text>")
}

fn path(points: &[Point]) -> String {
    let mut text = String::new();
    for (i, (x, y)) in points.iter().enumerate() {
        text.push(if i == 0 { 'M' } else { 'L' });
        text.push_str(&short(*x));
        text.push(' ');
        text.push_str(&short(*y));
    }
    text
}

fn attributes(style: &Style, paint: &impl Fn(Colour) -> String) -> String {
    let mut text = format!(" fill=\"{}\"", style.fill.map_or("none".to_string(), paint));
    if let Some(colour) = style.stroke {
        let (colour, width) = (paint(colour), short(style.width));
        text += &format!(" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"");
    }
    if let Some((dash, gap)) = style.dash {
        text += &format!(" stroke-dasharray=\"{} {}\"", short(dash), short(gap));
    }
    if style.opacity < 1.0 {
        text += &format!(" opacity=\"{}\"", style.opacity);
    }
    text
}

/// Tenths of a pixel.
fn short(value: f64) -> String {
    let tenths = (10.0 * value).round() as i64;
    if tenths % 10 == 0 { (tenths / 10).to_string() } else { (tenths as f64 / 10.0).to_string() }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture() -> Picture {
        let mut picture = Picture::new((60.0, 40.0), "\"a\" & <b>");
        picture.line(
            vec![(1.0, 2.04), (3.06, 4.0)],
            Style::stroked(INK, 2.0).dashed(Some((5.0, 3.0))),
        );
        picture.circle(
            (5.0, 5.0),
            3.0,
            Style::filled(Colour { name: "", rgb: [1, 2, 3] }).faded(0.5),
        );
        picture.text(Text::new("x < 1", (30.0, 20.0), Anchor::Middle));
        picture
    }

    #[test]
    fn shapes_become_elements() {
        let svg = picture().to_svg();
        for part in [
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"60\" height=\"40\" viewBox=\"0 0 60 40\"",
            "aria-label=\"&quot;a&quot; &amp; &lt;b&gt;\"",
            "<path d=\"M0 0L60 0L60 40L0 40Z\" fill=\"#ffffff\"/>",
            "<path d=\"M1 2L3.1 4\" fill=\"none\" stroke=\"#1a1a1a\" stroke-width=\"2\"",
            "stroke-dasharray=\"5 3\"",
            "<circle cx=\"5\" cy=\"5\" r=\"3\" fill=\"#010203\" opacity=\"0.5\"/>",
            "text-anchor=\"middle\" fill=\"#1a1a1a\">x &lt; 1</text>",
        ] {
            assert!(svg.contains(part), "{part} in {svg}");
        }
    }

    #[test]
    fn a_page_colours_what_has_a_name() {
        let svg = picture().to_themed_svg();
        assert!(svg.contains("fill=\"var(--paper)\"") && svg.contains("stroke=\"var(--ink)\""));
        assert!(svg.contains("fill=\"rgb(1,2,3)\"") && !svg.contains('#'));
    }
}
