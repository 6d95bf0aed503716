//! The contact iteration.

use super::linear::Linear;

/// The complementarity problem of a contact over n cells: u + gap = D where p > 0, u + gap >= D elsewhere, sum p given.
pub(super) struct Complementarity<'a> {
    /// Displacement u of a pressure.
    pub(super) displacement: &'a mut dyn Linear,
    /// An approximate inverse of the displacement, symmetric and positive.
    pub(super) inverse: &'a mut dyn Linear,
    /// The gap before loading.
    pub(super) gap: &'a [f64],
    /// Sum of the pressures.
    pub(super) total: f64,
}

/// A solution of [`Complementarity`], or what an iteration has come to.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct State {
    /// Pressures.
    pub(super) pressure: Vec<f64>,
    /// Approach D.
    pub(super) approach: f64,
    /// What the conditions of contact are missed by, in parts of the displacement (both root mean
    /// squares over the contact).
    pub(super) residual: f64,
    /// Applications of the displacement.
    pub(super) iterations: usize,
}

/// Share of a set's first residual at which the set is looked at again.
const SETTLED: f64 = 0.1;

impl Complementarity<'_> {
    /// Solves from the pressure `start` >= 0, not zero everywhere, to the residual `tolerance`; gives up, with what it has, after
    /// `most` applications of the displacement. Tells `progress` of their number and of the residual.
    ///
    /// On the set of cells in contact the pressure solves linear equations with one constraint, its sum, whose
    /// multiplier is D: conjugate gradients, preconditioned and projected (Polonsky and Keer 1999, Wear 231, 206; with a preconditioner Vollebregt 2014, J. Comput. Phys. 257, 333). Once the residual
    /// on the set has fallen, cells that pull leave the set and cells that penetrate enter it. The
    /// pressures are set to the prescribed load, and the displacement is taken anew, whenever cells were cut off, not
    /// carried along with what the step does: that is what the published iteration leaves inexact.
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
            let (descent, approach) = self.descent(&set, &u);
            let residual = Residual::new(&set.contact, &u, self.gap, approach);
            let (on_set, relative) = (residual.on_set.sqrt(), residual.relative());
            progress(iterations, relative);
            let pulled = pressure.iter().any(|p| *p < 0.0);
            if (relative <= tolerance && !pulled) || iterations >= most {
                pressure.iter_mut().for_each(|p| *p = p.max(0.0));
                return State { pressure, approach, residual: relative, iterations };
            }
            if line.last.is_none() {
                looked_at = on_set;
            } else if on_set <= SETTLED * looked_at || relative <= tolerance {
                looked_at = on_set;
                let gap = self.gap;
                let (changed, cut) =
                    change(&mut pressure, &mut set.contact, |i| u[i] + gap[i] < approach);
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
            let misfit: Vec<f64> =
                u.iter().zip(self.gap).map(|(u, gap)| u + gap - approach).collect();
            line.turn(&descent, &misfit);
            self.displacement.apply(&line.step, &mut line.moved);
            iterations += 1;
            line.advance(&misfit, &mut pressure, &mut u);
        }
    }

    /// A set of cells, and what the preconditioner makes of a uniform misfit on it.
    fn set(&mut self, contact: Vec<bool>) -> ContactSet {
        let unit: Vec<f64> = contact.iter().map(|c| f64::from(u8::from(*c))).collect();
        let mut ones = vec![0.0; contact.len()];
        self.inverse.apply(&unit, &mut ones);
        project(&mut ones, &contact);
        ContactSet { ones_sum: ones.iter().sum(), contact, ones }
    }

    /// The change of pressure on the set that the preconditioner holds against the misfit u + gap - D, with D such
    /// that it changes no sum; and this D.
    fn descent(&mut self, set: &ContactSet, u: &[f64]) -> (Vec<f64>, f64) {
        let mut misfit: Vec<f64> = u.iter().zip(self.gap).map(|(u, gap)| u + gap).collect();
        project(&mut misfit, &set.contact);
        let mut descent = vec![0.0; misfit.len()];
        self.inverse.apply(&misfit, &mut descent);
        project(&mut descent, &set.contact);
        let approach = descent.iter().sum::<f64>() / set.ones_sum;
        descent.iter_mut().zip(&set.ones).for_each(|(d, one)| *d = approach * one - *d);
        (descent, approach)
    }

    /// Scales the pressures to their sum.
    fn rescale(&self, pressure: &mut [f64]) {
        let scale = self.total / pressure.iter().sum::<f64>();
        pressure.iter_mut().for_each(|p| *p *= scale);
    }
}

/// Cells in contact.
struct ContactSet {
    contact: Vec<bool>,
    /// The preconditioned uniform misfit, and its sum.
    ones: Vec<f64>,
    ones_sum: f64,
}

/// The line along which conjugate gradients search.
struct Line {
    /// Change of the pressures, zero in sum and outside the contact, and the displacement that it causes.
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

/// Lets cells that pull leave the contact and those that penetrate enter it. Whether any did, and whether pull
/// was cut off.
fn change(
    pressure: &mut [f64],
    contact: &mut [bool],
    penetrates: impl Fn(usize) -> bool,
) -> (bool, bool) {
    let (mut changed, mut cut) = (false, false);
    for (i, (p, contact)) in pressure.iter_mut().zip(contact).enumerate() {
        if *contact && *p <= 0.0 {
            cut |= *p < 0.0;
            (*p, *contact, changed) = (0.0, false, true);
        } else if !*contact && penetrates(i) {
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
    fn new(contact: &[bool], u: &[f64], gap: &[f64], approach: f64) -> Self {
        let mut sums = Self { on_set: 0.0, elsewhere: 0.0, scale: 0.0 };
        for ((contact, u), gap) in contact.iter().zip(u).zip(gap) {
            let gap = u + gap - approach;
            if *contact {
                sums.on_set += gap * gap;
                sums.scale += u * u;
            } else if gap < 0.0 {
                sums.elsewhere += gap * gap;
            }
        }
        sums
    }

    fn relative(&self) -> f64 {
        ((self.on_set + self.elsewhere) / self.scale).sqrt()
    }
}
