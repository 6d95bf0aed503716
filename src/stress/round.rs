//! The contribution of a body's round shape to the stresses of a flat body, to first order in C /
//! R.
//!
//! The stress in a disc loaded normally on its circumference is exactly the sum of the radial
//! half-plane fields of all elements of the load, each behind its own tangent, and of a uniform
//! tension that frees the circumference of normal traction (Timoshenko and Goodier, Theory of
//! Elasticity, 1970, article 41). Near one of two opposite contacts this is, to first order in C /
//! R and in the frame of the surface above the point, the flat half-plane's field, a uniform
//! sigma_xx of w' / (pi R), with w' the load per length, and for each load p ds at the distance u
//! along the surface and the depth z, r^2 = u^2 + z^2,
//!
//! - xx: -(p ds / (pi R)) (u^4 / r^4 + 4 u^4 z^2 / r^6),
//! - zz: (p ds / (pi R)) (u^2 z^2 / r^4 - 4 u^2 z^4 / r^6),
//! - xz: -(p ds / (pi R)) 4 u^3 z^3 / r^6,
//!
//! from the load's tilt u / R and from the drop u^2 / (2 R) of the surface. The uniform tension
//! thus vanishes on the surface itself, and some C below it alone remains. These terms are those of a
//! plane contact. Along a straight, parallel line it is everywhere that of Hertz: near an end they
//! depend on the loads within about C of a point, where the variation of p is an effect of second
//! order. With a profile or a tilt it is the local one, [`LocalContact`]. No stress along y belongs to
//! them; under plane strain this neglects some 0.1 C / R.
//!
//! The frame of the surface above the point is rotated by x / R, and a point at the vertical depth
//! z lies x z / R farther out along the surface than x. Rotation and shift apply to the whole flat
//! field, including its free ends.

use super::flat::FlatStress;
use crate::base::StressTensor;
use multiversion::multiversion;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Points of Gauss's rule for the weight sqrt(1 - t^2) across the contact, in groups that are
/// summed together.
const POINTS: usize = GROUPS * LANES;
const GROUPS: usize = 5;
const LANES: usize = 8;

/// Distance from the contact's end (C) within which its local half-width is not that of the loads
/// around.
const END_REACH: f64 = 1.0;

/// Nodes of the rule on [-1, 1], and weights that include the Hertz pressure sqrt(1 - t^2).
type Rule = [[[f64; LANES]; 2]; GROUPS];

static RULE: LazyLock<Rule> = LazyLock::new(|| {
    let angle = |i: usize| PI * (i + 1) as f64 / (POINTS + 1) as f64;
    std::array::from_fn(|group| {
        let angles: [f64; LANES] = std::array::from_fn(|lane| angle(group * LANES + lane));
        [angles.map(f64::cos), angles.map(|angle| PI / (POINTS + 1) as f64 * angle.sin().powi(2))]
    })
});

/// The uniform sigma_xx of a disc compressed across its diameter, w' / (pi R) with the mean line
/// load, per C / R (p0).
pub const DIAMETRAL_TENSION: f64 = 0.5;

/// The plane contact near a place of the line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalContact {
    /// Its half-width (C).
    pub half_width: f64,
    /// Its largest pressure, of a semi-elliptic one with the same load (p0).
    pub peak: f64,
}

impl LocalContact {
    /// The Hertz contact of the mean load.
    pub const HERTZ: LocalContact = LocalContact { half_width: 1.0, peak: 1.0 };

    /// The place whose load counts at `y`, in a contact that has these `ends`: what is added depends on the loads within
    /// C, of which the steep ends themselves are no measure.
    pub fn place(y: f64, [from, to]: [f64; 2]) -> f64 {
        let inset = END_REACH.min(0.5 * (to - from));
        y.clamp(from + inset, to - inset)
    }

    /// The Hertz contact of a `load` per length (C p0), its half-width in units of C its pressure in units of p0; none pulls.
    pub fn carrying(load: f64) -> Self {
        let half_width = (2.0 / PI * load.max(0.0)).sqrt();
        Self { half_width, peak: half_width }
    }

    /// Contributions of the loads' tilt and of the surface's drop to xx, zz and xz at (`x`, `z`) (C).
    fn tilted(&self, x: f64, z: f64) -> [f64; 3] {
        let Self { half_width, peak } = *self;
        if half_width <= 0.0 {
            return [0.0; 3];
        }
        tilted(&RULE, x / half_width, z / half_width).map(|sum| half_width * peak * sum / PI)
    }
}

/// A stress of a body whose surface may be round, in units of p0.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RoundStress {
    /// The flat body's stress.
    pub flat: FlatStress,
    /// The contribution of the round shape per C / R.
    pub round: StressTensor,
}

impl RoundStress {
    /// The stress at x and the depth `z` below the surface (C), where the flat body has the stress
    /// `flat` with the derivative `slope` along x, per C, under the pressure of `contact`.
    pub fn new(
        x: f64,
        z: f64,
        flat: impl Into<FlatStress>,
        slope: &StressTensor,
        contact: &LocalContact,
    ) -> Self {
        let whole = flat.into();
        let flat = whole.pressure;
        let [xx, zz, xz] = contact.tilted(x, z);
        let turned = StressTensor {
            xx: -2.0 * flat.xz,
            yy: 0.0,
            zz: 2.0 * flat.xz,
            xy: -flat.yz,
            xz: flat.xx - flat.zz,
            yz: flat.xy,
        };
        let mut round = turned * x + *slope * (x * z);
        round.xx += DIAMETRAL_TENSION + xx;
        round.zz += zz;
        round.xz += xz;
        if z == 0.0 {
            // The tractions on the surface are known.
            (round.zz, round.xz, round.yz) = (0.0, 0.0, 0.0);
        }
        Self { flat: whole, round }
    }

    /// The stress (p0) under the pressure for C / R = `curvature`, positive for a convex body.
    pub fn at(&self, curvature: f64) -> StressTensor {
        self.flat.pressure + self.round * curvature
    }

    /// The stress at the mirror image in the plane x = 0.
    #[must_use]
    pub fn mirrored_in_x(&self) -> Self {
        let round = self.round.mirrored(StressTensor::ODD_IN_X);
        Self { flat: self.flat.mirrored_in_x(), round }
    }

    /// [`RoundStress::at`] without the diametral tension, which only a disc has that is squeezed between
    /// two loads.
    pub fn on_one_side(&self, curvature: f64) -> StressTensor {
        let tension = StressTensor { xx: DIAMETRAL_TENSION, ..StressTensor::default() };
        self.flat.pressure + (self.round - tension) * curvature
    }
}

/// Sums over the rule's loads of the contributions of their tilt and of the surface's drop to xx,
/// zz and xz at (`x`, `z`); compiled for the processor's vector units.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn tilted(rule: &Rule, x: f64, z: f64) -> [f64; 3] {
    let mut sums = [[0.0; LANES]; 3];
    for [nodes, weights] in rule {
        for lane in 0..LANES {
            let (u, w) = (x - nodes[lane], weights[lane]);
            let square = u * u + z * z;
            // A load at the point itself contributes nothing.
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
    use crate::kernels::strip;

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
        let plane = |x: f64, z: f64| {
            let [xx, zz, xz] = strip::stress(1.0, &[1.0], x, z);
            StressTensor { xx, zz, xz, ..StressTensor::default() }
        };
        let off = |radius: f64| {
            let mut worst: f64 = 0.0;
            for x in [0.0, 0.3, 0.7, 1.5, 2.5] {
                for z in [0.2, 0.5, 1.0, 2.0, 4.0] {
                    let slope = (plane(x + 1e-4, z) - plane(x - 1e-4, z)) * 5e3;
                    let got = RoundStress::new(x, z, plane(x, z), &slope, &LocalContact::HERTZ)
                        .at(1.0 / radius);
                    for (g, e) in [got.xx, got.zz, got.xz].iter().zip(disc(radius, x, z)) {
                        worst = worst.max((g - e).abs());
                    }
                }
            }
            worst
        };
        // The remainder is of second order.
        let (near, far) = (off(40.0), off(80.0));
        assert!(near < 3e-3 && far < 0.3 * near, "{near} {far}");
    }
}
