use serde::{Deserialize, Serialize};
use std::ops::{Add, AddAssign, Mul, Sub};

/// A symmetric stress tensor, positive in tension, in the unit that its owner states.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct StressTensor {
    /// Normal stress across the contact.
    pub xx: f64,
    /// Normal stress along the contact line.
    pub yy: f64,
    /// Normal stress in the depth direction.
    pub zz: f64,
    /// Shear stress in planes of constant depth z.
    pub xy: f64,
    /// Shear stress in planes across the contact line.
    pub xz: f64,
    /// Shear stress in planes along the contact line.
    pub yz: f64,
}

impl StressTensor {
    /// Names of the components, in the order of [`StressTensor::components`].
    pub const NAMES: [&'static str; 6] =
        ["sigma_xx", "sigma_yy", "sigma_zz", "sigma_xy", "sigma_xz", "sigma_yz"];

    /// The six components: xx, yy, zz, xy, xz, yz.
    pub fn components(&self) -> [f64; 6] {
        [self.xx, self.yy, self.zz, self.xy, self.xz, self.yz]
    }

    /// The inverse of [`StressTensor::components`].
    pub fn from_components([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Self {
        Self { xx, yy, zz, xy, xz, yz }
    }

    /// Which components change sign in a mirror image in the plane x = 0.
    pub const ODD_IN_X: [bool; 6] = [false, false, false, true, true, false];

    /// Which components change sign in a mirror image in the plane y = 0.
    pub const ODD_IN_Y: [bool; 6] = [false, false, false, true, false, true];

    /// Which components change sign in a mirror image in the plane z = 0.
    pub const ODD_IN_Z: [bool; 6] = [false, false, false, false, true, true];

    /// The mirror image in the plane whose components are `odd`.
    pub fn mirrored(&self, odd: [bool; 6]) -> Self {
        let own = self.components();
        Self::from_components(std::array::from_fn(|i| if odd[i] { -own[i] } else { own[i] }))
    }

    /// Von Mises equivalent stress, sqrt(3 J2).
    pub fn von_mises(&self) -> f64 {
        let (a, b, c) = (self.xx - self.yy, self.yy - self.zz, self.zz - self.xx);
        let shear = self.xy * self.xy + self.xz * self.xz + self.yz * self.yz;
        (0.5 * (a * a + b * b + c * c) + 3.0 * shear).sqrt()
    }

    /// Principal stresses, largest first (the trigonometric form of the cubic's roots, which
    /// stays accurate for repeated roots).
    pub fn principal(&self) -> [f64; 3] {
        let mean = (self.xx + self.yy + self.zz) / 3.0;
        let (a, b, c) = (self.xx - mean, self.yy - mean, self.zz - mean);
        let (d, e, f) = (self.xy, self.xz, self.yz);
        let j2 = 0.5 * (a * a + b * b + c * c) + d * d + e * e + f * f;
        if j2 <= 0.0 {
            return [mean; 3];
        }
        let j3 = a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e);
        let radius = 2.0 * (j2 / 3.0).sqrt();
        let cos3 = (1.5 * j3 / j2 * (3.0 / j2).sqrt()).clamp(-1.0, 1.0);
        let theta = cos3.acos() / 3.0;
        let third = 2.0 * std::f64::consts::FRAC_PI_3;
        [
            mean + radius * theta.cos(),
            mean + radius * (theta - third).cos(),
            mean + radius * (theta + third).cos(),
        ]
    }

    /// Largest shear stress, half the difference of the extreme principal stresses.
    pub fn tau_max(&self) -> f64 {
        let [high, _, low] = self.principal();
        0.5 * (high - low)
    }
}

impl Add for StressTensor {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self {
            xx: self.xx + o.xx,
            yy: self.yy + o.yy,
            zz: self.zz + o.zz,
            xy: self.xy + o.xy,
            xz: self.xz + o.xz,
            yz: self.yz + o.yz,
        }
    }
}

impl AddAssign for StressTensor {
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl std::iter::Sum for StressTensor {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |sum, s| sum + s)
    }
}

impl Sub for StressTensor {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + o * -1.0
    }
}

impl Mul<f64> for StressTensor {
    type Output = Self;
    fn mul(self, k: f64) -> Self {
        Self {
            xx: self.xx * k,
            yy: self.yy * k,
            zz: self.zz * k,
            xy: self.xy * k,
            xz: self.xz * k,
            yz: self.yz * k,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariants_of_simple_states() {
        let uniaxial = StressTensor { xx: 3.0, ..Default::default() };
        assert!((uniaxial.von_mises() - 3.0).abs() < 1e-14);
        assert!((uniaxial.tau_max() - 1.5).abs() < 1e-14);
        let shear = StressTensor { yz: 2.0, ..Default::default() };
        assert!((shear.von_mises() - 2.0 * 3f64.sqrt()).abs() < 1e-14);
        assert!((shear.tau_max() - 2.0).abs() < 1e-14);
        let hydrostatic = StressTensor { xx: -1.0, yy: -1.0, zz: -1.0, ..Default::default() };
        assert_eq!(hydrostatic.tau_max(), 0.0);
    }

    #[test]
    fn principal_stresses_solve_the_cubic() {
        let s = StressTensor { xx: 1.0, yy: -2.0, zz: 0.5, xy: 0.7, xz: -0.3, yz: 1.1 };
        let m = nalgebra::Matrix3::new(s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz);
        let mut expected: Vec<f64> = m.symmetric_eigenvalues().iter().copied().collect();
        expected.sort_by(|a, b| b.total_cmp(a));
        for (got, want) in s.principal().iter().zip(expected) {
            assert!((got - want).abs() < 1e-12);
        }
    }
}
