//! The solution of the contact.

use crate::kernels::strip;
use nalgebra::DVector;
use serde::{Deserialize, Serialize};

/// Contact pressure of the whole line.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSolution {
    /// Half-width of the contact at each node (C).
    pub half_widths: Vec<f64>,
    /// Coefficients of the modes at each node (p0).
    pub coefficients: Vec<Vec<f64>>,
    /// Approach in units of C^2 / (2 R), relative to points at a distance set by the smallest
    /// wavenumber: that of material points follows from the stresses.
    pub approach: f64,
    /// Tilt in units of C / (2 R): the growth of the approach per C along y.
    pub tilt: f64,
    /// The contact's ends: both of the whole line, also on an axis over one half of it.
    pub ends: [ContactEnd; 2],
    /// Number of iterations.
    pub iterations: usize,
    /// What a later attempt solved it with; none if the first one, with the settings, did.
    pub coarser: Option<Coarser>,
    /// Remaining amplitude of the edge singularity (p0).
    pub residual: f64,
    /// |load - prescribed| / prescribed.
    pub load_error: f64,
}

/// What a contact was solved with that was not to be solved with the settings asked for. Errors
/// beside its ends are then larger than those settings promise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct Coarser {
    /// Smallest distance of nodes with an independent half-width towards each end, in the
    /// resolution's unit.
    pub spacing: [f64; 2],
    /// Modes of the pressure across the contact.
    pub modes: usize,
    /// Most modes behind the last node with an independent half-width.
    pub end_modes: usize,
}

/// An end of a contact, by its line load: towards an end that is not the bodies' it falls linearly,
/// as the load of an elliptical contact does. The half-widths there, which are interpolated, change
/// it much less than the pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactEnd {
    /// Where the pressure ends along the axis (C): where the axis does, or before, if its last
    /// nodes carry none.
    pub at: f64,
    /// How much farther along y (C), or less far, it would go: what is left of the line load at the
    /// axis's end, over the slope with which it would fall to zero there. Zero if the axis ends
    /// where the bodies do, or if its last nodes carry none.
    pub beyond: f64,
    /// The length (C) over which it would rise to that of a contact of half-width C and pressure
    /// p0; infinite where the bodies end.
    pub rise: f64,
}

impl ContactEnd {
    /// That of bodies, if the pressure reaches it.
    pub(super) fn of_bodies(at: f64) -> Self {
        Self { at, beyond: 0.0, rise: f64::INFINITY }
    }

    /// The same in units of length and of pressure that are 1 / `factor` of the present ones.
    fn scaled(self, factor: f64) -> Self {
        let Self { at, beyond, rise } = self;
        Self { at: factor * at, beyond: factor * beyond, rise: rise / factor }
    }

    /// The other end of a contact that is symmetric about y = 0.
    pub(super) fn mirrored(self) -> Self {
        Self { at: -self.at, beyond: -self.beyond, ..self }
    }
}

impl ContactSolution {
    /// The same solution in units of length and of pressure that are 1 / `factor` of the present
    /// ones; displacements are in units of C^2 / (2 R).
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let scale = |values: &Vec<f64>| values.iter().map(|v| factor * v).collect();
        Self {
            half_widths: scale(&self.half_widths),
            coefficients: self.coefficients.iter().map(scale).collect(),
            approach: factor * factor * self.approach,
            tilt: factor * self.tilt,
            ends: self.ends.map(|end| end.scaled(factor)),
            residual: factor * self.residual,
            ..self.clone()
        }
    }

    /// Fourier transform int p cos(k x) dx of the pressure at every node.
    pub fn transform(&self, k: f64) -> DVector<f64> {
        let mut modes = Vec::new();
        DVector::from_fn(self.half_widths.len(), |j, _| {
            let coefficients = &self.coefficients[j];
            modes.resize(coefficients.len(), 0.0);
            strip::transforms(self.half_widths[j], k, &mut modes);
            modes.iter().zip(coefficients).map(|(t, c)| t * c).sum()
        })
    }
}
