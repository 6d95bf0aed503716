//! Widths and outlines of letters, from DejaVu Sans.
//!
//! SVG leaves letters to its viewer, whose font is often narrower and seldom wider: what has room
//! here has room there. PNG takes the outlines.

use super::picture::Point;
use std::collections::HashMap;
use std::sync::LazyLock;

/// A line is a letter, its width and its outline as commands of an SVG path (M, L, Q), in
/// thousandths of the letters' size, y upwards from the base line.
const TABLE: &str = include_str!("font/letters.txt");

/// Width of a letter that the table does not have, in parts of the letters' size.
const UNKNOWN: f64 = 0.6;

/// A letter, in parts of its size.
#[derive(Debug, Default)]
struct Letter {
    width: f64,
    /// Closed contours; y points up.
    outline: Vec<Vec<Point>>,
}

static LETTERS: LazyLock<HashMap<char, Letter>> = LazyLock::new(|| {
    let letter = |line: &str| {
        let name = line.chars().next()?;
        Some((name, Letter::parse(&line[name.len_utf8()..])?))
    };
    TABLE.lines().filter_map(letter).collect()
});

impl Letter {
    fn parse(text: &str) -> Option<Self> {
        let thousandths = |text: &str| text.parse::<f64>().ok().map(|v| v / 1000.0);
        let mut words = text.split_whitespace().peekable();
        let mut letter = Self { width: thousandths(words.next()?)?, ..Self::default() };
        while let Some(word) = words.next() {
            let mut values = vec![thousandths(&word[1..])?];
            while let Some(word) = words.next_if(|w| !w.starts_with(['M', 'L', 'Q'])) {
                values.push(thousandths(word)?);
            }
            let contours = &mut letter.outline;
            match (&word[..1], &values[..]) {
                ("M", &[x, y]) => contours.push(vec![(x, y)]),
                ("L", &[x, y]) => contours.last_mut()?.push((x, y)),
                ("Q", &[cx, cy, x, y]) => curve(contours.last_mut()?, (cx, cy), (x, y)),
                _ => return None,
            }
        }
        Some(letter)
    }
}

/// Adds a quadratic curve from the last point as four straight lines: letters are small.
fn curve(contour: &mut Vec<Point>, control: Point, end: Point) {
    let Some(&start) = contour.last() else { return };
    contour.extend([0.25, 0.5, 0.75, 1.0].map(|t: f64| {
        let [a, b, c] = [(1.0 - t).powi(2), 2.0 * t * (1.0 - t), t * t];
        (a * start.0 + b * control.0 + c * end.0, a * start.1 + b * control.1 + c * end.1)
    }));
}

/// Width of a text of a size, in the size's unit.
pub fn width(text: &str, size: f64) -> f64 {
    size * text.chars().map(|c| LETTERS.get(&c).map_or(UNKNOWN, |l| l.width)).sum::<f64>()
}

/// Closed contours of a text, from its left end and base line on; y points down.
pub fn outline(text: &str, size: f64) -> Vec<Vec<Point>> {
    let mut pen = 0.0;
    let mut contours = Vec::new();
    for c in text.chars() {
        let Some(letter) = LETTERS.get(&c) else {
            pen += size * UNKNOWN;
            continue;
        };
        let placed = |ring: &Vec<Point>| {
            ring.iter().map(|(x, y)| (pen + size * x, -size * y)).collect::<Vec<_>>()
        };
        contours.extend(letter.outline.iter().map(placed));
        pen += size * letter.width;
    }
    contours
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_of_the_table_is_a_letter() {
        assert_eq!(LETTERS.len(), TABLE.lines().count());
        assert!("σyy / p0, ν = 0.3 × 10⁴ µm −±".chars().all(|c| LETTERS.contains_key(&c)));
        // The e has a hole: two contours.
        assert_eq!(outline("le", 10.0).len(), 3);
        assert!(width("MM", 13.0) > 2.0 * width("ii", 13.0));
    }
}
