//! The loads of all wavenumbers on the superposed bodies, and what a target feels of them.

use crate::base::Panels;
use crate::body::stencil::{LANES, Sources, Stencil};
use crate::body::{Body, Layer};
use crate::kernels::line_load::WaveStress;
use crate::kernels::plate::Remainder;
use crate::kernels::wave::{Places, add_surface_spread};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// The loads of all wavenumbers. Matrices have a row for each of them; those that stresses are summed
/// from are in single precision, as the kernels' tables are, and are filled up with rows of zeros.
#[derive(Debug, Clone)]
pub(super) struct Waves {
    /// The wavenumbers, ascending.
    pub k: Vec<f64>,
    /// Factors of what they cause: the quadrature's weights, if the loads lack them, over pi.
    pub weights: Vec<f64>,
    /// Whether the end faces carry anything.
    pub ends: Vec<bool>,
    /// The wavenumbers in single precision.
    single: Vec<f32>,
    /// Squares of how far each wavenumber reaches.
    square_reaches: Vec<f64>,
    /// Contact pressure at the contact's nodes.
    pub contact: DMatrix<f64>,
    /// Transform of q for the plate, and the plate's remainder at its wavenumbers.
    pub plate: Vec<Vec<f64>>,
    pub plate_waves: Vec<Vec<Remainder>>,
    /// Whether they serve the plane x = 0 only, where shears that are odd in x vanish.
    central: bool,
    /// P at the surface's nodes, and its charges.
    surface: [DMatrix<f32>; 2],
    /// Mean of P over the body's length.
    mean: Vec<f32>,
    /// q at the face's nodes, and its charges.
    face: [DMatrix<f32>; 2],
}

impl Waves {
    /// The loads at the wavenumbers `k` that go with the transforms `contact` of the contact pressure.
    /// `shares` gives for each of them the first of the `layers` that it is interpolated from, and their
    /// shares. Without `weights` the quadrature is in `contact`, and the loads serve the plane x = 0.
    pub fn new<S: AsRef<[f64]>>(
        body: &Body,
        k: Vec<f64>,
        weights: Option<&[f64]>,
        contact: DMatrix<f64>,
        layers: &[Layer],
        shares: impl Fn(usize) -> (usize, S),
    ) -> Self {
        let stride = k.len().next_multiple_of(LANES);
        let mut surface = DMatrix::zeros(stride, body.surface.axis.len());
        let mut face = DMatrix::zeros(stride, body.face.axis.len());
        let (mut plate, mut plate_waves) = (Vec::new(), Vec::new());
        let mut ends = vec![false; k.len()];
        for (i, k) in k.iter().enumerate() {
            let p: DVector<f64> = contact.row(i).transpose();
            let add = |into: &mut DMatrix<f64>, part: &DVector<f64>, share: f64| {
                for (j, value) in part.iter().enumerate() {
                    into[(i, j)] += share * value;
                }
            };
            let (first, shares) = shares(i);
            let shares = layers[first..].iter().zip(shares.as_ref());
            for (layer, &share) in shares.filter(|(_, share)| **share != 0.0) {
                match &layer.surface {
                    Some(matrix) => add(&mut surface, &(matrix * &p), share),
                    None => add(&mut surface, &p, share),
                }
                if let Some(matrix) = &layer.face {
                    add(&mut face, &(matrix * &p), share);
                    ends[i] = true;
                }
            }
            let q: Vec<f64> = face.row(i).iter().copied().collect();
            plate.push(if ends[i] { body.plate_transform(*k, &q) } else { Vec::new() });
            plate_waves.push(if ends[i] { body.plate_waves(*k) } else { Vec::new() });
        }
        let total = &surface * DVector::from_column_slice(body.surface.axis.weights());
        let with_charges = |values: DMatrix<f64>, sources: &Sources| {
            let charges = sources.charges(&values).cast();
            [values.cast(), charges]
        };
        Self {
            weights: match weights {
                Some(weights) => weights.iter().map(|w| w / PI).collect(),
                None => vec![1.0 / PI; k.len()],
            },
            central: weights.is_none(),
            mean: total.iter().map(|t| (t / body.half) as f32).collect(),
            surface: with_charges(surface, &body.surface),
            face: with_charges(face, &body.face),
            single: k.iter().map(|k| *k as f32).collect(),
            square_reaches: k.iter().map(|k| body.reach(*k).powi(2)).collect(),
            k,
            ends,
            contact,
            plate,
            plate_waves,
        }
    }

    /// For each of the `offsets` from a target at `depth` how many of the wavenumbers, the first ones, reach
    /// so far.
    fn reaching(&self, offsets: &[f64], depth: f64) -> Vec<usize> {
        let count = |u: &f64| {
            let square = u * u + depth * depth;
            self.square_reaches.partition_point(|reach| square < *reach)
        };
        offsets.iter().map(count).collect()
    }
}

/// The loads on one surface of a body as a target feels them.
#[derive(Debug, Clone)]
pub(super) enum Sight {
    /// From within the body: places, and the loads, all wavenumbers of a place one after the other.
    Within(Places, Vec<f32>),
    /// From the loaded surface itself: the number of loads, the stresses for each wavenumber, and how
    /// many loads it reaches from.
    Upon(usize, Vec<(WaveStress, usize)>),
}

impl Sight {
    /// P on z = 0 and its images, from (`y`, `z`).
    pub fn of_surface(body: &Body, waves: &Waves, y: f64, z: f64) -> Self {
        let [values, charges] = &waves.surface;
        let mut stencil = body.surface_stencil(y, z);
        let mut strips = Vec::with_capacity(body.most_strips());
        body.for_strips(waves.k[0], y, z, |u, w| strips.push((u, w as f32)));
        let mut offsets = stencil.take_offsets();
        offsets.extend(strips.iter().map(|(u, _)| u));
        let wanted = waves.reaching(&offsets, z);
        let mut loads = vec![0.0; waves.mean.len() * offsets.len()];
        stencil.gather(values, charges, &wanted, &mut loads);
        let last = &mut loads[waves.mean.len() * (offsets.len() - strips.len())..];
        for (loads, (_, w)) in last.chunks_exact_mut(waves.mean.len()).zip(&strips) {
            loads.iter_mut().zip(&waves.mean).for_each(|(l, mean)| *l = w * mean);
        }
        if z > 0.0 {
            return Self::Within(Places::new(offsets, z, waves.central), loads);
        }
        Self::upon(body, waves, &offsets, &wanted, &loads, local(&body.surface.axis, values, y))
    }

    /// q on the end faces at +H and -H, `depths` from them, from (`y`, `z`).
    pub fn of_faces(body: &Body, waves: &Waves, y: f64, z: f64, depths: [f64; 2]) -> [Self; 2] {
        let [values, charges] = &waves.face;
        let [near, far] = body.face_stencils(y, z);
        [(near, depths[0]), (far, depths[1])].map(|(mut stencil, depth): (Stencil, f64)| {
            let offsets = stencil.take_offsets();
            let wanted = waves.reaching(&offsets, depth);
            let mut loads = vec![0.0; waves.mean.len() * offsets.len()];
            stencil.gather(values, charges, &wanted, &mut loads);
            if depth > 0.0 {
                return Self::Within(Places::new(offsets, depth, waves.central), loads);
            }
            Self::upon(body, waves, &offsets, &wanted, &loads, local(&body.face.axis, values, z))
        })
    }

    /// On the loaded surface: under a pressure p(u) the stresses are xx = -2 nu p - (1 - 2 nu) s,
    /// ww = -p + (1 - 2 nu) s, dd = -p and xw = (1 - 2 nu) t, with s and t those of
    /// [`add_surface_spread`]; `local` is p at the target.
    fn upon(
        body: &Body,
        waves: &Waves,
        offsets: &[f64],
        wanted: &[usize],
        loads: &[f32],
        local: Vec<f64>,
    ) -> Self {
        let (n, stride) = (waves.k.len(), waves.mean.len());
        let (mut spread, mut shear, mut counts) = (vec![0f32; n], vec![0f32; n], vec![0; n]);
        for ((u, &wanted), loads) in offsets.iter().zip(wanted).zip(loads.chunks_exact(stride)) {
            let within = 0..wanted;
            let k = &waves.single[within.clone()];
            let shear = if waves.central { &mut [][..] } else { &mut shear[within.clone()] };
            add_surface_spread(
                k,
                *u as f32,
                &loads[within.clone()],
                &mut spread[within.clone()],
                shear,
            );
            counts[within].iter_mut().for_each(|c| *c += 1);
        }
        let (nu, free) = (body.nu, 1.0 - 2.0 * body.nu);
        let stress = |i: usize| {
            let (p, spread) = (local[i], free * f64::from(spread[i]));
            WaveStress {
                xx: -2.0 * nu * p - spread,
                ww: spread - p,
                dd: -p,
                xw: free * f64::from(shear[i]),
                ..WaveStress::default()
            }
        };
        Self::Upon(offsets.len(), (0..n).map(|i| (stress(i), counts[i])).collect())
    }

    /// Number of loads.
    pub fn len(&self) -> usize {
        match self {
            Self::Within(places, _) => places.len(),
            Self::Upon(count, _) => *count,
        }
    }

    /// The stresses of wavenumber number `i`, in the frame of the loaded surface, and the number of loads
    /// that it reaches from; no shears across the plane x = 0 where only that is served.
    pub fn stress(&self, body: &Body, waves: &Waves, i: usize) -> (WaveStress, usize) {
        let (k, stride) = (waves.k[i], waves.mean.len());
        let reach = body.reach(k);
        let (places, loads) = match self {
            Self::Within(places, loads) if places.depth() < reach && !loads.is_empty() => {
                (places, &loads[i..])
            }
            Self::Within(..) => return (WaveStress::default(), 0),
            Self::Upon(_, stresses) => return stresses[i],
        };
        body.kernel.sum(k, places, reach, loads, stride)
    }
}

/// Values at `at` of functions given in rows at the nodes of `axis`; zeros beyond it.
fn local(axis: &Panels, values: &DMatrix<f32>, at: f64) -> Vec<f64> {
    let mut sums = vec![0.0; values.nrows()];
    if at <= axis.end() * (1.0 + 1e-12) {
        for (node, weight) in axis.interpolation(at) {
            let own = values.column(node);
            sums.iter_mut().zip(own.iter()).for_each(|(s, v)| *s += weight * f64::from(*v));
        }
    }
    sums
}
