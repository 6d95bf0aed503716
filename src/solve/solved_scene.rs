//! A scene whose contact is solved.

use super::deep::{self, Touch};
use super::lines::{self, Stresses};
use super::scene::{Scene, SceneBody, Tilt};
use crate::base::stop::go_on;
use crate::base::{Error, Panels, Result, Wavenumbers};
use crate::body::{Resolution, Shape, Stack};
use crate::contact::{
    self, Compliance, ContactSettings, ContactSolution, Problem, Rotation, Shaped, Slices,
};
use crate::stress::{BodyField, BodyKind, CurveSpec, Field, Load, Pressure};
use nalgebra::DMatrix;
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

/// Tolerance (p0) at which the ends of a contact are sought that may end before its bodies do.
const SEARCH: f64 = 3e-2;

/// Most contacts that are solved until the ends are found, or the tilt that is held.
const MOST_TRIALS: usize = 10;

/// How closely an end is found (half-lengths of the contact) at [`Resolution::COARSE`] and coarser
/// tolerances. Below, it falls with the tolerance, as the pressure is steep beside an end, to the
/// part `CLOSEST` of this.
const END_ERROR: f64 = 2e-3;
const CLOSEST: f64 = 0.1;

/// How far beyond a first guess the axis reaches, in half-lengths of the contact.
const MARGIN: f64 = 0.15;

/// Largest width, in its lengths, of a contact that ends before its bodies do: a wider one asks for
/// nodes across, not along. The same in a first guess, where no solution is found.
const WIDEST: f64 = 3.0;
const WIDEST_GUESS: f64 = 2.0;

/// Tolerance of a second attempt, in that of the first.
const FINER: f64 = 0.1;

/// A half-width (C) from which a contact has a unit of its own.
const WIDER: f64 = 1.4;

/// Tolerance of a contact whose tilt is sought, in those of others.
const FOLLOWS: f64 = 0.1;

/// Most tilts between the surfaces that are tried for one that is held at a depth, and those after
/// which the contact's own error is allowed: two solutions, as far apart as that, may follow each
/// other from the same tilt.
const MOST_TILTS: usize = 20;
const PATIENCE: usize = 10;

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
        if scene.ends_inside(&slices) {
            check_length(slices.widest(), slices.ends[1] - slices.ends[0], WIDEST_GUESS)?;
        }
        first
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
        if scene.may_end() {
            // The ends are found at low cost; on the way there no solution has to be sound.
            let coarse = scene.resolution(SEARCH, known.slices.as_ref());
            let accuracy = Accuracy { tolerance: SEARCH, soundness: f64::INFINITY };
            let search = Trial { scene, resolution: &coarse, powers: false, accuracy, gap: &gap };
            Settled { line, known, .. } = search.settled(line, known)?;
        }
        let of_tolerance = || scene.resolution(scene.tolerance, known.slices.as_ref());
        let resolution = given.copied().unwrap_or_else(of_tolerance);
        let accuracy = Accuracy { tolerance: scene.tolerance, soundness };
        let trial = Trial { scene, resolution: &resolution, powers: true, accuracy, gap: &gap };
        let Settled { line, parts, contact, is_settled, setup, .. } = trial.settled(line, known)?;
        let Parts { axis, wavenumbers, bodies, compliances, condition } = parts;
        let open = left_open(scene, &line, &contact);
        if soundness.is_finite() && open.contains(&true) {
            let widest = contact.half_widths.iter().copied().fold(0.0, f64::max);
            let [from, to] = contact.ends;
            check_length(widest, to - if scene.is_symmetric() { -to } else { from }, WIDEST)?;
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
            compliances,
        })
    }

    /// The body, shared by identical bodies.
    fn body(&self, kind: BodyKind) -> &Stack {
        match kind {
            BodyKind::Block => &self.bodies[0],
            BodyKind::Roller => &self.bodies[self.bodies.len() - 1],
        }
    }

    /// Whether the contact iteration reached its tolerance, and the search for the contact's ends
    /// its own.
    pub fn converged(&self) -> bool {
        self.is_settled && self.contact.residual <= CONTACT_TOLERANCE * self.scene.tolerance
    }

    /// Whether both bodies share one computation.
    pub fn bodies_shared(&self) -> bool {
        self.bodies.len() == 1
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
        BodyField::new(field.following_contact(self.scene.may_end(), open), self.unit)
    }

    /// The field of a body in the solution's own unit.
    fn own_field(&self, kind: BodyKind, gamma: Option<f64>, tolerance: f64) -> Field<'_> {
        let (numbers, pressure) = (&self.wavenumbers, &self.own.pressure);
        let field = Field::new(self.body(kind), numbers, pressure, &self.moments, gamma, tolerance);
        if self.scene.slides { field.with_traction(pressure) } else { field }
    }

    /// The contact's ends along y (C).
    pub fn ends(&self) -> [f64; 2] {
        let [from, to] = self.contact.ends;
        let ends = if self.scene.is_symmetric() { [-to, to] } else { [from, to] };
        // Where a contact all but reaches the bodies' end, its own end may be found beyond.
        let [first, last] = self.scene.overlap();
        ends.map(|y| y.clamp(first, last))
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

impl Scene {
    /// The resolution for a tolerance (p0), where `slices` are what is known of a contact that may
    /// end before its bodies do.
    pub(super) fn resolution(&self, tolerance: f64, slices: Option<&Slices>) -> Resolution {
        let overlap = self.overlap();
        if slices.is_some_and(|slices| self.ends_inside(slices)) {
            return Resolution::for_tips(tolerance);
        }
        let (end, corner) = (self.end(BodyKind::Block), self.corner_exponent());
        let level = Resolution::of(tolerance, &end, corner);
        let Some(slices) = slices else { return level };
        let gap = self.gap();
        let turns = [0, 1].map(|side| {
            let outward = 2.0 * side as f64 - 1.0;
            let end = slices.ends[side].clamp(overlap[0], overlap[1]);
            gap.turns_within(end, -outward)
        });
        level.following(turns[0].min(turns[1]))
    }

    /// Whether a contact of these `slices` ends well before its bodies do.
    fn ends_inside(&self, slices: &Slices) -> bool {
        let (overlap, least) = (self.overlap(), MARGIN * self.half_length);
        slices.ends[0] - overlap[0] > least && overlap[1] - slices.ends[1] > least
    }

    /// The unit of length, in C, in which the contact has a half-width of about 1, or a half-length
    /// where that is shorter. That of Hertz's line contact is left as it is where the contact is
    /// not much wider.
    fn own_unit(&self) -> f64 {
        if !self.may_end() {
            return 1.0;
        }
        let slices = self.slices(&self.gap());
        let (widest, half) = (slices.widest(), 0.5 * (slices.ends[1] - slices.ends[0]));
        if half < widest && self.ends_inside(&slices) {
            return half;
        }
        if widest > WIDER { widest } else { 1.0 }
    }

    /// The load's moment if the tilt is free, and the tilt that is held otherwise.
    fn moment_and_tilt(&self) -> (Option<f64>, f64) {
        match self.tilt {
            Tilt::Held(tilt) => (None, tilt),
            Tilt::Free(arm) => (Some(self.load * arm), 0.0),
        }
    }

    /// A first guess of the contact.
    fn slices(&self, gap: &Shaped) -> Slices {
        let (moment, tilt) = self.moment_and_tilt();
        Slices::new(gap, self.overlap(), self.load, moment, tilt)
    }
}

/// Whether the contact ends before its bodies do, at either end: its axis does, or the last nodes
/// carry no load.
fn left_open(scene: &Scene, line: &Line, contact: &ContactSolution) -> [bool; 2] {
    let last = contact.coefficients.len() - 1;
    let outermost = [if scene.is_symmetric() { last } else { 0 }, last];
    [0, 1].map(|side| {
        let lifted = contact.coefficients[outermost[side]].is_empty();
        line.open[side] || scene.may_end() && lifted
    })
}

/// The part of the overlap that the contact's axis covers.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Line {
    ends: [f64; 2],
    /// Whether the contact may end before the axis does.
    open: [bool; 2],
}

impl Line {
    /// A first guess.
    fn first(scene: &Scene, slices: Option<&Slices>) -> Self {
        Self::reaching(scene, slices.map_or(scene.overlap(), |slices| slices.ends), MARGIN)
    }

    /// An axis up to `ends`, and at open ends a `margin` beyond them, in half-lengths.
    fn reaching(scene: &Scene, ends: [f64; 2], margin: f64) -> Self {
        let overlap = scene.overlap();
        let longest = scene.half_length;
        let [from, to] = ends.map(|end| end.clamp(overlap[0], overlap[1]));
        let beyond = margin * 0.5 * (to - from);
        let wanted = [from - beyond, to + beyond];
        // What all but reaches the end of the bodies ends there.
        let near = |side: usize| (wanted[side] - overlap[side]).abs() <= END_ERROR * longest;
        let past = [wanted[0] <= overlap[0] || near(0), wanted[1] >= overlap[1] || near(1)];
        Self {
            ends: [0, 1].map(|side| if past[side] { overlap[side] } else { wanted[side] }),
            open: past.map(|past| !past),
        }
    }

    /// Half of the line's length.
    fn half(&self) -> f64 {
        0.5 * (self.ends[1] - self.ends[0])
    }
}

/// The search for the zero of a function whose slope is about 1, or at least of one sign: by
/// secants, and within two arguments whose values are of different signs as soon as both are known.
#[derive(Debug, Default)]
struct Secants {
    /// The argument and the value before.
    last: Option<[f64; 2]>,
    /// The last arguments with a value below zero, and above.
    below: Option<f64>,
    above: Option<f64>,
}

impl Secants {
    /// Distance of two arguments with values of different signs; infinite as long as one is
    /// unknown.
    fn width(&self) -> f64 {
        match (self.below, self.above) {
            (Some(one), Some(other)) => (other - one).abs(),
            _ => f64::INFINITY,
        }
    }

    /// The next argument to try, after the value at one.
    fn next(&mut self, at: f64, value: f64) -> f64 {
        let side = if value < 0.0 { &mut self.below } else { &mut self.above };
        *side = Some(at);
        let step = match self.last.replace([at, value]) {
            Some([before, was]) if value != was => {
                let longest = LONGEST_STEP * (at - before).abs();
                (-value * (at - before) / (value - was)).clamp(-longest, longest)
            }
            _ => -value,
        };
        let wanted = at + step;
        match (self.below, self.above) {
            (Some(a), Some(b)) if !(a.min(b)..a.max(b)).contains(&wanted) => 0.5 * (a + b),
            _ => wanted,
        }
    }
}

/// Most of a step of [`Secants`] in steps before it.
const LONGEST_STEP: f64 = 8.0;

/// Where the bodies touch on the axis of a pressure, and their load.
fn touch(pressure: &Pressure, contact: &ContactSolution) -> Touch {
    let [from, to] = pressure.ends();
    let [first, last] = contact.ends.map(|end| end.clamp(from, to));
    let first = if pressure.is_symmetric() { -last } else { first };
    let ends = if first < last { [first, last] } else { [from, to] };
    Touch::new(ends, &pressure.whole_line())
}

/// The moment about y = 0 of a contact's pressure.
fn moment(axis: &Panels, contact: &ContactSolution) -> f64 {
    let lines = contact.transform(0.0);
    let nodes = axis.nodes().iter().zip(axis.weights());
    nodes.zip(lines.iter()).map(|((y, weight), line)| weight * y * line).sum()
}

/// Bodies on an axis.
struct Parts {
    axis: Panels,
    wavenumbers: Wavenumbers,
    bodies: Vec<Stack>,
    compliances: Vec<DMatrix<f64>>,
    condition: f64,
}

/// A contact whose ends are found.
struct Settled {
    line: Line,
    parts: Parts,
    contact: ContactSolution,
    known: Known,
    /// Whether the ends no longer moved.
    is_settled: bool,
    /// Time spent on the bodies (s).
    setup: f64,
}

/// What is known of a contact from another solution of it.
struct Known {
    /// The half-widths; none where the contact cannot end before the bodies do.
    slices: Option<Slices>,
    /// The condition between the surfaces for a tilt that is held at a depth.
    spring: Option<Spring>,
}

/// See [`Rotation::Sprung`].
#[derive(Clone, Copy)]
struct Spring {
    tilt: f64,
    compliance: f64,
}

/// How accurate a contact is to be (p0), and how far it may violate the laws of contact.
struct Accuracy {
    tolerance: f64,
    soundness: f64,
}

/// What contacts are solved with.
struct Trial<'a> {
    scene: &'a Scene,
    resolution: &'a Resolution,
    /// Whether the pressure has the power of an end that it reaches. Before the contact's ends are
    /// known it may carry nothing there.
    powers: bool,
    accuracy: Accuracy,
    gap: &'a Shaped,
}

impl Trial<'_> {
    /// The contact from a first guess of its `line`, and from what else is known of it.
    fn settled(&self, mut line: Line, mut known: Known) -> Result<Settled> {
        let mut setup = 0.0;
        for trial in 1.. {
            go_on()?;
            let start = Instant::now();
            let parts = self.parts(&line)?;
            setup += start.elapsed().as_secs_f64();
            let contact = self.contact(&parts, &line, &mut known)?;
            let found = self.found(&line, &contact);
            let close = |(a, b): (&f64, &f64)| (a - b).abs() <= self.end_error() * line.half();
            let same = found.open == line.open && found.ends.iter().zip(&line.ends).all(close);
            if same || trial == MOST_TRIALS {
                return Ok(Settled { line, parts, contact, known, is_settled: same, setup });
            }
            line = found;
        }
        unreachable!("the trials end")
    }

    /// How closely an end is found, in half-lengths of the contact.
    fn end_error(&self) -> f64 {
        END_ERROR * (self.accuracy.tolerance / Resolution::COARSE).clamp(CLOSEST, 1.0)
    }

    /// The line that ends where the contact was found to end.
    fn found(&self, line: &Line, contact: &ContactSolution) -> Line {
        if !self.scene.may_end() {
            return *line;
        }
        let [mut from, to] = contact.ends;
        // An end that was not found lies farther out.
        let most = 0.2 * line.half();
        let limited = |found: f64, at: f64| found.clamp(at - most, at + most);
        let to = limited(to, line.ends[1]);
        from = if self.scene.is_symmetric() { -to } else { limited(from, line.ends[0]) };
        Line::reaching(self.scene, [from, to], 0.0)
    }

    /// The bodies on a line.
    fn parts(&self, line: &Line) -> Result<Parts> {
        let (scene, resolution) = (self.scene, self.resolution);
        let symmetric = scene.is_symmetric();
        let known = scene.corner_exponents();
        let exponents = [0, 1].map(|side| known[side].filter(|_| self.powers && !line.open[side]));
        let (axis, parity) =
            resolution.contact_line(line.ends, exponents, &self.gap.kinks(), symmetric);
        let halves = [scene.bodies.block.half, scene.bodies.roller.half];
        let wavenumbers = resolution.wavenumbers_of(&halves, parity);
        let coarse = wavenumbers.coarse();
        let [block, roller] = [&scene.bodies.block, &scene.bodies.roller];
        // Bodies with the same ends and Poisson's ratio share one computation.
        let distinct =
            if scene.bodies_are_alike() { &BodyKind::ALL[..1] } else { &BodyKind::ALL[..] };
        let stack = |&kind: &BodyKind| {
            let SceneBody { half, middle, nu, .. } = scene.bodies[kind];
            let place = (middle, Shape { half, nu });
            let sort = (symmetric, scene.slides);
            Stack::new(&axis, sort, place, scene.end(kind), (resolution, coarse))
        };
        let bodies: Vec<Stack> = distinct.iter().map(stack).collect();
        let condition = checked_condition(&bodies)?;
        let compliances = (0..coarse.len()).map(|i| {
            let mut total = DMatrix::zeros(axis.len(), axis.len());
            bodies[0].add_compliance(i, block.share, &mut total);
            bodies[bodies.len() - 1].add_compliance(i, roller.share, &mut total);
            total
        });
        let compliances = compliances.collect();
        Ok(Parts { axis, wavenumbers, bodies, compliances, condition })
    }

    /// The contact on a line, from what is `known` of it, to which it adds.
    fn contact(&self, parts: &Parts, line: &Line, known: &mut Known) -> Result<ContactSolution> {
        let settings = ContactSettings {
            modes: self.resolution.modes,
            spacing: self.resolution.spacing,
            tolerance: CONTACT_TOLERANCE * self.accuracy.tolerance,
            max_iterations: 40,
            soundness: self.accuracy.soundness,
        };
        let scene = self.scene;
        let matrices = &parts.compliances;
        let compliance = Compliance { wavenumbers: &parts.wavenumbers, matrices };
        let problem = problem(scene, &compliance, &parts.axis, self.gap, line.open);
        let solved = |rotation, known: &mut Known, settings: &ContactSettings| {
            let problem = Problem { rotation, guess: known.slices.as_ref(), ..problem };
            let solution = contact::solve(&problem, settings)?;
            if scene.may_end() {
                known.slices = Slices::of_solution(&parts.axis, &solution).or(known.slices.take());
            }
            Ok(solution)
        };
        let wanted = match scene.tilt {
            Tilt::Held(wanted) if scene.depth != 0.0 => wanted,
            Tilt::Held(_) | Tilt::Free(_) => return solved(problem.rotation, known, &settings),
        };
        // Between the surfaces the tilt is another one than at the depth where it is held, by what
        // the load tilts the bodies up to there: nearly a multiple of its moment.
        let mut secants = Secants::default();
        let mut off = f64::INFINITY;
        // A pressure within the tolerance does not follow a change of the tilt below it.
        let settings = ContactSettings { tolerance: FOLLOWS * settings.tolerance, ..settings };
        let rough = ContactSettings { soundness: f64::INFINITY, ..settings };
        for trial in 0..MOST_TILTS {
            let Spring { tilt, compliance } =
                known.spring.unwrap_or(Spring { tilt: wanted, compliance: 0.0 });
            let rotation = Rotation::Sprung { tilt, compliance };
            let solution = solved(rotation, known, &rough)?;
            let deep = self.tilt(parts, &solution);
            off = (deep - wanted) * scene.half_length;
            // Solutions from different guesses differ by less than their error, and so do their
            // tilts.
            let error = CONTACT_TOLERANCE * self.accuracy.tolerance;
            let exhausted = secants.width() * scene.half_length <= error || trial >= PATIENCE;
            if off.abs() <= error || exhausted && off.abs() <= self.accuracy.tolerance {
                known.spring = Some(Spring { tilt, compliance });
                return solved(rotation, known, &settings);
            }
            known.spring = Some(match known.spring {
                Some(_) => Spring { tilt: secants.next(tilt, deep - wanted), compliance },
                None => {
                    let moment = moment(&parts.axis, &solution);
                    let about_middle = moment - scene.middle * scene.load;
                    let compliance = (deep - solution.tilt) / about_middle;
                    // Below zero there may be two solutions.
                    let compliance = if compliance > 0.0 { compliance } else { 0.0 };
                    Spring { tilt: tilt + compliance * moment - (deep - wanted), compliance }
                }
            });
        }
        Err(Error::NotConverged {
            iterations: MOST_TILTS,
            residual: off.abs(),
            remedy: "the held tilt was not reached: give the load's eccentricity_m instead".into(),
        })
    }

    /// The tilt at the depth where it is held.
    fn tilt(&self, parts: &Parts, contact: &ContactSolution) -> f64 {
        let scene = self.scene;
        let (widths, modes) = (contact.half_widths.clone(), contact.coefficients.clone());
        let pressure = Pressure::new(parts.axis.clone(), scene.is_symmetric(), widths, modes);
        let moments = pressure.moments(&parts.wavenumbers);
        let [block, roller] =
            [&parts.bodies[0], &parts.bodies[parts.bodies.len() - 1]].map(|body| {
                Field::new(body, &parts.wavenumbers, &pressure, &moments, None, scene.tolerance)
            });
        deep::tilt(scene, [&block, &roller], &touch(&pressure, contact), scene.depth)
    }
}

/// The law that a contact wider than long does not hold.
const WIDTH: &str = "the contact's width over its length along y";

/// Refuses a contact of the largest half-width `widest` that is wider than `limit` times its
/// `length`.
fn check_length(widest: f64, length: f64, limit: f64) -> Result<()> {
    let value = 2.0 * widest / length;
    if value <= limit {
        return Ok(());
    }
    Err(Error::Unsound {
        law: WIDTH,
        value,
        limit,
        remedy: "take the longer direction as y (exchange the radii of roller and profile), or --engine cells"
            .into(),
    })
}

/// The largest condition number of the bodies' equations, refused if rounding would not be
/// negligible.
fn checked_condition(bodies: &[Stack]) -> Result<f64> {
    let condition = bodies.iter().map(Stack::condition).fold(1.0, f64::max);
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

/// The contact of a scene on an `axis`, which holds one half of it if it is symmetric.
fn problem<'a>(
    scene: &Scene,
    compliance: &'a Compliance<'a>,
    axis: &'a Panels,
    gap: &'a Shaped,
    open: [bool; 2],
) -> Problem<'a> {
    let symmetric = scene.is_symmetric();
    let rotation = match scene.tilt {
        Tilt::Held(tilt) => Rotation::Held(tilt),
        Tilt::Free(arm) => Rotation::Free(scene.load * arm),
    };
    Problem {
        compliance,
        axis,
        both_ends: !symmetric,
        gap,
        load: if symmetric { 0.5 * scene.load } else { scene.load },
        rotation,
        open: [open[0] && !symmetric, open[1]],
        recedes: [scene.may_end() && !symmetric, scene.may_end()],
        guess: None,
    }
}
