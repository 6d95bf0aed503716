//! A half-space under a line load that varies as cos(k x) along its line.
//!
//! Conventions of this module: `u` is the offset from the load along the surface, across the line;
//! `v` >= 0 is the depth; the load is a unit force per length times cos(k x) on the line u = 0 of
//! the surface. In-plane stresses `ww` (along u), `dd` (along the depth), `xx` and `wd` vary as
//! cos(k x), the shears `xw` and `xd` as sin(k x). Pressure is positive, stress is positive in
//! tension. Integrating any of them over k from 0 to infinity and dividing by pi gives the field
//! of a point load (Boussinesq).
//!
//! Source: the half-space under p cos(k x) cos(l u), kappa^2 = k^2 + l^2, carries
//! sigma_dd = -p (1 + kappa v) e^(-kappa v) and, tangentially,
//! sigma_ab = (d_a d_b / kappa^2) [(1 - 2 nu) - kappa v] p e^(-kappa v) - 2 nu delta_ab p e^(-kappa v)
//! (the Papkovich-Neuber solution with one harmonic function; Johnson, Contact Mechanics, 1985,
//! chapter 3). The inverse transforms in l are K0, K1 and their incomplete integrals:
//! e^(-kappa v)/kappa -> K0/pi, e^(-kappa v) -> k v K1/(pi rho), e^(-kappa v)/kappa^2 -> J/(pi k).

use super::bessel::{incomplete, incomplete_near, k0_k1};
use std::f64::consts::FRAC_1_PI;
use std::sync::{Arc, Mutex};

/// Amplitudes of the six stresses; see the module for which vary as cos(k x) and which as sin(k x).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WaveStress {
    pub xx: f64,
    /// Along the surface, across the load's line.
    pub ww: f64,
    /// Along the depth.
    pub dd: f64,
    pub xw: f64,
    pub xd: f64,
    pub wd: f64,
}

/// Stresses at offset `u` and depth `v` > 0 (or v = 0 with u /= 0) of a line load of wavenumber
/// `k` > 0, in a material of Poisson's ratio `nu`.
#[inline]
pub fn exact(k: f64, nu: f64, u: f64, v: f64) -> WaveStress {
    let rho = (u * u + v * v).sqrt();
    let x = k * rho;
    let (k0, k1) = k0_k1(x);
    let (j, n) = if x < FLOOR {
        incomplete_near(k * u.abs(), k * v, x)
    } else {
        incomplete(k * u.abs(), k * v)
    };
    let k1_rho = k1 / rho;
    // K2(x) k / rho^2, from K2 = K0 + 2 K1 / x.
    let k2_rho2 = (k * k0 + 2.0 * k1_rho) / (rho * rho);
    // Inverse transforms of e^(-kappa v) kappa^(-m), m = 2, 1, 0, -1, and their slopes along u.
    let e2 = FRAC_1_PI * j / k;
    let e1 = FRAC_1_PI * k0;
    let e0 = FRAC_1_PI * k * v * k1_rho;
    let em1 = FRAC_1_PI * k * (v * v * k2_rho2 - k1_rho);
    let slope2 = -FRAC_1_PI * n * u.signum();
    let slope1 = -FRAC_1_PI * k * u * k1_rho;
    let slope0 = -FRAC_1_PI * k * v * u * k2_rho2;
    let free = 1.0 - 2.0 * nu;
    let xx = k * k * (v * e1 - free * e2) - 2.0 * nu * e0;
    WaveStress {
        xx,
        ww: v * em1 - e0 - k * k * (v * e1 - free * e2),
        dd: -e0 - v * em1,
        xw: -k * (free * slope2 - v * slope1),
        xd: -k * v * e0,
        wd: v * slope0,
    }
}

/// [`exact`] of one material, tabulated: with lengths in units of 1/k the six stresses times
/// rho are smooth functions of rho and of the angle, interpolated by polynomials on patches, a row of
/// patches per octave of rho. Absolute error of rho times a stress below 2e-6
/// (checked against [`exact`]), at about a fifth of its time.
#[derive(Debug, Clone)]
pub struct WaveTable {
    nu: f64,
    /// Monomial coefficients [patch][power of the radial coordinate][power of the angular one].
    ///
    /// In single precision, whose rounding is below the interpolation's error: a look-up is bound
    /// by the memory it touches.
    patches: Vec<Patch>,
    /// The same of ww alone, which the faces' matrices ask for.
    ww: Vec<[[f64; ORDER]; ORDER]>,
}

/// The six stresses of every coefficient, padded to whole vector registers.
type Patch = [[[f32; LANES]; ORDER]; ORDER];

const LANES: usize = 8;
const ORDER: usize = 6;
const ANGLES: usize = 6;
/// Octaves of rho that are tabulated, 2^LOW up to 2^HIGH.
const LOW: i32 = -9;
const HIGH: i32 = 5;
const FLOOR: f64 = 1.0 / 512.0;
const CEILING: f64 = 32.0;

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
        let nodes: [f64; ORDER] =
            std::array::from_fn(|i| (std::f64::consts::PI * (i as f64 + 0.5) / ORDER as f64).cos());
        // From values at Chebyshev nodes to powers; so few powers keep this well conditioned.
        let inverse =
            nalgebra::SMatrix::<f64, ORDER, ORDER>::from_fn(|i, j| nodes[i].powi(j as i32))
                .try_inverse()
                .expect("distinct nodes");
        let mut patches = Vec::with_capacity((HIGH - LOW) as usize * ANGLES);
        let mut ww = Vec::with_capacity(patches.capacity());
        for octave in LOW..HIGH {
            let scale = 2f64.powi(octave);
            for angle in 0..ANGLES {
                let mut values = [[[0.0; 6]; ORDER]; ORDER];
                for (row, t) in values.iter_mut().zip(nodes) {
                    let rho = scale * (1.5 + 0.5 * t);
                    for (value, t) in row.iter_mut().zip(nodes) {
                        let share = (angle as f64 + 0.5 + 0.5 * t) / ANGLES as f64;
                        let (sin, cos) = share.atan2(1.0 - share).sin_cos();
                        let s = exact(1.0, nu, rho * sin, rho * cos);
                        *value = [s.xx, s.ww, s.dd, s.xw, s.xd, s.wd].map(|s| rho * s);
                    }
                }
                // One direction after the other.
                let mut half_way = [[[0.0; 6]; ORDER]; ORDER];
                let mut patch = [[[0.0; 6]; ORDER]; ORDER];
                for a in 0..ORDER {
                    for i in 0..ORDER {
                        for j in 0..ORDER {
                            for c in 0..6 {
                                half_way[a][j][c] += inverse[(a, i)] * values[i][j][c];
                            }
                        }
                    }
                    for b in 0..ORDER {
                        for j in 0..ORDER {
                            for c in 0..6 {
                                patch[a][b][c] += inverse[(b, j)] * half_way[a][j][c];
                            }
                        }
                    }
                }
                patches.push(patch.map(|row| {
                    row.map(|c: [f64; 6]| {
                        std::array::from_fn(|i| c.get(i).map_or(0.0, |c| *c as f32))
                    })
                }));
                ww.push(patch.map(|row| row.map(|c| c[1])));
            }
        }
        Self { nu, patches, ww }
    }

    /// The patch and the place in it, of u >= 0 and v >= 0 with rho, in units of 1/k.
    #[inline]
    fn locate(u: f64, v: f64, rho: f64) -> (usize, f64, f64) {
        let bits = rho.to_bits();
        let octave = ((bits >> 52) as i32) - 1023;
        let mantissa = f64::from_bits((bits & ((1 << 52) - 1)) | (1023 << 52));
        let a = 2.0 * mantissa - 3.0;
        let share = u / (u + v) * ANGLES as f64;
        let angle = (share as usize).min(ANGLES - 1);
        let b = 2.0 * (share - angle as f64) - 1.0;
        let row = (octave - LOW) as usize;
        (row * ANGLES + angle, a, b)
    }

    /// As [`exact`].
    #[inline]
    pub fn line_load(&self, k: f64, u: f64, v: f64) -> WaveStress {
        let (x, z) = (k * u.abs(), k * v);
        let rho = (x * x + z * z).sqrt();
        if rho >= CEILING {
            return WaveStress::default();
        }
        if rho < FLOOR {
            return exact(k, self.nu, u, v);
        }
        let (patch, a, b) = Self::locate(x, z, rho);
        let (patch, a, b) = (&self.patches[patch], a as f32, b as f32);
        let mut sum = [0f32; LANES];
        for row in patch.iter().rev() {
            let mut inner = row[ORDER - 1];
            for c in row[..ORDER - 1].iter().rev() {
                for i in 0..LANES {
                    inner[i] = inner[i] * b + c[i];
                }
            }
            for i in 0..LANES {
                sum[i] = sum[i] * a + inner[i];
            }
        }
        let sum = sum.map(f64::from);
        let scale = k / rho;
        // xw and wd are odd in u.
        let odd = if u < 0.0 { -scale } else { scale };
        WaveStress {
            xx: scale * sum[0],
            ww: scale * sum[1],
            dd: scale * sum[2],
            xw: odd * sum[3],
            xd: scale * sum[4],
            wd: odd * sum[5],
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
            return exact(k, self.nu, u, v).ww;
        }
        let (patch, a, b) = Self::locate(x, z, rho);
        let mut sum = 0.0;
        for row in self.ww[patch].iter().rev() {
            let inner = row.iter().rev().fold(0.0, |inner, c| inner * b + c);
            sum = sum * a + inner;
        }
        k / rho * sum
    }
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
        assert!(worst < 2e-5, "{worst:e}");
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
