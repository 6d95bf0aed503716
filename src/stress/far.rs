//! The stress far from the contact, where only the load's resultants along the line count.
//!
//! - A body between two free faces is a thin plate there: in plane stress under the load, and bent
//!   by the moment about its own middle. Kirchhoff's plate, loaded on its edge z = 0 by the moment
//!   m per length (Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells, 1959, articles 21
//!   and 22), has the moments of an edge moment m cos(k x)
//!   - M_z = m (1 - c k z) e^(-k z) cos(k x), with c = (1 - nu) / (3 + nu),
//!   - M_x = -c m (1 - k z) e^(-k z) cos(k x),
//!   - M_xz = m (2 / (3 + nu) - c k z) e^(-k z) sin(k x),
//!
//!   and of an edge torque m cos(k x) by tractions along x
//!   - M_z = -c m k z e^(-k z) sin(k x),
//!   - M_x = m (2 (1 + nu) / (3 + nu) + c k z) e^(-k z) sin(k x),
//!   - M_xz = m ((1 + nu) / (3 + nu) + c k z) e^(-k z) cos(k x).
//!
//!   Their integrals over k are those of a moment at one point of the edge. The shear forces are
//!   the derivatives of a harmonic function. Kirchhoff's free edge carries a torque, and a shear
//!   force that balances it. What takes both from the true edge is torsion, which decays over the
//!   plate's thickness: harmonic functions of y and z.
//! - A half-space, with images or without, is under forces at points (Boussinesq).

use super::field::Field;
use super::flat::FlatStress;
use crate::base::StressTensor;
use crate::body::transition;
use crate::kernels::boussinesq;
use std::f64::consts::PI;

/// Distance from the contact, in half-lengths of the body, beyond which a point is far. Waves so
/// long that they reach it are few, and the equations of free faces are close to singular for them.
const FAR: f64 = 10.0;

/// Distance along the surface of a short body (C) up to which the waves still count: what the
/// plate's layer leaves out falls with the distance, and with the half-length below one and at 10
/// half-lengths it is up to 0.005 p0 under loads beside the middle. Of sigma_zz it leaves out all,
/// which is Kirchhoff's up to the edge, and 0.001 p0 off near it at any distance.
const BESIDE: f64 = 20.0;

/// Depth of the edge's layer, in half-lengths of the body, and terms of its series.
const LAYER: f64 = 8.0;
const TERMS: u32 = 60;

/// A load on a piece of the line: its place from the body's middle, its length and its force.
pub(super) struct Piece {
    /// The place on the line.
    y: f64,
    /// The place from the body's middle.
    off: f64,
    length: f64,
    force: f64,
}

/// Moments and shear forces of a plate per moment: M_x, M_z, M_xz, Q_x, Q_z.
type Bending = [f64; 5];

impl Field<'_> {
    /// Whether the point (`x`, `z`) is so far from the contact that its stress is that of the
    /// load's resultants.
    pub(crate) fn is_far(&self, x: f64, z: f64) -> bool {
        let (reach, freed) = (FAR * self.stack.body().half, self.stack.body().end.freed);
        let distant = (x * reach / self.beside()).hypot(z) > reach;
        // Forces along a half-space's surface have no formula here.
        distant && (freed || self.traction.is_none())
    }

    /// The distance beside the contact (C) beyond which a point on the surface is far.
    pub(super) fn beside(&self) -> f64 {
        let reach = FAR * self.stack.body().half;
        if self.stack.body().end.freed { BESIDE.max(reach) } else { reach }
    }

    /// The stress at a far point under the `pieces` of the load.
    pub(super) fn far(&self, pieces: &[Piece], [x, y, z]: [f64; 3]) -> FlatStress {
        let y = y - self.stack.middle;
        if self.stack.body().end.freed {
            return self.in_plate(pieces, [x, y, z]);
        }
        self.in_half_space(pieces, [x, y, z]).into()
    }

    /// The load in pieces along the whole line.
    pub(super) fn pieces(&self) -> Vec<Piece> {
        let (load, middle) = (self.pressure, self.stack.middle);
        let forces = load.transforms(&[0.0]);
        let nodes = load.axis().nodes().iter().zip(load.axis().weights()).zip(forces.iter());
        let sides: &[f64] = if load.is_symmetric() { &[1.0, -1.0] } else { &[1.0] };
        let piece = |((y, length), force): ((&f64, &f64), &f64)| {
            let at = |side: &f64| Piece {
                y: side * y,
                off: side * y - middle,
                length: *length,
                force: length * force,
            };
            sides.iter().map(at).collect::<Vec<_>>()
        };
        nodes.flat_map(piece).collect()
    }

    fn in_plate(&self, pieces: &[Piece], [x, y, z]: [f64; 3]) -> FlatStress {
        let body = self.stack.body();
        let (half, nu) = (body.half, body.nu);
        let moment: f64 = pieces.iter().map(|piece| piece.force * piece.off).sum();
        let stress = |plane: [f64; 3], bending: Bending| {
            let own = plane.map(|s| s / (2.0 * half));
            let [m_x, m_z, m_xz, q_x, q_z] = bending.map(|of_one| moment * of_one);
            let linear = -1.5 * y / half.powi(3);
            let parabolic = -0.75 * (half * half - y * y) / half.powi(3);
            StressTensor {
                xx: own[0] + linear * m_x,
                yy: 0.0,
                zz: own[1] + linear * m_z,
                xy: parabolic * q_x,
                xz: own[2] + linear * m_xz,
                yz: parabolic * q_z,
            }
        };
        let mut pressure = stress(self.pressure.endless_of_all(x, z), bent(x, z, nu));
        if z < LAYER * half {
            let [_, _, torque, ..] = bent(x, 0.0, nu);
            let [xz, xy, yz] = untwisted(y, z, half);
            let twist = -1.5 * moment * torque / half.powi(3);
            pressure.xz += twist * xz;
            pressure.xy += twist * xy;
            // Beside a moment at one point the torque of the edge falls like 1 / x.
            pressure.yz -= twist / x * yz;
        }
        let traction = self.traction.map_or(StressTensor::default(), |own| {
            let mut plane = [0.0; 3];
            for piece in pieces {
                let part = own.endless_along(piece.y, x, z).map(|s| s * piece.length);
                plane.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
            }
            stress(plane, twisted(x, z, nu))
        });
        FlatStress { pressure, traction }
    }

    fn in_half_space(&self, pieces: &[Piece], [x, y, z]: [f64; 3]) -> StressTensor {
        let body = self.stack.body();
        let (half, nu) = (body.half, body.nu);
        let images: &[(f64, f64)] = match body.end.image_weight {
            Some(_) => &[(1.0, 0.0), (-1.0, 2.0), (-1.0, -2.0)],
            None => &[(1.0, 0.0)],
        };
        let at = |y: f64| {
            let mut sum = StressTensor::default();
            for piece in pieces {
                for (sign, shift) in images {
                    let place = sign * piece.off + shift * half;
                    sum += boussinesq::stress(x, y - place, z, nu) * piece.force;
                }
            }
            sum
        };
        let mut stress = at(y);
        if let Some(gamma) = self.gamma {
            for face in [half, -half] {
                stress.yy -= transition((face - y).abs(), z, gamma) * at(face).yy;
            }
        }
        stress
    }
}

/// The integrals over the wavenumber k of e^(-k z) / pi times cos(k x), k z cos(k x), sin(k x),
/// k z sin(k x), k cos(k x) and k sin(k x).
fn integrals(x: f64, z: f64) -> [f64; 6] {
    let r = x.hypot(z);
    let (s, c) = (x / r, z / r);
    let (one, double) = (1.0 / (PI * r), c * c - s * s);
    let integrals = [c, c * double, s, 2.0 * s * c * c, double / r, 2.0 * s * c / r];
    integrals.map(|integral| one * integral)
}

/// The plate under a moment at x = 0 of its edge.
fn bent(x: f64, z: f64, nu: f64) -> Bending {
    let [cos, z_cos, sin, z_sin, k_cos, k_sin] = integrals(x, z);
    let (c, share) = ((1.0 - nu) / (3.0 + nu), 2.0 / (3.0 + nu));
    let moments = [-c * (cos - z_cos), cos - c * z_cos, share * sin - c * z_sin];
    [moments[0], moments[1], moments[2], -share * k_sin, -share * k_cos]
}

/// Stresses xz and xy of the layer that takes the shear stress xz = y from the edge z = 0 of a
/// plate of half-thickness `half`, and per change of that along x the stress yz.
fn untwisted(y: f64, z: f64, half: f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for n in 0..TERMS {
        let wave = f64::from(2 * n + 1) * PI / (2.0 * half);
        let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
        let size = sign * 2.0 / (half * wave * wave) * (-wave * z).exp();
        let (sin, cos) = (wave * y).sin_cos();
        sum[0] -= size * sin;
        sum[1] += size * cos;
        sum[2] += size / wave * cos;
    }
    sum
}

/// The plate under a torque at x = 0 of its edge, by tractions along x.
fn twisted(x: f64, z: f64, nu: f64) -> Bending {
    let [cos, z_cos, sin, z_sin, k_cos, k_sin] = integrals(x, z);
    let (c, share) = ((1.0 - nu) / (3.0 + nu), 2.0 / (3.0 + nu));
    let torque = 0.5 * (1.0 + nu) * share * cos + c * z_cos;
    let moments = [(1.0 + nu) * share * sin + c * z_sin, -c * z_sin, torque];
    [moments[0], moments[1], moments[2], share * k_cos, -share * k_sin]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Equilibrium of the plate: div M = Q, div Q = 0, by central differences, and the edge free of
    /// moments away from its load, but for the torque that shear forces replace.
    #[test]
    fn plates_are_in_equilibrium() {
        let (nu, step) = (0.3, 1e-4);
        for of in [bent, twisted] {
            for (x, z) in [(0.7, 1.1), (-2.0, 0.4), (0.0, 3.0)] {
                let along =
                    |i: usize| (of(x + step, z, nu)[i] - of(x - step, z, nu)[i]) / (2.0 * step);
                let down =
                    |i: usize| (of(x, z + step, nu)[i] - of(x, z - step, nu)[i]) / (2.0 * step);
                let [_, _, _, q_x, q_z] = of(x, z, nu);
                assert!((along(0) + down(2) - q_x).abs() < 1e-6);
                assert!((along(2) + down(1) - q_z).abs() < 1e-6);
                assert!((along(3) + down(4)).abs() < 1e-6);
            }
            // Kirchhoff's edge: no moment, no Q_z + d M_xz / dx.
            let edge = |x: f64| of(x, 0.0, nu);
            let shear = edge(1.5)[4] + (edge(1.5 + step)[2] - edge(1.5 - step)[2]) / (2.0 * step);
            assert!(edge(1.5)[1].abs() < 1e-12 && shear.abs() < 1e-6, "{shear}");
        }
    }

    /// The layer takes from the edge what Kirchhoff's plate leaves there, and is free on the faces.
    #[test]
    fn the_edge_is_untwisted() {
        let half = 1.3;
        for y in [-1.1, 0.2, 0.9] {
            let [xz, _, yz] = untwisted(y, 0.0, half);
            assert!((xz + y).abs() < 2e-2 && (yz - 0.5 * (half * half - y * y)).abs() < 1e-4);
            let [_, on_face, yz] = untwisted(half, 0.4, half);
            assert!(on_face.abs() < 1e-12 && yz.abs() < 1e-12);
        }
    }
}
