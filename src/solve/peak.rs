//! The largest pressure or stress of a whole contact, wherever it is: what a profile is judged by.

use super::shaping::Shaping;
use super::solved::SolvedCase;
use crate::base::BodyKind;
use crate::case::Objective;
use crate::stress::{BodyField, Critical, away_from_edges};
use std::f64::consts::FRAC_PI_2;

/// Places along the contact, closer towards its ends.
const PLACES: usize = 33;

/// Depths, in the largest half-widths of the contact: where von Mises stress and shear are largest
/// at a plane strain, and at the narrower contact of a loaded end.
const DEPTHS: [f64; 8] = [0.0, 0.15, 0.3, 0.4, 0.5, 0.6, 0.7, 0.85];

/// Places across the contact where the shear stress is largest, in half-widths.
const ACROSS: [f64; 5] = [0.5, 0.65, 0.8, 0.9, 1.0];

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
        let (y, value) = highest(ends, scene.scene.is_symmetric(), 4 * PLACES, value);
        return Critical { body: BodyKind::Block, value, at: [0.0, y, 0.0] };
    }
    let bodies = BodyKind::ALL.map(|body| of_body(solved, body, objective, excluded));
    let [block, roller] = bodies;
    if roller.value > block.value { roller } else { block }
}

/// The largest value of a function along a line, on `count` places and then closer about the
/// largest.
fn highest(
    ends: [f64; 2],
    symmetric: bool,
    count: usize,
    mut value: impl FnMut(f64) -> f64,
) -> (f64, f64) {
    let [from, to] = ends;
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let least = if symmetric { 0.0 } else { -1.0 };
    let place = |t: f64| middle + half * (FRAC_PI_2 * t).sin();
    let mut step = (1.0 - least) / (count - 1) as f64;
    let at = |i: usize| least + step * i as f64;
    let all = (0..count).map(at).map(|t| (t, value(place(t))));
    let mut best =
        all.reduce(|best, next| if next.1 > best.1 { next } else { best }).expect("places");
    for _ in 0..HALVINGS {
        step *= 0.5;
        for t in [best.0 - step, best.0 + step] {
            if (least..=1.0).contains(&t) {
                let next = (t, value(place(t)));
                if next.1 > best.1 {
                    best = next;
                }
            }
        }
    }
    (place(best.0), best.1)
}

/// The largest value in one body.
fn of_body(solved: &SolvedCase, body: BodyKind, objective: Objective, excluded: f64) -> Critical {
    let scene = solved.scene();
    let lines = scene.pressure.line_loads();
    let width = lines.iter().map(|line| line.half_width).fold(0.0, f64::max);
    let mut search = Search {
        field: scene.field(body),
        shaping: Shaping::of(solved.case()),
        overlap: scene.scene.overlap(),
        objective,
        excluded,
        best: Critical { body, value: 0.0, at: [0.0; 3] },
    };
    let across: Vec<f64> = match objective {
        Objective::TauXz => ACROSS.iter().map(|x| x * width).collect(),
        _ => vec![0.0],
    };
    let depths = DEPTHS.map(|z| z * width);
    let symmetric = scene.scene.is_symmetric();
    highest(scene.ends(), symmetric, PLACES, |y| search.at(y, &across, &depths));
    // Closer in all directions: between the depths of the first search the largest value may lie at
    // another place.
    let (mut step, [from, to]) = (0.075 * width, scene.ends());
    let mut along = FRAC_PI_2 * 0.5 * (to - from) / (PLACES - 1) as f64;
    for _ in 0..HALVINGS {
        let [x, y, z] = search.best.at;
        let zs: Vec<f64> = [z - step, z, z + step].into_iter().filter(|z| *z >= 0.0).collect();
        let xs = if x == 0.0 { vec![0.0] } else { vec![x - step, x, x + step] };
        for y in [y - along, y, y + along] {
            if (from..=to).contains(&y) {
                search.at(y, &xs, &zs);
            }
        }
        step *= 0.5;
        along *= 0.5;
    }
    search.best
}

/// The search in one body.
struct Search<'a> {
    field: BodyField<'a>,
    shaping: Shaping,
    overlap: [f64; 2],
    objective: Objective,
    excluded: f64,
    best: Critical,
}

impl Search<'_> {
    /// The largest value at `y` and these places across and depths.
    fn at(&mut self, y: f64, xs: &[f64], zs: &[f64]) -> f64 {
        let rows = self.field.round_down(xs, y, zs);
        let mut largest = 0.0;
        for (z, row) in zs.iter().zip(rows) {
            for (x, stress) in xs.iter().zip(row) {
                let at = [*x, y, *z];
                if !away_from_edges(at, self.overlap, self.excluded) {
                    continue;
                }
                let stress = self.shaping.stress(self.best.body, &stress);
                let value = match self.objective {
                    Objective::TauXz => 2.0 * stress.xz.abs(),
                    _ => stress.von_mises(),
                };
                largest = f64::max(largest, value);
                if value > self.best.value {
                    self.best = Critical { value, at, ..self.best };
                }
            }
        }
        largest
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
            let found = of_body(&solved, body, Objective::VonMises, 0.1);
            let [from, to] = solved.scene().ends();
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
            let found = of_body(&solved, body, Objective::TauXz, 0.1);
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
