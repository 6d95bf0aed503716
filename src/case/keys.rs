//! The numbers and the flags of a case: their names in files, their meaning and legal ranges. All
//! readers, checks and tables of parameters use these lists.

use super::document::Table;
use super::draft::{Draft, Form};
use super::model::{Case, Cells, Factors};
use super::profile::ProfileKind;
use crate::base::number::stated;
use crate::base::{Error, Result};
use crate::cells::Detrend;

/// Whether a file must contain a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// Always.
    Always,
    /// Required if the load and the lengths are given in this form, and refused otherwise.
    With(Form),
    /// Exactly one of the numbers of this kind, if the load and the lengths are given in this form.
    OneOf(Form),
    /// Not required; it has a default.
    Optional,
    /// Never; where the load and the lengths are given in the other form it must not stand.
    OptionalWith(Form),
    /// By its table, which need not be there: a number of a profile by its kind, which may be
    /// without it.
    Table,
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
    /// A further condition of a legal value.
    is_legal: Option<fn(f64) -> bool>,
    /// The legal values in words, if the two numbers of the range are not clear by themselves.
    rule: Option<&'static str>,
    /// What to do if a value is not legal.
    remedy: &'static str,
    get: fn(&Draft) -> Option<f64>,
    set: fn(&mut Draft, f64),
}

/// What is on or off in a case; off where a file does not have it.
#[derive(Debug)]
pub struct Flag {
    /// Its place in a case file.
    pub path: &'static str,
    /// What is taken in if it is on, in words.
    pub what: &'static str,
    get: fn(&Case) -> bool,
    set: fn(&mut Case, bool),
}

/// All flags of a case.
pub static FLAGS: [Flag; 1] = [Flag {
    path: "accuracy.first_order",
    what: "what round surfaces and free ends make of each other, to first order in C / R",
    get: |case| case.accuracy.first_order,
    set: |case, on| case.accuracy.first_order = on,
}];

impl Flag {
    /// Its table.
    pub fn table(&self) -> &'static str {
        split(self.path).0
    }

    /// Its name within the table.
    pub fn leaf(&self) -> &'static str {
        split(self.path).1
    }

    /// Whether it is on.
    pub fn get(&self, case: &Case) -> bool {
        (self.get)(case)
    }

    /// Turns it on or off.
    pub fn set(&self, case: &mut Case, on: bool) {
        (self.set)(case, on);
    }
}

/// A text of a case.
#[derive(Debug)]
pub struct Word {
    /// Its places in a case file.
    pub paths: &'static [&'static str],
    /// What it is, in words.
    pub what: &'static str,
    /// The words that it can be; none of a file.
    pub choices: fn() -> Vec<&'static str>,
}

/// The texts of a case besides its name.
pub static WORDS: [Word; 4] = [
    Word {
        paths: &["roller.profile.kind", "block.profile.kind"],
        what: "the kind of the profile",
        choices: || ProfileKind::ALL.map(ProfileKind::name).to_vec(),
    },
    Word {
        paths: &["roller.profile.file", "block.profile.file"],
        what: "CSV with the columns y_m,drop_m, beside the case file; for a table",
        choices: Vec::new,
    },
    Word {
        paths: &["surface.heights"],
        what: "the file of the heights, .npy, .csv or .x3p, beside the case file; the first two need \
               dx_m and dy_m",
        choices: Vec::new,
    },
    Word {
        paths: &["surface.detrend"],
        what: "what is taken off the heights; nothing without it",
        choices: || Detrend::ALL.map(Detrend::name).to_vec(),
    },
];

/// The table and the name within it of a path.
pub(super) fn split(path: &'static str) -> (&'static str, &'static str) {
    path.rsplit_once('.').expect("a path has two parts")
}

/// What a table of a case file has besides its numbers and flags: texts, and tables below it.
fn others_of(table: &str) -> impl Iterator<Item = &'static str> {
    let words = WORDS.iter().flat_map(|word| word.paths).map(|path| split(path));
    let own = words.filter(move |(of, _)| *of == table).map(|(_, leaf)| leaf);
    own.chain(["roller", "block"].contains(&table).then_some("profile"))
}

/// Refuses a key of the table `name` that is neither among `keys` nor one of its flags or words.
pub(super) fn only_keys(
    table: &Table,
    name: &str,
    keys: impl Iterator<Item = &'static Key>,
) -> Result<()> {
    let same = keys.filter(|key| key.table() == name).map(|key| key.leaf());
    let flags = FLAGS.iter().filter(|flag| flag.table() == name).map(Flag::leaf);
    let known: Vec<&str> = same.chain(flags).chain(others_of(name)).collect();
    table.only(&known)
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
        split(self.path).0
    }

    /// Its name within the table.
    pub fn leaf(&self) -> &'static str {
        split(self.path).1
    }

    /// Whether a case with the load and the lengths in this form may contain it.
    pub fn is_of(&self, form: Form) -> bool {
        let own = match self.presence {
            Presence::With(own) | Presence::OneOf(own) | Presence::OptionalWith(own) => own,
            Presence::Always | Presence::Optional | Presence::Table => form,
        };
        own == form
    }

    /// Whether a file of its form has to give it.
    pub fn is_required(&self) -> bool {
        matches!(self.presence, Presence::Always | Presence::With(_))
    }

    /// Whether it belongs to the numbers of which a file gives exactly one.
    pub fn is_one_of_several(&self) -> bool {
        matches!(self.presence, Presence::OneOf(_))
    }

    /// Whether the draft has a place for it: a number of a profile needs the profile.
    pub fn fits(&self, draft: &Draft) -> bool {
        let profile = match self.table() {
            "roller.profile" => &draft.case.roller.profile,
            "block.profile" => &draft.case.block.profile,
            "surface" => return draft.case.surface.is_some(),
            _ => return self.is_of(draft.form()),
        };
        profile.as_ref().is_some_and(|p| p.kind.keys().contains(&self.leaf()))
    }

    /// Its value; `None` if the draft's form does not have it.
    pub fn get(&self, draft: &Draft) -> Option<f64> {
        self.is_of(draft.form()).then(|| (self.get)(draft)).flatten()
    }

    /// Sets its value without a check; a number of a profile needs the profile.
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
        if self.takes(value) {
            return Ok(());
        }
        let reason = match self.rule {
            _ if !value.is_finite() => "a finite number belongs here".to_string(),
            Some(rule) => rule.to_string(),
            None if value <= 0.0 && low > 0.0 => format!("{} is greater than zero", self.what),
            None => format!("{} lies between {} and {}", self.what, stated(low), stated(high)),
        };
        Err(self.refuse(value, reason, self.remedy))
    }

    /// An error about a value.
    pub(super) fn refuse(&self, value: f64, reason: String, remedy: &str) -> Error {
        // A value just beyond a limit is not that limit.
        let rounded = stated(value);
        let is_limit = !self.takes(value) && rounded.parse().is_ok_and(|v| self.takes(v));
        let value = if is_limit { format!("{value:e}") } else { rounded };
        Error::Value { key: self.path.to_string(), value, reason, remedy: remedy.to_string() }
    }

    /// Whether a value is legal.
    pub(super) fn takes(&self, value: f64) -> bool {
        let (low, high) = self.range;
        (low..=high).contains(&value) && self.is_legal.is_none_or(|legal| legal(value))
    }

    /// The same key with a further condition on its legal values.
    const fn only(self, is_legal: fn(f64) -> bool) -> Self {
        Self { is_legal: Some(is_legal), ..self }
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
    ($path:expr, $column:expr, $what:expr, $range:expr, $example:literal, $presence:expr,
     case $(.$field:ident)+) => {
        key!($path, $column, $what, $range, $example, $presence,
            |draft| Some(draft.case$(.$field)+),
            |draft, value| draft.case$(.$field)+ = value)
    };
    ($path:expr, $column:expr, $what:expr, $range:expr, $example:literal, $presence:expr,
     some $body:ident.profile.$field:ident) => {
        key!($path, $column, $what, $range, $example, $presence,
            |draft| draft.case.$body.profile.as_ref()?.$field,
            |draft, value| draft.case.$body.profile.iter_mut().for_each(|p| p.$field = Some(value)))
    };
    ($path:expr, $column:expr, $what:expr, $range:expr, $example:literal, $presence:expr,
     some $(.$field:ident)+) => {
        key!($path, $column, $what, $range, $example, $presence,
            |draft| draft.case$(.$field)+,
            |draft, value| draft.case$(.$field)+ = Some(value))
    };
    ($path:expr, $column:expr, $what:expr, $range:expr, $example:literal, $presence:expr,
     factors.$field:ident) => {
        key!($path, $column, $what, $range, $example, $presence,
            |draft| draft.factors.map(|factors| factors.$field),
            |draft, value| draft.factors.iter_mut().for_each(|factors| factors.$field = value))
    };
    ($path:expr, $column:expr, $what:expr, $range:expr, $example:literal, $presence:expr,
     $get:expr, $set:expr) => {
        Key {
            path: $path,
            column: $column,
            what: $what,
            range: $range,
            example: $example,
            presence: $presence,
            is_legal: None,
            rule: None,
            remedy: CORRECT,
            get: $get,
            set: $set,
        }
    };
}

/// Legal range of places along y (m).
const PLACES: (f64, f64) = (-LENGTHS.1, LENGTHS.1);

/// Legal range of drops of a profile (m).
const DROPS: (f64, f64) = (1e-12, 1.0);

/// Legal range of forces (N).
const FORCES: (f64, f64) = (1e-12, 1e15);

/// Legal range of approaches (m).
const APPROACHES: (f64, f64) = (1e-12, 1.0);

/// Legal range of tilts (rad): beyond, the slope is not small.
const TILTS: (f64, f64) = (-0.1, 0.1);

/// Legal range of residual stresses (Pa).
const RESIDUALS: (f64, f64) = (-MODULI.1, MODULI.1);

const ECCENTRICITY: &str = "y of the load's line of action from the roller's middle in metres";

const ALWAYS: Presence = Presence::Always;
const OPTIONAL: Presence = Presence::Optional;
const WITH_LOAD: Presence = Presence::With(Form::Load);
const GIVES_LOAD: Presence = Presence::OneOf(Form::Load);
const WITH_FACTORS: Presence = Presence::With(Form::Factors);

/// A number of a body's profile.
macro_rules! profile_key {
    ($body:ident, $field:ident, $what:literal, $range:expr, $example:literal) => {
        key!(
            concat!(stringify!($body), ".profile.", stringify!($field)),
            concat!(stringify!($body), "_profile_", stringify!($field)),
            $what, $range, $example, Presence::Table, some $body.profile.$field
        )
    };
    ($body:ident, radius_m) => {
        profile_key!($body, radius_m, "the radius of a crown or of a relief's arcs in metres", LENGTHS,
            "5.0")
    };
    ($body:ident, amplitude_m) => {
        profile_key!($body, amplitude_m, "the factor of a logarithmic profile in metres", DROPS, "2e-6")
    };
    ($body:ident, k) => {
        profile_key!($body, k, "k of a logarithmic profile", (1e-9, 1f64.next_down()), "0.95")
            .ruled("k of a logarithmic profile is greater than 0 and less than 1",
                "write for example 0.95: with 1 the ends would drop without limit")
    };
    ($body:ident, design_force_n) => {
        profile_key!($body, design_force_n, "the force in newtons that the profile is made for",
            FORCES, "5000.0")
    };
    ($body:ident, k1) => {
        profile_key!($body, k1, "K1 of Fujiwara's profile", (1e-3, 1e3), "1.5")
    };
    ($body:ident, k2) => {
        profile_key!($body, k2, "K2 of Fujiwara's profile", (1e-9, 1.0), "0.6")
    };
    ($body:ident, zm_m) => {
        profile_key!($body, zm_m, "the drop of Fujiwara's profile at the end in metres", DROPS, "10e-6")
    };
    ($body:ident, straight_m) => {
        profile_key!($body, straight_m, "the length of a relief's straight part in metres", (0.0, 1e4),
            "6e-3")
    };
}

/// A number of the rough surface.
macro_rules! surface_key {
    ($field:ident, $what:literal) => {
        key!(
            concat!("surface.", stringify!($field)),
            concat!("surface_", stringify!($field)),
            $what,
            LENGTHS,
            "1e-6",
            Presence::Table,
            |draft| Some(draft.case.surface.as_ref()?.$field),
            |draft, value| draft.case.surface.iter_mut().for_each(|s| s.$field = value)
        )
    };
}

/// All numbers of a case, in the order of its file. The keys of a table stand side by side.
#[rustfmt::skip]
pub static KEYS: [Key; 44] = [
    key!("roller.radius_m", "radius_m", "the roller's radius in metres", LENGTHS, "10e-3", ALWAYS,
        case.roller.radius_m),
    key!("roller.length_m", "roller_length_m", "the roller's length in metres", LENGTHS, "10e-3",
        WITH_LOAD, case.roller.length_m),
    key!("roller.young_pa", "roller_young_pa", "Young's modulus in pascals", MODULI, "210e9", ALWAYS,
        case.roller.material.young_pa),
    key!("roller.poisson", "roller_poisson", "Poisson's ratio", RATIOS, "0.3", ALWAYS,
        case.roller.material.poisson).ruled(RATIO_RULE, RATIO_REMEDY),
    profile_key!(roller, radius_m),
    profile_key!(roller, amplitude_m),
    profile_key!(roller, k),
    profile_key!(roller, design_force_n),
    profile_key!(roller, k1),
    profile_key!(roller, k2),
    profile_key!(roller, zm_m),
    profile_key!(roller, straight_m),
    key!("block.length_m", "block_length_m", "the block's length in metres", LENGTHS, "20e-3",
        WITH_LOAD, case.block.length_m),
    key!("block.young_pa", "block_young_pa", "Young's modulus in pascals", MODULI, "210e9", ALWAYS,
        case.block.material.young_pa),
    key!("block.poisson", "block_poisson", "Poisson's ratio", RATIOS, "0.3", ALWAYS,
        case.block.material.poisson).ruled(RATIO_RULE, RATIO_REMEDY),
    key!("block.radius_m", "block_radius_m", "the radius of a raceway in metres, negative if concave,",
        PLACES, "-0.05", OPTIONAL, some .block.radius_m)
        .only(|radius| radius.abs() >= LENGTHS.0)
        .ruled("a raceway's radius lies between -10000 and 10000 m and is not zero",
            "remove it for a flat block"),
    profile_key!(block, radius_m),
    profile_key!(block, amplitude_m),
    profile_key!(block, k),
    profile_key!(block, design_force_n),
    profile_key!(block, k1),
    profile_key!(block, k2),
    profile_key!(block, zm_m),
    profile_key!(block, straight_m),
    key!("dimensionless.W", "W", "the load factor W", Factors::LOAD_RANGE, "5e-4", WITH_FACTORS,
        factors.load),
    key!("dimensionless.S_l", "S_l", "the slenderness S_l", Factors::SLENDERNESS_RANGE, "5.0",
        WITH_FACTORS, factors.slenderness),
    key!("dimensionless.L_r", "L_r", "the length ratio L_r", Factors::LENGTH_RATIO_RANGE, "1.0",
        WITH_FACTORS, factors.length_ratio)
        .ruled("L_r = L1 / L2 lies between 0.001 and 1000", "write 1 for flush ends"),
    key!("dimensionless.eccentricity_m", "dimensionless_eccentricity_m", ECCENTRICITY, PLACES, "0.0",
        Presence::OptionalWith(Form::Factors), some .load.eccentricity_m),
    key!("load.force_n", "force_n", "the load in newtons", FORCES, "1000.0", GIVES_LOAD,
        |draft| Some(draft.case.load.force_n).filter(|_| draft.case.load.approach_m.is_none()),
        |draft, value| {
            draft.case.load.force_n = value;
            draft.case.load.approach_m = None;
        }),
    key!("load.approach_m", "approach_m",
        "the approach of points one roller radius below the surfaces, in metres,", APPROACHES, "5e-6",
        GIVES_LOAD, |draft| draft.case.load.approach_m,
        |draft, value| {
            draft.case.load.force_n = f64::NAN;
            draft.case.load.approach_m = Some(value);
        }),
    key!("load.eccentricity_m", "eccentricity_m", ECCENTRICITY, PLACES, "0.0",
        Presence::OptionalWith(Form::Load), some .load.eccentricity_m),
    key!("pose.tilt_rad", "tilt_rad", "the tilt in radians", TILTS, "0.0", OPTIONAL,
        some .pose.tilt_rad),
    key!("pose.offset_m", "offset_m", "y of the block's middle from the roller's in metres", PLACES,
        "0.0", OPTIONAL, case.pose.offset_m),
    key!("sliding.friction", "friction", "the friction, traction over pressure,", (0.0, 1.0), "0.1",
        OPTIONAL, case.sliding.friction),
    surface_key!(dx_m, "the distance of the heights across the contact in metres"),
    surface_key!(dy_m, "the distance of the heights along the contact in metres"),
    key!("fatigue.dang_van_alpha", "dang_van_alpha", "Dang Van's factor alpha", (0.0, 10.0), "0.3",
        OPTIONAL, some .fatigue.dang_van_alpha),
    key!("fatigue.dang_van_beta_pa", "dang_van_beta_pa", "Dang Van's limit beta in pascals", MODULI,
        "360e6", OPTIONAL, some .fatigue.dang_van_beta_pa),
    key!("fatigue.fatemi_socie_k", "fatemi_socie_k", "Fatemi and Socie's k", (0.0, 10.0), "0.6",
        OPTIONAL, some .fatigue.fatemi_socie_k),
    key!("fatigue.yield_pa", "yield_pa", "the yield stress in pascals", MODULI, "1.8e9", OPTIONAL,
        some .fatigue.yield_pa),
    key!("fatigue.residual_xx_pa", "residual_xx_pa", "the residual stress sigma_xx in pascals",
        RESIDUALS, "-200e6", OPTIONAL, some .fatigue.residual_xx_pa),
    key!("fatigue.residual_yy_pa", "residual_yy_pa", "the residual stress sigma_yy in pascals",
        RESIDUALS, "-200e6", OPTIONAL, some .fatigue.residual_yy_pa),
    key!("accuracy.tolerance", "tolerance", "the tolerance, a fraction of p0,", (1e-5, 1e-1), "1e-3",
        OPTIONAL, case.accuracy.tolerance),
    key!("cells.half_width_m", "cells_half_width_m", "the half-width of the cells in metres", LENGTHS,
        "1e-3", OPTIONAL, |draft| draft.case.cells.map(|cells| cells.half_width_m),
        |draft, half_width_m| draft.case.cells = Some(Cells { half_width_m })),
];
