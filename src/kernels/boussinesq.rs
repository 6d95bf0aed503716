//! A normal point load on an elastic half-space (Boussinesq).
//!
//! Origin at the load, z >= 0 into the body, stress positive in tension, the load positive in
//! compression.

use std::f64::consts::PI;

use crate::base::StressTensor;

/// Stress at (`x`, `y`, `z`) from a unit load at the origin, in load per area.
///
/// `x`, `y`, `z`: lengths in one unit, z >= 0, not all zero (the stress at the load itself is not
/// finite); `nu`: Poisson's ratio.
///
/// Source: Johnson, Contact Mechanics, 1985, section 3.2, in Love's form: 1/r^2 (1 - z/rho) is
/// written 1/(rho (rho + z)), to avoid cancellation and division by zero on the axis below the
/// load.
pub fn stress(x: f64, y: f64, z: f64, nu: f64) -> StressTensor {
    debug_assert!(z >= 0.0, "z points into the body: {z}");
    let rho = x.hypot(y).hypot(z);
    let sum = rho + z;
    let cubed = rho * rho * rho;
    let radial = (1.0 - 2.0 * nu) / (2.0 * PI);
    let slope = (2.0 * rho + z) / (cubed * sum * sum);
    let direct = -1.5 / PI * z / (cubed * rho * rho);
    StressTensor {
        xx: radial * (1.0 / (rho * sum) - y * y * slope) + direct * x * x,
        yy: radial * (1.0 / (rho * sum) - x * x * slope) + direct * y * y,
        zz: direct * z * z,
        xy: radial * x * y * slope + direct * x * y,
        xz: direct * x * z,
        yz: direct * y * z,
    }
}

/// Influence coefficient 1/r of a unit load at the origin on the surface point (`x`, `y`), not both
/// zero: the displacement into the body is (1 - nu^2) / (pi E) * load / r (Johnson 1985, section
/// 3.2).
pub fn deflection(x: f64, y: f64) -> f64 {
    1.0 / x.hypot(y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deflection_falls_with_distance() {
        assert_eq!(deflection(3.0, -4.0), 0.2);
    }

    #[test]
    fn surface_and_axis() {
        // Johnson 1985, Eq. 3.20: on the surface sigma_r = -sigma_theta = (1 - 2 nu) / (2 pi r^2);
        // below the load sigma_z = -3 / (2 pi z^2), sigma_r = (1 - 2 nu) / (4 pi z^2).
        let s = stress(2.0, 0.0, 0.0, 0.3);
        assert!((s.xx - 0.4 / (8.0 * PI)).abs() < 1e-17 && (s.xx + s.yy).abs() < 1e-17);
        assert_eq!([s.zz, s.xz, s.yz], [0.0; 3]);
        let s = stress(0.0, 0.0, 2.0, 0.3);
        assert!((s.zz + 3.0 / (8.0 * PI)).abs() < 1e-16);
        assert!((s.xx - 0.4 / (16.0 * PI)).abs() < 1e-17 && s.xx == s.yy);
    }
}
