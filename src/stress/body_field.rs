//! The stress field of a body in units of C and p0, whatever units it is computed in.

use super::field::Field;
use super::flat::FlatStress;
use super::round::RoundStress;
use super::work::Work;
use crate::base::StressTensor;

/// A [`Field`] that is computed in a unit of length of its own, and so with a unit of pressure of
/// its own: both are `unit` times C and p0. A contact much wider than C is then one of half-width
/// 1, to which all resolutions belong.
#[derive(Debug)]
pub struct BodyField<'a> {
    field: Field<'a>,
    unit: f64,
}

impl<'a> BodyField<'a> {
    /// The `field` in C and p0.
    pub fn new(field: Field<'a>, unit: f64) -> Self {
        Self { field, unit }
    }

    /// Whether the contact is symmetric about y = 0.
    pub fn is_symmetric(&self) -> bool {
        self.field.is_symmetric()
    }

    /// The kernel evaluations so far.
    pub fn work(&self) -> Work {
        self.field.work()
    }

    /// [`Field::at`], under the pressure alone.
    pub fn at(&self, y: f64, z: f64, xs: &[f64]) -> Vec<StressTensor> {
        self.flat(self.field.at(self.own(y), self.own(z), &self.all(xs)))
    }

    /// [`Field::down`], under the pressure alone.
    pub fn down(&self, xs: &[f64], y: f64, zs: &[f64]) -> Vec<Vec<StressTensor>> {
        let rows = self.field.down(&self.all(xs), self.own(y), &self.all(zs));
        rows.into_iter().map(|row| self.flat(row)).collect()
    }

    /// [`Field::along`], under the pressure alone.
    pub fn along(&self, x: f64, z: f64, ys: &[f64]) -> Vec<StressTensor> {
        self.flat(self.field.along(self.own(x), self.own(z), &self.all(ys)))
    }

    /// [`Field::round_at`].
    pub fn round_at(&self, y: f64, z: f64, xs: &[f64]) -> Vec<RoundStress> {
        self.round(self.field.round_at(self.own(y), self.own(z), &self.all(xs)))
    }

    /// [`Field::round_down`].
    pub fn round_down(&self, xs: &[f64], y: f64, zs: &[f64]) -> Vec<Vec<RoundStress>> {
        let rows = self.field.round_down(&self.all(xs), self.own(y), &self.all(zs));
        rows.into_iter().map(|row| self.round(row)).collect()
    }

    /// [`Field::round_along`].
    pub fn round_along(&self, z: f64, ys: &[f64]) -> Vec<RoundStress> {
        self.round(self.field.round_along(self.own(z), &self.all(ys)))
    }

    fn own(&self, v: f64) -> f64 {
        v / self.unit
    }

    fn all(&self, values: &[f64]) -> Vec<f64> {
        values.iter().map(|v| self.own(*v)).collect()
    }

    fn flat(&self, stresses: Vec<FlatStress>) -> Vec<StressTensor> {
        stresses.into_iter().map(|s| s.pressure * self.unit).collect()
    }

    fn round(&self, stresses: Vec<RoundStress>) -> Vec<RoundStress> {
        // What the round shape adds is stated per C / R.
        let square = self.unit * self.unit;
        let of = |RoundStress { flat, round }| RoundStress {
            flat: flat * self.unit,
            round: round * square,
        };
        stresses.into_iter().map(of).collect()
    }
}
