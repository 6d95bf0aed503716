//! The contact on a line of trial ends: its ends are moved to where it was found to end, and a tilt
//! that is held at a depth is sought.

use super::deep::{self, Touch};
use super::end_search::EndSearch;
use super::first_guess::MARGIN;
use super::scene::{Scene, SceneBody, Tilt};
use crate::base::stop::go_on;
use crate::base::{BodyKind, Error, Panels, Result, Secants, Wavenumbers};
use crate::body::{LoadedLine, Placed, Resolution, Shape, SkinLine, Skins, Stack};
use crate::contact::{
    self, Compliance, ContactEnd, ContactSettings, ContactSolution, Problem, Rotation, Shaped,
    Slices,
};
use crate::stress::{Field, Load, Pressure};
use nalgebra::DMatrix;
use std::time::Instant;

/// Largest condition number of a body's equations for which rounding is negligible: it costs this
/// many units of 1e-16. Scenes over the whole legal range stay below a thousandth of it
/// (docs/robustness.md).
const WORST_CONDITION: f64 = 1e7;

/// Tolerance of the contact's iteration, in tolerances of the scene.
pub(super) const CONTACT_TOLERANCE: f64 = 1e-2;

/// Most contacts that are solved until the ends are found, or the tilt that is held.
const MOST_TRIALS: usize = 10;

/// How closely an end is found (half-lengths of the contact) at [`Resolution::COARSE`] and coarser
/// tolerances. Below, it falls with the tolerance, as the pressure is steep beside an end, to the
/// part `CLOSEST` of this. An elliptical contact's half-length is about `ELLIPTICAL` times
/// [`ContactEnd::rise`], and where that is shorter it takes the half-length's place. Nodes tell an
/// end no closer than within the part `BY_NODES` of the panel next to it.
const END_ERROR: f64 = 2e-3;
const CLOSEST: f64 = 0.1;
const ELLIPTICAL: f64 = 2.4;
const BY_NODES: f64 = 0.05;

/// An end that is moved changes the pressure at `RIM` (C) inside it at most by the part `SHARE` of
/// the tolerance. At the distance s from the end of an elliptical contact of half-length l the
/// pressure is p0 sqrt(2 s / l), and changes by p0 / sqrt(2 s l) per length.
const SHARE: f64 = 0.7;
const RIM: f64 = 0.03;

/// How much longer (C) a line up to ends that were found at low cost is made: on one that is too
/// long the nodes tell the end better than on one that is too short.
const LONGER: f64 = 1.5e-3;

/// Tolerance of a contact whose tilt is sought, in those of others.
const FOLLOWS: f64 = 0.1;

/// Most tilts between the surfaces that are tried for one that is held at a depth, and those after
/// which the contact's own error is allowed: two solutions, as far apart as that, may follow each
/// other from the same tilt.
const MOST_TILTS: usize = 20;
const PATIENCE: usize = 10;

/// The part of the overlap that the contact's axis covers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Line {
    /// Its ends along y.
    pub ends: [f64; 2],
    /// Whether the contact may end before the axis does.
    pub open: [bool; 2],
}

impl Line {
    /// A first guess.
    pub fn first(scene: &Scene, slices: Option<&Slices>) -> Self {
        let [from, to] = slices.map_or(scene.overlap(), |slices| slices.ends);
        let beyond = MARGIN * 0.5 * (to - from);
        Self::reaching(scene, [from - beyond, to + beyond], [END_ERROR * scene.half_length; 2])
    }

    /// An axis up to `ends`, which are known within these `errors`.
    fn reaching(scene: &Scene, ends: [f64; 2], errors: [f64; 2]) -> Self {
        let overlap = scene.overlap();
        // What all but reaches the end of the bodies ends there.
        let past = [ends[0] <= overlap[0] + errors[0], ends[1] >= overlap[1] - errors[1]];
        Self {
            ends: [0, 1].map(|side| if past[side] { overlap[side] } else { ends[side] }),
            open: past.map(|past| !past),
        }
    }

    /// The line that is [`LONGER`].
    pub fn longer(&self, scene: &Scene) -> Self {
        let [from, to] = self.ends;
        Self::reaching(scene, [from - LONGER, to + LONGER], [0.0; 2])
    }

    /// Half of the line's length.
    fn half(&self) -> f64 {
        0.5 * (self.ends[1] - self.ends[0])
    }
}

/// The moment about y = 0 of a contact's pressure.
fn moment(axis: &Panels, contact: &ContactSolution) -> f64 {
    let lines = contact.transform(0.0);
    let nodes = axis.nodes().iter().zip(axis.weights());
    nodes.zip(lines.iter()).map(|((y, weight), line)| weight * y * line).sum()
}

/// Bodies on an axis.
pub(super) struct Parts {
    pub axis: Panels,
    pub wavenumbers: Wavenumbers,
    /// The block and the roller; one for both if they are alike.
    pub bodies: Vec<Stack>,
    /// The skins of these bodies, where they are round.
    pub skins: Vec<Option<Skins>>,
    /// The compliance of both together at each coarse wavenumber.
    pub compliances: Vec<DMatrix<f64>>,
    /// The largest condition number of their equations.
    pub condition: f64,
}

/// The part of a body among `parts`, which are the block's and the roller's, or one for both if
/// they are alike.
pub(super) fn part_of<T>(parts: &[T], kind: BodyKind) -> &T {
    match kind {
        BodyKind::Block => &parts[0],
        BodyKind::Roller => &parts[parts.len() - 1],
    }
}

/// A contact whose ends are found.
pub(super) struct Settled {
    pub line: Line,
    /// The line that would be tried next.
    pub next: Line,
    pub parts: Parts,
    pub contact: ContactSolution,
    pub known: Known,
    /// Whether the ends no longer moved.
    pub is_settled: bool,
    /// Time spent on the bodies (s).
    pub setup: f64,
}

/// What is known of a contact from another solution of it.
pub(super) struct Known {
    /// The half-widths; none where the contact cannot end before the bodies do.
    pub slices: Option<Slices>,
    /// The condition between the surfaces for a tilt that is held at a depth.
    pub spring: Option<Spring>,
}

/// See [`Rotation::Sprung`].
#[derive(Clone, Copy)]
pub(super) struct Spring {
    tilt: f64,
    compliance: f64,
}

/// How accurate a contact is to be (p0), and how far it may violate the laws of contact.
pub(super) struct Accuracy {
    pub tolerance: f64,
    pub soundness: f64,
}

/// What contacts are solved with.
pub(super) struct Trial<'a> {
    pub scene: &'a Scene,
    pub resolution: &'a Resolution,
    /// Whether the pressure has the power of an end that it reaches. Before the contact's ends are
    /// known it may carry nothing there.
    pub powers: bool,
    pub accuracy: Accuracy,
    pub gap: &'a Shaped,
}

impl Trial<'_> {
    /// The contact from a first guess of its `line`, and from what else is known of it.
    pub fn settled(&self, mut line: Line, mut known: Known) -> Result<Settled> {
        let mut setup = 0.0;
        let mut searches = [EndSearch::new(-1.0), EndSearch::new(1.0)];
        for trial in 1.. {
            go_on()?;
            let start = Instant::now();
            let parts = self.parts(&line)?;
            setup += start.elapsed().as_secs_f64();
            let contact = self.contact(&parts, &line, &mut known)?;
            let errors = contact.ends.map(|end| self.end_error(&line, end));
            let next = self.next(&line, &contact, errors, &mut searches);
            let stays = |side: usize| searches[side].off() <= errors[side];
            let is_settled = next.open == line.open && stays(0) && stays(1);
            if is_settled || trial == MOST_TRIALS {
                return Ok(Settled { line, next, parts, contact, known, is_settled, setup });
            }
            line = next;
        }
        unreachable!("the trials end")
    }

    /// How closely an end is found (C).
    fn end_error(&self, line: &Line, end: ContactEnd) -> f64 {
        let part = END_ERROR * (self.accuracy.tolerance / Resolution::COARSE).clamp(CLOSEST, 1.0);
        let half = line.half().min(ELLIPTICAL * end.rise);
        let of_pressure = SHARE * self.accuracy.tolerance * (2.0 * RIM * half).sqrt();
        (part * half).min(of_pressure).max(BY_NODES * self.resolution.corner)
    }

    /// The line to try after this one, whose ends the contact told within these `errors`.
    fn next(
        &self,
        line: &Line,
        contact: &ContactSolution,
        errors: [f64; 2],
        searches: &mut [EndSearch; 2],
    ) -> Line {
        if !self.scene.may_end() {
            return *line;
        }
        let [before, after] = searches;
        let to = after.next(line.ends[1], contact.ends[1]);
        let from = match self.scene.is_symmetric() {
            true => -to,
            false => before.next(line.ends[0], contact.ends[0]),
        };
        Line::reaching(self.scene, [from, to], errors)
    }

    /// The bodies on a line.
    fn parts(&self, line: &Line) -> Result<Parts> {
        let (scene, resolution) = (self.scene, self.resolution);
        let symmetric = scene.is_symmetric();
        let known = scene.corner_exponents();
        let exponents = [0, 1].map(|side| known[side].filter(|_| self.powers && !line.open[side]));
        let gap = self.gap.generatrix();
        let (axis, parity) = resolution.contact_line(line.ends, exponents, &gap.kinks, symmetric);
        let axis = resolution.resolving(axis, &gap, self.accuracy.tolerance);
        let halves = [scene.bodies.block.half, scene.bodies.roller.half];
        let wavenumbers = resolution.wavenumbers_of(&halves, parity);
        let coarse = wavenumbers.coarse();
        // Bodies with the same ends and Poisson's ratio share one computation.
        let distinct =
            if scene.bodies_are_alike() { &BodyKind::ALL[..1] } else { &BodyKind::ALL[..] };
        let placed = |kind: BodyKind| {
            let SceneBody { half, middle, nu, .. } = scene.bodies[kind];
            Placed { middle, shape: Shape { half, nu }, end: scene.end(kind) }
        };
        let stack = |&kind: &BodyKind| {
            let line = LoadedLine { axis: &axis, symmetric, slides: scene.slides };
            Stack::new(line, placed(kind), resolution, coarse)
        };
        let bodies: Vec<Stack> = distinct.iter().map(stack).collect();
        // While ends are sought all is coarser than what a round shape adds.
        let curvatures = scene.curvatures.map(|own| if self.powers { *own } else { 0.0 });
        let skin = |&kind: &BodyKind| {
            let alike = distinct.len() == 1;
            let others = BodyKind::ALL.into_iter().filter(|other| alike || *other == kind);
            let sharper = |a: f64, b: f64| if b.abs() > a.abs() { b } else { a };
            let curvature = others.map(|kind| curvatures[kind]).fold(0.0, sharper);
            let (ends, kinks) = (line.ends, &gap.kinks);
            let line = SkinLine { ends, exponents, kinks, symmetric, least_corner: 0.0 };
            let error = self.accuracy.tolerance / curvature.abs();
            (curvature != 0.0).then(|| Skins::new(line, placed(kind), curvature, error))
        };
        let skins: Vec<Option<Skins>> = distinct.iter().map(skin).collect();
        let condition = checked_condition(&bodies)?;
        let compliances = (0..coarse.len()).map(|i| {
            let mut total = DMatrix::zeros(axis.len(), axis.len());
            for kind in BodyKind::ALL {
                let share = scene.bodies[kind].share;
                part_of(&bodies, kind).add_compliance(i, share, &mut total);
            }
            total
        });
        let mut compliances: Vec<DMatrix<f64>> = compliances.collect();
        for kind in BodyKind::ALL.into_iter().filter(|kind| curvatures[*kind] != 0.0) {
            let skins = part_of(&skins, kind).as_ref().expect("a round body has a skin");
            let factor = curvatures[kind] * scene.bodies[kind].share;
            skins.add_compliances(coarse.nodes(), factor, &axis, &mut compliances);
        }
        Ok(Parts { axis, wavenumbers, bodies, skins, compliances, condition })
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
        match self.scene.tilt {
            Tilt::Held(wanted) if self.scene.depth != 0.0 => {
                self.held(parts, line, known, wanted, settings)
            }
            Tilt::Held(_) | Tilt::Free(_) => self.solved(parts, line, known, None, &settings),
        }
    }

    /// The contact with this `rotation` in place of the scene's, if there is one.
    fn solved(
        &self,
        parts: &Parts,
        line: &Line,
        known: &mut Known,
        rotation: Option<Rotation>,
        settings: &ContactSettings,
    ) -> Result<ContactSolution> {
        let matrices = &parts.compliances;
        let compliance = Compliance { wavenumbers: &parts.wavenumbers, matrices };
        let of_scene = problem(self.scene, &compliance, &parts.axis, self.gap, line.open);
        let rotation = rotation.unwrap_or(of_scene.rotation);
        let problem = Problem { rotation, guess: known.slices.as_ref(), ..of_scene };
        let solution = contact::solve(&problem, settings)?;
        if self.scene.may_end() {
            known.slices = Slices::of_solution(&parts.axis, &solution).or(known.slices.take());
        }
        Ok(solution)
    }

    /// The contact with the `wanted` tilt at the depth where it is held. Between the surfaces it is
    /// another one, by what the load tilts the bodies up to there: nearly a multiple of its moment.
    fn held(
        &self,
        parts: &Parts,
        line: &Line,
        known: &mut Known,
        wanted: f64,
        settings: ContactSettings,
    ) -> Result<ContactSolution> {
        let scene = self.scene;
        let mut secants = Secants::new();
        let mut off = f64::INFINITY;
        // A pressure within the tolerance does not follow a change of the tilt below it.
        let settings = ContactSettings { tolerance: FOLLOWS * settings.tolerance, ..settings };
        let rough = ContactSettings { soundness: f64::INFINITY, ..settings };
        for trial in 0..MOST_TILTS {
            let Spring { tilt, compliance } =
                known.spring.unwrap_or(Spring { tilt: wanted, compliance: 0.0 });
            let rotation = Some(Rotation::Sprung { tilt, compliance });
            let solution = self.solved(parts, line, known, rotation, &rough)?;
            let deep = self.tilt(parts, &solution);
            off = (deep - wanted) * scene.half_length;
            // Solutions from different guesses differ by less than their error, and so do their
            // tilts.
            let error = CONTACT_TOLERANCE * self.accuracy.tolerance;
            let exhausted = secants.width() * scene.half_length <= error || trial >= PATIENCE;
            if off.abs() <= error || exhausted && off.abs() <= self.accuracy.tolerance {
                known.spring = Some(Spring { tilt, compliance });
                return self.solved(parts, line, known, rotation, &settings);
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
        let [block, roller] = BodyKind::ALL.map(|kind| {
            let body = part_of(&parts.bodies, kind);
            Field::new(body, &parts.wavenumbers, &pressure, &moments, None, scene.tolerance)
        });
        deep::tilt(scene, [&block, &roller], &touch(&pressure, contact), scene.depth)
    }
}

/// Where the bodies touch on the axis of a pressure, and their load.
pub(super) fn touch(pressure: &Pressure, contact: &ContactSolution) -> Touch {
    let [from, to] = pressure.ends();
    let [first, last] = contact.ends.map(|end| end.at);
    let ends = if first < last { [first, last] } else { [from, to] };
    Touch::new(ends, &pressure.whole_line())
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
pub(super) fn problem<'a>(
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
        turns: [(axis.breaks()[0], 1.0), (axis.end(), -1.0)].map(|(y, to)| gap.turns_within(y, to)),
        guess: None,
    }
}
