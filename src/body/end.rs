//! The treatment of a free end face by an edge model.

use std::f64::consts::PI;

/// A free end face as an edge model treats it. The bodies, the contact and the stresses know an
/// edge model by these capabilities alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// Weight of the pressure's image in the face for the displacement; none without images. For
    /// the stresses an image always has its full weight.
    pub image_weight: Option<f64>,
    /// Whether a pressure on the face cancels the normal stress that the images leave there. There
    /// are then [`super::Resolution::images`] images, with strips beyond them; otherwise there is
    /// one.
    pub freed: bool,
    /// Transition factor gamma of the stress correction, see [`super::transition`]; none without
    /// one.
    pub gamma: Option<f64>,
}

impl End {
    /// A body that continues beyond the contact's end.
    pub const ENDLESS: End = End { image_weight: None, freed: false, gamma: None };

    /// The slope u' E' / 2 at s = 1 of a surface that ends at s = 0, under the pressure s^-m,
    /// 0 < m <= 1/2.
    ///
    /// With an image of weight psi: int_0^inf t^-m [1/(1-t) + psi/(1+t)] dt = pi (psi - cos pi m) /
    /// sin pi m. Free of traction: P = s^-m / (1 - tau^2), where tau = (1 - m) / cos(pi m / 2) is
    /// the normal stress that P and its image cause on the end face at the depth 1 (the Mellin
    /// transform of the line load's 4 t^2 / (pi (1 + t^2)^2)).
    pub(super) fn slope(&self, m: f64) -> f64 {
        let image = ((PI * m).cos() - self.image_weight.unwrap_or(0.0)) / (PI * m).sin();
        if !self.freed {
            return image;
        }
        let tau = (1.0 - m) / (0.5 * PI * m).cos();
        image / (1.0 - tau * tau)
    }
}
