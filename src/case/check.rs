//! Checks of a case as a value. Readers add the place in their file, see `document::Table::place`.

use super::draft::{Draft, Form};
use super::keys::{KEYS, Key};
use super::model::{Case, Factors};
use crate::base::{Error, Result};

/// Largest number of letters of a name.
pub(super) const MAX_NAME: usize = 64;

/// Rounding: a case from factors at a limit may exceed the limit by this factor.
const ROUNDING: f64 = 1.0 + 1e-9;

impl Case {
    /// Refuses a case with a name or a number that is not legal, or whose factors are not.
    ///
    /// # Errors
    /// [`Error::Value`] with the key of the case file, for example `block.length_m`.
    pub fn check(&self) -> Result<()> {
        check_name(&self.name)?;
        check_numbers(&Draft::of(self, Form::Load))?;
        self.check_factors()
    }

    /// Checks the factors that follow from the load and the lengths.
    fn check_factors(&self) -> Result<()> {
        let factors = self.factors();
        let refuse = |path: &str, value: f64, reason: String, remedy: &str| {
            let key = Key::find(path).expect("a key of the list");
            Err(key.refuse(value, reason, remedy))
        };
        let (block, roller) = (self.block.length_m, self.roller.length_m);
        if factors.length_ratio > ROUNDING {
            let reason = format!("the block is shorter than the roller ({roller:e} m)");
            let remedy = "make it at least as long: equal lengths are flush ends";
            return refuse("block.length_m", block, reason, remedy);
        }
        let Factors { load, slenderness, length_ratio } = factors;
        let force = self.load.force_n;
        let ranges = [Factors::LENGTH_RATIO_RANGE, Factors::LOAD_RANGE, Factors::SLENDERNESS_RANGE];
        let checks = [
            ("block.length_m", block, "L_r = L1 / L2", length_ratio),
            ("load.force_n", force, "W = w / (E* R L1)", load),
            ("roller.length_m", roller, "S_l = L1 / (2 C)", slenderness),
        ];
        for ((path, own, name, value), (low, high)) in checks.into_iter().zip(ranges) {
            if !(low / ROUNDING..=high * ROUNDING).contains(&value) {
                let reason =
                    format!("{name} becomes {value:.3e} and must lie between {low:e} and {high:e}");
                let remedy = "check the units of the load (N), the lengths and the radius (m), and \
                              the moduli (Pa)";
                return refuse(path, own, reason, remedy);
            }
        }
        Ok(())
    }
}

impl Draft {
    /// The case, if its name and all of its numbers are legal.
    ///
    /// # Errors
    /// As [`Case::check`], for the keys that the draft's form has.
    pub fn case(&self) -> Result<Case> {
        let mut case = self.case.clone();
        let Some(factors) = self.factors else {
            return case.check().map(|()| case);
        };
        check_name(&case.name)?;
        check_numbers(self)?;
        case.set_factors(factors);
        case.check().map(|()| case).map_err(|e| match e {
            Error::Value { key, value, reason, .. } => Error::Value {
                key,
                value,
                reason: format!("it follows from W, S_l and L_r, and {reason}"),
                remedy: "check the radius (m), the moduli (Pa) and the factors".into(),
            },
            other => other,
        })
    }
}

/// Refuses a text that cannot be the name of a folder.
pub(super) fn check_name(name: &str) -> Result<()> {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
    let legal = (1..=MAX_NAME).contains(&name.len()) && name.chars().all(plain);
    if legal && !name.starts_with('.') {
        return Ok(());
    }
    Err(Error::Value {
        key: "name".into(),
        value: format!("{name:?}"),
        reason: format!(
            "a name is 1 to {MAX_NAME} letters, digits, '-', '_' and '.', and does not start with '.'"
        ),
        remedy: "choose such a name: folders are named after it".into(),
    })
}

/// Checks each number that the draft has.
fn check_numbers(draft: &Draft) -> Result<()> {
    let given = |key: &'static Key| key.get(draft).map(|value| (key, value));
    KEYS.iter().filter_map(given).try_for_each(|(key, value)| key.check(value))
}
