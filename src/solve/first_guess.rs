//! What is known of a contact before it is solved: by slices without neighbours.

use super::scene::{Scene, Tilt};
use crate::base::{BodyKind, Kink};
use crate::body::Resolution;
use crate::contact::{Shaped, Slices};

/// How far beyond a first guess the axis reaches, in half-lengths of the contact.
pub(super) const MARGIN: f64 = 0.15;

/// How near its guessed end is to that of the bodies (half-lengths) for a contact to reach it.
const REACHES: f64 = 0.01;

/// A contact that all but reaches the end of its bodies, with so much left to it, turns within this
/// many times as much: beside a corner the pressure is as steep as the corner is near.
const CORNER: f64 = 10.0;

/// Width, in its lengths, of a contact that ends before its bodies do from which on it has the
/// resolution of tighter tolerances, in proportion: the pressure is the higher, and changes the
/// faster along the nodes, the shorter it is.
const SLENDER: f64 = 0.15;

/// Length (C) between a kink of the gap and the end of a contact beyond it below which the contact
/// has the resolution of tighter tolerances, in proportion: the pressure rises and falls within it.
/// Not of tighter ones than `CLOSE`: there are contacts that these do not solve.
const RUNS_OUT: f64 = 0.15;
const CLOSE: f64 = 1e-3;

/// Half-length (own units) of a body with free ends below which a load beside its middle asks for
/// the resolution of [`Resolution::COARSE`] at least. Under long waves the equations of a plate in
/// bending are close to singular, and between its ends there are few panels: at coarser ones their
/// errors decide, and stresses are wrong by a multiple of p0.
const BENDS: f64 = 2.0;

/// Half-width at the ends of the bodies, as a part of the largest one, from which on a first guess
/// is sure that the contact reaches them.
const SURE: f64 = 0.8;

/// A half-width (C) from which a contact has a unit of its own.
const WIDER: f64 = 1.4;

impl Scene {
    /// The resolution for a tolerance (p0), where `slices` are what is known of a contact that may
    /// end before its bodies do.
    pub(super) fn resolution(&self, tolerance: f64, slices: Option<&Slices>) -> Resolution {
        let tolerance = match self.bends_short_bodies() {
            true => tolerance.min(Resolution::COARSE),
            false => tolerance,
        };
        let overlap = self.overlap();
        let Some(slices) = slices else { return self.level(tolerance, overlap) };
        let sharper = tolerance / (RUNS_OUT / self.beyond_a_kink(slices)).max(1.0);
        let tolerance = sharper.max(CLOSE.min(tolerance));
        if self.ends_inside(slices) {
            let wider = slices.width_over_length() / SLENDER;
            return Resolution::for_tips(tolerance / wider.max(1.0));
        }
        let gap = self.gap();
        let ends = [0, 1].map(|side: usize| slices.ends[side].clamp(overlap[0], overlap[1]));
        let left = [ends[0] - overlap[0], overlap[1] - ends[1]];
        let turns = [0, 1].map(|side| {
            let inward = if side == 0 { 1.0 } else { -1.0 };
            let corner = if left[side] > 0.0 { CORNER * left[side] } else { f64::INFINITY };
            gap.turns_within(ends[side], inward).min(corner)
        });
        let level = self.level(tolerance, slices.ends).following(turns);
        let reaches = [0, 1].map(|side| self.reaches(slices.ends, side));
        // What all but reaches an end of its bodies narrows to a tip, too.
        let narrows = left.iter().any(|left| *left > 0.0);
        let level = if narrows { level.narrowing(tolerance) } else { level };
        let is_steep = reaches.contains(&true) || !gap.kinks().is_empty();
        if is_steep { level.across(slices.widest()) } else { level }
    }

    /// How far a contact of these `slices` goes on beyond the last kinks of the gap (C), on the
    /// side where that is less, before its bodies end; infinite without one.
    fn beyond_a_kink(&self, slices: &Slices) -> f64 {
        let ([from, to], overlap) = (slices.ends, self.overlap());
        let beyond = |Kink { at, .. }: Kink| {
            let apart = [(at - from, from > overlap[0]), (to - at, to < overlap[1])];
            apart.map(|(apart, ends)| if ends && apart > 0.0 { apart } else { f64::INFINITY })
        };
        self.gap().kinks().into_iter().flat_map(beyond).fold(f64::INFINITY, f64::min)
    }

    /// Whether a contact that has about these `ends` reaches the end of its bodies on a side.
    fn reaches(&self, ends: [f64; 2], side: usize) -> bool {
        (ends[side] - self.overlap()[side]).abs() <= REACHES * self.half_length
    }

    /// The resolution for a `tolerance` (p0) of a contact that has about these `ends`. The pressure
    /// has the power of an end of the bodies only where it reaches that.
    fn level(&self, tolerance: f64, ends: [f64; 2]) -> Resolution {
        let known = self.corner_exponents();
        let exponents = [0, 1].map(|side| known[side].filter(|_| self.reaches(ends, side)));
        let largest = exponents.into_iter().flatten().reduce(f64::max);
        Resolution::of(tolerance, &self.end(BodyKind::Block), largest, !self.may_end())
    }

    /// Whether a load beside the middle of a short body with free ends bends it.
    fn bends_short_bodies(&self) -> bool {
        let is_short = |kind: BodyKind| self.end(kind).freed && self.bodies[kind].half < BENDS;
        !self.is_symmetric() && BodyKind::ALL.into_iter().any(is_short)
    }

    /// Whether a contact of these `slices` ends well before its bodies do.
    pub(super) fn ends_inside(&self, slices: &Slices) -> bool {
        let (overlap, least) = (self.overlap(), MARGIN * self.half_length);
        slices.ends[0] - overlap[0] > least && overlap[1] - slices.ends[1] > least
    }

    /// Whether the ends of a contact, or a tilt that is held at a depth, have to be sought beyond
    /// the first guess, its `slices`.
    pub(super) fn needs_search(&self, slices: &Slices) -> bool {
        let reached = |end: &f64| slices.half_width(*end) >= SURE * slices.widest();
        matches!(self.tilt, Tilt::Held(_)) || !self.overlap().iter().all(reached)
    }

    /// The unit of length, in C, in which the contact has a half-width of about 1, or a half-length
    /// where that is shorter. That of Hertz's line contact is left as it is where the contact is
    /// not much wider.
    pub(super) fn own_unit(&self) -> f64 {
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
    pub(super) fn slices(&self, gap: &Shaped) -> Slices {
        let (moment, tilt) = self.moment_and_tilt();
        Slices::new(gap, self.overlap(), self.load, moment, tilt)
    }
}
