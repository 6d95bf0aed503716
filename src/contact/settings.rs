//! Settings of the contact solve.

/// Settings of the contact solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSettings {
    /// Modes of the pressure across the contact.
    pub modes: usize,
    /// Smallest distance along the line, of each other and from its end, of nodes whose half-width is
    /// an unknown of its own.
    pub spacing: f64,
    /// Largest amplitude of the pressure's edge singularity that counts as none (p0).
    pub tolerance: f64,
    /// Iterations after which it gives up.
    pub max_iterations: usize,
    /// How far a solution may break the laws of contact: penetration and gap under the pressure
    /// (C^2 / (2 R)), and pull (p0).
    pub soundness: f64,
}
