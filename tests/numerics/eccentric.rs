//! An eccentric load: even and odd parts of both bodies.

use edgeline::base::{Panels, Parity};
use edgeline::body::{Body, EdgeModel, Resolution, Shape};
use edgeline::contact::{Compliance, ContactSettings, Problem, Straight, solve};
use edgeline::kernels::strip;
use nalgebra::DMatrix;
use std::f64::consts::PI;

/// S_l = 5, flush ends, nu = 0.3, the load 0.08 L1 off the middle: pressures at x = 0 of an
/// independent calculation, which finite elements (230,000 unknowns) confirm to 0.0035 p0 RMS.
#[test]
fn an_eccentric_load_has_the_pressures_of_an_independent_calculation() {
    let half = 5.0;
    for tolerance in [5e-3, 1e-3] {
        let resolution = Resolution::for_tolerance(tolerance);
        let numbers = resolution.wavenumbers(half);
        let shape = Shape { contact: half, half, nu: 0.3 };
        let end = EdgeModel::QuarterSpace.end(0.3, None);
        let parts = Parity::BOTH.map(|parity| {
            let body = Body::new(shape, end, parity, &resolution);
            numbers.coarse().nodes().iter().map(|&k| body.layer(k).compliance).collect::<Vec<_>>()
        });
        // Nodes from one end to the other, from those of one half.
        let right = resolution.contact_axis(half);
        let n = right.len();
        let breaks =
            right.breaks().iter().rev().map(|y| -y).chain(right.breaks()[1..].iter().copied());
        let axis = Panels::new(breaks.collect(), right.order());
        let matrices: Vec<DMatrix<f64>> = parts[0]
            .iter()
            .zip(&parts[1])
            .map(|(even, odd)| {
                DMatrix::from_fn(2 * n, 2 * n, |i, j| {
                    let place = |i: usize| if i < n { (n - 1 - i, -1.0) } else { (i - n, 1.0) };
                    let ((i, a), (j, b)) = (place(i), place(j));
                    0.5 * (even[(i, j)] + a * b * odd[(i, j)])
                })
            })
            .collect();
        let load = PI * half;
        let problem = Problem {
            compliance: &Compliance { wavenumbers: &numbers, matrices: &matrices },
            axis: &axis,
            both_ends: true,
            gap: &Straight,
            load,
            moment: Some(load * 0.08 * 2.0 * half),
        };
        let settings = ContactSettings {
            modes: resolution.modes,
            spacing: resolution.spacing,
            tolerance: 1e-2 * tolerance,
            max_iterations: 40,
            soundness: 5.0 * tolerance,
        };
        let solution = solve(&problem, &settings).unwrap();
        let wanted = [
            (-4.7, 0.613),
            (-4.0, 0.757),
            (-2.0, 0.913),
            (0.0, 1.018),
            (2.0, 1.107),
            (4.0, 1.161),
            (4.7, 1.071),
        ];
        for (y, want) in wanted {
            let at = |(j, w): (usize, f64)| {
                w * strip::pressure(solution.half_widths[j], &solution.coefficients[j], 0.0)
            };
            let p: f64 = axis.interpolation(y).map(at).sum();
            println!("{tolerance} {y}: {p:.4} {want}");
            assert!((p - want).abs() < 4e-3, "{tolerance}: p({y}) is {p}, not {want}");
        }
    }
}
