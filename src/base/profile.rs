//! Profiles: how far a body's generatrix drops from the straight line along its length.
//!
//! y is the distance from the body's middle, the drop is positive away from the other body. All
//! lengths are in one unit, which is the user's.

use std::sync::Arc;

/// The shape of a profile. Its places along y and its drops scale together, see
/// [`Profile::scaled`].
#[derive(Debug, Clone, PartialEq)]
pub enum Profile {
    /// Straight for |y| <= `straight`, then an arc of `radius` that is tangent to it. Without a
    /// straight part a crown.
    Arc {
        /// Half of the straight part's length.
        straight: f64,
        /// Radius of the arc.
        radius: f64,
    },
    /// A ln(1 / (1 - k t^2)) with t = (|y| - start) / span beyond `start`, else zero. With k = 1 it
    /// has no limit at t = 1.
    Logarithm {
        /// A, of the sign of the drop.
        amplitude: f64,
        /// k, greater than 0 and at most 1.
        k: f64,
        /// |y| where it begins.
        start: f64,
        /// Length over which t grows to 1.
        span: f64,
    },
    /// Measured drops.
    Table(Arc<Table>),
}

/// A place where a profile's curvature jumps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kink {
    /// The place along y.
    pub at: f64,
    /// The jump of the drop's second derivative.
    pub jump: f64,
}

impl Profile {
    /// The drop at `y`; infinite where the profile has no limit.
    pub fn drop(&self, y: f64) -> f64 {
        match self {
            Self::Arc { straight, radius } => {
                let u = (y.abs() - straight).max(0.0);
                // R - sqrt(R^2 - u^2) without cancellation.
                if u < *radius {
                    u * u / (radius + ((radius - u) * (radius + u)).sqrt())
                } else {
                    f64::INFINITY
                }
            }
            Self::Logarithm { amplitude, k, start, span } => {
                let t = (y.abs() - start).max(0.0) / span;
                if k * t * t < 1.0 { -amplitude * (-k * t * t).ln_1p() } else { f64::INFINITY }
            }
            Self::Table(table) => table.at(y)[0],
        }
    }

    /// The derivative of the drop along y.
    pub fn slope(&self, y: f64) -> f64 {
        match self {
            Self::Arc { straight, radius } => {
                let u = (y.abs() - straight).max(0.0);
                let slope = if u < *radius {
                    u / ((radius - u) * (radius + u)).sqrt()
                } else {
                    f64::INFINITY
                };
                slope.copysign(y)
            }
            Self::Logarithm { amplitude, k, start, span } => {
                let t = (y.abs() - start).max(0.0) / span;
                let rest = 1.0 - k * t * t;
                let slope = if rest > 0.0 {
                    amplitude * 2.0 * k * t / (span * rest)
                } else {
                    f64::INFINITY.copysign(*amplitude)
                };
                slope * 1f64.copysign(y)
            }
            Self::Table(table) => table.at(y)[1],
        }
    }

    /// The largest |y| up to which the drop is finite.
    pub fn reach(&self) -> f64 {
        match self {
            Self::Arc { straight, radius } => straight + radius,
            Self::Logarithm { k, start, span, .. } => start + span / k.sqrt(),
            Self::Table(_) => f64::INFINITY,
        }
    }

    /// Where the curvature jumps: the ends of a straight part. The many small jumps of a table are
    /// none, see [`Profile::points`].
    pub fn kinks(&self) -> Vec<Kink> {
        let (at, jump) = match self {
            Self::Arc { straight, radius } => (*straight, 1.0 / radius),
            Self::Logarithm { amplitude, k, start, span } => {
                (*start, 2.0 * amplitude * k / (span * span))
            }
            Self::Table(_) => return Vec::new(),
        };
        if at > 0.0 { [-at, at].map(|at| Kink { at, jump }).to_vec() } else { Vec::new() }
    }

    /// The points of a table.
    pub fn points(&self) -> &[f64] {
        match self {
            Self::Table(table) => &table.y,
            Self::Arc { .. } | Self::Logarithm { .. } => &[],
        }
    }

    /// Whether both sides of the middle are alike.
    pub fn is_even(&self) -> bool {
        match self {
            Self::Arc { .. } | Self::Logarithm { .. } => true,
            Self::Table(table) => table.is_even(),
        }
    }

    /// The same profile in a unit of length that is 1 / `factor` of the present one.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        match self {
            Self::Arc { straight, radius } => {
                Self::Arc { straight: factor * straight, radius: factor * radius }
            }
            Self::Logarithm { amplitude, k, start, span } => Self::Logarithm {
                amplitude: factor * amplitude,
                k: *k,
                start: factor * start,
                span: factor * span,
            },
            Self::Table(table) => Self::Table(Arc::new(table.scaled(factor))),
        }
    }

    /// The numbers that make the profile, for comparison.
    pub fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Arc { straight, radius } => vec![0.0, *straight, *radius],
            Self::Logarithm { amplitude, k, start, span } => {
                vec![1.0, *amplitude, *k, *start, *span]
            }
            Self::Table(table) => {
                let points = table.y.iter().zip(&table.drop).flat_map(|(y, drop)| [*y, *drop]);
                std::iter::once(2.0).chain(points).collect()
            }
        }
    }
}

/// Measured drops, with a monotone cubic between them (Fritsch and Carlson, SIAM Journal on
/// Numerical Analysis 17, 1980, with the three-point slopes of Fritsch and Butland, SIAM Journal on
/// Scientific and Statistical Computing 5, 1984): it does not overshoot. Beyond the outer points it
/// is straight.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    y: Vec<f64>,
    drop: Vec<f64>,
    slope: Vec<f64>,
}

impl Table {
    /// The least number of points.
    pub const LEAST: usize = 2;

    /// A table of drops at ascending places `y`, at least [`Table::LEAST`].
    ///
    /// # Panics
    /// If there are fewer, or they do not ascend.
    pub fn new(y: Vec<f64>, drop: Vec<f64>) -> Self {
        assert!(
            y.len() >= Self::LEAST && y.len() == drop.len() && y.windows(2).all(|p| p[0] < p[1])
        );
        let lengths: Vec<f64> = y.windows(2).map(|p| p[1] - p[0]).collect();
        let secants: Vec<f64> =
            drop.windows(2).zip(&lengths).map(|(d, length)| (d[1] - d[0]) / length).collect();
        let inner = |i: usize| {
            let [before, after] = [secants[i - 1], secants[i]];
            if before * after <= 0.0 {
                return 0.0;
            }
            let [a, b] = [lengths[i - 1], lengths[i]];
            let [w1, w2] = [2.0 * b + a, b + 2.0 * a];
            (w1 + w2) / (w1 / before + w2 / after)
        };
        let last = y.len() - 1;
        let slope = (0..=last).map(|i| match i {
            0 => outer(&lengths, &secants, [0, 1]),
            _ if i == last => outer(&lengths, &secants, [last - 1, last.saturating_sub(2)]),
            _ => inner(i),
        });
        let slope = slope.collect();
        Self { y, drop, slope }
    }

    /// The first and the last place.
    pub fn range(&self) -> [f64; 2] {
        [self.y[0], self.y[self.y.len() - 1]]
    }

    /// Drop and slope at `y`.
    fn at(&self, y: f64) -> [f64; 2] {
        let last = self.y.len() - 1;
        let end = if y <= self.y[0] { Some(0) } else { (y >= self.y[last]).then_some(last) };
        if let Some(end) = end {
            return [self.drop[end] + self.slope[end] * (y - self.y[end]), self.slope[end]];
        }
        let i = self.y.partition_point(|p| *p <= y) - 1;
        let length = self.y[i + 1] - self.y[i];
        let t = (y - self.y[i]) / length;
        let rise = self.drop[i + 1] - self.drop[i];
        // Hermite's cubic as the line between both points plus what vanishes at both.
        let [a, b] = [self.slope[i], self.slope[i + 1]].map(|slope| slope * length - rise);
        let bend = t * (1.0 - t) * (a * (1.0 - t) - b * t);
        let bending = a * (1.0 - t) * (1.0 - 3.0 * t) + b * t * (3.0 * t - 2.0);
        [self.drop[i] + rise * t + bend, (rise + bending) / length]
    }

    fn is_even(&self) -> bool {
        let size = self.drop.iter().fold(0.0, |m: f64, d| m.max(d.abs()));
        let [from, to] = self.range();
        let pairs = self.y.iter().rev().zip(self.drop.iter().rev());
        self.y.iter().zip(&self.drop).zip(pairs).all(|((y, drop), (other, mirrored))| {
            (y + other).abs() <= 1e-12 * (to - from) && (drop - mirrored).abs() <= 1e-12 * size
        })
    }

    fn scaled(&self, factor: f64) -> Self {
        let scale = |values: &[f64]| values.iter().map(|v| factor * v).collect();
        Self { y: scale(&self.y), drop: scale(&self.drop), slope: self.slope.clone() }
    }
}

/// The slope at an end from the secants of the two intervals there, the outer one first; limited so
/// that the cubic stays monotone.
fn outer(lengths: &[f64], secants: &[f64], [own, next]: [usize; 2]) -> f64 {
    let Some((&a, &b)) = secants.get(own).zip(secants.get(next)).filter(|_| own != next) else {
        return secants[own];
    };
    let [h, g] = [lengths[own], lengths[next]];
    let slope = ((2.0 * h + g) * a - h * b) / (h + g);
    if slope * a <= 0.0 {
        0.0
    } else if a * b <= 0.0 && slope.abs() > 3.0 * a.abs() {
        3.0 * a
    } else {
        slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some() -> Vec<Profile> {
        let table = Table::new(
            vec![-5.0, -3.0, -1.0, 0.5, 2.0, 5.0],
            vec![0.03, 0.012, 0.0, 0.0, 0.002, 0.02],
        );
        vec![
            Profile::Arc { straight: 0.0, radius: 700.0 },
            Profile::Arc { straight: 2.0, radius: 300.0 },
            Profile::Logarithm { amplitude: 0.004, k: 0.95, start: 0.0, span: 5.0 },
            Profile::Logarithm { amplitude: 0.004, k: 1.0, start: 3.0, span: 2.0 },
            Profile::Table(Arc::new(table)),
        ]
    }

    #[test]
    fn slopes_are_derivatives() {
        for profile in some() {
            for y in [-4.9, -4.0, -2.9, -1.3, 0.2, 1.1, 2.7, 3.9, 4.9] {
                let step = 1e-5;
                let quotient = (profile.drop(y + step) - profile.drop(y - step)) / (2.0 * step);
                let slope = profile.slope(y);
                assert!((slope - quotient).abs() < 1e-6, "{profile:?} {y}: {slope} {quotient}");
            }
        }
    }

    #[test]
    fn a_scaled_profile_is_the_same_shape() {
        for profile in some() {
            let scaled = profile.scaled(40.0);
            for y in [-4.9, -2.0, 0.3, 3.3] {
                assert!((scaled.drop(40.0 * y) - 40.0 * profile.drop(y)).abs() < 1e-12);
                assert!((scaled.slope(40.0 * y) - profile.slope(y)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn arcs_and_logarithms_have_their_closed_forms() {
        let all = some();
        assert!((all[0].drop(3.0) - (700.0 - (700.0f64 * 700.0 - 9.0).sqrt())).abs() < 1e-12);
        assert_eq!([0.0, 1.9, -2.0].map(|y| all[1].drop(y)), [0.0; 3]);
        assert!((all[1].drop(-5.0) - all[1].drop(5.0)).abs() < 1e-15);
        assert!((all[2].drop(5.0) - 0.004 * (1.0f64 / 0.05).ln()).abs() < 1e-15);
        assert_eq!(all[3].drop(2.9), 0.0);
        assert!(all[3].drop(5.0).is_infinite() && all[3].reach() == 5.0);
        assert!(all[..4].iter().all(Profile::is_even) && !all[4].is_even());
    }

    #[test]
    fn a_table_keeps_its_points_and_does_not_overshoot() {
        let (y, drop) = (vec![0.0, 1.0, 2.0, 3.0, 4.0], vec![0.0, 0.0, 0.1, 1.0, 1.0]);
        let table = Profile::Table(Arc::new(Table::new(y.clone(), drop.clone())));
        for (y, drop) in y.iter().zip(&drop) {
            assert!((table.drop(*y) - drop).abs() < 1e-15);
        }
        let fine: Vec<f64> = (0..=400).map(|i| table.drop(0.01 * f64::from(i))).collect();
        assert!(fine.windows(2).all(|p| p[1] >= p[0] - 1e-15));
        // A linear table is linear everywhere.
        let line = Table::new(vec![-1.0, 0.0, 3.0], vec![0.5, 0.0, -1.5]);
        for y in [-2.0, -0.3, 1.7, 5.0] {
            let [drop, slope] = line.at(y);
            assert!((drop + 0.5 * y).abs() < 1e-14 && (slope + 0.5).abs() < 1e-14);
        }
    }
}
