//! The main results of many cases with one scene, without the curves and cells of a complete
//! solution.

use super::approached::{approach_m, with_force};
use super::cells::{largest, pressure_cells};
use super::options::Options;
use super::shaping::Shaping;
use super::solved::place_of;
use super::solved_scene::{Approaches, SolvedScene};
use crate::base::{HertzScales, PerBody, Result};
use crate::body::{EdgeModel, Resolution};
use crate::case::Case;
use crate::stress::{
    BodyKind, Critical, EDGE, RoundStress, away_from_edge, away_from_edges, curves,
};

/// Distances from the contact's end at +y (C), that of the shorter body, at which [`KeyResults`]
/// states the pressure.
pub const END_DISTANCES: [f64; 8] = [0.1, 0.2, 0.3, 0.5, 1.0, 2.0, 3.0, 5.0];

/// The main results of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct KeyResults {
    /// The scales.
    pub hertz: HertzScales,
    /// Load (N).
    pub load_n: f64,
    /// Approach of points one roller radius below the surfaces (m).
    pub approach_m: f64,
    /// Pressure at the contact's centre (p0).
    pub p_centre: f64,
    /// Largest pressure of the cells (p0).
    pub p_max: f64,
    /// Its place x, y (C).
    pub p_max_at: [f64; 2],
    /// Pressure (p0) at x = 0 and the [`END_DISTANCES`] from the end at +y; none beyond the centre.
    pub p_at: [Option<f64>; END_DISTANCES.len()],
    /// The most stressed place of both bodies outside 0.1 C of the contact's ends.
    pub critical: Critical,
    /// What to beware of, see [`SolvedScene::warnings`].
    pub warnings: Vec<&'static str>,
}

/// A stress at a place, in units of C and p0.
type Sample = (BodyKind, [f64; 3], RoundStress);

/// Largest C / R for which samples are kept. Only closely conforming raceways under the largest
/// loads exceed it.
const LARGEST_CURVATURE: f64 = 1.0;

/// Relative error that rounding leaves in a stress.
const ROUNDING: f64 = 1e-12;

/// What the main results of all cases of one [`Scene`](super::Scene) are read from: small, so that
/// many of them can be kept.
#[derive(Debug)]
pub struct KeySolution {
    approaches: Approaches,
    p_centre: f64,
    p_max: f64,
    p_max_at: [f64; 2],
    p_at: [Option<f64>; END_DISTANCES.len()],
    /// Largest C / R of the cases whose critical stress is among the samples.
    curvature: f64,
    samples: Vec<Sample>,
    warnings: Vec<&'static str>,
}

impl KeySolution {
    /// Solves the contact of `case` by `method`, and returns the case with its force, which is
    /// found first if the approach is given in its place. The largest stress is sought on all
    /// standard curves, but for straight and parallel bodies without sliding at tolerances from
    /// 5e-3 on: a search along the curves in the plane x = 0 finds it there within 3e-3 p0 at 1e-2
    /// and 2e-3 at 5e-3 (a test of this module checks that), of very unlike bodies within 6.5e-3.
    ///
    /// # Errors
    /// [`crate::base::Error::NotConverged`] when the contact does not settle.
    pub fn new(case: &Case, method: EdgeModel) -> Result<(Case, Self)> {
        let (case, solved) = with_force(case, &Options::new(method))?;
        let scene = &solved.scene;
        let cells = pressure_cells(&solved);
        let top = largest(&cells);
        let along = |s: f64| {
            let y = scene.half_length - s;
            (y >= 0.0).then(|| solved.pressure.at(0.0, scene.middle + y))
        };
        let curvature = Shaping::of(&case).largest_curvature().max(LARGEST_CURVATURE);
        let mut samples = samples(&solved);
        if !scene.slides {
            let [block, roller] = [&scene.bodies.block, &scene.bodies.roller].map(|body| body.half);
            keep_candidates(&mut samples, curvature, block.min(roller) / roller);
        }
        let own = Self {
            approaches: solved.approaches(),
            p_centre: solved.pressure.at(0.0, scene.span().centre()),
            p_max: top.p,
            p_max_at: place_of(&solved, top),
            p_at: END_DISTANCES.map(along),
            curvature,
            samples,
            warnings: solved.warnings(),
        };
        Ok((case, own))
    }

    /// Whether the main results of a case of the scene can be read from this.
    pub fn serves(&self, case: &Case) -> bool {
        Shaping::of(case).largest_curvature() <= self.curvature
    }

    /// The main results of a case of the scene that this [`KeySolution::serves`].
    pub fn of(&self, case: &Case) -> KeyResults {
        KeyResults {
            hertz: case.hertz(),
            load_n: case.load.force_n,
            approach_m: approach_m(&self.approaches, case),
            p_centre: self.p_centre,
            p_max: self.p_max,
            p_max_at: self.p_max_at,
            p_at: self.p_at,
            critical: critical(&self.samples, &Shaping::of(case)),
            warnings: self.warnings.clone(),
        }
    }

    /// Memory that it takes (bytes).
    pub fn bytes(&self) -> usize {
        let lists = size_of_val(self.samples.as_slice()) + size_of_val(self.warnings.as_slice());
        size_of::<Self>() + self.approaches.bytes() + lists
    }
}

/// Removes samples that are critical for no C / R up to `largest`, where there is no friction and
/// the shorter body is `loaded` lengths of the roller long.
fn keep_candidates(samples: &mut Vec<Sample>, largest: f64, loaded: f64) {
    let at = |curvature: f64, (body, _, stress): &Sample| {
        let curvatures = PerBody { block: curvature, roller: curvature };
        Shaping { curvatures, loaded, friction: 0.0 }.stress(*body, stress).von_mises()
    };
    // Von Mises' stress is convex in the curvature.
    let most = |s: &Sample| at(largest, s).max(at(-largest, s));
    let least = |s: &Sample| 2.0 * at(0.0, s) - most(s);
    let bound = samples.iter().map(least).fold(0.0, f64::max) * (1.0 - ROUNDING);
    samples.retain(|s| most(s) >= bound);
    samples.shrink_to_fit();
}

/// The largest von Mises stress of the samples.
fn critical(samples: &[Sample], shaping: &Shaping) -> Critical {
    let value =
        |(body, at, stress): &Sample| (*body, *at, shaping.stress(*body, stress).von_mises());
    Critical::largest(samples.iter().map(value)).expect("both bodies have samples")
}

/// Depths (C) of the search's first pass.
const DEPTHS: [f64; 6] = [0.0, 0.25, 0.5, 0.75, 1.0, 1.5];
/// Distances from an edge along y (C) of the search's first pass, and depths there.
const ALONG: [f64; 3] = [0.3, 1.0, 2.5];
/// Depths of the curves along y (C).
const ALONG_DEPTHS: [f64; 3] = [0.0, 0.5, 0.78];

/// The stresses among which the critical one is sought.
fn samples(solved: &SolvedScene) -> Vec<Sample> {
    let shared = solved.bodies_shared();
    let mut all = Vec::new();
    for (kind, body) in BodyKind::ALL.into_iter().zip(solved.scene.bodies.iter()) {
        if shared && kind == BodyKind::Roller {
            // Bodies that share one computation have equal results.
            let again: Vec<Sample> =
                all.iter().map(|&(_, at, s): &Sample| (BodyKind::Roller, at, s)).collect();
            all.extend(again);
            break;
        }
        let scene = &solved.scene;
        if scene.tolerance < Resolution::COARSE || scene.slides || scene.may_end() {
            every_point(solved, kind, body.ends(), &mut all);
        } else {
            search(solved, kind, body.half, &mut all);
        }
    }
    all
}

/// All points of the standard curves.
fn every_point(solved: &SolvedScene, kind: BodyKind, ends: [f64; 2], all: &mut Vec<Sample>) {
    let field = solved.field(kind);
    let span = solved.scene.span();
    let mut columns: Vec<([f64; 2], Vec<f64>)> = Vec::new();
    let mut index = std::collections::HashMap::new();
    for curve in curves::curves_on(kind, &span, ends) {
        for [x, y, z] in curve.points {
            if !away_from_edges([x, y, z], span.ends, EDGE) {
                continue;
            }
            let column = *index.entry((y.to_bits(), z.to_bits())).or_insert_with(|| {
                columns.push(([y, z], Vec::new()));
                columns.len() - 1
            });
            columns[column].1.push(x);
        }
    }
    for ([y, z], xs) in columns {
        let stresses = field.round_at(y, z, &xs);
        all.extend(xs.iter().zip(stresses).map(|(&x, s)| (kind, [x, y, z], s)));
    }
}

/// A first pass over all standard curves of a symmetric contact, and then closer points around the
/// largest stress; `half` is the body's half-length.
fn search(solved: &SolvedScene, kind: BodyKind, half: f64, all: &mut Vec<Sample>) {
    let field = solved.field(kind);
    let half_length = solved.scene.half_length;
    let start = all.len();
    let mut seen = Vec::new();
    let mut add = |y: f64, z: f64, all: &mut Vec<Sample>| -> f64 {
        let inside = (0.0..=half * (1.0 + 1e-12)).contains(&y) && z >= 0.0;
        if !inside
            || !away_from_edge([0.0, y, z], half_length, EDGE)
            || seen.contains(&(y.to_bits(), z.to_bits()))
        {
            return 0.0;
        }
        seen.push((y.to_bits(), z.to_bits()));
        let stress = field.round_at(y, z, &[0.0])[0];
        all.push((kind, [0.0, y, z], stress));
        stress.flat.pressure.von_mises()
    };
    for y in [0.0, 0.9 * half_length, half_length] {
        for z in DEPTHS {
            add(y, z, all);
        }
    }
    // At the end the stress may be largest just outside the excluded part.
    add(half_length, EDGE, all);
    for z in ALONG_DEPTHS {
        for s in ALONG.into_iter().chain((z == 0.0).then_some(EDGE)) {
            add(half_length - s, z, all);
        }
        add((half_length + EDGE).min(half), z, all);
    }
    // The surface across the contact, where it is largest for small Poisson's ratios.
    let xs = [0.25, 0.5, 0.75, 1.0, 1.25];
    for (x, s) in xs.into_iter().zip(field.round_at(0.0, 0.0, &xs)) {
        all.push((kind, [x, 0.0, 0.0], s));
    }
    // A step to either side of the largest stress, halved twice.
    let best = |all: &[Sample]| {
        let own = all[start..].iter().filter(|s| s.1[0] == 0.0);
        own.map(|s| (s.2.flat.pressure.von_mises(), s.1)).max_by(|a, b| a.0.total_cmp(&b.0))
    };
    let mut step = 0.125;
    for _ in 0..3 {
        let Some((_, [_, y, z])) = best(all) else { return };
        let on_depth = [0.0, 0.9 * half_length, half_length].contains(&y);
        if on_depth {
            add(y, z + step, all);
            add(y, z - step, all);
        }
        if ALONG_DEPTHS.contains(&z) && y > 0.5 * half_length {
            add(y + 2.0 * step, z, all);
            add(y - 2.0 * step, z, all);
        }
        step *= 0.5;
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Options, solve};
    use super::*;
    use crate::base::{Material, StressTensor};
    use crate::case::Factors;
    use crate::stress::FlatStress;

    /// On the surface in the plane x = 0 a round shape adds next to nothing, and the largest stress
    /// of all curvatures is that of none but for rounding.
    #[test]
    fn a_sample_alone_is_kept() {
        let mut state = 1u64;
        let mut draw = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        for i in 0..10_000 {
            let mut tensor = |size: f64| {
                let [xx, yy, zz, yz] = std::array::from_fn(|_| size * draw());
                let pressure = StressTensor { xx, yy, zz, yz, ..StressTensor::default() };
                FlatStress { pressure, ..FlatStress::default() }
            };
            let stress = RoundStress { flat: tensor(1.0), round: tensor(1e-16) };
            let body = BodyKind::ALL[i % 2];
            let mut samples = vec![(body, [0.0; 3], stress)];
            keep_candidates(&mut samples, LARGEST_CURVATURE, 0.8);
            assert_eq!(samples.len(), 1, "{stress:?}");
        }
    }

    #[test]
    fn the_search_finds_the_largest_stress_of_the_curves() {
        for (slenderness, length_ratio, poisson) in [
            (5.0, 1.0, 0.3),
            (5.0, 0.5, 0.3),
            (20.0, 0.9, 0.3),
            (2.0, 0.3, 0.1),
            (40.0, 1.0, 0.45),
            (1.0, 0.99, 0.25),
        ] {
            let material = Material { young_pa: 210e9, poisson };
            let factors = Factors { load: 5e-4, slenderness, length_ratio };
            let case = Case::from_factors("case", 0.01, material, material, factors);
            let method = EdgeModel::QuarterSpace;
            // The curves' points are interpolated, the search's are not; both stay within the
            // tolerance of the truth.
            for (tolerance, limit) in [(1e-2, 3e-3), (5e-3, 2e-3)] {
                let case = case.clone().with_tolerance(tolerance);
                let whole = solve(&case, &Options::new(method)).unwrap();
                let p0 = whole.curves.hertz.p0_pa;
                let all = whole.summary.critical.unwrap();
                let (case, solution) = KeySolution::new(&case, method).unwrap();
                let found = solution.of(&case).critical;
                let less = all.value_pa / p0 - found.value;
                assert!(
                    less < limit,
                    "{slenderness} {length_ratio} {poisson}: {found:?} of {all:?}"
                );
            }
        }
    }
}
