//! Settings of the contact solve.

/// Settings of the contact solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSettings {
    /// Modes of the pressure across the contact.
    pub modes: usize,
    /// Smallest distance (C) of nodes with an independent half-width, from each other along the
    /// line and from its end, towards each end.
    pub spacing: [f64; 2],
    /// Largest negligible amplitude of the pressure's edge singularity (p0).
    pub tolerance: f64,
    /// Largest number of iterations.
    pub max_iterations: usize,
    /// Largest violation of the laws of contact: penetration and gap under the pressure (C^2 / (2
    /// R)), and tensile pressure (p0).
    pub soundness: f64,
}
