//! Axes chosen from a requested accuracy.

use super::end::End;
use super::part::Part;
use crate::base::{Corner, Growth, Panels, Parity, Wavenumbers, ledge};
use serde::{Deserialize, Serialize};

/// Wavenumber below which the contact's width has no effect.
const SLOW: f64 = 0.5;

/// Growth of panels of wavenumbers below [`SLOW`] under odd loads. With four nodes on a panel that
/// grows by 16 tilts were up to 1 % wrong, and the stiffness against a tilt and an approach was 2 %
/// from being symmetric. Their number changes at half-lengths of 3.5 C, 24.5 C and so on.
const BENDING_GROWTH: f64 = 7.0;

/// Largest end of the first panel of wavenumbers: bodies may be much shorter than the contact is
/// wide.
const LONGEST: f64 = 2.0;

/// Widest panel of wavenumbers along an end face: it resolves depths of some ten C.
const WIDEST: f64 = 1.0;

/// Wavenumber times half-thickness beyond which the plate acts as two half-spaces: its remainder is
/// negligible.
pub(super) const PLATE_FADES: f64 = 8.0;

/// Wavenumber times half-length up to which one panel holds the waves of a plate in bending.
pub(super) const BENDS: f64 = 0.25;

/// Largest growth of the panels of depths and wavenumbers along an end face of a plate in bending,
/// whose loads reach as deep as the wave is long.
const BENDING_RATIO: f64 = 2.0;

/// Largest ratio of two bodies' half-lengths for which the first panel of wavenumbers is that of
/// the longer one.
const UNLIKE: f64 = 10.0;

/// Further panels of wavenumbers along an end face of a plate in bending, as parts of the smallest
/// one.
const BENDING: [f64; 3] = [0.1, 0.2, 0.45];

/// Distance (C) from a corner within which panels grow by a ratio of their own.
const STEEP: f64 = 0.02;

/// Distance (C) from the contact's end within which the loads have the power of a singular
/// pressure.
pub(super) const LAW: f64 = 1.0;

/// Depth (C) below which the load on an end face has no features of the contact's width.
const FACE_TAIL: f64 = 8.0;

/// The resolution of a solution; all lengths are in units of C.
///
/// [`Resolution::for_tolerance`] chooses it; [`Resolution::refined`] halves every panel and doubles
/// every extent, to show convergence.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct Resolution {
    /// Gauss nodes per panel along y and along the end faces' depth.
    pub order: usize,
    /// Panel next to a loaded corner (C).
    pub corner: f64,
    /// Growth of panels within 0.02 C of a corner: the nearer, the less a load weighs in what is
    /// computed farther away.
    pub corner_ratio: f64,
    /// Growth of panels away from a corner.
    pub ratio: f64,
    /// Modes of the pressure across the contact.
    pub modes: usize,
    /// Smallest distance (C) along the line between independent half-widths, and of the last one
    /// from the end, towards each end.
    pub spacing: [f64; 2],
    /// Largest wavenumber (1/C).
    pub k_max: f64,
    /// Gauss nodes per panel of wavenumbers.
    pub k_order: usize,
    /// Distance x (C) up to which the fine wavenumbers resolve cos(k x) in what the compliance and
    /// the pressure's transforms have together: a contact's half-widths count twice there.
    pub k_across: f64,
    /// Growth of the wavenumber panels above 0.5; below it panels grow by 10 or 20.
    pub k_ratio: f64,
    /// Largest end of the first wavenumber panel (1/C).
    pub k_min: f64,
    /// Images of the corrected pressure in the end faces on either side, in lengths of the body;
    /// beyond them uniform strips carry its mean.
    pub images: usize,
    /// Length of an end face's axis, in decay lengths 1/k.
    pub face_reach: f64,
    /// Distance beyond which a load is negligible, in decay lengths 1/k.
    pub reach: f64,
}

/// The tolerances that have levels of their own. A table that has fewer lacks the first ones.
const TOLERANCES: [f64; 6] = [1e-1, 3e-2, 1e-2, 5e-3, 1e-3, 1e-4];

/// Largest distance between half-widths that follow a gap, in the length within which it turns, and
/// the least one (C): nearer to each other than the shortest waves are long they would be noise.
/// With 0.02 a contact that ends as much before its bodies do is four tolerances of 1e-3 off.
const TURN: f64 = 0.1;
const NARROWEST: f64 = 0.01;

/// Most growth of the panels at a corner towards which a half-width falls within that length: over
/// one of 0.1 C next to one of 0.015 C it falls by a third, and five nodes do not follow that.
const GENTLE: f64 = 3.0;

/// The least largest wavenumber times that distance, and how many times a level's own it is at
/// most. Where half-widths fall towards a tip, longer waves leave out what nodes so close do to
/// each other; far shorter ones than the level's nodes can tell apart are noise.
const RESOLVED: f64 = 5.0;
const SHORTER: f64 = 3.0;

/// A share this small is rounding.
const ROUNDING: f64 = 1e-12;

/// The levels where the pressure at the contact's end has a limit, at the last of [`TOLERANCES`].
///
/// `cargo bench --bench promise -- search` proposes levels, the cheapest that keep the errors of
/// some scenes within the tolerance, and `-- try` shows what a change does; `-- hold` measures
/// others. These and the next ones lie between what it proposed and finer ones, where the tests of
/// fields, approaches and ends asked for them.
const FINITE: [Resolution; 5] = [
    Resolution {
        order: 3,
        corner: 0.06,
        corner_ratio: 3.0,
        ratio: 3.0,
        modes: 3,
        spacing: [0.15; 2],
        k_max: 12.0,
        k_order: 3,
        k_across: 2.0,
        k_min: 0.05,
        k_ratio: 5.0,
        images: 1,
        face_reach: 10.0,
        reach: 8.0,
    },
    Resolution {
        order: 4,
        corner: 0.02,
        corner_ratio: 2.6,
        ratio: 2.6,
        modes: 3,
        spacing: [0.075; 2],
        k_max: 36.0,
        k_order: 3,
        k_across: 2.0,
        k_min: 0.05,
        k_ratio: 5.5,
        images: 1,
        face_reach: 10.0,
        reach: 8.0,
    },
    Resolution {
        order: 5,
        corner: 0.012,
        corner_ratio: 2.4,
        ratio: 2.5,
        modes: 6,
        spacing: [0.05; 2],
        k_max: 36.0,
        k_order: 4,
        k_across: 2.0,
        k_min: 0.05,
        k_ratio: 8.0,
        images: 1,
        face_reach: 12.0,
        reach: 8.4,
    },
    Resolution {
        order: 6,
        corner: 0.0055,
        corner_ratio: 2.5,
        ratio: 2.4,
        modes: 6,
        spacing: [0.025; 2],
        k_max: 100.0,
        k_order: 4,
        k_across: 2.0,
        k_min: 0.01,
        k_ratio: 4.0,
        images: 2,
        face_reach: 15.0,
        reach: 15.0,
    },
    Resolution {
        order: 7,
        corner: 0.002,
        corner_ratio: 2.2,
        ratio: 2.1,
        modes: 8,
        spacing: [0.02; 2],
        k_max: 200.0,
        k_order: 5,
        k_across: 2.2,
        k_min: 0.003,
        k_ratio: 3.0,
        images: 4,
        face_reach: 19.0,
        reach: 20.0,
    },
];

/// The same where the pressure grows without bound at a free end: the loads on the end face do so
/// too, and carry much from next to the corner. Its panels are many times smaller, and grow fast.
const SINGULAR: [Resolution; 5] = [
    Resolution {
        order: 3,
        corner: 0.01,
        corner_ratio: 7.29,
        ratio: 2.7,
        modes: 3,
        spacing: [0.12; 2],
        k_max: 20.0,
        k_order: 3,
        k_across: 2.0,
        k_min: 0.05,
        k_ratio: 5.0,
        images: 1,
        face_reach: 10.0,
        reach: 8.0,
    },
    Resolution {
        order: 4,
        corner: 0.007,
        corner_ratio: 7.29,
        ratio: 2.7,
        modes: 3,
        spacing: [0.075; 2],
        k_max: 50.0,
        k_order: 3,
        k_across: 2.0,
        k_min: 0.05,
        k_ratio: 4.95,
        images: 1,
        face_reach: 10.0,
        reach: 8.0,
    },
    Resolution {
        order: 5,
        corner: 0.0025,
        corner_ratio: 7.0,
        ratio: 2.8,
        modes: 4,
        spacing: [0.06; 2],
        k_max: 55.0,
        k_order: 4,
        k_across: 2.0,
        k_min: 0.03,
        k_ratio: 5.32,
        images: 1,
        face_reach: 14.0,
        reach: 8.7,
    },
    Resolution {
        order: 6,
        corner: 0.0017,
        corner_ratio: 5.8,
        ratio: 2.4,
        modes: 6,
        spacing: [0.04; 2],
        k_max: 130.0,
        k_order: 5,
        k_across: 2.0,
        k_min: 0.005,
        k_ratio: 4.5,
        images: 2,
        face_reach: 17.0,
        reach: 14.0,
    },
    Resolution {
        order: 7,
        corner: 0.0007,
        corner_ratio: 3.42,
        ratio: 2.0,
        modes: 8,
        spacing: [0.03; 2],
        k_max: 160.0,
        k_order: 5,
        k_across: 2.2,
        k_min: 0.003,
        k_ratio: 3.0,
        images: 4,
        face_reach: 18.0,
        reach: 16.0,
    },
];

/// Those of straight bodies that are symmetric about the contact's middle, by what is other than at
/// the levels of all bodies. Nothing bends such bodies: long waves turn others as 1 / k, and what
/// clusters of panels and panels of wavenumbers leave out counts a hundred times.
const STRAIGHT_FINITE: [Resolution; 6] = [
    Resolution { order: 2, ratio: 2.9, k_across: 1.5, reach: 5.93, ..FINITE[0] },
    Resolution {
        corner: 0.035,
        ratio: 2.6,
        modes: 5,
        spacing: [0.12; 2],
        k_max: 13.0,
        k_ratio: 6.0,
        face_reach: 8.5,
        reach: 9.0,
        ..FINITE[0]
    },
    Resolution {
        order: 3,
        corner: 0.03,
        ratio: 2.1,
        modes: 5,
        spacing: [0.07; 2],
        k_max: 26.0,
        k_ratio: 6.0,
        ..FINITE[1]
    },
    Resolution {
        order: 4,
        ratio: 2.3,
        modes: 4,
        spacing: [0.08; 2],
        k_order: 3,
        k_min: 0.035,
        k_ratio: 7.0,
        reach: 9.2,
        ..FINITE[2]
    },
    Resolution {
        order: 5,
        corner: 0.0045,
        ratio: 2.3,
        spacing: [0.04; 2],
        face_reach: 19.0,
        ..FINITE[3]
    },
    Resolution {
        ratio: 1.85,
        k_max: 170.0,
        k_min: 0.004,
        k_ratio: 4.0,
        images: 8,
        face_reach: 17.0,
        ..FINITE[4]
    },
];

/// The same of straight bodies where the pressure grows without bound.
const STRAIGHT_SINGULAR: [Resolution; 6] = [
    Resolution {
        corner: 0.02,
        corner_ratio: 6.4,
        ratio: 3.5,
        modes: 2,
        k_order: 2,
        k_across: 1.5,
        k_min: 0.037,
        reach: 5.2,
        ..SINGULAR[0]
    },
    Resolution { k_max: 26.0, ..SINGULAR[0] },
    Resolution { spacing: [0.13; 2], reach: 9.0, ..SINGULAR[1] },
    Resolution {
        order: 4,
        corner: 0.002,
        corner_ratio: 6.0,
        ratio: 2.4,
        reach: 9.6,
        ..SINGULAR[2]
    },
    Resolution {
        order: 5,
        corner: 0.0009,
        ratio: 2.3,
        modes: 5,
        spacing: [0.06; 2],
        reach: 15.0,
        ..SINGULAR[3]
    },
    Resolution { spacing: [0.04; 2], k_ratio: 2.6, ..SINGULAR[4] },
];

/// Those of contacts that end before their bodies do at both ends: the pressure falls to zero
/// there, and only its length has to be found. Waves have to tell how narrow the contact is as near
/// to a tip as pressures are asked for, and the first panel is so short that a transform does not
/// turn within it. Where a long one is eccentric, its end depends on what long waves do as much as
/// on its tips.
const TIPS: [Resolution; 5] = [
    Resolution { corner: 0.02, k_max: 30.0, ..FINITE[0] },
    Resolution {
        order: 4,
        corner: 0.015,
        corner_ratio: 2.6,
        ratio: 2.6,
        k_max: 60.0,
        k_order: 4,
        ..FINITE[0]
    },
    Resolution {
        order: 4,
        corner: 0.01,
        corner_ratio: 2.5,
        ratio: 2.5,
        modes: 4,
        spacing: [0.1; 2],
        k_max: 95.0,
        k_order: 4,
        k_across: 2.5,
        k_min: 0.05,
        k_ratio: 6.5,
        images: 1,
        face_reach: 10.0,
        reach: 8.0,
    },
    Resolution {
        order: 5,
        corner: 0.005,
        corner_ratio: 2.0,
        ratio: 2.0,
        modes: 5,
        spacing: [0.05; 2],
        k_max: 260.0,
        k_order: 4,
        k_across: 2.5,
        k_min: 0.01,
        k_ratio: 3.2,
        images: 2,
        face_reach: 14.0,
        reach: 14.0,
    },
    Resolution {
        order: 7,
        corner: 0.003,
        corner_ratio: 1.8,
        ratio: 1.8,
        modes: 7,
        spacing: [0.05; 2],
        k_max: 500.0,
        k_order: 5,
        k_across: 3.0,
        k_min: 0.005,
        k_ratio: 2.2,
        images: 4,
        face_reach: 18.0,
        reach: 18.0,
    },
];

/// The same for half-spaces: their pressure is the steepest at its end, and nodes and wavenumbers
/// cost little without end faces.
const ENDLESS: [Resolution; 5] = [
    Resolution {
        order: 5,
        corner: 0.015,
        corner_ratio: 3.0,
        ratio: 3.0,
        modes: 3,
        spacing: [0.1; 2],
        k_max: 60.0,
        k_order: 4,
        k_across: 2.0,
        k_min: 0.05,
        k_ratio: 2.6,
        images: 1,
        face_reach: 10.0,
        reach: 8.0,
    },
    Resolution {
        order: 4,
        corner: 0.015,
        corner_ratio: 3.0,
        ratio: 2.35,
        modes: 4,
        spacing: [0.0949; 2],
        k_max: 60.0,
        k_order: 4,
        k_across: 2.0,
        k_min: 0.0141,
        k_ratio: 4.0,
        images: 1,
        face_reach: 12.9,
        reach: 8.0,
    },
    Resolution {
        order: 5,
        corner: 0.008,
        corner_ratio: 2.8,
        ratio: 2.3,
        modes: 4,
        spacing: [0.0569; 2],
        k_max: 80.0,
        k_order: 5,
        k_across: 2.0,
        k_min: 0.05,
        k_ratio: 2.15,
        images: 1,
        face_reach: 12.2,
        reach: 8.0,
    },
    Resolution {
        order: 5,
        corner: 0.008,
        corner_ratio: 2.5,
        ratio: 2.05,
        modes: 6,
        spacing: [0.08; 2],
        k_max: 185.0,
        k_order: 6,
        k_across: 3.0,
        k_min: 0.0151,
        k_ratio: 2.34,
        images: 1,
        face_reach: 10.0,
        reach: 14.0,
    },
    Resolution {
        order: 7,
        corner: 0.0015,
        corner_ratio: 2.8,
        ratio: 2.1,
        modes: 8,
        spacing: [0.025; 2],
        k_max: 340.0,
        k_order: 6,
        k_across: 4.0,
        k_min: 0.005,
        k_ratio: 2.2,
        images: 1,
        face_reach: 18.0,
        reach: 24.0,
    },
];

impl Resolution {
    /// The tightest tolerance that has a resolution of its own.
    pub const FINEST: f64 = TOLERANCES[5];

    /// Smallest tolerance with a coarse resolution.
    pub const COARSE: f64 = TOLERANCES[3];

    /// The resolution of a body with end faces `end`, under a pressure that is singular at the
    /// contact's end with the exponent `corner`, if any: see [`Resolution::for_tolerance`]. Bodies
    /// that are all `straight`, and symmetric about the contact's middle, need less than others.
    pub fn of(tolerance: f64, end: &End, corner: Option<f64>, straight: bool) -> Self {
        let levels: &[Self] = match (end.image_weight, corner, straight) {
            (None, ..) => &ENDLESS,
            (Some(_), Some(_), true) => &STRAIGHT_SINGULAR,
            (Some(_), None, true) => &STRAIGHT_FINITE,
            (Some(_), Some(_), false) => &SINGULAR,
            (Some(_), None, false) => &FINITE,
        };
        Self::between(levels, tolerance)
    }

    /// The resolution for errors of about `tolerance` (a fraction of p0) where the pressure has a
    /// limit at the contact's end. Between the levels it is interpolated, so that no error jumps.
    pub fn for_tolerance(tolerance: f64) -> Self {
        Self::between(&FINITE, tolerance)
    }

    /// The same of a contact that ends before its bodies do, at both ends.
    pub fn for_tips(tolerance: f64) -> Self {
        Self::between(&TIPS, tolerance)
    }

    /// The same with half-widths towards each end of the contact that follow what turns there
    /// within a length (C), with waves as short as these ask for, and with panels that grow no
    /// faster than `GENTLE`. Towards an end that does not turn so soon half-widths as close would
    /// be noise.
    #[must_use]
    pub fn following(self, lengths: [f64; 2]) -> Self {
        let follows = |side: usize| self.spacing[side].min((TURN * lengths[side]).max(NARROWEST));
        let spacing = [0, 1].map(follows);
        let closest = spacing[0].min(spacing[1]);
        let k_max = (RESOLVED / closest).clamp(self.k_max, SHORTER * self.k_max);
        let turns = (0..2).any(|side| spacing[side] < self.spacing[side]);
        let corner_ratio = if turns { self.corner_ratio.min(GENTLE) } else { self.corner_ratio };
        let corner = self.corner.min(closest);
        Self { spacing, k_max, corner, corner_ratio, ..self }
    }

    /// The same for a contact that narrows to a tip at an end, for a `tolerance`: panels grow as
    /// slowly as those of [`Resolution::for_tips`]. Between their nodes the pressure's transform is
    /// followed up to the shorter waves the less the half-width changes over a panel.
    #[must_use]
    pub fn narrowing(self, tolerance: f64) -> Self {
        Self { ratio: self.ratio.min(Self::for_tips(tolerance).ratio), ..self }
    }

    /// The same for a contact that reaches an end of its bodies, or whose gap has a kink, and whose
    /// `widest` half-width (C) may be above 1. Its transform oscillates the faster, and a panel of
    /// wavenumbers with fewer nodes than that turns by radians would leave noise in what nodes
    /// beside each other do to each other, which half-widths beside the end and the kink follow.
    #[must_use]
    pub fn across(self, widest: f64) -> Self {
        Self { k_across: self.k_across * widest.max(1.0), ..self }
    }

    /// The resolution between two of the levels: lengths by their logarithms, numbers rounded up.
    fn between(levels: &[Self], tolerance: f64) -> Self {
        let tolerances = &TOLERANCES[TOLERANCES.len() - levels.len()..];
        let at = tolerance.clamp(Self::FINEST, tolerances[0]);
        let next =
            tolerances.iter().position(|level| *level <= at).unwrap_or(tolerances.len() - 1).max(1);
        let [wide, tight] = [next - 1, next].map(|i| tolerances[i]);
        let share = (wide / at).ln() / (wide / tight).ln();
        let (from, to) = (&levels[next - 1], &levels[next]);
        let mixed = |of: fn(&Self) -> f64| of(from) * (of(to) / of(from)).powf(share);
        let count = |of: fn(&Self) -> usize| match (of(from), of(to)) {
            (a, _) if share < ROUNDING => a,
            (_, b) if share > 1.0 - ROUNDING => b,
            (a, b) => a.max(b),
        };
        Self {
            order: count(|r| r.order),
            corner: mixed(|r| r.corner),
            corner_ratio: mixed(|r| r.corner_ratio),
            ratio: mixed(|r| r.ratio),
            modes: count(|r| r.modes),
            spacing: [mixed(|r| r.spacing[0]), mixed(|r| r.spacing[1])],
            k_max: mixed(|r| r.k_max),
            k_order: count(|r| r.k_order),
            k_across: mixed(|r| r.k_across),
            k_ratio: mixed(|r| r.k_ratio),
            k_min: mixed(|r| r.k_min),
            images: count(|r| r.images),
            face_reach: mixed(|r| r.face_reach),
            reach: mixed(|r| r.reach),
        }
    }

    /// Every panel halved (its growth ratio's root taken) and every extent doubled.
    pub fn refined(&self) -> Self {
        Self {
            order: self.order,
            corner: 0.5 * self.corner,
            corner_ratio: self.corner_ratio.sqrt(),
            ratio: self.ratio.sqrt(),
            modes: self.modes + 2,
            spacing: self.spacing.map(|apart| 0.5 * apart),
            k_max: 2.0 * self.k_max,
            k_order: self.k_order,
            k_across: 2.0 * self.k_across,
            k_ratio: self.k_ratio.sqrt(),
            k_min: 0.5 * self.k_min,
            images: 2 * self.images,
            face_reach: 2.0 * self.face_reach,
            reach: (2.0 * self.reach).min(30.0),
        }
    }

    /// Distances from a corner: 0, `first`, and so on with the growth ratio up to `length`, the
    /// last.
    pub(super) fn graded(&self, first: f64, length: f64) -> Vec<f64> {
        let mut s = vec![0.0];
        let mut next = first;
        // Avoids a last panel that is much shorter than its neighbour.
        while next * self.ratio.sqrt() < length {
            s.push(next);
            next *= if next < STEEP { self.corner_ratio } else { self.ratio };
        }
        s.push(length);
        s
    }

    /// The smallest panel at a body's end face, `ledge` beyond the contact's end: a loaded corner
    /// needs the finest panels; at a corner farther from the load the fields vary over that
    /// distance.
    fn end_panel(&self, ledge: f64) -> f64 {
        if ledge > 0.0 { ledge.max(self.corner) / 16.0 } else { self.corner }
    }

    /// The `contact` on one side of a body's middle, continued by panels to the middle and to the
    /// end face at `half`, graded towards the contact and the face.
    pub fn body_axis(&self, contact: &Panels, half: f64, edge: Option<Edge>) -> Panels {
        let mut breaks = contact.breaks().to_vec();
        let near = breaks[0];
        if ledge(near, half) > 0.0 {
            let inward = self.graded(self.corner.min(0.5 * near), near);
            breaks.splice(..0, inward[1..].iter().rev().map(|s| (near - s).max(0.0)));
        }
        let ledge = ledge(half - contact.end(), half);
        if ledge > 0.0 {
            // The effect of the end face on the surface is smooth at the contact's end: only the
            // face itself needs grading.
            let inward = self.graded(self.end_panel(ledge).min(0.5 * ledge), ledge);
            breaks.extend(inward[..inward.len() - 1].iter().rev().map(|s| half - s));
        }
        // A power of the contact's own end is already among its corners.
        let at = breaks[breaks.len() - 1];
        let edge =
            edge.filter(|edge| edge.growth == Growth::Logarithm).map(|edge| edge.corner(at, -1.0));
        let corners: Vec<Corner> = contact.corners().iter().copied().chain(edge).collect();
        Panels::new(breaks, self.order).with_corners(&corners)
    }

    /// Panels of the depth along an end face, graded towards the edge, deep enough for the
    /// smallest wavenumber.
    pub fn face_axis(&self, ledge: f64, half: f64, parity: Parity, edge: Option<Edge>) -> Panels {
        // Loads on the face of a body much shorter than the contact is wide have no longer tail.
        let deepest = (self.face_reach / self.smallest_wavenumber(half, parity)).max(FACE_TAIL);
        let mut s = self.graded(self.end_panel(ledge), FACE_TAIL);
        // Panels may grow faster where the load only decays.
        let growth = match parity {
            Parity::Even => self.ratio * self.ratio,
            Parity::Odd => self.ratio.min(BENDING_RATIO),
        };
        let mut next = FACE_TAIL * growth;
        while next * self.ratio < deepest {
            s.push(next);
            next *= growth;
        }
        if deepest > FACE_TAIL {
            s.push(deepest);
        }
        let edge = edge.map(|edge| edge.corner(0.0, 1.0));
        Panels::new(s, self.order).with_corners(edge.as_slice())
    }

    /// Wavenumbers across the contact, for bodies of half-length up to `half` under loads that are
    /// even about their middle, or not: coarse panels that grow from the smallest one to `k_max`.
    pub fn wavenumbers(&self, half: f64, parity: Parity) -> Wavenumbers {
        let smallest = self.smallest_wavenumber(half, parity);
        let mut breaks = vec![0.0, smallest];
        let mut equal = |from: f64, to: f64, ratio: f64| {
            let count = ((to / from).ln() / ratio.ln()).ceil().max(1.0) as i32;
            breaks.extend(
                (1..=count).map(|i| from * (to / from).powf(f64::from(i) / f64::from(count))),
            );
        };
        // One panel suffices for bodies that are not much longer than the contact is wide.
        if smallest < SLOW {
            // An even load's grow by more where that saves a panel; the answer to an odd one, which
            // bends the body, grows as 1 / k.
            let growth = match parity {
                Parity::Even if SLOW <= 20.0 * smallest => 20.0,
                Parity::Even => 10.0,
                Parity::Odd => BENDING_GROWTH,
            };
            equal(smallest, SLOW, growth);
        }
        equal(SLOW.max(smallest), self.k_max, self.k_ratio);
        Wavenumbers::new(Panels::new(breaks, self.k_order), self.k_across)
    }

    /// [`Resolution::wavenumbers`] of bodies of these half-lengths.
    pub fn wavenumbers_of(&self, halves: &[f64], parity: Parity) -> Wavenumbers {
        let longest = halves.iter().copied().fold(0.0, f64::max);
        let shortest = halves.iter().copied().fold(f64::INFINITY, f64::min);
        // The first panel has room for the waves that a much shorter body can be computed for.
        let half = match parity {
            Parity::Even => longest,
            Parity::Odd => longest.min(UNLIKE * shortest),
        };
        self.wavenumbers(half, parity)
    }

    /// End of the first panel of wavenumbers: waves longer than the body and the contact's width
    /// depend on little more than the total load.
    ///
    /// Under odd loads the answer grows as 1 / k, and below k `half` = 0.01 the equations are close
    /// to singular: the panel is wide enough for its nodes to stay above, and gives the tilt of
    /// narrower ones within 0.3 %.
    fn smallest_wavenumber(&self, half: f64, parity: Parity) -> f64 {
        let of_body = match parity {
            Parity::Even => self.k_min.min(1.0 / half),
            Parity::Odd => BENDS / half,
        };
        // No panel of its own is left below the slow waves' end.
        if of_body > 0.5 * SLOW { of_body.clamp(SLOW, LONGEST) } else { of_body }
    }

    /// Wavenumbers along an end face's depth, for the plate of half-thickness `half`: its remainder
    /// is negligible beyond `PLATE_FADES` / `half` and varies on the scale of the wavenumber
    /// across the contact, hence panels that grow from `k_min`.
    ///
    /// A plate in bending, under the odd part of a load, answers most to waves of the same length
    /// along and across: its remainder varies on the scale of the smallest wavenumber across the
    /// contact.
    pub fn face_wavenumbers(&self, half: f64, parity: Parity) -> Panels {
        let top = PLATE_FADES / half;
        let mut breaks = vec![0.0];
        let mut next = self.smallest_wavenumber(half, parity);
        let growth = match parity {
            Parity::Even => 2.0 * self.ratio.sqrt(),
            Parity::Odd => self.ratio.min(BENDING_RATIO),
        };
        if parity == Parity::Odd {
            breaks.extend(BENDING.map(|part| part * next));
        }
        while next < 0.6 * top {
            breaks.push(next);
            next = (next * growth).min(next + WIDEST);
        }
        while breaks[breaks.len() - 1] + 1.4 * WIDEST < top {
            breaks.push(breaks[breaks.len() - 1] + WIDEST);
        }
        breaks.push(top);
        Panels::new(breaks, self.order)
    }
}

/// How the loads on both faces of a body grow towards their common edge, and how far from it.
#[derive(Debug, Clone, Copy)]
pub struct Edge {
    /// How they grow.
    pub growth: Growth,
    reach: f64,
}

impl Edge {
    /// That of a body of half-length `half` under one `part` of the loads on `contact`, an axis on
    /// one side of its middle; none where polynomials do.
    ///
    /// Near the edge of a quarter-space in plane strain loads s^a on one side are answered by
    /// -K(a) s^a on the other, K(a) = (1 + a) / cos(pi a / 2), and are free loads where K^2 = 1.
    /// That is so for a = 0, and what else acts there does not vanish at the edge: both sides have
    /// loads a ln s, of opposite sign, which act against each other and leave no stress.
    /// Polynomials up to the edge miss a part of each, which bends bodies shorter than the contact
    /// is wide by as much as their loads do. Where all loads are even and reach the edge, both
    /// sides have the same panels and miss the same.
    pub fn new(contact: &Panels, half: f64, part: Part) -> Option<Self> {
        let ledge = ledge(half - contact.end(), half);
        let logarithm = |reach| Some(Self { growth: Growth::Logarithm, reach });
        if ledge > 0.0 {
            return logarithm(ledge);
        }
        let end = contact.corner_of(contact.panel_count() - 1).filter(|corner| corner.side < 0.0);
        match end {
            Some(Corner { growth, .. }) => Some(Self { growth, reach: LAW }),
            None if part.bends => logarithm(LAW.min(half)),
            None => None,
        }
    }

    /// The corner at the place `at` of an axis whose loads are on this `side` of it.
    fn corner(&self, at: f64, side: f64) -> Corner {
        Corner { at, side, growth: self.growth, reach: self.reach }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wavenumbers_ascend_for_bodies_of_any_length() {
        for tolerance in TOLERANCES {
            let resolution = Resolution::for_tolerance(tolerance);
            for half in [1e-3, 0.1, 0.5, 1.0, 2.0, 50.0, 1e4] {
                for parity in [Parity::Even, Parity::Odd] {
                    let numbers = resolution.wavenumbers(half, parity);
                    let breaks = numbers.coarse().breaks();
                    assert!(breaks.windows(2).all(|pair| pair[0] < pair[1]), "{half}: {breaks:?}");
                    assert!((breaks[breaks.len() - 1] / resolution.k_max - 1.0).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn depths_ascend_on_end_faces_of_bodies_of_any_length() {
        for tolerance in TOLERANCES {
            let all = [Resolution::for_tolerance(tolerance), Resolution::for_tips(tolerance)];
            for (resolution, half) in
                all.iter().flat_map(|r| [1e-3, 0.1, 0.5, 1.0, 2.0, 50.0, 1e4].map(|half| (r, half)))
            {
                for parity in [Parity::Even, Parity::Odd] {
                    for ledge in [0.0, 0.3 * half, 1.0] {
                        let depths = resolution.face_axis(ledge, half, parity, None);
                        assert!(depths.end() >= FACE_TAIL, "{half} {parity:?}: {depths:?}");
                    }
                }
            }
        }
    }
}
