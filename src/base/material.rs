use serde::{Deserialize, Serialize};

/// A linear elastic, isotropic material.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Young's modulus (Pa), > 0.
    pub young_pa: f64,
    /// Poisson's ratio, 0 <= nu < 0.5.
    pub poisson: f64,
}

impl Material {
    /// Compliance of the surface in plane strain, (1 - nu^2) / E (1/Pa).
    pub fn plane_strain_compliance(&self) -> f64 {
        (1.0 - self.poisson * self.poisson) / self.young_pa
    }

    /// Contact modulus E* of two materials (Pa): 1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2
    /// (Johnson, Contact Mechanics, 1985, Eq. 4.24 and table of chapter 4).
    pub fn contact_modulus(&self, other: &Material) -> f64 {
        1.0 / (self.plane_strain_compliance() + other.plane_strain_compliance())
    }
}
