//! The stresses of the loads that a body's round surface adds, per C / R; see [`Skins`].

use super::load::Load;
use super::target::{INTO_FACES, add_side, add_wave, from_face, in_body, off_middle};
use super::waves::{Influence, LoadBlock, blocks};
use crate::base::{Parity, Samples, StressTensor, Wavenumbers};
use crate::body::{Body, Skin, Skins};
use crate::kernels::line_load::WaveStress;
use crate::kernels::plate::Remainder;
use crate::kernels::wave::{WAVES, Wanted};
use nalgebra::DMatrix;
use std::f64::consts::PI;
use std::sync::{Arc, Mutex};

/// Least depth (C) at which tractions along the surface act on a point: on the surface itself
/// forces apart have no stress, and above this depth that of all of them hardly varies.
const LEAST_DEPTH: f64 = 0.05;

/// Distance from an end face (C) within which stresses vary with that, where the contact ends
/// farther from it.
const BESIDE_FACE: f64 = 1.5;

/// The field of a skin under a pressure.
#[derive(Debug)]
pub(super) struct SkinField<'a> {
    skins: &'a Skins,
    /// The part of them that counts.
    felt: f64,
    pressure: &'a dyn Load,
    /// The distance beside the contact and the depth (C) beyond which its stresses are not felt.
    reach: [f64; 2],
    /// For each node of the skin's line the nodes of the pressure's, with weights.
    places: Vec<Vec<(usize, f64)>>,
    /// The loads for the plane x = 0.
    central: Arc<SkinWaves>,
    /// Those for other points: each with the binary exponent of the largest distance from that
    /// plane for which it is valid.
    all: Mutex<Vec<(i32, Arc<SkinWaves>)>>,
}

/// The loads of all wavenumbers.
#[derive(Debug)]
struct SkinWaves {
    /// The wavenumbers, and the factors of their stresses.
    k: Vec<f64>,
    weights: Vec<f64>,
    /// Whether they are valid for the plane x = 0 only.
    central: bool,
    /// The loads on each part of the body.
    parts: Vec<SkinLoads>,
}

/// The loads of [`Skin`] on one part of the body.
#[derive(Debug)]
struct SkinLoads {
    along: Vec<LoadBlock>,
    apart: Vec<LoadBlock>,
    freeing: Vec<LoadBlock>,
    /// Transforms of the freeing loads on the end faces, for the plate, and its remainder.
    plate: Vec<Vec<f64>>,
    plate_waves: Vec<Vec<Remainder>>,
}

impl<'a> SkinField<'a> {
    /// The field of these `skins`, which are `felt` in this part, under `pressure`, within the
    /// `reach` beside the contact and below it (C).
    pub fn new(skins: &'a Skins, felt: f64, pressure: &'a dyn Load, reach: [f64; 2]) -> Self {
        let neighbours =
            |y: &f64| pressure.axis().load_interpolation(pressure.on_axis(*y)).collect();
        let places: Vec<Vec<_>> = skins.line.nodes().iter().map(neighbours).collect();
        let numbers = &skins.wavenumbers;
        let transforms = transforms(pressure, &places, numbers.fine());
        let moments = numbers.moments(transforms.as_slice(), places.len());
        let moments = DMatrix::from_row_slice(numbers.coarse().len(), places.len(), &moments);
        let order = numbers.coarse().order();
        let k = numbers.coarse().nodes()[order..].to_vec();
        let weights = vec![felt / PI; k.len()];
        let contact = moments.rows_range(order..).into_owned();
        let own = SkinWaves::new(skins, k, weights, contact, |i| (i + order, vec![1.0]));
        let central = Arc::new(SkinWaves { central: true, ..own });
        Self { skins, felt, pressure, reach, places, central, all: Mutex::default() }
    }

    /// The loads of every fine wavenumber, for points up to `farthest` from the plane x = 0.
    fn all(&self, farthest: f64) -> Arc<SkinWaves> {
        let level = farthest.max(1.0).log2().ceil() as i32;
        let mut known = self.all.lock().unwrap_or_else(|e| e.into_inner());
        if let Some((_, waves)) = known.iter().find(|(l, _)| *l == level) {
            return waves.clone();
        }
        let waves = Arc::new(self.resolved(&self.skins.wavenumbers.resolving(2f64.powi(level))));
        known.push((level, waves.clone()));
        waves
    }

    /// The loads of the fine ones of the wavenumbers `numbers` that have some.
    fn resolved(&self, numbers: &Wavenumbers) -> SkinWaves {
        let fine = numbers.fine();
        let long = fine.partition_point(|k| *k < self.skins.longest());
        let k = fine[long..].to_vec();
        let weights = numbers.weights()[long..].iter().map(|w| self.felt * w / PI).collect();
        let contact = transforms(self.pressure, &self.places, &k).transpose();
        SkinWaves::new(self.skins, k, weights, contact, |i| {
            let (first, shares) = numbers.interpolation(i + long);
            (first, shares.to_vec())
        })
    }

    /// Stresses at the points (x, `y`, z): for each z of `zs` those for each x of `xs`, in their
    /// order. They vary with ln z.
    pub fn down(&self, xs: &[f64], y: f64, zs: &[f64]) -> Vec<Vec<StressTensor>> {
        let [beside, deepest] = self.reach;
        let near = |x: &f64| x.abs() <= beside;
        let own: Vec<f64> = xs.iter().copied().filter(near).collect();
        let felt = zs.iter().filter(|z| **z <= deepest && !own.is_empty());
        let places: Vec<f64> = felt.map(|z| z.max(LEAST_DEPTH).ln()).collect();
        let per_e = self.skins.nodes_per_e;
        let mut rows = sampled(&places, per_e, |t| self.below(y, t.exp(), &own)).into_iter();
        let of_depth = |z: &f64| {
            let row = if *z <= deepest { rows.next() } else { None };
            let mut row = row.into_iter().flatten().map(|s| self.meeting(s, y, *z));
            let at = |x: &f64| if near(x) { row.next() } else { None };
            xs.iter().map(at).map(Option::unwrap_or_default).collect()
        };
        zs.iter().map(of_depth).collect()
    }

    /// Stresses at the points (0, y, `z`) for each y of `ys`, in their order. They vary with the
    /// distance from the contact's end on the same side, in that of the depth.
    pub fn along(&self, z: f64, ys: &[f64]) -> Vec<StressTensor> {
        let depth = z.max(LEAST_DEPTH);
        if z > self.reach[1] {
            return vec![StressTensor::default(); ys.len()];
        }
        let [from, to] = self.pressure.ends();
        let (middle, end) = (0.5 * (from + to), 0.5 * (to - from));
        let mut stresses = vec![StressTensor::default(); ys.len()];
        for side in [1.0, -1.0] {
            let own = |y: f64| if side > 0.0 { y >= middle } else { y < middle };
            let own = (0..ys.len()).filter(|i| own(ys[*i]));
            let face = self.skins.middle + side * self.skins.bodies[0].half;
            let from_face = |y: f64| side * (face - y);
            let open = from_face(middle + side * end) > BESIDE_FACE;
            let beside = |i: &usize| open && from_face(ys[*i]) < BESIDE_FACE;
            let (beside, own): (Vec<usize>, Vec<usize>) = own.partition(beside);
            for i in beside {
                stresses[i] = self.meeting(self.below(ys[i], depth, &[0.0])[0], ys[i], z);
            }
            let place = |i: &usize| ((side * (ys[*i] - middle) - end) / depth).asinh();
            let places: Vec<f64> = own.iter().map(place).collect();
            let at = |t: f64| self.below(middle + side * (end + depth * t.sinh()), depth, &[0.0]);
            for (i, found) in own.into_iter().zip(sampled(&places, self.skins.nodes_per_e, at)) {
                stresses[i] = self.meeting(found[0], ys[i], z);
            }
        }
        stresses
    }

    /// Stresses at the points (x, `y`, `z`) for each x of `xs`, in their order.
    pub fn at(&self, y: f64, z: f64, xs: &[f64]) -> Vec<StressTensor> {
        self.down(xs, y, &[z]).swap_remove(0)
    }

    /// A stress at `y` and the depth `z` from that at [`LEAST_DEPTH`] or at the same depth: free
    /// surfaces carry no traction.
    fn meeting(&self, mut s: StressTensor, y: f64, z: f64) -> StressTensor {
        let share = (z / LEAST_DEPTH).min(1.0);
        [&mut s.zz, &mut s.xz, &mut s.yz].into_iter().for_each(|stress| *stress *= share);
        let body = &self.skins.bodies[0];
        if off_middle(body, y - self.skins.middle) == body.half {
            (s.yy, s.xy, s.yz) = (0.0, 0.0, 0.0);
        }
        s
    }

    /// [`SkinField::at`] at least [`LEAST_DEPTH`] deep, within reach.
    fn below(&self, y: f64, z: f64, xs: &[f64]) -> Vec<StressTensor> {
        let farthest = xs.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let odd = self.pressure.parity_across() == Parity::Odd;
        // Those of the plane x = 0 are without shears, which an even pressure has none of there.
        let central = farthest == 0.0 && !odd;
        let waves = if central { self.central.clone() } else { self.all(farthest) };
        let mut targets: Vec<SkinTarget> = waves
            .parts
            .iter()
            .zip(&self.skins.bodies)
            .map(|(loads, body)| SkinTarget::new(self.skins, &waves, loads, body, y, z))
            .collect();
        let mut sums = vec![[0.0; 6]; xs.len()];
        for (i, (&k, &weight)) in waves.k.iter().zip(&waves.weights).enumerate() {
            let mut amplitudes = [0.0; 6];
            targets.iter_mut().for_each(|target| target.add(i, &mut amplitudes));
            for (sum, x) in sums.iter_mut().zip(xs) {
                let (sin, cos) = if *x == 0.0 { (0.0, 1.0) } else { (k * x).sin_cos() };
                let [others, shears] = if odd { [sin, -cos] } else { [cos, sin] };
                add_wave(sum, &amplitudes, weight * others, weight * shears);
            }
        }
        sums.into_iter().map(StressTensor::from_components).collect()
    }
}

/// The stresses `at` each of the `places`, by interpolation between `per_unit` nodes where that
/// takes fewer of them.
fn sampled(
    places: &[f64],
    per_unit: f64,
    at: impl Fn(f64) -> Vec<StressTensor>,
) -> Vec<Vec<StressTensor>> {
    let [from, to] = places
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], t| [low.min(*t), high.max(*t)]);
    let nodes = (per_unit * (to - from)).max(0.0).ceil() as usize + 2;
    if places.len() <= nodes || from >= to {
        return places.iter().map(|t| at(*t)).collect();
    }
    let axis = Samples::new(from, to, nodes);
    let known: Vec<_> = axis.places().iter().map(|t| at(*t)).collect();
    let interpolated = |t: &f64| {
        let mut sums = vec![StressTensor::default(); known[0].len()];
        for (share, known) in axis.shares(*t).into_iter().zip(&known) {
            sums.iter_mut().zip(known).for_each(|(sum, own)| *sum += *own * share);
        }
        sums
    };
    places.iter().map(interpolated).collect()
}

/// Transforms of `pressure` at the `places` of a skin's nodes: a column for each of the wavenumbers
/// `k`.
fn transforms(pressure: &dyn Load, places: &[Vec<(usize, f64)>], k: &[f64]) -> DMatrix<f64> {
    let own = pressure.transforms(k);
    DMatrix::from_fn(places.len(), k.len(), |node, i| {
        places[node].iter().map(|(j, w)| w * own[(*j, i)]).sum()
    })
}

impl SkinWaves {
    /// The loads at the wavenumbers `k` for the transforms `contact` of the contact pressure, a row
    /// for each. `shares` gives for each of them the first of the coarse wavenumbers in its
    /// interpolation, and the shares.
    fn new(
        skins: &Skins,
        k: Vec<f64>,
        weights: Vec<f64>,
        contact: DMatrix<f64>,
        shares: impl Fn(usize) -> (usize, Vec<f64>),
    ) -> Self {
        let parts = skins.bodies.iter().enumerate().map(|(part, body)| {
            let own = skins.fold.part(body.parity, &contact);
            SkinLoads::new(body, &k, &own, |i| {
                let (first, shares) = shares(i);
                let all = (first..).zip(shares);
                all.filter_map(|(at, share)| Some((skins.loads(part, at)?, share))).collect()
            })
        });
        let parts = parts.collect();
        Self { parts, k, weights, central: false }
    }
}

impl SkinLoads {
    /// The loads on a `body` under a part of the pressure, from the `shares` of skins in each
    /// wavenumber.
    fn new<'s>(
        body: &Body,
        k: &[f64],
        contact: &DMatrix<f64>,
        shares: impl Fn(usize) -> Vec<(&'s Skin, f64)>,
    ) -> Self {
        let (on_surface, on_face) = (body.surface.axis.len(), body.face.axis.len());
        let of = |rows: usize| DMatrix::zeros(rows, k.len());
        let mut all = [on_surface, on_surface, on_surface, on_face].map(of);
        for i in 0..k.len() {
            let p = contact.row(i).transpose();
            for (skin, share) in shares(i) {
                let loads = [&skin.along, &skin.apart, &skin.surface, &skin.face];
                for (sum, load) in all.iter_mut().zip(loads) {
                    sum.view_range_mut(..load.nrows(), i).gemv(share, load, &p, 1.0);
                }
            }
        }
        let [along, apart, surface, face] = all;
        let none = of(on_face);
        let waves = k.iter().zip(face.column_iter());
        Self {
            along: blocks(body, (k, 0), &along, &none),
            apart: blocks(body, (k, 0), &apart, &none),
            plate: waves.map(|(k, q)| body.plate_transform(*k, q.as_slice())).collect(),
            plate_waves: k.iter().map(|k| body.plate_waves(*k)).collect(),
            freeing: blocks(body, (k, k.len()), &surface, &face),
        }
    }
}

/// The influence of a skin's loads on one part of a body on a point.
struct SkinTarget<'a> {
    skins: &'a Skins,
    loads: &'a SkinLoads,
    body: &'a Body,
    /// Distance from the body's middle, and whether the point lies on the other side of it.
    eta: f64,
    behind: bool,
    wanted: Wanted,
    surface: Influence,
    faces: [Influence; 2],
    phases: Vec<(f64, f64)>,
    /// The stresses of the most recent [`WAVES`] wavenumbers, of the loads along, apart and into
    /// the surface, and of those on the end faces.
    stresses: [[(WaveStress, usize); WAVES]; 5],
    scratch: Vec<[f32; WAVES]>,
}

impl<'a> SkinTarget<'a> {
    /// The point (`y`, `z`) of a `body` under the `loads` of `waves`.
    fn new(
        skins: &'a Skins,
        waves: &SkinWaves,
        loads: &'a SkinLoads,
        body: &'a Body,
        y: f64,
        z: f64,
    ) -> Self {
        let y = y - skins.middle;
        let eta = off_middle(body, y);
        let (lowest, shears) = (waves.k[0], !waves.central);
        let depths = [body.half - eta, body.half + eta];
        Self {
            skins,
            loads,
            body,
            eta,
            behind: y < 0.0,
            wanted: if waves.central { Wanted::PLAIN } else { Wanted::ALL },
            surface: Influence::of_surface(body, lowest, shears, eta, z),
            faces: Influence::of_faces(body, shears, eta, z, depths),
            phases: body.plate_phases(z),
            stresses: [[(WaveStress::default(), 0); WAVES]; 5],
            scratch: Vec::new(),
        }
    }

    /// Sums the loads of the [`WAVES`] wavenumbers of number `block`.
    fn sum_block(&mut self, block: usize) {
        let Self { skins, body, loads, wanted, scratch, .. } = self;
        let [along, apart] = &skins.tables;
        let (pressed, freeing) = ((*body, &*body.kernel), &loads.freeing[block]);
        let [near, far] = &self.faces;
        self.stresses = [
            self.surface.stresses((*body, &**along), &loads.along[block], *wanted, scratch),
            self.surface.stresses((*body, &**apart), &loads.apart[block], *wanted, scratch),
            self.surface.stresses(pressed, freeing, *wanted, scratch),
            near.stresses(pressed, freeing, *wanted, scratch),
            far.stresses(pressed, freeing, *wanted, scratch),
        ];
    }

    /// Adds the amplitudes of the six components at wavenumber number `i`; wavenumbers must be
    /// evaluated in order.
    fn add(&mut self, i: usize, total: &mut [f64; 6]) {
        let wave = i % WAVES;
        if wave == 0 {
            self.sum_block(i / WAVES);
        }
        let [along, apart, surface, near, far] = self.stresses.map(|own| own[wave].0);
        let mut sum = in_body(&apart);
        // These loads are sin(k x): a quarter of a wave behind, where all but the shears are -
        // cos(k x).
        for (component, (sum, own)) in sum.iter_mut().zip(in_body(&along)).enumerate() {
            *sum += if StressTensor::ODD_IN_X[component] { own } else { -own };
        }
        sum.iter_mut().zip(in_body(&surface)).for_each(|(sum, own)| *sum += own);
        for (face, into) in [near, far].iter().zip(INTO_FACES) {
            sum.iter_mut().zip(from_face(face, into)).for_each(|(sum, own)| *sum += own);
        }
        let kernel = self.body.plate_kernel(&self.loads.plate_waves[i], self.eta);
        let plate = Body::plate_stress(&kernel, &self.loads.plate[i], &self.phases);
        sum.iter_mut().zip(plate).for_each(|(sum, own)| *sum += own);
        add_side(self.body, self.behind, total, sum);
    }
}
