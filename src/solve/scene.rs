//! A contact in units of C and p0: a case without its scales.

use crate::base::{Material, PerBody, Profile, ledge};
use crate::body::{EdgeModel, End, corner_exponent};
use crate::case::{Accuracy, Block, Case, Load, Pose, Roller, Sliding};
use crate::contact::Shaped;
use crate::stress::BodyKind;
use crate::stress::curves::Span;
use std::f64::consts::PI;

/// A number smaller than this part of a length or an angle beside it is rounding.
const NOTHING: f64 = 1e-9;

/// Largest change of the pressure and of stresses by a round surface between free ends, per C / R
/// (p0), the part of a tolerance that is not felt, and the largest C / R that it is known for: what
/// is of first order in it means nothing beyond.
const ROUND: f64 = 0.8;
const UNFELT: f64 = 0.05;
const ROUNDEST: f64 = 0.1;

/// One of the two bodies of a [`Scene`].
#[derive(Debug, Clone, PartialEq)]
pub struct SceneBody {
    /// Half-length (C).
    pub half: f64,
    /// Place of its middle (C).
    pub middle: f64,
    /// Poisson's ratio.
    pub nu: f64,
    /// Share of the contact compliance, E* (1 - nu^2) / E.
    pub share: f64,
    /// Its profile, in units of C; none if it is straight.
    pub profile: Option<Profile>,
}

impl SceneBody {
    /// Its ends along y (C).
    pub fn ends(&self) -> [f64; 2] {
        [self.middle - self.half, self.middle + self.half]
    }
}

/// What is known of the bodies' tilt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tilt {
    /// It is held (C / (2 R)), for the lines x = 0 at the depth of the roller's radius.
    Held(f64),
    /// It is free, and the load's line of action lies at this y (C).
    Free(f64),
}

/// A dimensionless contact. The load factor W is not in it, unless a profile, a tilt or a round
/// surface needs it: else only the approach's reference depth and the roller's
/// diametral tension know the radius. y is counted from the roller's middle.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Half-length of the bodies' overlap (C).
    pub half_length: f64,
    /// Place of the overlap's middle (C).
    pub middle: f64,
    /// The two bodies.
    pub bodies: PerBody<SceneBody>,
    /// The load, the integral of p (C^2 p0).
    pub load: f64,
    /// The tilt.
    pub tilt: Tilt,
    /// Whether the contact carries a traction along x. Of which friction does not matter: the
    /// stresses under a traction equal to the pressure are kept by themselves.
    pub slides: bool,
    /// Whether measured heights come on top of the surfaces: nothing is symmetric then. Only the
    /// engine on cells takes them.
    pub rough: bool,
    /// 2 R / C, R the equivalent radius, where a profile or a held tilt needs it, otherwise zero.
    pub steepness: f64,
    /// Depth (C) of the lines whose tilt is held; zero where none is, or where they are parallel by
    /// symmetry.
    pub depth: f64,
    /// C / R of each body whose round surface changes pressures and stresses beside free end faces,
    /// [`crate::body::Skins`]; zero where that is not asked for or does not matter.
    pub curvatures: PerBody<f64>,
    /// `curvatures` as parts of each body's own C / R: less than 1 where that is more than terms of
    /// first order bear, else 1.
    pub felt: PerBody<f64>,
    /// The edge model.
    pub model: EdgeModel,
    /// Weight of the images of `guilbault`; by default [`crate::body::guilbault_psi`] of each body.
    pub psi: Option<f64>,
    /// Requested accuracy (p0).
    pub tolerance: f64,
}

impl SceneBody {
    /// A straight body of half-length `half` (C) with its middle at y = 0, of Poisson's ratio `nu`
    /// and `share` of the compliance.
    pub fn straight(half: f64, nu: f64, share: f64) -> Self {
        Self { half, middle: 0.0, nu, share, profile: None }
    }
}

impl Scene {
    /// The scene of parallel `bodies` with their middles at one place, by default edge models' own
    /// psi.
    pub fn symmetric(bodies: PerBody<SceneBody>, model: EdgeModel, tolerance: f64) -> Self {
        let half_length = bodies.block.half.min(bodies.roller.half);
        Self {
            half_length,
            middle: 0.0,
            bodies,
            load: PI * half_length,
            tilt: Tilt::Held(0.0),
            slides: false,
            rough: false,
            steepness: 0.0,
            depth: 0.0,
            curvatures: PerBody { block: 0.0, roller: 0.0 },
            felt: PerBody { block: 1.0, roller: 1.0 },
            model,
            psi: None,
            tolerance,
        }
    }

    /// The scene of a case.
    pub fn new(case: &Case, model: EdgeModel, psi: Option<f64>) -> Self {
        // Each field of a case is in the scene, in the scales or in neither.
        let Case {
            name: _,
            roller,
            block,
            load,
            pose,
            sliding: Sliding { friction },
            fatigue: _,
            surface,
            accuracy: Accuracy { tolerance, first_order },
            cells: _,
        } = case;
        let Roller { radius_m, length_m: roller_m, material: roller_material, profile: _ } = roller;
        let Block { length_m: block_m, material: block_material, radius_m: hollow_m, profile: _ } =
            block;
        let Load { force_n: _, approach_m: _, eccentricity_m } = load;
        let Pose { tilt_rad, offset_m } = pose;
        let hertz = case.hertz();
        let c_m = hertz.c_m;
        let steepness = 2.0 * case.equivalent_radius_m() / c_m;
        let [block_half, roller_half] = [block_m, roller_m].map(|m| rounded(0.5 * m / c_m));
        let offset = unless_nothing(offset_m / c_m, roller_half);
        let roller_ends = [-roller_half, roller_half];
        let block_ends = flush([offset - block_half, offset + block_half], roller_ends);
        let body = |[from, to]: [f64; 2], material: &Material, kind: BodyKind| SceneBody {
            half: 0.5 * (to - from),
            middle: 0.5 * (from + to),
            nu: material.poisson,
            share: rounded(hertz.e_star_pa * material.plane_strain_compliance()),
            profile: case.profile(kind).map(|profile| profile.scaled(1.0 / c_m)),
        };
        let bodies = PerBody {
            block: body(block_ends, block_material, BodyKind::Block),
            roller: body(roller_ends, roller_material, BodyKind::Roller),
        };
        let tilt = match eccentricity_m {
            Some(y) => Tilt::Free(unless_nothing(y / c_m, roller_half)),
            None => {
                let tilt = tilt_rad.unwrap_or(0.0) * steepness;
                Tilt::Held(unless_nothing(tilt, 1.0 / roller_half))
            }
        };
        let profiled = bodies.iter().any(|body| body.profile.is_some());
        let from = block_ends[0].max(roller_ends[0]);
        let to = block_ends[1].min(roller_ends[1]);
        let curvature = |radius_m: f64, nu: f64| {
            let own = rounded(c_m / radius_m);
            let felt = ROUND * own.abs() > UNFELT * tolerance;
            let matters = *first_order && felt && model.end(nu, psi).freed;
            if matters { own } else { 0.0 }
        };
        let curvatures = PerBody {
            block: hollow_m.map_or(0.0, |radius_m| curvature(radius_m, block_material.poisson)),
            roller: curvature(*radius_m, roller_material.poisson),
        };
        let felt = curvatures.map(|own| ROUNDEST / own.abs().max(ROUNDEST));
        let curvatures = curvatures.map(|own| own.clamp(-ROUNDEST, ROUNDEST));
        let scene = Self {
            half_length: 0.5 * (to - from),
            middle: 0.5 * (from + to),
            load: PI * roller_half.min(block_half),
            steepness: if profiled { steepness } else { 0.0 },
            depth: 0.0,
            curvatures,
            felt,
            bodies,
            tilt,
            slides: *friction != 0.0,
            rough: surface.is_some(),
            model,
            psi,
            tolerance: *tolerance,
        };
        scene.held_at(radius_m / c_m)
    }

    /// The scene with its tilt held at a `depth` (C), where the tilt counts.
    fn held_at(self, depth: f64) -> Self {
        match self.tilt {
            // A load in the middle of what is symmetric leaves it parallel; heights are not.
            Tilt::Free(0.0) if self.is_aligned() && !self.rough => {
                Self { tilt: Tilt::Held(0.0), ..self }
            }
            Tilt::Held(_) if !self.is_symmetric() => Self { depth, ..self },
            _ => self,
        }
    }

    /// The same scene in a unit of length that is 1 / `factor` of the present one; the units of
    /// pressure, of load and of displacement follow, so that the gap stays x^2.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let body = |body: &SceneBody| SceneBody {
            half: factor * body.half,
            middle: factor * body.middle,
            profile: body.profile.as_ref().map(|profile| profile.scaled(factor)),
            ..body.clone()
        };
        Self {
            half_length: factor * self.half_length,
            middle: factor * self.middle,
            bodies: self.bodies.map(body),
            load: factor.powi(3) * self.load,
            tilt: match self.tilt {
                Tilt::Held(tilt) => Tilt::Held(factor * tilt),
                Tilt::Free(arm) => Tilt::Free(factor * arm),
            },
            steepness: factor * self.steepness,
            depth: factor * self.depth,
            curvatures: self.curvatures.map(|curvature| curvature / factor),
            ..self.clone()
        }
    }

    /// Whether both bodies have the same ends and Poisson's ratio, and so the same stresses.
    pub fn bodies_are_alike(&self) -> bool {
        let PerBody { block, roller } = &self.bodies;
        block.half == roller.half && block.middle == roller.middle && block.nu == roller.nu
    }

    /// Whether both bodies feel the same part of their round shapes.
    pub fn feels_alike(&self) -> bool {
        self.felt.block == self.felt.roller
    }

    /// The bodies whose stresses differ: like ones are one, with the shares of both.
    pub fn distinct_bodies(&self) -> Vec<(BodyKind, SceneBody)> {
        let [block, roller] = BodyKind::ALL.map(|kind| (kind, self.bodies[kind].clone()));
        if self.bodies_are_alike() {
            let share = block.1.share + roller.1.share;
            return vec![(block.0, SceneBody { share, ..block.1 })];
        }
        vec![block, roller]
    }

    /// Whether bodies and gap are symmetric about y = 0.
    fn is_aligned(&self) -> bool {
        let even = |profile: &Profile| profile.is_even();
        let aligned = |b: &SceneBody| b.middle == 0.0 && b.profile.as_ref().is_none_or(even);
        self.bodies.iter().all(aligned)
    }

    /// Whether the contact is symmetric about y = 0, but for heights on top of it.
    pub fn is_symmetric(&self) -> bool {
        self.is_aligned() && self.tilt == Tilt::Held(0.0)
    }

    /// Whether the contact may end before the bodies do; between straight and parallel ones it does
    /// not.
    pub fn may_end(&self) -> bool {
        self.steepness != 0.0 || !self.is_symmetric()
    }

    /// The overlap of the bodies, from end to end (C).
    pub fn overlap(&self) -> [f64; 2] {
        [self.middle - self.half_length, self.middle + self.half_length]
    }

    /// The contact line, for the standard curves.
    pub fn span(&self) -> Span {
        let symmetric = self.is_symmetric() && !self.rough;
        Span { ends: self.overlap(), symmetric, slides: self.slides || self.rough }
    }

    /// The gap between the bodies, parallel and without load.
    pub fn gap(&self) -> Shaped {
        let profiles = self.bodies.iter().filter_map(|body| {
            let profile = body.profile.clone()?;
            Some((body.middle, profile))
        });
        Shaped { profiles: profiles.collect(), steepness: self.steepness }
    }

    /// The key of the solution: scenes with equal keys share one. It contains all of the scene,
    /// with numbers rounded to twelve digits. Numbers that differ by less may still round to
    /// different keys, which costs a solve but is no error.
    pub fn key(&self) -> SceneKey {
        let Self {
            half_length,
            middle,
            bodies,
            load,
            tilt,
            slides,
            rough: _,
            steepness,
            depth,
            curvatures,
            felt,
            model,
            psi,
            tolerance,
        } = self;
        let (is_free, tilt) = match tilt {
            Tilt::Held(tilt) => (false, tilt),
            Tilt::Free(arm) => (true, arm),
        };
        let mut numbers = vec![*half_length, *middle, *load, *tilt, *steepness, *depth, *tolerance];
        numbers.extend(curvatures.iter().chain(felt.iter()));
        for SceneBody { half, middle, nu, share, profile } in bodies.iter() {
            numbers.extend([*half, *middle, *nu, *share]);
            let own = profile.as_ref().map(Profile::numbers).unwrap_or_default();
            numbers.push(own.len() as f64);
            numbers.extend(own);
        }
        // 0.0 and -0.0 are equal.
        let bits = |v: &f64| (rounded(*v) + 0.0).to_bits();
        SceneKey {
            numbers: numbers.iter().map(bits).collect(),
            is_free,
            slides: *slides,
            model: *model,
            psi: psi.as_ref().map(bits),
        }
    }

    /// The treatment of the end faces of a body.
    pub fn end(&self, kind: BodyKind) -> End {
        self.model.end(self.bodies[kind].nu, self.psi)
    }

    /// The exponents m > 0 of the pressure s^-m at the overlap's ends; none where it is not
    /// singular.
    pub fn corner_exponents(&self) -> [Option<f64>; 2] {
        let overlap = self.overlap();
        [0, 1].map(|side| {
            let bodies = BodyKind::ALL.map(|kind| {
                let body = &self.bodies[kind];
                let beyond = (body.ends()[side] - overlap[side]).abs();
                let is_flush = ledge(beyond, self.half_length) == 0.0;
                (body.share, if is_flush { self.end(kind) } else { End::ENDLESS })
            });
            corner_exponent(&bodies)
        })
    }
}

/// The key that scenes of one solution share, see [`Scene::key`].
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct SceneKey {
    numbers: Vec<u64>,
    is_free: bool,
    slides: bool,
    model: EdgeModel,
    psi: Option<u64>,
}

/// A number beside some `size`: what is nothing but for rounding is nothing, so that symmetric
/// scenes are symmetric.
fn unless_nothing(v: f64, size: f64) -> f64 {
    if v.abs() < NOTHING * size { 0.0 } else { rounded(v) }
}

/// The `own` ends of a body, at those of the other one where they are flush with them but for
/// rounding, which must not leave a ledge.
fn flush(own: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    let shorter = 0.5 * (own[1] - own[0]).min(other[1] - other[0]);
    [0, 1].map(|side| match ledge((own[side] - other[side]).abs(), shorter) {
        0.0 => other[side],
        _ => own[side],
    })
}

/// The number rounded to twelve digits, to remove differences by rounding.
fn rounded(v: f64) -> f64 {
    format!("{v:.12e}").parse().expect("a formatted number")
}
