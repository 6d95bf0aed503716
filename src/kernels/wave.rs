//! Stresses of line loads that vary as cos(k x) along their line, tabulated; the conventions and the
//! closed forms are those of [`crate::kernels::line_load`].

use super::bessel_table::to_powers;
use super::line_load::{WaveStress, near};
use super::patches::{CEILING, FLOOR, STRESS, WW};
use multiversion::{multiversion, target::target_cfg_f};
use std::sync::{Arc, Mutex};

/// [`super::line_load::exact`] of one material, tabulated: with lengths in units of 1/k the six stresses times
/// rho are smooth functions of rho and of the angle, interpolated by polynomials on patches, rows of
/// patches in octaves of rho. Absolute error of rho times a stress below 5e-5, of [`WaveTable::ww`]
/// below 2e-5 (checked against the closed forms), at less than a tenth of its time.
#[derive(Debug, Clone)]
pub struct WaveTable {
    nu: f64,
    /// xx, ww, dd and wd: all that a plane of symmetry x = 0 needs.
    even: Vec<Patch>,
    /// xw and xd.
    odd: Vec<Patch>,
    /// ww alone, more exactly: the faces' matrices are solved with.
    ww: Vec<WwPatch>,
}

/// Monomial coefficients of four stresses: for each power of the radial coordinate a vector of
/// [power of the angular one][stress].
///
/// In single precision, whose rounding is below the interpolation's error: a look-up is bound by
/// the memory it touches.
type Patch = [[f32; LANES]; STRESS.order];

/// Monomial coefficients of ww: for each power of the radial coordinate a vector over those of the angular
/// one, filled up with zeros.
type WwPatch = [[f64; WW_LANES]; WW.order];
const WW_LANES: usize = 8;

/// Stresses that are looked up together.
const STRESSES: usize = 4;
const LANES: usize = STRESSES * STRESS.order;

/// No stress of the six.
const NONE: usize = 6;

/// Stresses times rho at the places of [`STRESS`] and of [`WW`] (ww alone), k = 1, for nu = 0 and what
/// nu = 1 adds, in little-endian: they are linear in nu. Evaluated when the program is built.
const STRESS_VALUES: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/wave_stress.f32"));
const WW_VALUES: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/wave_ww.f64"));

/// Calls `add` with the monomial coefficients [radial][angular] of each patch of `C` functions, whose
/// `values` are given in the order of [`super::patches::Fineness::places`].
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
    /// The table for Poisson's ratio `nu`, built once for all that ask for it.
    pub fn shared(nu: f64) -> Arc<Self> {
        static TABLES: Mutex<Vec<Arc<WaveTable>>> = Mutex::new(Vec::new());
        let mut tables = TABLES.lock().unwrap_or_else(|e| e.into_inner());
        if let Some(table) = tables.iter().find(|t| t.nu == nu) {
            return table.clone();
        }
        // A sweep over many materials must not fill the memory.
        if tables.len() >= 16 {
            tables.remove(0);
        }
        let table = Arc::new(Self::new(nu));
        tables.push(table.clone());
        table
    }

    /// The table for Poisson's ratio `nu`.
    pub fn new(nu: f64) -> Self {
        let (mut even, mut odd, mut ww) = (Vec::new(), Vec::new(), Vec::new());
        let single = |b: &[u8]| f64::from(f32::from_le_bytes(b.try_into().expect("four bytes")));
        let stresses = STRESS_VALUES.chunks_exact(4 * 12).map(|place| -> [f64; 6] {
            let value = |i: usize| single(&place[4 * i..4 * i + 4]);
            std::array::from_fn(|c| value(c) + nu * value(6 + c))
        });
        interpolate::<{ STRESS.order }, 6>(stresses, |patch| {
            let lanes = |stress: [usize; STRESSES]| -> Patch {
                std::array::from_fn(|a| {
                    std::array::from_fn(|i| {
                        let c = patch[a][i / STRESSES];
                        c.get(stress[i % STRESSES]).map_or(0.0, |c| *c as f32)
                    })
                })
            };
            even.push(lanes([0, 1, 2, 3]));
            odd.push(lanes([4, 5, NONE, NONE]));
        });
        let double = |b: &[u8]| f64::from_le_bytes(b.try_into().expect("eight bytes"));
        let values = WW_VALUES
            .chunks_exact(16)
            .map(|place| [double(&place[..8]) + nu * double(&place[8..])]);
        interpolate::<{ WW.order }, 1>(values, |patch| {
            ww.push(patch.map(|row| std::array::from_fn(|b| row.get(b).map_or(0.0, |[c]| *c))));
        });
        Self { nu, even, odd, ww }
    }

    /// As [`super::line_load::exact`].
    pub fn line_load(&self, k: f64, u: f64, v: f64) -> WaveStress {
        self.sum(k, &Places::new(vec![u], v, false), f64::INFINITY, &[1.0], 1).0
    }

    /// The stresses of line loads at `places` no farther away than `reach`, and the number of these
    /// loads. Place i's load is `loads[i * stride]`.
    pub fn sum(
        &self,
        k: f64,
        places: &Places,
        reach: f64,
        loads: &[f32],
        stride: usize,
    ) -> (WaveStress, usize) {
        let ([mut xx, mut ww, mut dd, mut wd], count) =
            sum_loads(&self.even, k, places, &places.even, reach, loads, stride);
        let (mut xw, mut xd) = (0.0, 0.0);
        if !places.central {
            ([xw, xd, ..], _) = sum_loads(&self.odd, k, places, &places.odd, reach, loads, stride);
        }
        if k * places.depth < FLOOR {
            for (i, (&u, distance)) in places.offsets.iter().zip(&places.distances).enumerate() {
                // The table begins farther away.
                if k as f32 * distance < FLOOR as f32 {
                    let (s, load) =
                        (near(k, self.nu, u, places.depth), f64::from(loads[i * stride]));
                    (xx, ww, dd) = (xx + load * s.xx, ww + load * s.ww, dd + load * s.dd);
                    wd += load * s.wd;
                    if !places.central {
                        (xw, xd) = (xw + load * s.xw, xd + load * s.xd);
                    }
                }
            }
        }
        (WaveStress { xx, ww, dd, xw, xd, wd }, count)
    }

    /// The stress ww alone, of a unit load at each of `places`, into `out`; none from beyond `reach`.
    pub fn ww(&self, k: f64, places: &WwPlaces, reach: f64, out: &mut Vec<f64>) {
        out.resize(places.offsets.len(), 0.0);
        ww_of_all(&self.ww, k, places, reach, out);
        for ((value, &u), distance) in out.iter_mut().zip(&places.offsets).zip(&places.distances) {
            if k * distance < FLOOR {
                *value = near(k, self.nu, u, places.depth).ww;
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

/// The tabulated stress ww into `out`, compiled for the processor's vector units too.
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
        // Rounded first: what is below the ceiling then has a row.
        let rho = (k * distance) as f32;
        if !(floor..ceiling).contains(&rho) {
            *value = 0.0;
            continue;
        }
        let (row, a) = WW.row(rho);
        let (patch, a) = (&patches[row + *direction as usize], f64::from(a));
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

/// Where line loads are that a target feels: what is the same for all wavenumbers.
#[derive(Debug, Clone, Default)]
pub struct Places {
    offsets: Vec<f64>,
    depth: f64,
    central: bool,
    distances: Vec<f32>,
    /// First patch of the direction, in any row of patches.
    patches: Vec<u32>,
    /// Powers of the angular coordinate as [`Patch`] wants them, over the distance, with the signs of
    /// the stresses that are odd in the offset: of [`WaveTable::even`] and of [`WaveTable::odd`].
    even: Vec<[f32; LANES]>,
    odd: Vec<[f32; LANES]>,
}

impl Places {
    /// Line loads at the `offsets` target - source along the surface, of a target at `depth` > 0.
    /// Only what does not vanish in the plane x = 0 is summed for a target that is `central`.
    pub fn new(offsets: Vec<f64>, depth: f64, central: bool) -> Self {
        let count = offsets.len();
        let mut places = Self {
            depth,
            central,
            distances: Vec::with_capacity(count),
            patches: Vec::with_capacity(count),
            even: Vec::with_capacity(count),
            odd: Vec::with_capacity(if central { 0 } else { count }),
            offsets: Vec::new(),
        };
        for &u in &offsets {
            let distance = (u * u + depth * depth).sqrt();
            let (patch, b) = STRESS.direction(u.abs() / (u.abs() + depth));
            let (b, inverse) = (b as f32, (1.0 / distance) as f32);
            let powers = [inverse, inverse * b, inverse * b * b, inverse * b * b * b];
            let sign = if u < 0.0 { -1.0 } else { 1.0 };
            let factors = |signs: [f32; STRESSES]| -> [f32; LANES] {
                std::array::from_fn(|i| powers[i / STRESSES] * signs[i % STRESSES])
            };
            places.distances.push(distance as f32);
            places.patches.push(patch as u32);
            places.even.push(factors([1.0, 1.0, 1.0, sign]));
            if !central {
                places.odd.push(factors([sign, 1.0, 1.0, 1.0]));
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

    /// Depth of the target.
    pub fn depth(&self) -> f64 {
        self.depth
    }
}

/// What spreads on a half-space's surface from line loads at the offset `u`: adds
/// (k / 2) e^(-k |u|) times the load, and the same with the sign of `u` to `shear` unless that is empty, for
/// each of the wavenumbers `k`. J and N of [`super::bessel::incomplete`] at v = 0 are (pi/2) e^-u.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
pub fn add_surface_spread(k: &[f32], u: f32, loads: &[f32], spread: &mut [f32], shear: &mut [f32]) {
    for ((k, load), sum) in k.iter().zip(loads).zip(&mut *spread) {
        *sum += load * 0.5 * k * fade(k * u.abs());
    }
    let sign = if u == 0.0 { 0.0 } else { u.signum() };
    for ((k, load), sum) in k.iter().zip(loads).zip(shear) {
        *sum += load * 0.5 * k * sign * fade(k * u.abs());
    }
}

/// e^(-x) for 0 <= x < 80, relative error below 3e-7: 2^n times the series of 2^r, |r| <= 1/2.
#[inline(always)]
fn fade(x: f32) -> f32 {
    let exponent = -std::f32::consts::LOG2_E * x;
    // Adding 3 * 2^22 rounds to a whole number, which then are the last digits.
    const ROUND: f32 = 12_582_912.0;
    let rounded = exponent + ROUND;
    let t = std::f32::consts::LN_2 * (exponent - (rounded - ROUND));
    let power = f32::from_bits((rounded.to_bits().wrapping_add(127)) << 23);
    const SERIES: [f32; 7] = [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0];
    power * SERIES.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// Sums of the tabulated stresses over the loads that the table reaches, compiled for the
/// processor's vector units too, and the number of these loads. `factors` are those of the table.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn sum_loads(
    patches: &[Patch],
    k: f64,
    places: &Places,
    factors: &[[f32; LANES]],
    reach: f64,
    loads: &[f32],
    stride: usize,
) -> ([f64; STRESSES], usize) {
    let times = |a: f32, b: f32, c: f32| -> f32 {
        if target_cfg_f!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
    };
    let (floor, ceiling) = (FLOOR as f32, CEILING.min(k * reach) as f32);
    let k = k as f32;
    let mut total = [0f32; LANES];
    let mut count = 0;
    let directions = places.patches.iter().zip(factors);
    for ((distance, (direction, factors)), load) in
        places.distances.iter().zip(directions).zip(loads.iter().step_by(stride))
    {
        let rho = k * distance;
        if !(floor..ceiling).contains(&rho) {
            continue;
        }
        count += 1;
        let (row, a) = STRESS.row(rho);
        let patch = &patches[row + *direction as usize];
        let mut sum = patch[STRESS.order - 1];
        for c in patch[..STRESS.order - 1].iter().rev() {
            for i in 0..LANES {
                sum[i] = times(sum[i], a, c[i]);
            }
        }
        for i in 0..LANES {
            total[i] = times(load * factors[i], sum[i], total[i]);
        }
    }
    let sums = std::array::from_fn(|stress| {
        (0..STRESS.order).map(|b| f64::from(total[b * STRESSES + stress])).sum()
    });
    (sums, count)
}

#[cfg(test)]
mod tests {
    use super::super::line_load::exact;
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

    #[test]
    fn waves_add_up_to_boussinesq() {
        let breaks =
            (0..=90).map(|i| if i == 0 { 0.0 } else { 2f64.powf(f64::from(i - 60) / 4.0) });
        let axis = Panels::new(breaks.collect(), 10);
        for nu in [0.0, 0.3, 0.45] {
            for (x, u, v) in [(0.4, 0.3, 0.5), (0.0, -0.7, 0.4), (1.2, 0.6, 0.3), (-0.5, 0.1, 1.0)]
            {
                let mut got = [0.0; 6];
                for (&k, w) in axis.nodes().iter().zip(axis.weights()) {
                    let s = exact(k, nu, u, v);
                    let (sin, cos) = (k * x).sin_cos();
                    let all =
                        [s.xx * cos, s.ww * cos, s.dd * cos, s.xw * sin, s.xd * sin, s.wd * cos];
                    for (g, a) in got.iter_mut().zip(all) {
                        *g += w * a / PI;
                    }
                }
                for (g, want) in got.iter().zip(point_load(nu, x, u, v)) {
                    assert!((g - want).abs() < 2e-6, "nu {nu} at {x} {u} {v}: {g} {want}");
                }
            }
        }
    }

    #[test]
    fn table_equals_the_closed_forms() {
        let mut worst: f64 = 0.0;
        for nu in [0.0, 0.3, 0.49] {
            let table = WaveTable::new(nu);
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
                    for (got, want) in pairs {
                        worst = worst.max((got - want).abs() * rho / k);
                    }
                }
            }
        }
        println!("worst {worst:e}");
        assert!(worst < 5e-5, "{worst:e}");
    }

    #[test]
    fn surface_values_are_the_limit_of_small_depth() {
        let (k, nu) = (1.3, 0.3);
        for u in [0.4, -0.9, 12.0] {
            let s = exact(k, nu, u, 1e-9);
            let (mut spread, mut shear) = ([0.0], [0.0]);
            add_surface_spread(&[k as f32], u as f32, &[1.0], &mut spread, &mut shear);
            let [spread, shear] = [spread, shear].map(|s| (1.0 - 2.0 * nu) * f64::from(s[0]));
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
