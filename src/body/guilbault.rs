//! `guilbault`: mirrored pressures weighted with Guilbault's factor psi in the displacement, and a
//! correction of the stresses.

use super::end::End;

/// Stress transition factor of the model: the least-squares fit of sigma_yy to `quarter-space` over
/// the standard curves of four cases (tests/numerics/ends.rs, docs/theory.md).
pub const GAMMA: f64 = 2.03;

/// Guilbault's factor for images in the flexibility matrix (Guilbault, ASME Journal of Tribology
/// 133, 2011), as a function of Poisson's ratio.
pub fn guilbault_psi(nu: f64) -> f64 {
    1.29 - (0.08 - 0.5 * nu) / (1.0 - nu)
}

/// The end face of a body of Poisson's ratio `nu`, with `psi` in place of [`guilbault_psi`] if
/// given.
pub(super) fn end(nu: f64, psi: Option<f64>) -> End {
    let image_weight = Some(psi.unwrap_or_else(|| guilbault_psi(nu)));
    End { image_weight, freed: false, gamma: Some(GAMMA) }
}

/// Share of an end face's normal stress that the reconstructed correction subtracts at the distance
/// `s` from the face and the depth `z`.
///
/// A pressure on the face whose wavelength is the depth decays into the body like (1 + kappa s)
/// e^(-kappa s); with kappa = 1 / (gamma z) the share is one on the face and zero far from it, over
/// a distance that grows with the depth.
pub fn transition(s: f64, z: f64, gamma: f64) -> f64 {
    if s <= 0.0 {
        return 1.0;
    }
    let t = s / (gamma * z);
    if t > 700.0 || z == 0.0 { 0.0 } else { (1.0 + t) * (-t).exp() }
}
