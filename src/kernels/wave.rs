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

use super::bessel::{incomplete, k0_k1};
use std::f64::consts::FRAC_1_PI;

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

/// Beyond this product of wavenumber and distance a line load is not felt (e^-20 = 2e-9).
pub const REACH: f64 = 20.0;

/// Stresses at offset `u` and depth `v` > 0 (or v = 0 with u /= 0) of a line load of wavenumber
/// `k` > 0, in a material of Poisson's ratio `nu`.
#[inline]
pub fn line_load(k: f64, nu: f64, u: f64, v: f64) -> WaveStress {
    let rho = u.hypot(v);
    let x = k * rho;
    if x > REACH {
        return WaveStress::default();
    }
    let (k0, k1) = k0_k1(x);
    let (j, n) = incomplete(k * u.abs(), k * v, x);
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
                    let s = line_load(k, nu, u, v);
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
    fn surface_values_are_the_limit_of_small_depth() {
        let (k, nu) = (1.3, 0.3);
        for u in [0.4, -0.9] {
            let s = line_load(k, nu, u, 1e-9);
            let spread = (1.0 - 2.0 * nu) * surface_spread(k, u);
            assert!((s.xx + spread).abs() < 1e-5 && (s.ww - spread).abs() < 1e-5);
            let shear = (1.0 - 2.0 * nu) * surface_spread_shear(k, u);
            assert!((s.xw - shear).abs() < 1e-5, "{} {}", s.xw, shear);
        }
    }
}
