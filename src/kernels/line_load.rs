//! A half-space under a line load that varies as cos(k x) along its line.
//!
//! Conventions of this module: `u` is the offset from the load along the surface, across the line;
//! `v` >= 0 is the depth; the load is a unit force per length times cos(k x) on the line u = 0 of
//! the surface, into the surface or along x. Under a load into the surface the in-plane stresses
//! `ww` (along u), `dd` (along the depth), `xx` and `wd` vary as cos(k x), the shears `xw` and `xd`
//! as sin(k x); under a load along x it is the other way round. Pressure is positive, a load along
//! x acts towards +x, stress is positive in tension. Integrating any of them over k from 0 to
//! infinity and dividing by pi gives the field of a point load (Boussinesq, Cerruti).
//!
//! Source, load into the surface: the half-space under p cos(k x) cos(l u), kappa^2 = k^2 + l^2,
//! has the stresses sigma_dd = -p (1 + kappa v) e^(-kappa v) and, tangentially, sigma_ab = (d_a d_b
//! / kappa^2) [(1 - 2 nu) - kappa v] p e^(-kappa v) - 2 nu delta_ab p e^(-kappa v) (the
//! Papkovich-Neuber solution with one harmonic function; Johnson, Contact Mechanics, 1985, chapter
//! 3). The inverse transforms in l are K0, K1 and their incomplete integrals: e^(-kappa v)/kappa ->
//! K0/pi, e^(-kappa v) -> k v K1/(pi rho), e^(-kappa v)/kappa^2 -> J/(pi k).
//!
//! Load along x: its part along the wave vector is a plane-strain wave with Airy's function z
//! e^(-kappa v), its part across the wave vector an antiplane one (Barber, Elasticity, 2010,
//! chapters 13 and 19). Together, with e the factor e^(-kappa v) and the phase of each stress left
//! out:
//!
//! ```text
//! xx = -k e (2 (1 + nu) / kappa - 2 nu k^2 / kappa^3 - k^2 v / kappa^2)
//! ww = -k e (k^2 v / kappa^2 - v + 2 nu k^2 / kappa^3)
//! dd = -k v e
//! xw = d_u e (1 / kappa - 2 nu k^2 / kappa^3 - k^2 v / kappa^2)
//! xd = -e (1 - k^2 v / kappa)
//! wd = k v d_u e / kappa
//! ```
//!
//! The transform of e^(-kappa v) / kappa^3 is (rho K1 - v J) / (pi k).
//!
//! Load apart from the line: forces along u that are opposite on its two sides, the traction -(1/k)
//! delta'(u) cos(k x). A load along u is one along x with the axes exchanged, l^2 = kappa^2 - k^2
//! for k^2; the pair is minus its slope along u over k, with d_u^2 = k^2 - kappa^2 on every e.

use super::bessel::{incomplete, k0_k1};
use std::f64::consts::FRAC_1_PI;

/// Amplitudes of the six stresses; the module says which vary as cos(k x) and which as sin(k x).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WaveStress {
    /// Along the load's line.
    pub xx: f64,
    /// Along the surface, across the load's line.
    pub ww: f64,
    /// Along the depth.
    pub dd: f64,
    /// Shear of the load's line and the direction across it.
    pub xw: f64,
    /// Shear of the load's line and the depth.
    pub xd: f64,
    /// Shear of the direction across the line and the depth.
    pub wd: f64,
}

/// Stresses at offset `u` and depth `v` > 0 (or v = 0 with u /= 0) of a line load of wavenumber
/// `k` > 0, in a material of Poisson's ratio `nu`.
#[inline]
pub fn exact(k: f64, nu: f64, u: f64, v: f64) -> WaveStress {
    let rho = (u * u + v * v).sqrt();
    let x = k * rho;
    let (k0, k1) = k0_k1(x);
    let (j, n) = incomplete(k * u.abs(), k * v);
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

/// As [`exact`], of a line load along x.
#[inline]
pub fn exact_along(k: f64, nu: f64, u: f64, v: f64) -> WaveStress {
    let rho = (u * u + v * v).sqrt();
    let (k0, k1) = k0_k1(k * rho);
    let (j, n) = incomplete(k * u.abs(), k * v);
    let k1_rho = k1 / rho;
    // As in [`exact`], and m = 3.
    let e3 = FRAC_1_PI * (rho * k1 - v * j) / k;
    let e2 = FRAC_1_PI * j / k;
    let e1 = FRAC_1_PI * k0;
    let e0 = FRAC_1_PI * k * v * k1_rho;
    let slope2 = -FRAC_1_PI * n * u.signum();
    let slope3 = -FRAC_1_PI * u * k0 - v * slope2;
    let slope1 = -FRAC_1_PI * k * u * k1_rho;
    let square = k * k;
    WaveStress {
        xx: -k * (2.0 * (1.0 + nu) * e1 - square * (2.0 * nu * e3 + v * e2)),
        ww: -k * (square * (v * e2 + 2.0 * nu * e3) - v * e0),
        dd: -k * v * e0,
        xw: slope1 - square * (2.0 * nu * slope3 + v * slope2),
        xd: square * v * e1 - e0,
        wd: k * v * slope1,
    }
}

/// As [`exact`], of forces apart from the line: the phases are those of a load into the surface.
#[inline]
pub fn exact_apart(k: f64, nu: f64, u: f64, v: f64) -> WaveStress {
    let rho = (u * u + v * v).sqrt();
    let x = k * rho;
    let (k0, k1) = k0_k1(x);
    let (j, n) = incomplete(k * u.abs(), k * v);
    let (square, k1_rho) = (k * k, k1 / rho);
    // K2(x) k / rho^2 and K3(x) k^2 / rho^3, from K3 = K1 + 4 K2 / x.
    let k2_rho2 = (k * k0 + 2.0 * k1_rho) / (rho * rho);
    let k3_rho3 = (square * k1_rho + 4.0 * k2_rho2) / (rho * rho);
    // As in [`exact_along`], and m = -1 and -2.
    let e3 = FRAC_1_PI * (rho * k1 - v * j) / k;
    let e2 = FRAC_1_PI * j / k;
    let e1 = FRAC_1_PI * k0;
    let e0 = FRAC_1_PI * k * v * k1_rho;
    let em1 = FRAC_1_PI * k * (v * v * k2_rho2 - k1_rho);
    let em2 = FRAC_1_PI * k * v * (v * v * k3_rho3 - 3.0 * k2_rho2);
    let slope2 = -FRAC_1_PI * n * u.signum();
    let slope3 = -FRAC_1_PI * u * k0 - v * slope2;
    let slope1 = -FRAC_1_PI * k * u * k1_rho;
    let slope0 = -FRAC_1_PI * k * v * u * k2_rho2;
    let slope_m1 = FRAC_1_PI * k * u * (k2_rho2 - v * v * k3_rho3);
    WaveStress {
        xx: k * v * (square * e2 - e0) - 2.0 * nu * (2.0 * k * e1 - em1 / k)
            + 2.0 * nu * k * square * e3,
        ww: 2.0 * em1 / k - 2.0 * k * ((1.0 - nu) * e1 + nu * square * e3)
            + v * (2.0 * k * e0 - em2 / k - k * square * e2),
        dd: v * (em2 / k - k * e0),
        xw: (1.0 - 2.0 * nu) * slope1 + 2.0 * nu * square * slope3 + v * (square * slope2 - slope0),
        xd: v * (em1 - square * e1),
        wd: slope0 / k + v * (k * slope1 - slope_m1 / k),
    }
}

/// [`exact_along`] to first order in `k` at distances much shorter than 1/k: the line of an
/// antiplane load, and what varies along it.
#[inline]
pub fn near_along(k: f64, nu: f64, u: f64, v: f64) -> WaveStress {
    let square = u * u + v * v;
    // K0 for small arguments.
    const EULER: f64 = 0.577_215_664_901_532_9;
    let k0 = -(0.5 * k * square.sqrt()).ln() - EULER;
    let spread = FRAC_1_PI * k;
    WaveStress {
        xx: -2.0 * spread * ((1.0 + nu) * k0 - nu),
        ww: spread * (v * v / square - 2.0 * nu),
        dd: -spread * v * v / square,
        xw: -FRAC_1_PI * u / square,
        xd: -FRAC_1_PI * v / square,
        wd: -spread * u * v / square,
    }
}

/// [`exact`] to first order in `k` at distances much shorter than 1/k: the plane-strain line load
/// (Johnson 1985, Eq. 2.23) and the even term of a Poisson's ratio other than 1/2; relative error
/// below (k rho)^2 ln(k rho).
#[inline]
pub fn near(k: f64, nu: f64, u: f64, v: f64) -> WaveStress {
    let free = 1.0 - 2.0 * nu;
    let square = u * u + v * v;
    let radial = 2.0 * FRAC_1_PI * v / (square * square);
    let spread = 0.5 * free * k;
    WaveStress {
        xx: -2.0 * nu * FRAC_1_PI * v / square - spread,
        ww: -radial * u * u + spread,
        dd: -radial * v * v,
        xw: k * FRAC_1_PI * (free * u.atan2(v) - u * v / square),
        xd: -k * FRAC_1_PI * v * v / square,
        wd: -radial * u * v,
    }
}
