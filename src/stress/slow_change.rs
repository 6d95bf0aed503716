//! What a slow change of the pressure along the line does, in closed form.
//!
//! Waves that are shorter than a polynomial along the line follows are faded out. The field of an
//! endless contact, which is added in closed form, does not know that the pressure changes along
//! the line; the shears of an even change are added likewise.

use crate::base::Panels;
use crate::kernels::strip;
use std::f64::consts::PI;

/// The slow change of a load per length along the line at a place, as far as it has a closed form.
#[derive(Debug, Clone, Default)]
pub struct SlowChange {
    /// Nodes with the weights that make the change of what is interpolated between them.
    pub nodes: Vec<(usize, f64)>,
    /// The plane contacts whose difference it is: a factor of each, its half-width and its modes.
    pub contacts: Vec<(f64, f64, Vec<f64>)>,
}

impl SlowChange {
    /// The change of the load per length.
    pub fn load(&self) -> f64 {
        self.contacts.iter().map(|(factor, a, c)| factor * strip::cumulative(*a, c, *a)).sum()
    }

    /// The change of the [`strip::potentials`] at (`x`, `z`).
    pub fn potentials(&self, x: f64, z: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (factor, a, c) in &self.contacts {
            let own = strip::potentials(*a, c, x, z);
            sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += factor * own);
        }
        sum
    }

    /// Stresses xy and yz at (`x`, `z`), the former without that of the `long` waves.
    pub fn stress(&self, nu: f64, x: f64, z: f64, long: &Panels) -> [f64; 2] {
        if self.contacts.is_empty() {
            return [0.0; 2];
        }
        let [mut xy, yz] = first_order(nu, z, self.potentials(x, z));
        // They see the load alone.
        let load = self.load() / PI;
        for (k, weight) in long.nodes().iter().zip(long.weights()) {
            let wave = load * weight * (-k * z).exp() * (k * x).sin();
            xy -= first_order(nu, z, [wave / k, wave, 0.0])[0];
        }
        [xy, yz]
    }

    /// Amplitudes of the stresses xy and yz at the depth `z` in a wave `k` with the `transforms` of
    /// the load at the nodes.
    pub fn amplitudes(
        &self,
        nu: f64,
        z: f64,
        k: f64,
        transforms: impl Fn(usize) -> f64,
    ) -> [f64; 2] {
        let slope: f64 = self.nodes.iter().map(|(j, weight)| weight * transforms(*j)).sum();
        let e = (-k * z).exp() * slope;
        first_order(nu, z, [e / k, e, e])
    }
}

/// Stresses xy and yz at the depth `z` under a pressure that changes evenly along y, from the
/// [`strip::potentials`] of its change per length.
///
/// Of the pressure y cos(k x) Boussinesq's potential (Johnson, Contact Mechanics, 1985, section
/// 3.2) is 2 pi y / k e^(-k z) cos(k x), whence xy = -((1 - 2 nu) / k - z) e^(-k z) sin(k x) and
/// yz = z e^(-k z) cos(k x), beside the stresses of an endless contact.
fn first_order(nu: f64, z: f64, [integral, sine, cosine]: [f64; 3]) -> [f64; 2] {
    [z * sine - (1.0 - 2.0 * nu) * integral, z * cosine]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::gauss_legendre;
    use crate::kernels::boussinesq;

    /// Stresses under a pressure that grows evenly along y are those of forces at points
    /// (Boussinesq), on a line so long that its ends add 2e-6 of p0.
    #[test]
    fn a_load_that_changes_evenly_is_a_sum_of_point_loads() {
        let (a, modes, nu, length) = (1.3, [1.0, -0.2, 0.05], 0.2, 1e6);
        let mut breaks = vec![0.0];
        breaks.extend((0..48).map(|i| 0.05 * 1.43f64.powi(i)).filter(|y| *y < length));
        breaks.push(length);
        let line = Panels::new(breaks, 8);
        let (across, weights) = gauss_legendre(60);
        for (x, z) in [(0.0, 0.4), (0.7, 0.3), (-1.8, 0.5), (1.3, 2.0)] {
            let mut sum = [0.0; 2];
            for (y, along) in line.nodes().iter().zip(line.weights()) {
                for (g, w) in across.iter().zip(&weights) {
                    let angle = 0.5 * PI * (1.0 + g);
                    let s = a * angle.cos();
                    let force = 0.5 * PI * w * a * angle.sin() * strip::pressure(a, &modes, s);
                    // Those at y < 0 pull, and do the same.
                    let own = boussinesq::stress(x - s, -y, z, nu) * (2.0 * along * y * force);
                    sum = [sum[0] + own.xy, sum[1] + own.yz];
                }
            }
            let got = first_order(nu, z, strip::potentials(a, &modes, x, z));
            for (got, want) in got.into_iter().zip(sum) {
                assert!((got - want).abs() < 1e-5, "{x} {z}: {got} {want}");
            }
        }
    }
}
