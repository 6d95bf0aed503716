//! Stresses at many points: those on one line along an axis share much of their computation.

use crate::stress::{BodyField, BodyKind, CurveSpec, RoundStress, Work};
use rayon::prelude::*;
use std::collections::HashMap;

/// Points of one body that share much of their computation.
struct Line {
    body: BodyKind,
    along: Along,
    /// Coordinates (C), and the place of the stress in the result.
    points: Vec<([f64; 3], Slot)>,
}

/// Which points belong to one [`Line`] (coordinates in C).
#[derive(Clone, Copy)]
enum Along {
    /// Those along x, at y and z.
    X(f64, f64),
    /// Those along y in the plane x = 0, at z.
    Y(f64),
    /// Those along z, at y, in the plane x = 0.
    Z(f64),
    /// Those along z, at y, off the plane x = 0.
    OffZ(f64),
}

impl Along {
    /// What distinguishes it from others: the kind, and the coordinates to the last bit.
    fn key(self) -> (u8, [u64; 2]) {
        match self {
            Self::X(y, z) => (0, [y, z].map(f64::to_bits)),
            Self::Y(z) => (1, [z, 0.0].map(f64::to_bits)),
            Self::Z(y) => (2, [y, 0.0].map(f64::to_bits)),
            Self::OffZ(y) => (3, [y, 0.0].map(f64::to_bits)),
        }
    }
}

/// The place of a stress in the result: a curve's point, or a single point.
#[derive(Clone, Copy)]
enum Slot {
    Curve(usize, usize),
    Single(usize),
}

/// Stresses of bodies before the roller's round shape is added.
#[derive(Debug, Default)]
pub struct Stresses {
    /// Of each curve at its points.
    pub curves: Vec<Vec<RoundStress>>,
    /// Of the single points.
    pub points: Vec<RoundStress>,
    /// The evaluations.
    pub work: Work,
}

/// Stresses on `curves` and at single `points` (C) from the `field` of each body; bodies that share
/// their fields are `shared`.
pub(super) fn stresses<'a>(
    shared: bool,
    field: impl Fn(BodyKind) -> BodyField<'a>,
    curves: &[CurveSpec],
    points: &[(BodyKind, [f64; 3])],
) -> Stresses {
    let lines = lines(shared, curves, points);
    let fields: Vec<_> = BodyKind::ALL
        .into_iter()
        .filter(|&k| lines.iter().any(|l| l.body == k))
        .map(|k| (k, field(k)))
        .collect();
    let values: Vec<Vec<RoundStress>> = lines
        .par_iter()
        .map(|line| {
            let (_, field) = fields.iter().find(|f| f.0 == line.body).expect("one a body");
            line.stresses(field)
        })
        .collect();
    let mut found = Stresses {
        curves: curves.iter().map(|c| vec![RoundStress::default(); c.points.len()]).collect(),
        points: vec![RoundStress::default(); points.len()],
        work: fields.iter().map(|(_, field)| field.work()).sum(),
    };
    for (line, values) in lines.iter().zip(values) {
        for ((_, slot), value) in line.points.iter().zip(values) {
            match *slot {
                Slot::Curve(i, j) => found.curves[i][j] = value,
                Slot::Single(i) => found.points[i] = value,
            }
        }
    }
    found
}

/// The points of `curves` and the single ones, line by line.
fn lines(shared: bool, curves: &[CurveSpec], points: &[(BodyKind, [f64; 3])]) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    let mut known: HashMap<(BodyKind, (u8, [u64; 2])), usize> = HashMap::new();
    let mut add = |kind: BodyKind, along: Along, at: [f64; 3], slot: Slot| {
        // Bodies that share one computation have equal results.
        let body = if shared { BodyKind::Block } else { kind };
        let index = *known.entry((body, along.key())).or_insert_with(|| {
            lines.push(Line { body, along, points: Vec::new() });
            lines.len() - 1
        });
        lines[index].points.push((at, slot));
    };
    for (i, curve) in curves.iter().enumerate() {
        let same = |axis: usize| curve.points.windows(2).all(|p| p[0][axis] == p[1][axis]);
        let fixed = [0, 1, 2].map(same);
        for (j, &at) in curve.points.iter().enumerate() {
            let [x, y, z] = at;
            let along = match fixed {
                [true, true, _] if x == 0.0 => Along::Z(y),
                [true, true, _] => Along::OffZ(y),
                [true, _, true] if x == 0.0 => Along::Y(z),
                _ => Along::X(y, z),
            };
            add(curve.body, along, at, Slot::Curve(i, j));
        }
    }
    for (i, &(body, at)) in points.iter().enumerate() {
        add(body, Along::X(at[1], at[2]), at, Slot::Single(i));
    }
    lines
}

impl Line {
    /// The stresses at the points, in their order.
    fn stresses(&self, field: &BodyField) -> Vec<RoundStress> {
        let coordinate = |axis: usize| self.points.iter().map(|p| p.0[axis]).collect::<Vec<_>>();
        match self.along {
            Along::X(y, z) => field.round_at(y, z, &coordinate(0)),
            Along::Y(z) => field.round_along(z, &coordinate(1)),
            Along::Z(y) | Along::OffZ(y) => {
                // Points at one depth share their sums over the loads.
                let distinct = |mut all: Vec<f64>| {
                    all.sort_by(f64::total_cmp);
                    all.dedup();
                    all
                };
                let (xs, zs) = (distinct(coordinate(0)), distinct(coordinate(2)));
                let all = field.round_down(&xs, y, &zs);
                let place = |all: &[f64], v: f64| all.partition_point(|a| *a < v);
                let at = |(at, _): &([f64; 3], Slot)| all[place(&zs, at[2])][place(&xs, at[0])];
                self.points.iter().map(at).collect()
            }
        }
    }
}
