//! Stresses in a half-space under uniform pressure on a rectangle (Love).
//!
//! Conventions: the rectangle is |x'| <= a, |y'| <= b of the surface z = 0, z points into the body,
//! x and y are the point's coordinates minus those of the rectangle's centre, stress is positive in
//! tension, the pressure is 1.
//!
//! On the surface the field jumps across the rectangle's edges. The value on an edge is the mean of
//! both sides, at a corner a quarter: sigma_zz is -1 inside, -1/2 on an edge, -1/4 at a corner, 0
//! outside, and two rectangles that share an edge add up to what one large one gives. A surface
//! point counts as on an edge if its coordinate is within four units in the last place of it.
//! sigma_xz and sigma_yz vanish on the surface everywhere. sigma_xy grows like ln(rho) towards a
//! corner on the surface; at the corner itself its finite part is taken, with rho measured in
//! sqrt(a b): the contributions of the four cells of a tensor grid that meet there then cancel for
//! equal pressures, as required.
//!
//! # How cancellation is avoided
//!
//! The textbook formula is a second difference over the four corners, u = x +- a and v = y +- b.
//! Far away and for thin cells it loses R^2 / (a b), and next to the rectangle near the surface
//! sigma_zz, which falls like z^3, is the difference of terms of order one. Therefore
//!
//! - the shears are written with both differences formed exactly; they are accurate everywhere;
//! - on the surface the normal stresses need one arctangent, whose argument factorises;
//! - inside, the normal stresses are the textbook sums, which also return their cancellation;
//! - where the cancellation is too large, and far away, the stresses of a line load of finite
//!   length, which factorise, are integrated across the shorter side by Gauss's rule on panels
//!   graded towards the point.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::base::StressTensor;

/// Stress at (`x`, `y`, `z`) per unit pressure on the rectangle |x'| <= `a`, |y'| <= `b`, z' = 0.
///
/// `x`, `y`: any finite length, relative to the rectangle's centre (point minus cell); `z` >= 0
/// into the body; `a`, `b` > 0: half-sides; all in one unit of length. `nu`: Poisson's ratio, 0 to
/// 0.5. Finite everywhere; for points on edges and at corners see the module. Lengths other than
/// zero should lie within 1e-40 to 1e40, where no intermediate over- or underflows.
///
/// Source: Love 1929, Phil. Trans. R. Soc. A 228, 377; in the form of Eqs. 5 to 10 of the study
/// that the package reproduces, which prints the differences x, y with the opposite sign and so
/// flips sigma_xz and sigma_yz. With the solid angle W of the rectangle seen from the point, B_x =
/// second difference of u v z / (rho (u^2 + z^2)) and E = second difference of atan(u/v) - atan(u z
/// / (v rho)): 2 pi sigma_xx = (1 - 2 nu) E - W + B_x, 2 pi sigma_zz = -(W + B_x + B_y).
pub fn stress(x: f64, y: f64, z: f64, a: f64, b: f64, nu: f64) -> StressTensor {
    debug_assert!(a > 0.0 && b > 0.0, "half-sides must be positive: {a}, {b}");
    debug_assert!(z >= 0.0, "z points into the body: {z}");
    let (sign_x, sign_y) = (1f64.copysign(x), 1f64.copysign(y));
    let cell = Cell::new(x, y, z, a, b);
    let StressTensor { xx, yy, zz, .. } = cell.normal(nu).stress(nu);
    let (xz, yz) = cell.shears_of_depth();
    StressTensor {
        xx,
        yy,
        zz,
        xy: sign_x * sign_y * cell.in_plane_shear(nu),
        xz: sign_x * xz,
        yz: sign_y * yz,
    }
}

/// Panels of half-width h at the distance D from the point are integrated by one rule if D >= 5 h.
const PANEL_REACH: f64 = 5.0;
/// Distance (in shorter half-sides) beyond which the whole rectangle is one panel, whose at most
/// eight lines cost no more than the four corners.
const FAR_REACH: f64 = 16.0;
/// Largest tolerated ratio of the corner terms to a stress: 3e3 times a rounding error of 2e-16.
const LARGEST_CANCELLATION: f64 = 3e3;

/// Gauss-Legendre nodes and weights, and the distance in half-widths beyond which each rule is
/// accurate to 1e-13 (Abramowitz and Stegun 1964, table 25.4).
const RULES: [(f64, &[(f64, f64)]); 3] = [
    (
        1000.0,
        &[
            (-0.774_596_669_241_483_4, 0.555_555_555_555_555_6),
            (0.0, 0.888_888_888_888_889),
            (0.774_596_669_241_483_4, 0.555_555_555_555_555_6),
        ],
    ),
    (
        40.0,
        &[
            (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
            (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
            (0.0, 0.568_888_888_888_888_9),
            (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
            (0.906_179_845_938_664, 0.236_926_885_056_189_1),
        ],
    ),
    (
        PANEL_REACH,
        &[
            (-0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
            (-0.796_666_477_413_626_7, 0.222_381_034_453_374_47),
            (-0.525_532_409_916_329, 0.313_706_645_877_887_3),
            (-0.183_434_642_495_649_8, 0.362_683_783_378_362),
            (0.183_434_642_495_649_8, 0.362_683_783_378_362),
            (0.525_532_409_916_329, 0.313_706_645_877_887_3),
            (0.796_666_477_413_626_7, 0.222_381_034_453_374_47),
            (0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
        ],
    ),
];

/// The integrals over the loaded area that form the three normal stresses; rho is the distance.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    /// The integral of z / rho^3, the solid angle.
    angle: f64,
    /// The integral of 1/(rho (rho + z)) - y^2 (2 rho + z) / (rho^3 (rho + z)^2), the part of
    /// sigma_xx with 1 - 2 nu; that of sigma_yy is `angle` less this.
    lateral: f64,
    /// The integral of 3 z x^2 / rho^5.
    direct_x: f64,
    /// The integral of 3 z y^2 / rho^5.
    direct_y: f64,
    /// The integral of 3 z^3 / rho^5.
    direct_z: f64,
}

impl Sums {
    fn stress(&self, nu: f64) -> StressTensor {
        let lateral = 1.0 - 2.0 * nu;
        StressTensor {
            xx: (lateral * self.lateral - self.direct_x) / (2.0 * PI),
            yy: (lateral * (self.angle - self.lateral) - self.direct_y) / (2.0 * PI),
            zz: -self.direct_z / (2.0 * PI),
            ..Default::default()
        }
    }

    /// The sums with x and y exchanged.
    fn transposed(self) -> Self {
        Self {
            lateral: self.angle - self.lateral,
            direct_x: self.direct_y,
            direct_y: self.direct_x,
            ..self
        }
    }

    fn add_scaled(&mut self, other: Self, k: f64) {
        self.angle += k * other.angle;
        self.lateral += k * other.lateral;
        self.direct_x += k * other.direct_x;
        self.direct_y += k * other.direct_y;
        self.direct_z += k * other.direct_z;
    }
}

/// One direction of the surface, reflected so that the point's coordinate is not negative.
#[derive(Debug, Clone, Copy)]
struct Side {
    /// Coordinate of the point relative to the rectangle's centre.
    at: f64,
    /// Half-side of the rectangle.
    half: f64,
    /// `at` + `half`, `at` - `half`.
    ends: [f64; 2],
}

impl Side {
    fn new(at: f64, half: f64, on_surface: bool) -> Self {
        let at = at.abs();
        let mut ends = [at + half, at - half];
        if on_surface && ends[1].abs() <= 4.0 * f64::EPSILON * ends[0] {
            ends[1] = 0.0;
        }
        Self { at, half, ends }
    }
}

/// A point and a rectangle.
struct Cell {
    x: Side,
    y: Side,
    z: f64,
    /// rho[i][j]: distance from the corner (u_i, v_j).
    rho: [[f64; 2]; 2],
}

impl Cell {
    fn new(x: f64, y: f64, z: f64, a: f64, b: f64) -> Self {
        let (x, y) = (Side::new(x, a, z == 0.0), Side::new(y, b, z == 0.0));
        let rho = x.ends.map(|u| y.ends.map(|v| (u * u + v * v + z * z).sqrt()));
        Self { x, y, z, rho }
    }

    /// Sums of the normal stresses, by the form that is accurate at the point.
    fn normal(&self, nu: f64) -> Sums {
        if self.z == 0.0 {
            return self.surface();
        }
        let across_x = self.x.half <= self.y.half;
        let (across, along) = if across_x { (self.x, self.y) } else { (self.y, self.x) };
        let lines = || {
            let sums = strip(across.at, along.at, self.z, across.half, along.half);
            if across_x { sums } else { sums.transposed() }
        };
        if reach(across.at, along.at, self.z, across.half, along.half) >= FAR_REACH {
            return lines();
        }
        let (sums, largest) = self.corners();
        let lateral = 1.0 - 2.0 * nu;
        let smallest = (lateral * sums.lateral.abs() + sums.direct_x.abs())
            .min(lateral * (sums.angle - sums.lateral).abs() + sums.direct_y.abs())
            .min(sums.direct_z.abs());
        if largest > LARGEST_CANCELLATION * smallest { lines() } else { sums }
    }

    /// Love's sums over the corners for z > 0, and the sum of the terms' magnitudes.
    fn corners(&self) -> (Sums, f64) {
        let (mut angle, mut lateral, mut b_x, mut b_y) = (0.0, 0.0, 0.0, 0.0);
        let mut largest = 0.0;
        let z = self.z;
        for (i, &u) in self.x.ends.iter().enumerate() {
            for (j, &v) in self.y.ends.iter().enumerate() {
                // A corner directly above or beside the point contributes nothing: every term is
                // odd in u and v.
                if u == 0.0 || v == 0.0 {
                    continue;
                }
                let sign = if i == j { 1.0 } else { -1.0 };
                let rho = self.rho[i][j];
                let (uu, vv, uv) = (u * u, v * v, sign * u * v);
                let w = (uv / (z * rho)).atan();
                // atan(u/v) - atan(u z / (v rho)) in one: rho - z = (u^2 + v^2) / (rho + z).
                let e = (uv * (uu + vv) / ((rho + z) * (vv * rho + uu * z))).atan();
                let common = uv * z / rho;
                let (x_term, y_term) = (common / (uu + z * z), common / (vv + z * z));
                angle += w;
                lateral += e;
                b_x += x_term;
                b_y += y_term;
                largest += w.abs() + e.abs() + x_term.abs() + y_term.abs();
            }
        }
        let sums = Sums {
            angle,
            lateral,
            direct_x: angle - b_x,
            direct_y: angle - b_y,
            direct_z: angle + b_x + b_y,
        };
        (sums, largest)
    }

    /// The sums for z = 0, where the direct parts are the solid angle or zero.
    fn surface(&self) -> Sums {
        let ([u1, u2], [v1, v2]) = (self.x.ends, self.y.ends);
        if u2 > 0.0 || v2 > 0.0 {
            // Sum of the arguments of v + i u, as one argument whose imaginary part is free of
            // cancellation: (v1 + i u1)(v2 + i u2) and (v1 + i u2)(v2 + i u1) share a real part.
            let real = v1 * v2 - u1 * u2;
            let (xy, ab) = (self.x.at * self.y.at, self.x.half * self.y.half);
            // x y - a b from the distances to the edges, which are accurate next to the corner.
            let beyond = u2 * self.y.at + self.x.half * v2;
            let lateral = (-4.0 * ab * real).atan2(real * real + 4.0 * beyond * (xy + ab));
            return Sums { lateral, ..Default::default() };
        }
        // Inside and on the boundary every term has one sign; an edge's two sides average to 0.
        let turn = |w: f64| if w == 0.0 { 1.0 } else { 2.0 };
        let angle = FRAC_PI_2 * turn(u2) * turn(v2);
        let term = |u: f64, v: f64| if v == 0.0 { 0.0 } else { (u / v).atan() };
        let lateral = term(u1, v1) + term(-u2, v1) + term(u1, -v2) + term(-u2, -v2);
        Sums { angle, lateral, direct_x: angle, direct_y: angle, direct_z: angle }
    }

    /// sigma_xy for x, y >= 0: both terms of Love's A_xy, (2 nu - 1) ln(rho + z) - z/rho, as exact
    /// multiples of x y. They factorise because rho11^2 rho22^2 - rho12^2 rho21^2 = -16 a b x y.
    fn in_plane_shear(&self, nu: f64) -> f64 {
        let z = self.z;
        let [[r11, r12], [r21, r22]] = self.rho;
        let (own, cross) = (r11 * r22, r12 * r21);
        let total = r11 + r22 + r12 + r21;
        let difference =
            -16.0 * (self.x.half * self.x.at) * (self.y.half * self.y.at) / (own + cross);
        let below = (r12 + z) * (r21 + z);
        let excess = difference * (1.0 + 2.0 * z / total) / below;
        let log = if excess > -0.5 {
            excess.ln_1p()
        } else {
            let corner = if r22 + z == 0.0 { (self.x.half * self.y.half).sqrt() } else { r22 + z };
            ((r11 + z) * corner / below).ln()
        };
        // Second difference of z/rho.
        let ratio = if z == 0.0 {
            0.0
        } else {
            let rest = r12 * r12 + r21 * r21 + (r12 + r21) * (r11 + r22);
            -z * difference * rest / (total * own * cross)
        };
        ((2.0 * nu - 1.0) * log - ratio) / (2.0 * PI)
    }

    /// sigma_xz and sigma_yz for x, y >= 0.
    fn shears_of_depth(&self) -> (f64, f64) {
        if self.z == 0.0 {
            return (0.0, 0.0);
        }
        let [[r11, r12], [r21, r22]] = self.rho;
        let xz = depth_shear(self.x, self.y, self.z, self.rho);
        let transposed = [[r11, r21], [r12, r22]];
        let yz = depth_shear(self.y, self.x, self.z, transposed);
        (xz, yz)
    }
}

/// sigma_xz: the second difference of v z^2 / (rho (u^2 + z^2)).
///
/// With c_i^2 = u_i^2 + z^2 and s_i = v / rho_i the difference in u is -4 a x z^2 / (c_1^2 c_2^2)
/// K(s_1, s_2), K = (s_1^2 + s_2^2 + s_1 s_2 - s_1^2 s_2^2) / (s_1 + s_2), and for 0 < v_2 < v_1
/// K's difference in one s at a fixed other t is (s - s') m (1 - t^2) / (m + t^2), m = s s' + t (s
/// + s'): products of positive numbers only.
fn depth_shear(x: Side, y: Side, z: f64, rho: [[f64; 2]; 2]) -> f64 {
    let (u, v) = (x.ends, y.ends);
    let c = u.map(|u| u * u + z * z);
    let s = rho.map(|r| [v[0] / r[0], v[1].abs() / r[1]]);
    let k = |j: usize| {
        let (s, t) = (s[0][j], s[1][j]);
        (s * s + t * t + s * t * (1.0 - s * t)) / (s + t)
    };
    let difference = if v[1] > 0.0 {
        // Step in s_i from v2 to v1 with the other s at `other`, whose 1 - s^2 is `rest`.
        let step = |i: usize, other: f64, rest: f64| {
            let [r1, r2] = rho[i];
            let rise = c[i] * 4.0 * y.half * y.at / (r1 * r2 * (v[0] * r2 + v[1] * r1));
            let m = s[i][0] * s[i][1] + other * (s[i][0] + s[i][1]);
            rise * m * rest / (m + other * other)
        };
        step(0, s[1][0], c[1] / (rho[1][0] * rho[1][0]))
            + step(1, s[0][1], c[0] / (rho[0][1] * rho[0][1]))
    } else if v[1] < 0.0 {
        k(0) + k(1)
    } else {
        k(0)
    };
    -2.0 / PI * x.half * x.at * (z * z / (c[0] * c[1])) * difference
}

/// Distance from a point to the middle line of a rectangle of half-width `half` across and
/// `half_along` along, in units of `half`.
fn reach(across: f64, along: f64, z: f64, half: f64, half_along: f64) -> f64 {
    let gap = (along.abs() - half_along).max(0.0);
    (across * across + gap * gap + z * z).sqrt() / half
}

/// Sums for z > 0 by Gauss's rule over lines along y, `half` the half-width in x; a rectangle too
/// wide for its distance is divided in two, first below the point, so that the distances of parts
/// next to it stay accurate. The recursion ends because the point is off the surface: the integrand
/// is analytic within the distance from [`reach`].
fn strip(x: f64, y: f64, z: f64, half: f64, half_along: f64) -> Sums {
    let distance = reach(x, y, z, half, half_along);
    let mut sums = Sums::default();
    match RULES.iter().find(|(from, _)| distance >= *from) {
        Some((_, rule)) => {
            for &(node, weight) in *rule {
                sums.add_scaled(line(x - half * node, y, z, half_along), weight * half);
            }
        }
        None => {
            let (first, last) = (x - half, x + half);
            let cut = if first < 0.0 && last > 0.0 { 0.0 } else { x };
            for (a, b) in [(first, cut), (cut, last)] {
                let part = strip(0.5 * (a + b), y, z, 0.5 * (b - a), half_along);
                sums.add_scaled(part, 1.0);
            }
        }
    }
    sums
}

/// Sums of a line load of unit density on x' = 0, |y'| <= `b`, at (`x`, `y`, `z`), y >= 0, z > 0.
///
/// The integrals along y of the point load's terms ([`super::boussinesq`]); with c^2 = x^2 + z^2
/// and s = v / rho they are z s / c^2, v / (rho (rho + z)), z x^2 (3 s - s^3) / c^4, z s^3 / c^2
/// and z^3 (3 s - s^3) / c^4, differenced between the ends v = y + b and y - b.
fn line(x: f64, y: f64, z: f64, b: f64) -> Sums {
    let (v1, v2) = (y + b, y - b);
    let c = x * x + z * z;
    let (r1, r2) = ((c + v1 * v1).sqrt(), (c + v2 * v2).sqrt());
    let (s1, s2) = (v1 / r1, v2 / r2);
    // (s1 - s2) / c^2 and (3 - s1^2 - s1 s2 - s2^2) / c^2, which stay finite as c tends to 0 when
    // both ends lie on one side.
    let (rise, rest) = if v2 > 0.0 {
        let (q1, q2) = (1.0 / (r1 * r1), 1.0 / (r2 * r2));
        let both = (q1 + s1 * s1 * q2) / (1.0 + s1 * s2);
        (4.0 * b * y / (r1 * r2 * (v1 * r2 + v2 * r1)), q1 + both + q2)
    } else {
        ((s1 - s2) / c, (3.0 - s1 * s1 - s1 * s2 - s2 * s2) / c)
    };
    let lateral = (2.0 * b * (c - v1 * v2) / (r1 * r2) + z * c * rise) / ((r1 + z) * (r2 + z));
    Sums {
        angle: z * rise,
        lateral,
        direct_x: z * x * x * rise * rest,
        direct_y: z * rise * (s1 * s1 + s1 * s2 + s2 * s2),
        direct_z: z * z * z * rise * rest,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corner_sums_equal_lines_where_both_hold() {
        for (x, y, z, a, b) in
            [(0.9, 0.4, 0.7, 0.6, 0.8), (1.5, 2.0, 0.5, 0.6, 0.5), (0.0, 0.0, 2.0, 1.0, 0.3)]
        {
            let cell = Cell::new(x, y, z, a, b);
            let (corners, _) = cell.corners();
            for lines in [strip(x, y, z, a, b), strip(y, x, z, b, a).transposed()] {
                for (got, want) in [
                    (lines.angle, corners.angle),
                    (lines.lateral, corners.lateral),
                    (lines.direct_x, corners.direct_x),
                    (lines.direct_y, corners.direct_y),
                    (lines.direct_z, corners.direct_z),
                ] {
                    assert!((got - want).abs() < 1e-13, "{got} {want} at {x} {y} {z}");
                }
            }
        }
    }

    #[test]
    fn surface_values_on_the_boundary() {
        let zz = |x, y| stress(x, y, 0.0, 0.7, 0.4, 0.3).zz;
        assert_eq!(
            [zz(0.1, 0.2), zz(0.7, 0.2), zz(0.1, -0.4), zz(-0.7, 0.4)],
            [-1.0, -0.5, -0.5, -0.25]
        );
        assert_eq!(zz(0.71, 0.0), 0.0);
        let rounded = 0.7 * (1.0 + f64::EPSILON);
        assert_eq!(zz(rounded, 0.1), -0.5);
    }
}
