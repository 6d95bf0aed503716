//! The amplitudes of the waves of stress at one point.

use super::load::Load;
use super::slow_change::SlowChange;
use super::waves::{Influence, PartLoads, TractionLoads, Waves, shears};
use super::work::Work;
use crate::base::StressTensor;
use crate::body::{Body, Stack, transition};
use crate::kernels::line_load::WaveStress;
use crate::kernels::wave::{WAVES, Wanted, WaveTable};
use std::sync::{Arc, Mutex};

/// Points closer to an end face than this (in body half-lengths) count as on it.
pub(super) const ON_FACE: f64 = 1e-9;

/// Depth (C) that stands for the surface under a traction along x, see [`below`].
const UNDER_SURFACE: f64 = 1e-5;

/// The kernels of a plate's remainder, for each part of the load and each wavenumber.
type Plates = Arc<Vec<Vec<Vec<[f64; 6]>>>>;

/// Largest number of positions y whose plate kernels are kept for other points.
const MOST_PLATES: usize = 128;

/// [`Body::plate_kernel`] in the plane x = 0, for the most recent distances from the body's middle.
#[derive(Debug, Default)]
pub(super) struct KeptPlates(Mutex<Vec<(f64, Plates)>>);

impl KeptPlates {
    /// Those of the `waves` at the distance `eta` from the middle of the body of `stack`, shared by
    /// all points with that distance.
    fn at(&self, stack: &Stack, waves: &Waves, eta: f64) -> Plates {
        let kept = |plates: &[(f64, Plates)]| {
            plates.iter().find(|(at, _)| *at == eta).map(|(_, plates)| plates.clone())
        };
        if let Some(plates) = kept(&self.0.lock().unwrap_or_else(|e| e.into_inner())) {
            return plates;
        }
        let parts = stack.parts().iter().zip(&waves.parts);
        let kernels = parts.map(|((body, _), loads)| {
            loads.plate_waves.iter().map(|wave| body.plate_kernel(wave, eta)).collect()
        });
        let kernels: Plates = Arc::new(kernels.collect());
        let mut plates = self.0.lock().unwrap_or_else(|e| e.into_inner());
        if plates.len() >= MOST_PLATES {
            plates.clear();
        }
        plates.push((eta, kernels.clone()));
        kernels
    }
}

/// A body and what loads it.
pub(super) struct Loaded<'a> {
    pub stack: &'a Stack,
    pub pressure: &'a dyn Load,
    /// Whether the contact carries a traction.
    pub slides: bool,
    /// Transition factor of the stress correction, if any.
    pub gamma: Option<f64>,
    /// [`Load::slow_change`] at the point.
    pub slow_change: &'a SlowChange,
    pub plates: &'a KeptPlates,
}

/// A point (y, z) and the influence of all loads on it.
pub(super) struct Target<'a> {
    waves: &'a Waves,
    nu: f64,
    z: f64,
    /// Whether the contact carries a traction.
    slides: bool,
    /// The influence of each part of the loads.
    parts: Vec<PartTarget<'a>>,
    /// The contact's nodes that interpolate the local pressure, and their shares.
    local: Vec<(usize, f64)>,
    slow_change: &'a SlowChange,
    pub work: Work,
}

/// The influence of the even or the odd part of the loads on a point.
struct PartTarget<'a> {
    body: &'a Body,
    loads: &'a PartLoads,
    /// Distance from the body's middle.
    eta: f64,
    /// Whether the point lies on the other side of the middle.
    behind: bool,
    /// Whether it lies in the plane x = 0.
    central: bool,
    surface: Influence,
    /// The loads on the end faces at +H and -H, if any.
    faces: Option<[Influence; 2]>,
    /// The influence of the surface's loads on the end face, and the share of its normal stress
    /// that the stress correction subtracts at the point.
    correction: Option<(Influence, f64)>,
    plate: Option<PlateAt>,
    /// The influence of a traction on the surface, if the point lies on it; else that of the
    /// pressure.
    under: Option<Influence>,
    /// The stresses of the most recent [`WAVES`] wavenumbers.
    stresses: BlockStress,
    /// The same under the traction, without and with the loads that free the end faces.
    traction: [BlockStress; 2],
    /// Scratch space.
    scratch: Vec<[f32; WAVES]>,
}

/// The plate's remainder at a point: its kernels, if they are kept with the number of the part of
/// the load that they belong to, and its phases.
struct PlateAt {
    kernels: Option<(Plates, usize)>,
    phases: Vec<(f64, f64)>,
}

/// The stresses of some wavenumbers at a target, each with its number of loads.
#[derive(Default)]
struct BlockStress {
    surface: [(WaveStress, usize); WAVES],
    /// From the surface's loads, at the end face.
    end: [(WaveStress, usize); WAVES],
    /// From the loads on either end face.
    faces: [[(WaveStress, usize); WAVES]; 2],
}

impl<'a> Target<'a> {
    /// The point (`y`, `z`) of a body that is `loaded`, under the loads of `waves`.
    pub fn new(loaded: &Loaded<'a>, waves: &'a Waves, y: f64, z: f64) -> Self {
        let parts = (0..waves.parts.len()).map(|i| PartTarget::new(loaded, waves, i, y, z));
        Self {
            waves,
            nu: loaded.stack.body().nu,
            z,
            slides: loaded.slides,
            parts: parts.collect(),
            local: loaded.pressure.neighbours(y),
            slow_change: loaded.slow_change,
            work: Work::default(),
        }
    }

    /// Number of all loads.
    pub fn loads(&self) -> usize {
        self.parts.iter().map(PartTarget::loads).sum()
    }

    /// Amplitudes of the six components at wavenumber number `i`, under the pressure and under the
    /// traction; wavenumbers must be evaluated in order.
    pub fn amplitudes(&mut self, i: usize) -> ([f64; 6], Option<[f64; 6]>) {
        let mut amplitudes = [0.0; 6];
        let mut traction = self.slides.then_some([0.0; 6]);
        for part in &mut self.parts {
            let own = part.amplitudes(i, &mut self.work);
            part.add_to(&mut amplitudes, own);
            if let Some(traction) = &mut traction {
                let own = part.traction_amplitudes(i);
                part.add_to(traction, own);
            }
        }
        self.take_endless_contact(i, &mut amplitudes);
        self.take_slow_change(i, &mut amplitudes);
        if let Some(traction) = &mut traction {
            self.take_endless_traction(i, traction);
        }
        (amplitudes, traction)
    }

    /// Subtracts the effect of an endless contact with the local pressure.
    fn take_endless_contact(&self, i: usize, amplitudes: &mut [f64; 6]) {
        let (k, z) = (self.waves.k[i], self.z);
        let p: f64 = self.local.iter().map(|(j, w)| w * self.waves.contact[(i, *j)]).sum();
        let e = (-k * z).exp() * p;
        amplitudes[0] += (1.0 - k * z) * e;
        amplitudes[1] += 2.0 * self.nu * e;
        amplitudes[2] += (1.0 + k * z) * e;
        amplitudes[4] += k * z * e;
    }

    /// Subtracts the effect of the load's slow change along the line; of xy that of the long waves,
    /// which are interpolated, is left.
    fn take_slow_change(&self, i: usize, amplitudes: &mut [f64; 6]) {
        if self.slow_change.nodes.is_empty() {
            return;
        }
        let transform = |j: usize| self.waves.contact[(i, j)];
        let [xy, yz] = self.slow_change.amplitudes(self.nu, self.z, self.waves.k[i], transform);
        if i >= self.waves.long.count() {
            amplitudes[3] -= xy;
        }
        amplitudes[5] -= yz;
    }

    /// The same of the traction.
    fn take_endless_traction(&self, i: usize, amplitudes: &mut [f64; 6]) {
        let (k, z) = (self.waves.k[i], below(self.z));
        let p: f64 = self.local.iter().map(|(j, w)| w * self.waves.contact[(i, *j)]).sum();
        let e = (-k * z).exp() * p;
        amplitudes[0] += (2.0 - k * z) * e;
        amplitudes[1] += 2.0 * self.nu * e;
        amplitudes[2] += k * z * e;
        amplitudes[4] += (1.0 - k * z) * e;
    }
}

/// The depth at which the stress of a traction less that of an endless contact is computed for a
/// point at the depth `z`: on the surface itself the stress beside a line load is infinite, in mean
/// value it is not.
fn below(z: f64) -> f64 {
    z.max(UNDER_SURFACE)
}

impl<'a> PartTarget<'a> {
    /// The point (`y`, `z`) of a body that is `loaded`, under part number `part` of the loads of
    /// `waves`.
    fn new(loaded: &Loaded<'a>, waves: &'a Waves, part: usize, y: f64, z: f64) -> Self {
        let (body, loads) = (&loaded.stack.parts()[part].0, &waves.parts[part]);
        let y = y - loaded.stack.middle;
        let beside = if z > 0.0 { 0.0 } else { body.beside_edge() };
        let eta = off_middle(body, y).min(body.half - beside);
        let (lowest, shears) = (waves.k[0], shears(body, waves));
        let faces = body
            .end
            .freed
            .then(|| Influence::of_faces(body, shears, eta, z, [body.half - eta, body.half + eta]));
        let correction = loaded.gamma.map(|gamma| {
            let [near, far] = [body.half - eta, body.half + eta].map(|s| transition(s, z, gamma));
            let share = near + body.parity.sign() * far;
            (Influence::of_surface(body, lowest, shears, body.half, z), share)
        });
        let plate = body.end.freed.then(|| PlateAt {
            kernels: waves.central.then(|| (loaded.plates.at(loaded.stack, waves, eta), part)),
            phases: body.plate_phases(z),
        });
        Self {
            body,
            loads,
            eta,
            behind: y < 0.0,
            surface: Influence::of_surface(body, lowest, shears, eta, z),
            faces,
            correction,
            plate,
            under: (body.along.is_some() && z < UNDER_SURFACE)
                .then(|| Influence::of_surface(body, lowest, shears, eta, UNDER_SURFACE)),
            central: waves.central,
            stresses: BlockStress::default(),
            traction: Default::default(),
            scratch: Vec::new(),
        }
    }

    /// Number of loads on the end faces.
    fn on_faces(&self) -> usize {
        self.faces.iter().flatten().map(Influence::len).sum()
    }

    /// Number of all loads.
    fn loads(&self) -> usize {
        let on_end = self.correction.as_ref().map_or(0, |c| c.0.len());
        self.surface.len() + on_end + self.on_faces()
    }

    /// Adds the amplitudes `own` of this part to `sum`, on the point's side of the body's middle.
    fn add_to(&self, sum: &mut [f64; 6], own: [f64; 6]) {
        add_side(self.body, self.behind, sum, own);
    }

    /// Sums the loads of the [`WAVES`] wavenumbers from number `first` on.
    fn sum_block(&mut self, first: usize) {
        let (body, scratch) = (self.body, &mut self.scratch);
        let loads = (body, &*body.kernel);
        let wanted = if self.central { Wanted::PLAIN } else { Wanted::ALL };
        let block = &self.loads.blocks[first / WAVES];
        self.stresses.surface = self.surface.stresses(loads, block, wanted, scratch);
        if let Some((end, _)) = &self.correction {
            self.stresses.end = end.stresses(loads, block, wanted, scratch);
        }
        if let Some(faces) = self.faces.as_ref().filter(|_| first < self.loads.ends) {
            let on = |f: &Influence| f.stresses(loads, block, wanted, scratch);
            self.stresses.faces = faces.each_ref().map(on);
        }
    }

    /// [`PartTarget::sum_block`] of the loads under the traction. In the plane x = 0 all but the
    /// shears vanish.
    fn sum_traction(&mut self, first: usize, along: &WaveTable, loads: &TractionLoads) {
        let (body, scratch) = (self.body, &mut self.scratch);
        let wanted = if self.central { Wanted::SHEARS } else { Wanted::ALL };
        let block = &loads.own[first / WAVES];
        let surface = self.under.as_ref().unwrap_or(&self.surface);
        let [own, freeing] = &mut self.traction;
        own.surface = surface.stresses((body, along), block, wanted, scratch);
        if let Some((end, _)) = self.correction.as_ref().filter(|_| wanted.plain) {
            own.end = end.stresses((body, along), block, wanted, scratch);
        }
        if let Some(faces) = self.faces.as_ref().filter(|_| first < self.loads.ends) {
            let (pressed, block) = ((body, &*body.kernel), &loads.freeing[first / WAVES]);
            freeing.surface = self.surface.stresses(pressed, block, wanted, scratch);
            let on = |f: &Influence| f.stresses(pressed, block, wanted, scratch);
            freeing.faces = faces.each_ref().map(on);
        }
    }

    /// [`PartTarget::amplitudes`] under the traction.
    fn traction_amplitudes(&mut self, i: usize) -> [f64; 6] {
        let (Some(along), Some(loads)) = (&self.body.along, &self.loads.traction) else {
            return [0.0; 6];
        };
        let wave = i % WAVES;
        if wave == 0 {
            self.sum_traction(i, along, loads);
        }
        let [own, freeing] = &self.traction;
        let mut amplitudes = in_body(&own.surface[wave].0);
        if let Some((_, share)) = &self.correction {
            amplitudes[1] -= own.end[wave].0.ww * share;
        }
        if self.body.end.freed && i < self.loads.ends {
            let mut pressed = in_body(&freeing.surface[wave].0);
            self.add_faces(i, &freeing.faces, &loads.plate[i], &mut pressed);
            // These loads are sin(k x): a quarter of a wave behind, where their shears are - cos(k
            // x).
            for (component, (sum, own)) in amplitudes.iter_mut().zip(pressed).enumerate() {
                *sum += if StressTensor::ODD_IN_X[component] { -own } else { own };
            }
        }
        amplitudes
    }

    /// Amplitudes of the six components at wavenumber number `i`, on the side y > 0 of the body's
    /// middle.
    fn amplitudes(&mut self, i: usize, work: &mut Work) -> [f64; 6] {
        let wave = i % WAVES;
        if wave == 0 {
            self.sum_block(i);
        }
        let (stress, mut done) = self.stresses.surface[wave];
        let mut amplitudes = in_body(&stress);
        if let Some((_, share)) = &self.correction {
            let (on_end, count) = self.stresses.end[wave];
            amplitudes[1] -= on_end.ww * share;
            done += count;
        }
        let loaded_ends = self.body.end.freed && i < self.loads.ends;
        if loaded_ends {
            done += self.add_faces(i, &self.stresses.faces, &self.loads.plate[i], &mut amplitudes);
        }
        let ends = if loaded_ends { 0 } else { self.on_faces() };
        work.done += done as u64;
        work.ends += ends as u64;
        work.beyond_reach += (self.loads() - ends - done) as u64;
        amplitudes
    }

    /// Adds the stresses of the loads on either of the end `faces` and of the plate's remainder
    /// under their `transform`; returns the number of loads within reach.
    fn add_faces(
        &self,
        i: usize,
        faces: &[[(WaveStress, usize); WAVES]; 2],
        transform: &[f64],
        amplitudes: &mut [f64; 6],
    ) -> usize {
        let mut done = 0;
        for (face, into) in faces.iter().zip(INTO_FACES) {
            let (s, count) = face[i % WAVES];
            amplitudes.iter_mut().zip(from_face(&s, into)).for_each(|(a, f)| *a += f);
            done += count;
        }
        if let Some(PlateAt { kernels, phases }) = &self.plate {
            let plate = match kernels {
                Some((kernels, part)) => Body::plate_stress(&kernels[*part][i], transform, phases),
                None => {
                    let kernel = self.body.plate_kernel(&self.loads.plate_waves[i], self.eta);
                    Body::plate_stress(&kernel, transform, phases)
                }
            };
            amplitudes.iter_mut().zip(plate).for_each(|(a, p)| *a += p);
        }
        done
    }
}

/// The distance of `y`, from the middle of a `body`, from that middle. A distance from the face of
/// the size of rounding has no quadrature.
pub(super) fn off_middle(body: &Body, y: f64) -> f64 {
    match y.abs() {
        eta if body.half - eta < ON_FACE * body.half => body.half,
        eta => eta,
    }
}

/// Adds the amplitudes `own` of a part of the loads on a `body` to `sum`, on the other side of its
/// middle if the point lies `behind` it.
pub(super) fn add_side(body: &Body, behind: bool, sum: &mut [f64; 6], own: [f64; 6]) {
    let sign = if behind { body.parity.sign() } else { 1.0 };
    for (component, (sum, own)) in sum.iter_mut().zip(own).enumerate() {
        let turned = behind && StressTensor::ODD_IN_Y[component];
        *sum += if turned { -sign * own } else { sign * own };
    }
}

/// The direction of y into the body at its end faces at +H and at -H.
pub(super) const INTO_FACES: [f64; 2] = [-1.0, 1.0];

/// The components of a load on an end face in the body's axes; `into` is one of [`INTO_FACES`].
pub(super) fn from_face(stress: &WaveStress, into: f64) -> [f64; 6] {
    let WaveStress { xx, ww, dd, xw, xd, wd } = *stress;
    [xx, dd, ww, into * xd, xw, into * wd]
}

/// Adds a wave of these `amplitudes` to the components of a stress: the shears xy and xz times
/// `shears`, all others times `others`.
pub(super) fn add_wave(sum: &mut [f64; 6], amplitudes: &[f64; 6], others: f64, shears: f64) {
    for (i, (s, a)) in sum.iter_mut().zip(amplitudes).enumerate() {
        *s += a * if StressTensor::ODD_IN_X[i] { shears } else { others };
    }
}

/// The components of a load on the surface in the body's axes.
pub(super) fn in_body(stress: &WaveStress) -> [f64; 6] {
    let WaveStress { xx, ww, dd, xw, xd, wd } = *stress;
    [xx, ww, dd, xw, xd, wd]
}
