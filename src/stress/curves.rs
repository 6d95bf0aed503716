//! The standard curves: the points at which all models and FEM are compared.
//!
//! All coordinates here are in units of C; `half_length` is half the length of the bodies' overlap,
//! which is S_l = L / (2 C) where the shorter body, of length L, lies within the other.

use crate::base::{BodyKind, ledge};

/// A named list of points of one body.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveSpec {
    /// The body the points lie in.
    pub body: BodyKind,
    /// The curve's name, e.g. `depth-end`.
    pub name: &'static str,
    /// Points (x, y, z) in units of C, z into the body, in the order of the running coordinate.
    pub points: Vec<[f64; 3]>,
}

/// Names of the standard curves, in the order of [`standard_curves`].
pub const CURVE_NAMES: [&str; 13] = [
    "surface-along-y",
    "surface-along-x",
    "depth-centre",
    "depth-0.9",
    "depth-end",
    "along-y-0.5C",
    "along-y-0.78C",
    "depth-centre-x0.7",
    "depth-0.9-x0.7",
    "depth-end-x0.7",
    "depth-centre-x1.4",
    "depth-0.9-x1.4",
    "depth-end-x1.4",
];

/// The curves that name an end, at the +y end of the contact and at the -y end of a contact that is
/// not symmetric.
pub const END_CURVES: [[&str; 2]; 6] = [
    ["depth-0.9", "depth-0.9-neg"],
    ["depth-end", "depth-end-neg"],
    ["depth-0.9-x0.7", "depth-0.9-x0.7-neg"],
    ["depth-end-x0.7", "depth-end-x0.7-neg"],
    ["depth-0.9-x1.4", "depth-0.9-x1.4-neg"],
    ["depth-end-x1.4", "depth-end-x1.4-neg"],
];

/// The curves off the plane x = 0, at their own x and at -x. The latter exist where the bodies
/// slide on each other: only then do both differ.
pub const OFF_PLANE_CURVES: [[&str; 2]; 10] = [
    ["depth-centre-x0.7", "depth-centre-x0.7-xneg"],
    ["depth-0.9-x0.7", "depth-0.9-x0.7-xneg"],
    ["depth-end-x0.7", "depth-end-x0.7-xneg"],
    ["depth-centre-x1.4", "depth-centre-x1.4-xneg"],
    ["depth-0.9-x1.4", "depth-0.9-x1.4-xneg"],
    ["depth-end-x1.4", "depth-end-x1.4-xneg"],
    ["depth-0.9-x0.7-neg", "depth-0.9-x0.7-neg-xneg"],
    ["depth-end-x0.7-neg", "depth-end-x0.7-neg-xneg"],
    ["depth-0.9-x1.4-neg", "depth-0.9-x1.4-neg-xneg"],
    ["depth-end-x1.4-neg", "depth-end-x1.4-neg-xneg"],
];

/// All names that a curve may have.
pub fn every_name() -> impl Iterator<Item = &'static str> {
    let others = END_CURVES.iter().chain(&OFF_PLANE_CURVES).map(|[_, other]| *other);
    CURVE_NAMES.into_iter().chain(others)
}

/// The standard curve of which the one called `name` is the twin on the other side, at -x or at the
/// -y end; itself if it is none.
pub fn twin(name: &str) -> &str {
    let ahead = name.strip_suffix("-xneg").unwrap_or(name);
    ahead.strip_suffix("-neg").unwrap_or(ahead)
}

/// The part of the contact line that the curves lie on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// The ends of the bodies' overlap (C).
    pub ends: [f64; 2],
    /// Whether the contact is symmetric about y = 0; one half of it is then enough.
    pub symmetric: bool,
    /// Whether the bodies slide on each other; x of both signs is then needed.
    pub slides: bool,
}

impl Span {
    /// A symmetric contact of half-length `half_length` (C) without sliding.
    pub fn symmetric(half_length: f64) -> Self {
        Self { ends: [-half_length, half_length], symmetric: true, slides: false }
    }

    /// The middle of the overlap.
    pub fn middle(&self) -> f64 {
        0.5 * (self.ends[0] + self.ends[1])
    }

    /// Half of the overlap's length.
    pub fn half_length(&self) -> f64 {
        0.5 * (self.ends[1] - self.ends[0])
    }

    /// y of the curves in the middle: the roller's middle, or that of the overlap if it lies
    /// elsewhere.
    pub fn centre(&self) -> f64 {
        if self.ends[0] < 0.0 && 0.0 < self.ends[1] { 0.0 } else { self.middle() }
    }

    /// y of the points on the contact line, ascending.
    pub fn contact_line(&self) -> Vec<f64> {
        self.both_sides([0.0; 2])
    }

    /// y of the points on the contact line and, beyond its ends, on the `ledges` of a body.
    fn both_sides(&self, ledges: [f64; 2]) -> Vec<f64> {
        let half_length = self.half_length();
        let side = |beyond: f64| {
            let mut y = contact_line(half_length);
            if ledge(beyond, half_length) > 0.0 {
                let reach = beyond.min(OUTWARD);
                let outward =
                    SAMPLED_DISTANCES.iter().filter(|&&s| s > 0.0 && s < reach * (1.0 - SAME));
                y.extend(outward.map(|s| half_length + s));
                y.push(half_length + reach);
            }
            y
        };
        if self.symmetric {
            return side(ledges[1]);
        }
        let middle = self.middle();
        let before = side(ledges[0]).into_iter().skip(1).rev().map(|u| middle - u);
        before.chain(side(ledges[1]).into_iter().map(|u| middle + u)).collect()
    }
}

/// Positions x of the depth profiles off the plane of symmetry, inside and outside the contact
/// (units of C).
const OFF_PLANE: [f64; 2] = [0.7, 1.4];

/// Distances from the overlap's ends at which curves along y are sampled (units of C).
const SAMPLED_DISTANCES: [f64; 22] = [
    0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0,
    4.0, 5.0, 6.5, 8.0,
];

/// How far beyond the overlap's ends curves of a longer body go (units of C).
const OUTWARD: f64 = 3.0;

/// Lengths within this relative difference are equal: they may have been converted to SI units and
/// back.
const SAME: f64 = 1e-9;

/// Distances from the overlap's end, ascending, up to `half_length` (which is the last).
fn end_distances(half_length: f64) -> Vec<f64> {
    let below = half_length * (1.0 - SAME);
    let mut s: Vec<f64> = SAMPLED_DISTANCES.iter().copied().filter(|&s| s < below).collect();
    let mut decade = 1.0;
    'grow: loop {
        for step in [1.0, 1.3, 1.6, 2.0, 2.5, 3.2, 4.0, 5.0, 6.4, 8.0] {
            let next = 10.0 * decade * step;
            // No number is below NaN.
            if next < below {
                s.push(next);
            } else {
                break 'grow;
            }
        }
        decade *= 10.0;
    }
    s.push(half_length);
    s
}

/// y of the points on the contact line, from the centre to the end (units of C).
pub fn contact_line(half_length: f64) -> Vec<f64> {
    end_distances(half_length).iter().rev().map(|s| half_length - s).collect()
}

/// x of the points across the contact, from the centre outwards (units of C).
pub fn across_contact() -> Vec<f64> {
    (0..=30).map(|i| 0.05 * f64::from(i)).collect()
}

/// Depths of the depth profiles (units of C).
pub fn depths() -> Vec<f64> {
    let mut z = vec![0.0, 0.02];
    z.extend((1..=30).map(|i| 0.05 * f64::from(i)));
    z.extend((16..=30).map(|i| 0.1 * f64::from(i)));
    z.extend([3.5, 4.0, 5.0]);
    z
}

/// The standard curves of one body. `half_length` is that of the overlap and
/// `body_half_length` that of the body (units of C); a longer body's curves along y go on past
/// the overlap's ends for up to three C. z is the depth below the body's surface at the point's x.
pub fn standard_curves(body: BodyKind, half_length: f64, body_half_length: f64) -> Vec<CurveSpec> {
    let ends = [-body_half_length, body_half_length];
    curves_on(body, &Span::symmetric(half_length), ends)
}

/// The standard curves of one body with these `ends` (C), on any contact line. Curves along y of a
/// contact that is not symmetric go over all of it, and each of [`END_CURVES`] stands at both ends.
/// Of bodies that slide, the curve across the contact goes over both signs of x, and each of
/// [`OFF_PLANE_CURVES`] stands at both.
pub fn curves_on(body: BodyKind, span: &Span, ends: [f64; 2]) -> Vec<CurveSpec> {
    let y = span.both_sides([span.ends[0] - ends[0], ends[1] - span.ends[1]]);
    let (middle, centre, half_length) = (span.middle(), span.centre(), span.half_length());
    let mut x = across_contact();
    x.extend([1.75, 2.0, 2.5, 3.0]);
    if span.slides {
        x = x[1..].iter().rev().map(|x| -x).chain(x.iter().copied()).collect();
    }
    let along_y = |depth: f64| y.iter().map(|&y| [0.0, y, depth]).collect::<Vec<_>>();
    let down = |x: f64, y: f64| depths().iter().map(|&z| [x, y, z]).collect::<Vec<_>>();
    let along_z = |x: f64| [centre, middle + 0.9 * half_length, span.ends[1]].map(|y| down(x, y));
    let across = x.iter().map(|&x| [x, centre, 0.0]).collect();
    let points = [along_y(0.0), across]
        .into_iter()
        .chain(along_z(0.0))
        .chain([along_y(0.5), along_y(0.78)])
        .chain(OFF_PLANE.into_iter().flat_map(along_z));
    let mut curves: Vec<CurveSpec> = CURVE_NAMES
        .iter()
        .zip(points)
        .map(|(&name, points)| CurveSpec { body, name, points })
        .collect();
    if !span.symmetric {
        let other = |x: f64| [middle - 0.9 * half_length, span.ends[0]].map(|y| down(x, y));
        let points = [0.0].into_iter().chain(OFF_PLANE).flat_map(other);
        let names = END_CURVES.iter().map(|[_, name]| *name);
        curves.extend(names.zip(points).map(|(name, points)| CurveSpec { body, name, points }));
    }
    if span.slides {
        let behind = |curve: &CurveSpec| {
            let [_, name] = *OFF_PLANE_CURVES.iter().find(|[own, _]| *own == curve.name)?;
            let points = curve.points.iter().map(|[x, y, z]| [-x, *y, *z]).collect();
            Some(CurveSpec { body, name, points })
        };
        let behind: Vec<_> = curves.iter().filter_map(behind).collect();
        curves.extend(behind);
    }
    curves
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_have_the_points_that_records_hold() {
        assert_eq!(contact_line(5.0).first(), Some(&0.0));
        assert_eq!(contact_line(5.0).last(), Some(&5.0));
        assert_eq!(contact_line(5.0).len(), 20);
        assert_eq!(end_distances(20.0)[20..], [6.5, 8.0, 10.0, 13.0, 16.0, 20.0]);
        assert_eq!(end_distances(120.0)[30..], [64.0, 80.0, 100.0, 120.0]);
        assert_eq!(end_distances(f64::NAN).len(), 1);
        let curves = standard_curves(BodyKind::Block, 5.0, 10.0);
        assert_eq!(curves[0].points.last(), Some(&[0.0, 8.0, 0.0]));
        let ledge = standard_curves(BodyKind::Block, 5.0, 5.0 / 0.99);
        assert_eq!(ledge[0].points.last(), Some(&[0.0, 5.0 / 0.99, 0.0]));
        assert_eq!(depths().len(), 50);
        let of = |name: &str| &curves.iter().find(|c| c.name == name).unwrap().points;
        for (curve, x) in [("x0.7", 0.7), ("x1.4", 1.4)] {
            for (place, y) in [("centre", 0.0), ("0.9", 4.5), ("end", 5.0)] {
                let points = of(&format!("depth-{place}-{curve}"));
                assert!(points.iter().zip(depths()).all(|(p, z)| *p == [x, y, z]));
                assert_eq!(points.len(), of(&format!("depth-{place}")).len());
            }
        }
        let span = Span { ends: [-3.0, 5.0], symmetric: false, slides: false };
        let curves = curves_on(BodyKind::Block, &span, [-3.0, 7.0]);
        assert_eq!(curves.len(), CURVE_NAMES.len() + END_CURVES.len());
        let ends = |name: &str| {
            let points = &curves.iter().find(|c| c.name == name).unwrap().points;
            [points[0], points[points.len() - 1]]
        };
        assert_eq!(ends("surface-along-y"), [[0.0, -3.0, 0.0], [0.0, 7.0, 0.0]]);
        assert!(curves[0].points.windows(2).all(|p| p[0][1] < p[1][1]));
        assert_eq!(ends("depth-end-x1.4-neg"), [[1.4, -3.0, 0.0], [1.4, -3.0, 5.0]]);
        assert_eq!(ends("depth-end-x0.7"), [[0.7, 5.0, 0.0], [0.7, 5.0, 5.0]]);
        assert!((ends("depth-0.9-neg")[0][1] + 2.6).abs() < 1e-12);
        assert_eq!(ends("depth-centre")[0], [0.0; 3]);
        let curves = curves_on(BodyKind::Block, &Span { slides: true, ..span }, [-3.0, 7.0]);
        assert_eq!(curves.len(), CURVE_NAMES.len() + END_CURVES.len() + OFF_PLANE_CURVES.len());
        let curve = |name: &str| &curves.iter().find(|c| c.name == name).unwrap().points;
        assert_eq!(curve("surface-along-x").len(), 69);
        assert!(curve("surface-along-x").windows(2).all(|p| p[0][0] < p[1][0]));
        assert_eq!(curve("depth-end-x1.4-neg-xneg")[0], [-1.4, -3.0, 0.0]);
        for rounded in [5.0 * (1.0 - 1e-15), 5.0 * (1.0 + 1e-15)] {
            let flush = standard_curves(BodyKind::Block, 5.0, rounded);
            assert_eq!(flush[0].points.len(), 20);
            assert_eq!(contact_line(rounded).len(), 20);
        }
    }
}
