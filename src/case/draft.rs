//! A case as a file gives it, before it is known to be one.

use super::model::{Case, Factors};
use crate::base::Material;

/// Which of the two ways gives the load and the lengths.
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
    /// What is given in SI units. With `factors`, the load and the lengths mean nothing.
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
        let factors = || {
            let own = case.factors();
            // Equal lengths may come out as 1 and a rounding.
            Factors { length_ratio: own.length_ratio.min(1.0), ..own }
        };
        Self { case: case.clone(), factors: (form == Form::Factors).then(factors) }
    }

    /// How the load is given.
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
