//! The patches on which the stresses of line loads are tabulated, in the distance rho, in units of
//! 1/k, and the direction.

/// The resolution of a table in rho and the direction.
pub struct Fineness {
    /// Coefficients in each coordinate of a patch.
    pub order: usize,
    /// Patches per octave of rho, a power of two.
    pub rows: usize,
    /// Patches from the direction of the depth to that of the surface.
    pub angles: usize,
}

/// For the stresses of fields.
pub const STRESS: Fineness = Fineness { order: 4, rows: 2, angles: 8 };

/// For the stress in the matrices of the end faces.
pub const WW: Fineness = Fineness { order: 6, rows: 1, angles: 6 };

/// Tabulated octaves of rho, 2^LOW to 2^HIGH.
const LOW: i32 = -9;
const HIGH: i32 = 5;

/// Lower end of the tabulated range of rho.
pub const FLOOR: f64 = 1.0 / 512.0;
/// Upper end of the tabulated range of rho.
pub const CEILING: f64 = 32.0;

impl Fineness {
    /// The first patch of the row for the distance `rho`, and the position in it, in [-1, 1]. A
    /// distance outside the table has no patch.
    #[inline(always)]
    pub fn row(&self, rho: f32) -> (i32, f32) {
        const MANTISSA: u32 = 23;
        const ONE: u32 = 127 << MANTISSA;
        // The parts of the octave are the first digits of the mantissa; the rest is the position.
        let halves = self.rows.trailing_zeros();
        let bits = rho.to_bits();
        let row = (bits >> (MANTISSA - halves)) as i32 - ((127 + LOW) << halves);
        let place = f32::from_bits((bits << halves) & ((1 << MANTISSA) - 1) | ONE);
        (row * self.angles as i32, 2.0 * place - 3.0)
    }

    /// The patch within a row for `share`, the offset divided by the sum of offset and depth, and
    /// the position in it, in [-1, 1].
    #[inline(always)]
    pub fn direction(&self, share: f64) -> (usize, f64) {
        let around = share * self.angles as f64;
        let angle = (around as usize).min(self.angles - 1);
        (angle, 2.0 * (around - angle as f64) - 1.0)
    }

    /// Offsets and depths of all values, patch by patch, with the direction running fastest within
    /// a patch.
    pub fn places(&self) -> impl Iterator<Item = (f64, f64)> {
        let (n, rows) = (self.order, (HIGH - LOW) as usize * self.rows);
        let count = rows * self.angles * n * n;
        (0..count).map(move |at| {
            let (patch, i, j) = (at / (n * n), at / n % n, at % n);
            let (row, angle) = (patch / self.angles, patch % self.angles);
            let part = (row % self.rows) as f64 + 0.5 + 0.5 * chebyshev_node(n, i);
            let octave = LOW + (row / self.rows) as i32;
            let rho = 2f64.powi(octave) * (1.0 + part / self.rows as f64);
            let share = (angle as f64 + 0.5 + 0.5 * chebyshev_node(n, j)) / self.angles as f64;
            let (sin, cos) = share.atan2(1.0 - share).sin_cos();
            (rho * sin, rho * cos)
        })
    }
}

/// Chebyshev node number `i` of `order` in [-1, 1], the positions of a patch's values in each
/// coordinate.
pub fn chebyshev_node(order: usize, i: usize) -> f64 {
    (std::f64::consts::PI * (i as f64 + 0.5) / order as f64).cos()
}
