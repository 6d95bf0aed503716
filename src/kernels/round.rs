//! What a round surface adds to the deflection of a half-space, to first order in C / R.
//!
//! A point load P at a round surface, x across it, has the stresses c (x^2 - y^2) / r^4, minus that
//! and 2 c x y / r^4, c = (1 - 2 nu) P / (2 pi), along its tangent plane (Johnson, Contact
//! Mechanics, 1985, Eq. 3.19). The body lacks the skin between plane and surface, x^2 / (2 R)
//! thick, and with it these stresses (see [`crate::body::Skins`]). Their forces have no divergence
//! but for that of its thickness: the flat body carries the tractions -(x / R) times the first and
//! the last of these stresses. By Cerruti they displace it along z, in the transform over both
//! directions with K^2 = k^2 + l^2, by (1 - 2 nu)^2 / (1 - nu) l^2 / K^4 times P / R in units of
//! (1 - nu^2) / E. The displacement along the tangent, (1 - 2 nu) / (2 pi (1 - nu)) x / r^2 towards
//! the load, gives x / R of itself along the normal, (1 - 2 nu) / (1 - nu) (l^2 - k^2) / K^4. The
//! sum is the transform of
//!
//! (1 - 2 nu) / (4 pi (1 - nu)) ((3 - 2 nu) x^2 / r^2 - (1 - 2 nu) ln r)
//!
//! but for a constant: ln r has the transform -2 pi / K^2, and x^2 / r^2 has 2 pi (l^2 - k^2) /
//! K^4. Under a line load along y, l = 0, it is the |x| of plane strain.

use std::f64::consts::PI;

/// Distance in longer half-sides beyond which a rectangle is taken for its value and its curvature
/// in the middle: fourth derivatives add less than 1e-5.
const FAR: f64 = 16.0;

/// What the surface of a body of Poisson's ratio `nu` moves at (`x`, `y`) from the centre of the
/// rectangle |x'| <= `a`, |y'| <= `b` under the unit pressure there, per 1 / R, positive into the
/// body, in units of (1 - nu^2) / E. At the distance `zero` the logarithm of the distance is taken
/// for zero.
///
/// All lengths in one unit. Finite everywhere; to 1e-5 of its largest value far away, else to
/// rounding.
pub fn rectangle([x, y]: [f64; 2], [a, b]: [f64; 2], nu: f64, zero: f64) -> f64 {
    let free = 1.0 - 2.0 * nu;
    let square = x * x + y * y;
    let [directed, log] = if square > (FAR * a.max(b)).powi(2) {
        far([x, y], [a, b])
    } else {
        let mut sums = [0.0; 2];
        for (u, sign_u) in [(x + a, 1.0), (x - a, -1.0)] {
            for (v, sign_v) in [(y + b, 1.0), (y - b, -1.0)] {
                let corner = corner(u, v);
                sums.iter_mut().zip(corner).for_each(|(sum, own)| *sum += sign_u * sign_v * own);
            }
        }
        sums
    };
    let log = log - 4.0 * a * b * zero.ln();
    free / (4.0 * PI * (1.0 - nu)) * ((3.0 - 2.0 * nu) * directed - free * log)
}

/// The transform over both directions, at the wavenumbers `k` across and `l` along, of the
/// displacement by a force.
#[cfg(test)]
pub(crate) fn wave(k: f64, l: f64, nu: f64) -> f64 {
    let square = k * k + l * l;
    (1.0 - 2.0 * nu) / (1.0 - nu) * ((3.0 - 2.0 * nu) * l * l / square - 1.0) / square
}

/// Integrals of x^2 / r^2 and of ln r over the rectangle between the origin and (`u`, `v`).
fn corner(u: f64, v: f64) -> [f64; 2] {
    if u == 0.0 || v == 0.0 {
        return [0.0; 2];
    }
    let [beside_u, beside_v] = [u * u * (v / u).atan(), v * v * (u / v).atan()];
    let log = u * v * ((u * u + v * v).ln() - 3.0);
    [0.5 * (u * v + beside_u - beside_v), 0.5 * (log + beside_u + beside_v)]
}

/// The same integrals over a rectangle of half-sides `a`, `b` about (`x`, `y`), far from the
/// origin.
fn far([x, y]: [f64; 2], [a, b]: [f64; 2]) -> [f64; 2] {
    let square = x * x + y * y;
    let c = x * x / square;
    let [p, q] = [a * a / square, b * b / square];
    let directed = c + (p * (1.0 + c * (4.0 * c - 5.0)) + q * c * (3.0 - 4.0 * c)) / 3.0;
    let log = 0.5 * square.ln() + (p - q) * (1.0 - 2.0 * c) / 6.0;
    [4.0 * a * b * directed, 4.0 * a * b * log]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::gauss_legendre;

    /// The kernel of a force.
    fn force(x: f64, y: f64, nu: f64, zero: f64) -> f64 {
        let square = x * x + y * y;
        let directed = (3.0 - 2.0 * nu) * x * x / square;
        let free = 1.0 - 2.0 * nu;
        free / (4.0 * PI * (1.0 - nu)) * (directed - 0.5 * free * (square / (zero * zero)).ln())
    }

    #[test]
    fn rectangles_are_sums_of_forces() {
        let (nodes, weights) = gauss_legendre(24);
        let (nu, zero, a, b) = (0.27, 1.7, 0.2, 0.5);
        for [x, y] in [[0.9, 0.3], [-0.25, 1.4], [0.0, -0.9], [7.9, 1.0], [8.1, 1.2], [1.0, -30.0]]
        {
            let mut want = 0.0;
            for (g, wg) in nodes.iter().zip(&weights) {
                for (h, wh) in nodes.iter().zip(&weights) {
                    want += a * b * wg * wh * force(x - a * g, y - b * h, nu, zero);
                }
            }
            let got = rectangle([x, y], [a, b], nu, zero);
            assert!((got - want).abs() < 2e-6 * 4.0 * a * b, "{x} {y}: {got} {want}");
        }
        // Inside, the four quarters of it.
        let [x, y] = [0.05, -0.11];
        let quarter = |side: f64, along: f64| {
            let (low, high) = (side * a, along * b);
            let (du, dv) = (0.5 * (low - x).abs(), 0.5 * (high - y).abs());
            let centre = [0.5 * (x - low), 0.5 * (y - high)];
            rectangle(centre, [du, dv], nu, zero)
        };
        let want: f64 = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
            .map(|(s, t)| quarter(s, t))
            .iter()
            .sum();
        let got = rectangle([x, y], [a, b], nu, zero);
        assert!((got / want - 1.0).abs() < 1e-12, "{got} {want}");
    }

    /// Under a line load the surface moves by -(1 - 2 nu) |x| / (2 (1 - nu)) and a constant.
    #[test]
    fn a_long_strip_is_plane_strain() {
        let (nu, b) = (0.3, 1e5);
        let at = |x: f64| rectangle([x, 0.0], [1e-4, b], nu, 1.0) / 2e-4;
        let want = 0.5 * (1.0 - 2.0 * nu) / (1.0 - nu);
        for x in [0.5, 2.0] {
            let got = (at(x) - at(0.0)) / x;
            assert!((got / want - 1.0).abs() < 3e-4, "{x}: {got} {want}");
        }
    }
}
