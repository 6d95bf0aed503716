//! What the roller's round shape adds to the stresses of a flat body, to first order in C / R.
//!
//! A disc loaded normally on its circumference carries, exactly, the radial fields of half-planes
//! that every element of the load would cause behind its own tangent, and a uniform tension that takes
//! the normal traction off the circumference (Timoshenko and Goodier, Theory of Elasticity, 1970,
//! article 41). Near one of two opposite contacts this is, to first order in C / R and in the
//! frame of the surface above the point, the flat half-plane's field, an even sigma_xx of
//! w' / (pi R), w' the load per length, and for each load p ds at the distance u along the surface
//! and the depth z, r^2 = u^2 + z^2,
//!
//! - xx: -(p ds / (pi R)) (u^4 / r^4 + 4 u^4 z^2 / r^6),
//! - zz: (p ds / (pi R)) (u^2 z^2 / r^4 - 4 u^2 z^4 / r^6),
//! - xz: -(p ds / (pi R)) 4 u^3 z^3 / r^6,
//!
//! from the load's tilt u / R and from the surface's fall u^2 / (2 R). So on the surface itself the
//! even tension is gone, and some C below it is all that is left. These terms are taken alike all
//! along the line, under the Hertz pressure: near an end the loads of about a C on either side of a
//! point make them up, and p varies there by what the second order is worth. No stress along y goes
//! with them; of plane strain that would leave out some 0.1 C / R.

use crate::base::{HertzScales, StressTensor};
use crate::kernels::strip;
use crate::stress::Pressure;
use multiversion::multiversion;
use std::f64::consts::PI;

/// Points of Gauss's rule for the weight sqrt(1 - t^2) across the contact, in groups that are summed side by
/// side.
const POINTS: usize = GROUPS * LANES;
const GROUPS: usize = 5;
const LANES: usize = 8;

/// Step of the difference quotient along x (C).
const STEP: f64 = 1e-4;

/// The roller's shape.
#[derive(Debug, Clone)]
pub struct RollerShape {
    /// C / R.
    curvature: f64,
    /// Nodes of the rule on [-1, 1], and weights that include the Hertz pressure sqrt(1 - t^2).
    rule: [[[f64; LANES]; 2]; GROUPS],
}

impl RollerShape {
    /// A roller of the radius `radius_m` (m).
    pub fn new(hertz: &HertzScales, radius_m: f64) -> Self {
        let angle = |i: usize| PI * (i + 1) as f64 / (POINTS + 1) as f64;
        let rule = std::array::from_fn(|group| {
            let angles: [f64; LANES] = std::array::from_fn(|lane| angle(group * LANES + lane));
            [
                angles.map(f64::cos),
                angles.map(|angle| PI / (POINTS + 1) as f64 * angle.sin().powi(2)),
            ]
        });
        Self { curvature: hertz.c_m / radius_m, rule }
    }

    /// The even sigma_xx of a disc squeezed across its diameter (p0): w' / (pi R) with the mean line
    /// load.
    pub fn diametral_tension(&self) -> f64 {
        0.5 * self.curvature
    }

    /// The roller's stress (p0) at x, y and the depth z below its surface (C), under `pressure`,
    /// where the `flat` body has the stress given.
    pub fn stress(&self, pressure: &Pressure, at: [f64; 3], flat: &StressTensor) -> StressTensor {
        let [x, y, z] = at;
        let mut s = *flat;
        s.xx += self.diametral_tension();
        let sums = tilted(&self.rule, x, z);
        let [xx, zz, xz] = sums.map(|sum| self.curvature / PI * sum);
        s.xx += xx;
        s.zz += zz;
        s.xz += xz;
        // The frame of the surface above the point is turned by x / R, and z runs beside its normal.
        let tilt = self.curvature * x;
        if tilt != 0.0 {
            s.xx -= 2.0 * tilt * flat.xz;
            s.zz += 2.0 * tilt * flat.xz;
            s.xz += tilt * (flat.xx - flat.zz);
            s.xy -= tilt * flat.yz;
            s.yz += tilt * flat.xy;
            if let Some((a, c)) = pressure.modes(y).filter(|_| z > 0.0) {
                let [before, after] = [x - STEP, x + STEP].map(|x| strip::stress(a, &c, x, z));
                let shift = tilt * z / (2.0 * STEP);
                s.xx += shift * (after[0] - before[0]);
                s.zz += shift * (after[1] - before[1]);
                s.xz += shift * (after[2] - before[2]);
            }
        }
        if z == 0.0 {
            // The pressure is known there.
            (s.zz, s.xz, s.yz) = (flat.zz, flat.xz, flat.yz);
        }
        s
    }
}

/// Sums over the rule's loads of what their tilt and the surface's fall add to xx, zz and xz at (`x`, `z`), compiled
/// for the processor's vector units too.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn tilted(rule: &[[[f64; LANES]; 2]; GROUPS], x: f64, z: f64) -> [f64; 3] {
    let mut sums = [[0.0; LANES]; 3];
    for [nodes, weights] in rule {
        for lane in 0..LANES {
            let (u, w) = (x - nodes[lane], weights[lane]);
            let square = u * u + z * z;
            // A load at the place itself adds nothing.
            let inverse = if square > 0.0 { 1.0 / square } else { 0.0 };
            let (along, down) = (u * u * inverse, z * z * inverse);
            sums[0][lane] -= w * along * along * (1.0 + 4.0 * down);
            sums[1][lane] += w * along * down * (1.0 - 4.0 * down);
            sums[2][lane] -= w * 4.0 * (u * z * inverse).powi(3);
        }
    }
    sums.map(|lanes| lanes.iter().sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Panels;

    /// A disc under opposite semi-elliptic pressures of half-width 1: the sum of the
    /// radial fields behind the tangents and of the uniform tension, in the frame of the axes.
    fn disc(radius: f64, x: f64, depth: f64) -> [f64; 3] {
        let top = radius - (radius * radius - x * x).sqrt() + depth;
        let rule = crate::base::gauss_legendre(400);
        let (mut xx, mut zz, mut xz, mut load) = (0.0, 0.0, 0.0, 0.0);
        for (g, w) in rule.0.iter().zip(&rule.1) {
            // Arc length s = sin(angle), p = cos(angle).
            let angle = 0.5 * PI * g;
            let (s, p) = (angle.sin(), 0.5 * PI * w * angle.cos().powi(2));
            load += p;
            let (sin, cos) = (s / radius).sin_cos();
            for side in [1.0, -1.0] {
                // Apex, and inward normal; z from the upper contact down, the centre at the radius.
                let apex = [radius * sin, radius - side * radius * cos];
                let normal = [-sin, side * cos];
                let d = [x - apex[0], top - apex[1]];
                let r2 = d[0] * d[0] + d[1] * d[1];
                let radial = -2.0 / PI * p * (d[0] * normal[0] + d[1] * normal[1]) / r2;
                xx += radial * d[0] * d[0] / r2;
                zz += radial * d[1] * d[1] / r2;
                xz += radial * d[0] * d[1] / r2;
            }
        }
        let tension = load / (PI * radius);
        [xx + tension, zz + tension, xz]
    }

    #[test]
    fn first_order_of_a_disc_that_is_squeezed() {
        let axis = Panels::new(vec![0.0, 1.0], 2);
        let pressure = Pressure::new(axis, vec![1.0; 2], vec![vec![1.0]; 2]);
        let hertz = HertzScales { c_m: 1.0, p0_pa: 1.0, e_star_pa: 1.0 };
        let off = |radius: f64| {
            let shape = RollerShape::new(&hertz, radius);
            let mut worst: f64 = 0.0;
            for x in [0.0, 0.3, 0.7, 1.5, 2.5] {
                for z in [0.2, 0.5, 1.0, 2.0, 4.0] {
                    let [xx, zz, xz] = strip::stress(1.0, &[1.0], x, z);
                    let flat = StressTensor { xx, zz, xz, ..StressTensor::default() };
                    let got = shape.stress(&pressure, [x, 0.5, z], &flat);
                    for (g, e) in [got.xx, got.zz, got.xz].iter().zip(disc(radius, x, z)) {
                        worst = worst.max((g - e).abs());
                    }
                }
            }
            worst
        };
        // What is left is of second order.
        let (near, far) = (off(40.0), off(80.0));
        assert!(near < 3e-3 && far < 0.3 * near, "{near} {far}");
    }
}
