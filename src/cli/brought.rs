//! Curves from files beside the references of a study.

use super::study_options::StudyOptions;
use crate::base::{Error, Result};
use crate::case::{Case, Study, known_names};
use crate::study::StudyRun;
use crate::study::brought::{Beside, BroughtFile, FileRun, Statements};
use crate::study::verification::refined_tolerance;
use std::path::PathBuf;
use std::result::Result as Checked;

/// `CASE=FILE`: a case of the study and a file of its curves.
#[derive(Debug, Clone)]
pub(super) struct CurvesOf {
    case: String,
    path: PathBuf,
}

/// Parses `CASE=FILE`.
pub(super) fn curves_of(text: &str) -> Checked<CurvesOf, String> {
    match text.split_once('=') {
        Some((case, path)) if !case.is_empty() && !path.is_empty() => {
            Ok(CurvesOf { case: case.to_string(), path: path.into() })
        }
        _ => Err("give a case of the study, = and a file, as in centre=curves.csv".to_string()),
    }
}

/// A case with files of curves, and its solved models.
pub(super) struct Brought {
    case: Case,
    files: Vec<BroughtFile>,
    beside: Beside,
}

impl Brought {
    /// Reads all files and solves their cases, so that what cannot be used is said before the study
    /// runs.
    ///
    /// # Errors
    /// [`Error::Value`] for a case that the study has not, or two files of a case with one name; as
    /// [`BroughtFile::read`] and [`Beside::new`].
    pub(super) fn read(
        all: &[CurvesOf],
        study: &Study,
        options: &StudyOptions,
    ) -> Result<Vec<Self>> {
        let cases: Vec<&Case> = study.cases().collect();
        for CurvesOf { case: name, .. } in all {
            if !cases.iter().any(|case| case.name == *name) {
                return Err(unknown_case(name, &cases));
            }
        }
        let mut brought = Vec::new();
        for case in cases {
            let mut files: Vec<BroughtFile> = Vec::new();
            for CurvesOf { path, .. } in all.iter().filter(|own| own.case == case.name) {
                let file = BroughtFile::read(path, case, &Statements::default())?;
                file.check_foreign()?;
                file.check_name(&files)?;
                files.push(file);
            }
            if !files.is_empty() {
                case.check_force("every model would find another force")?;
                let beside = options.beside(case)?;
                let beside = match refined_tolerance(case) {
                    Some(tolerance) => beside.with_refined(tolerance)?,
                    None => beside,
                };
                brought.push(Self { case: case.clone(), files, beside });
            }
        }
        Ok(brought)
    }

    /// Compares the curves with the models and with the references of `run`.
    ///
    /// # Errors
    /// As [`Beside::file`].
    pub(super) fn compared(self, run: &StudyRun) -> Result<Vec<FileRun>> {
        let own = run.cases.iter().filter(|c| c.case.name == self.case.name);
        let references = own.flat_map(|c| &c.references);
        let references: Vec<_> =
            references.filter_map(|r| Some((r.engine.clone(), r.result.as_ref().ok()?))).collect();
        self.files.into_iter().map(|file| self.beside.file(file, &references)).collect()
    }
}

fn unknown_case(name: &str, cases: &[&Case]) -> Error {
    let names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    Error::Value {
        key: "--curves".to_string(),
        value: name.to_string(),
        reason: "the study has no case of this name".to_string(),
        remedy: known_names(name, &names, "its cases are"),
    }
}
