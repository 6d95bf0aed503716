//! A scene whose contact is solved.

use super::deep;
use super::lines::{self, Stresses};
use super::scene::Scene;
use super::trial::{
    Accuracy, CONTACT_TOLERANCE, Known, Line, Parts, Settled, Trial, part_of, problem, touch,
};
use crate::base::{Error, Result, Wavenumbers};
use crate::body::{Resolution, Skins, Stack};
use crate::contact::{self, Compliance, ContactSolution};
use crate::stress::round::ContactEnds;
use crate::stress::{BodyField, BodyKind, CurveSpec, Field, Load, Pressure};
use nalgebra::DMatrix;
use std::time::Instant;

/// Largest violation of the laws of contact, in tolerances. Solutions over the whole range of
/// scenes stay within 2 (docs/robustness.md); errors of the solver exceed it by far.
const SOUNDNESS: f64 = 5.0;

/// Tolerance (p0) at which the ends of a contact are sought that may end before its bodies do.
const SEARCH: f64 = 3e-2;

/// Largest width, in its lengths, of a contact that ends before its bodies do: a wider one asks for
/// nodes across, not along. The same in a first guess, where no solution is found.
const WIDEST: f64 = 3.0;
const WIDEST_GUESS: f64 = 2.0;

/// How much farther along y (C) than its line a contact may go whose ends did not settle: with more
/// the rest of its load is pressed into what is left.
const FARTHER: f64 = 0.05;

/// Tolerance of a second attempt, in that of the first.
const FINER: f64 = 0.1;

/// Half-length of a body (own units) up to which its stresses are integrated over depths with the
/// scene's tolerance.
const SHORT: f64 = 10.0;

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
    /// The unit of length, in C, that it is solved in: resolution and wavenumbers are in this unit.
    pub unit: f64,
    /// Its resolution.
    pub resolution: Resolution,
    /// Wavenumbers across the contact.
    pub wavenumbers: Wavenumbers,
    /// The contact pressure.
    pub pressure: Pressure,
    /// The solution of the contact; its approach and its tilt lack the reference (see
    /// [`SolvedScene::approach`] and [`SolvedScene::tilt`]).
    pub contact: ContactSolution,
    /// Whether the contact ends before its bodies do, at either end.
    pub open: [bool; 2],
    /// Whether the search for the contact's ends came to an end.
    is_settled: bool,
    /// Run times of set-up and contact.
    pub seconds: Seconds,
    /// The largest condition number of the bodies' equations, see
    /// [`crate::body::Layer::condition`].
    pub condition: f64,
    /// The scene, the contact and its pressure in the solution's own unit.
    own: Own,
    /// [`Pressure::moments`] of the own pressure.
    moments: DMatrix<f64>,
    bodies: Vec<Stack>,
    /// Their skins, where they are round.
    skins: Vec<Option<Skins>>,
    compliances: Vec<DMatrix<f64>>,
}

/// What is solved, in its own unit of length.
#[derive(Debug)]
struct Own {
    scene: Scene,
    contact: ContactSolution,
    pressure: Pressure,
}

impl SolvedScene {
    /// Solves a scene at the resolution for its tolerance.
    ///
    /// # Errors
    /// [`Error::NotConverged`] if the contact does not converge, [`Error::Unsound`] if the solution
    /// violates a law of contact or the equations are ill-conditioned.
    pub fn new(scene: &Scene) -> Result<Self> {
        let soundness = soundness(scene);
        let first = Self::within(scene, None, soundness);
        let failed = match &first {
            Err(Error::Unsound { law, .. }) => *law != WIDTH,
            Err(Error::NotConverged { .. }) => true,
            _ => false,
        };
        if !failed || !scene.may_end() {
            return first;
        }
        // A contact that is hardly longer than wide may ask for closer nodes.
        let finer = Scene { tolerance: FINER * scene.tolerance, ..scene.clone() };
        if finer.tolerance >= Resolution::FINEST
            && let Ok(found) = Self::within(&finer, None, soundness)
        {
            return Ok(Self { scene: scene.clone(), ..found });
        }
        let slices = scene.slices(&scene.gap());
        if slices.ends != scene.overlap() {
            check_width(slices.width_over_length(), WIDEST_GUESS)?;
        }
        first
    }

    /// What the nodes along the line leave out of the pressure, about (p0), where measured profiles
    /// do more between them than they can follow, and that is more than the tolerance.
    pub fn profile_residual(&self) -> Option<f64> {
        let (gap, line) = (self.scene.gap(), self.pressure.axis());
        let gap = gap.generatrix();
        if gap.points.is_empty() {
            return None;
        }
        let left_out = (0..line.panel_count()).map(|i| gap.missed(line, i)).fold(0.0, f64::max);
        (left_out > self.scene.tolerance).then_some(left_out)
    }

    /// What to beware of, in words: `not-converged`, `coarser` and `profile-residual`, by what the
    /// summary of a case says of it.
    pub fn warnings(&self) -> Vec<&'static str> {
        let all = [
            ("not-converged", !self.converged()),
            ("coarser", self.contact.coarser.is_some()),
            ("profile-residual", self.profile_residual().is_some()),
        ];
        all.into_iter().filter(|(_, holds)| *holds).map(|(word, _)| word).collect()
    }

    /// Solves a scene at a given resolution.
    ///
    /// # Errors
    /// [`Error::NotConverged`] if the contact does not converge, [`Error::Unsound`] if the solution
    /// violates a law of contact or the equations are ill-conditioned.
    pub fn with_resolution(scene: &Scene, resolution: &Resolution) -> Result<Self> {
        Self::within(scene, Some(resolution), soundness(scene))
    }

    /// Solves a scene on the way to another one: it need not be sound.
    ///
    /// # Errors
    /// [`Error::NotConverged`] and [`Error::Unsound`] as [`SolvedScene::new`], but for the laws of
    /// contact.
    pub(super) fn roughly(scene: &Scene) -> Result<Self> {
        Self::within(scene, None, f64::INFINITY)
    }

    /// Solves a scene that may violate the laws of contact by `soundness`, at the resolution for
    /// its tolerance unless one is given.
    fn within(scene: &Scene, given: Option<&Resolution>, soundness: f64) -> Result<Self> {
        let start = Instant::now();
        let unit = scene.own_unit();
        let (asked, scene) = (scene, &scene.scaled(1.0 / unit));
        let gap = scene.gap();
        // A contact that cannot end before its bodies do needs no guess.
        let slices = scene.may_end().then(|| scene.slices(&gap));
        let mut line = Line::first(scene, slices.as_ref());
        let mut known = Known { slices, spring: None };
        if known.slices.as_ref().is_some_and(|slices| scene.needs_search(slices)) {
            // The ends are found at low cost; on the way there no solution has to be sound.
            let coarse = scene.resolution(SEARCH, known.slices.as_ref());
            let accuracy = Accuracy { tolerance: SEARCH, soundness: f64::INFINITY };
            let search = Trial { scene, resolution: &coarse, powers: false, accuracy, gap: &gap };
            let found = search.settled(line, known)?;
            (line, known) = (found.next.longer(scene), found.known);
        }
        let of_tolerance = || scene.resolution(scene.tolerance, known.slices.as_ref());
        let resolution = given.copied().unwrap_or_else(of_tolerance);
        let accuracy = Accuracy { tolerance: scene.tolerance, soundness };
        let trial = Trial { scene, resolution: &resolution, powers: true, accuracy, gap: &gap };
        let settled = trial.settled(line, known)?;
        if soundness.is_finite() {
            check_ends(&settled)?;
        }
        let Settled { line, parts, contact, is_settled, setup, .. } = settled;
        let Parts { axis, wavenumbers, bodies, skins, compliances, condition } = parts;
        // Before its bodies do it ends also where the last nodes of a line up to their end carry
        // nothing.
        let open = [0, 1].map(|side| line.open[side] || contact.ends[side].at != line.ends[side]);
        if soundness.is_finite() && open.contains(&true) {
            let widest = contact.half_widths.iter().copied().fold(0.0, f64::max);
            let [from, to] = contact.ends.map(|end| end.at);
            check_width(2.0 * widest / (to - from), WIDEST)?;
        }
        let pressure = Pressure::new(
            axis,
            scene.is_symmetric(),
            contact.half_widths.clone(),
            contact.coefficients.clone(),
        );
        let moments = pressure.moments(&wavenumbers);
        let total = start.elapsed().as_secs_f64();
        Ok(Self {
            scene: asked.clone(),
            unit,
            resolution,
            is_settled,
            wavenumbers,
            pressure: pressure.scaled(unit),
            contact: contact.scaled(unit),
            own: Own { scene: scene.clone(), contact, pressure },
            open,
            seconds: Seconds { setup, contact: total - setup, stress: 0.0, total },
            condition,
            moments,
            bodies,
            skins,
            compliances,
        })
    }

    /// The body, shared by identical bodies.
    fn body(&self, kind: BodyKind) -> &Stack {
        part_of(&self.bodies, kind)
    }

    /// Whether the contact iteration reached its tolerance, and the search for the contact's ends
    /// its own.
    pub fn converged(&self) -> bool {
        let own = &self.own;
        self.is_settled && own.contact.residual <= CONTACT_TOLERANCE * own.scene.tolerance
    }

    /// Whether both bodies share one computation and its stresses.
    pub fn bodies_shared(&self) -> bool {
        self.bodies.len() == 1 && self.scene.feels_alike()
    }

    /// The stress field of a body, without the contribution of the roller's round shape.
    pub fn field(&self, kind: BodyKind) -> BodyField<'_> {
        self.field_with(kind, self.body(kind).body().end.gamma, self.scene.tolerance)
    }

    /// Stresses on `curves` and at single `points` (C).
    pub fn stresses(&self, curves: &[CurveSpec], points: &[(BodyKind, [f64; 3])]) -> Stresses {
        lines::stresses(self.bodies_shared(), |kind| self.field(kind), curves, points)
    }

    /// [`SolvedScene::field`] with a transition factor other than the edge model's, and with
    /// contributions below `tolerance` (p0) neglected.
    pub fn field_with(&self, kind: BodyKind, gamma: Option<f64>, tolerance: f64) -> BodyField<'_> {
        let field = self.own_field(kind, gamma, tolerance);
        let [left, right] = self.open;
        let open = [if self.scene.is_symmetric() { right } else { left }, right];
        let contact = ContactEnds { at: self.own.pressure.ends(), open };
        let contact = self.scene.may_end().then_some(contact);
        let skins = part_of(&self.skins, kind).as_ref();
        let field = field.with_skins(skins, self.scene.felt[kind]);
        BodyField::new(field.following_contact(contact), self.unit)
    }

    /// The field of a body in the solution's own unit.
    fn own_field(&self, kind: BodyKind, gamma: Option<f64>, tolerance: f64) -> Field<'_> {
        let (numbers, pressure) = (&self.wavenumbers, &self.own.pressure);
        let field = Field::new(self.body(kind), numbers, pressure, &self.moments, gamma, tolerance);
        if self.scene.slides { field.with_traction(pressure) } else { field }
    }

    /// The contact's ends along y (C).
    pub fn ends(&self) -> [f64; 2] {
        self.contact.ends.map(|end| end.at)
    }

    /// The compliance of both bodies together.
    fn compliance(&self) -> Compliance<'_> {
        Compliance { wavenumbers: &self.wavenumbers, matrices: &self.compliances }
    }

    /// Gaps between the bodies (C^2 / (2 R)) at the nodes along the line: a row for each of
    /// `places`, which are distances from x = 0 in half-widths of each node.
    pub fn gaps(&self, places: &[f64]) -> Vec<Vec<f64>> {
        let (compliance, gap) = (self.compliance(), self.own.scene.gap());
        let axis = self.own.pressure.axis();
        let problem = problem(&self.own.scene, &compliance, axis, &gap, self.open);
        let mut gaps = contact::gaps(&problem, &self.own.contact, places);
        gaps.iter_mut().flatten().for_each(|gap| *gap *= self.unit * self.unit);
        gaps
    }

    /// Approach in units of C^2 / (2 R) of points `depth` (C) below the surfaces at y = 0.
    pub fn approach(&self, depth: f64) -> f64 {
        self.approaches().at(depth)
    }

    /// The approach of points at any depth.
    pub(super) fn approaches(&self) -> Approaches {
        let own = &self.own;
        let approach = |fields: [&Field; 2]| {
            deep::Approaches::new(&own.scene, fields, &touch(&own.pressure, &own.contact))
        };
        Approaches { own: self.with_fields(approach), unit: self.unit }
    }

    /// Tilt in units of C / (2 R) of lines `depth` (C) below the surface.
    pub fn tilt(&self, depth: f64) -> f64 {
        if self.scene.is_symmetric() {
            return 0.0;
        }
        let own = &self.own;
        let tilt = |fields: [&Field; 2]| {
            deep::tilt(&own.scene, fields, &touch(&own.pressure, &own.contact), depth / self.unit)
        };
        self.with_fields(tilt) * self.unit
    }

    /// What `of` makes of the fields of the block and of the roller, without a stress correction.
    /// What their stresses neglect adds up over the depths of long bodies.
    fn with_fields<T>(&self, of: impl Fn([&Field; 2]) -> T) -> T {
        let fields = BodyKind::ALL.map(|kind| {
            let short = (SHORT / self.own.scene.bodies[kind].half).min(1.0);
            self.own_field(kind, None, self.scene.tolerance * short)
        });
        let [block, roller] = &fields;
        of([block, roller])
    }
}

/// The approach of the bodies at any depth, without the rest of a [`SolvedScene`].
#[derive(Debug)]
pub(super) struct Approaches {
    own: deep::Approaches,
    /// The unit of length, in C, of it.
    unit: f64,
}

impl Approaches {
    /// Approach in units of C^2 / (2 R) of points `depth` (C) below the surfaces at y = 0.
    pub fn at(&self, depth: f64) -> f64 {
        self.own.at(depth / self.unit) * self.unit * self.unit
    }

    /// Memory that it takes (bytes).
    pub fn bytes(&self) -> usize {
        self.own.bytes()
    }
}

/// How far a scene's solution may violate the laws of contact (p0).
fn soundness(scene: &Scene) -> f64 {
    SOUNDNESS * scene.tolerance.max(Resolution::FINEST)
}

/// Refuses a contact whose pressure goes on beyond the line on which it was found by more than
/// [`FARTHER`].
fn check_ends(settled: &Settled) -> Result<()> {
    let [first, last] = settled.contact.ends;
    let beyond = last.beyond.max(-first.beyond);
    if settled.is_settled || beyond <= FARTHER {
        return Ok(());
    }
    Err(Error::Unsound {
        law: "how far a contact goes on beyond the end that was found for it (C)",
        value: beyond,
        limit: FARTHER,
        remedy: "take another [accuracy] tolerance, or --engine cells".into(),
    })
}

/// The law that a contact wider than long does not hold.
const WIDTH: &str = "the contact's width over its length along y";

/// Refuses a contact whose largest width, in its lengths, is a `value` above the `limit`.
fn check_width(value: f64, limit: f64) -> Result<()> {
    if value <= limit {
        return Ok(());
    }
    Err(Error::Unsound {
        law: WIDTH,
        value,
        limit,
        remedy:
            "take the longer direction as y (exchange the radii of roller and profile), bring a \
                 load that is near to an end to the middle, or take --engine cells"
                .into(),
    })
}
