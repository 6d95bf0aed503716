//! A picture as a list of shapes.

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
pub const HALF_HEIGHT: f64 = 0.36;

impl Text {
    /// Plain letters of the usual size.
    pub fn new(text: impl Into<String>, at: Point, anchor: Anchor) -> Self {
        Self { at, text: text.into(), size: TEXT, anchor, bold: false, upright: false }
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
    /// The shapes.
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
}
