//! The contact iteration.

use super::linear::Linear;
use crate::base::stop::go_on;

/// The complementarity problem of a contact over n cells: u + gap = D where p > 0, u + gap >= D
/// elsewhere, sum p given. With arms y, D + T y takes the place of D, and sum y p is given too.
pub(super) struct Complementarity<'a> {
    /// Displacement u of a pressure.
    pub(super) displacement: &'a mut dyn Linear,
    /// An approximate inverse of the displacement, symmetric and positive.
    pub(super) inverse: &'a mut dyn Linear,
    /// The gap before loading.
    pub(super) gap: &'a [f64],
    /// Sum of the pressures.
    pub(super) total: f64,
    /// Of bodies that are free to tilt the arm of each cell, and the sum of arms times pressures.
    pub(super) arms: Option<(&'a [f64], f64)>,
}

/// A rigid motion of the bodies towards each other.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Motion {
    /// Approach D.
    pub(super) approach: f64,
    /// Tilt T; zero where it is not free.
    pub(super) tilt: f64,
}

impl Motion {
    /// The motion of cell `i`.
    fn at(&self, arms: Option<(&[f64], f64)>, i: usize) -> f64 {
        self.approach + arms.map_or(0.0, |(arms, _)| self.tilt * arms[i])
    }
}

/// A solution of [`Complementarity`], or what an iteration has come to.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct State {
    /// Pressures.
    pub(super) pressure: Vec<f64>,
    /// The gap under them, zero in the contact but for the residual.
    pub(super) gap: Vec<f64>,
    /// The motion that the load causes.
    pub(super) motion: Motion,
    /// What the conditions of contact are missed by, in parts of the displacement (both root mean
    /// squares over the contact).
    pub(super) residual: f64,
    /// Applications of the displacement.
    pub(super) iterations: usize,
}

/// Share of a set's first residual at which the set is looked at again.
const SETTLED: f64 = 0.1;

impl Complementarity<'_> {
    /// Solves from the pressure `start` >= 0, not zero everywhere, to the residual `tolerance`;
    /// gives up, with what it has, after `most` applications of the displacement, or where it is
    /// stopped. Tells `progress` of their number and of the residual.
    ///
    /// On the set of cells in contact the pressure solves linear equations with one constraint, its
    /// sum, whose multiplier is D, and with arms another one, whose multiplier is T: conjugate
    /// gradients, preconditioned and projected (Polonsky and Keer 1999, Wear 231, 206; with a
    /// preconditioner Vollebregt 2014, J. Comput. Phys. 257, 333). Once the residual on the set has
    /// fallen, cells of tensile pressure leave the set and cells that penetrate enter it. The
    /// pressures are set to the prescribed load, and the displacement is taken anew, whenever cells
    /// were cut off, not carried along with what the step does: that is what the published
    /// iteration leaves inexact.
    pub(super) fn solve(
        &mut self,
        start: Vec<f64>,
        tolerance: f64,
        most: usize,
        progress: &dyn Fn(usize, f64),
    ) -> State {
        let n = self.gap.len();
        let mut pressure = start;
        self.rescale(&mut pressure);
        let mut u = vec![0.0; n];
        self.displacement.apply(&pressure, &mut u);
        let mut iterations = 1;
        let mut line = Line { step: vec![0.0; n], moved: vec![0.0; n], last: None };
        let mut set = self.set(pressure.iter().map(|p| *p > 0.0).collect());
        let mut looked_at = f64::INFINITY;
        loop {
            let (descent, motion) = self.descent(&set, &u);
            let (gap, arms) = (self.gap, self.arms);
            let misfit: Vec<f64> = (0..n).map(|i| u[i] + gap[i] - motion.at(arms, i)).collect();
            let residual = Residual::new(&set.contact, &u, &misfit);
            let (on_set, relative) = (residual.on_set.sqrt(), residual.relative());
            progress(iterations, relative);
            let tensile = pressure.iter().any(|p| *p < 0.0);
            let settled = relative <= tolerance && !tensile;
            if settled || relative.is_nan() || iterations >= most || go_on().is_err() {
                pressure.iter_mut().for_each(|p| *p = p.max(0.0));
                return State { pressure, gap: misfit, motion, residual: relative, iterations };
            }
            if line.last.is_none() {
                looked_at = on_set;
            } else if on_set <= SETTLED * looked_at || relative <= tolerance {
                looked_at = on_set;
                let (changed, cut) = change(&mut pressure, &mut set.contact, &misfit);
                if cut {
                    self.rescale(&mut pressure);
                    self.displacement.apply(&pressure, &mut u);
                    iterations += 1;
                }
                if changed {
                    set = self.set(set.contact);
                    line.last = None;
                    continue;
                }
            }
            line.turn(&descent, &misfit);
            self.displacement.apply(&line.step, &mut line.moved);
            iterations += 1;
            line.advance(&misfit, &mut pressure, &mut u);
        }
    }

    /// A set of cells, and what the preconditioner makes of rigid misfits on it.
    fn set(&mut self, contact: Vec<bool>) -> ContactSet {
        let n = contact.len();
        let mut prepared = |misfit: &dyn Fn(usize) -> f64| {
            let own: Vec<f64> = (0..n).map(|i| if contact[i] { misfit(i) } else { 0.0 }).collect();
            let mut made = vec![0.0; n];
            self.inverse.apply(&own, &mut made);
            project(&mut made, &contact);
            made
        };
        let ones = prepared(&|_| 1.0);
        let arms = self.arms.map_or(Vec::new(), |(arms, _)| prepared(&|i| arms[i]));
        let sums = self.sums(&ones);
        let [_, second] = self.sums(&arms);
        ContactSet { contact, products: [sums[0], sums[1], second], ones, arms }
    }

    /// The sum of `values`, and that of the arms times them.
    fn sums(&self, values: &[f64]) -> [f64; 2] {
        [values.iter().sum(), self.arms.map_or(0.0, |(arms, _)| dot(arms, values))]
    }

    /// The change of pressure on the set that the preconditioner holds against the misfit u + gap -
    /// D - T y, with the motion such that it changes no sum; and this motion.
    fn descent(&mut self, set: &ContactSet, u: &[f64]) -> (Vec<f64>, Motion) {
        let mut misfit: Vec<f64> = u.iter().zip(self.gap).map(|(u, gap)| u + gap).collect();
        project(&mut misfit, &set.contact);
        let mut descent = vec![0.0; misfit.len()];
        self.inverse.apply(&misfit, &mut descent);
        project(&mut descent, &set.contact);
        let [sum, moment] = self.sums(&descent);
        let [ones, both, arms] = set.products;
        let motion = match self.arms {
            None => Motion { approach: sum / ones, tilt: 0.0 },
            Some(_) => {
                let determinant = ones * arms - both * both;
                let approach = (sum * arms - moment * both) / determinant;
                Motion { approach, tilt: (moment * ones - sum * both) / determinant }
            }
        };
        descent.iter_mut().zip(&set.ones).for_each(|(d, one)| *d = motion.approach * one - *d);
        descent.iter_mut().zip(&set.arms).for_each(|(d, arm)| *d += motion.tilt * arm);
        (descent, motion)
    }

    /// Scales the pressures to their sum; with arms by e^(s y) besides, which keeps them positive,
    /// for the sum of arms times pressures.
    fn rescale(&self, pressure: &mut [f64]) {
        if let Some((arms, moment)) = self.arms {
            let wanted = moment / self.total;
            let longest = arms.iter().fold(0.0, |m: f64, y| m.max(y.abs()));
            // The centre of pressure grows with s: halving finds it.
            let centre = |s: f64| {
                let all =
                    pressure.iter().zip(arms).map(|(p, y)| (p * (s * (y - longest)).exp(), y));
                let [sum, turned] =
                    all.fold([0.0; 2], |[sum, turned], (p, y)| [sum + p, turned + p * y]);
                turned / sum
            };
            let [mut low, mut high] = [-1.0, 1.0].map(|side| side * STEEPEST / longest);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if centre(middle) < wanted { low = middle } else { high = middle }
            }
            let s = 0.5 * (low + high);
            pressure.iter_mut().zip(arms).for_each(|(p, y)| *p *= (s * y).exp());
        }
        let scale = self.total / pressure.iter().sum::<f64>();
        pressure.iter_mut().for_each(|p| *p *= scale);
    }
}

/// Largest exponent of the factors that turn pressures, and how often its range is halved.
const STEEPEST: f64 = 300.0;
const HALVINGS: usize = 62;

/// Cells in contact.
struct ContactSet {
    contact: Vec<bool>,
    /// The preconditioned uniform misfit, and that which is as the arms.
    ones: Vec<f64>,
    arms: Vec<f64>,
    /// Products of 1 and 1, 1 and y, y and y by the preconditioner.
    products: [f64; 3],
}

/// The line along which conjugate gradients search.
struct Line {
    /// Change of the pressures, zero in sum and outside the contact, and the displacement that it
    /// causes.
    step: Vec<f64>,
    moved: Vec<f64>,
    /// Product of the last misfit and its descent; none before the first step on a set.
    last: Option<f64>,
}

impl Line {
    /// Takes up `descent`, conjugate to the last step.
    fn turn(&mut self, descent: &[f64], misfit: &[f64]) {
        let product = -dot(descent, misfit);
        let share = self.last.map_or(0.0, |last| product / last);
        self.step.iter_mut().zip(descent).for_each(|(step, d)| *step = d + share * *step);
        self.last = Some(product);
    }

    /// Goes to where the energy along the line is least.
    fn advance(&self, misfit: &[f64], pressure: &mut [f64], u: &mut [f64]) {
        let length = -dot(&self.step, misfit) / dot(&self.step, &self.moved);
        pressure.iter_mut().zip(&self.step).for_each(|(p, s)| *p += length * s);
        u.iter_mut().zip(&self.moved).for_each(|(u, m)| *u += length * m);
    }
}

/// Lets cells of tensile pressure leave the contact, and those enter it whose `misfit` says that
/// they penetrate. Whether any did, and whether tension was cut off.
fn change(pressure: &mut [f64], contact: &mut [bool], misfit: &[f64]) -> (bool, bool) {
    let (mut changed, mut cut) = (false, false);
    for ((p, contact), misfit) in pressure.iter_mut().zip(contact).zip(misfit) {
        if *contact && *p <= 0.0 {
            cut |= *p < 0.0;
            (*p, *contact, changed) = (0.0, false, true);
        } else if !*contact && *misfit < 0.0 {
            (*contact, changed) = (true, true);
        }
    }
    (changed, cut)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Zeros `values` outside the `contact`.
fn project(values: &mut [f64], contact: &[bool]) {
    values.iter_mut().zip(contact).filter(|(_, c)| !**c).for_each(|(v, _)| *v = 0.0);
}

/// Sums of squares over the cells.
struct Residual {
    /// Of gaps and penetrations in the contact.
    on_set: f64,
    /// Of penetrations elsewhere.
    elsewhere: f64,
    /// Of the displacement in the contact.
    scale: f64,
}

impl Residual {
    fn new(contact: &[bool], u: &[f64], misfit: &[f64]) -> Self {
        let mut sums = Self { on_set: 0.0, elsewhere: 0.0, scale: 0.0 };
        for ((contact, u), misfit) in contact.iter().zip(u).zip(misfit) {
            if *contact {
                sums.on_set += misfit * misfit;
                sums.scale += u * u;
            } else if *misfit < 0.0 {
                sums.elsewhere += misfit * misfit;
            }
        }
        sums
    }

    fn relative(&self) -> f64 {
        ((self.on_set + self.elsewhere) / self.scale).sqrt()
    }
}
