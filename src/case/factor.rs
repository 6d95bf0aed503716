//! The factors that a study may vary: every number of a smooth case, and two that have no unit.

use super::draft::{Draft, Form};
use super::keys::{KEYS, Key};
use super::model::Case;
use super::profile::{ProfileKind, ProfileSpec};
use crate::base::number::stated;
use crate::base::{BodyKind, Error, Result};

/// A quantity that differs between the cases of a study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FactorKey {
    /// A number of the case.
    Number(&'static Key),
    /// The drop of a body's profile at the body's ends in C^2 / (2 R), which is the drop of the
    /// round bodies from one another at x = C. R is the equivalent radius. It sets the one number
    /// of the profile that scales the drop.
    EndDrop(BodyKind),
    /// The load's eccentricity in lengths of the shorter body.
    Eccentricity,
}

/// The numbers of `[dimensionless]` that a study names without their table.
const PLAIN: &str = "dimensionless.";

/// Legal range of end drops (C^2 / (2 R)): beyond, they follow from a mistake.
const DROPS: (f64, f64) = (1e-6, 1e6);

impl FactorKey {
    /// All factors, those without a unit first.
    pub fn all() -> impl Iterator<Item = Self> {
        let drops = [BodyKind::Roller, BodyKind::Block].map(Self::EndDrop);
        let numbers = KEYS.iter().filter(|key| key.table() != "surface").map(Self::Number);
        let (plain, others): (Vec<Self>, Vec<Self>) =
            numbers.partition(|factor| factor.path() != factor.name());
        plain.into_iter().chain(drops).chain([Self::Eccentricity]).chain(others)
    }

    /// The factor of this name, or of this path in a case file.
    pub fn find(path: &str) -> Option<Self> {
        Self::all().find(|factor| [factor.path(), factor.name()].contains(&path))
    }

    /// Its place in a case file; its name if a case file does not have it.
    pub fn path(self) -> &'static str {
        match self {
            Self::Number(key) => key.path,
            Self::EndDrop(BodyKind::Block) => "block.end_drop",
            Self::EndDrop(BodyKind::Roller) => "roller.end_drop",
            Self::Eccentricity => "eccentricity",
        }
    }

    /// Its name in studies and their results: its path, for W, S_l and L_r without the table.
    pub fn name(self) -> &'static str {
        let path = self.path();
        let plain = path.strip_prefix(PLAIN).filter(|leaf| ["W", "S_l", "L_r"].contains(leaf));
        plain.unwrap_or(path)
    }

    /// The unit of its levels as axes of plots have it; none for those of `[dimensionless]`.
    pub fn unit(self) -> Option<&'static str> {
        match self {
            Self::Number(key) => match key.leaf().rsplit_once('_')?.1 {
                "m" => Some("m"),
                "pa" => Some("Pa"),
                "n" => Some("N"),
                "rad" => Some("rad"),
                _ => None,
            },
            Self::EndDrop(_) => Some("C²/2R"),
            Self::Eccentricity => Some("lengths of the shorter body"),
        }
    }

    /// What stands before its level in the names of cases.
    pub fn token(self) -> String {
        match self {
            Self::Number(key) => match self.name() {
                "W" => "w".into(),
                "S_l" => "sl".into(),
                "L_r" => "lr".into(),
                _ => {
                    let units = ["_m", "_pa", "_n", "_rad"];
                    let plain = units.iter().find_map(|unit| key.column.strip_suffix(unit));
                    plain.unwrap_or(key.column).to_string()
                }
            },
            Self::EndDrop(BodyKind::Block) => "block_drop".into(),
            Self::EndDrop(BodyKind::Roller) => "drop".into(),
            Self::Eccentricity => "ecc".into(),
        }
    }

    /// The number of the case that it sets, and that a file then must not contain. An end drop
    /// needs the profile.
    ///
    /// # Errors
    /// [`Error::Value`] where the draft has no place for it.
    pub(super) fn key(self, draft: &Draft) -> Result<&'static Key> {
        let path = match self {
            Self::Number(key) if key.fits(draft) => return Ok(key),
            Self::Number(key) => {
                let (table, leaf) = (key.table(), key.leaf());
                let reason = match table.ends_with(".profile") {
                    true => format!("[{table}] has no {leaf}, by its kind"),
                    false => "it belongs to the other way to give the load".to_string(),
                };
                return Err(self.refuse(reason, "remove it, or change the case to one that has it"));
            }
            Self::Eccentricity => match draft.form() {
                Form::Factors => "dimensionless.eccentricity_m".to_string(),
                Form::Load => "load.eccentricity_m".to_string(),
            },
            Self::EndDrop(body) => {
                let kind = draft.case.profile_spec(body).map(|spec| spec.kind);
                let Some(number) = kind.and_then(scaling_number) else {
                    let body = body.name();
                    let reason = match kind {
                        None => format!("the {body} has no profile"),
                        Some(kind) => {
                            format!("no number of the profile {} sets its end drop", kind.name())
                        }
                    };
                    let remedy = format!(
                        "give [{body}.profile] one of the kinds crown, relief, logarithmic and fujiwara"
                    );
                    return Err(self.refuse(reason, &remedy));
                };
                format!("{}.profile.{number}", body.name())
            }
        };
        Ok(Key::find(&path).expect("a key of the list"))
    }

    /// Refuses a level that is not legal.
    ///
    /// # Errors
    /// [`Error::Value`].
    pub(super) fn check(self, level: f64) -> Result<()> {
        let (low, high) = DROPS;
        match self {
            Self::Number(key) => key.check(level),
            Self::EndDrop(_) if !(low..=high).contains(&level) => {
                let [low, high] = [low, high].map(stated);
                let reason = format!("an end drop lies between {low} and {high} C^2 / (2 R)");
                Err(self.refuse(reason, "give it in these units; for no drop remove the profile"))
            }
            Self::Eccentricity if level.abs() >= 1.0 => {
                let reason = "an eccentricity is in lengths of the shorter body, less than 1";
                Err(self.refuse(reason.into(), "0.05 is a twentieth of the length off the middle"))
            }
            Self::EndDrop(_) | Self::Eccentricity => Ok(()),
        }
    }

    /// Whether the middle of its levels is their geometric mean, else it is the arithmetic one.
    /// Lengths, moduli, forces, W, S_l and end drops are compared by ratios; so is the tolerance.
    pub fn is_by_ratio(self) -> bool {
        match self {
            Self::Number(key) => {
                let scaled = ["_m", "_pa", "_n"].iter().any(|unit| key.leaf().ends_with(unit));
                let named = ["W", "S_l", "tolerance"].contains(&key.leaf());
                key.range.0 > 0.0 && (scaled || named)
            }
            Self::EndDrop(_) => true,
            Self::Eccentricity => false,
        }
    }

    /// The middle of some levels, see [`FactorKey::is_by_ratio`].
    pub fn middle(self, levels: &[f64]) -> f64 {
        let mean =
            |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / levels.len() as f64;
        match self.is_by_ratio() {
            true => mean(&mut levels.iter().map(|v| v.ln())).exp(),
            false => mean(&mut levels.iter().copied()),
        }
    }

    /// Whether it can be set only when the lengths and the load of the case are known.
    pub(super) fn is_relative(self) -> bool {
        !matches!(self, Self::Number(_))
    }

    /// Sets it in a draft that has a place for it; a relative one needs all others.
    pub(super) fn set(self, draft: &mut Draft, level: f64) {
        let mut sized = draft.case.clone();
        if let Some(factors) = draft.factors {
            sized.set_factors(factors);
        }
        match self {
            Self::Number(key) => key.set(draft, level),
            Self::Eccentricity => {
                draft.case.load.eccentricity_m = Some(level * sized.shorter_m());
            }
            Self::EndDrop(body) => {
                let drop_m = level * sized.gap_unit_m();
                let half_m = 0.5 * sized.length_m(body);
                let Some(spec) = draft.case.profile_mut(body) else { return };
                match spec.kind {
                    ProfileKind::Crown | ProfileKind::Relief => {
                        let arc_m = half_m - 0.5 * spec.straight_m.unwrap_or(0.0);
                        spec.radius_m = Some(ProfileSpec::arc_radius_m(arc_m, drop_m));
                    }
                    ProfileKind::Logarithmic => {
                        let drop = -(-spec.k.unwrap_or(f64::NAN)).ln_1p();
                        spec.amplitude_m = Some(drop_m / drop);
                    }
                    ProfileKind::Fujiwara => spec.zm_m = Some(drop_m),
                    _ => {}
                }
            }
        }
    }

    /// Its value in a case; `None` if the case does not have it.
    pub fn of(self, case: &Case) -> Option<f64> {
        match self {
            Self::Number(key) => {
                let form = if key.is_of(Form::Load) { Form::Load } else { Form::Factors };
                key.get(&Draft::of(case, form))
            }
            Self::EndDrop(body) => {
                let drop_m = case.profile(body)?.drop(0.5 * case.length_m(body));
                Some(drop_m / case.gap_unit_m()).filter(|drop| drop.is_finite())
            }
            Self::Eccentricity => Some(case.load.eccentricity_m? / case.shorter_m()),
        }
    }

    fn refuse(self, reason: String, remedy: &str) -> Error {
        let (key, value) = (self.path().to_string(), "a factor".to_string());
        Error::Value { key, value, reason, remedy: remedy.into() }
    }
}

/// The number of a profile that any drop at the end asks for a value of, the others fixed.
fn scaling_number(kind: ProfileKind) -> Option<&'static str> {
    match kind {
        ProfileKind::Crown | ProfileKind::Relief => Some("radius_m"),
        ProfileKind::Logarithmic => Some("amplitude_m"),
        ProfileKind::Fujiwara => Some("zm_m"),
        ProfileKind::Lundberg
        | ProfileKind::JohnsGohar
        | ProfileKind::Iso16281
        | ProfileKind::Table => None,
    }
}
