//! Interpolation through places whose outermost ones are the ends of the range.

use std::f64::consts::PI;

/// Places between two ends, both of which are places themselves, and the polynomial through values
/// there.
///
/// They are Chebyshev's extreme points: errors of the values are at most (2 / pi) ln n + 1 times as
/// large in the polynomial. Through Gauss's nodes, which end before the range does, it is several
/// times as much at the ends (Trefethen, Approximation Theory and Approximation Practice, 2013,
/// chapter 15).
#[derive(Debug, Clone)]
pub struct Samples {
    places: Vec<f64>,
}

impl Samples {
    /// `count` >= 2 places from `from` to `to`, ascending.
    pub fn new(from: f64, to: f64, count: usize) -> Self {
        let last = count - 1;
        let place = |i: usize| match i {
            0 => from,
            i if i == last => to,
            i => 0.5 * (from + to - (to - from) * (PI * i as f64 / last as f64).cos()),
        };
        Self { places: (0..count).map(place).collect() }
    }

    /// The places.
    pub fn places(&self) -> &[f64] {
        &self.places
    }

    /// The share of the value at each place in that at `x`: barycentric, with weights that
    /// alternate in sign and are halved at the ends (Berrut and Trefethen, SIAM Review 46, 2004,
    /// section 5).
    pub fn shares(&self, x: f64) -> Vec<f64> {
        if let Some(hit) = self.places.iter().position(|place| *place == x) {
            return (0..self.places.len()).map(|i| f64::from(u8::from(i == hit))).collect();
        }
        let last = self.places.len() - 1;
        let term = |(i, place): (usize, &f64)| {
            let size = if i == 0 || i == last { 0.5 } else { 1.0 };
            let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
            size * sign / (x - place)
        };
        let terms: Vec<f64> = self.places.iter().enumerate().map(term).collect();
        let sum: f64 = terms.iter().sum();
        terms.into_iter().map(|term| term / sum).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_interpolated_exactly_and_noise_hardly_grows() {
        for count in [2, 3, 8, 17] {
            let samples = Samples::new(-1.5, 4.0, count);
            let places = samples.places();
            assert!(places.is_sorted() && places[0] == -1.5 && places[count - 1] == 4.0);
            let of = |x: f64| (0..count).map(|n| (0.3 * x).powi(n as i32)).sum::<f64>();
            let mut most: f64 = 0.0;
            for i in 0..=300 {
                let x = -1.5 + 5.5 * f64::from(i) / 300.0;
                let shares = samples.shares(x);
                let got: f64 = shares.iter().zip(places).map(|(share, x)| share * of(*x)).sum();
                assert!((got - of(x)).abs() < 1e-11, "{count} {x}: {got} {}", of(x));
                most = most.max(shares.iter().map(|share| share.abs()).sum());
            }
            assert!(most < 2.0 / PI * (count as f64).ln() + 1.0, "{count}: {most}");
        }
    }
}
