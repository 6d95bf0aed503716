//! A picture's SVG.

use super::picture::{Anchor, Colour, HALF_HEIGHT, INK, Picture, Point, Shape, Style, Text};
use std::fmt::Write;

impl Picture {
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
