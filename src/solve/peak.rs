//! The largest pressure or stress of a whole contact, wherever it is: what a profile is judged by.

use super::shaping::Shaping;
use super::solved::SolvedCase;
use crate::base::BodyKind;
use crate::case::Objective;
use crate::stress::{BodyField, Critical, RoundStress, away_from_edges};
use std::f64::consts::FRAC_PI_2;

/// Places along the contact, closer towards its ends.
const PLACES: usize = 25;

/// Depths, in the largest half-widths of the contact: where von Mises stress and shear are largest
/// at a plane strain, and at the narrower contact of a loaded end.
const DEPTHS: [f64; 8] = [0.0, 0.15, 0.3, 0.4, 0.5, 0.6, 0.7, 0.85];

/// Places across the contact where the shear stress is largest, in half-widths.
const ACROSS: [f64; 5] = [0.5, 0.65, 0.8, 0.9, 1.0];

/// Directions from an edge in which the border of what does not count about it is looked at.
const ANGLES: usize = 9;

/// Halvings of the distances around the largest value.
const HALVINGS: usize = 4;

/// The largest value (p0) of `objective` in both bodies and its place (C), more than `excluded` (C)
/// from the edges of the bodies' overlap. Von Mises stress is sought in the plane x = 0, where that
/// of a frictionless contact is largest below the surface; the range of tau_xz is twice its largest
/// size, as the passage sees both signs.
///
/// Error: the search meets the largest value within 1e-3 of it (a test checks that).
pub fn peak(solved: &SolvedCase, objective: Objective, excluded: f64) -> Critical {
    let scene = solved.scene();
    let ends = scene.ends();
    if objective == Objective::Pressure {
        let value = |y: f64| match away_from_edges([0.0, y, 0.0], scene.scene.overlap(), excluded) {
            true => solved.pressure(0.0, y),
            false => 0.0,
        };
        let symmetric = scene.scene.is_symmetric();
        let within = highest(ends, symmetric, 4 * PLACES, value);
        // Towards a steep end it is largest where it just counts.
        let outermost = around(scene.scene.overlap(), symmetric, excluded);
        let beside = outermost.iter().map(|[y, _]| (*y, value(*y)));
        let (y, value) = beside.fold(within, higher);
        return Critical { body: BodyKind::Block, value, at: [0.0, y, 0.0] };
    }
    let each = in_bodies(solved, &BodyKind::ALL, objective, excluded).into_iter();
    let larger =
        |block: Critical, roller: Critical| if roller.value > block.value { roller } else { block };
    each.reduce(larger).expect("one for each body")
}

/// Places along a contact, on the right half of a symmetric one, in the parameter t of [`place`].
fn parameters(symmetric: bool, count: usize) -> impl Iterator<Item = f64> {
    let least = if symmetric { 0.0 } else { -1.0 };
    (0..count).map(move |i| least + (1.0 - least) * i as f64 / (count - 1) as f64)
}

/// The place along a contact with these `ends`, which are those of t = -1 and 1; close to them for
/// equal steps.
fn place([from, to]: [f64; 2], t: f64) -> f64 {
    0.5 * (from + to) + 0.5 * (to - from) * (FRAC_PI_2 * t).sin()
}

/// The inverse of [`place`]; of places beyond the ends theirs.
fn parameter([from, to]: [f64; 2], y: f64) -> f64 {
    ((2.0 * y - from - to) / (to - from)).clamp(-1.0, 1.0).asin() / FRAC_PI_2
}

/// The one of two places that has the larger value.
fn higher(best: (f64, f64), next: (f64, f64)) -> (f64, f64) {
    if next.1 > best.1 { next } else { best }
}

/// The largest value of a function along a line, on `count` places and then closer about the
/// largest.
fn highest(
    ends: [f64; 2],
    symmetric: bool,
    count: usize,
    value: impl Fn(f64) -> f64,
) -> (f64, f64) {
    let all: Vec<f64> = parameters(symmetric, count).collect();
    let mut step = all[1] - all[0];
    let at = |t: f64| (t, value(place(ends, t)));
    let mut best = all.iter().map(|t| at(*t)).reduce(higher).expect("places");
    for _ in 0..HALVINGS {
        step *= 0.5;
        let beside = [best.0 - step, best.0 + step];
        let inside = beside.into_iter().filter(|t| (all[0]..=1.0).contains(t));
        best = inside.map(at).fold(best, higher);
    }
    (place(ends, best.0), best.1)
}

/// Places y and depths at the distance `excluded` from the edges of an overlap with these `ends`,
/// the right one if `symmetric`: where stresses grow towards an edge they are largest there.
fn around([from, to]: [f64; 2], symmetric: bool, excluded: f64) -> Vec<[f64; 2]> {
    if excluded == 0.0 {
        return Vec::new();
    }
    let edges = if symmetric { vec![(to, -1.0)] } else { vec![(from, 1.0), (to, -1.0)] };
    let angles = (0..ANGLES).map(|i| FRAC_PI_2 * i as f64 / (ANGLES - 1) as f64);
    let at = |(edge, inward): (f64, f64), angle: f64| {
        let (sin, cos) = angle.sin_cos();
        [edge + inward * excluded * cos, excluded * sin]
    };
    angles.flat_map(|angle| edges.iter().map(move |edge| at(*edge, angle))).collect()
}

/// The largest value in each of `bodies`.
fn in_bodies(
    solved: &SolvedCase,
    bodies: &[BodyKind],
    objective: Objective,
    excluded: f64,
) -> Vec<Critical> {
    let scene = solved.scene();
    let lines = scene.pressure.line_loads();
    let width = lines.iter().map(|line| line.half_width).fold(0.0, f64::max);
    let across: Vec<f64> = match objective {
        Objective::TauXz => ACROSS.iter().map(|x| x * width).collect(),
        _ => vec![0.0],
    };
    let depths = DEPTHS.map(|z| z * width);
    let shaping = Shaping::of(solved.case());
    let mut searches: Vec<Search> = bodies
        .iter()
        .map(|&body| Search {
            shaping,
            overlap: scene.scene.overlap(),
            objective,
            excluded,
            best: Critical { body, value: 0.0, at: [0.0; 3] },
            along: 0.0,
        })
        .collect();
    // Bodies that share one computation share the stresses before the round shape is added.
    let fields: Vec<BodyField> = match scene.bodies_shared() {
        true => vec![scene.field(BodyKind::Block)],
        false => bodies.iter().map(|body| scene.field(*body)).collect(),
    };
    let each = searches.len() / fields.len();
    let ends = scene.ends();
    let symmetric = scene.scene.is_symmetric();
    let along: Vec<f64> = parameters(symmetric, PLACES).collect();
    let around = around(scene.scene.overlap(), symmetric, excluded);
    for (field, searches) in fields.iter().zip(searches.chunks_mut(each)) {
        let mut look = |t: f64, y: f64, zs: &[f64]| {
            let rows = field.round_down(&across, y, zs);
            searches.iter_mut().for_each(|search| search.look((t, y), (&across, zs), &rows));
        };
        along.iter().for_each(|t| look(*t, place(ends, *t), &depths));
        let inside = around.iter().filter(|[y, _]| (ends[0]..=ends[1]).contains(y));
        inside.for_each(|[y, z]| look(parameter(ends, *y), *y, &[*z]));
        let steps = [along[1] - along[0], 0.075 * width];
        searches.iter_mut().for_each(|search| search.closer(field, ends, steps));
    }
    searches.into_iter().map(|search| search.best).collect()
}

/// The search in one body.
struct Search {
    shaping: Shaping,
    overlap: [f64; 2],
    objective: Objective,
    excluded: f64,
    best: Critical,
    /// Its place along the contact, as [`place`] has it.
    along: f64,
}

impl Search {
    /// Looks at the stresses at a place along the contact, its parameter and y, and these places
    /// across and depths: for each depth those at all places across.
    fn look(&mut self, (t, y): (f64, f64), (xs, zs): (&[f64], &[f64]), rows: &[Vec<RoundStress>]) {
        for (z, row) in zs.iter().zip(rows) {
            for (x, stress) in xs.iter().zip(row) {
                let at = [*x, y, *z];
                if !away_from_edges(at, self.overlap, self.excluded) {
                    continue;
                }
                let stress = self.shaping.stress(self.best.body, stress);
                let value = match self.objective {
                    Objective::TauXz => 2.0 * stress.xz.abs(),
                    _ => stress.von_mises(),
                };
                if value > self.best.value {
                    self.best = Critical { value, at, ..self.best };
                    self.along = t;
                }
            }
        }
    }

    /// Looks closer in all directions about the largest value in the `field` of its body, of a
    /// contact with these `ends`; first at half the step along the contact, and at the other one
    /// across and in depth.
    fn closer(&mut self, field: &BodyField, ends: [f64; 2], [mut along, mut step]: [f64; 2]) {
        for _ in 0..HALVINGS {
            along *= 0.5;
            let (t, [x, _, z]) = (self.along, self.best.at);
            let zs: Vec<f64> = [z - step, z, z + step].into_iter().filter(|z| *z >= 0.0).collect();
            let xs = if x == 0.0 { vec![0.0] } else { vec![x - step, x, x + step] };
            for t in [t - along, t, t + along] {
                if t.abs() <= 1.0 {
                    let y = place(ends, t);
                    self.look((t, y), (&xs, &zs), &field.round_down(&xs, y, &zs));
                }
            }
            step *= 0.5;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Options, Passage};
    use super::*;
    use crate::base::Material;
    use crate::body::EdgeModel;
    use crate::case::{Case, Factors, ProfileKind, ProfileSpec};

    fn solved(crown_m: Option<f64>, eccentricity_m: Option<f64>) -> SolvedCase {
        let material = Material { young_pa: 210e9, poisson: 0.3 };
        let factors = Factors { load: 5e-4, slenderness: 5.0, length_ratio: 0.8 };
        let mut case = Case::from_factors("case", 0.01, material, material, factors);
        case.roller.profile = crown_m.map(|radius_m| {
            let mut profile = ProfileSpec::new(ProfileKind::Crown);
            profile.radius_m = Some(radius_m);
            profile
        });
        case.load.eccentricity_m = eccentricity_m;
        SolvedCase::new(&case.with_tolerance(5e-3), &Options::new(EdgeModel::QuarterSpace)).unwrap()
    }

    #[test]
    fn the_search_meets_the_largest_values() {
        for (crown_m, eccentricity_m) in [(None, None), (Some(0.3), Some(3e-4)), (Some(0.05), None)]
        {
            let solved = solved(crown_m, eccentricity_m);
            let name = format!("{crown_m:?} {eccentricity_m:?}");
            // A dense grid of one body, and the passage with its many instants.
            let body = BodyKind::Block;
            let found = in_bodies(&solved, &[body], Objective::VonMises, 0.1)[0];
            let [from, to] = solved.scene().scene.overlap();
            let mut most = 0.0f64;
            for i in 0..=60 {
                let y = from + (to - from) * f64::from(i) / 60.0;
                let at = (0..=50).map(|j| [0.0, y, 0.03 * f64::from(j)]);
                let overlap = solved.scene().scene.overlap();
                let at: Vec<_> = at.filter(|at| away_from_edges(*at, overlap, 0.1)).collect();
                let stresses = solved.stress(body, &at).unwrap();
                most = stresses.iter().map(|s| s.von_mises()).fold(most, f64::max);
            }
            assert!(found.value > most - 1e-3, "{name}: {found:?} of {most}");
            let there = solved.stress(body, &[found.at]).unwrap()[0].von_mises();
            // Along a curve stresses are interpolated, to a part of the tolerance of 5e-3.
            assert!((found.value - there).abs() < 2e-3, "{name}: {found:?}, there {there}");
            let passage = Passage::new(&solved, body, [33, 31]);
            let range = passage.critical(|m| Some(m.shear_range)).unwrap().value;
            let found = in_bodies(&solved, &[body], Objective::TauXz, 0.1)[0];
            assert!((found.value - range).abs() < 0.01, "{name}: {found:?} of {range}");
            let found = peak(&solved, Objective::Pressure, 0.1);
            let line = (-200..=200).map(|i| 0.01 * f64::from(i) * 0.5 * (to - from));
            let overlap = solved.scene().scene.overlap();
            let line = line.filter(|y| away_from_edges([0.0, *y, 0.0], overlap, 0.1));
            let most = line.map(|y| solved.pressure(0.0, y)).fold(0.0, f64::max);
            assert!((found.value - most).abs() < 2e-3, "{name}: {found:?} of {most}");
        }
    }
}
