//! The study file: a factorial design around one pair of bodies, and further cases.

use super::case_file::{
    MAX_NAME, length_ratio, load_factor, material, name, radius, slenderness, tolerance,
};
use super::document::{Document, Entry, Table, read_text};
use super::{Case, Factors, builtin_case};
use crate::base::{Material, Result};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The text of the study that runs when none is given.
pub const DEFAULT_STUDY: &str = include_str!("../../cases/factorial.toml");

/// More cases than this are a slip of the pen, not a study.
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
    /// The centre point, called `centre`, if it is asked for: geometric means of the levels of W
    /// and of S_l, arithmetic mean of those of L_r.
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

    /// Reads a study file. Case files that it lists are looked for beside it; a listed name
    /// without such a file is a built-in case.
    ///
    /// # Errors
    /// [`crate::base::Error::Io`] when a file cannot be read; [`crate::base::Error::File`] with the
    /// line when it is not
    /// TOML, has an unknown or missing key, or a value that is not legal.
    pub fn read(path: &Path) -> Result<Study> {
        Study::parse(&read_text(path)?, path)
    }

    /// Parses the text of a study file that stands at `path`.
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
        root.only(&["name", "centre", "cases", "roller", "block", "factors", "accuracy"])?;
        let base = Base::read(&root)?;
        let levels = root.table("factors")?;
        levels.only(&["W", "S_l", "L_r"])?;
        let mut study = Study {
            name: name(&root)?,
            load_levels: read_levels(&levels, "W", load_factor)?,
            slenderness_levels: read_levels(&levels, "S_l", slenderness)?,
            length_ratio_levels: read_levels(&levels, "L_r", length_ratio)?,
            corners: Vec::new(),
            centre: None,
            extra: Vec::new(),
        };
        let sizes = [&study.load_levels, &study.slenderness_levels, &study.length_ratio_levels];
        if sizes.iter().map(|l| l.len()).product::<usize>() > MAX_CASES {
            let message = format!("the levels combine to more than {MAX_CASES} cases");
            return Err(levels.error(message, "give fewer levels"));
        }
        for &load in &study.load_levels {
            for &slenderness in &study.slenderness_levels {
                for &length_ratio in &study.length_ratio_levels {
                    let name = format!("w{load:e}_sl{slenderness}_lr{length_ratio}");
                    let factors = Factors { load, slenderness, length_ratio };
                    study.corners.push(base.case(name, factors, &levels)?);
                }
            }
        }
        if root.get("centre").map_or(Ok(false), |entry| entry.flag())? {
            let factors = Factors {
                load: geometric_mean(&study.load_levels),
                slenderness: geometric_mean(&study.slenderness_levels),
                length_ratio: study.length_ratio_levels.iter().sum::<f64>()
                    / study.length_ratio_levels.len() as f64,
            };
            study.centre = Some(base.case("centre".into(), factors, &levels)?);
        }
        if let Some(files) = root.get("cases") {
            let mut names: BTreeSet<String> = study.cases().map(|c| c.name.clone()).collect();
            for entry in files.list()? {
                let case = listed_case(&entry, path.parent().unwrap_or(Path::new("")))?;
                if !names.insert(case.name.clone()) {
                    let reason = format!("the study has another case called {}", case.name);
                    return Err(entry.refuse(reason, "rename one of them"));
                }
                study.extra.push(case);
            }
        }
        Ok(study)
    }

    /// All cases: the corners, the centre point, the further cases.
    pub fn cases(&self) -> impl Iterator<Item = &Case> {
        self.corners.iter().chain(&self.centre).chain(&self.extra)
    }
}

/// What all cases of the design share.
struct Base {
    radius_m: f64,
    roller: Material,
    block: Material,
    tolerance: f64,
}

impl Base {
    fn read(root: &Table) -> Result<Base> {
        let roller = root.table("roller")?;
        roller.only(&["radius_m", "young_pa", "poisson"])?;
        let block = root.table("block")?;
        block.only(&["young_pa", "poisson"])?;
        Ok(Base {
            radius_m: radius(&roller)?,
            roller: material(&roller)?,
            block: material(&block)?,
            tolerance: tolerance(root)?,
        })
    }

    fn case(&self, name: String, factors: Factors, levels: &Table) -> Result<Case> {
        let case = Case::from_factors(name, self.radius_m, self.roller, self.block, factors);
        if case.name.len() > MAX_NAME {
            let message =
                format!("the case {} has a name of more than {MAX_NAME} letters", case.name);
            return Err(levels.error(message, "give levels with fewer digits"));
        }
        if let Some(reason) = case.out_of_range() {
            let message = format!("in the case {}, {reason}", case.name);
            return Err(
                levels.error(message, "check the radius (m), the moduli (Pa) and the levels")
            );
        }
        Ok(Case { tolerance: self.tolerance, ..case })
    }
}

/// The levels of one factor, all different.
fn read_levels(table: &Table, key: &str, read: impl Fn(&Entry) -> Result<f64>) -> Result<Vec<f64>> {
    let mut levels: Vec<f64> = Vec::new();
    for entry in table.require(key, &format!("{key} = [low, high]"))?.list()? {
        let level = read(&entry)?;
        if levels.contains(&level) {
            return Err(entry.refuse("this level is there already", "remove it"));
        }
        levels.push(level);
    }
    Ok(levels)
}

/// A case that the study lists by file or by built-in name.
fn listed_case(entry: &Entry, folder: &Path) -> Result<Case> {
    let listed = entry.string()?;
    let path: PathBuf = folder.join(listed);
    if path.is_file() {
        return Case::read(&path);
    }
    builtin_case(listed).unwrap_or_else(|| {
        let reason = format!("there is no file {}", path.display());
        Err(entry.refuse(reason, "paths are relative to the study file"))
    })
}

fn geometric_mean(values: &[f64]) -> f64 {
    (values.iter().map(|v| v.ln()).sum::<f64>() / values.len() as f64).exp()
}
