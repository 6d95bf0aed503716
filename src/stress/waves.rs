//! The loads of all wavenumbers on the superposed bodies, and their influence on a target.

use crate::base::{Panels, Parity};
use crate::body::stencil::Stencil;
use crate::body::{Body, Layer, Stack};
use crate::kernels::line_load::WaveStress;
use crate::kernels::plate::Remainder;
use crate::kernels::wave::{Places, SurfaceSpread, WAVES, Wanted, WaveTable, add_surface_spread};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;
use std::ops::AddAssign;

/// The loads of all wavenumbers.
#[derive(Debug, Clone)]
pub(super) struct Waves {
    /// The wavenumbers, ascending.
    pub k: Vec<f64>,
    /// Factors of their stresses: the quadrature's weights, unless the loads include them, over pi.
    pub weights: Vec<f64>,
    /// Contact pressure at the contact's nodes, a row for each wavenumber.
    pub contact: DMatrix<f64>,
    /// Whether they are valid for the plane x = 0 only, where what is odd in x vanishes.
    pub central: bool,
    /// The quadrature of the long waves, which come first.
    pub long: LongQuadrature,
    /// The loads of each part of the pressure, in the order of [`Stack::parts`].
    pub parts: Vec<PartLoads>,
}

/// The quadrature over the first panel of wavenumbers, for points beside the plane x = 0. Stresses
/// tend to a limit for long waves, and those at a few wavenumbers are interpolated; loads grow
/// without a limit, and what is left of them in a stress would be the interpolation's error.
#[derive(Debug, Clone, Default)]
pub(super) struct LongQuadrature {
    /// The wavenumbers of the quadrature, and their weights over pi.
    pub nodes: Vec<(f64, f64)>,
    /// The shares in each of them of the first waves' stresses.
    pub shares: Vec<Vec<f64>>,
}

impl LongQuadrature {
    /// Number of the first waves, whose stresses are interpolated.
    pub fn count(&self) -> usize {
        self.shares.first().map_or(0, Vec::len)
    }

    /// Factors of the first waves' stresses at `x`, of those with cos(k x) and those with sin(k x).
    pub fn factors(&self, x: f64) -> Vec<[f64; 2]> {
        let mut factors = vec![[0.0; 2]; self.count()];
        for ((k, weight), shares) in self.nodes.iter().zip(&self.shares) {
            let (sin, cos) = (k * x).sin_cos();
            for (factor, share) in factors.iter_mut().zip(shares) {
                factor[0] += weight * share * cos;
                factor[1] += weight * share * sin;
            }
        }
        factors
    }
}

/// The loads of one part of the pressure, even or odd about the body's middle.
#[derive(Debug, Clone)]
pub(super) struct PartLoads {
    /// Number of leading wavenumbers for which the end faces carry loads.
    pub ends: usize,
    /// The loads in blocks of [`WAVES`] wavenumbers.
    pub blocks: Vec<LoadBlock>,
    /// Transform of q for the plate, and the plate's remainder at its wavenumbers.
    pub plate: Vec<Vec<f64>>,
    pub plate_waves: Vec<Vec<Remainder>>,
    /// The loads under the pressure as a traction along x instead; none where the contact carries
    /// none.
    pub traction: Option<TractionLoads>,
}

/// The loads under a traction along x, in the form of [`PartLoads`].
#[derive(Debug, Clone)]
pub(super) struct TractionLoads {
    /// The traction itself, on the surface.
    pub own: Vec<LoadBlock>,
    /// The pressures that free the end faces of its normal stress, see
    /// [`crate::body::FreeEnds`].
    pub freeing: Vec<LoadBlock>,
    /// Transform of these on the end faces, for the plate.
    pub plate: Vec<Vec<f64>>,
}

/// The loads of some wavenumbers, in single precision, as the kernels' tables are.
#[derive(Debug, Clone)]
pub(super) struct LoadBlock {
    surface: Loads,
    face: Loads,
    /// Mean of P over the body's length.
    mean: [f32; WAVES],
}

/// The loads of a [`LoadBlock`] on a surface or on the end faces.
#[derive(Debug, Clone)]
struct Loads {
    /// The wavenumbers; infinite, and so without effect, beyond the last with a load.
    k: [f64; WAVES],
    /// Loads at the axis's nodes, and their charges.
    values: Vec<[f32; WAVES]>,
    charges: Vec<[f32; WAVES]>,
}

impl Loads {
    /// The loads of the wavenumbers from number `first`; only the wavenumbers `k` have loads.
    /// `values` and `charges` have a row for each wavenumber.
    fn new(first: usize, k: &[f64], values: &DMatrix<f64>, charges: &DMatrix<f64>) -> Self {
        let rows = |matrix: &DMatrix<f64>| {
            let columns = matrix.column_iter();
            columns.map(|column| block(first, column.as_slice()).map(|v| v as f32)).collect()
        };
        let carried = block(first, k);
        Self {
            k: carried.map(|k| if k > 0.0 { k } else { f64::INFINITY }),
            values: rows(values),
            charges: rows(charges),
        }
    }
}

/// The elements of `all` from number `first`, filled with zeros.
fn block(first: usize, all: &[f64]) -> [f64; WAVES] {
    std::array::from_fn(|wave| all.get(first + wave).copied().unwrap_or(0.0))
}

impl Waves {
    /// The loads at the wavenumbers `k` for the transforms `contact` of the contact pressure.
    /// `shares` gives for each of them the first of the layers in its interpolation, and the
    /// shares. Without `weights` the quadrature is in `contact`, and the loads are valid for the
    /// plane x = 0.
    pub fn new<S: AsRef<[f64]>>(
        stack: &Stack,
        k: Vec<f64>,
        weights: Option<&[f64]>,
        contact: DMatrix<f64>,
        shares: impl Fn(usize) -> (usize, S),
    ) -> Self {
        let shares: Vec<_> = (0..k.len()).map(shares).collect();
        let parts = stack.parts().iter().map(|(body, layers)| {
            let own = stack.fold.part(body.parity, &contact);
            match stack.grown(body, &k, &shares) {
                Some(grown) => PartLoads::new(body, &k, &own, layers, &grown),
                None => PartLoads::new(body, &k, &own, layers, &shares),
            }
        });
        Self {
            weights: match weights {
                Some(weights) => weights.iter().map(|w| w / PI).collect(),
                None => vec![1.0 / PI; k.len()],
            },
            central: weights.is_none(),
            long: LongQuadrature::default(),
            parts: parts.collect(),
            k,
            contact,
        }
    }
}

impl PartLoads {
    /// The loads at the wavenumbers `k` under a part of the pressure, see [`Waves::new`].
    fn new<S: AsRef<[f64]>>(
        body: &Body,
        k: &[f64],
        contact: &DMatrix<f64>,
        layers: &[Layer],
        shares: &[(usize, S)],
    ) -> Self {
        // The layers with loads on their end faces come first, and so do the wavenumbers between
        // them.
        let ends = shares.iter().take_while(|(first, _)| layers[*first].ends.is_some()).count();
        let transforms = |face: &DMatrix<f64>| {
            let waves = k.iter().zip(face.column_iter()).take(ends);
            waves.map(|(k, q)| body.plate_transform(*k, q.as_slice())).collect::<Vec<_>>()
        };
        let loads = |under| nodal_loads(body, contact, layers, shares, under);
        let (surface, face) = loads(Under::Pressure);
        let traction = body.along.as_ref().map(|_| {
            let own = contact_loads(body, contact);
            let (surface, face) = loads(Under::Traction);
            TractionLoads {
                own: blocks(body, (k, 0), &own, &DMatrix::zeros(body.face.axis.len(), k.len())),
                freeing: blocks(body, (k, ends), &surface, &face),
                plate: transforms(&face),
            }
        });
        let plate = transforms(&face);
        let plate_waves = k.iter().take(ends).map(|k| body.plate_waves(*k)).collect();
        let blocks = blocks(body, (k, ends), &surface, &face);
        Self { ends, blocks, plate, plate_waves, traction }
    }
}

/// The loads in blocks, from those on the surface and on the end faces at the wavenumbers `k`, a
/// column for each; the end faces carry loads at the first `ends` of them.
pub(super) fn blocks(
    body: &Body,
    (k, ends): (&[f64], usize),
    surface: &DMatrix<f64>,
    face: &DMatrix<f64>,
) -> Vec<LoadBlock> {
    let (surface, face) = (surface.transpose(), face.transpose());
    let charges = [body.surface.charges(&surface), body.face.charges(&face)];
    let total = &surface * DVector::from_column_slice(body.surface.axis.weights());
    let means = total / body.half;
    let blocks = (0..k.len()).step_by(WAVES).map(|first| LoadBlock {
        surface: Loads::new(first, k, &surface, &charges[0]),
        face: Loads::new(first, &k[..ends], &face, &charges[1]),
        mean: block(first, means.as_slice()).map(|mean| mean as f32),
    });
    blocks.collect()
}

/// What acts on the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Under {
    Pressure,
    /// The same along x.
    Traction,
}

/// The transforms `contact` at the nodes of the surface, a column for each wavenumber.
fn contact_loads(body: &Body, contact: &DMatrix<f64>) -> DMatrix<f64> {
    let mut surface = DMatrix::zeros(body.surface.axis.len(), contact.nrows());
    surface.rows_range_mut(body.contact()).copy_from(&contact.transpose());
    surface
}

/// The pressures at the nodes of the surface and of the end faces, a column for each wavenumber,
/// `under` the transforms `contact`; see [`Waves::new`].
fn nodal_loads<S: AsRef<[f64]>>(
    body: &Body,
    contact: &DMatrix<f64>,
    layers: &[Layer],
    shares: &[(usize, S)],
    under: Under,
) -> (DMatrix<f64>, DMatrix<f64>) {
    let mut surface = DMatrix::zeros(body.surface.axis.len(), shares.len());
    let mut face = DMatrix::zeros(body.face.axis.len(), shares.len());
    for (at, layer) in layers.iter().enumerate() {
        let on_face = layer.ends.as_ref().and_then(|ends| match under {
            Under::Pressure => Some((&ends.face, &ends.from_face)),
            Under::Traction => Some((ends.under_traction.as_ref()?, &ends.from_face)),
        });
        if on_face.is_none() && under == Under::Traction {
            continue;
        }
        // The wavenumbers interpolated from a layer are consecutive.
        let end = |(first, shares): &(usize, S)| first + shares.as_ref().len();
        let start = shares.partition_point(|s| end(s) <= at);
        let waves = start..shares.partition_point(|s| s.0 <= at);
        let p = DMatrix::from_fn(contact.ncols(), waves.len(), |node, i| {
            let (first, shares) = &shares[start + i];
            shares.as_ref()[at - first] * contact[(start + i, node)]
        });
        if under == Under::Pressure {
            surface.view_range_mut(body.contact(), waves.clone()).add_assign(&p);
        }
        if let Some((on_face, from_face)) = on_face {
            let q = on_face * p;
            surface.columns_range_mut(waves.clone()).gemm(-1.0, from_face, &q, 1.0);
            // For short waves the deep nodes of an end face carry no load.
            face.view_range_mut(..q.nrows(), waves).add_assign(&q);
        }
    }
    (surface, face)
}

/// Whether shears are ever wanted: in the plane x = 0 those of a traction alone.
pub(super) fn shears(body: &Body, waves: &Waves) -> bool {
    !waves.central || body.along.is_some()
}

/// The influence of the loads on a body's surface or end face on a target.
#[derive(Debug, Clone)]
pub(super) struct Influence {
    side: Side,
    stencil: Stencil,
    /// Weights of the mean load on strips, which come last.
    strips: Vec<f32>,
    target: Position,
}

/// The loaded side.
#[derive(Debug, Clone, Copy)]
enum Side {
    /// The surface z = 0.
    Surface,
    /// The end faces.
    Face,
}

/// The position of the target.
#[derive(Debug, Clone)]
enum Position {
    /// Within the body, with the loads at these positions.
    Within(Places),
    /// On the loaded surface itself: the loads' offsets, and the shares of the axis's nodes at the
    /// target.
    Upon(Vec<f32>, Vec<(usize, f64)>),
}

impl Influence {
    /// P on z = 0 and its images, from (`y`, `z`), at wavenumbers from the `lowest` on, for all
    /// stresses or for those without `shears`.
    pub fn of_surface(body: &Body, lowest: f64, shears: bool, y: f64, z: f64) -> Self {
        let mut strips = Vec::with_capacity(body.most_strips());
        body.for_strips(lowest, y, z, |u, w| strips.push((u, w as f32)));
        let (stencil, axis) = (body.surface_stencil(y, z), &body.surface.axis);
        let mut own = Self::new(Side::Surface, stencil, &strips, axis, y, z, shears);
        // In the body's middle, where the line's halves meet, the mean of an odd load is zero.
        if let (Position::Upon(_, shares), Parity::Odd) = (&mut own.target, body.parity)
            && y.abs() <= axis.rounding()
        {
            shares.clear();
        }
        own
    }

    /// q on the end faces at +H and -H, `depths` from them, from (`y`, `z`).
    pub fn of_faces(body: &Body, shears: bool, y: f64, z: f64, depths: [f64; 2]) -> [Self; 2] {
        let [near, far] = body.face_stencils(y, z);
        [(near, depths[0]), (far, depths[1])].map(|(stencil, depth)| {
            Self::new(Side::Face, stencil, &[], &body.face.axis, z, depth, shears)
        })
    }

    /// The loads on `side` from `stencil` and `strips` (offset, weight), for a target at the
    /// coordinate `along` their `axis` and a `depth`.
    fn new(
        side: Side,
        mut stencil: Stencil,
        strips: &[(f64, f32)],
        axis: &Panels,
        along: f64,
        depth: f64,
        shears: bool,
    ) -> Self {
        let mut offsets = stencil.take_offsets();
        offsets.extend(strips.iter().map(|(u, _)| u));
        let target = if depth > 0.0 {
            Position::Within(Places::new(offsets, depth, shears))
        } else {
            let shares = axis.load_interpolation(along).collect();
            Position::Upon(offsets.iter().map(|u| *u as f32).collect(), shares)
        };
        Self { side, stencil, strips: strips.iter().map(|(_, w)| *w).collect(), target }
    }

    /// Number of loads.
    pub fn len(&self) -> usize {
        match &self.target {
            Position::Within(places) => places.len(),
            Position::Upon(offsets, _) => offsets.len(),
        }
    }

    /// The `wanted` stresses of each wavenumber of `block`, loads of `kernel` on this `body`, in
    /// the frame of the loaded surface, and the number of loads within its reach. `loads` is
    /// scratch space.
    pub fn stresses(
        &self,
        (body, kernel): (&Body, &WaveTable),
        block: &LoadBlock,
        wanted: Wanted,
        loads: &mut Vec<[f32; WAVES]>,
    ) -> [(WaveStress, usize); WAVES] {
        let own = match self.side {
            Side::Surface => &block.surface,
            Side::Face => &block.face,
        };
        // In units of 1/k all wavenumbers have the same reach; the first one is the smallest. The
        // margin covers rounding.
        let reach = body.reach(1.0);
        let limit = (1.0001 * reach / own.k[0]) as f32;
        loads.resize(self.len(), [0.0; WAVES]);
        let (sources, strips) = loads.split_at_mut(self.len() - self.strips.len());
        for (load, w) in strips.iter_mut().zip(&self.strips) {
            *load = block.mean.map(|mean| w * mean);
        }
        match &self.target {
            Position::Within(places) => {
                let distances = places.distances();
                self.stencil.gather(&own.values, &own.charges, distances, limit, sources);
                kernel.sum(&own.k, places, reach, loads, wanted)
            }
            Position::Upon(offsets, shares) => {
                self.stencil.gather(&own.values, &own.charges, offsets, limit, sources);
                upon(body.nu, own, offsets, shares, reach, loads)
            }
        }
    }
}

/// On the loaded surface: under a pressure p(u) the stresses are xx = -2 nu p - (1 - 2 nu) s, ww =
/// -p + (1 - 2 nu) s, dd = -p and xw = (1 - 2 nu) t, with s and t from [`add_surface_spread`];
/// `shares` of the nodes give p at the target.
fn upon(
    nu: f64,
    own: &Loads,
    offsets: &[f32],
    shares: &[(usize, f64)],
    reach: f64,
    loads: &[[f32; WAVES]],
) -> [(WaveStress, usize); WAVES] {
    let single = own.k.map(|k| k as f32);
    let mut sums = SurfaceSpread::default();
    for (u, loads) in offsets.iter().zip(loads) {
        add_surface_spread(&single, *u, reach as f32, loads, &mut sums);
    }
    let free = 1.0 - 2.0 * nu;
    std::array::from_fn(|wave| {
        let p: f64 = shares.iter().map(|(j, w)| w * f64::from(own.values[*j][wave])).sum();
        let [spread, shear] = [sums.even, sums.odd].map(|s| free * f64::from(s[wave]));
        let stress = WaveStress {
            xx: -2.0 * nu * p - spread,
            ww: spread - p,
            dd: -p,
            xw: shear,
            ..WaveStress::default()
        };
        (stress, sums.counts[wave] as usize)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{EdgeModel, LoadedLine, Placed, Resolution, Shape};

    #[test]
    fn a_block_sums_its_wavenumbers_independently() {
        // The last wavenumbers lie between layers of which first some, then none have loads on
        // their ends.
        for (ledge, everywhere) in [(1.2, true), (6.0, false)] {
            compare(ledge, everywhere);
        }
    }

    fn compare(ledge: f64, everywhere: bool) {
        let resolution = Resolution::for_tolerance(1e-2);
        let shape = Shape { half: 5.0 + ledge, nu: 0.3 };
        let numbers = resolution.wavenumbers(shape.half, Parity::Even).resolving(1.0);
        let line = resolution.contact_axis(5.0);
        let end = EdgeModel::QuarterSpace.end(0.3, None);
        let stack = Stack::new(
            LoadedLine { axis: &line, symmetric: true, slides: false },
            Placed { middle: 0.0, shape, end },
            &resolution,
            numbers.coarse(),
        );
        let (body, layers) = &stack.parts()[0];
        let (k, weights) = (numbers.fine().to_vec(), numbers.weights());
        let loads = DMatrix::from_fn(k.len(), line.len(), |i, j| 1.0 + ((3 * i + j) % 5) as f64);
        let all = Waves::new(&stack, k.clone(), Some(weights), loads.clone(), |i| {
            numbers.interpolation(i)
        });
        let ends = all.parts[0].ends;
        assert!(ends > 0);
        assert_eq!(ends == k.len(), everywhere);
        for i in ends..k.len() {
            let (first, shares) = numbers.interpolation(i);
            assert!(layers[first..first + shares.len()].iter().all(|layer| layer.ends.is_none()));
        }
        assert!(layers[layers.len() - 1].ends.is_none());
        let mut scratch = Vec::new();
        for (y, z) in [(body.half - 0.1, 0.3), (4.9, 0.0), (body.half, 0.2)] {
            let influences = |waves: &Waves| {
                let shears = shears(body, waves);
                let faces = Influence::of_faces(body, shears, y, z, [body.half - y, body.half + y]);
                let surface = Influence::of_surface(body, waves.k[0], shears, y, z);
                [vec![surface], faces.into()].concat()
            };
            let own = influences(&all);
            for (i, &k) in k.iter().enumerate() {
                let one = Waves::new(
                    &stack,
                    vec![k],
                    Some(&weights[i..=i]),
                    loads.rows(i, 1).into_owned(),
                    |_| numbers.interpolation(i),
                );
                for (influence, alone) in own.iter().zip(influences(&one)) {
                    let loads = (body, &*body.kernel);
                    let block = &all.parts[0].blocks[i / WAVES];
                    let together = influence.stresses(loads, block, Wanted::ALL, &mut scratch);
                    let (got, count) = together[i % WAVES];
                    let block = &one.parts[0].blocks[0];
                    let (want, alone) = alone.stresses(loads, block, Wanted::ALL, &mut scratch)[0];
                    let values = |s: WaveStress| [s.xx, s.ww, s.dd, s.xw, s.xd, s.wd];
                    for (got, want) in values(got).into_iter().zip(values(want)) {
                        assert!((got - want).abs() < 1e-5 * (1.0 + want.abs()), "{i} at {y}, {z}");
                    }
                    assert_eq!(count, alone, "{i} at {y}, {z}");
                }
            }
        }
    }
}
