//! Stresses of one body from the pressures that act on it.
//!
//! Conventions: lengths in units of C, stresses in units of p0. A stress is
//! (1/pi) int_0^inf A(k) cos(k x) dk, or sin(k x) for the shears xy and xz, with the amplitude A
//! the sum over the loads of the kernels of [`crate::kernels::wave`]. What an endless contact of
//! the local pressure would do is subtracted from A and added in closed form
//! ([`crate::kernels::strip`]): what is left fades with k, so the pressure's steep edge across the
//! contact costs no wavenumbers.

use crate::base::{Panels, StressTensor, Wavenumbers};
use crate::body::stencil::{LineLoads, Stencil};
use crate::body::{Body, EdgeModel, Layer};
use crate::kernels::strip;
use crate::kernels::wave::{surface_spread, surface_spread_shear};
use nalgebra::{Complex, DVector};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex};

/// The contact pressure as a function of place.
#[derive(Debug, Clone)]
pub struct Pressure {
    axis: Panels,
    half_widths: Vec<f64>,
    coefficients: Vec<Vec<f64>>,
}

impl Pressure {
    /// The pressure whose half-width and coefficients of the modes are given at the nodes of `axis`;
    /// modes that a node lacks are zero there.
    pub fn new(axis: Panels, half_widths: Vec<f64>, mut coefficients: Vec<Vec<f64>>) -> Self {
        let most = coefficients.iter().map(Vec::len).max().unwrap_or(0);
        coefficients.iter_mut().for_each(|c| c.resize(most, 0.0));
        Self { axis, half_widths, coefficients }
    }

    /// Axis along the contact.
    pub fn axis(&self) -> &Panels {
        &self.axis
    }

    /// Half-width and modes at node `j`.
    pub fn at_node(&self, j: usize) -> (f64, &[f64]) {
        (self.half_widths[j], &self.coefficients[j])
    }

    /// Half-width and modes at `y`; none outside the contact.
    pub fn modes(&self, y: f64) -> Option<(f64, Vec<f64>)> {
        let (first, weights) = self.neighbours(y.abs())?;
        let mut coefficients = vec![0.0; self.coefficients[0].len()];
        let mut half_width = 0.0;
        for (j, w) in (first..).zip(&weights) {
            half_width += w * self.half_widths[j];
            for (sum, c) in coefficients.iter_mut().zip(&self.coefficients[j]) {
                *sum += w * c;
            }
        }
        Some((half_width, coefficients))
    }

    /// Pressure at (`x`, `y`) (p0).
    pub fn at(&self, x: f64, y: f64) -> f64 {
        self.modes(y).map_or(0.0, |(a, c)| strip::pressure(a, &c, x).max(0.0))
    }

    /// Fourier transform over x at every node, into `out`.
    fn transform(&self, k: f64, out: &mut [f64]) {
        let mut modes = vec![0.0; self.coefficients[0].len()];
        for ((into, a), c) in out.iter_mut().zip(&self.half_widths).zip(&self.coefficients) {
            strip::transforms(*a, k, &mut modes);
            *into = modes.iter().zip(c).map(|(t, c)| t * c).sum();
        }
    }

    /// The nodes whose values interpolate to `y`, with their weights; none outside the contact.
    fn neighbours(&self, y: f64) -> Option<(usize, Vec<f64>)> {
        let inside = y <= self.axis.breaks()[self.axis.panel_count()] * (1.0 + 1e-12);
        inside.then(|| self.axis.interpolation(y))
    }
}

/// The loads of one wavenumber on the superposed bodies.
#[derive(Debug, Clone)]
struct Loads {
    k: f64,
    /// Whether they serve the plane x = 0 only, where shears that are odd in x vanish.
    central: bool,
    /// Factor of what they cause: the quadrature weight of the wavenumber, if the loads lack it,
    /// over pi.
    weight: f64,
    /// Contact pressure at the contact's nodes.
    contact: Vec<f64>,
    /// P at the surface's nodes, and its charges.
    surface: Vec<f64>,
    surface_charges: Vec<f64>,
    /// Mean of P over the body's length.
    mean: f64,
    /// q at the face's first nodes, and its charges.
    face: Vec<f64>,
    face_charges: Vec<f64>,
    /// Transform of q for the plate.
    plate: Vec<f64>,
}

impl Loads {
    /// The loads that go with the transform `contact` of the contact pressure, by the layers and
    /// their shares. Without a `weight` of the wavenumber its quadrature is in `contact`, and the loads
    /// serve the plane x = 0.
    fn new(
        body: &Body,
        k: f64,
        weight: Option<f64>,
        contact: Vec<f64>,
        layers: &[Layer],
        shares: &[f64],
    ) -> Self {
        let p = DVector::from_column_slice(&contact);
        let (mut surface, mut face) = (Vec::new(), Vec::new());
        let add = |sum: &mut Vec<f64>, part: &DVector<f64>, share: f64| {
            sum.resize(sum.len().max(part.len()), 0.0);
            sum.iter_mut().zip(part.iter()).for_each(|(s, p)| *s += share * p);
        };
        for (layer, &share) in layers.iter().zip(shares).filter(|(_, share)| **share != 0.0) {
            match &layer.surface {
                Some(matrix) => add(&mut surface, &(matrix * &p), share),
                None => add(&mut surface, &p, share),
            }
            if let Some(matrix) = &layer.face {
                add(&mut face, &(matrix * &p), share);
            }
        }
        let total: f64 = surface.iter().zip(body.surface.axis.weights()).map(|(p, w)| p * w).sum();
        Self {
            k,
            central: weight.is_none(),
            weight: weight.unwrap_or(1.0) / PI,
            mean: total / body.half,
            plate: body.plate_transform(k, &face),
            surface_charges: body.surface.charges(&surface),
            face_charges: body.face.charges(&face),
            contact,
            surface,
            face,
        }
    }
}

/// Kernel evaluations for stresses: those done, and those that a sum of all sources over all
/// wavenumbers would have taken besides.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Work {
    /// Evaluations done.
    pub done: u64,
    /// Spared: sources farther away than a wave reaches.
    pub beyond_reach: u64,
    /// Spared: end faces that a wavenumber does not reach from the contact.
    pub ends: u64,
    /// Spared: wavenumbers behind those that add nothing any more.
    pub faded: u64,
}

impl std::iter::Sum for Work {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |sum, w| Self {
            done: sum.done + w.done,
            beyond_reach: sum.beyond_reach + w.beyond_reach,
            ends: sum.ends + w.ends,
            faded: sum.faded + w.faded,
        })
    }
}

/// [`Work`] that several threads add to.
#[derive(Debug, Default)]
struct Counters {
    done: AtomicU64,
    beyond_reach: AtomicU64,
    ends: AtomicU64,
    faded: AtomicU64,
}

impl Counters {
    fn add(&self, work: &Work) {
        self.done.fetch_add(work.done, Relaxed);
        self.beyond_reach.fetch_add(work.beyond_reach, Relaxed);
        self.ends.fetch_add(work.ends, Relaxed);
        self.faded.fetch_add(work.faded, Relaxed);
    }
}

/// Depth (C) from which [`Field::down`] interpolates: nearer to the surface a coarse answer has
/// errors next to the corner that a polynomial would carry away from there.
const SMOOTH_DEPTH: f64 = 0.14;

/// What interpolation along a line may leave out, in tolerances.
const INTERPOLATION: f64 = 0.02;

/// Points nearer to a surface than this (C, or in body half-lengths) lie on it.
const ON_SURFACE: f64 = 1e-9;

/// The stress field of one body.
#[derive(Debug)]
pub struct Field<'a> {
    body: &'a Body,
    pressure: &'a Pressure,
    wavenumbers: &'a Wavenumbers,
    layers: &'a [Layer],
    /// What acts on the plane x = 0, where every wave is at its crest: one item for each coarse
    /// wavenumber, with the quadrature over the fine ones in its loads.
    central: Vec<Loads>,
    /// What acts elsewhere, one item for each fine wavenumber, made when it is asked for: with the
    /// exponent of two of the distance from that plane up to which it serves.
    all: Mutex<Vec<(i32, Arc<Vec<Loads>>)>>,
    /// Stress transition factor of [`EdgeModel::Guilbault`].
    gamma: f64,
    /// Requested accuracy (p0).
    tolerance: f64,
    /// A wavenumber's share of a stress that is as good as none (p0).
    negligible: f64,
    counters: Counters,
    /// [`Body::plate_kernel`] of the items of `central`, for the latest y.
    plates: Mutex<Vec<(f64, Plates)>>,
}

/// What a plate's remainder does, for each item of a list.
type Plates = Arc<Vec<Vec<[f64; 6]>>>;

/// Curves share so many places along y at most that are worth keeping.
const KEPT_PLATES: usize = 128;

/// After so many negligible fine wavenumbers in a row, more than a period of the oscillation that the
/// contact's width gives the amplitudes, the rest is left out; of the coarse ones, after a panel.
const FADED: usize = 8;

/// Amplitudes of xx, yy, zz, xy, xz, yz.
type Amplitudes = [f64; 6];

impl<'a> Field<'a> {
    /// The field of `body` whose `layers` belong to `wavenumbers`, under `pressure`, with wavenumbers
    /// left out that change no stress by more than about a tenth of `tolerance` (p0).
    pub fn new(
        body: &'a Body,
        wavenumbers: &'a Wavenumbers,
        layers: &'a [Layer],
        pressure: &'a Pressure,
        gamma: f64,
        tolerance: f64,
    ) -> Self {
        let (fine, n) = (wavenumbers.fine(), pressure.axis().len());
        let mut transforms = vec![0.0; n * fine.len()];
        for (&k, out) in fine.nodes().iter().zip(transforms.chunks_exact_mut(n)) {
            pressure.transform(k, out);
        }
        let moments = wavenumbers.moments(&transforms, n);
        let central = wavenumbers
            .coarse()
            .nodes()
            .iter()
            .zip(moments.chunks_exact(n))
            .zip(layers)
            .map(|((&k, p), layer)| {
                Loads::new(body, k, None, p.to_vec(), std::slice::from_ref(layer), &[1.0])
            })
            .collect();
        let negligible = 0.005 * tolerance;
        let all = Mutex::default();
        let counters = Counters::default();
        let plates = Mutex::default();
        Self {
            body,
            pressure,
            wavenumbers,
            layers,
            central,
            all,
            gamma,
            tolerance,
            negligible,
            counters,
            plates,
        }
    }

    /// The kernel evaluations so far.
    pub fn work(&self) -> Work {
        let Counters { done, beyond_reach, ends, faded } = &self.counters;
        let [done, beyond_reach, ends, faded] =
            [done, beyond_reach, ends, faded].map(|count| count.load(Relaxed));
        Work { done, beyond_reach, ends, faded }
    }

    /// The plate's kernels in the plane x = 0 at `y`; points below each other share them.
    fn plates(&self, y: f64) -> Plates {
        let kept = |plates: &[(f64, Plates)]| {
            plates.iter().find(|(at, _)| *at == y).map(|(_, plates)| plates.clone())
        };
        if let Some(plates) = kept(&self.plates.lock().unwrap_or_else(|e| e.into_inner())) {
            return plates;
        }
        let made: Plates =
            Arc::new(self.central.iter().map(|loads| self.body.plate_kernel(loads.k, y)).collect());
        let mut plates = self.plates.lock().unwrap_or_else(|e| e.into_inner());
        if plates.len() >= KEPT_PLATES {
            plates.clear();
        }
        plates.push((y, made.clone()));
        made
    }

    /// The loads of every fine wavenumber, for points up to `farthest` from the plane x = 0.
    fn all(&self, farthest: f64) -> Arc<Vec<Loads>> {
        let level = farthest.max(1.0).log2().ceil() as i32;
        let mut made = self.all.lock().unwrap_or_else(|e| e.into_inner());
        if let Some((_, loads)) = made.iter().find(|(l, _)| *l == level) {
            return loads.clone();
        }
        let numbers = self.wavenumbers.resolving(2f64.powi(level));
        let terms = numbers.fine().nodes().iter().zip(numbers.fine().weights()).enumerate();
        let loads = terms.map(|(node, (&k, &weight))| {
            let (first, shares) = numbers.interpolation(node);
            let mut p = vec![0.0; self.pressure.axis().len()];
            self.pressure.transform(k, &mut p);
            Loads::new(self.body, k, Some(weight), p, &self.layers[first..], shares)
        });
        let loads = Arc::new(loads.collect::<Vec<_>>());
        made.push((level, loads.clone()));
        loads
    }

    /// Stresses at the points (x, `y`, `z`) for each x of `xs`, in their order.
    ///
    /// On a loaded surface or a free end face the known tractions are used.
    pub fn at(&self, y: f64, z: f64, xs: &[f64]) -> Vec<StressTensor> {
        let z = if z < ON_SURFACE { 0.0 } else { z };
        let remainders = self.remainders(y, z, xs);
        xs.iter().zip(remainders).map(|(&x, s)| self.complete(x, y, z, s)).collect()
    }

    /// Stresses at the points (`x`, `y`, z) for each z >= 0 of `zs`, in their order: what [`Field::at`]
    /// gives, with the smooth part interpolated where points lie closer than it varies.
    ///
    /// Under a load at the distance u along the surface the field's poles are at z = +-i u, so in
    /// ln z it is analytic for imaginary parts within pi/2.
    pub fn down(&self, x: f64, y: f64, zs: &[f64]) -> Vec<StressTensor> {
        let below = zs.iter().filter(|z| **z >= SMOOTH_DEPTH).map(|z| z.ln());
        let poles = |[from, to]: [f64; 2]| vec![(0.5 * (from + to), FRAC_PI_2)];
        let Some(axis) = self.sampling(below, poles) else {
            return zs.iter().map(|&z| self.at(y, z, &[x])[0]).collect();
        };
        let nodes: Vec<StressTensor> =
            axis.nodes().iter().map(|t| self.remainders(y, t.exp(), &[x])[0]).collect();
        zs.iter()
            .map(|&z| match z >= SMOOTH_DEPTH {
                true => self.complete(x, y, z, interpolated(&axis, &nodes, z.ln())),
                false => self.at(y, z, &[x])[0],
            })
            .collect()
    }

    /// Stresses at the points (`x`, y, `z`) for each y >= 0 of `ys`, in their order: what
    /// [`Field::at`] gives, interpolated where points lie closer than the field varies.
    ///
    /// At a depth below a corner the field's poles are at that distance from the corner, to either
    /// side of the line: y = corner + z sinh t puts the points where it varies, and the poles of
    /// the contact's end at t = +-i pi/2.
    pub fn along(&self, x: f64, z: f64, ys: &[f64]) -> Vec<StressTensor> {
        let breaks = self.pressure.axis().breaks();
        let end = breaks[breaks.len() - 1];
        let corner = Complex::new((self.body.half - end) / z, 1.0).asinh();
        let place = |y: f64| ((y - end) / z).asinh();
        let poles = |_| vec![(0.0, FRAC_PI_2), (corner.re, corner.im)];
        let axis = match z > ON_SURFACE {
            true => self.sampling(ys.iter().map(|y| place(*y)), poles),
            false => None,
        };
        let Some(axis) = axis else {
            return ys.iter().map(|&y| self.at(y, z, &[x])[0]).collect();
        };
        let nodes: Vec<StressTensor> =
            axis.nodes().iter().map(|t| self.at(end + z * t.sinh(), z, &[x])[0]).collect();
        ys.iter().map(|y| interpolated(&axis, &nodes, place(*y))).collect()
    }

    /// The nodes through which to interpolate to `places`, [`INTERPOLATION`] exactly, with
    /// functions that have `poles` (places, and distances from the axis) between the outermost two;
    /// none if they were no fewer than the places.
    ///
    /// Interpolation through n Gauss nodes errs by about r^-n, with r the parameter of Bernstein's
    /// ellipse through the pole, see [`crate::body::stencil`].
    fn sampling(
        &self,
        places: impl Iterator<Item = f64> + Clone,
        poles: impl Fn([f64; 2]) -> Vec<(f64, f64)>,
    ) -> Option<Panels> {
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
        let wanted = -(INTERPOLATION * self.tolerance).ln() / rate;
        (wanted < count as f64 - 1.0)
            .then(|| Panels::new(vec![from, to], wanted.ceil().max(2.0) as usize))
    }

    /// Whether `y` (C) lies on an end face.
    fn on_face(&self, y: f64) -> bool {
        self.body.half - y.abs() < ON_SURFACE * self.body.half
    }

    /// The stress whose part beyond the endless contact of the local pressure is `remainder`.
    fn complete(&self, x: f64, y: f64, z: f64, remainder: StressTensor) -> StressTensor {
        let mut s = remainder;
        for (j, weight) in self.pressure.neighbours(y.abs()).into_iter().flat_map(numbered) {
            let (a, c) = self.pressure.at_node(j);
            let [xx, zz, xz] = strip::stress(a, c, x, z).map(|s| weight * s);
            s.xx += xx;
            s.zz += zz;
            s.xz += xz;
            s.yy += self.body.nu * (xx + zz);
        }
        if z == 0.0 {
            s.zz = -self.pressure.at(x, y);
            (s.xz, s.yz) = (0.0, 0.0);
        }
        if self.on_face(y) && self.body.model == EdgeModel::QuarterSpace {
            (s.yy, s.xy, s.yz) = (0.0, 0.0, 0.0);
        }
        if y < 0.0 {
            (s.xy, s.yz) = (-s.xy, -s.yz);
        }
        s
    }

    /// Stresses at (x, |`y`|, `z`) for each x of `xs`, less those of an endless contact of the
    /// pressure at `y`.
    fn remainders(&self, y: f64, z: f64, xs: &[f64]) -> Vec<StressTensor> {
        let y = y.abs();
        let body = self.body;
        let surface = body.surface_stencil(y, z);
        let complete = body.model == EdgeModel::QuarterSpace;
        let faces = complete.then(|| body.face_stencils(y, z));
        let correction = (body.model == EdgeModel::Guilbault).then(|| {
            let end = body.surface_stencil(body.half, z);
            (end, [body.half - y, body.half + y].map(|s| transition(s, z, self.gamma)))
        });
        let local: Vec<(usize, f64)> =
            self.pressure.neighbours(y).into_iter().flat_map(numbered).collect();
        let farthest = xs.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let central = farthest == 0.0;
        let all = if central { Arc::default() } else { self.all(farthest) };
        let (items, faded) = if central {
            (&self.central[..], self.wavenumbers.coarse().order())
        } else {
            (&all[..], FADED * all.len() / self.wavenumbers.fine().len())
        };
        let mut sums = vec![[0.0; 6]; xs.len()];
        let mut fading = 0;
        let mut scratch = LineLoads::default();
        let on_faces: usize = faces.iter().flatten().map(Stencil::len).sum();
        let on_surface = surface.len() + correction.as_ref().map_or(0, |c| c.0.len());
        let mut work = Work::default();
        let phases = if complete { body.plate_phases(z) } else { Vec::new() };
        let plates = (complete && central).then(|| self.plates(y));
        for (number, loads) in items.iter().enumerate() {
            let k = loads.k;
            if fading >= faded {
                work.faded = ((items.len() - number) * (on_surface + on_faces)) as u64;
                break;
            }
            let mut amplitudes = self.surface_part(&surface, loads, y, z, &mut scratch);
            let mut done = scratch.offsets.len();
            if let Some((end, shares)) = &correction {
                let on_end = self.surface_part(end, loads, body.half, z, &mut scratch)[1];
                done += scratch.offsets.len();
                amplitudes[1] -= on_end * (shares[0] + shares[1]);
            }
            if let Some(stencils) = &faces {
                let depths = [if self.on_face(y) { 0.0 } else { body.half - y }, body.half + y];
                for ((stencil, depth), into) in stencils.iter().zip(depths).zip([-1.0, 1.0]) {
                    let face = self.face_part(stencil, loads, z, depth, into, &mut scratch);
                    amplitudes.iter_mut().zip(face).for_each(|(a, f)| *a += f);
                    done += scratch.offsets.len();
                }
                let plate = match &plates {
                    Some(plates) => Body::plate_stress(&plates[number], &loads.plate, &phases),
                    None => Body::plate_stress(&body.plate_kernel(k, y), &loads.plate, &phases),
                };
                amplitudes.iter_mut().zip(plate).for_each(|(a, p)| *a += p);
            }
            let ends = if loads.face.is_empty() { on_faces } else { 0 };
            work.done += done as u64;
            work.ends += ends as u64;
            // Strips are sources that the stencils do not count.
            work.beyond_reach += (on_surface + on_faces).saturating_sub(ends + done) as u64;
            let p: f64 = local.iter().map(|(j, w)| w * loads.contact[*j]).sum();
            let e = (-k * z).exp() * p;
            amplitudes[0] += (1.0 - k * z) * e;
            amplitudes[1] += 2.0 * body.nu * e;
            amplitudes[2] += (1.0 + k * z) * e;
            amplitudes[4] += k * z * e;
            let largest = amplitudes.iter().fold(0.0, |m: f64, a| m.max(a.abs()));
            // Only once oscillations across the contact are resolved does a small amplitude last.
            let small = k > 1.0 && loads.weight * largest < self.negligible;
            fading = if small { fading + 1 } else { 0 };
            for (sum, x) in sums.iter_mut().zip(xs) {
                let (sin, cos) = if *x == 0.0 { (0.0, 1.0) } else { (k * x).sin_cos() };
                for (i, (s, a)) in sum.iter_mut().zip(amplitudes).enumerate() {
                    *s += loads.weight * a * if i == 3 || i == 4 { sin } else { cos };
                }
            }
        }
        self.counters.add(&work);
        sums.into_iter().map(StressTensor::from_components).collect()
    }

    /// Amplitudes from P on z = 0 and its images, at (`y`, `z`); `scratch` is overwritten.
    fn surface_part(
        &self,
        stencil: &Stencil,
        loads: &Loads,
        y: f64,
        z: f64,
        scratch: &mut LineLoads,
    ) -> Amplitudes {
        let (body, k) = (self.body, loads.k);
        let reach = body.reach(k);
        scratch.clear();
        if z > reach {
            return [0.0; 6];
        }
        stencil.gather(reach, &loads.surface, &loads.surface_charges, scratch);
        body.for_strips(k, y, z, |u, w| scratch.push(u, w * loads.mean));
        if z == 0.0 {
            let p = value_at(&body.surface.axis, &loads.surface, y);
            return surface_limit(body.nu, k, p, loads.central, scratch);
        }
        let [xx, yy, zz, yz, xy, xz] = self.line_loads(k, z, loads.central, scratch);
        [xx, yy, zz, xy, xz, yz]
    }

    /// Amplitudes xx, ww, dd, wd, xw, xd of line loads at a depth > 0; on the plane x = 0 the shears
    /// xw and xd are none.
    fn line_loads(&self, k: f64, depth: f64, central: bool, loads: &LineLoads) -> Amplitudes {
        let kernel = &self.body.kernel;
        if central {
            let [xx, ww, dd, wd] = kernel.sum_even(k, depth, &loads.offsets, &loads.loads);
            return [xx, ww, dd, wd, 0.0, 0.0];
        }
        kernel.sum(k, depth, &loads.offsets, &loads.loads)
    }

    /// Amplitudes from q on one end face, `depth` from it, at the depth `z` in the body; `into` is
    /// the sign of the direction into the body along y.
    fn face_part(
        &self,
        stencil: &Stencil,
        loads: &Loads,
        z: f64,
        depth: f64,
        into: f64,
        scratch: &mut LineLoads,
    ) -> Amplitudes {
        let (body, k) = (self.body, loads.k);
        let reach = body.reach(k);
        scratch.clear();
        if depth > reach || loads.face.is_empty() {
            return [0.0; 6];
        }
        stencil.gather(reach, &loads.face, &loads.face_charges, scratch);
        let [xx, ww, dd, wd, xw, xd] = if depth == 0.0 {
            let q = value_at(&body.face.axis, &loads.face, z);
            let [xx, ww, dd, xw, xd, wd] = surface_limit(body.nu, k, q, loads.central, scratch);
            [xx, ww, dd, wd, xw, xd]
        } else {
            self.line_loads(k, depth, loads.central, scratch)
        };
        [xx, dd, ww, into * xd, xw, into * wd]
    }
}

/// The stress at `place` of the polynomial through `values` at the nodes of `axis`.
fn interpolated(axis: &Panels, values: &[StressTensor], place: f64) -> StressTensor {
    let mut sum = StressTensor::default();
    for (node, weight) in numbered(axis.interpolation(place)) {
        sum += values[node] * weight;
    }
    sum
}

/// A run of numbers from the first on, each with its weight.
fn numbered((first, weights): (usize, Vec<f64>)) -> impl Iterator<Item = (usize, f64)> {
    (first..).zip(weights)
}

/// Value at `at` of a function given at the first nodes of `axis`; zero beyond them.
fn value_at(axis: &Panels, values: &[f64], at: f64) -> f64 {
    let end = axis.breaks()[axis.panel_count()];
    let (first, weights) = axis.interpolation(at);
    if at > end * (1.0 + 1e-12) || first >= values.len() {
        return 0.0;
    }
    weights.iter().zip(&values[first..]).map(|(w, v)| w * v).sum()
}

/// Amplitudes on a loaded surface itself, see [`surface_spread`]: xx, along the surface, along the
/// depth, xw (none on the plane x = 0, `central`), and no shear on the surface. `p` is the load there.
fn surface_limit(nu: f64, k: f64, p: f64, central: bool, loads: &LineLoads) -> Amplitudes {
    let free = 1.0 - 2.0 * nu;
    let spread = free * loads.sum(|u| surface_spread(k, u));
    let shear = if central { 0.0 } else { free * loads.sum(|u| surface_spread_shear(k, u)) };
    [-2.0 * nu * p - spread, -p + spread, -p, shear, 0.0, 0.0]
}

/// Share of an end face's normal stress that the reconstructed correction of
/// [`EdgeModel::Guilbault`] takes away at the distance `s` from the face and the depth `z`.
///
/// A pressure on the face with the wavelength of the depth fades into the body like
/// (1 + kappa s) e^(-kappa s); with kappa = 1 / (gamma z) the share is one on the face and none far
/// from it, and the far field is reached over a distance that grows with the depth.
pub fn transition(s: f64, z: f64, gamma: f64) -> f64 {
    if s <= 0.0 {
        return 1.0;
    }
    let t = s / (gamma * z);
    if t > 700.0 || z == 0.0 { 0.0 } else { (1.0 + t) * (-t).exp() }
}
