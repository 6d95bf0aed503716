//! A picture's PNG: shapes become polygons, whose cover of each pixel mixes their colour in.
//!
//! The file is a signature and three chunks, by hand: the usual crate costs more time to build than
//! all else that draws.

use super::letters;
use super::picture::{Anchor, Colour, HALF_HEIGHT, INK, Picture, Point, Shape, Style, Text};
use ab_glyph_rasterizer::{Rasterizer, point};

impl Picture {
    /// The picture as PNG, three bytes a pixel.
    pub fn to_png(&self) -> Vec<u8> {
        encode(&Pixels::of(self))
    }
}

fn encode(pixels: &Pixels) -> Vec<u8> {
    let (width, height) = (pixels.width as u32, pixels.height as u32);
    // Eight bits a channel, red green blue, the only compression, filter and order there are.
    let header: Vec<u8> = [width.to_be_bytes(), height.to_be_bytes()]
        .concat()
        .into_iter()
        .chain([8, 2, 0, 0, 0])
        .collect();
    // Each row begins with its filter: none.
    let rows: Vec<u8> =
        pixels.bytes.chunks(3 * pixels.width).flat_map(|row| [&[0], row].concat()).collect();
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    chunk(&mut file, b"IHDR", &header);
    chunk(&mut file, b"IDAT", &miniz_oxide::deflate::compress_to_vec_zlib(&rows, 6));
    chunk(&mut file, b"IEND", &[]);
    file
}

/// Adds length, name, data and their checksum.
fn chunk(file: &mut Vec<u8>, name: &[u8; 4], data: &[u8]) {
    file.extend((data.len() as u32).to_be_bytes());
    let from = file.len();
    file.extend(name);
    file.extend(data);
    let sum = crc32(&file[from..]);
    file.extend(sum.to_be_bytes());
}

/// The checksum of PNG's specification (annex D).
fn crc32(data: &[u8]) -> u32 {
    !data.iter().fold(!0, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| {
            (c >> 1) ^ if c & 1 == 1 { 0xedb8_8320 } else { 0 }
        })
    })
}

/// The picture's pixels, row by row from the top.
struct Pixels {
    width: usize,
    height: usize,
    bytes: Vec<u8>,
    cover: Rasterizer,
}

impl Pixels {
    fn of(picture: &Picture) -> Self {
        let (width, height) = (picture.size.0.ceil() as usize, picture.size.1.ceil() as usize);
        let bytes = vec![0xff; 3 * width * height];
        let mut pixels = Self { width, height, bytes, cover: Rasterizer::new(1, 1) };
        for shape in &picture.shapes {
            match shape {
                Shape::Path { lines, closed, style } => pixels.path(lines, *closed, style),
                Shape::Circle { centre, radius, style } => {
                    let ring = polygon(*centre, *radius, 24);
                    pixels.path(&[ring], true, style);
                }
                Shape::Text(text) => pixels.text(text),
            }
        }
        pixels
    }

    fn path(&mut self, lines: &[Vec<Point>], closed: bool, style: &Style) {
        if let Some(colour) = style.fill {
            self.fill(lines, colour, style.opacity);
        }
        let Some(colour) = style.stroke else { return };
        let mut pieces = Vec::new();
        for line in lines {
            let end = if closed { line.first() } else { None };
            let line: Vec<Point> = line.iter().chain(end).copied().collect();
            match style.dash {
                None => outline(&line, style.width, &mut pieces),
                Some(dash) => {
                    for part in dashes(&line, dash) {
                        outline(&part, style.width, &mut pieces);
                    }
                }
            }
        }
        self.fill(&pieces, colour, style.opacity);
    }

    fn text(&mut self, text: &Text) {
        let (x, y) = start(text);
        let place = |(a, b): Point| if text.upright { (x + b, y - a) } else { (x + a, y + b) };
        let rings = letters::outline(&text.text, text.size).into_iter();
        let rings: Vec<_> = rings.map(|ring| ring.into_iter().map(place).collect()).collect();
        self.fill(&rings, INK, 1.0);
        if text.bold {
            // A stroke around the letters, as there are no bold ones.
            self.path(&rings, true, &Style::stroked(INK, 0.03 * text.size));
        }
    }

    /// Mixes a colour into the pixels within rings.
    fn fill(&mut self, rings: &[Vec<Point>], colour: Colour, opacity: f64) {
        let points = || rings.iter().flatten();
        let low =
            points().fold((f64::INFINITY, f64::INFINITY), |l, p| (l.0.min(p.0), l.1.min(p.1)));
        let high = points().fold((0.0f64, 0.0f64), |h, p| (h.0.max(p.0), h.1.max(p.1)));
        let (left, top) = (low.0.max(-9.0).floor(), low.1.max(-9.0).floor());
        // One pixel to spare: the sums of the last one run on.
        let size = [high.0 - left, high.1 - top].map(|v| v.max(0.0).ceil() as usize + 2);
        if points().next().is_none() || size[0] > 4 * self.width || size[1] > 4 * self.height {
            return;
        }
        self.cover.reset(size[0], size[1]);
        let place = |(x, y): Point| point((x - left) as f32, (y - top) as f32);
        for ring in rings {
            for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
                self.cover.draw_line(place(*a), place(*b));
            }
        }
        let (width, height, bytes) = (self.width as i64, self.height as i64, &mut self.bytes);
        self.cover.for_each_pixel(|index, cover| {
            let x = left as i64 + (index % size[0]) as i64;
            let y = top as i64 + (index / size[0]) as i64;
            if (0..width).contains(&x) && (0..height).contains(&y) {
                let share = opacity * f64::from(cover.clamp(0.0, 1.0));
                let at = 3 * (y * width + x) as usize;
                for (byte, to) in bytes[at..at + 3].iter_mut().zip(colour.rgb) {
                    let from = f64::from(*byte);
                    *byte = (from + share * (f64::from(to) - from)).round() as u8;
                }
            }
        });
    }
}

/// Where the base line of a text begins.
fn start(text: &Text) -> Point {
    let width = letters::width(&text.text, text.size);
    let back = match text.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => 0.5 * width,
        Anchor::End => width,
    };
    let ((x, y), down) = (text.at, HALF_HEIGHT * text.size);
    if text.upright { (x + down, y + back) } else { (x - back, y + down) }
}

/// A regular polygon, run through as [`outline`] does its pieces.
fn polygon((x, y): Point, radius: f64, corners: usize) -> Vec<Point> {
    let angle = |i: usize| -(i as f64) * std::f64::consts::TAU / corners as f64;
    (0..corners).map(|i| (x + radius * angle(i).cos(), y + radius * angle(i).sin())).collect()
}

/// Adds the rectangles of a line's parts and its round corners, all run through the same way, so
/// that they count once where they overlap.
fn outline(line: &[Point], width: f64, pieces: &mut Vec<Vec<Point>>) {
    let half = 0.5 * width;
    for (i, ends) in line.windows(2).enumerate() {
        let (a, b) = (ends[0], ends[1]);
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let length = dx.hypot(dy);
        if length == 0.0 {
            continue;
        }
        let (nx, ny) = (-half * dy / length, half * dx / length);
        pieces.push(vec![
            (a.0 + nx, a.1 + ny),
            (b.0 + nx, b.1 + ny),
            (b.0 - nx, b.1 - ny),
            (a.0 - nx, a.1 - ny),
        ]);
        if i > 0 && width > 1.0 {
            pieces.push(polygon(a, half, 8));
        }
    }
}

/// The dashes of a line; the pattern runs on around corners.
fn dashes(line: &[Point], (dash, gap): (f64, f64)) -> Vec<Vec<Point>> {
    let mut parts: Vec<Vec<Point>> = Vec::new();
    // Whether a dash is being drawn, and how much is left of it or of the gap.
    let (mut drawn, mut left) = (true, dash);
    let mut part: Vec<Point> = line.first().copied().into_iter().collect();
    for ends in line.windows(2) {
        let (mut a, b) = (ends[0], ends[1]);
        loop {
            let length = (b.0 - a.0).hypot(b.1 - a.1);
            if length <= left {
                left -= length;
                part.push(b);
                break;
            }
            let share = left / length;
            a = (a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1));
            part.push(a);
            let done = std::mem::replace(&mut part, vec![a]);
            if drawn {
                parts.push(done);
            }
            drawn = !drawn;
            left = if drawn { dash } else { gap };
        }
    }
    if drawn {
        parts.push(part);
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: Colour = Colour { name: "", rgb: [200, 0, 0] };

    fn pixel(picture: &Picture, x: usize, y: usize) -> [u8; 3] {
        let pixels = Pixels::of(picture);
        let at = 3 * (y * pixels.width + x);
        [pixels.bytes[at], pixels.bytes[at + 1], pixels.bytes[at + 2]]
    }

    #[test]
    fn pixels_take_their_share_of_a_colour() {
        let mut picture = Picture::new((20.0, 20.0), "");
        picture.rectangle((2.0, 2.0), (6.0, 6.5), Style::filled(RED));
        picture.circle((14.0, 14.0), 3.0, Style::filled(RED).faded(0.5));
        picture.line(vec![(0.0, 10.5), (9.0, 10.5)], Style::stroked(INK, 1.0));
        assert_eq!(pixel(&picture, 3, 3), [200, 0, 0]);
        assert_eq!(pixel(&picture, 3, 6), [228, 128, 128]);
        assert_eq!(pixel(&picture, 3, 7), [255; 3]);
        assert_eq!(pixel(&picture, 14, 14), [228, 128, 128]);
        assert_eq!((pixel(&picture, 4, 10), pixel(&picture, 4, 11)), (INK.rgb, [255; 3]));
    }

    #[test]
    fn letters_are_drawn_where_they_stand() {
        let dark = |upright: bool| {
            let mut picture = Picture::new((40.0, 40.0), "");
            picture.text(Text { upright, ..Text::new("HHH", (20.0, 20.0), Anchor::Middle) });
            let pixels = Pixels::of(&picture);
            let dark = |x: usize, y: usize| pixels.bytes[3 * (y * 40 + x)] < 128;
            let all = (0..40 * 40).map(|i| (i % 40, i / 40)).filter(|&(x, y)| dark(x, y));
            let (xs, ys): (Vec<usize>, Vec<usize>) = all.unzip();
            let span = |v: &[usize]| (*v.iter().min().unwrap(), *v.iter().max().unwrap());
            (span(&xs), span(&ys))
        };
        let (xs, ys) = dark(false);
        assert!(xs.1 - xs.0 > 20 && (7..11).contains(&(ys.1 - ys.0)), "{xs:?} {ys:?}");
        assert!((39..=41).contains(&(xs.0 + xs.1)) && (38..=41).contains(&(ys.0 + ys.1)));
        assert_eq!(dark(true).1.1 - dark(true).1.0, xs.1 - xs.0);
    }

    #[test]
    fn dashes_run_on_around_corners() {
        let parts = dashes(&[(0.0, 0.0), (4.0, 0.0), (4.0, 6.0)], (5.0, 2.0));
        assert_eq!(parts, [vec![(0.0, 0.0), (4.0, 0.0), (4.0, 1.0)], vec![(4.0, 3.0), (4.0, 6.0)]]);
    }

    #[test]
    fn the_checksum_is_the_specifications() {
        assert_eq!(crc32(b"IEND"), 0xae42_6082);
        let file = Picture::new((3.0, 2.0), "").to_png();
        assert_eq!(file[16..29], [0, 0, 0, 3, 0, 0, 0, 2, 8, 2, 0, 0, 0]);
        assert_eq!(file[file.len() - 12..], *b"\0\0\0\0IEND\xae\x42\x60\x82");
    }
}
