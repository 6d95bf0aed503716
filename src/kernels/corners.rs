//! Love's stresses of many cells at once, summed over the corners that the cells share.
//!
//! The stress of a rectangle under pressure is a second difference of one function over its four
//! corners ([`super::love`]). Under a grid of cells each corner's function is therefore wanted
//! once, times the second difference of the pressures that meet there. Corners that share y are
//! summed in vector units; the functions arctangent and logarithm are those of Cephes (Moshier
//! 1989, Methods and Programs for Mathematical Functions), whose errors are a unit in the last
//! place.
//!
//! With A = atan(x/y) - atan(x z / (y rho)) and B the same with x and y exchanged, both one
//! arctangent each, the textbook's corner functions are -2 nu A - B + x y z / (rho (x^2 + z^2)) for
//! xx and -A - B less the two fractions for zz. Rounding leaves some 1e-15 of the largest pressure.
//! On the surface the values are those of [`super::love`]: on an edge between cells the mean of
//! both sides, at a corner the finite part of xy.

use crate::base::StressTensor;
use multiversion::multiversion;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, SQRT_2};

/// A difference of places that is this part of them is none: points on an edge are not to fall on
/// one side of it.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Corners that are summed together.
const LANES: usize = 8;

/// Corners with one y: their x and weights, filled up with weights of zero.
#[derive(Debug, Clone, Default)]
pub struct CornerRow {
    groups: Vec<[[f64; LANES]; 2]>,
}

impl CornerRow {
    /// Corners at `x` with their `weights`.
    pub fn new(corners: &[(f64, f64)]) -> Self {
        let group = |part: &[(f64, f64)]| {
            let last = part[part.len() - 1].0;
            let at = |i: usize| part.get(i).copied().unwrap_or((last, 0.0));
            [std::array::from_fn(|i| at(i).0), std::array::from_fn(|i| at(i).1)]
        };
        Self { groups: corners.chunks(LANES).map(group).collect() }
    }
}

/// Sums over corners, each of one function, in the order of `row_sums`.
#[derive(Debug, Clone, Copy, Default)]
pub struct CornerSums([f64; 8]);

impl CornerSums {
    /// Adds the corners of a `row` at y' = y - `y`, `weight` times, seen from the point (`x`, y,
    /// `z`). `unit`, a length of the size of a cell, is what logarithms are taken of at a corner
    /// itself.
    pub fn add(&mut self, row: &CornerRow, weight: f64, [x, y, z]: [f64; 3], unit: f64) {
        let sums = row_sums(&row.groups, x, y, z, 1.0 / unit);
        self.0.iter_mut().zip(sums).for_each(|(sum, s)| *sum += weight * s);
    }

    /// The stress of cells with the pressures whose second differences the weights are.
    pub fn stress(&self, nu: f64) -> StressTensor {
        let [a, b, across, along, log, ratio, xz, yz] = self.0.map(|sum| sum / (2.0 * PI));
        StressTensor {
            xx: across - 2.0 * nu * a - b,
            yy: along - 2.0 * nu * b - a,
            zz: -a - b - across - along,
            xy: (2.0 * nu - 1.0) * log - ratio,
            xz,
            yz,
        }
    }
}

/// Sums of A, B, x y z / (rho (x^2 + z^2)), the same with x and y exchanged, ln(rho + z), z / rho,
/// y z^2 / (rho (x^2 + z^2)) and x z^2 / (rho (y^2 + z^2)); compiled for the processor's vector
/// units.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn row_sums(groups: &[[[f64; LANES]; 2]], x: f64, y: f64, z: f64, per_unit: f64) -> [f64; 8] {
    let mut sums = [[0.0; LANES]; 8];
    let down = y * y + z * z;
    let per_down = 1.0 / down.max(f64::MIN_POSITIVE);
    for [places, weights] in groups {
        for lane in 0..LANES {
            let (u, w) = (x - places[lane], weights[lane]);
            let u = if u.abs() <= ROUNDING * x.abs() { 0.0 } else { u };
            let (square, side) = (u * u + y * y, u * u + z * z);
            let rho = (square + z * z).sqrt();
            let per_rho = 1.0 / rho.max(f64::MIN_POSITIVE);
            let per_side = 1.0 / side.max(f64::MIN_POSITIVE);
            // rho - z.
            let rise = square / (rho + z).max(f64::MIN_POSITIVE);
            let product = u * y;
            let fraction = z * per_rho;
            let a = arctangent(product * rise, y * y * rho + u * u * z);
            let b = arctangent(product * rise, u * u * rho + y * y * z);
            let reach = (rho + z) * per_unit;
            let log = logarithm(if reach > 0.0 { reach } else { 1.0 });
            let own = [
                a,
                b,
                product * fraction * per_side,
                product * fraction * per_down,
                log,
                fraction,
                y * z * fraction * per_side,
                u * z * fraction * per_down,
            ];
            for (sum, own) in sums.iter_mut().zip(own) {
                sum[lane] += w * own;
            }
        }
    }
    sums.map(|lanes| lanes.iter().sum())
}

/// atan(`over` / `under`), `under` >= 0; zero for 0 / 0.
#[inline(always)]
fn arctangent(over: f64, under: f64) -> f64 {
    let size = over.abs();
    // Of the angle less a quarter, an eighth or nothing of a turn.
    let steep = size > (1.0 + SQRT_2) * under;
    let middle = size > 0.66 * under;
    let base = if steep {
        FRAC_PI_2
    } else if middle {
        FRAC_PI_4
    } else {
        0.0
    };
    let (top, bottom) = if steep {
        (-under, size)
    } else if middle {
        (size - under, size + under)
    } else {
        (size, under)
    };
    let t = top / bottom.max(f64::MIN_POSITIVE);
    let s = t * t;
    let p = (((-8.750_608_600_031_904e-1 * s - 1.615_753_718_733_365e1) * s
        - 7.500_855_792_314_705e1)
        * s
        - 1.228_866_684_490_136_1e2)
        * s
        - 6.485_021_904_942_025e1;
    let q = ((((s + 2.485_846_490_142_306_3e1) * s + 1.650_270_098_316_988_5e2) * s
        + 4.328_810_604_912_903e2)
        * s
        + 4.853_903_996_359_137e2)
        * s
        + 1.945_506_571_482_614e2;
    (base + (t + t * s * p / q)).copysign(over)
}

/// ln(`x`) of a normal number.
#[inline(always)]
fn logarithm(x: f64) -> f64 {
    // x = 2^n m with m in [1/sqrt 2, sqrt 2): the bits of n are read as those of the number 2^52 +
    // n.
    const FIRST: u64 = 0x3fe6_a09e_667f_3bcd;
    let bits = x.to_bits().wrapping_sub(FIRST).wrapping_add(1023 << 52);
    let n =
        f64::from_bits((bits >> 52) | 0x4330_0000_0000_0000) - (4_503_599_627_370_496.0 + 1023.0);
    let m = f64::from_bits((bits & 0x000f_ffff_ffff_ffff).wrapping_add(FIRST)) - 1.0;
    let p = ((((1.018_756_638_045_809_3e-4 * m + 4.974_949_949_767_47e-1) * m
        + 4.705_791_198_788_817)
        * m
        + 1.449_892_253_416_109_3e1)
        * m
        + 1.793_686_785_078_198_2e1)
        * m
        + 7.708_387_337_558_854;
    let q = ((((m + 1.128_735_871_891_674_5e1) * m + 4.522_791_458_375_322e1) * m
        + 8.298_752_669_127_767e1)
        * m
        + 7.115_447_506_185_639e1)
        * m
        + 2.312_516_201_267_653_5e1;
    m - 0.5 * m * m + m * m * m * p / q + n * std::f64::consts::LN_2
}

#[cfg(test)]
mod tests {
    use super::super::love;
    use super::*;

    #[test]
    fn functions_are_those_of_the_standard_library() {
        for i in -2000..=2000 {
            let t = f64::from(i) * 0.01;
            for under in [1.0, 3.7e-5, 2.2e8] {
                assert!((arctangent(t * under, under) - t.atan()).abs() < 4e-16, "{t}");
            }
            let x = (0.05 * f64::from(i)).exp();
            assert!((logarithm(x) - x.ln()).abs() <= 4e-16 * x.ln().abs().max(1.0), "{x}");
        }
        assert_eq!(
            [arctangent(0.0, 0.0), arctangent(1.0, 0.0), arctangent(-2.0, 0.0)],
            [0.0, FRAC_PI_2, -FRAC_PI_2]
        );
    }

    #[test]
    fn one_cell_is_loves_rectangle() {
        let (a, b, nu) = (0.7, 0.4, 0.3);
        let [low, high] = [1.0, -1.0].map(|w| CornerRow::new(&[(-a, w), (a, -w)]));
        for x in [0.0, 0.3, -0.7, 0.7, 2.0, -40.0] {
            for y in [0.0, 0.4, 0.9, -0.4, -3.0] {
                for z in [0.0, 1e-9, 0.01, 0.5, 3.0] {
                    let mut sums = CornerSums::default();
                    let unit = f64::sqrt(a * b);
                    sums.add(&low, 1.0, [x, y + b, z], unit);
                    sums.add(&high, 1.0, [x, y - b, z], unit);
                    let want = love::stress(x, y, z, a, b, nu);
                    for (got, want) in sums.stress(nu).components().iter().zip(want.components()) {
                        assert!((got - want).abs() < 3e-15, "{x} {y} {z}: {got} {want}");
                    }
                }
            }
        }
    }
}
