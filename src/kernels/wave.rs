//! Stresses of line loads that vary as cos(k x) along their line, tabulated; the conventions and
//! the closed forms are those of [`crate::kernels::line_load`].

use super::bessel_table::to_powers;
use super::line_load::{WaveStress, exact_apart, near, near_along};
use super::patches::{CEILING, FLOOR, STRESS, WW};
use multiversion::{multiversion, target::target_cfg_f};
use std::sync::{Arc, Mutex};

/// The way in which a line load acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Into the surface, [`super::line_load::exact`].
    Into,
    /// Along its line, [`super::line_load::exact_along`].
    Along,
    /// Across its line, away from it on either side, [`super::line_load::exact_apart`].
    Apart,
}

/// The line loads of one direction in one material, tabulated: with lengths in units of 1/k the six
/// stresses times rho are smooth functions of rho and of the angle, interpolated by polynomials on
/// patches, with rows of patches in octaves of rho. Absolute error of rho times a stress below
/// 6e-5, of [`WaveTable::ww`] below 2e-5 (checked against the closed forms), at less than a tenth
/// of its time.
#[derive(Debug, Clone)]
pub struct WaveTable {
    direction: Direction,
    nu: f64,
    /// xx, ww, dd and wd: of loads into the surface all stresses that do not vanish in the plane of
    /// symmetry x = 0.
    even: Vec<Patch>,
    /// xw and xd.
    odd: Vec<OddPatch>,
    /// ww alone, more accurately, for the matrices of the end faces.
    ww: Vec<WwPatch>,
}

/// Monomial coefficients of some stresses: for each power of the radial coordinate a vector of
/// [power of the angular one][stress].
///
/// In single precision, whose rounding is below the interpolation error: memory access limits the
/// speed of a look-up.
type Patch = [[f32; LANES]; STRESS.order];
type OddPatch = [[f32; ODD_LANES]; STRESS.order];

/// Monomial coefficients of ww: for each power of the radial coordinate a vector over those of the
/// angular one, filled up with zeros.
type WwPatch = [[f64; WW_LANES]; WW.order];
const WW_LANES: usize = 8;

/// Stresses that are looked up together: those that are even in the distance along the line, and
/// those that are odd.
const EVEN: usize = 4;
const ODD: usize = 2;
const LANES: usize = EVEN * STRESS.order;
const ODD_LANES: usize = ODD * STRESS.order;

/// Number of wavenumbers summed together: their common data of a load is looked up once.
pub const WAVES: usize = 8;

/// Stresses times rho at the nodes of [`STRESS`] and of [`WW`] (ww alone), k = 1, little-endian:
/// the values for nu = 0 and their increase to nu = 1, because they are linear in nu. Evaluated by
/// the build script.
macro_rules! values {
    ($file:literal) => {
        include_bytes!(concat!(env!("OUT_DIR"), "/", $file))
    };
}
const INTO: [&[u8]; 2] = [values!("wave_stress.f32"), values!("wave_ww.f64")];
const ALONG: [&[u8]; 2] = [values!("along_stress.f32"), values!("along_ww.f64")];
const APART: [&[u8]; 2] = [values!("apart_stress.f32"), values!("apart_ww.f64")];

/// Calls `add` with the monomial coefficients [radial][angular] of each patch of `C` functions,
/// whose `values` are given in the order of [`super::patches::Fineness::places`].
fn interpolate<const N: usize, const C: usize>(
    values: impl Iterator<Item = [f64; C]>,
    mut add: impl FnMut([[[f64; C]; N]; N]),
) {
    let inverse = to_powers::<N>();
    let mut values = values.peekable();
    while values.peek().is_some() {
        // One direction after the other.
        let mut half_way = [[[0.0; C]; N]; N];
        for i in 0..N {
            for j in 0..N {
                let value = values.next().expect("whole patches");
                for (a, row) in half_way.iter_mut().enumerate() {
                    for (sum, v) in row[j].iter_mut().zip(value) {
                        *sum += inverse[(a, i)] * v;
                    }
                }
            }
        }
        let mut patch = [[[0.0; C]; N]; N];
        for (into, from) in patch.iter_mut().zip(&half_way) {
            for (b, coefficient) in into.iter_mut().enumerate() {
                for (j, v) in from.iter().enumerate() {
                    for (sum, v) in coefficient.iter_mut().zip(v) {
                        *sum += inverse[(b, j)] * v;
                    }
                }
            }
        }
        add(patch);
    }
}

impl WaveTable {
    /// The table for loads of a `direction` and Poisson's ratio `nu`, built once and shared.
    pub fn shared(direction: Direction, nu: f64) -> Arc<Self> {
        static TABLES: Mutex<Vec<Arc<WaveTable>>> = Mutex::new(Vec::new());
        let mut tables = TABLES.lock().unwrap_or_else(|e| e.into_inner());
        if let Some(table) = tables.iter().find(|t| (t.direction, t.nu) == (direction, nu)) {
            return table.clone();
        }
        // Limits the memory in a sweep over many materials.
        if tables.len() >= 16 {
            tables.remove(0);
        }
        let table = Arc::new(Self::new(direction, nu));
        tables.push(table.clone());
        table
    }

    /// The table for loads of a `direction` and Poisson's ratio `nu`.
    pub fn new(direction: Direction, nu: f64) -> Self {
        let [stress_values, ww_values] = match direction {
            Direction::Into => INTO,
            Direction::Along => ALONG,
            Direction::Apart => APART,
        };
        let (mut even, mut odd, mut ww) = (Vec::new(), Vec::new(), Vec::new());
        let single = |b: &[u8]| f64::from(f32::from_le_bytes(b.try_into().expect("four bytes")));
        let stresses = stress_values.chunks_exact(4 * 12).map(|place| -> [f64; 6] {
            let value = |i: usize| single(&place[4 * i..4 * i + 4]);
            std::array::from_fn(|c| value(c) + nu * value(6 + c))
        });
        interpolate::<{ STRESS.order }, 6>(stresses, |patch| {
            let single = |a: usize, b: usize, stress: usize| patch[a][b][stress] as f32;
            even.push(std::array::from_fn(|a| {
                std::array::from_fn(|i| single(a, i / EVEN, i % EVEN))
            }));
            odd.push(std::array::from_fn(|a| {
                std::array::from_fn(|i| single(a, i / ODD, EVEN + i % ODD))
            }));
        });
        let double = |b: &[u8]| f64::from_le_bytes(b.try_into().expect("eight bytes"));
        let values = ww_values
            .chunks_exact(16)
            .map(|place| [double(&place[..8]) + nu * double(&place[8..])]);
        interpolate::<{ WW.order }, 1>(values, |patch| {
            ww.push(patch.map(|row| std::array::from_fn(|b| row.get(b).map_or(0.0, |[c]| *c))));
        });
        Self { direction, nu, even, odd, ww }
    }

    /// The stresses at places so close that the table begins farther away.
    fn near(&self, k: f64, u: f64, v: f64) -> WaveStress {
        match self.direction {
            Direction::Into => near(k, self.nu, u, v),
            Direction::Along => near_along(k, self.nu, u, v),
            Direction::Apart => exact_apart(k, self.nu, u, v),
        }
    }

    /// As [`super::line_load::exact`], [`super::line_load::exact_along`] or
    /// [`super::line_load::exact_apart`].
    pub fn line_load(&self, k: f64, u: f64, v: f64) -> WaveStress {
        let mut waves = [f64::INFINITY; WAVES];
        waves[0] = k;
        let places = Places::new(vec![u], v, true);
        self.sum(&waves, &places, f64::INFINITY, &[[1.0; WAVES]], Wanted::ALL)[0].0
    }

    /// For each of the ascending wavenumbers `k`, the `wanted` stresses of the line loads at
    /// `places` closer than `reach` / k, and the number of those taken from the table. `loads`
    /// holds the loads of each place at all wavenumbers; an infinite wavenumber reaches none.
    pub fn sum(
        &self,
        k: &[f64; WAVES],
        places: &Places,
        reach: f64,
        loads: &[[f32; WAVES]],
        wanted: Wanted,
    ) -> [(WaveStress, usize); WAVES] {
        let single = k.map(|k| k as f32);
        let tables = (self.even.as_slice(), self.odd.as_slice());
        let sums = sum_loads(tables, &single, places, reach, loads, wanted);
        let mut of_waves = [(WaveStress::default(), 0); WAVES];
        for (wave, into) in of_waves.iter_mut().enumerate() {
            let [xx, ww, dd, wd] = from_powers(&sums.even[wave]);
            let [xw, xd] = from_powers(&sums.odd[wave]);
            *into = (WaveStress { xx, ww, dd, xw, xd, wd }, sums.counts[wave] as usize);
            if k[wave] * places.depth >= FLOOR {
                continue;
            }
            for ((&u, distance), loads) in places.offsets.iter().zip(&places.distances).zip(loads) {
                // The table begins farther away.
                if single[wave] * distance < FLOOR as f32 {
                    let s = self.near(k[wave], u, places.depth);
                    let (sum, load) = (&mut into.0, f64::from(loads[wave]));
                    if wanted.plain {
                        sum.xx += load * s.xx;
                        sum.ww += load * s.ww;
                        sum.dd += load * s.dd;
                        sum.wd += load * s.wd;
                    }
                    if wanted.shears {
                        sum.xw += load * s.xw;
                        sum.xd += load * s.xd;
                    }
                }
            }
        }
        of_waves
    }

    /// The stress ww alone, of a unit load at each of `places`, into `out`; none from beyond
    /// `reach`.
    pub fn ww(&self, k: f64, places: &WwPlaces, reach: f64, out: &mut Vec<f64>) {
        out.resize(places.offsets.len(), 0.0);
        ww_of_all(&self.ww, k, places, reach, out);
        for ((value, &u), distance) in out.iter_mut().zip(&places.offsets).zip(&places.distances) {
            if k * distance < FLOOR {
                *value = self.near(k, u, places.depth).ww;
            }
        }
    }
}

/// [`Places`] of [`WaveTable::ww`].
#[derive(Debug, Clone, Default)]
pub struct WwPlaces {
    offsets: Vec<f64>,
    depth: f64,
    distances: Vec<f64>,
    patches: Vec<u32>,
    factors: Vec<[f64; WW_LANES]>,
}

impl WwPlaces {
    /// As [`Places::new`].
    pub fn new(offsets: &[f64], depth: f64) -> Self {
        let mut places = Self { offsets: offsets.to_vec(), depth, ..Self::default() };
        for u in offsets {
            let distance = (u * u + depth * depth).sqrt();
            let (patch, b) = WW.direction(u.abs() / (u.abs() + depth));
            let mut power = 1.0 / distance;
            places.distances.push(distance);
            places.patches.push(patch as u32);
            places.factors.push(std::array::from_fn(|i| {
                let factor = if i < WW.order { power } else { 0.0 };
                power *= b;
                factor
            }));
        }
        places
    }
}

/// Writes the tabulated stress ww to `out`; compiled for the processor's vector units.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn ww_of_all(patches: &[WwPatch], k: f64, places: &WwPlaces, reach: f64, out: &mut [f64]) {
    let times = |a: f64, b: f64, c: f64| -> f64 {
        if target_cfg_f!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
    };
    let (floor, ceiling) = (FLOOR as f32, CEILING.min(k * reach) as f32);
    let directions = places.patches.iter().zip(&places.factors);
    for ((distance, (direction, factors)), value) in
        places.distances.iter().zip(directions).zip(out.iter_mut())
    {
        // Rounded first, so that every distance below the ceiling has a row.
        let rho = (k * distance) as f32;
        if !(floor..ceiling).contains(&rho) {
            *value = 0.0;
            continue;
        }
        let (row, a) = WW.row(rho);
        let (patch, a) = (&patches[row as usize + *direction as usize], f64::from(a));
        let mut sum = patch[WW.order - 1];
        for c in patch[..WW.order - 1].iter().rev() {
            for i in 0..WW_LANES {
                sum[i] = times(sum[i], a, c[i]);
            }
        }
        for i in 0..WW_LANES {
            sum[i] *= factors[i];
        }
        let [a, b, c, d, e, f, g, h] = sum;
        *value = ((a + b) + (c + d)) + ((e + f) + (g + h));
    }
}

/// The stresses that are summed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wanted {
    /// xx, ww, dd and wd.
    pub plain: bool,
    /// xw and xd.
    pub shears: bool,
}

impl Wanted {
    /// All six.
    pub const ALL: Wanted = Wanted { plain: true, shears: true };
    /// Without the shears.
    pub const PLAIN: Wanted = Wanted { plain: true, shears: false };
    /// The shears alone.
    pub const SHEARS: Wanted = Wanted { plain: false, shears: true };
}

/// The positions of line loads relative to a target: the data common to all wavenumbers.
#[derive(Debug, Clone, Default)]
pub struct Places {
    offsets: Vec<f64>,
    depth: f64,
    distances: Vec<f32>,
    /// First patch of the direction, in any row of patches.
    patches: Vec<u32>,
    /// Powers of the angular coordinate in the form of [`Patch`], divided by the distance, with the
    /// signs of the stresses that are odd in the offset, for [`WaveTable::even`] and
    /// [`WaveTable::odd`].
    even: Vec<[f32; LANES]>,
    odd: Vec<[f32; ODD_LANES]>,
}

impl Places {
    /// Line loads at the `offsets` target - source along the surface, of a target at `depth` > 0.
    /// The shears xw and xd of these places are summed only where they are asked for now.
    pub fn new(offsets: Vec<f64>, depth: f64, shears: bool) -> Self {
        let count = offsets.len();
        let mut places = Self {
            depth,
            distances: Vec::with_capacity(count),
            patches: Vec::with_capacity(count),
            even: Vec::with_capacity(count),
            odd: Vec::with_capacity(if shears { count } else { 0 }),
            offsets: Vec::new(),
        };
        for &u in &offsets {
            let distance = (u * u + depth * depth).sqrt();
            let (patch, b) = STRESS.direction(u.abs() / (u.abs() + depth));
            let (b, inverse) = (b as f32, (1.0 / distance) as f32);
            let powers = [inverse, inverse * b, inverse * b * b, inverse * b * b * b];
            let sign = if u < 0.0 { -1.0 } else { 1.0 };
            places.distances.push(distance as f32);
            places.patches.push(patch as u32);
            let signs = [1.0, 1.0, 1.0, sign];
            places.even.push(std::array::from_fn(|i| powers[i / EVEN] * signs[i % EVEN]));
            if shears {
                let signs = [sign, 1.0];
                places.odd.push(std::array::from_fn(|i| powers[i / ODD] * signs[i % ODD]));
            }
        }
        places.offsets = offsets;
        places
    }

    /// Number of loads.
    pub fn len(&self) -> usize {
        self.offsets.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.offsets.is_empty()
    }

    /// Distance of each load.
    pub fn distances(&self) -> &[f32] {
        &self.distances
    }
}

/// Sums for the stresses on a half-space's surface beside line loads, for each of some wavenumbers.
#[derive(Debug, Clone, Copy, Default)]
pub struct SurfaceSpread {
    /// Sums of (k / 2) e^(-k |u|) times a load.
    pub even: [f32; WAVES],
    /// The same with the sign of u.
    pub odd: [f32; WAVES],
    /// Numbers of loads.
    pub counts: [u32; WAVES],
}

/// Adds the effect of line loads at the offset `u` to `sums`, for each of the wavenumbers `k` below
/// `reach` / |u|. J and N of [`super::bessel::incomplete`] at v = 0 are (pi/2) e^-u.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
pub fn add_surface_spread(
    k: &[f32; WAVES],
    u: f32,
    reach: f32,
    loads: &[f32; WAVES],
    sums: &mut SurfaceSpread,
) {
    let sign = if u == 0.0 { 0.0 } else { u.signum() };
    for wave in 0..WAVES {
        let rho = k[wave] * u.abs();
        let spread = loads[wave] * 0.5 * k[wave] * fade(rho.min(reach));
        let spread = if rho < reach { spread } else { 0.0 };
        sums.even[wave] += spread;
        sums.odd[wave] += sign * spread;
        sums.counts[wave] += u32::from(rho < reach);
    }
}

/// e^(-x) for 0 <= x < 80, relative error below 3e-7: 2^n times the series of 2^r, |r| <= 1/2.
#[inline(always)]
fn fade(x: f32) -> f32 {
    let exponent = -std::f32::consts::LOG2_E * x;
    // Adding 3 * 2^22 rounds to an integer, which then stands in the last digits.
    const ROUND: f32 = 12_582_912.0;
    let rounded = exponent + ROUND;
    let t = std::f32::consts::LN_2 * (exponent - (rounded - ROUND));
    let power = f32::from_bits((rounded.to_bits().wrapping_add(127)) << 23);
    const SERIES: [f32; 7] = [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0];
    power * SERIES.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// Sums over loads for each of some wavenumbers, in the lanes of a [`Patch`] and of an
/// [`OddPatch`], and the number of loads.
#[derive(Debug, Clone, Copy)]
struct Sums {
    even: [[f32; LANES]; WAVES],
    odd: [[f32; ODD_LANES]; WAVES],
    counts: [u32; WAVES],
}

/// Sums of the tabulated stresses over the loads within the table; compiled for the processor's
/// vector units.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn sum_loads(
    (even, odd): (&[Patch], &[OddPatch]),
    k: &[f32; WAVES],
    places: &Places,
    reach: f64,
    loads: &[[f32; WAVES]],
    wanted: Wanted,
) -> Sums {
    let times = |a: f32, b: f32, c: f32| -> f32 {
        if target_cfg_f!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
    };
    let (floor, ceiling) = (FLOOR as f32, CEILING.min(reach) as f32);
    let mut sums =
        Sums { even: [[0.0; LANES]; WAVES], odd: [[0.0; ODD_LANES]; WAVES], counts: [0; WAVES] };
    for (i, (distance, direction)) in places.distances.iter().zip(&places.patches).enumerate() {
        if k[0] * distance >= ceiling {
            continue;
        }
        let (loads, factors) = (&loads[i], &places.even[i]);
        let (mut rho, mut rows, mut at) = ([0.0; WAVES], [0; WAVES], [0.0; WAVES]);
        for wave in 0..WAVES {
            rho[wave] = k[wave] * distance;
            (rows[wave], at[wave]) = STRESS.row(rho[wave]);
        }
        let odd_factors = if wanted.shears { places.odd.get(i) } else { None };
        for wave in 0..WAVES {
            if !(floor..ceiling).contains(&rho[wave]) {
                continue;
            }
            let (a, load) = (at[wave], loads[wave]);
            let patch = rows[wave] as usize + *direction as usize;
            if wanted.plain {
                add_patch(&even[patch], a, load, factors, &mut sums.even[wave], times);
            }
            if let Some(factors) = odd_factors {
                add_patch(&odd[patch], a, load, factors, &mut sums.odd[wave], times);
            }
            sums.counts[wave] += 1;
        }
    }
    sums
}

/// Adds a load to the sums over the powers of the angular coordinate: its patch at the position `a`
/// times the load's `factors`. `times` multiplies and adds.
#[inline(always)]
fn add_patch<const L: usize>(
    patch: &[[f32; L]; STRESS.order],
    a: f32,
    load: f32,
    factors: &[f32; L],
    total: &mut [f32; L],
    times: impl Fn(f32, f32, f32) -> f32,
) {
    let mut sum = patch[STRESS.order - 1];
    for c in patch[..STRESS.order - 1].iter().rev() {
        for lane in 0..L {
            sum[lane] = times(sum[lane], a, c[lane]);
        }
    }
    for lane in 0..L {
        total[lane] = times(load * factors[lane], sum[lane], total[lane]);
    }
}

/// The `S` stresses from their sums in `lanes` for each power of the angular coordinate.
fn from_powers<const S: usize, const L: usize>(lanes: &[f32; L]) -> [f64; S] {
    let mut sums = [0.0; S];
    for (lane, v) in lanes.iter().enumerate() {
        sums[lane % S] += f64::from(*v);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::super::line_load::{exact, exact_along, exact_apart};
    use super::*;
    use crate::base::Panels;
    use std::f64::consts::PI;

    /// Boussinesq's point load (Johnson 1985, Eqs. 3.19), unit force, depth along z.
    fn point_load(nu: f64, x: f64, y: f64, z: f64) -> [f64; 6] {
        let r2 = x * x + y * y;
        let big2 = r2 + z * z;
        let big = big2.sqrt();
        let f = 1.0 - 2.0 * nu;
        let a = (1.0 - z / big) / r2;
        let c = z / big.powi(3);
        let tangent = |p: f64, q: f64| {
            f * (a * (p * p - q * q) / r2 + c * q * q / r2) - 3.0 * z * p * p / big.powi(5)
        };
        [
            tangent(x, y) / (2.0 * PI),
            tangent(y, x) / (2.0 * PI),
            -3.0 * z.powi(3) / big.powi(5) / (2.0 * PI),
            (f * (a * 2.0 * x * y / r2 - c * x * y / r2) - 3.0 * x * y * z / big.powi(5))
                / (2.0 * PI),
            -3.0 * x * z * z / big.powi(5) / (2.0 * PI),
            -3.0 * y * z * z / big.powi(5) / (2.0 * PI),
        ]
    }

    /// Cerruti's point load along x (Johnson 1985, Eqs. 3.76), unit force, depth along z.
    fn point_load_along(nu: f64, x: f64, y: f64, z: f64) -> [f64; 6] {
        let big = (x * x + y * y + z * z).sqrt();
        let f = 1.0 - 2.0 * nu;
        let (cube, sum) = (big.powi(3), big + z);
        let spread = 1.0 / (cube * sum.powi(2)) + 2.0 / (big.powi(2) * sum.powi(3));
        let flat = 1.0 / (big * sum.powi(2));
        let radial = -3.0 / big.powi(5);
        [
            radial * x.powi(3) + f * x * (1.0 / cube - 3.0 * flat + x * x * spread),
            radial * x * y * y + f * x * (1.0 / cube - flat + y * y * spread),
            radial * x * z * z,
            radial * x * x * y + f * y * (x * x * spread - flat),
            radial * x * x * z,
            radial * x * y * z,
        ]
        .map(|s| s / (2.0 * PI))
    }

    #[test]
    fn waves_add_up_to_boussinesq_and_cerruti() {
        let breaks =
            (0..=90).map(|i| if i == 0 { 0.0 } else { 2f64.powf(f64::from(i - 60) / 4.0) });
        let axis = Panels::new(breaks.collect(), 10);
        for nu in [0.0, 0.3, 0.45] {
            for (x, u, v) in [(0.4, 0.3, 0.5), (0.0, -0.7, 0.4), (1.2, 0.6, 0.3), (-0.5, 0.1, 1.0)]
            {
                let (mut into, mut along, mut apart) = ([0.0; 6], [0.0; 6], [0.0; 6]);
                for (&k, w) in axis.nodes().iter().zip(axis.weights()) {
                    let (sin, cos) = (k * x).sin_cos();
                    let add = |sums: &mut [f64; 6], s: WaveStress, even: f64, odd: f64| {
                        let all = [s.xx * even, s.ww * even, s.dd * even, s.xw * odd, s.xd * odd];
                        for (g, a) in sums.iter_mut().zip(all.into_iter().chain([s.wd * even])) {
                            *g += w * a / PI;
                        }
                    };
                    add(&mut into, exact(k, nu, u, v), cos, sin);
                    add(&mut along, exact_along(k, nu, u, v), sin, cos);
                    add(&mut apart, exact_apart(k, nu, u, v), k * cos, k * sin);
                }
                // A point load along u is one along x with x and u exchanged.
                let across = |u: f64| {
                    let [uu, xx, dd, xu, ud, xd] = point_load_along(nu, u, x, v);
                    [xx, uu, dd, xu, xd, ud]
                };
                let (before, after) = (across(u - 1e-5), across(u + 1e-5));
                let pair = std::array::from_fn(|i| (before[i] - after[i]) / 2e-5);
                let known = [point_load(nu, x, u, v), point_load_along(nu, x, u, v), pair];
                let got = into.iter().chain(&along).chain(&apart);
                for (g, want) in got.zip(known.iter().flatten()) {
                    assert!((g - want).abs() < 2e-6, "nu {nu} at {x} {u} {v}: {g} {want}");
                }
            }
        }
    }

    #[test]
    fn table_equals_the_closed_forms() {
        let mut worst = [0.0; 2];
        let loads = [
            (Direction::Into, exact as fn(f64, f64, f64, f64) -> WaveStress),
            (Direction::Along, exact_along),
            (Direction::Apart, exact_apart),
        ];
        for ((direction, exact), nu) in
            loads.into_iter().flat_map(|l| [0.0, 0.3, 0.49].map(|nu| (l, nu)))
        {
            let table = WaveTable::new(direction, nu);
            for i in 0..400 {
                let rho = 1e-3 * 1.0263f64.powi(i);
                for j in 0..=40 {
                    let (sin, cos) = (PI * f64::from(j) / 40.0 - 0.5 * PI).sin_cos();
                    let (k, cos) = (0.7, cos.max(0.0));
                    let (u, v) = (rho * sin / k, rho * cos / k);
                    let (got, want) = (table.line_load(k, u, v), exact(k, nu, u, v));
                    let mut ww_alone = Vec::new();
                    table.ww(k, &WwPlaces::new(&[u], v), f64::INFINITY, &mut ww_alone);
                    let pairs = [
                        (got.xx, want.xx),
                        (got.ww, want.ww),
                        (got.dd, want.dd),
                        (got.xw, want.xw),
                        (got.xd, want.xd),
                        (got.wd, want.wd),
                        (ww_alone[0], want.ww),
                    ];
                    // A pair of forces falls with the square of the distance.
                    let scale = match direction {
                        Direction::Apart => rho.min(1.0) * rho / k,
                        _ => rho / k,
                    };
                    for (got, want) in pairs {
                        let worst: &mut f64 = match direction {
                            Direction::Apart => &mut worst[1],
                            _ => &mut worst[0],
                        };
                        *worst = worst.max((got - want).abs() * scale);
                    }
                }
            }
        }
        println!("worst {worst:?}");
        assert!(worst[0] < 6e-5 && worst[1] < 2e-4, "{worst:?}");
    }

    #[test]
    fn sums_take_each_wavenumber_by_itself() {
        let (nu, reach) = (0.3, 8.0);
        let table = WaveTable::new(Direction::Into, nu);
        // From next to the target, before the table begins, to beyond the reach.
        let offsets: Vec<f64> =
            (0..30).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 } * 1e-3 * 1.45f64.powi(i)).collect();
        let mut k: [f64; WAVES] = std::array::from_fn(|wave| 0.3 * 1.9f64.powi(wave as i32));
        k[WAVES - 1] = f64::INFINITY;
        let load = |i: usize, wave: usize| 1.0 + ((3 * i + 5 * wave) % 7) as f32;
        let loads: Vec<[f32; WAVES]> =
            (0..30).map(|i| std::array::from_fn(|wave| load(i, wave))).collect();
        let cases =
            [(1e-4, Wanted::ALL), (0.2, Wanted::ALL), (0.2, Wanted::PLAIN), (0.2, Wanted::SHEARS)];
        for (depth, wanted) in cases {
            let places = Places::new(offsets.clone(), depth, wanted.shears);
            let sums = table.sum(&k, &places, reach, &loads, wanted);
            for (wave, (got, count)) in sums.into_iter().enumerate() {
                let (mut want, mut size, mut near, mut felt) = ([0.0; 6], 0.0, 0, 0);
                for (i, &u) in offsets.iter().enumerate() {
                    let rho = k[wave] * u.hypot(depth);
                    if rho < reach {
                        let s = exact(k[wave], nu, u, depth);
                        let own = [s.xx, s.ww, s.dd, s.wd, s.xw, s.xd];
                        let load = f64::from(load(i, wave));
                        want.iter_mut().zip(own).for_each(|(sum, s)| *sum += load * s);
                        size += load * k[wave] / rho;
                        (near, felt) = (near + usize::from(rho < FLOOR), felt + 1);
                    }
                }
                if !wanted.shears {
                    (want[4], want[5]) = (0.0, 0.0);
                }
                if !wanted.plain {
                    want[..4].fill(0.0);
                }
                assert_eq!(count, felt - near, "wave {wave} at {depth}");
                let got = [got.xx, got.ww, got.dd, got.wd, got.xw, got.xd];
                for (got, want) in got.into_iter().zip(want) {
                    assert!((got - want).abs() <= 5e-5 * size, "wave {wave}: {got} {want}");
                }
            }
        }
    }

    #[test]
    fn surface_values_are_the_limit_of_small_depth() {
        let (k, nu) = (1.3, 0.3);
        for u in [0.4, -0.9, 12.0] {
            let s = exact(k, nu, u, 1e-9);
            let mut sums = SurfaceSpread::default();
            add_surface_spread(&[k as f32; WAVES], u as f32, 80.0, &[1.0; WAVES], &mut sums);
            let [spread, shear] = [sums.even, sums.odd].map(|s| (1.0 - 2.0 * nu) * f64::from(s[0]));
            assert!((s.xx + spread).abs() < 1e-5 && (s.ww - spread).abs() < 1e-5);
            assert!((s.xw - shear).abs() < 1e-5, "{} {}", s.xw, shear);
        }
        for i in 0..800 {
            let x = 0.1 * i as f32;
            let want = (-f64::from(x)).exp();
            assert!((f64::from(fade(x)) / want - 1.0).abs() < 3e-7 * f64::from(1.0 + x), "{x}");
        }
    }
}
