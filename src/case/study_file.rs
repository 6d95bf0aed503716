//! The study file: a factorial design around one pair of bodies, and further cases.

use super::builtin::builtin_case;
use super::case_file::{entries, name, read_profiles};
use super::check::{MAX_NAME, check_name};
use super::document::{Document, Entry, Table, read_text};
use super::draft::{Draft, Form};
use super::keys::{KEYS, Key};
use super::model::{Case, Factors};
use crate::base::{Error, Result};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The text of the default study.
pub const DEFAULT_STUDY: &str = include_str!("../../cases/factorial.toml");

/// Larger designs are refused as mistakes.
const MAX_CASES: usize = 4096;

/// A study: every combination of the factors' levels, and further cases.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// The study's name.
    pub name: String,
    /// Levels of W, in the order of the file.
    pub load_levels: Vec<f64>,
    /// Levels of S_l, in the order of the file.
    pub slenderness_levels: Vec<f64>,
    /// Levels of L_r, in the order of the file.
    pub length_ratio_levels: Vec<f64>,
    /// All combinations of the levels; W varies slowest and L_r fastest.
    pub corners: Vec<Case>,
    /// The centre point, called `centre`, if the file has `centre = true`: geometric means of the
    /// levels of W and of S_l, arithmetic mean of those of L_r.
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
        root.only(&[
            "name", "centre", "cases", "roller", "block", "pose", "sliding", "fatigue", "factors",
            "accuracy",
        ])?;
        let base = read_base(&root, path)?;
        let study_name = name(&root)?;
        check_name(study_name).map_err(|e| root.place(e))?;
        let table = root.table("factors")?;
        table.only(&["W", "S_l", "L_r"])?;
        let mut study = Study {
            name: study_name.to_string(),
            load_levels: read_levels(&table, "W")?,
            slenderness_levels: read_levels(&table, "S_l")?,
            length_ratio_levels: read_levels(&table, "L_r")?,
            corners: Vec::new(),
            centre: None,
            extra: Vec::new(),
        };
        let sizes = [&study.load_levels, &study.slenderness_levels, &study.length_ratio_levels];
        if sizes.iter().map(|l| l.len()).product::<usize>() > MAX_CASES {
            let message = format!("the levels combine to more than {MAX_CASES} cases");
            return Err(table.error(message, "give fewer levels"));
        }
        let case = |name: String, factors| design_case(&base, name, factors, &table);
        for &load in &study.load_levels {
            for &slenderness in &study.slenderness_levels {
                for &length_ratio in &study.length_ratio_levels {
                    let name = format!("w{load:e}_sl{slenderness}_lr{length_ratio}");
                    study.corners.push(case(name, Factors { load, slenderness, length_ratio })?);
                }
            }
        }
        if root.get("centre").map_or(Ok(false), |entry| entry.flag())? {
            study.centre = Some(case("centre".into(), study.middle())?);
        }
        if let Some(files) = root.get("cases") {
            study.list(&files.list()?, path.parent().unwrap_or(Path::new("")))?;
        }
        Ok(study)
    }

    /// The middle of the design.
    fn middle(&self) -> Factors {
        let geometric_mean =
            |v: &[f64]| (v.iter().map(|v| v.ln()).sum::<f64>() / v.len() as f64).exp();
        let ratios = &self.length_ratio_levels;
        Factors {
            load: geometric_mean(&self.load_levels),
            slenderness: geometric_mean(&self.slenderness_levels),
            length_ratio: ratios.iter().sum::<f64>() / ratios.len() as f64,
        }
    }

    /// Adds the further cases of the file; paths are relative to `folder`.
    fn list(&mut self, files: &[Entry], folder: &Path) -> Result<()> {
        let mut names: BTreeSet<String> = self.cases().map(|c| c.name.clone()).collect();
        for entry in files {
            let case = listed_case(entry, folder)?;
            entry.placed(case.check_force("every model would find another force"))?;
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

/// The values that all cases of the design share.
fn read_base(root: &Table, path: &Path) -> Result<Draft> {
    let of_both = |key: &&Key| key.is_of(Form::Load) && key.is_of(Form::Factors);
    let keys: Vec<&'static Key> = KEYS.iter().filter(of_both).collect();
    let mut draft = Draft::new("base", Form::Factors);
    read_profiles(root, path, &mut draft)?;
    for (key, entry) in entries(root, &keys)? {
        key.set(&mut draft, read_number(key, &entry)?);
    }
    Ok(draft)
}

/// A legal value of `key`.
fn read_number(key: &Key, entry: &Entry) -> Result<f64> {
    let value = entry.number()?;
    entry.placed(key.check(value))?;
    Ok(value)
}

/// A case of the design, by the levels of the table `levels`.
fn design_case(base: &Draft, name: String, factors: Factors, levels: &Table) -> Result<Case> {
    if name.len() > MAX_NAME {
        let message = format!("the case {name} has a name of more than {MAX_NAME} letters");
        return Err(levels.error(message, "give levels with fewer digits"));
    }
    let mut draft = base.clone().named(name);
    draft.factors = Some(factors);
    draft.case().map_err(|e| match e {
        Error::Value { key, value, reason, remedy } => {
            let name = &draft.case.name;
            levels.error(
                format!("in the case {name}, {key} = {value} is not valid: {reason}"),
                remedy,
            )
        }
        other => other,
    })
}

/// The levels of one factor, all different.
fn read_levels(table: &Table, name: &str) -> Result<Vec<f64>> {
    let key = Key::find(&format!("dimensionless.{name}")).expect("a factor");
    let mut levels: Vec<f64> = Vec::new();
    for entry in table.require(name, &format!("{name} = [low, high]"))?.list()? {
        let level = read_number(key, &entry)?;
        if levels.contains(&level) {
            return Err(entry.refuse("this level is there already", "remove it"));
        }
        levels.push(level);
    }
    Ok(levels)
}

/// A case that the study lists by file or by built-in name.
pub(super) fn listed_case(entry: &Entry, folder: &Path) -> Result<Case> {
    let listed = entry.string()?;
    let path: PathBuf = folder.join(listed);
    if path.is_file() {
        let case = Case::read(&path)?;
        if case.surface.is_some() {
            let reason = "it has a [surface], and a study compares smooth contacts";
            return Err(entry.refuse(reason, "remove it, and solve it by `edgeline solve`"));
        }
        return Ok(case);
    }
    builtin_case(listed).unwrap_or_else(|| {
        let reason = format!("there is no file {}", path.display());
        Err(entry.refuse(reason, "paths are relative to the study file"))
    })
}
