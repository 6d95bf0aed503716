//! An infinite plate under pressure on both faces, and the two half-spaces that contain its steep
//! part.
//!
//! The plate is |y| <= H, unbounded in x and z; the face at y = H carries the pressure q cos(k x)
//! cos(l z), the other one the same (even) or its opposite (odd). kappa^2 = k^2 + l^2, t = kappa H.
//! In the plane of the wave vector and y the plate is in plane strain (Timoshenko and Goodier,
//! Theory of Elasticity, 1970, article 24). An odd load bends the plate: for long waves its
//! stresses grow like 3 / t^2.

use crate::base::Parity;

/// The stresses of the plate less those of the two half-spaces behind its faces, per unit face
/// pressure of one wave. The difference is smooth and vanishes like e^(-2 kappa (H - |y|) ...) for
/// large kappa H.
#[derive(Debug, Clone, Copy)]
pub struct Remainder {
    parity: Parity,
    nu: f64,
    kappa: f64,
    /// kappa H, and its hyperbolic functions divided by their growth e^t.
    t: f64,
    cosh_t: f64,
    sinh_t: f64,
    /// e^(-2 t).
    decay: f64,
    /// 1 / ((sinh t cosh t + t) / e^(2 t)), or with - t for an odd load.
    inverse: f64,
    /// The wave vector's direction, k / kappa and l / kappa.
    kk: f64,
    ll: f64,
}

impl Remainder {
    /// For loads of this `parity`, the half-thickness `half` > 0, Poisson's ratio `nu`, and the
    /// wavenumbers `k` and `l` >= 0, not both zero.
    pub fn new(parity: Parity, half: f64, nu: f64, k: f64, l: f64) -> Self {
        let kappa = k.hypot(l);
        let t = kappa * half;
        let decay = (-2.0 * t).exp();
        let product = 0.25 * (1.0 - decay * decay);
        let sum = match parity {
            Parity::Even => product + t * decay,
            // Sinh t cosh t - t cancels for long waves.
            Parity::Odd if t < 0.05 => {
                let u = 2.0 * t;
                let square = u * u;
                u * square / 12.0 * (1.0 + square / 20.0 * (1.0 + square / 42.0)) * decay
            }
            Parity::Odd => product - t * decay,
        };
        Self {
            parity,
            nu,
            kappa,
            t,
            cosh_t: 0.5 * (1.0 + decay),
            sinh_t: 0.5 * (1.0 - decay),
            decay,
            inverse: 1.0 / sum,
            kk: k / kappa,
            ll: l / kappa,
        }
    }

    /// Amplitudes at |`y`| <= H: xx, yy, zz vary as cos(k x) cos(l z), xy as sin(k x) cos(l z), xz
    /// as sin(k x) sin(l z), yz as cos(k x) sin(l z).
    pub fn at(&self, y: f64) -> [f64; 6] {
        let Self { parity, nu, t, inverse, kk, ll, .. } = *self;
        let a = self.kappa * y;
        // e^(a - t) and e^(-a - t), the larger one by the exponential.
        let large = (a.abs() - t).exp();
        let small = self.decay / large;
        let (up, down) = if a < 0.0 { (small, large) } else { (large, small) };
        let (cosh_a, sinh_a) = (0.5 * (up + down), 0.5 * (up - down));
        // An odd load exchanges sinh and cosh in the even one's solution.
        let (sinh_t, cosh_t, sinh_a, cosh_a) = match parity {
            Parity::Even => (self.sinh_t, self.cosh_t, sinh_a, cosh_a),
            Parity::Odd => (self.cosh_t, self.sinh_t, cosh_a, sinh_a),
        };
        let across = -((sinh_t + t * cosh_t) * cosh_a - a * sinh_t * sinh_a) * inverse;
        let along = -((sinh_t - t * cosh_t) * cosh_a + a * sinh_t * sinh_a) * inverse;
        let shear = -(a * sinh_t * cosh_a - t * cosh_t * sinh_a) * inverse;
        let (near, far) = (t - a, t + a);
        // `up` is e^-near and `down` e^-far.
        let down = parity.sign() * down;
        let across = across + (1.0 + near) * up + (1.0 + far) * down;
        let along = along + (1.0 - near) * up + (1.0 - far) * down;
        let shear = shear - near * up + far * down;
        let transverse = nu * (along + across);
        [
            along * kk * kk + transverse * ll * ll,
            across,
            along * ll * ll + transverse * kk * kk,
            shear * kk,
            -(along - transverse) * kk * ll,
            shear * ll,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The six stresses of the two half-spaces at y, as the plate's components.
    fn half_spaces(parity: Parity, half: f64, nu: f64, k: f64, l: f64, y: f64) -> [f64; 6] {
        let kappa = k.hypot(l);
        let mut sum = [0.0; 6];
        for (depth, sign) in [(half - y, 1.0), (half + y, -1.0)] {
            let d = kappa * depth;
            let e = (-d).exp();
            let (across, along, shear) = (-(1.0 + d) * e, -(1.0 - d) * e, sign * d * e);
            let transverse = nu * (across + along);
            let (kk, ll) = (k / kappa, l / kappa);
            let all = [
                along * kk * kk + transverse * ll * ll,
                across,
                along * ll * ll + transverse * kk * kk,
                shear * kk,
                -(along - transverse) * kk * ll,
                shear * ll,
            ];
            // The far face's load has the parity's sign.
            let load = if sign < 0.0 { parity.sign() } else { 1.0 };
            sum.iter_mut().zip(all).for_each(|(s, a)| *s += load * a);
        }
        sum
    }

    #[test]
    fn plate_meets_its_boundary_conditions_and_equilibrium() {
        let (half, nu) = (1.7, 0.3);
        let waves = [(0.01, 0.02), (0.02, 0.01), (0.5, 0.0), (0.0, 0.8), (1.1, 0.7), (3.0, 5.0)];
        for (parity, (k, l)) in Parity::BOTH.into_iter().flat_map(|p| waves.map(|w| (p, w))) {
            let at = |y: f64| {
                let r = Remainder::new(parity, half, nu, k, l).at(y);
                let h = half_spaces(parity, half, nu, k, l, y);
                std::array::from_fn::<f64, 6, _>(|i| r[i] + h[i])
            };
            // Long waves bend the plate, with stresses of 3 / t^2.
            let scale = 1.0 + (k.hypot(l) * half).powi(-2);
            for (y, load) in [(half, 1.0), (-half, parity.sign())] {
                let s = at(y);
                assert!((s[1] + load).abs() < 1e-12 * scale, "yy {}", s[1]);
                assert!(s[3].abs() < 1e-12 * scale && s[5].abs() < 1e-12 * scale);
            }
            // Equilibrium along x, y and z of the cosine and sine amplitudes.
            for y in [0.0, 0.4, 1.2] {
                let step = 1e-5;
                let (s, up, down) = (at(y), at(y + step), at(y - step));
                let slope = |i: usize| (up[i] - down[i]) / (2.0 * step);
                assert!((-k * s[0] + slope(3) + l * s[4]).abs() < 1e-7 * scale);
                assert!((k * s[3] + slope(1) + l * s[5]).abs() < 1e-7 * scale);
                assert!((k * s[4] + slope(5) - l * s[2]).abs() < 1e-7 * scale);
            }
        }
    }

    #[test]
    fn remainder_vanishes_for_short_waves() {
        for parity in Parity::BOTH {
            let remainder = Remainder::new(parity, 10.0, 0.3, 2.0, 1.0);
            assert!(remainder.at(10.0).iter().all(|s| s.abs() < 1e-15));
        }
    }
}
