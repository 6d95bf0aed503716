//! The study file: a factorial design around one pair of bodies, and further cases, or these alone.

use super::builtin::{BUILTIN_STUDIES, builtin_case, is_given, no_case, nothing_at};
use super::case_file::{entries, keys_of, name, only_tables, read_flags, read_profiles};
use super::check::{MAX_NAME, check_name};
use super::document::{Document, Entry, Table, did_you_mean, read_text};
use super::draft::{Draft, Form};
use super::factor::FactorKey;
use super::keys::Key;
use super::model::Case;
use super::two_level::TwoLevel;
use crate::base::{Error, Result};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The text of the default study.
pub const DEFAULT_STUDY: &str = BUILTIN_STUDIES[0].1;

/// Larger designs are refused as mistakes.
const MAX_CASES: usize = 4096;

/// Why a study needs forces.
const OTHER_FORCES: &str = "every model would find another force";

/// A factor of a study with its levels.
#[derive(Debug, Clone, PartialEq)]
pub struct Varied {
    /// The factor.
    pub key: FactorKey,
    /// Its levels, all different, in the order of the file.
    pub levels: Vec<f64>,
}

impl Varied {
    /// The low and the high level of a factor that has two.
    pub fn pair(&self) -> Option<[f64; 2]> {
        let [a, b] = self.levels[..] else { return None };
        Some([a.min(b), a.max(b)])
    }
}

/// A study: combinations of the factors' levels, and further cases.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// The study's name.
    pub name: String,
    /// The factors, in the order of the file; none where the file only lists cases.
    pub factors: Vec<Varied>,
    /// The cases of the design: all combinations of the levels, or of those of the basic factors.
    /// The first factor varies slowest. Empty without factors.
    pub corners: Vec<Case>,
    /// The two-level design of the factors that have two levels; `None` if there is none of them or
    /// a factor has more.
    pub design: Option<TwoLevel>,
    /// The centre point, called `centre`, if the file has `centre = true`: at [`FactorKey::middle`]
    /// of each factor's levels.
    pub centre: Option<Case>,
    /// Further cases that are not part of the design.
    pub extra: Vec<Case>,
}

impl Study {
    /// The study that is built into the program, `cases/factorial.toml`.
    pub fn built_in() -> Study {
        Study::parse(DEFAULT_STUDY, Path::new("factorial.toml"))
            .expect("a test reads the built-in study")
    }

    /// All studies that are built into the program.
    pub fn all_built_in() -> impl Iterator<Item = Study> {
        BUILTIN_STUDIES.into_iter().map(|(name, text)| {
            Study::parse(text, Path::new(name)).expect("a test reads the built-in studies")
        })
    }

    /// Reads the study file at `path`, or takes the built-in study of that name if there is no such
    /// file.
    ///
    /// # Errors
    /// As [`Study::read`]; the error about a missing file names the built-in studies.
    pub fn find(path: &Path) -> Result<Study> {
        if is_given(path) {
            return Study::read(path);
        }
        let name = path.to_str().unwrap_or_default();
        Study::all_built_in().find(|study| study.name == name).ok_or_else(|| {
            let names = BUILTIN_STUDIES.map(|(name, _)| name);
            let is_case = named_case(name).is_some();
            let meant = match is_case {
                true => format!("run `edgeline solve {name}`, or "),
                false => did_you_mean(name, &names),
            };
            Error::File {
                path: path.to_path_buf(),
                line: None,
                message: if is_case { "is a case, not a study" } else { nothing_at(path) }.into(),
                remedy: format!(
                    "{meant}give a study file, or a built-in study: {}",
                    names.join(", ")
                ),
            }
        })
    }

    /// Reads a study file. Its case files are relative to its folder; a name without such a file is
    /// that of a built-in case.
    ///
    /// # Errors
    /// [`crate::base::Error::Io`] when a file cannot be read; [`crate::base::Error::File`] with the
    /// line when it is not TOML, has an unknown or missing key, or a value that is not legal.
    pub fn read(path: &Path) -> Result<Study> {
        Study::parse(&read_text(path)?, path)
    }

    /// Parses the text of the study file at `path`.
    ///
    /// # Errors
    /// As [`Study::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Study> {
        let document = Document::parse(path, text)?;
        let root = document.root();
        if root.get("factors").is_none()
            && (root.get("dimensionless").is_some() || root.get("load").is_some())
        {
            return Err(
                root.error("is a case file, not a study file", "run `edgeline solve` on it")
            );
        }
        let study_name = name(&root)?;
        check_name(study_name).map_err(|e| root.place(e))?;
        let mut study = match (root.get("factors"), root.get("cases")) {
            (None, Some(_)) => {
                root.only(&["cases", "name"])?;
                Study::without_design(study_name)
            }
            _ => Study::designed(study_name, &root, path)?,
        };
        if let Some(files) = root.get("cases") {
            study.list(&files.list()?, path.parent().unwrap_or(Path::new("")))?;
        }
        Ok(study)
    }

    /// A study without cases yet.
    fn without_design(name: &str) -> Study {
        let (factors, corners, extra) = Default::default();
        Study { name: name.to_string(), factors, corners, design: None, centre: None, extra }
    }

    /// The study with the design that the factors of the file at `path` make, without further
    /// cases.
    fn designed(name: &str, root: &Table, path: &Path) -> Result<Study> {
        only_tables(root, &["name", "centre", "cases", "factors", "generators"])?;
        if let Some(surface) = root.get("surface") {
            let remedy = "remove it, and solve rough cases by `edgeline solve`";
            return Err(surface.refuse("a study is one of smooth contacts", remedy));
        }
        let table = root.table("factors")?;
        let factors = read_factors(&table)?;
        let base = read_base(root, path, &table, &factors)?;
        let factors: Vec<Varied> = factors
            .into_iter()
            .map(|(key, entry)| Ok(Varied { key, levels: read_levels(key, &entry)? }))
            .collect::<Result<_>>()?;
        let design = read_design(root, &factors)?;
        let case =
            |name: String, levels: &[f64]| design_case(&base, name, &factors, levels, &table);
        let settings = settings(&factors, design.as_ref(), &table)?;
        let named = case_names(&factors, &settings).into_iter().zip(&settings);
        let corners = named.map(|(name, levels)| case(name, levels)).collect::<Result<_>>()?;
        let centre = match root.get("centre").map_or(Ok(false), |entry| entry.flag())? {
            true => {
                let middle: Vec<f64> = factors.iter().map(|f| f.key.middle(&f.levels)).collect();
                Some(case("centre".into(), &middle)?)
            }
            false => None,
        };
        Ok(Study { factors, corners, design, centre, ..Study::without_design(name) })
    }

    /// The factors of the design, those with two levels, with the low and the high one.
    pub fn pairs(&self) -> Vec<(FactorKey, [f64; 2])> {
        let pairs = self.factors.iter().filter_map(|f| Some((f.key, f.pair()?)));
        pairs.filter(|_| self.design.is_some()).collect()
    }

    /// The factors beside W, S_l and L_r.
    pub fn further(&self) -> Vec<FactorKey> {
        self.factors.iter().map(|f| f.key).filter(|key| !FIRST.contains(&key.name())).collect()
    }

    /// Adds the further cases of the file; paths are relative to `folder`.
    fn list(&mut self, files: &[Entry], folder: &Path) -> Result<()> {
        let mut names: BTreeSet<String> = self.cases().map(|c| c.name.clone()).collect();
        for entry in files {
            let case = listed_case(entry, folder, "study")?;
            entry.placed(case.check_force(OTHER_FORCES))?;
            if !names.insert(case.name.clone()) {
                let reason = format!("the study has another case called {}", case.name);
                return Err(entry.refuse(reason, "rename one of them"));
            }
            self.extra.push(case);
        }
        Ok(())
    }

    /// All cases: the corners, the centre point, the further cases.
    pub fn cases(&self) -> impl Iterator<Item = &Case> {
        self.corners.iter().chain(&self.centre).chain(&self.extra)
    }
}

/// As [`Case::find`], and takes the cases of the built-in studies, too: `w1e-3_sl5_lr1`, or
/// `profiled/centre` where several studies have a case of that name, of which the name alone is the
/// first.
///
/// # Errors
/// As [`Case::find`].
pub fn find_case(path: &Path) -> Result<Case> {
    or_of_study(path, Case::find(path), |case| case)
}

/// [`find_case`] in the form of its file; a case of a study has W, S_l and L_r.
///
/// # Errors
/// As [`Case::find`].
pub fn find_draft(path: &Path) -> Result<Draft> {
    or_of_study(path, Draft::find(path), |case| Draft::of(&case, Form::Factors))
}

/// What is `found` at `path`, or what becomes of the case of a study that has this name.
fn or_of_study<T>(path: &Path, found: Result<T>, of: impl FnOnce(Case) -> T) -> Result<T> {
    found.or_else(|error| match path.to_str().and_then(case_of_study) {
        Some(case) if !is_given(path) => Ok(of(case)),
        _ => Err(error),
    })
}

/// The built-in case called `name`, also one of a study.
fn named_case(name: &str) -> Option<Result<Case>> {
    // In this order: built-in studies list built-in cases, and are read to find theirs.
    builtin_case(name).or_else(|| case_of_study(name).map(Ok))
}

/// The case called `name` of a built-in study, see [`find_case`].
fn case_of_study(name: &str) -> Option<Case> {
    let (of, name) = match name.split_once('/') {
        Some((study, name)) => (Some(study), name),
        None => (None, name),
    };
    let mut studies = Study::all_built_in().filter(|study| of.is_none_or(|of| study.name == of));
    studies.find_map(|study| study.cases().find(|case| case.name == name).cloned())
}

/// A factor, and the entry with its levels.
type Factor<'d> = (FactorKey, Entry<'d>);

/// The factors in the order of the file.
fn read_factors<'d>(table: &Table<'d>) -> Result<Vec<Factor<'d>>> {
    let mut factors = Vec::new();
    collect_factors(table, "", &mut factors)?;
    factors.sort_by_key(|(_, entry)| entry.place());
    for (i, (key, entry)) in factors.iter().enumerate() {
        if factors[..i].iter().any(|(known, _)| known == key) {
            return Err(entry.refuse("this factor is there already", "remove it"));
        }
    }
    match factors.is_empty() {
        true => Err(table.error("there is no factor", "add for example W = [1e-4, 1e-3]")),
        false => Ok(factors),
    }
}

/// Adds the factors of a table and of those below it. `path` is that of the table among the
/// factors.
fn collect_factors<'d>(table: &Table<'d>, path: &str, into: &mut Vec<Factor<'d>>) -> Result<()> {
    for (key, entry) in table.all() {
        let own = if path.is_empty() { key.to_string() } else { format!("{path}.{key}") };
        if let Some(below) = entry.as_table() {
            collect_factors(&below, &own, into)?;
        } else if let Some(factor) = FactorKey::find(&own) {
            into.push((factor, entry));
        } else {
            let names: Vec<&str> = FactorKey::all().map(FactorKey::name).collect();
            let remedy = format!(
                "{}[factors] takes W, S_l, L_r, roller.end_drop, block.end_drop, \
                 eccentricity, and the numbers of a case by their paths, such as sliding.friction",
                did_you_mean(&own, &names)
            );
            return Err(table.unknown(key, remedy));
        }
    }
    Ok(())
}

/// The values that all cases of the design share.
fn read_base(root: &Table, path: &Path, table: &Table, factors: &[Factor]) -> Result<Draft> {
    let form = form(root, factors)?;
    let mut draft = Draft::new("base", form);
    read_profiles(root, path, &mut draft)?;
    read_flags(root, &mut draft)?;
    let mut varied: Vec<&'static Key> = Vec::new();
    for (factor, entry) in factors {
        let key = entry.placed(factor.key(&draft))?;
        if key.path == "load.approach_m" {
            return Err(entry.refuse(OTHER_FORCES, "vary load.force_n instead"));
        }
        if key.table() == "fatigue" {
            let remedy = "remove it: `edgeline fatigue` takes a case for each level";
            return Err(entry.refuse("a study tells nothing of fatigue", remedy));
        }
        if let Some(given) = root.find(key.path) {
            let reason = format!("the factor {} sets it", factor.name());
            return Err(given.refuse(reason, "remove it, or the factor"));
        }
        if varied.contains(&key) {
            let reason = format!("another factor sets {} too", key.path);
            return Err(entry.refuse(reason, "remove one of the two"));
        }
        varied.push(key);
    }
    if let Some(approach) = root.find("load.approach_m") {
        return Err(approach.refuse(OTHER_FORCES, "give force_n instead"));
    }
    for name in FIRST.into_iter().filter(|_| form == Form::Factors) {
        let path = format!("dimensionless.{name}");
        if root.get("dimensionless").is_none() && !varied.iter().any(|key| key.path == path) {
            table.require(name, &format!("{name} = [low, high]"))?;
        }
    }
    let force = |key: &&Key| key.path == "load.force_n";
    if form == Form::Load && !varied.iter().any(force) {
        root.table("load")?;
    }
    let keys: Vec<&'static Key> = keys_of(form)
        .into_iter()
        .filter(|key| !varied.contains(key) && key.path != "load.approach_m")
        .collect();
    for (key, entry) in entries(root, &keys)? {
        key.set(&mut draft, read_number(key, &entry)?);
    }
    Ok(draft)
}

/// How the load is given: by the tables of the file, or by the factors.
fn form(root: &Table, factors: &[Factor]) -> Result<Form> {
    let only = |form: Form, other: Form| {
        factors.iter().find(move |(factor, _)| match factor {
            FactorKey::Number(key) => key.is_of(form) && !key.is_of(other),
            _ => false,
        })
    };
    let by_load = only(Form::Load, Form::Factors);
    let by_factors = only(Form::Factors, Form::Load);
    let loaded = root.get("load").is_some() || by_load.is_some();
    let dimensionless = root.get("dimensionless").is_some() || by_factors.is_some();
    match (loaded, dimensionless) {
        (true, false) => Ok(Form::Load),
        (true, true) => {
            let reason =
                "the load and the lengths are given twice, by W, S_l and L_r and in SI units";
            let remedy = "keep one of the two";
            Err(match by_load.or(by_factors) {
                Some((_, entry)) => entry.refuse(reason, remedy),
                None => root.error(reason, remedy),
            })
        }
        (false, _) => Ok(Form::Factors),
    }
}

/// A legal value of `key`.
fn read_number(key: &Key, entry: &Entry) -> Result<f64> {
    let value = entry.number()?;
    entry.placed(key.check(value))?;
    Ok(value)
}

/// The levels of one factor, all different.
fn read_levels(key: FactorKey, entry: &Entry) -> Result<Vec<f64>> {
    let mut levels: Vec<f64> = Vec::new();
    for entry in entry.list()? {
        let level = entry.number()?;
        entry.placed(key.check(level))?;
        if levels.contains(&level) {
            return Err(entry.refuse("this level is there already", "remove it"));
        }
        levels.push(level);
    }
    Ok(levels)
}

/// The design of the factors with two levels, by the file's generators if it has any.
fn read_design(root: &Table, factors: &[Varied]) -> Result<Option<TwoLevel>> {
    let count = factors.iter().filter(|f| f.levels.len() == 2).count();
    let Some(entry) = root.get("generators") else {
        let more = factors.iter().any(|f| f.levels.len() > 2);
        return Ok(if more || count == 0 { None } else { TwoLevel::full(count).ok() });
    };
    if let Some(other) = factors.iter().find(|f| f.levels.len() != 2) {
        let (name, own) = (other.key.name(), other.levels.len());
        let reason =
            format!("a fractional design has two levels of each factor, and {name} has {own}");
        return Err(entry.refuse(reason, "give two levels, or remove the generators"));
    }
    let entries = entry.list()?;
    let texts = entries.iter().map(Entry::string).collect::<Result<Vec<_>>>()?;
    entry.placed(TwoLevel::fractional(count, &texts)).map(Some)
}

/// The levels of all factors in each case of the design; the first factor varies slowest.
fn settings(factors: &[Varied], design: Option<&TwoLevel>, table: &Table) -> Result<Vec<Vec<f64>>> {
    let basic = design.filter(|d| d.is_fractional()).map_or(factors.len(), TwoLevel::basic);
    if factors[..basic].iter().map(|f| f.levels.len()).product::<usize>() > MAX_CASES {
        let message = format!("the levels combine to more than {MAX_CASES} cases");
        return Err(table.error(message, "give fewer levels, or generators"));
    }
    let mut all: Vec<Vec<f64>> = vec![Vec::new()];
    for factor in &factors[..basic] {
        let with = |levels: &Vec<f64>, level: f64| [&levels[..], &[level]].concat();
        let more = all.iter().flat_map(|own| factor.levels.iter().map(move |&l| with(own, l)));
        all = more.collect();
    }
    let Some(design) = design.filter(|d| d.is_fractional()) else { return Ok(all) };
    let pairs: Vec<[f64; 2]> = factors.iter().filter_map(Varied::pair).collect();
    for levels in &mut all {
        let coded: Vec<i8> = levels
            .iter()
            .zip(&pairs)
            .map(|(l, [_, high])| if l == high { 1 } else { -1 })
            .collect();
        let others = design.generated(&coded).into_iter().zip(&pairs[basic..]);
        levels.extend(others.map(|(code, pair)| pair[usize::from(code > 0)]));
    }
    Ok(all)
}

/// The factors that stand first in the names of cases.
const FIRST: [&str; 3] = ["W", "S_l", "L_r"];

/// The names of the cases of the design: their levels. Where further factors make one of them too
/// long, the cases are numbered.
fn case_names(factors: &[Varied], settings: &[Vec<f64>]) -> Vec<String> {
    let names: Vec<String> = settings.iter().map(|levels| case_name(factors, levels)).collect();
    let further = factors.iter().any(|f| !FIRST.contains(&f.key.name()));
    match further && names.iter().any(|name| name.len() > MAX_NAME) {
        true => (1..=names.len()).map(|run| format!("run-{run}")).collect(),
        false => names,
    }
}

/// The name of a case of the design by its levels.
fn case_name(factors: &[Varied], levels: &[f64]) -> String {
    let of = |(factor, level): (&Varied, &f64)| {
        let (plain, short) = (format!("{level}"), format!("{level:e}"));
        let first = FIRST.iter().position(|name| *name == factor.key.name());
        let text = match first {
            Some(0) => short,
            Some(_) => plain,
            None if short.len() < plain.len() => short,
            None => plain,
        };
        (first.unwrap_or(usize::MAX), factor.key.token() + &text)
    };
    let mut parts: Vec<(usize, String)> = factors.iter().zip(levels).map(of).collect();
    parts.sort_by_key(|(first, _)| *first);
    parts.into_iter().map(|(_, part)| part).collect::<Vec<_>>().join("_")
}

/// A case of the design, by the `levels` of the `factors`, which the table holds.
fn design_case(
    base: &Draft,
    name: String,
    factors: &[Varied],
    levels: &[f64],
    table: &Table,
) -> Result<Case> {
    if name.len() > MAX_NAME {
        let message = format!("the case {name} has a name of more than {MAX_NAME} letters");
        return Err(table.error(message, "give levels with fewer digits"));
    }
    let mut draft = base.clone().named(name);
    for relative in [false, true] {
        let own = factors.iter().zip(levels).filter(|(f, _)| f.key.is_relative() == relative);
        own.for_each(|(factor, level)| factor.key.set(&mut draft, *level));
    }
    let refuse = |key: &str, value: &str, reason: &str, remedy: String| {
        let name = &draft.case.name;
        table.error(format!("in the case {name}, {key} = {value} is not valid: {reason}"), remedy)
    };
    let case = draft.case().map_err(|e| match e {
        Error::Value { key, value, reason, remedy } => refuse(&key, &value, &reason, remedy),
        other => other,
    })?;
    for (factor, level) in factors.iter().zip(levels).filter(|(f, _)| f.key.is_relative()) {
        let found = factor.key.of(&case).unwrap_or(f64::NAN);
        if found.is_nan() || (found - level).abs() > 1e-6 * level.abs() {
            let reason = "no profile of this kind drops that far";
            let remedy = "give a smaller end drop".to_string();
            return Err(refuse(factor.key.name(), &level.to_string(), reason, remedy));
        }
    }
    Ok(case)
}

/// A case that a file lists by its own file or by a name that [`find_case`] takes; the file is that
/// of `what`, a study for example.
pub(super) fn listed_case(entry: &Entry, folder: &Path, what: &str) -> Result<Case> {
    let listed = entry.string()?;
    let path: PathBuf = folder.join(listed);
    if path.is_file() {
        let case = Case::read(&path)?;
        if case.surface.is_some() {
            let reason = format!("it has a [surface], and a {what} is one of smooth contacts");
            return Err(entry.refuse(reason, "remove it, and solve it by `edgeline solve`"));
        }
        return Ok(case);
    }
    named_case(listed).unwrap_or_else(|| {
        let nothing = format!("there is no file {}", path.display());
        let file = format!("a case file by its path from the file of the {what}");
        let (reason, remedy) = no_case(listed, nothing, &file);
        Err(entry.refuse(reason, remedy))
    })
}
