use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Scales of the Hertz line contact, which make a case dimensionless (Johnson, Contact Mechanics,
/// 1985, Eqs. 4.43 to 4.45).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct HertzScales {
    /// Contact modulus E* (Pa).
    pub e_star_pa: f64,
    /// Half-width of the line contact, C = 2 R sqrt(W / pi) (m).
    pub c_m: f64,
    /// Maximum pressure of the line contact, p0 = E* C / (2 R) (Pa).
    pub p0_pa: f64,
}

impl HertzScales {
    /// Scales of a roller of radius `radius_m` (m) and length `length_m` (m) under `force_n` (N),
    /// with contact modulus `e_star_pa` (Pa). All arguments > 0.
    pub fn new(e_star_pa: f64, radius_m: f64, length_m: f64, force_n: f64) -> Self {
        let w = force_n / (e_star_pa * radius_m * length_m);
        let c_m = 2.0 * radius_m * (w / PI).sqrt();
        Self { e_star_pa, c_m, p0_pa: e_star_pa * c_m / (2.0 * radius_m) }
    }
}
