//! Stresses of one body from the pressures on it.
//!
//! Conventions: lengths in units of C, stresses in units of p0. A stress is (1/pi) int_0^inf A(k)
//! cos(k x) dk, or sin(k x) for the shears xy and xz, with the amplitude A the sum over the loads
//! of the kernels of [`crate::kernels::wave`]; under a traction along x it is the other way round.
//! The stress under an endless contact with the local pressure is subtracted from A and added in
//! closed form ([`crate::kernels::strip`]). The remainder decays with k, so the steep edge of the
//! pressure across the contact needs no additional wavenumbers.

use super::flat::FlatStress;
use super::load::{Load, Traction};
use super::round::{ContactEnds, LocalContact, RoundStress, STEP, add_skins, rounded};
use super::skin::SkinField;
use super::slow_change::SlowChange;
use super::target::{KeptPlates, Loaded, ON_FACE, Target, add_wave};
use super::waves::{LongQuadrature, Waves};
use super::work::{Counters, Work};
use crate::base::{Panels, Parity, Samples, StressTensor, Wavenumbers};
use crate::body::{Skins, Stack};
use nalgebra::{Complex, DMatrix};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::{Arc, Mutex};

/// Depth (C) from which [`Field::down`] interpolates: nearer to the surface a coarse solution has
/// errors next to the corner that a polynomial would spread.
const SMOOTH_DEPTH: f64 = 0.14;

/// Distance (C) from the contact's end from which [`Field::along`] interpolates on the surface,
/// where the pressure's panels grow with the distance from the end.
const SMOOTH_DISTANCE: f64 = 1.0;

/// The bound r^-n of the interpolation along a line, in tolerances: where the pressure has a limit
/// at its ends, and where it grows without one. The unknown factor of the bound is larger there:
/// with 0.1 errors are up to two tolerances, with 0.03 half of one more of 1e-4 than with 0.01.
const INTERPOLATION: f64 = 0.1;
const STEEP_INTERPOLATION: f64 = 0.01;

/// What may be neglected of a stress's sum over the wavenumbers, in tolerances. Amplitudes that
/// fall like a power of k leave about k times the last one.
const NEGLIGIBLE: f64 = 0.08;

/// Nodes for the long waves of a load's change along the line.
const LONG_NODES: usize = 8;

/// Points closer to the loaded surface than this (C) count as on it.
const ON_SURFACE: f64 = 1e-9;

/// The stress field of one body.
#[derive(Debug)]
pub struct Field<'a> {
    pub(super) stack: &'a Stack,
    pub(super) pressure: &'a dyn Load,
    /// The pressure as a traction along x, if the contact carries one.
    pub(super) traction: Option<&'a dyn Traction>,
    /// The loads that a round surface adds, if the body has one.
    skin: Option<SkinField<'a>>,
    wavenumbers: &'a Wavenumbers,
    /// The loads for the plane x = 0, where every wave is at its crest: the coarse wavenumbers,
    /// with the quadrature over the fine ones in their loads.
    central: Arc<Waves>,
    /// The loads for other points, at the fine wavenumbers, computed on demand: each with the
    /// binary exponent of the largest distance from that plane for which it is valid.
    all: Mutex<Vec<(i32, Arc<Waves>)>>,
    /// Transition factor of the stress correction, if any.
    pub(super) gamma: Option<f64>,
    /// Requested accuracy (p0).
    tolerance: f64,
    /// Negligible contribution of one wavenumber to a stress (p0).
    negligible: f64,
    counters: Counters,
    /// The contact that what a round surface adds follows, if any.
    contact: Option<ContactEnds>,
    /// The plate's kernels of the waves of `central`.
    plates: KeptPlates,
    /// The long waves, for what is taken from a slow change.
    long: Panels,
}

/// Whether a flat stress under a pressure that is even in x has a slope along x.
fn off_middle(x: f64) -> bool {
    x != 0.0
}

/// Depth, in half-lengths of the body, from which on the waves that are resolved across the contact
/// are too few.
const FAR_BELOW: f64 = 5.0;

/// Number of consecutive negligible fine wavenumbers after which the sum ends: more than a period
/// of the oscillation of the amplitudes with the contact's width. The sum over coarse wavenumbers
/// ends after a panel.
const FADED: usize = 8;

impl<'a> Field<'a> {
    /// The field of the body whose `stack` of layers belongs to `wavenumbers`, under `pressure`
    /// with its [`Load::moments`]. Wavenumbers that change no stress by more than about a tenth of
    /// `tolerance` (p0) are neglected.
    pub fn new(
        stack: &'a Stack,
        wavenumbers: &'a Wavenumbers,
        pressure: &'a dyn Load,
        moments: &DMatrix<f64>,
        gamma: Option<f64>,
        tolerance: f64,
    ) -> Self {
        let (k, shares) = (stack.nodes().to_vec(), |i: usize| (i, [1.0]));
        let central = Arc::new(Waves::new(stack, k, None, stack.for_layers(moments), shares));
        let negligible = NEGLIGIBLE * tolerance;
        let all = Mutex::default();
        let counters = Counters::default();
        let plates = KeptPlates::default();
        Self {
            stack,
            pressure,
            traction: None,
            skin: None,
            wavenumbers,
            central,
            all,
            gamma,
            tolerance,
            negligible,
            counters,
            contact: None,
            plates,
            long: Panels::new(wavenumbers.coarse().breaks()[..2].to_vec(), LONG_NODES),
        }
    }

    /// The same field with the stresses under a `traction` along x, which is the pressure of the
    /// field. The stack has to be one that slides.
    #[must_use]
    pub fn with_traction(self, traction: &'a dyn Traction) -> Self {
        Self { traction: Some(traction), ..self }
    }

    /// The same field of a body with a round surface, whose `skins` belong to the pressure's line
    /// and are `felt` in this part.
    #[must_use]
    pub fn with_skins(self, skins: Option<&'a Skins>, felt: f64) -> Self {
        let reach = [self.beside(), FAR_BELOW * self.stack.body().half];
        let skin = skins.map(|skins| SkinField::new(skins, felt, self.pressure, reach));
        Self { skin, ..self }
    }

    /// What the skin of a round surface adds at (x, `y`, `z`) for each x of `xs`, per C / R;
    /// nothing where the body has none.
    pub fn skin_at(&self, y: f64, z: f64, xs: &[f64]) -> Vec<StressTensor> {
        self.skin.as_ref().map_or(Vec::new(), |skin| skin.at(y, z, xs))
    }

    /// The same field, where what a round surface adds follows the local contact between these
    /// ends, not that of the mean load all along the line.
    #[must_use]
    pub fn following_contact(self, contact: Option<ContactEnds>) -> Self {
        Self { contact, ..self }
    }

    /// The plane contact that a round surface at `y` has.
    fn local_contact(&self, y: f64) -> LocalContact {
        let (half, middle) = (self.stack.body().half, self.stack.middle);
        let body = [middle - half, middle + half];
        let Some(contact) = self.contact else {
            let all = ContactEnds { at: self.pressure.ends(), open: [false; 2] };
            return LocalContact::HERTZ.on_line(y, all, body);
        };
        let local = self.pressure.local_contact(LocalContact::place(y, contact.at));
        local.on_line(y, contact, body)
    }

    /// Whether the contact is symmetric about y = 0.
    pub fn is_symmetric(&self) -> bool {
        self.pressure.is_symmetric()
    }

    /// The kernel evaluations so far.
    pub fn work(&self) -> Work {
        self.counters.work()
    }

    /// What a target needs to know.
    fn loaded<'b>(&'b self, slow_change: &'b SlowChange) -> Loaded<'b> {
        Loaded {
            stack: self.stack,
            pressure: self.pressure,
            slides: self.traction.is_some(),
            gamma: self.gamma,
            slow_change,
            plates: &self.plates,
        }
    }

    /// The loads of every fine wavenumber, for points up to `farthest` from the plane x = 0.
    fn all(&self, farthest: f64) -> Arc<Waves> {
        // The points beside a place, for its slope, must not take it to another level.
        let level = (farthest - 2.0 * STEP).max(1.0).log2().ceil() as i32;
        let mut known = self.all.lock().unwrap_or_else(|e| e.into_inner());
        if let Some((_, waves)) = known.iter().find(|(l, _)| *l == level) {
            return waves.clone();
        }
        let waves = Arc::new(self.resolved(&self.wavenumbers.resolving(2f64.powi(level))));
        known.push((level, waves.clone()));
        waves
    }

    /// The loads of all fine ones of the wavenumbers `numbers`, but for those of the first panel:
    /// those of the layers stand for them.
    fn resolved(&self, numbers: &Wavenumbers) -> Waves {
        let (stack, fine) = (self.stack, numbers.fine());
        let order = numbers.coarse().order();
        let long = fine.partition_point(|k| *k < numbers.coarse().breaks()[1]);
        let shares = |i: usize| stack.interpolation(numbers.interpolation(i));
        let k = [&stack.nodes()[..order], &fine[long..]].concat();
        let weights = [&[0.0].repeat(order), &numbers.weights()[long..]].concat();
        let transforms = self.pressure.transforms(&k).transpose();
        let own = |i: usize| (0..order).map(|j| f64::from(u8::from(i == j))).collect();
        let share = |i: usize| match i < order {
            true => (0, own(i)),
            false => shares(i - order + long),
        };
        let mut waves = Waves::new(stack, k, Some(&weights), transforms, share);
        waves.long = LongQuadrature {
            nodes: (0..long).map(|i| (fine[i], numbers.weights()[i] / PI)).collect(),
            shares: (0..long).map(|i| shares(i).1).collect(),
        };
        waves
    }

    /// Stresses at the points (x, `y`, `z`) for each x of `xs`, in their order.
    ///
    /// On a loaded surface or a free end face the known tractions are used.
    pub fn at(&self, y: f64, z: f64, xs: &[f64]) -> Vec<FlatStress> {
        self.near_or_far(y, z, xs, xs)
    }

    /// [`Field::at`], where the points with those of `places` for x decide which of them are far.
    fn near_or_far(&self, y: f64, z: f64, xs: &[f64], places: &[f64]) -> Vec<FlatStress> {
        let z = if z < ON_SURFACE { 0.0 } else { z };
        let far: Vec<bool> = places.iter().map(|x| self.is_far(*x, z)).collect();
        let near = xs.iter().zip(&far).filter(|(_, far)| !**far).map(|(x, _)| *x);
        let near: Vec<f64> = near.collect();
        let distant = xs.iter().zip(&far).filter(|(_, far)| **far).map(|(x, _)| *x);
        let mut by_resultants = self.by_resultants(y, z, &distant.collect::<Vec<_>>()).into_iter();
        let mut by_waves = self.by_waves(y, z, &near).into_iter();
        let mut at = |far: bool| if far { by_resultants.next() } else { by_waves.next() };
        far.into_iter().map(|far| at(far).expect("one of each point")).collect()
    }

    /// [`Field::at`] by the load's resultants, as far points have it.
    pub(crate) fn by_resultants(&self, y: f64, z: f64, xs: &[f64]) -> Vec<FlatStress> {
        if xs.is_empty() {
            return Vec::new();
        }
        let pieces = self.pieces();
        xs.iter().map(|x| self.far(&pieces, [*x, y, z])).collect()
    }

    /// [`Field::at`] by sums of waves, wherever the points are.
    pub(crate) fn by_waves(&self, y: f64, z: f64, xs: &[f64]) -> Vec<FlatStress> {
        let z = if z < ON_SURFACE { 0.0 } else { z };
        let change = self.slow_change(y);
        let remainders = self.remainders(&change, y, z, xs).into_iter();
        xs.iter()
            .zip(remainders)
            .map(|(x, rest)| self.complete(&change, [*x, y, z], rest))
            .collect()
    }

    /// [`Field::at`], with the contribution of a round surface per C / R.
    pub fn round_at(&self, y: f64, z: f64, xs: &[f64]) -> Vec<RoundStress> {
        let contact = self.local_contact(y);
        let flat = |all: &[f64], places: &[f64]| vec![self.near_or_far(y, z, all, places)];
        let mut all = rounded(xs, &[z], &contact, off_middle, flat).swap_remove(0);
        add_skins(&mut all, &self.skin_at(y, z, xs));
        all
    }

    /// [`Field::down`], with the contribution of a round surface per C / R.
    pub fn round_down(&self, xs: &[f64], y: f64, zs: &[f64]) -> Vec<Vec<RoundStress>> {
        let mut rows = rounded(xs, zs, &self.local_contact(y), off_middle, |all, places| {
            let far = |z: &f64| places.iter().any(|x| self.is_far(*x, *z));
            match zs.iter().any(far) {
                true => zs.iter().map(|&z| self.near_or_far(y, z, all, places)).collect(),
                false => self.down(all, y, zs),
            }
        });
        if let Some(skin) = &self.skin {
            let skins = skin.down(xs, y, zs);
            rows.iter_mut().zip(skins).for_each(|(row, skins)| add_skins(row, &skins));
        }
        rows
    }

    /// Stresses at the points (x, `y`, z): for each z >= 0 of `zs` those for each x of `xs`, in
    /// their order. They equal [`Field::at`], with the smooth part interpolated if the points are
    /// closer together than its length of variation.
    ///
    /// A load at the distance u along the surface gives the field poles at z = +-i u, which matter
    /// only where the load is not smooth. In the variable asinh(z / u), with the u of the nearest
    /// such place, all of them have imaginary parts of +-pi/2. Directly below such a place the
    /// variable is ln z, which is used from some depth.
    pub fn down(&self, xs: &[f64], y: f64, zs: &[f64]) -> Vec<Vec<FlatStress>> {
        if zs.iter().any(|z| xs.iter().any(|x| self.is_far(*x, *z))) {
            return zs.iter().map(|&z| self.at(y, z, xs)).collect();
        }
        let near = self.smooth_within(xs, y);
        let least = if near >= SMOOTH_DEPTH { 0.0 } else { SMOOTH_DEPTH };
        let scale = near.max(ON_SURFACE);
        let place = |z: f64| (z / scale).asinh();
        let poles = |[from, to]: [f64; 2]| vec![(0.5 * (from + to), FRAC_PI_2)];
        let below = zs.iter().filter(|z| **z >= least).map(|z| place(*z));
        let Some(axis) = self.sampling(below, poles) else {
            return zs.iter().map(|&z| self.at(y, z, xs)).collect();
        };
        let change = self.slow_change(y);
        let at_node = |t: &f64| self.remainders(&change, y, scale * t.sinh(), xs);
        let nodes: Vec<Vec<FlatStress>> = axis.places().iter().map(at_node).collect();
        let smooth = |z: f64| {
            let shares = axis.shares(place(z));
            let at = |(i, &x): (usize, &f64)| {
                let own = nodes.iter().zip(&shares).map(|(node, share)| (&node[i], *share));
                self.complete(&change, [x, y, z], self.weighted(own))
            };
            xs.iter().enumerate().map(at).collect()
        };
        zs.iter().map(|&z| if z >= least { smooth(z) } else { self.at(y, z, xs) }).collect()
    }

    /// Least distance along the surface from (x, `y`), with the x of `xs`, to a place where the
    /// load is not smooth: the edges and ends of the contact, and the ends of the body. Zero if a
    /// [`transition`] corrects the stresses, because it is singular on the surface itself.
    fn smooth_within(&self, xs: &[f64], y: f64) -> f64 {
        if self.gamma.is_some() {
            return 0.0;
        }
        let [from, to] = self.pressure.ends();
        let face = self.stack.body().half - (y - self.stack.middle).abs();
        let half_width = self.pressure.local_contact(y).half_width;
        let edges = xs.iter().filter(|_| half_width > 0.0).map(|x| half_width - x.abs());
        let places = [y - from, to - y, face].into_iter().chain(edges);
        places.fold(f64::INFINITY, |near, to| near.min(to.abs()))
    }

    /// [`Field::along`] in the plane x = 0, with the contribution of a round surface per C / R.
    pub fn round_along(&self, z: f64, ys: &[f64]) -> Vec<RoundStress> {
        let flat = self.along(0.0, z, ys);
        let round = |(s, y): (FlatStress, &f64)| {
            RoundStress::new(0.0, z, s, FlatStress::default(), &self.local_contact(*y))
        };
        let mut all: Vec<RoundStress> = flat.into_iter().zip(ys).map(round).collect();
        if let Some(skin) = &self.skin {
            add_skins(&mut all, &skin.along(z, ys));
        }
        all
    }

    /// Stresses at the points (`x`, y, `z`) for each y of `ys`, in their order. They equal
    /// [`Field::at`], interpolated if the points are closer together than the field's length of
    /// variation. Each side of the contact is sampled by itself. Between shaped bodies the field
    /// varies along the contact as their profiles do, and nothing is interpolated.
    pub fn along(&self, x: f64, z: f64, ys: &[f64]) -> Vec<FlatStress> {
        if self.contact.is_some() || self.is_far(x, z) {
            return ys.iter().map(|&y| self.at(y, z, &[x])[0]).collect();
        }
        let mut stresses = vec![FlatStress::default(); ys.len()];
        let [from, to] = self.pressure.ends();
        let middle = 0.5 * (from + to);
        for side in [1.0, -1.0] {
            let own = |y: f64| if side > 0.0 { y >= middle } else { y < middle };
            let (places, own): (Vec<usize>, Vec<f64>) =
                ys.iter().enumerate().filter(|(_, y)| own(**y)).unzip();
            let line = Side { x, z, middle, side, end: 0.5 * (to - from) };
            let found = match z > ON_SURFACE {
                true => self.along_below(&line, &own),
                false => self.along_surface(&line, &own),
            };
            places.into_iter().zip(found).for_each(|(i, s)| stresses[i] = s);
        }
        stresses
    }

    /// [`Field::along`] on the surface, on one side.
    fn along_surface(&self, line: &Side, ys: &[f64]) -> Vec<FlatStress> {
        // The smooth part varies over the distances from the two ends of the contact, and is
        // analytic in ln((end - u) / (end + u)) within imaginary parts of pi; if it is even, it is
        // so in ln((end - u) (end + u)), too, which needs the one half alone.
        let (x, end, even) = (line.x, line.end, self.pressure.is_symmetric());
        let place = |y: f64| {
            let u = line.off_middle(y);
            if even { ((end - u) * (end + u)).ln() } else { ((end - u) / (end + u)).ln() }
        };
        let off_middle = |t: f64| match even {
            true => (end * end - t.exp()).max(0.0).sqrt(),
            false => -end * (0.5 * t).tanh(),
        };
        let far = |y: f64| line.off_middle(y) <= end - SMOOTH_DISTANCE;
        let inner = ys.iter().filter(|y| far(**y)).map(|y| place(*y));
        let poles = |[from, to]: [f64; 2]| vec![(0.5 * (from + to), PI)];
        let nodes = self.sampling(inner, poles).map(|axis| {
            let at_node = |t: &f64| {
                let y = line.y(off_middle(*t));
                self.remainders(&self.slow_change(y), y, 0.0, &[x])[0]
            };
            let values: Vec<FlatStress> = axis.places().iter().map(at_node).collect();
            (axis, values)
        });
        ys.iter()
            .map(|&y| match &nodes {
                Some((axis, values)) if far(y) => {
                    let rest = self.interpolated(axis, values, place(y));
                    self.complete(&self.slow_change(y), [x, y, 0.0], rest)
                }
                _ => self.at(y, 0.0, &[x])[0],
            })
            .collect()
    }

    /// [`Field::along`] below the surface, on one side. At a depth z below a corner, of the contact
    /// at u = `end` from its middle or of the body, the field has poles at the distances +-i z from
    /// the corner. With u = end + z sinh t the points are dense where the field varies, and the
    /// poles of the contact's end are at t = +-i pi/2.
    fn along_below(&self, line: &Side, ys: &[f64]) -> Vec<FlatStress> {
        let (x, z, end) = (line.x, line.z, line.end);
        let face = self.stack.body().half + line.side * (self.stack.middle - line.middle);
        let corner = Complex::new((face - end) / z, 1.0).asinh();
        let place = |y: f64| ((line.off_middle(y) - end) / z).asinh();
        let poles = |_| vec![(0.0, FRAC_PI_2), (corner.re, corner.im)];
        let Some(axis) = self.sampling(ys.iter().map(|y| place(*y)), poles) else {
            return ys.iter().map(|&y| self.at(y, z, &[x])[0]).collect();
        };
        let at_node = |t: &f64| self.at(line.y(end + z * t.sinh()), z, &[x])[0];
        let nodes: Vec<FlatStress> = axis.places().iter().map(at_node).collect();
        ys.iter().map(|y| self.interpolated(&axis, &nodes, place(*y))).collect()
    }

    /// The stress at `place` of the polynomial through `values` at the places of `axis`.
    fn interpolated(&self, axis: &Samples, values: &[FlatStress], place: f64) -> FlatStress {
        self.weighted(values.iter().zip(axis.shares(place)))
    }

    /// The sum of stresses with their weights.
    fn weighted<'v>(&self, values: impl Iterator<Item = (&'v FlatStress, f64)>) -> FlatStress {
        let mut sum = FlatStress::default();
        for (s, weight) in values {
            sum.pressure += s.pressure * weight;
            if self.traction.is_some() {
                sum.traction += s.traction * weight;
            }
        }
        sum
    }

    /// The samples for the interpolation to `places` as [`INTERPOLATION`] asks for, of functions
    /// that have `poles` (position, and distance from the axis) between the outermost two places.
    /// None if there would be no fewer samples than places.
    ///
    /// Interpolation through n of them errs by about r^-n, with r the parameter of Bernstein's
    /// ellipse through the pole, see [`crate::body::stencil`].
    fn sampling(
        &self,
        places: impl Iterator<Item = f64> + Clone,
        poles: impl Fn([f64; 2]) -> Vec<(f64, f64)>,
    ) -> Option<Samples> {
        let from = places.clone().fold(f64::INFINITY, f64::min);
        let to = places.clone().fold(f64::NEG_INFINITY, f64::max);
        let count = places.count();
        if count < 3 || to <= from {
            return None;
        }
        let slowest = poles([from, to])
            .into_iter()
            .map(|(at, off)| ((at - from).hypot(off) + (at - to).hypot(off)) / (to - from))
            .fold(f64::INFINITY, f64::min);
        let rate = (slowest + (slowest * slowest - 1.0).max(0.0).sqrt()).ln();
        let steep = self.pressure.axis().corners().iter().any(|c| c.exponent().is_some());
        let bound = if steep { STEEP_INTERPOLATION } else { INTERPOLATION } * self.tolerance;
        let wanted = -bound.ln() / rate;
        (wanted < count as f64 - 1.0)
            .then(|| Samples::new(from, to, wanted.ceil().max(2.0) as usize))
    }

    /// Whether `y` (C) lies on an end face.
    fn on_face(&self, y: f64) -> bool {
        let half = self.stack.body().half;
        half - (y - self.stack.middle).abs() < ON_FACE * half
    }

    /// The stress of the endless contact with the local pressure, and of its `slow_change`, plus
    /// `remainder`.
    fn complete(
        &self,
        slow_change: &SlowChange,
        [x, y, z]: [f64; 3],
        remainder: FlatStress,
    ) -> FlatStress {
        let FlatStress { pressure, traction } = remainder;
        let pressure = self.complete_pressure(slow_change, [x, y, z], pressure);
        let along = |own| self.complete_traction(own, x, y, z, traction);
        FlatStress { pressure, traction: self.traction.map_or(traction, along) }
    }

    /// [`Field::complete`] under a traction.
    fn complete_traction(
        &self,
        own: &dyn Traction,
        x: f64,
        y: f64,
        z: f64,
        remainder: StressTensor,
    ) -> StressTensor {
        let mut s = self.with_plane(remainder, own.endless_along(y, x, z));
        if z == 0.0 {
            s.xz = -self.pressure.at(x, y);
            (s.zz, s.yz) = (0.0, 0.0);
        }
        self.free_face(y, s)
    }

    /// [`Field::complete`] under the pressure.
    fn complete_pressure(
        &self,
        slow_change: &SlowChange,
        [x, y, z]: [f64; 3],
        remainder: StressTensor,
    ) -> StressTensor {
        let mut s = self.with_plane(remainder, self.pressure.endless(y, x, z));
        let [xy, yz] = slow_change.stress(self.stack.body().nu, x, z, &self.long);
        s.xy += xy;
        s.yz += yz;
        if z == 0.0 {
            s.zz = -self.pressure.at(x, y);
            (s.xz, s.yz) = (0.0, 0.0);
        }
        self.free_face(y, s)
    }

    /// [`Load::slow_change`] at `y`.
    fn slow_change(&self, y: f64) -> SlowChange {
        self.pressure.slow_change(y, self.wavenumbers.coarse().end())
    }

    /// The stress `s` and the plane strain of an endless contact with these xx, zz and xz.
    fn with_plane(&self, mut s: StressTensor, [xx, zz, xz]: [f64; 3]) -> StressTensor {
        s.xx += xx;
        s.zz += zz;
        s.xz += xz;
        s.yy += self.stack.body().nu * (xx + zz);
        s
    }

    /// The stress `s` without the tractions of a free end face, if `y` lies on one.
    fn free_face(&self, y: f64, mut s: StressTensor) -> StressTensor {
        if self.on_face(y) && self.stack.body().end.freed {
            (s.yy, s.xy, s.yz) = (0.0, 0.0, 0.0);
        }
        s
    }

    /// Stresses at (x, `y`, `z`) for each x of `xs`, less those of an endless contact of the
    /// pressure at `y`, and of its `slow_change` there.
    fn remainders(&self, slow_change: &SlowChange, y: f64, z: f64, xs: &[f64]) -> Vec<FlatStress> {
        if xs.is_empty() {
            return Vec::new();
        }
        let mut farthest = xs.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        // Far below, waves vary with their length as they do far beside.
        if !self.stack.body().end.freed && z > FAR_BELOW * self.stack.body().half {
            farthest = farthest.max(z);
        }
        let odd = self.pressure.parity_across() == Parity::Odd;
        // Those of the plane x = 0 leave out what an even pressure has none of there: the shears.
        let central = farthest == 0.0 && !odd;
        let waves = if central { self.central.clone() } else { self.all(farthest) };
        let faded = if central {
            self.wavenumbers.coarse().order()
        } else {
            FADED * waves.k.len() / self.wavenumbers.fine().len()
        };
        let mut target = Target::new(&self.loaded(slow_change), &waves, y, z);
        let mut sums = vec![[[0.0; 6]; 2]; xs.len()];
        let mut fading = 0;
        let long: Vec<Vec<[f64; 2]>> = xs.iter().map(|x| waves.long.factors(*x)).collect();
        for (i, (&k, &weight)) in waves.k.iter().zip(&waves.weights).enumerate() {
            if fading >= faded {
                target.work.faded = ((waves.k.len() - i) * target.loads()) as u64;
                break;
            }
            let (pressure, traction) = target.amplitudes(i);
            let all = pressure.iter().chain(traction.iter().flatten());
            let largest = all.fold(0.0, |m: f64, a| m.max(a.abs()));
            // A small amplitude stays small only if oscillations across the contact are resolved.
            let small = k > 1.0 && k * largest < self.negligible;
            fading = if small { fading + 1 } else { 0 };
            for ((sum, x), long) in sums.iter_mut().zip(xs).zip(&long) {
                let [cos, sin] = match long.get(i) {
                    Some(factors) => *factors,
                    None if *x == 0.0 => [weight, 0.0],
                    None => {
                        let (sin, cos) = (k * x).sin_cos();
                        [weight * cos, weight * sin]
                    }
                };
                // An odd pressure is an even one a quarter of the wave farther on.
                let [others, shears] = if odd { [sin, -cos] } else { [cos, sin] };
                add_wave(&mut sum[0], &pressure, others, shears);
                if let Some(traction) = &traction {
                    add_wave(&mut sum[1], traction, sin, cos);
                }
            }
        }
        self.counters.add(&target.work);
        let flat = |sums: [[f64; 6]; 2]| {
            let [pressure, traction] = sums.map(|sums| {
                let mut s = StressTensor::from_components(sums);
                if z == 0.0 {
                    // The tractions there are those of the endless contact.
                    (s.zz, s.xz, s.yz) = (0.0, 0.0, 0.0);
                }
                s
            });
            FlatStress { pressure, traction }
        };
        sums.into_iter().map(flat).collect()
    }
}

/// One side of a line of points along y, from the contact's middle.
struct Side {
    x: f64,
    z: f64,
    /// y of the contact's middle.
    middle: f64,
    /// 1 or -1: the sign of y - middle.
    side: f64,
    /// The contact's half-length.
    end: f64,
}

impl Side {
    /// Distance of `y` from the middle.
    fn off_middle(&self, y: f64) -> f64 {
        self.side * (y - self.middle)
    }

    /// The place at the distance `u` from the middle.
    fn y(&self, u: f64) -> f64 {
        self.middle + self.side * u
    }
}
