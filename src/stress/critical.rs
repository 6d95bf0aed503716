//! The most stressed point of a body, and the neighbourhood of the roller's edge, which is
//! excluded.

use crate::base::BodyKind;

/// The most stressed point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Critical {
    /// The body.
    pub body: BodyKind,
    /// Von Mises stress (p0).
    pub value: f64,
    /// Point x, y, z (C), z into the body.
    pub at: [f64; 3],
}

/// Distance from the roller's edge (C) within which the stress at a sharp corner is a property of
/// the sampling, not of the contact.
pub const EDGE: f64 = 0.1;

/// Relative tolerance for rounding of a distance from the edge.
const SLACK: f64 = 1e-9;

/// Whether the point `at` (C) is at least `distance` (C) away from the edges of an overlap with
/// these `ends` (C), see [`away_from_edge`].
pub fn away_from_edges(at: [f64; 3], ends: [f64; 2], distance: f64) -> bool {
    let [from, to] = ends;
    let [x, y, z] = at;
    away_from_edge([x, y - 0.5 * (from + to), z], 0.5 * (to - from), distance)
}

/// Whether the point `at` (C) is at least `distance` (C) away from the roller's edges, the lines
/// |y| = `half_length`, z = 0 at any x.
pub fn away_from_edge(at: [f64; 3], half_length: f64, distance: f64) -> bool {
    (at[1].abs() - half_length).hypot(at[2]) >= distance * (1.0 - SLACK)
}
