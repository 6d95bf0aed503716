//! Contours of a scalar in a plane, as SVG and as PNG.
//!
//! Between the grid's points the scalar is linear along the cells' edges; bands are cut out of the
//! cells along those edges (marching squares). The colours are the anchors of viridis (van der Walt
//! and Smith, 2015), whose lightness rises with the value, so that a print without colour keeps the
//! order; lines between the bands carry it too.

use super::chart::{INK, PAPER};
use crate::base::number::{significant, with_minus_signs};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// A scalar on a grid of a plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// What is shown, and where.
    pub title: String,
    /// Labels of the axes, with units.
    pub labels: [String; 2],
    /// Label of the scalar, with its unit.
    pub value_label: String,
    /// Coordinates to the right and upwards (downwards if `down`), ascending.
    pub axes: [Vec<f64>; 2],
    /// Whether the second axis points down, as a depth does.
    pub down: bool,
    /// Values; the first axis runs fastest.
    pub values: Vec<f64>,
}

/// The scalar's largest value and its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Maximum {
    /// Coordinates along both axes.
    pub at: [f64; 2],
    /// The value.
    pub value: f64,
}

const BANDS: usize = 12;
const SIZE: (u32, u32) = (820, 460);
const LEFT: i32 = 70;
const RIGHT: i32 = 130;
const TOP: i32 = 44;
const BOTTOM: i32 = 52;
const FONT: &str = "sans-serif";

/// Anchors of viridis, evenly spaced.
const VIRIDIS: [(u8, u8, u8); 9] = [
    (68, 1, 84),
    (71, 44, 122),
    (59, 81, 139),
    (44, 113, 142),
    (33, 144, 141),
    (39, 173, 129),
    (92, 200, 99),
    (170, 220, 50),
    (253, 231, 37),
];

fn colour(share: f64) -> RGBColor {
    let place = share.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let low = (place.floor() as usize).min(VIRIDIS.len() - 2);
    let part = place - low as f64;
    let mix = |a: u8, b: u8| (f64::from(a) + part * (f64::from(b) - f64::from(a))).round() as u8;
    let (a, b) = (VIRIDIS[low], VIRIDIS[low + 1]);
    RGBColor(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

/// The part of a polygon (x, y, value) on one side of a level; values are linear along its edges.
fn cut(polygon: &[[f64; 3]], level: f64, above: bool) -> Vec<[f64; 3]> {
    let keeps = |v: f64| if above { v >= level } else { v <= level };
    let mut kept = Vec::with_capacity(polygon.len() + 2);
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        if keeps(a[2]) {
            kept.push(a);
        }
        if keeps(a[2]) != keeps(b[2]) {
            let share = (level - a[2]) / (b[2] - a[2]);
            kept.push([a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), level]);
        }
    }
    kept
}

impl Plane {
    /// The scalar's largest value on the grid. `None` where no value is finite.
    pub fn maximum(&self) -> Option<Maximum> {
        let finite = self.values.iter().enumerate().filter(|(_, v)| v.is_finite());
        let (i, &value) = finite.max_by(|a, b| a.1.total_cmp(b.1))?;
        let n = self.axes[0].len();
        Some(Maximum { at: [self.axes[0][i % n], self.axes[1][i / n]], value })
    }

    /// The plot as SVG.
    pub fn to_svg(&self) -> String {
        let mut text = String::new();
        {
            let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
            // Drawing into memory has no way to fail but a fault of this module.
            self.draw(&root).expect("a string takes every drawing");
        }
        text
    }

    /// The plot's picture elements, red, green, blue, row by row, with the width and height.
    pub fn to_pixels(&self) -> (Vec<u8>, (u32, u32)) {
        super::chart::register_font();
        let mut pixels = vec![0; 3 * (SIZE.0 * SIZE.1) as usize];
        {
            let root = BitMapBackend::with_buffer(&mut pixels, SIZE).into_drawing_area();
            self.draw(&root).expect("a buffer takes every drawing");
        }
        (pixels, SIZE)
    }

    fn draw<B: DrawingBackend>(
        &self,
        root: &DrawingArea<B, Shift>,
    ) -> Result<(), DrawingAreaErrorKind<B::ErrorType>>
    where
        B::ErrorType: 'static,
    {
        root.fill(&PAPER)?;
        let text = |size: i32, h, v| (FONT, size).into_font().color(&INK).pos(Pos::new(h, v));
        let title = text(16, HPos::Left, VPos::Top);
        root.draw(&Text::new(self.title.clone(), (LEFT, 12), title))?;
        let (right, bottom) = (SIZE.0 as i32 - RIGHT, SIZE.1 as i32 - BOTTOM);
        let ends = |axis: &[f64]| match axis {
            [first, .., last] => (*first, *last),
            _ => (0.0, 1.0),
        };
        let (a, b) = (ends(&self.axes[0]), ends(&self.axes[1]));
        let along = |(low, high): (f64, f64), v: f64, from: i32, to: i32| {
            from + ((v - low) / (high - low) * f64::from(to - from)).round() as i32
        };
        let (from, to) = if self.down { (TOP, bottom) } else { (bottom, TOP) };
        let pixel = |x: f64, y: f64| (along(a, x, LEFT, right), along(b, y, from, to));

        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for v in self.values.iter().filter(|v| v.is_finite()) {
            (low, high) = (low.min(*v), high.max(*v));
        }
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        // A scalar that is the same everywhere is one band.
        let step = ((high - low) / BANDS as f64).max(1e-12 * high.abs().max(1e-12));
        let level = |i: usize| low + i as f64 * step;
        self.draw_bands(root, &pixel, level)?;

        // The colour bar.
        let bar = right + 22;
        for i in 0..BANDS {
            let y = |i: usize| along((0.0, BANDS as f64), i as f64, bottom, TOP);
            let shade = colour((i as f64 + 0.5) / BANDS as f64);
            root.draw(&Rectangle::new([(bar, y(i + 1)), (bar + 18, y(i))], shade.filled()))?;
            if i % 2 == 0 || i + 1 == BANDS {
                let i = if i + 1 == BANDS { BANDS } else { i };
                let style = text(12, HPos::Left, VPos::Center);
                root.draw(&Text::new(significant(level(i), 3), (bar + 24, y(i)), style))?;
            }
        }
        root.draw(&Rectangle::new([(bar, TOP), (bar + 18, bottom)], INK.stroke_width(1)))?;
        let style = text(12, HPos::Left, VPos::Bottom);
        root.draw(&Text::new(self.value_label.clone(), (bar - 18, TOP - 8), style))?;

        // Axes.
        for (v, name) in ticks(a) {
            let x = along(a, v, LEFT, right);
            root.draw(&PathElement::new(vec![(x, bottom), (x, bottom + 5)], INK))?;
            root.draw(&Text::new(name, (x, bottom + 8), text(12, HPos::Center, VPos::Top)))?;
        }
        for (v, name) in ticks(b) {
            let y = along(b, v, from, to);
            root.draw(&PathElement::new(vec![(LEFT - 5, y), (LEFT, y)], INK))?;
            root.draw(&Text::new(name, (LEFT - 8, y), text(12, HPos::Right, VPos::Center)))?;
        }
        root.draw(&Rectangle::new([(LEFT, TOP), (right, bottom)], INK.stroke_width(1)))?;
        let middle = ((LEFT + right) / 2, bottom + 28);
        let style = text(13, HPos::Center, VPos::Top);
        root.draw(&Text::new(self.labels[0].clone(), middle, style))?;
        let upright = (FONT, 13)
            .into_font()
            .transform(FontTransform::Rotate270)
            .color(&INK)
            .pos(Pos::new(HPos::Center, VPos::Top));
        root.draw(&Text::new(self.labels[1].clone(), (10, (TOP + bottom) / 2), upright))?;

        // The maximum, in ink on paper so that it is seen on every colour.
        if let Some(m) = self.maximum() {
            let (x, y) = pixel(m.at[0], m.at[1]);
            for (style, size) in [(PAPER.stroke_width(5), 8), (INK.stroke_width(2), 7)] {
                root.draw(&PathElement::new(vec![(x - size, y), (x + size, y)], style))?;
                root.draw(&PathElement::new(vec![(x, y - size), (x, y + size)], style))?;
            }
            let name = format!("max {}", significant(m.value, 3));
            let width = 8 * name.len() as i32;
            let left = if x + 14 + width < right { x + 12 } else { x - 16 - width };
            let top = (y + 8).min(bottom - 22).max(TOP + 4);
            let frame = [(left, top), (left + width + 4, top + 18)];
            root.draw(&Rectangle::new(frame, PAPER.mix(0.85).filled()))?;
            let style = text(13, HPos::Left, VPos::Center);
            root.draw(&Text::new(name, (left + 4, top + 9), style))?;
        }
        Ok(())
    }

    /// Bands and the lines between them. Neighbouring cells that lie in one band become one
    /// rectangle: the plot stays small.
    fn draw_bands<B: DrawingBackend>(
        &self,
        root: &DrawingArea<B, Shift>,
        pixel: &impl Fn(f64, f64) -> (i32, i32),
        level: impl Fn(usize) -> f64,
    ) -> Result<(), DrawingAreaErrorKind<B::ErrorType>>
    where
        B::ErrorType: 'static,
    {
        let [xs, ys] = &self.axes;
        let n = xs.len();
        let band = |v: f64| {
            let step = level(1) - level(0);
            (((v - level(0)) / step).floor().max(0.0) as usize).min(BANDS - 1)
        };
        let shade = |i: usize| colour((i as f64 + 0.5) / BANDS as f64).filled();
        let mut lines: Vec<Vec<(i32, i32)>> = Vec::new();
        for j in 1..ys.len() {
            let mut run: Option<(usize, usize)> = None; // first cell and band
            let draw_run = |run: Option<(usize, usize)>, end: usize| match run {
                Some((first, of)) => {
                    let corners = [pixel(xs[first], ys[j - 1]), pixel(xs[end], ys[j])];
                    root.draw(&Rectangle::new(corners, shade(of)))
                }
                None => Ok(()),
            };
            for i in 1..n {
                let corner = |di: usize, dj: usize| {
                    let (a, b) = (i - 1 + di, j - 1 + dj);
                    [xs[a], ys[b], self.values[b * n + a]]
                };
                let cell = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                if cell.iter().any(|c| !c[2].is_finite()) {
                    draw_run(run.take(), i - 1)?;
                    continue;
                }
                let bands = cell.map(|c| band(c[2]));
                let (first, last) =
                    (bands.into_iter().min().unwrap_or(0), bands.into_iter().max().unwrap_or(0));
                if first == last {
                    if run.is_none_or(|(_, of)| of != first) {
                        draw_run(run.take(), i - 1)?;
                        run = Some((i - 1, first));
                    }
                    continue;
                }
                draw_run(run.take(), i - 1)?;
                // The lowest band fills the cell, and each higher one covers its part.
                let outline: Vec<_> = cell.iter().map(|c| pixel(c[0], c[1])).collect();
                root.draw(&Polygon::new(outline, shade(first)))?;
                for of in first + 1..=last {
                    let part = cut(&cell, level(of), true);
                    if part.len() > 2 {
                        let corners: Vec<_> = part.iter().map(|c| pixel(c[0], c[1])).collect();
                        root.draw(&Polygon::new(corners, shade(of)))?;
                    }
                    let on_level: Vec<(i32, i32)> = part
                        .iter()
                        .filter(|c| c[2] == level(of))
                        .map(|c| pixel(c[0], c[1]))
                        .collect();
                    if on_level.len() == 2 {
                        lines.push(on_level);
                    }
                }
            }
            draw_run(run, n - 1)?;
        }
        for line in lines {
            root.draw(&PathElement::new(line, PAPER.mix(0.6).stroke_width(1)))?;
        }
        Ok(())
    }
}

/// Round numbers over a range, five or so.
fn ticks((low, high): (f64, f64)) -> Vec<(f64, String)> {
    let rough = (high - low) / 5.0;
    let decade = 10f64.powf(rough.log10().floor());
    let share = rough / decade;
    let factors = [(1.5, 1.0), (3.5, 2.0), (7.5, 5.0)];
    let factor = factors.iter().find(|(limit, _)| share < *limit).map_or(10.0, |f| f.1);
    let step = decade * factor;
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last)
        .map(|i| i as f64 * step)
        .map(|v| (v, with_minus_signs(&significant(v, 3))))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane() -> Plane {
        let x: Vec<f64> = (0..=20).map(|i| f64::from(i) * 0.1 - 1.0).collect();
        let z: Vec<f64> = (0..=10).map(|i| f64::from(i) * 0.2).collect();
        let values = z
            .iter()
            .flat_map(|z| x.iter().map(move |x| (-x * x - (z - 0.8).powi(2)).exp()))
            .collect();
        Plane {
            title: "a hill".to_string(),
            labels: ["x / C".to_string(), "z / C".to_string()],
            value_label: "height".to_string(),
            axes: [x, z],
            down: true,
            values,
        }
    }

    #[test]
    fn a_cell_is_cut_along_its_edges() {
        let cell = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]];
        let upper = cut(&cell, 0.25, true);
        assert_eq!(upper, [[1.0, 0.25, 0.25], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0], [0.0, 0.25, 0.25]]);
        assert_eq!(cut(&cell, 2.0, true), Vec::<[f64; 3]>::new());
        assert_eq!(cut(&cell, 0.25, false).len(), 4);
    }

    #[test]
    fn the_maximum_is_found_and_marked() {
        let plane = plane();
        let maximum = plane.maximum().unwrap();
        assert!(maximum.at[0].abs() < 1e-12 && (maximum.at[1] - 0.8).abs() < 1e-12);
        let svg = plane.to_svg();
        assert!(svg.contains("max 1") && svg.contains("x / C") && svg.contains("height"));
        assert!(!svg.contains("NaN") && svg.len() < 400_000, "{}", svg.len());
    }

    #[test]
    fn the_picture_shows_the_hill() {
        let (pixels, (width, height)) = plane().to_pixels();
        assert_eq!(pixels.len(), 3 * (width * height) as usize);
        let at = |x: u32, y: u32| {
            let i = 3 * (y * width + x) as usize;
            [pixels[i], pixels[i + 1], pixels[i + 2]]
        };
        // Beside the summit's mark: the lightest band; in the corner: the darkest.
        let (right, bottom) = (width as i32 - RIGHT, height as i32 - BOTTOM);
        let summit =
            at(((LEFT + right) / 2) as u32 - 14, (TOP + (bottom - TOP) * 2 / 5) as u32 - 10);
        let corner = at(LEFT as u32 + 3, bottom as u32 - 3);
        let top = colour(11.5 / 12.0);
        assert_eq!(summit, [top.0, top.1, top.2]);
        assert!(corner[2] > corner[1], "{corner:?}");
        // Something dark was written into the title's place: the font is there.
        let dark = (10..32).any(|y| (LEFT as u32..LEFT as u32 + 60).any(|x| at(x, y)[0] < 90));
        assert!(dark);
    }
}
