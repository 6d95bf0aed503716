//! Surface deflection of a half-space under uniform pressure on a rectangle.
//!
//! The textbook formula (Love 1929; Johnson, Contact Mechanics, 1985, Eq. 3.25) is a difference of
//! four logarithms per direction and loses R^2 / (a b) in relative accuracy at the distance R. Here
//! every difference that can cancel is formed before rounding, so the result is accurate to a few
//! units in the last place everywhere. Far away, where most cells of a grid are, a series takes a
//! tenth of the time.

/// Distance in longer half-sides beyond which the series of [`far`] leaves out less than a rounding
/// error.
const FAR: f64 = 64.0;

/// Influence f of a unit pressure on the rectangle |x'| <= `a`, |y'| <= `b` at the surface point
/// (`x`, `y`) relative to the rectangle's centre: the integral of 1/r over the rectangle.
///
/// The normal displacement of the surface, positive into the body, is
/// (1 - nu^2) / (pi E) * f * p.
///
/// `x`, `y`: any finite length; `a`, `b`: half-sides, > 0; all in one unit of length, which is also
/// that of f. Finite and continuous everywhere, including the rectangle's edges and corners.
/// Magnitudes other than zero should lie within 1e-60 to 1e60, where no intermediate over- or
/// underflows.
///
/// Source: Johnson 1985, Eq. 3.25. With u = x +- a, v = y +- b and L(u) = asinh(v1/|u|) -
/// asinh(v2/|u|), f = u1 L(u1) - u2 L(u2) plus the same with x and y exchanged.
pub fn rectangle(x: f64, y: f64, a: f64, b: f64) -> f64 {
    debug_assert!(a > 0.0 && b > 0.0, "half-sides must be positive: {a}, {b}");
    if x * x + y * y > (FAR * a.max(b)).powi(2) {
        return far(x, y, a, b);
    }
    direct(x, y, a, b)
}

/// The closed form of [`rectangle`].
fn direct(x: f64, y: f64, a: f64, b: f64) -> f64 {
    let (x, y) = (x.abs(), y.abs());
    let (u, v) = ([x + a, x - a], [y + b, y - b]);
    let r = u.map(|u| v.map(|v| u.hypot(v)));
    let r_transposed = [[r[0][0], r[1][0]], [r[0][1], r[1][1]]];
    direction(x, a, u, y, b, v, r) + direction(y, b, v, x, a, u, r_transposed)
}

/// The integral of the Taylor series of 1/r about the centre, up to the sixth derivatives: the
/// moments of a rectangle are 4 a b a^2m b^2n / ((2m + 1) (2n + 1)), and the derivatives
/// polynomials in the squared cosines of the direction.
fn far(x: f64, y: f64, a: f64, b: f64) -> f64 {
    let per_square = 1.0 / (x * x + y * y);
    let [c, s, p, q] = [x * x, y * y, a * a, b * b].map(|v| v * per_square);
    let alike = |p: f64, c: f64| {
        p * ((3.0 * c - 1.0) / 6.0
            + p * ((9.0 + c * (105.0 * c - 90.0)) / 120.0
                + p * ((231.0 * c - 315.0) * c * c + 105.0 * c - 5.0) / 112.0))
    };
    let mixed = |p: f64, c: f64, s: f64| {
        p * (10395.0 * c * c * s - 945.0 * c * (6.0 * s + c) + 315.0 * s + 630.0 * c - 45.0) / 720.0
    };
    let both = (105.0 * c * s - 12.0) / 36.0 + mixed(p, c, s) + mixed(q, s, c);
    4.0 * a * b * per_square.sqrt() * (1.0 + alike(p, c) + alike(q, s) + p * q * both)
}

/// u1 L(u1) - u2 L(u2) for x, y >= 0, with u = [x + a, x - a], v = [y + b, y - b] and
/// `r[i][j]` = hypot(u_i, v_j).
fn direction(x: f64, a: f64, u: [f64; 2], y: f64, b: f64, v: [f64; 2], r: [[f64; 2]; 2]) -> f64 {
    // asinh(v1/|u|) - asinh(v2/|u|); for v2 > 0 as one asinh, by the addition theorem.
    let log = |i: usize| {
        if v[1] > 0.0 {
            (4.0 * b * y / (v[0] * r[i][1] + v[1] * r[i][0])).asinh()
        } else {
            (v[0] / u[i].abs()).asinh() + (-v[1] / u[i].abs()).asinh()
        }
    };
    // u ln u tends to 0 on the line of an edge.
    let far_side = if u[1] == 0.0 { 0.0 } else { u[1] * log(1) };
    if u[1] < a {
        return u[0] * log(0) - far_side;
    }
    // x >= 2a: u1 L1 and u2 L2 may agree in many digits, so the result is formed from the sum and
    // the exactly factored difference of the two logarithms.
    let difference = if v[1] > 0.0 {
        let square = v[0] * v[0] + v[1] * v[1];
        let part = |i: usize| (u[i] * u[i] + square) / (v[1] * r[i][1] + v[0] * r[i][0]);
        let sums = (r[0][0] + r[1][0]) * (r[0][1] + r[1][1]);
        let numerator = -16.0
            * (a * x)
            * (b * y)
            * ((part(0) + part(1)) / sums + 1.0 / (r[0][0] * r[1][1] + r[0][1] * r[1][0]));
        (numerator / ((v[1] + r[0][1]) * (v[0] + r[1][0]))).ln_1p()
    } else {
        let scale = 4.0 * a * x / (u[0] * u[1]);
        -(scale * v[0] / (r[0][0] + r[1][0])).asinh()
            - (-scale * v[1] / (r[0][1] + r[1][1])).asinh()
    };
    a * (log(0) + log(1)) + x * difference
}

#[cfg(test)]
mod tests {
    use super::{FAR, direct, far, rectangle};

    #[test]
    fn centre_and_corner_of_a_square() {
        // Johnson 1985, section 3.3: the centre deflects 8 asinh(1) a, the corner half as much.
        let centre = 8.0 * 1f64.asinh();
        assert!((rectangle(0.0, 0.0, 1.0, 1.0) / centre - 1.0).abs() < 1e-15);
        assert!((rectangle(1.0, -1.0, 1.0, 1.0) / (0.5 * centre) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn the_series_goes_on_where_the_closed_form_ends() {
        for (a, b) in [(1.0, 1.0), (1.0, 0.07), (0.3, 1.0)] {
            for turn in 0..16 {
                let (sin, cos) = (0.1 * f64::from(turn)).sin_cos();
                let r = 1.0001 * FAR;
                // The closed form of two halves, which are farther away than they are long.
                let half = |side: f64| direct(r * cos - side * 0.5 * a, r * sin, 0.5 * a, b);
                let want = half(1.0) + half(-1.0);
                let got = far(r * cos, r * sin, a, b);
                assert!((got / want - 1.0).abs() < 3e-15, "{a} {b} {turn}: {got} {want}");
            }
        }
    }

    #[test]
    fn symmetric_and_like_a_point_load_far_away() {
        let f = rectangle(1.3, 0.7, 0.4, 0.9);
        for (x, y) in [(-1.3, 0.7), (1.3, -0.7), (-1.3, -0.7)] {
            assert_eq!(rectangle(x, y, 0.4, 0.9), f);
        }
        assert!((rectangle(0.7, 1.3, 0.9, 0.4) / f - 1.0).abs() < 1e-15);
        let far = rectangle(3e8, -4e8, 0.5, 0.25) / (4.0 * 0.5 * 0.25 / 5e8);
        assert!((far - 1.0).abs() < 1e-15);
    }
}
