//! Displacements at a depth, which the approach of the bodies is counted from.
//!
//! As [`crate::contact::Reference`] has it, a wave of wavenumber k across the contact fades like e^(-k d) with the depth d. Its
//! kernel 2 K0(k u) then sums to (2 / pi^2) Re f(d + i x, u), f(w, u) = arcosh(w / u) / sqrt(w^2 - u^2) (Gradshteyn and
//! Ryzhik 2007, 6.611 9.), at the distances u along the contact and x across it; at d = 0 it is 1 / (pi r).

use super::pressure::CellPressure;
use crate::base::Panels;
use nalgebra::Complex;
use std::f64::consts::PI;

/// Ratio of the panels' lengths towards u = 0, where f is logarithmic, and their number.
const RATIO: f64 = 0.5;
const PANELS: i32 = 24;

/// Gauss points of a panel.
const ORDER: usize = 6;

/// Integrals over u of (2 / pi^2) Re f.
struct Integral {
    /// d + i x.
    place: Complex<f64>,
    /// Ends of panels, and the integral from zero to each.
    breaks: Vec<f64>,
    sums: Vec<f64>,
}

impl Integral {
    /// For distances up to `longest`.
    fn new(place: Complex<f64>, longest: f64) -> Self {
        let mut breaks = vec![0.0];
        breaks.extend((0..PANELS).rev().map(|i| longest * RATIO.powi(i)));
        let mut integral = Self { place, breaks, sums: vec![0.0] };
        for i in 1..integral.breaks.len() {
            let next =
                integral.sums[i - 1] + integral.between(integral.breaks[i - 1], integral.breaks[i]);
            integral.sums.push(next);
        }
        integral
    }

    /// From zero to `u`, of either sign.
    fn to(&self, u: f64) -> f64 {
        let from = self.breaks[1..].partition_point(|b| *b <= u.abs()).min(self.sums.len() - 1);
        let rest = if u.abs() > self.breaks[from] {
            self.between(self.breaks[from], u.abs())
        } else {
            0.0
        };
        (self.sums[from] + rest).copysign(u)
    }

    fn between(&self, from: f64, to: f64) -> f64 {
        let panel = Panels::new(vec![from, to], ORDER);
        panel.nodes().iter().zip(panel.weights()).map(|(u, w)| w * self.kernel(*u)).sum()
    }

    fn kernel(&self, u: f64) -> f64 {
        let ratio = self.place / u;
        let own = match (ratio - 1.0).norm() < 1e-6 {
            true => Complex::new(1.0, 0.0),
            false => ratio.acosh() / (ratio - 1.0).sqrt() / (ratio + 1.0).sqrt(),
        };
        2.0 / (PI * PI) * (own / u).re
    }
}

/// Mean along the line of the displacement (C^2 / (2 R)) that `cells` cause at `depth` (C), those shifted along y by each of
/// `shifts` after a mirror in y = 0 with its weight.
pub(super) fn mean(cells: &CellPressure, shifts: &[(f64, f64)], depth: f64) -> f64 {
    let grid = &cells.grid;
    let (a, b) = grid.half_sides();
    let half = grid.half_length;
    let total: f64 = cells.pressure.iter().sum();
    let rows = || cells.pressure.chunks_exact(grid.nx);
    let second: f64 =
        rows().flat_map(|row| row.iter().enumerate().map(|(i, p)| p * grid.x(i).powi(2))).sum();
    // As much on either side at the distance of equal second moment.
    let place = Complex::new(depth, (second / total).sqrt());
    let farthest = shifts.iter().fold(0.0, |m: f64, (shift, _)| m.max(shift.abs()));
    let integral = Integral::new(place, farthest + 2.0 * half);
    let along = |at: f64| integral.to(half - at) + integral.to(half + at);
    let of_row = |(j, row): (usize, &[f64])| {
        let y = grid.y(j);
        let images = shifts.iter().map(|(shift, weight)| weight * along(shift - y));
        row.iter().sum::<f64>() * (along(y) + images.sum::<f64>())
    };
    rows().enumerate().map(of_row).sum::<f64>() * 4.0 * a * b / (2.0 * half)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_that_fade_with_the_depth_add_up() {
        use crate::kernels::bessel::k0;
        for (depth, x, u) in [(3.0, 0.0, 0.7), (2.0, 0.5, 2.0), (1.5, 0.4, 6.0)] {
            let got = Integral::new(Complex::new(depth, x), 10.0).kernel(u);
            let waves =
                Panels::new((0..400).map(|i| 1e-12 + 1e-4 * f64::from(i).powi(2)).collect(), 6);
            let wave = |k: f64| 2.0 * k0(k * u) * (-k * depth).exp() * (k * x).cos();
            let all = waves.nodes().iter().zip(waves.weights());
            let want = all.map(|(k, w)| w * wave(*k)).sum::<f64>() / (PI * PI);
            assert!((got / want - 1.0).abs() < 1e-5, "{depth} {x} {u}: {got} {want}");
        }
        let integral = Integral::new(Complex::new(2.0, 0.3), 8.0);
        let parts = Panels::new(vec![0.5, 1.0, 2.0, 3.0, 4.0, 5.0], 12);
        let want: f64 =
            parts.nodes().iter().zip(parts.weights()).map(|(u, w)| w * integral.kernel(*u)).sum();
        assert!((integral.to(5.0) - integral.to(0.5) - want).abs() < 1e-9);
        assert_eq!(integral.to(-5.0), -integral.to(5.0));
    }
}
