//! A first guess of the contact: every slice across the line is in contact by itself, or what is
//! known of a contact that is solved.

use super::gap::Gap;
use super::solution::ContactSolution;
use crate::base::Panels;
use nalgebra::{Matrix2, Vector2};
use std::f64::consts::FRAC_PI_2;

/// Slices along the line.
const SLICES: usize = 240;

/// The half-width, as a part of the largest one, where slices do not touch. Under a tilt bodies
/// that bend may touch there, and a half-width at most doubles in an iteration.
const APART: f64 = 0.1;

/// Most iterations of the rigid motions, and passes for the contact's length.
const MOST: usize = 100;
const PASSES: usize = 4;

/// What slices say of a contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Slices {
    /// Places of the slices.
    y: Vec<f64>,
    /// Squares of the half-widths; negative where the bodies do not touch.
    squares: Vec<f64>,
    /// Where the contact ends.
    pub ends: [f64; 2],
}

impl Slices {
    /// The contact on the overlap of the bodies, from end to end, under `load`; with its `moment`
    /// if the tilt is free, otherwise with the held `tilt`.
    ///
    /// The half-width a of a slice at which the bodies would overlap by d follows a^2 = d / L. A
    /// line of the half-length l under a uniform load has L = ln(4 l) + 1/2 (Johnson, Contact
    /// Mechanics, 1985, section 5.6); a load that varies over that length itself has about half of
    /// it.
    pub fn new(
        gap: &dyn Gap,
        overlap: [f64; 2],
        load: f64,
        moment: Option<f64>,
        tilt: f64,
    ) -> Self {
        let mut slices =
            Self::of_length(gap, overlap, load, (moment, tilt), overlap[1] - overlap[0]);
        for _ in 0..PASSES {
            let length = slices.ends[1] - slices.ends[0];
            slices = Self::of_length(gap, overlap, load, (moment, tilt), length);
        }
        slices
    }

    /// The slices of a contact of about this `length`.
    fn of_length(
        gap: &dyn Gap,
        overlap: [f64; 2],
        load: f64,
        (moment, tilt): (Option<f64>, f64),
        length: f64,
    ) -> Self {
        let [from, to] = overlap;
        let step = (to - from) / SLICES as f64;
        let y: Vec<f64> = (0..SLICES).map(|i| from + (i as f64 + 0.5) * step).collect();
        let drops: Vec<f64> = y.iter().map(|y| gap.at(0.0, *y)).collect();
        let soft = 0.5 * (2.0 * length).max(1.0).ln() + 0.25;
        // The load gives the approach; the moment gives the tilt.
        let wanted = Vector2::new(load, moment.unwrap_or(0.0)) * (soft / (FRAC_PI_2 * step));
        let least = drops.iter().copied().fold(f64::INFINITY, f64::min);
        let mut rigid = Vector2::new(least + soft * load / (FRAC_PI_2 * (to - from)), tilt);
        for _ in 0..MOST {
            let mut matrix = Matrix2::zeros();
            let mut sum = Vector2::zeros();
            for (y, drop) in y.iter().zip(&drops) {
                let arm = Vector2::new(1.0, *y);
                let deep = rigid.dot(&arm) - drop;
                if deep > 0.0 {
                    sum += arm * deep;
                    matrix += arm * arm.transpose();
                }
            }
            let off = wanted - sum;
            let change = match moment {
                Some(_) => matrix.lu().solve(&off),
                None => (matrix.m11 > 0.0).then(|| Vector2::new(off.x / matrix.m11, 0.0)),
            };
            let Some(change) = change else { break };
            rigid += change;
            if change.norm() <= 1e-10 * rigid.norm() {
                break;
            }
        }
        let deep = |y: f64, drop: f64| (rigid.dot(&Vector2::new(1.0, y)) - drop) / soft;
        let squares: Vec<f64> = y.iter().zip(&drops).map(|(y, drop)| deep(*y, *drop)).collect();
        let first = squares.iter().position(|s| *s > 0.0).unwrap_or(0);
        let last = squares.iter().rposition(|s| *s > 0.0).unwrap_or(SLICES - 1);
        let crossing = |inside: usize, outside: usize| {
            let [a, b] = [squares[inside], squares[outside]];
            let share = if b.is_finite() { a / (a - b) } else { 0.5 };
            y[inside] + share * (y[outside] - y[inside])
        };
        let ends = [
            if first == 0 { from } else { crossing(first, first - 1) },
            if last == SLICES - 1 { to } else { crossing(last, last + 1) },
        ];
        Self { y, squares, ends }
    }

    /// Those of a contact that is solved, on its `axis`; none where it has fewer than two nodes.
    pub fn of_solution(axis: &Panels, contact: &ContactSolution) -> Option<Self> {
        let ends = contact.ends.map(|end| end.at);
        let nodes = axis.nodes().iter().zip(&contact.half_widths).zip(&contact.coefficients);
        // Nodes without a pressure have a half-width of those beside them.
        let inside =
            nodes.filter(|((y, _), modes)| !modes.is_empty() && (ends[0]..=ends[1]).contains(*y));
        let (y, squares): (Vec<f64>, _) = inside.map(|((y, a), _)| (*y, a * a)).unzip();
        (y.len() >= 2).then_some(Self { y, squares, ends })
    }

    /// The largest half-width.
    pub fn widest(&self) -> f64 {
        self.squares.iter().copied().fold(0.0, f64::max).sqrt()
    }

    /// The largest width, in lengths along y.
    pub fn width_over_length(&self) -> f64 {
        2.0 * self.widest() / (self.ends[1] - self.ends[0])
    }

    /// The half-width at `y`; where the slices do not touch, one to begin with.
    pub fn half_width(&self, y: f64) -> f64 {
        let after = self.y.partition_point(|place| *place < y).clamp(1, self.y.len() - 1);
        let squares = [after - 1, after].map(|i| self.squares[i]);
        if squares.iter().all(|square| *square <= 0.0) {
            return APART * self.widest();
        }
        let [a, b] = squares.map(|square| square.max(0.0));
        let share = ((y - self.y[after - 1]) / (self.y[after] - self.y[after - 1])).clamp(0.0, 1.0);
        (a + share * (b - a)).sqrt()
    }
}
