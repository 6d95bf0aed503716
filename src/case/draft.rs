//! A case as given in a file, before its numbers are checked.

use super::model::{Case, Factors};
use crate::base::Material;

/// The two ways to give the load and the lengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// `[dimensionless]`: by W, S_l and L_r.
    Factors,
    /// `[load]`: by the load itself, and by lengths with the bodies.
    Load,
}

/// A case whose numbers are not checked yet, in either [`Form`]. [`Draft::case`] makes the case.
#[derive(Debug, Clone, PartialEq)]
pub struct Draft {
    /// The values in SI units. With `factors`, its load and lengths are not used.
    pub(super) case: Case,
    /// The factors, if they give the load and the lengths.
    pub(super) factors: Option<Factors>,
}

impl Draft {
    /// A draft without any number but the default accuracy.
    pub fn new(name: impl Into<String>, form: Form) -> Self {
        let missing = f64::NAN;
        let material = Material { young_pa: missing, poisson: missing };
        let factors = Factors { load: missing, slenderness: missing, length_ratio: missing };
        let case = Case::from_factors(name, missing, material, material, factors);
        Self { case, factors: (form == Form::Factors).then_some(factors) }
    }

    /// The draft of a case, in the given form.
    pub fn of(case: &Case, form: Form) -> Self {
        let factors = (form == Form::Factors).then(|| case.factors());
        Self { case: case.clone(), factors }
    }

    /// The form in which the load is given.
    pub fn form(&self) -> Form {
        if self.factors.is_some() { Form::Factors } else { Form::Load }
    }

    /// The same under another name.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.case.name = name.into();
        self
    }
}
