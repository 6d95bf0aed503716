//! A contact in units of C and p0: a case without its scales.

use super::lines;
use crate::base::{Error, Material, Panels, Parity, PerBody, Result, Wavenumbers};
use crate::body::{Body, EdgeModel, End, Layer, Resolution, Shape, corner_exponent};
use crate::case::{Accuracy, Block, Case, Load, Roller};
use crate::contact::{self, Compliance, ContactSettings, ContactSolution, Problem, Straight};
use crate::stress::{BodyKind, CurveSpec, Field, Load as _, Pressure};
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::time::Instant;

/// Largest violation of the laws of contact, in tolerances. Solutions over the whole range of
/// scenes stay within 2 (docs/robustness.md); errors of the solver exceed it by far.
const SOUNDNESS: f64 = 5.0;

/// Largest condition number of a body's equations for which rounding is negligible: it costs this
/// many units of 1e-16. Scenes over the whole legal range stay below a thousandth of it
/// (docs/robustness.md).
const WORST_CONDITION: f64 = 1e7;

/// Tolerance of the contact's iteration, in tolerances of the scene.
const CONTACT_TOLERANCE: f64 = 1e-2;

/// One of the two bodies of a [`Scene`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneBody {
    /// Half-length (C).
    pub half: f64,
    /// Poisson's ratio.
    pub nu: f64,
    /// Share of the contact compliance, E* (1 - nu^2) / E.
    pub share: f64,
}

/// A dimensionless contact. The load factor W is not in it: only the approach's reference depth
/// and the roller's diametral tension know the radius.
#[derive(Debug, Clone)]
pub struct Scene {
    /// S_l, the contact's half-length (C).
    pub half_length: f64,
    /// The two bodies.
    pub bodies: PerBody<SceneBody>,
    /// The edge model.
    pub model: EdgeModel,
    /// Weight of the images of `guilbault`; by default [`crate::body::guilbault_psi`] of each body.
    pub psi: Option<f64>,
    /// Requested accuracy (p0).
    pub tolerance: f64,
}

impl Scene {
    /// The scene of a case.
    pub fn new(case: &Case, model: EdgeModel, psi: Option<f64>) -> Self {
        // Each field of a case is in the scene, in the scales or in neither.
        let Case { name: _, roller, block, load, accuracy: Accuracy { tolerance }, cells: _ } =
            case;
        let Roller { radius_m: _, length_m: roller_length_m, material: roller_material } = *roller;
        let Block { length_m: block_length_m, material: block_material } = *block;
        let Load { force_n: _ } = load;
        let hertz = case.hertz();
        let half = |length_m: f64| rounded(0.5 * length_m / hertz.c_m);
        let body = |half: f64, material: Material| SceneBody {
            half,
            nu: material.poisson,
            share: rounded(hertz.e_star_pa * material.plane_strain_compliance()),
        };
        let half_length = half(roller_length_m);
        let block = half(block_length_m);
        // Rounding must not leave a ledge at flush ends.
        let block = if block < half_length * (1.0 + 1e-9) { half_length } else { block };
        Self {
            half_length,
            bodies: PerBody {
                block: body(block, block_material),
                roller: body(half_length, roller_material),
            },
            model,
            psi,
            tolerance: *tolerance,
        }
    }

    /// The key of the solution: scenes with equal keys share one. It contains all of the scene,
    /// with numbers rounded to twelve digits. Numbers that differ by less may still round to
    /// different keys, which costs a solve but is no error.
    pub fn key(&self) -> SceneKey {
        let Self { half_length, bodies, model, psi, tolerance } = self;
        // 0.0 and -0.0 are equal.
        let bits = |v: f64| (rounded(v) + 0.0).to_bits();
        let body = |SceneBody { half, nu, share }: &SceneBody| [half, nu, share].map(|v| bits(*v));
        SceneKey {
            half_length: bits(*half_length),
            bodies: PerBody { block: body(&bodies.block), roller: body(&bodies.roller) },
            model: *model,
            psi: psi.map(bits),
            tolerance: bits(*tolerance),
        }
    }

    /// The treatment of the end faces of a body.
    pub fn end(&self, kind: BodyKind) -> End {
        self.model.end(self.bodies[kind].nu, self.psi)
    }

    /// The exponent m > 0 of the pressure s^-m at the contact's end; none if it is not singular.
    pub fn corner_exponent(&self) -> Option<f64> {
        let bodies = BodyKind::ALL.map(|kind| {
            let SceneBody { half, share, .. } = self.bodies[kind];
            let flush = half <= self.half_length * (1.0 + 1e-9);
            (share, if flush { self.end(kind) } else { End::ENDLESS })
        });
        corner_exponent(&bodies)
    }
}

/// The key that scenes of one solution share, see [`Scene::key`].
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct SceneKey {
    half_length: u64,
    bodies: PerBody<[u64; 3]>,
    model: EdgeModel,
    psi: Option<u64>,
    tolerance: u64,
}

/// The number rounded to twelve digits, to remove differences by rounding.
fn rounded(v: f64) -> f64 {
    format!("{v:.12e}").parse().expect("a formatted number")
}

/// Run time of each stage (s).
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct Seconds {
    /// Axes and compliance.
    pub setup: f64,
    /// Contact.
    pub contact: f64,
    /// Stresses.
    pub stress: f64,
    /// Total.
    pub total: f64,
}

/// A solved scene, which gives pressures and stresses anywhere.
#[derive(Debug)]
pub struct SolvedScene {
    /// The scene.
    pub scene: Scene,
    /// Its resolution.
    pub resolution: Resolution,
    /// Wavenumbers across the contact.
    pub wavenumbers: Wavenumbers,
    /// The contact pressure.
    pub pressure: Pressure,
    /// The solution of the contact; its approach lacks the reference (see
    /// [`SolvedScene::approach`]).
    pub contact: ContactSolution,
    /// Run times of set-up and contact.
    pub seconds: Seconds,
    /// The largest condition number of the bodies' equations, see [`Layer::condition`].
    pub condition: f64,
    /// [`Pressure::moments`].
    moments: DMatrix<f64>,
    bodies: Vec<(Body, Vec<Layer>)>,
    compliances: Vec<DMatrix<f64>>,
}

impl SolvedScene {
    /// Solves a scene at the resolution for its tolerance.
    ///
    /// # Errors
    /// [`Error::NotConverged`] if the contact does not converge, [`Error::Unsound`] if the solution
    /// violates a law of contact or the equations are ill-conditioned.
    pub fn new(scene: &Scene) -> Result<Self> {
        let end = scene.end(BodyKind::Block);
        let resolution = Resolution::of(scene.tolerance, &end, scene.corner_exponent());
        Self::with_resolution(scene, &resolution)
    }

    /// Solves a scene at a given resolution.
    ///
    /// # Errors
    /// [`Error::NotConverged`] if the contact does not converge, [`Error::Unsound`] if the solution
    /// violates a law of contact or the equations are ill-conditioned.
    pub fn with_resolution(scene: &Scene, resolution: &Resolution) -> Result<Self> {
        let start = Instant::now();
        let longest = scene.bodies.iter().fold(0.0, |m: f64, b| m.max(b.half));
        let wavenumbers = resolution.wavenumbers(longest);
        let coarse = wavenumbers.coarse();
        let axis = resolution.contact_axis(scene.half_length);
        let PerBody { block, roller } = scene.bodies;
        // Bodies with the same ends and Poisson's ratio share one computation.
        let alike = block.half == roller.half && block.nu == roller.nu;
        let distinct = if alike { &BodyKind::ALL[..1] } else { &BodyKind::ALL[..] };
        let bodies: Vec<(Body, Vec<Layer>)> = distinct
            .iter()
            .map(|&kind| {
                let SceneBody { half, nu, .. } = scene.bodies[kind];
                let shape = Shape { contact: scene.half_length, half, nu };
                let body = Body::new(shape, scene.end(kind), Parity::Even, resolution);
                let layers = coarse.nodes().par_iter().map(|&k| body.layer(k)).collect();
                (body, layers)
            })
            .collect();
        let condition = checked_condition(&bodies)?;
        let compliances: Vec<_> = (0..coarse.len())
            .map(|i| {
                let of = |body: usize| &bodies[body.min(bodies.len() - 1)].1[i].compliance;
                of(0) * block.share + of(1) * roller.share
            })
            .collect();
        let setup = start.elapsed().as_secs_f64();
        let settings = ContactSettings {
            modes: resolution.modes,
            spacing: resolution.spacing,
            tolerance: CONTACT_TOLERANCE * scene.tolerance,
            max_iterations: 40,
            soundness: SOUNDNESS * scene.tolerance.max(Resolution::FINEST),
        };
        let compliance = Compliance { wavenumbers: &wavenumbers, matrices: &compliances };
        let contact = contact::solve(&straight(&compliance, &axis), &settings)?;
        let pressure =
            Pressure::new(axis, contact.half_widths.clone(), contact.coefficients.clone());
        let moments = pressure.moments(&wavenumbers);
        let total = start.elapsed().as_secs_f64();
        Ok(Self {
            scene: scene.clone(),
            resolution: *resolution,
            wavenumbers,
            pressure,
            contact,
            seconds: Seconds { setup, contact: total - setup, stress: 0.0, total },
            condition,
            moments,
            bodies,
            compliances,
        })
    }

    /// The body and its layers, shared by identical bodies.
    fn body(&self, kind: BodyKind) -> &(Body, Vec<Layer>) {
        let index = match kind {
            BodyKind::Block => 0,
            BodyKind::Roller => self.bodies.len() - 1,
        };
        &self.bodies[index]
    }

    /// Whether the contact iteration reached its tolerance.
    pub fn converged(&self) -> bool {
        self.contact.residual <= CONTACT_TOLERANCE * self.scene.tolerance
    }

    /// Whether both bodies share one computation.
    pub fn bodies_shared(&self) -> bool {
        self.bodies.len() == 1
    }

    /// The stress field of a body, without the contribution of the roller's round shape.
    pub fn field(&self, kind: BodyKind) -> Field<'_> {
        self.field_with(kind, self.body(kind).0.end.gamma, self.scene.tolerance)
    }

    /// Stresses on `curves` and at single `points` (C).
    pub(super) fn stresses(
        &self,
        curves: &[CurveSpec],
        points: &[(BodyKind, [f64; 3])],
    ) -> lines::Stresses {
        lines::stresses(self.bodies_shared(), |kind| self.field(kind), curves, points)
    }

    /// [`SolvedScene::field`] with a transition factor other than the edge model's, and with
    /// contributions below `tolerance` (p0) neglected.
    pub fn field_with(&self, kind: BodyKind, gamma: Option<f64>, tolerance: f64) -> Field<'_> {
        let (body, layers) = self.body(kind);
        let (numbers, moments) = (&self.wavenumbers, &self.moments);
        Field::new(body, numbers, layers, &self.pressure, moments, gamma, tolerance)
    }

    /// The compliance of both bodies together.
    fn compliance(&self) -> Compliance<'_> {
        Compliance { wavenumbers: &self.wavenumbers, matrices: &self.compliances }
    }

    /// Gaps between the bodies (C^2 / (2 R)) at the nodes along the line: a row for each of
    /// `places`, which are distances from x = 0 in half-widths of each node.
    pub fn gaps(&self, places: &[f64]) -> Vec<Vec<f64>> {
        let compliance = self.compliance();
        let problem = straight(&compliance, self.pressure.axis());
        contact::gaps(&problem, &self.contact, places)
    }

    /// Approach in units of C^2 / (2 R) of points `depth` (C) below the surface.
    pub fn approach(&self, depth: f64) -> f64 {
        self.contact.approach
            - contact::reference(&self.compliance(), |k| self.contact.transform(k), depth)
    }
}

/// The largest condition number of the bodies' equations, refused if rounding would not be
/// negligible.
fn checked_condition(bodies: &[(Body, Vec<Layer>)]) -> Result<f64> {
    let condition = bodies
        .iter()
        .flat_map(|(_, layers)| layers)
        .map(|l| l.condition)
        .fold(1.0, |a: f64, b| if b.is_nan() { f64::INFINITY } else { a.max(b) });
    if condition <= WORST_CONDITION {
        return Ok(condition);
    }
    Err(Error::Unsound {
        law: "the condition number of the end faces' equations",
        value: condition,
        limit: WORST_CONDITION,
        remedy: "take a coarser [accuracy] tolerance or less extreme lengths".into(),
    })
}

/// The contact of a straight roller that is pressed on the block in its middle: one half of it.
fn straight<'a>(compliance: &'a Compliance<'a>, axis: &'a Panels) -> Problem<'a> {
    Problem {
        compliance,
        axis,
        both_ends: false,
        gap: &Straight,
        load: 0.5 * PI * axis.end(),
        moment: None,
    }
}
