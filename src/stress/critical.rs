//! The most stressed point, and the neighbourhood of the edges at the ends of the bodies' overlap,
//! in which it is not sought.

use crate::base::BodyKind;

/// The most stressed point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Critical {
    /// The body.
    pub body: BodyKind,
    /// The largest value of what is sought there, mostly von Mises stress (p0).
    pub value: f64,
    /// Point x, y, z (C), z into the body.
    pub at: [f64; 3],
}

impl Critical {
    /// The first of the largest values among those of bodies at points; none if there are none.
    pub fn largest(values: impl Iterator<Item = (BodyKind, [f64; 3], f64)>) -> Option<Self> {
        let all = values.map(|(body, at, value)| Self { body, value, at });
        all.reduce(|best, next| if next.value > best.value { next } else { best })
    }
}

/// Distance from an edge (C) within which the stress at a sharp corner is a property of
/// the sampling, not of the contact.
pub const EDGE: f64 = 0.1;

/// Relative tolerance for rounding of a distance from the edge.
const SLACK: f64 = 1e-9;

/// Whether the point `at` (C) is at least `distance` (C) away from the edges of an overlap with
/// these `ends` (C): the lines through them on the surface, z = 0 at any x.
pub fn away_from_edges(at: [f64; 3], ends: [f64; 2], distance: f64) -> bool {
    let [from, to] = ends;
    let [x, y, z] = at;
    away_from_edge([x, y - 0.5 * (from + to), z], 0.5 * (to - from), distance)
}

/// [`away_from_edges`] of an overlap of this `half_length` (C) about y = 0.
pub fn away_from_edge(at: [f64; 3], half_length: f64, distance: f64) -> bool {
    (at[1].abs() - half_length).hypot(at[2]) >= distance * (1.0 - SLACK)
}
