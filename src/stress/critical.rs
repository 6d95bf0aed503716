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

/// Rounding of places, in half-lengths of the overlap but at least 1 C: files have nine digits. A
/// point that lies at a distance that is asked for counts, whichever way its place was rounded.
const SLACK: f64 = 1e-8;

/// Whether the point `at` (C) is at least `distance` (C) away from the edges of an overlap with
/// these `ends` (C): the lines through them on the surface, z = 0 at any x.
pub fn away_from_edges(at: [f64; 3], ends: [f64; 2], distance: f64) -> bool {
    let [from, to] = ends;
    let [x, y, z] = at;
    away_from_edge([x, y - 0.5 * (from + to), z], 0.5 * (to - from), distance)
}

/// [`away_from_edges`] of an overlap of this `half_length` (C) about y = 0.
pub fn away_from_edge(at: [f64; 3], half_length: f64, distance: f64) -> bool {
    (at[1].abs() - half_length).hypot(at[2]) >= distance - SLACK * half_length.max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_at_the_distance_counts_whichever_way_files_round_it() {
        for i in 0..5000 {
            let half_length = 0.5 + 0.037 * f64::from(i);
            let c_m = 1e-4 * (1.0 + (0.618 * f64::from(i)).fract());
            let counts = |off: f64| {
                let y_m: f64 = format!("{:.8e}", (half_length - off) * c_m).parse().unwrap();
                away_from_edge([0.0, y_m / c_m, 0.0], half_length, 0.1)
            };
            assert!(counts(0.1) && counts(0.10001) && !counts(0.09999), "{half_length} C, {c_m} m");
        }
    }
}
