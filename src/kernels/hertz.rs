//! Hertz line and circular point contacts: the reference solutions for a general solver.
//!
//! Lengths are in units of the contact's half-width or radius, stresses in units of the maximum
//! pressure; z points into the body, stress is positive in tension. The scales themselves are
//! [`crate::base::HertzScales`] for the line and [`PointScales`] for the point.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use crate::base::StressTensor;

/// Pressure of the line contact at the distance `x` from its middle plane, in units of p0:
/// sqrt(1 - x^2) within the contact, 0 outside (Johnson, Contact Mechanics, 1985, Eq. 4.44).
pub fn line_pressure(x: f64) -> f64 {
    ((1.0 - x) * (1.0 + x)).max(0.0).sqrt()
}

/// Plane-strain stress below the line contact at (`x`, `z`), z >= 0, in units of p0; y is the
/// direction of the contact line, `nu` Poisson's ratio.
///
/// Source: McEwen 1949, as Johnson 1985, Eq. 4.49; sigma_yy = nu (sigma_xx + sigma_zz). With m - i
/// n = sqrt(1 - (x + i z)^2) the forms printed there, m (1 +- (z^2 + n^2)/(m^2 + n^2)) - ..., are
/// written as multiples of m - z = Re 1/(m + z - i (n + x)), to keep their accuracy far away and
/// next to the surface.
pub fn line_stress(x: f64, z: f64, nu: f64) -> StressTensor {
    debug_assert!(z >= 0.0, "z points into the body: {z}");
    let sign = 1f64.copysign(x);
    let x = x.abs();
    // m^2 + n^2 and m^2 - n^2.
    let modulus = (1.0 - x).hypot(z) * (1.0 + x).hypot(z);
    if modulus == 0.0 {
        return StressTensor::default();
    }
    let real = (1.0 - x) * (1.0 + x) + z * z;
    let (m, n) = if real >= 0.0 {
        let m = (0.5 * (modulus + real)).sqrt();
        (m, x * z / m)
    } else {
        let n = (0.5 * (modulus - real)).sqrt();
        (x * z / n, n)
    };
    let (m_sum, n_sum) = (m + z, n + x);
    let lift = m_sum / (m_sum * m_sum + n_sum * n_sum);
    let xx = -lift * (m * lift + 2.0 * n * n) / modulus;
    let zz = -lift * m * m_sum / modulus;
    let xz = -sign * lift * n * m_sum / modulus;
    StressTensor { xx, yy: nu * (xx + zz), zz, xz, ..Default::default() }
}

/// Scales of a circular contact (Johnson 1985, Eqs. 4.22 to 4.24).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointScales {
    /// Contact radius, (3 P R / (4 E*))^(1/3) (m).
    pub radius_m: f64,
    /// Maximum pressure, 3 P / (2 pi a^2) (Pa).
    pub p0_pa: f64,
    /// Approach of distant points, a^2 / R (m).
    pub approach_m: f64,
}

impl PointScales {
    /// Scales under `load_n` (N) with the relative radius of curvature `curvature_radius_m` (m) and
    /// the contact modulus `e_star_pa` (Pa), all > 0.
    pub fn new(e_star_pa: f64, curvature_radius_m: f64, load_n: f64) -> Self {
        let radius_m = (0.75 * load_n * curvature_radius_m / e_star_pa).cbrt();
        Self {
            radius_m,
            p0_pa: 1.5 * load_n / (PI * radius_m * radius_m),
            approach_m: radius_m * radius_m / curvature_radius_m,
        }
    }
}

/// Pressure of the circular contact at the radius `r` >= 0, in units of p0: sqrt(1 - r^2) within, 0
/// outside (Johnson 1985, Eq. 3.39).
pub fn point_pressure(r: f64) -> f64 {
    line_pressure(r)
}

/// Influence f of the circular contact's pressure on the surface at the radius `r` >= 0, in units
/// of the contact radius: the displacement into the body is (1 - nu^2) / (pi E) f p0 a.
///
/// Source: Johnson 1985, Eqs. 3.41a and 3.42a. The latter, with sin(phi / 2) = 1 / r, is (pi/4) r^2
/// (sin phi - phi cos phi), whose power series is used far away, where the difference cancels.
pub fn point_deflection(r: f64) -> f64 {
    if r <= 1.0 {
        return 0.5 * FRAC_PI_2 * PI * (2.0 - r * r);
    }
    let phi = 2.0 * (1.0 / r).asin();
    let difference = if phi < 0.5 {
        // sum over k >= 1 of (-1)^(k+1) 2k phi^(2k+1) / (2k+1)!
        let square = phi * phi;
        let mut power = phi;
        let mut sum = 0.0;
        for k in 1..=8 {
            let even = f64::from(2 * k);
            power *= -square / (even * (even + 1.0));
            sum -= even * power;
        }
        sum
    } else {
        phi.sin() - phi * phi.cos()
    };
    FRAC_PI_4 * r * r * difference
}

/// Stress on the surface z = 0 of the circular contact at the radius `r` >= 0, in units of p0; x is
/// the radial, y the circumferential direction (Johnson 1985, Eq. 3.43). Shears vanish.
pub fn point_surface_stress(r: f64, nu: f64) -> StressTensor {
    let lateral = (1.0 - 2.0 * nu) / 3.0;
    if r > 1.0 {
        let xx = lateral / (r * r);
        return StressTensor { xx, yy: -xx, ..Default::default() };
    }
    let p = line_pressure(r);
    // (1 - p^3) / r^2 with r^2 = 1 - p^2, finite at the centre.
    let spread = lateral * (1.0 + p + p * p) / (1.0 + p);
    StressTensor { xx: spread - p, yy: -spread - 2.0 * nu * p, zz: -p, ..Default::default() }
}

/// Stress on the axis of the circular contact at the depth `z` >= 0, in units of p0 (Johnson 1985,
/// Eq. 3.45). Shears vanish; xx = yy is the radial stress.
pub fn point_axis_stress(z: f64, nu: f64) -> StressTensor {
    debug_assert!(z >= 0.0, "z points into the body: {z}");
    let zz = -1.0 / (1.0 + z * z);
    let xx = -(1.0 + nu) * one_less_arctangent(z) - 0.5 * zz;
    StressTensor { xx, yy: xx, zz, ..Default::default() }
}

/// 1 - z atan(1/z), by its power series in 1/z where the difference cancels.
fn one_less_arctangent(z: f64) -> f64 {
    if z < 2.0 {
        return 1.0 - z * FRAC_PI_2 + z * z.atan();
    }
    let t = 1.0 / (z * z);
    (1..=27).rev().fold(0.0, |sum, k| t * (1.0 / f64::from(2 * k + 1) - sum))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn point_scales_carry_the_load() {
        let s = PointScales::new(1.15e11, 0.01, 50.0);
        assert!((2.0 / 3.0 * PI * s.radius_m.powi(2) * s.p0_pa / 50.0 - 1.0).abs() < 1e-14);
        // Inside, the influence and the gap of the ball add up to the approach:
        // p0 a (pi^2 / 4) (2 - r^2) / (pi E*) = delta - r^2 a^2 / (2 R).
        for r in [0.0, 0.6, 1.0] {
            let u = point_deflection(r) * s.p0_pa * s.radius_m / (PI * 1.15e11);
            let gap = (r * s.radius_m).powi(2) / 0.02;
            assert!(((u + gap) / s.approach_m - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn series_meet_the_closed_forms() {
        let near = |r: f64| {
            let phi = 2.0 * (1.0 / r).asin();
            FRAC_PI_4 * r * r * (phi.sin() - phi * phi.cos())
        };
        assert!((point_deflection(4.1) / near(4.1) - 1.0).abs() < 1e-13);
        assert!((point_deflection(1.0 + 1e-15) / point_deflection(1.0) - 1.0).abs() < 1e-14);
        let z: f64 = 2.0;
        let closed = 1.0 - z * (1.0 / z).atan();
        assert!((one_less_arctangent(z) / closed - 1.0).abs() < 1e-14);
    }
}
