//! The numbers of a case: their names in files, their meaning and their legal ranges. All readers,
//! checks and tables of parameters use this list.

use super::draft::{Draft, Form};
use super::model::{Cells, Factors};
use crate::base::{Error, Result};

/// Whether a file must contain a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// Always.
    Always,
    /// Required if the load and the lengths are given in this form, and refused otherwise.
    With(Form),
    /// Not required; it has a default.
    Optional,
}

/// A number of a case.
#[derive(Debug)]
pub struct Key {
    /// Its place in a case file, for example `roller.radius_m`.
    pub path: &'static str,
    /// Its name as the column of a table.
    pub column: &'static str,
    /// The quantity in words, with its unit.
    pub what: &'static str,
    /// The least and the largest legal value.
    pub range: (f64, f64),
    /// A usual value, as written in a file.
    pub example: &'static str,
    /// Whether a file must contain it.
    pub presence: Presence,
    /// The legal values in words, if the two numbers of the range are not clear by themselves.
    rule: Option<&'static str>,
    /// What to do if a value is not legal.
    remedy: &'static str,
    get: fn(&Draft) -> Option<f64>,
    set: fn(&mut Draft, f64),
}

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path
    }
}

impl Key {
    /// The key at `path` in a case file.
    pub fn find(path: &str) -> Option<&'static Key> {
        KEYS.iter().find(|key| key.path == path)
    }

    /// Its table.
    pub fn table(&self) -> &'static str {
        self.path.rsplit_once('.').expect("a path has two parts").0
    }

    /// Its name within the table.
    pub fn leaf(&self) -> &'static str {
        self.path.rsplit_once('.').expect("a path has two parts").1
    }

    /// Whether a case with the load and the lengths in this form may contain it.
    pub fn is_of(&self, form: Form) -> bool {
        !matches!(self.presence, Presence::With(other) if other != form)
    }

    /// Its value; `None` if the draft's form does not have it.
    pub fn get(&self, draft: &Draft) -> Option<f64> {
        self.is_of(draft.form()).then(|| (self.get)(draft)).flatten()
    }

    /// Sets its value without a check.
    ///
    /// # Panics
    /// If the draft's form does not have it, see [`Key::is_of`].
    pub fn set(&self, draft: &mut Draft, value: f64) {
        assert!(self.is_of(draft.form()), "{} belongs to the other form", self.path);
        (self.set)(draft, value);
    }

    /// Refuses a value that is not legal.
    ///
    /// # Errors
    /// [`Error::Value`].
    pub fn check(&self, value: f64) -> Result<()> {
        let (low, high) = self.range;
        if (low..=high).contains(&value) {
            return Ok(());
        }
        let reason = match self.rule {
            _ if !value.is_finite() => "a finite number belongs here".to_string(),
            Some(rule) => rule.to_string(),
            None if value <= 0.0 && low > 0.0 => format!("{} is greater than zero", self.what),
            None => format!("{} lies between {low:e} and {high:e}", self.what),
        };
        Err(self.refuse(value, reason, self.remedy))
    }

    /// An error about a value.
    pub(super) fn refuse(&self, value: f64, reason: String, remedy: &str) -> Error {
        let (key, value) = (self.path.to_string(), format!("{value:e}"));
        Error::Value { key, value, reason, remedy: remedy.to_string() }
    }

    /// The same key with its legal values described in words.
    const fn ruled(self, rule: &'static str, remedy: &'static str) -> Self {
        Self { rule: Some(rule), remedy, ..self }
    }
}

/// Legal range of lengths and radii (m).
const LENGTHS: (f64, f64) = (1e-9, 1e4);

/// Legal range of Young's moduli (Pa). The lower limit also catches numbers in GPa or MPa.
const MODULI: (f64, f64) = (1e3, 1e14);

/// Legal range of Poisson's ratio: it is less than 0.5.
const RATIOS: (f64, f64) = (0.0, 0.5f64.next_down());

const RATIO_RULE: &str = "Poisson's ratio is at least 0 and less than 0.5";
const RATIO_REMEDY: &str =
    "steel has 0.3; for a nearly incompressible material write for example 0.49";

const CORRECT: &str = "correct the value, and check its unit";

/// Path, column, quantity, range, example, presence, and how to read and write the value in a
/// draft: a field of `case`, or of `factors` if the draft has them.
macro_rules! key {
    ($path:literal, $column:literal, $what:literal, $range:expr, $example:literal, $presence:expr,
     case $(.$field:ident)+) => {
        key!($path, $column, $what, $range, $example, $presence,
            |draft| Some(draft.case$(.$field)+),
            |draft, value| draft.case$(.$field)+ = value)
    };
    ($path:literal, $column:literal, $what:literal, $range:expr, $example:literal, $presence:expr,
     factors.$field:ident) => {
        key!($path, $column, $what, $range, $example, $presence,
            |draft| draft.factors.map(|factors| factors.$field),
            |draft, value| draft.factors.iter_mut().for_each(|factors| factors.$field = value))
    };
    ($path:literal, $column:literal, $what:literal, $range:expr, $example:literal, $presence:expr,
     $get:expr, $set:expr) => {
        Key {
            path: $path,
            column: $column,
            what: $what,
            range: $range,
            example: $example,
            presence: $presence,
            rule: None,
            remedy: CORRECT,
            get: $get,
            set: $set,
        }
    };
}

const ALWAYS: Presence = Presence::Always;
const OPTIONAL: Presence = Presence::Optional;
const WITH_LOAD: Presence = Presence::With(Form::Load);
const WITH_FACTORS: Presence = Presence::With(Form::Factors);

/// All numbers of a case, in the order of its file. The keys of a table stand side by side.
#[rustfmt::skip]
pub static KEYS: [Key; 13] = [
    key!("roller.radius_m", "radius_m", "the roller's radius in metres", LENGTHS, "10e-3", ALWAYS,
        case.roller.radius_m),
    key!("roller.length_m", "roller_length_m", "the roller's length in metres", LENGTHS, "10e-3",
        WITH_LOAD, case.roller.length_m),
    key!("roller.young_pa", "roller_young_pa", "Young's modulus in pascals", MODULI, "210e9", ALWAYS,
        case.roller.material.young_pa),
    key!("roller.poisson", "roller_poisson", "Poisson's ratio", RATIOS, "0.3", ALWAYS,
        case.roller.material.poisson).ruled(RATIO_RULE, RATIO_REMEDY),
    key!("block.length_m", "block_length_m", "the block's length in metres", LENGTHS, "20e-3",
        WITH_LOAD, case.block.length_m),
    key!("block.young_pa", "block_young_pa", "Young's modulus in pascals", MODULI, "210e9", ALWAYS,
        case.block.material.young_pa),
    key!("block.poisson", "block_poisson", "Poisson's ratio", RATIOS, "0.3", ALWAYS,
        case.block.material.poisson).ruled(RATIO_RULE, RATIO_REMEDY),
    key!("dimensionless.W", "W", "the load factor W", Factors::LOAD_RANGE, "5e-4", WITH_FACTORS,
        factors.load),
    key!("dimensionless.S_l", "S_l", "the slenderness S_l", Factors::SLENDERNESS_RANGE, "5.0",
        WITH_FACTORS, factors.slenderness),
    key!("dimensionless.L_r", "L_r", "the length ratio L_r", Factors::LENGTH_RATIO_RANGE, "1.0",
        WITH_FACTORS, factors.length_ratio)
        .ruled("the roller is at most as long as the block, and L_r = L1 / L2 lies between 1e-3 and 1",
            "write 1 for flush ends"),
    key!("load.force_n", "force_n", "the load in newtons", (1e-12, 1e15), "1000.0", WITH_LOAD,
        case.load.force_n),
    key!("accuracy.tolerance", "tolerance", "the tolerance, a fraction of p0,", (1e-5, 1e-1), "1e-3",
        OPTIONAL, case.accuracy.tolerance),
    key!("cells.half_width_m", "cells_half_width_m", "the half-width of the cells in metres", LENGTHS,
        "1e-3", OPTIONAL, |draft| draft.case.cells.map(|cells| cells.half_width_m),
        |draft, half_width_m| draft.case.cells = Some(Cells { half_width_m })),
];
