//! What the material of a body goes through as the contact passes it: at a place (y, z) it sees the
//! stresses along x, one after the other.

use super::extent::Extent;
use super::shaping::Shaping;
use super::solved::SolvedCase;
use crate::base::{BodyKind, HertzScales, StressTensor, ledge};
use crate::case::Fatigue;
use crate::fatigue::{Extreme, Measures, Parameters};
use crate::stress::{BodyField, EDGE, Load, away_from_edges};
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// From this x to its opposite the contact passes, in half-widths of the contact. There stresses
/// are at most 3e-4 p0, under a friction of 0.3 0.004: Dang Van's measure may be largest without a
/// load.
const REACH: f64 = 100.0;

/// Steps of a passage within 1.5 half-widths, and beyond on each side.
const STEP: f64 = 0.025;
const BEYOND: i32 = 44;

/// Distances from the contact's edge of further steps, in its half-width there: on the surface
/// under a traction sigma_xx has its largest value at the edge, with a vertical tangent beside it
/// (Johnson, Contact Mechanics, 1985, Fig. 7.4).
const BESIDE: [f64; 4] = [3e-4, 1e-3, 3e-3, 9e-3];

/// Largest depth of the places, and distance beyond the other body's end, in half-widths of the
/// contact.
const DEPTH: f64 = 3.0;

/// The measures of fatigue at places over the length and the depth of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Passage {
    /// The body.
    pub body: BodyKind,
    /// The distances from the contact's middle during the passage, ascending (C), for each y.
    x: Vec<Vec<f64>>,
    /// Places along the body, ascending (C); of a contact that is symmetric about y = 0 those from
    /// there on.
    pub y: Vec<f64>,
    /// Depths, ascending from 0 (C).
    pub z: Vec<f64>,
    /// The measures (p0) at all places, y running fastest.
    pub measures: Vec<Measures>,
    /// The contact's largest half-width (C).
    width: f64,
    ends: [f64; 2],
}

impl Passage {
    /// The passage of `body` in a solved case, at `counts` places along y and down z, at least 2
    /// each. Runs on all threads of the current pool.
    pub fn new(solved: &SolvedCase, body: BodyKind, counts: [usize; 2]) -> Self {
        let scene = solved.scene();
        let lines = scene.pressure.line_loads();
        let width = lines.iter().map(|line| line.half_width).fold(0.0, f64::max);
        let own = Extent::of(solved.case(), body).ends_m().map(|y| y / solved.hertz().c_m);
        let y = along(
            scene.scene.overlap(),
            own,
            scene.pressure.is_symmetric(),
            DEPTH * width,
            counts[0],
        );
        let share = |i: usize| i as f64 / (counts[1] - 1) as f64;
        let z: Vec<f64> = (0..counts[1]).map(|i| DEPTH * width * share(i).powi(2)).collect();
        Self::at(solved, body, width, [y, z])
    }

    /// The passage of the same body at the same places of the same case, as another model has
    /// solved it.
    #[must_use]
    pub fn by(&self, solved: &SolvedCase) -> Self {
        Self::at(solved, self.body, self.width, [&self.y, &self.z].map(Clone::clone))
    }

    /// The passage of `body` at the places of a grid, past a contact of the largest half-width
    /// `width`.
    fn at(solved: &SolvedCase, body: BodyKind, width: f64, [y, z]: [Vec<f64>; 2]) -> Self {
        let (case, hertz) = (solved.case(), *solved.hertz());
        let scene = solved.scene();
        let edge = |y: &f64| scene.pressure.modes(*y).map_or(0.0, |(half_width, _)| half_width);
        let ahead: Vec<Vec<f64>> = y.iter().map(|y| positive_steps(width, edge(y))).collect();
        let place = Place {
            field: scene.field(body),
            body,
            shaping: Shaping::of(case),
            turn: solved.curvature(body),
            parameters: parameters(&case.fatigue, &hertz, body_modulus(solved, body)),
        };
        let count = y.len() * z.len();
        let measures = (0..count).into_par_iter();
        let of = |i: usize| place.measures(y[i % y.len()], z[i / y.len()], &ahead[i % y.len()]);
        let measures = measures.map(of).collect();
        let x = ahead.iter().map(|ahead| both_ways(ahead)).collect();
        Self { body, x, y, z, measures, width, ends: scene.scene.overlap() }
    }

    /// Whether a place counts: not within 0.1 C of the overlap's edges, where stresses may have no
    /// limit.
    fn counts(&self, place: usize) -> bool {
        let [y, z] = self.place(place);
        away_from_edges([0.0, y, z], self.ends, EDGE)
    }

    /// y and z of a place (C).
    pub fn place(&self, place: usize) -> [f64; 2] {
        [self.y[place % self.y.len()], self.z[place / self.y.len()]]
    }

    /// The distances from the contact's middle while it passes a place, ascending (C): the instants
    /// of the history.
    pub fn instants(&self, place: usize) -> &[f64] {
        &self.x[place % self.y.len()]
    }

    /// The place with the largest value of a measure, among those that count; none without the
    /// measure.
    pub fn critical(&self, of: impl Fn(&Measures) -> Option<f64>) -> Option<Extreme> {
        let all = self.measures.iter().enumerate().filter(|(i, _)| self.counts(*i));
        let values = all.filter_map(|(at, m)| of(m).map(|value| Extreme { value, at }));
        values.reduce(|most, next| if next.value > most.value { next } else { most })
    }
}

/// Shear modulus of a body (p0).
fn body_modulus(solved: &SolvedCase, body: BodyKind) -> f64 {
    let material = solved.case().material(body);
    0.5 * material.young_pa / (1.0 + material.poisson) / solved.hertz().p0_pa
}

/// The case's parameters in units of p0.
fn parameters(given: &Fatigue, hertz: &HertzScales, modulus: f64) -> Parameters {
    let own = |residual_pa: Option<f64>| residual_pa.unwrap_or(0.0) / hertz.p0_pa;
    let strain = given.fatemi_socie_k.zip(given.yield_pa);
    Parameters {
        alpha: given.dang_van_alpha,
        fatemi_socie: strain.map(|(k, yield_pa)| [k * hertz.p0_pa / yield_pa, modulus]),
        residual: StressTensor {
            xx: own(given.residual_xx_pa),
            yy: own(given.residual_yy_pa),
            ..StressTensor::default()
        },
    }
}

/// x >= 0 of a passage (C) over a contact of half-width up to `width`, whose edge is at `edge`;
/// zero without contact.
fn positive_steps(width: f64, edge: f64) -> Vec<f64> {
    let near = (0..=60).map(|i| STEP * f64::from(i));
    let far = (1..=BEYOND).map(|i| 1.5 * (REACH / 1.5).powf(f64::from(i) / f64::from(BEYOND)));
    let mut x: Vec<f64> = near.chain(far).map(|x| width * x).collect();
    if edge > 0.0 {
        x.extend(BESIDE.iter().flat_map(|off| [edge * (1.0 - off), edge * (1.0 + off)]));
        x.push(edge);
        x.sort_by(f64::total_cmp);
        x.dedup();
    }
    x
}

/// The places of both signs whose distances from zero, the first of them, are these.
fn both_ways(ahead: &[f64]) -> Vec<f64> {
    ahead[1..].iter().rev().map(|x| -x).chain(ahead.iter().copied()).collect()
}

/// Places along a body with the ends `own`: `count` on the overlap, from its middle if it is
/// `symmetric`, closer towards its ends, and half as many up to `reach` beyond an end that the body
/// goes past.
fn along(overlap: [f64; 2], own: [f64; 2], symmetric: bool, reach: f64, count: usize) -> Vec<f64> {
    let (middle, half) = (0.5 * (overlap[0] + overlap[1]), 0.5 * (overlap[1] - overlap[0]));
    let from = if symmetric { 0.0 } else { -1.0 };
    let mut y: Vec<f64> = (0..count)
        .map(|i| from + (1.0 - from) * i as f64 / (count - 1) as f64)
        .map(|t| middle + half * (FRAC_PI_2 * t).sin())
        .collect();
    // The ends exactly.
    y[count - 1] = overlap[1];
    if !symmetric {
        y[0] = overlap[0];
    }
    let more = count / 2;
    for (side, beyond) in [(1.0, own[1] - overlap[1]), (-1.0, overlap[0] - own[0])] {
        if ledge(beyond, half) == 0.0 || (symmetric && side < 0.0) {
            continue;
        }
        let end = if side > 0.0 { overlap[1] } else { overlap[0] };
        let reach = beyond.min(reach);
        y.extend((1..=more).map(|i| end + side * reach * (i as f64 / more as f64).powi(2)));
    }
    y.sort_by(f64::total_cmp);
    y
}

/// What the histories of all places of a body have in common.
struct Place<'a> {
    field: BodyField<'a>,
    body: BodyKind,
    shaping: Shaping,
    /// C / R: the material turns with a round surface.
    turn: f64,
    parameters: Parameters,
}

impl Place<'_> {
    /// The measures of the history at these `distances` from x = 0 on either side of it.
    fn measures(&self, y: f64, z: f64, distances: &[f64]) -> Measures {
        let ahead = self.field.round_at(y, z, distances);
        let behind = ahead[1..].iter().rev().map(|s| s.mirrored_in_x());
        let history: Vec<StressTensor> = behind
            .chain(ahead.iter().copied())
            .zip(both_ways(distances))
            .map(|(s, x)| turned(&self.shaping.stress(self.body, &s), self.turn * x))
            .collect();
        Measures::of(&history, &self.parameters)
    }
}

/// A stress in axes turned by `angle` from x towards z: those of a surface that falls by this
/// slope.
fn turned(s: &StressTensor, angle: f64) -> StressTensor {
    let (sin, cos) = angle.sin_cos();
    StressTensor {
        xx: cos * cos * s.xx + 2.0 * sin * cos * s.xz + sin * sin * s.zz,
        yy: s.yy,
        zz: sin * sin * s.xx - 2.0 * sin * cos * s.xz + cos * cos * s.zz,
        xy: cos * s.xy + sin * s.yz,
        xz: (cos * cos - sin * sin) * s.xz + sin * cos * (s.zz - s.xx),
        yz: cos * s.yz - sin * s.xy,
    }
}

#[cfg(test)]
mod tests {
    use super::super::Options;
    use super::*;
    use crate::base::Material;
    use crate::body::EdgeModel;
    use crate::case::{Case, Factors};

    #[test]
    fn a_passage_has_the_shear_range_of_a_long_contact() {
        // Plane strain everywhere: without lateral strain flush ends are not felt.
        let material = Material { young_pa: 210e9, poisson: 0.0 };
        let factors = Factors { load: 1e-6, slenderness: 5.0, length_ratio: 1.0 };
        let case = Case::from_factors("case", 0.01, material, material, factors);
        let solved = SolvedCase::new(&case, &Options::new(EdgeModel::QuarterSpace)).unwrap();
        let passage = Passage::new(&solved, BodyKind::Block, [5, 61]);
        let critical = passage.critical(|m| Some(m.shear_range)).unwrap();
        // Johnson, Contact Mechanics, 1985, section 4.1: 0.25 p0 at 0.5 C, on either side.
        assert!((critical.value - 0.5).abs() < 0.0015, "{critical:?}");
        let [_, z] = passage.place(critical.at);
        assert!((z - 0.5).abs() < 0.06, "at {z}");
        assert!(passage.measures.iter().all(|m| m.dang_van.is_none() && m.fatemi_socie.is_none()));
        let shear = passage.critical(|m| Some(m.tau_max.value)).unwrap();
        // On the surface sigma_yy = 0 stands against the pressure.
        assert!((shear.value - 0.5).abs() < 5e-3, "{shear:?}");
        let instant = passage.instants(shear.at)[passage.measures[shear.at].tau_max.at];
        assert!(instant.abs() < 0.03);
    }

    #[test]
    fn another_model_is_seen_at_the_same_places() {
        // Half-spaces' contact is wider at its ends: places of its own would lie deeper.
        let material = Material { young_pa: 210e9, poisson: 0.3 };
        let factors = Factors { load: 3e-4, slenderness: 5.0, length_ratio: 0.8 };
        let case = Case::from_factors("case", 0.01, material, material, factors);
        let case = case.with_tolerance(1e-2);
        let [own, other] = [EdgeModel::QuarterSpace, EdgeModel::HalfSpace]
            .map(|model| SolvedCase::new(&case, &Options::new(model)).unwrap());
        let passage = Passage::new(&own, BodyKind::Block, [4, 4]);
        let beside = passage.by(&other);
        assert_eq!((&passage.y, &passage.z), (&beside.y, &beside.z));
        for place in [1, 6, 10] {
            let [y, z] = passage.place(place);
            let at: Vec<[f64; 3]> = beside.instants(place).iter().map(|x| [*x, y, z]).collect();
            let history = other.stress(BodyKind::Block, &at).unwrap();
            let shear = crate::fatigue::shear_range(&history);
            let found = beside.measures[place].shear_range;
            assert!((found - shear).abs() < 2e-3, "at {y}, {z}: {found}, not {shear}");
        }
    }

    /// A crowned roller that slides: the contact is the narrower the nearer to its end, and a place
    /// of the surface has its largest tension at the contact's edge there.
    #[test]
    fn the_local_edge_of_a_sliding_contact_is_seen() {
        let text = r#"
            name = "crown"
            block = { length_m = 12e-3, young_pa = 210e9, poisson = 0.3 }
            load.force_n = 1500.0
            sliding.friction = 0.3
            fatigue.dang_van_alpha = 0.5
            accuracy.tolerance = 1e-2
            [roller]
            radius_m = 10e-3
            length_m = 8e-3
            young_pa = 210e9
            poisson = 0.3
            profile = { kind = "crown", radius_m = 0.5 }"#;
        let case = Case::from_toml(text).unwrap();
        let solved = SolvedCase::new(&case, &Options::new(EdgeModel::QuarterSpace)).unwrap();
        let passage = Passage::new(&solved, BodyKind::Block, [12, 2]);
        let within = |y: f64| solved.scene().pressure.modes(y).map(|(half_width, _)| half_width);
        let widths: Vec<f64> = passage.y.iter().map_while(|y| within(*y)).collect();
        assert!(widths.len() >= 5, "{widths:?}");
        for (place, half_width) in widths.into_iter().enumerate() {
            let [y, z] = passage.place(place);
            let beside = |off: f64| [1.0 - off, 1.0 + off, off - 1.0, -off - 1.0];
            let near = (0..400).map(|i| (-0.04 * f64::from(i)).exp());
            let mut x: Vec<f64> = near.flat_map(beside).chain(beside(0.0)).collect();
            x.sort_by(f64::total_cmp);
            let at: Vec<[f64; 3]> = x.iter().map(|x| [x * half_width, y, z]).collect();
            let history = solved.stress(BodyKind::Block, &at).unwrap();
            let want = crate::fatigue::dang_van(&history, 0.5).value;
            let found = passage.measures[place].dang_van.unwrap();
            assert!((found.value - want).abs() < 5e-4, "at {y}: {found:?}, not {want}");
            let instant = passage.instants(place)[found.at];
            assert!((instant.abs() - half_width).abs() < 1e-9, "at {y}: {instant}");
        }
    }

    #[test]
    fn turning_with_the_surface_keeps_invariants() {
        let s = StressTensor { xx: 1.0, yy: -2.0, zz: 0.5, xy: 0.7, xz: -0.3, yz: 1.1 };
        let t = turned(&s, 0.4);
        assert!((t.von_mises() - s.von_mises()).abs() < 1e-14);
        // Under a pressure normal to a surface of that slope there is no shear along it.
        let (sin, cos) = 0.4f64.sin_cos();
        let pressed =
            StressTensor { xx: -sin * sin, zz: -cos * cos, xz: sin * cos, ..Default::default() };
        let t = turned(&pressed, 0.4);
        assert!((t.zz + 1.0).abs() < 1e-14 && t.xz.abs() < 1e-14 && t.xx.abs() < 1e-14);
    }

    #[test]
    fn places_reach_both_ends_and_beyond() {
        let y = along([-5.0, 5.0], [-5.0, 9.0], false, 3.0, 5);
        assert_eq!((y[0], y[4], y[6]), (-5.0, 5.0, 8.0));
        let y = along([-5.0, 5.0], [-6.0, 6.0], true, 3.0, 5);
        assert_eq!((y[0], y[4], y[6]), (0.0, 5.0, 6.0));
        assert!(y.windows(2).all(|w| w[0] < w[1]));
    }
}
