//! The design file: which parameters of a profile may vary between which bounds, and the loads that
//! the roller has to carry.

use super::document::{Document, Entry, Table, known_names, read_text};
use super::keys::Key;
use super::model::{Case, Load, Pose};
use super::objective::Objective;
use super::profile::{ProfileKind, ProfileSpec};
use super::study_file::listed_case;
use crate::base::number::significant;
use crate::base::{BodyKind, Error, Result};
use std::path::Path;

/// More loads are refused as mistakes.
const MOST_LOADS: usize = 100;

/// Bounds of this ratio and more are searched in equal ratios.
const LOGARITHMIC: f64 = 10.0;

/// Excluded distance (C) by default, and the largest one.
const EXCLUDED: f64 = 0.1;
const MOST_EXCLUDED: f64 = 2.0;

/// A number of a profile that varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name, for example `zm_m`.
    pub name: &'static str,
    /// The bounds, in its own unit.
    pub bounds: [f64; 2],
}

impl Parameter {
    /// Whether it is searched in equal ratios.
    pub fn is_logarithmic(&self) -> bool {
        let [low, high] = self.bounds;
        low > 0.0 && high / low >= LOGARITHMIC
    }

    /// The value at a `part` of the way between the bounds, both included.
    pub fn at(&self, part: f64) -> f64 {
        let [low, high] = self.bounds;
        let part = part.clamp(0.0, 1.0);
        let value = match self.is_logarithmic() {
            true => (low.ln() + part * (high / low).ln()).exp(),
            false => low + part * (high - low),
        };
        value.clamp(low, high)
    }
}

/// A load that the roller has to carry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DesignLoad {
    /// Force (N).
    pub force_n: f64,
    /// y of its line of action from the roller's middle (m), of a roller that is free to tilt.
    pub eccentricity_m: Option<f64>,
    /// The tilt that is held (rad).
    pub tilt_rad: Option<f64>,
}

/// A profile that is to be designed.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// The case, as its own file gives it.
    pub case: Case,
    /// The body that gets the profile.
    pub body: BodyKind,
    /// The profile, its varying numbers not set.
    profile: ProfileSpec,
    /// The numbers that vary, in the order of the kind.
    pub parameters: Vec<Parameter>,
    /// The loads, at least one.
    pub loads: Vec<DesignLoad>,
    /// What is made smallest.
    pub objective: Objective,
    /// Distance (C of each load) from the ends of the bodies' overlap within which nothing counts.
    pub exclude_c: f64,
}

impl Design {
    /// Reads a design file. Its case is relative to its folder, or a built-in one.
    ///
    /// # Errors
    /// [`Error::Io`] when a file cannot be read; [`Error::File`] with the line when it is not TOML,
    /// has an unknown or missing key, or a value that is not legal.
    pub fn read(path: &Path) -> Result<Self> {
        Self::parse(&read_text(path)?, path)
    }

    /// Parses the text of the design file at `path`.
    ///
    /// # Errors
    /// As [`Design::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Self> {
        let document = Document::parse(path, text)?;
        let root = document.root();
        root.only(&["case", "objective", "exclude_c", "profile", "bounds", "loads"])?;
        let entry = root.require("case", "case = \"my-case.toml\"")?;
        let case = listed_case(&entry, path.parent().unwrap_or(Path::new("")), "design")?;
        if case.sliding.friction != 0.0 {
            let remedy = "remove [sliding] from it: the profile does not depend on it";
            return Err(entry.refuse("a profile is designed without friction", remedy));
        }
        let (body, profile, parameters) = read_profile(&root)?;
        let loads = read_loads(&root)?;
        let design = Self {
            case,
            body,
            profile,
            parameters,
            loads,
            objective: read_objective(&root)?,
            exclude_c: read_excluded(&root)?,
        };
        // Each load with the middle of the bounds.
        let middle: Vec<f64> = design.parameters.iter().map(|p| p.at(0.5)).collect();
        let listed = root.table_entries("loads")?;
        for (i, entry) in listed.iter().enumerate() {
            let shaped = design.loaded(&middle, i);
            let case =
                entry.checked(shaped.map_err(|e| design.blamed_on_bounds(e, &middle, &root)))?;
            let [from, to] = case.overlap();
            if 0.5 * (to - from) <= design.exclude_c {
                let reason = format!(
                    "all of the contact lies within exclude_c = {} half-widths of its ends: nothing is \
                     left to make smaller",
                    design.exclude_c
                );
                return Err(entry.refuse(reason, "lower exclude_c or the load"));
            }
        }
        Ok(design)
    }

    /// The `error` of a load with the values in the `middle` of the bounds; at the bounds, if it is
    /// one of a profile, which no load mends.
    fn blamed_on_bounds(&self, error: Error, middle: &[f64], root: &Table) -> Error {
        let (key, value, reason, remedy) = match error {
            Error::Value { key, value, reason, remedy } if key.contains(".profile.") => {
                (key, value, reason, remedy)
            }
            other => return other,
        };
        let values = self.parameters.iter().zip(middle);
        let values = values.map(|(p, value)| format!("{} = {}", p.name, significant(*value, 4)));
        let values = values.collect::<Vec<_>>().join(", ");
        let message = format!(
            "in the middle of the bounds, {values}, {key} = {value} is not legal: {reason}"
        );
        match root.table("bounds") {
            Ok(bounds) => bounds.error(message, remedy),
            Err(error) => error,
        }
    }

    /// The case with the profile of these `values` of the parameters, under its own load.
    ///
    /// # Errors
    /// [`Error::Value`] if no body can have this profile.
    pub fn designed(&self, values: &[f64]) -> Result<Case> {
        let case = self.shaped(values);
        case.check().map(|()| case)
    }

    /// The same under a load.
    ///
    /// # Errors
    /// As [`Design::designed`], and for a load that is not legal.
    pub fn loaded(&self, values: &[f64], load: usize) -> Result<Case> {
        under(self.shaped(values), &self.loads[load])
    }

    /// The case with its own profile under a load.
    ///
    /// # Errors
    /// [`Error::Value`] for a load that is not legal.
    pub fn before(&self, load: usize) -> Result<Case> {
        under(self.case.clone(), &self.loads[load])
    }

    fn shaped(&self, values: &[f64]) -> Case {
        let mut profile = self.profile.clone();
        for (parameter, value) in self.parameters.iter().zip(values) {
            *profile.number_mut(parameter.name).expect("a number of profiles") = Some(*value);
        }
        let mut case = self.case.clone();
        *case.profile_mut(self.body) = Some(profile);
        case
    }
}

/// The case under another load.
fn under(case: Case, load: &DesignLoad) -> Result<Case> {
    let DesignLoad { force_n, eccentricity_m, tilt_rad } = *load;
    let mut case = case;
    case.load = Load { force_n, approach_m: None, eccentricity_m };
    case.pose = Pose { tilt_rad, ..case.pose };
    case.check().map(|()| case)
}

/// The body, the profile, and the parameters that vary.
fn read_profile(root: &Table) -> Result<(BodyKind, ProfileSpec, Vec<Parameter>)> {
    let table = root.table("profile")?;
    let entry = table.require("kind", "kind = \"fujiwara\"")?;
    let name = entry.string()?;
    let named = ProfileKind::ALL.into_iter().filter(|kind| !kind.keys().is_empty());
    let known: Vec<&str> = named.clone().map(ProfileKind::name).collect();
    let Some(kind) = named.clone().find(|kind| kind.name() == name) else {
        let remedy = known_names(name, &known, "there are");
        return Err(entry.refuse("there is no profile of this name with parameters", remedy));
    };
    let body = match table.get("body") {
        None => BodyKind::Roller,
        Some(entry) => {
            let name = entry.string()?;
            BodyKind::find(name).ok_or_else(|| {
                entry.refuse("there is no such body", "write \"roller\" or \"block\"")
            })?
        }
    };
    let keys = kind.keys();
    let fixed: Vec<&str> = ["kind", "body"].into_iter().chain(keys.iter().copied()).collect();
    table.only(&fixed)?;
    let bounds = root.table("bounds")?;
    bounds.only(keys)?;
    let mut spec = ProfileSpec::new(kind);
    let mut parameters = Vec::new();
    for &name in keys {
        let key = Key::find(&format!("roller.profile.{name}")).expect("a number of a profile");
        match (table.get(name), bounds.get(name)) {
            (Some(_), Some(entry)) => {
                let reason = "[profile] gives this number";
                return Err(entry.refuse(reason, "remove it from one of the two"));
            }
            (Some(entry), None) => {
                let value = entry.number()?;
                entry.placed(key.check(value))?;
                *spec.number_mut(name).expect("a number of profiles") = Some(value);
            }
            (None, Some(entry)) => {
                parameters.push(Parameter { name, bounds: read_bounds(key, &entry)? });
            }
            (None, None) => {
                let message = format!("{name} is neither in [profile] nor in [bounds]");
                let remedy = format!("add for example `{name} = {}` to [profile]", key.example);
                return Err(table.error(message, remedy));
            }
        }
    }
    if parameters.is_empty() {
        let remedy = format!("add a pair for one of {}", keys.join(", "));
        return Err(bounds.error("nothing varies", remedy));
    }
    Ok((body, spec, parameters))
}

/// Two legal values in ascending order.
fn read_bounds(key: &Key, entry: &Entry) -> Result<[f64; 2]> {
    let list = entry.list()?;
    let values: Vec<f64> = list.iter().map(Entry::number).collect::<Result<_>>()?;
    let [low, high] = values[..] else {
        return Err(entry.refuse("bounds are two numbers", "write [least, largest]"));
    };
    if low >= high {
        return Err(
            entry.refuse("the first bound is not the smaller one", "write [least, largest]")
        );
    }
    for value in [low, high] {
        entry.placed(key.check(value))?;
    }
    Ok([low, high])
}

fn read_objective(root: &Table) -> Result<Objective> {
    let Some(entry) = root.get("objective") else { return Ok(Objective::VonMises) };
    let name = entry.string()?;
    let known = Objective::ALL.map(Objective::name);
    Objective::ALL.into_iter().find(|o| o.name() == name).ok_or_else(|| {
        let remedy = known_names(name, &known, "there are");
        entry.refuse("there is no such objective", remedy)
    })
}

fn read_excluded(root: &Table) -> Result<f64> {
    let Some(entry) = root.get("exclude_c") else { return Ok(EXCLUDED) };
    let value = entry.number()?;
    if !(0.0..=MOST_EXCLUDED).contains(&value) {
        let reason =
            format!("the excluded distance lies between 0 and {MOST_EXCLUDED} half-widths");
        return Err(entry.refuse(reason, format!("{EXCLUDED} is usual")));
    }
    Ok(value)
}

fn read_loads(root: &Table) -> Result<Vec<DesignLoad>> {
    let entries = root.table_entries("loads")?;
    if entries.len() > MOST_LOADS {
        let message = format!("there are more than {MOST_LOADS} loads");
        return Err(root.error(message, "give fewer"));
    }
    let number = |table: &Table, name: &str, path: &str| -> Result<Option<f64>> {
        let Some(entry) = table.get(name) else { return Ok(None) };
        let value = entry.number()?;
        entry.placed(Key::find(path).expect("a key of the list").check(value))?;
        Ok(Some(value))
    };
    let load = |entry: &Entry| {
        let table = entry.as_table().ok_or_else(|| {
            entry.refuse("a load is a table", "write [[loads]] and below it force_n = 1000.0")
        })?;
        table.only(&["force_n", "eccentricity_m", "tilt_rad"])?;
        table.require("force_n", "force_n = 1000.0")?;
        Ok(DesignLoad {
            force_n: number(&table, "force_n", "load.force_n")?.expect("it is required"),
            eccentricity_m: number(&table, "eccentricity_m", "load.eccentricity_m")?,
            tilt_rad: number(&table, "tilt_rad", "pose.tilt_rad")?,
        })
    };
    entries.iter().map(load).collect()
}

impl<'d> Table<'d> {
    /// The entries of a required list of tables.
    fn table_entries(&self, key: &str) -> Result<Vec<Entry<'d>>> {
        match self.get(key) {
            Some(entry) if entry.is_list() => entry.list(),
            Some(entry) => {
                Err(entry.refuse("a list of tables belongs here", format!("write [[{key}]]")))
            }
            None => Err(self.error(format!("there are no [[{key}]]"), "add one or more")),
        }
    }
}

impl Entry<'_> {
    /// A result that depends on this value; an error names its key as it is, at this place.
    fn checked<T>(&self, checked: Result<T>) -> Result<T> {
        checked.map_err(|e| match e {
            Error::Value { key, value, reason, remedy } => {
                self.refuse(format!("with it, {key} = {value} is not legal: {reason}"), remedy)
            }
            other => other,
        })
    }
}
