//! Contours of a scalar in a plane: bands of colour and the lines between them.
//!
//! Between the grid's points the scalar is linear along the cells' edges; bands are cut out of the
//! cells along those edges (marching squares). The colours are the anchors of viridis (van der Walt
//! and Smith, 2015), whose lightness rises with the value, so that a print without colour keeps the
//! order; lines between the bands carry it too.

use super::axis::{extent, round_step};
use super::picture::{Colour, Point};
use std::collections::HashMap;

/// A scalar on a grid of a plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// Name of the scalar, with its unit.
    pub label: String,
    /// Coordinates to the right and upwards (downwards if `down`), ascending, two each at least.
    pub axes: [Vec<f64>; 2],
    /// Whether the second axis points down, as a depth does.
    pub down: bool,
    /// Values; the first axis runs fastest. What is not finite leaves a gap.
    pub values: Vec<f64>,
    /// Largest value that counts: what exceeds it has its colour, and is not marked as the maximum.
    pub limit: f64,
}

/// The scalar's largest value and its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Maximum {
    /// Coordinates along both axes.
    pub at: [f64; 2],
    /// The value.
    pub value: f64,
}

/// Number of bands that is aimed at; round levels may bring some more or fewer.
const BANDS: f64 = 11.0;

/// Anchors of viridis, evenly spaced.
const VIRIDIS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// Colour of one of some bands, the lowest first.
pub fn colour(band: usize, bands: usize) -> Colour {
    let place = (band as f64 + 0.5) / bands as f64 * (VIRIDIS.len() - 1) as f64;
    let (low, part) = (place.floor() as usize, place.fract());
    let mix = |i: usize| {
        let [a, b] = [VIRIDIS[low][i], VIRIDIS[low + 1][i]].map(f64::from);
        (a + part * (b - a)).round() as u8
    };
    Colour { name: "", rgb: [0, 1, 2].map(mix) }
}

/// A corner of a cell: coordinates and value.
type Corner = [f64; 3];

/// The part of a polygon that lies at or above a level; values are linear along its edges.
fn above(polygon: &[Corner], level: f64) -> Vec<Corner> {
    let mut kept = Vec::with_capacity(polygon.len() + 2);
    for (i, a) in polygon.iter().enumerate() {
        let b = &polygon[(i + 1) % polygon.len()];
        if a[2] >= level {
            kept.push(*a);
        }
        if (a[2] >= level) != (b[2] >= level) {
            // From the lower end, whichever cell asks: neighbours must get the same place.
            let (low, high) = if a[2] < b[2] { (a, b) } else { (b, a) };
            let share = (level - low[2]) / (high[2] - low[2]);
            kept.push([0, 1, 2].map(|k| low[k] + share * (high[k] - low[k])));
        }
    }
    kept
}

impl Map {
    /// The scalar's largest value on the grid. `None` where no value is finite.
    pub fn maximum(&self) -> Option<Maximum> {
        let counts = |v: f64| v.is_finite() && v <= self.limit;
        let finite = self.values.iter().enumerate().filter(|(_, v)| counts(**v));
        let (i, &value) = finite.max_by(|a, b| a.1.total_cmp(b.1))?;
        let n = self.axes[0].len();
        Some(Maximum { at: [self.axes[0][i % n], self.axes[1][i / n]], value })
    }

    /// The limits of the bands, ascending: round numbers from the scalar's least value or below to
    /// its largest or above.
    pub fn levels(&self) -> Vec<f64> {
        let (low, high) = extent(self.values.iter().map(|v| v.min(self.limit)));
        // A scalar that is the same everywhere but for rounding is one band.
        let step = round_step(((high - low) / BANDS).max(1e-6 * high.abs().max(1e-12)));
        let first = (low / step + 1e-9).floor() as i64;
        let last = ((high / step - 1e-9).ceil() as i64).max(first + 1);
        (first..=last).map(|i| i as f64 * step).collect()
    }

    /// The rings around all that lies at or above a level, in the pixels that `place` gives.
    ///
    /// Pieces of cells are run through the same way round, so an edge that two of them share is
    /// there in both directions and cancels; the rest is the border. Where pieces are smaller than
    /// a pixel an edge may be there more than once.
    pub fn rings_above(&self, level: f64, place: impl Fn(f64, f64) -> Point) -> Vec<Vec<Point>> {
        let [xs, ys] = &self.axes;
        let n = xs.len();
        let corner = |i: usize, j: usize| [xs[i], ys[j], self.values[j * n + i]];
        let mut edges: HashMap<(Node, Node), usize> = HashMap::new();
        for (i, j) in (1..ys.len()).flat_map(|j| (1..n).map(move |i| (i, j))) {
            let cell = [corner(i - 1, j - 1), corner(i, j - 1), corner(i, j), corner(i - 1, j)];
            if cell.iter().any(|c| !c[2].is_finite()) {
                continue;
            }
            let nodes: Vec<Node> =
                above(&cell, level).iter().map(|c| node(place(c[0], c[1]))).collect();
            for (k, &a) in nodes.iter().enumerate() {
                let b = nodes[(k + 1) % nodes.len()];
                match edges.get_mut(&(b, a)) {
                    _ if a == b => {}
                    Some(back) if *back > 0 => *back -= 1,
                    _ => *edges.entry((a, b)).or_default() += 1,
                }
            }
        }
        rings(edges)
    }
}

/// A place in tenths of a pixel: exact, so that it can be compared.
type Node = (i32, i32);

fn node((x, y): Point) -> Node {
    ((10.0 * x).round() as i32, (10.0 * y).round() as i32)
}

/// Joins edges to rings. As many end at a node as begin there, so none is left over.
fn rings(edges: HashMap<(Node, Node), usize>) -> Vec<Vec<Point>> {
    // In order: the same map gives the same text.
    let all = edges.into_iter().flat_map(|(edge, count)| std::iter::repeat_n(edge, count));
    let mut sorted: Vec<(Node, Node)> = all.collect();
    sorted.sort_unstable();
    let mut next: HashMap<Node, Vec<Node>> = HashMap::new();
    for &(a, b) in &sorted {
        next.entry(a).or_default().push(b);
    }
    let mut all = Vec::new();
    for &(start, _) in &sorted {
        let mut ring: Vec<Node> = Vec::new();
        let mut here = start;
        while let Some(to) = next.get_mut(&here).and_then(Vec::pop) {
            // What lies on a straight line says nothing.
            if let [.., a, b] = ring[..]
                && straight(a, b, here)
            {
                ring.pop();
            }
            ring.push(here);
            here = to;
        }
        if let [first, .., a, b] = ring[..]
            && straight(a, b, first)
        {
            ring.pop();
        }
        if ring.len() > 2 {
            let point = |(x, y): Node| (f64::from(x) / 10.0, f64::from(y) / 10.0);
            all.push(ring.into_iter().map(point).collect());
        }
    }
    all
}

fn straight(a: Node, b: Node, c: Node) -> bool {
    let wide = |v: i32| i64::from(v);
    let (ux, uy) = (wide(b.0) - wide(a.0), wide(b.1) - wide(a.1));
    let (vx, vy) = (wide(c.0) - wide(b.0), wide(c.1) - wide(b.1));
    ux * vy == uy * vx && ux * vx + uy * vy > 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hill() -> Map {
        let x: Vec<f64> = (0..=20).map(|i| f64::from(i) * 0.1 - 1.0).collect();
        let z: Vec<f64> = (0..=10).map(|i| f64::from(i) * 0.2).collect();
        let height = |x: f64, z: f64| (-x * x - (z - 0.8).powi(2)).exp();
        let values = z.iter().flat_map(|z| x.iter().map(move |x| height(*x, *z)));
        Map {
            label: "height".into(),
            values: values.collect(),
            axes: [x, z],
            down: true,
            limit: f64::INFINITY,
        }
    }

    /// Twice the area within a ring, positive or negative by its direction.
    fn area(ring: &[Point]) -> f64 {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum()
    }

    #[test]
    fn a_cell_is_cut_along_its_edges() {
        let cell = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]];
        let upper = above(&cell, 0.25);
        assert_eq!(upper, [[1.0, 0.25, 0.25], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0], [0.0, 0.25, 0.25]]);
        assert_eq!(above(&cell, 2.0), Vec::<Corner>::new());
    }

    #[test]
    fn what_lies_above_a_level_is_one_ring() {
        let map = hill();
        let place = |x: f64, z: f64| (100.0 * x, 100.0 * z);
        let levels = map.levels();
        assert!(levels[0] == 0.0 && (levels[levels.len() - 1] - 1.0).abs() < 1e-12);
        assert_eq!(levels.len(), 11);
        let all = map.rings_above(levels[0], place);
        assert_eq!(all, [vec![(-100.0, 0.0), (100.0, 0.0), (100.0, 200.0), (-100.0, 200.0)]]);
        // A circle around the summit; its radius follows from the hill's form.
        let rings = map.rings_above(0.8, place);
        assert_eq!(rings.len(), 1);
        let circle = std::f64::consts::PI * 1e4 * -(0.8f64.ln());
        let share = area(&rings[0]) / 2.0 / circle;
        assert!(share > 0.96 && share < 1.0, "{share}");
        assert_eq!(map.rings_above(2.0, place), Vec::<Vec<Point>>::new());
    }

    #[test]
    fn pieces_below_a_pixel_leave_no_ring_open() {
        // Steps of a border in tenths of a pixel: a ring that closes over a gap would have a long
        // one.
        let axis: Vec<f64> = (0..60).map(f64::from).collect();
        let values = (0..3600u64).map(|i| ((i * i * 7919 + i * 104_729) % 1000) as f64).collect();
        let map = Map {
            label: String::new(),
            axes: [axis.clone(), axis],
            down: false,
            values,
            limit: f64::INFINITY,
        };
        let rings = map.rings_above(500.0, |x, y| (0.17 * x, 0.17 * y));
        assert!(rings.len() > 20);
        for ring in rings {
            let pairs = ring.iter().zip(ring.iter().cycle().skip(1));
            let longest = pairs.map(|(a, b)| (a.0 - b.0).hypot(a.1 - b.1)).fold(0.0, f64::max);
            assert!(longest < 2.0, "{longest}");
        }
    }

    #[test]
    fn a_gap_is_a_hole() {
        let mut map = hill();
        map.values[5 * 21 + 10] = f64::NAN;
        let rings = map.rings_above(map.levels()[0], |x, z| (100.0 * x, 100.0 * z));
        let areas: Vec<f64> = rings.iter().map(|r| area(r) / 2.0).collect();
        assert_eq!(areas.iter().sum::<f64>(), 200.0 * 200.0 - 4.0 * 10.0 * 20.0);
        assert_eq!(areas.len(), 2);
    }

    #[test]
    fn the_maximum_is_found() {
        let maximum = hill().maximum().unwrap();
        assert!(maximum.at[0].abs() < 1e-12 && (maximum.at[1] - 0.8).abs() < 1e-12);
        let nothing = Map { values: vec![f64::NAN; 21 * 11], ..hill() };
        assert_eq!((nothing.maximum(), nothing.levels()[0]), (None, 0.0));
        let flat = Map { values: vec![3.0; 21 * 11], ..hill() };
        assert_eq!(flat.rings_above(flat.levels()[0], |x, z| (x, z)).len(), 1);
    }
}
