//! The search for the zero of a function by secants.

/// Most of a step in steps before it.
const LONGEST_STEP: f64 = 8.0;

/// The slope of what falls, and its limits: it may fall in a jump, and be flat beside it.
const FALLING: f64 = -2.0;
const FALLS: [f64; 2] = [-8.0, -1.0];

/// What has a slope above this, and falls elsewhere, is far from its zero, and says nothing of how
/// far: steps grow by this factor.
const FLAT: f64 = -0.5;
const STRIDE: f64 = 2.0;

/// The search for the zero of a function whose slope is about 1, or at least of one sign: by
/// secants, and within two arguments whose values are of different signs as soon as both are known.
#[derive(Debug)]
pub(crate) struct Secants {
    /// The slope that is known.
    slope: f64,
    /// Its limits.
    slopes: [f64; 2],
    /// The argument and the value before.
    last: Option<[f64; 2]>,
    /// The last arguments with a value below zero, and above.
    below: Option<f64>,
    above: Option<f64>,
}

impl Secants {
    /// A search that begins with a slope of 1.
    pub fn new() -> Self {
        Self::with_slope(1.0, [f64::NEG_INFINITY, f64::INFINITY])
    }

    /// A search for the zero of a function that falls, at least as fast as its argument grows, but
    /// may be flat far from its zero.
    pub fn falling() -> Self {
        Self::with_slope(FALLING, FALLS)
    }

    fn with_slope(slope: f64, slopes: [f64; 2]) -> Self {
        Self { slope, slopes, last: None, below: None, above: None }
    }

    /// A search for the zero of a function that is nearly this one: the slope is known, but no
    /// value.
    pub fn of_another(&self) -> Self {
        Self::with_slope(self.slope, self.slopes)
    }

    /// Distance of two arguments with values of different signs; infinite as long as one is
    /// unknown.
    pub fn width(&self) -> f64 {
        match (self.below, self.above) {
            (Some(one), Some(other)) => (other - one).abs(),
            _ => f64::INFINITY,
        }
    }

    /// The next argument to try, after the value at one.
    pub fn next(&mut self, at: f64, value: f64) -> f64 {
        let side = if value < 0.0 { &mut self.below } else { &mut self.above };
        *side = Some(at);
        let mut longest = f64::INFINITY;
        if let Some([before, was]) = self.last.replace([at, value]) {
            longest = LONGEST_STEP * (at - before).abs();
            let falls = self.slopes[1] < 0.0;
            if falls && value * was > 0.0 && (value - was) / (at - before) > FLAT {
                return self.inside(at + STRIDE * (at - before));
            }
            let slope = if value == was { 1.0 } else { (value - was) / (at - before) };
            self.slope = slope.clamp(self.slopes[0], self.slopes[1]);
        }
        self.inside(at + (-value / self.slope).clamp(-longest, longest))
    }

    /// The next argument to try, `wanted`, after one at which the value is not known, but below
    /// zero.
    pub fn next_below(&mut self, at: f64, wanted: f64) -> f64 {
        self.below = Some(at);
        self.inside(wanted)
    }

    /// The argument `wanted`, or the middle of those between which the zero is known to be.
    fn inside(&self, wanted: f64) -> f64 {
        match (self.below, self.above) {
            (Some(a), Some(b)) if !(a.min(b)..a.max(b)).contains(&wanted) => 0.5 * (a + b),
            _ => wanted,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The calls that a search for the zero of `f` from `at` takes.
    fn calls(search: &mut Secants, mut at: f64, f: impl Fn(f64) -> f64) -> usize {
        (1..100)
            .find(|_| {
                let value = f(at);
                at = search.next(at, value);
                value.abs() < 1e-12
            })
            .expect("a zero")
    }

    #[test]
    fn zeros_are_found_whatever_the_slope_is_and_a_known_slope_helps() {
        // A line, whose slope is known after the second value.
        let mut search = Secants::new();
        assert_eq!(calls(&mut search, 0.0, |x| 3.0 * x - 1.0), 3);
        assert_eq!(calls(&mut search.of_another(), 0.0, |x| 3.0 * x - 1.2), 2);
        // Steep on one side, flat on the other.
        let bent = |x: f64| if x < 0.3 { 20.0 * (x - 0.3) } else { 0.2 * (x - 0.3) };
        for from in [-5.0, 0.0, 0.29, 1.0, 40.0] {
            let taken = calls(&mut Secants::new(), from, bent);
            assert!(taken < 30, "{from}: {taken} calls");
        }
        assert_eq!(Secants::new().width(), f64::INFINITY);
    }

    /// What is flat far from its zero is left in steps that grow.
    #[test]
    fn a_plateau_is_left_in_few_steps() {
        let flat = |x: f64| (2.0 * (3.0 - x)).clamp(-0.05, 0.05);
        for from in [-1.0, 2.0, 2.99, 3.2, 7.0] {
            let taken = calls(&mut Secants::falling(), from, flat);
            assert!(taken < 30, "{from}: {taken} calls");
        }
    }
}
