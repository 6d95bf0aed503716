//! Stresses of line loads that vary as cos(k x) along their line, tabulated; the conventions and the
//! closed forms are those of [`crate::kernels::line_load`].

use super::line_load::{WaveStress, near};
use super::patches::{CEILING, FLOOR, Fineness, STRESS, WW};
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
    ww: Vec<[[f64; WW.order]; WW.order]>,
}

/// Monomial coefficients of four stresses: for each power of the angular coordinate a vector of
/// [power of the radial one][stress].
///
/// In single precision, whose rounding is below the interpolation's error: a look-up is bound by
/// the memory it touches.
type Patch = [[f32; LANES]; STRESS.order];

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
/// `values` are given in the order of [`Fineness::places`].
fn interpolate<const N: usize, const C: usize>(
    fineness: &Fineness,
    values: impl Iterator<Item = [f64; C]>,
    mut add: impl FnMut([[[f64; C]; N]; N]),
) {
    // From values at Chebyshev nodes to powers; so few powers keep this well conditioned.
    let powers = nalgebra::SMatrix::<f64, N, N>::from_fn(|i, j| fineness.node(i).powi(j as i32));
    let inverse = powers.try_inverse().expect("distinct nodes");
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
        interpolate::<{ STRESS.order }, 6>(&STRESS, stresses, |patch| {
            let lanes = |stress: [usize; STRESSES]| -> Patch {
                std::array::from_fn(|b| {
                    std::array::from_fn(|i| {
                        let c = patch[i / STRESSES][b];
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
        interpolate::<{ WW.order }, 1>(&WW, values, |patch| {
            ww.push(patch.map(|row| row.map(|[c]| c)));
        });
        Self { nu, even, odd, ww }
    }

    /// As [`super::line_load::exact`].
    pub fn line_load(&self, k: f64, u: f64, v: f64) -> WaveStress {
        let [xx, ww, dd, wd, xw, xd] = self.sum(k, v, &[u], &[1.0]);
        WaveStress { xx, ww, dd, xw, xd, wd }
    }

    /// The stresses xx, ww, dd, wd, xw, xd at the depth `v` > 0 of line loads `loads` at the
    /// `offsets` target - source along the surface (of equal length).
    pub fn sum(&self, k: f64, v: f64, offsets: &[f64], loads: &[f64]) -> [f64; 6] {
        let [xx, ww, dd, wd] = self.sum_even(k, v, offsets, loads);
        let [xw, xd, ..] = sum_loads(&self.odd, k, v, offsets, loads, [true, false, false, false]);
        let mut total = [xx, ww, dd, wd, xw, xd];
        self.add_near(k, v, offsets, loads, |s| {
            (total[4], total[5]) = (total[4] + s.xw, total[5] + s.xd);
        });
        total
    }

    /// The stresses xx, ww, dd, wd alone, see [`WaveTable::sum`].
    pub fn sum_even(&self, k: f64, v: f64, offsets: &[f64], loads: &[f64]) -> [f64; 4] {
        let [mut xx, mut ww, mut dd, mut wd] =
            sum_loads(&self.even, k, v, offsets, loads, [false, false, false, true]);
        self.add_near(k, v, offsets, loads, |s| {
            (xx, ww, dd, wd) = (xx + s.xx, ww + s.ww, dd + s.dd, wd + s.wd);
        });
        [xx, ww, dd, wd]
    }

    /// Calls `add` with the stresses of the loads that are nearer than the table begins.
    fn add_near(
        &self,
        k: f64,
        v: f64,
        offsets: &[f64],
        loads: &[f64],
        mut add: impl FnMut(WaveStress),
    ) {
        if k * v >= FLOOR {
            return;
        }
        for (&u, &load) in offsets.iter().zip(loads) {
            if k * (u * u + v * v).sqrt() < FLOOR {
                let s = near(k, self.nu, u, v);
                add(WaveStress {
                    xx: load * s.xx,
                    ww: load * s.ww,
                    dd: load * s.dd,
                    xw: load * s.xw,
                    xd: load * s.xd,
                    wd: load * s.wd,
                });
            }
        }
    }

    /// The stress ww alone.
    #[inline]
    pub fn ww(&self, k: f64, u: f64, v: f64) -> f64 {
        let (x, z) = (k * u.abs(), k * v);
        let rho = (x * x + z * z).sqrt();
        if rho >= CEILING {
            return 0.0;
        }
        if rho < FLOOR {
            return near(k, self.nu, u, v).ww;
        }
        let (patch, a, b) = WW.locate(x / (x + z), rho);
        let mut sum = 0.0;
        for row in self.ww[patch].iter().rev() {
            let inner = row.iter().rev().fold(0.0, |inner, c| inner * b + c);
            sum = sum * a + inner;
        }
        k / rho * sum
    }
}

/// Sums of the tabulated stresses over the loads that the table reaches, compiled for the
/// processor's vector units too; `odd` tells which stresses are odd in the offset.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn sum_loads(
    patches: &[Patch],
    k: f64,
    v: f64,
    offsets: &[f64],
    loads: &[f64],
    odd: [bool; STRESSES],
) -> [f64; STRESSES] {
    const BLOCK: usize = 16;
    let times = |a: f32, b: f32, c: f32| -> f32 {
        if target_cfg_f!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
    };
    let mut total = [0f32; LANES];
    let flip: [f32; LANES] = std::array::from_fn(|i| if odd[i % STRESSES] { -1.0 } else { 1.0 });
    let z = k * v;
    for (offsets, loads) in offsets.chunks(BLOCK).zip(loads.chunks(BLOCK)) {
        let (mut rhos, mut shares, mut scales) = ([1.0; BLOCK], [0.0; BLOCK], [0.0; BLOCK]);
        for (((&u, &load), rho), (share, scale)) in
            offsets.iter().zip(loads).zip(&mut rhos).zip(shares.iter_mut().zip(&mut scales))
        {
            let x = k * u.abs();
            let distance = (x * x + z * z).sqrt();
            let inside = (FLOOR..CEILING).contains(&distance);
            *rho = if inside { distance } else { 1.0 };
            *share = x / (x + z);
            *scale = if inside { load * k / distance } else { 0.0 };
        }
        for (((rho, share), scale), u) in rhos.iter().zip(&shares).zip(&scales).zip(offsets) {
            let (patch, a, b) = STRESS.locate(*share, *rho);
            let (patch, a, b, scale) = (&patches[patch], a as f32, b as f32, *scale as f32);
            let mut sum = patch[STRESS.order - 1];
            for c in patch[..STRESS.order - 1].iter().rev() {
                for i in 0..LANES {
                    sum[i] = times(sum[i], b, c[i]);
                }
            }
            let powers = [scale, scale * a, scale * a * a, scale * a * a * a];
            let mut factors: [f32; LANES] = std::array::from_fn(|i| powers[i / STRESSES]);
            if *u < 0.0 {
                for i in 0..LANES {
                    factors[i] *= flip[i];
                }
            }
            for i in 0..LANES {
                total[i] = times(factors[i], sum[i], total[i]);
            }
        }
    }
    std::array::from_fn(|stress| {
        (0..STRESS.order).map(|a| f64::from(total[a * STRESSES + stress])).sum()
    })
}

/// The part of a half-space's surface stress that is not local to the load: at v = 0 the stresses
/// under a pressure p(u) are xx = -2 nu p - (1 - 2 nu) s, ww = -p + (1 - 2 nu) s, dd = -p,
/// with s the convolution of p with this kernel, (k / 2) e^(-k |u|) (J at v = 0 is (pi/2) e^-u).
#[inline]
pub fn surface_spread(k: f64, u: f64) -> f64 {
    0.5 * k * (-k * u.abs()).exp()
}

/// As [`surface_spread`], for the shear xw = (1 - 2 nu) times the convolution with this kernel
/// (N at v = 0 is (pi/2) e^-u).
#[inline]
pub fn surface_spread_shear(k: f64, u: f64) -> f64 {
    if u == 0.0 { 0.0 } else { 0.5 * k * (-k * u.abs()).exp() * u.signum() }
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
                    let pairs = [
                        (got.xx, want.xx),
                        (got.ww, want.ww),
                        (got.dd, want.dd),
                        (got.xw, want.xw),
                        (got.xd, want.xd),
                        (got.wd, want.wd),
                        (table.ww(k, u, v), want.ww),
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
        for u in [0.4, -0.9] {
            let s = exact(k, nu, u, 1e-9);
            let spread = (1.0 - 2.0 * nu) * surface_spread(k, u);
            assert!((s.xx + spread).abs() < 1e-5 && (s.ww - spread).abs() < 1e-5);
            let shear = (1.0 - 2.0 * nu) * surface_spread_shear(k, u);
            assert!((s.xw - shear).abs() < 1e-5, "{} {}", s.xw, shear);
        }
    }
}
