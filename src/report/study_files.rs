//! The files of a study's run: tables and `summary.json`. Plots, page and Markdown are made from
//! these files alone, so that all they show can be looked up there.

use super::brought::{Of, of_curves, of_errors, of_pressure};
use super::study_rows::{CurveRow, EffectRow, OwnErrorRow, PressureRow, StudyRow};
use super::study_summary::StudySummary;
use super::summarise::{Context, study_summary};
use super::table::{self, Layout, Row, Short, from_csv, to_csv};
use super::tables;
use crate::base::{Error, Result};
use crate::study::effects;
use crate::study::verification::VerificationRow;
use crate::study::{ErrorRow, Source, StudyRun};
use serde::Serialize;
use serde_json::Value;
use std::path::Path;

/// A finished run, as its files hold it.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyFiles {
    /// `summary.json`.
    pub summary: StudySummary,
    /// `study.csv`: one row for each case and source.
    pub study: Vec<StudyRow>,
    /// `curves.csv`: stresses of every source on the standard curves.
    pub curves: Vec<CurveRow>,
    /// `pressure.csv`: contact pressure of every source on the two lines.
    pub pressure: Vec<PressureRow>,
    /// `fem_error.csv`: the references' own errors at the points where they state one.
    pub fem_error: Vec<OwnErrorRow>,
    /// `errors.csv`: one row for each case, method, body, curve and quantity.
    pub errors: Vec<ErrorRow>,
    /// `effects.csv`: one row for each method, response and effect.
    pub effects: Vec<EffectRow>,
    /// `verification.csv`: differences beside the numerical uncertainty of both sides.
    pub verification: Vec<VerificationRow>,
    /// `brought.csv`: the errors of all sources against curves from files. It and the next two are
    /// written where there are such curves.
    pub brought: Vec<Of<ErrorRow>>,
    /// `brought_curves.csv`: stresses of these curves and of all sources on their points.
    pub brought_curves: Vec<Of<CurveRow>>,
    /// `brought_pressure.csv`: the same of the contact pressure.
    pub brought_pressure: Vec<Of<PressureRow>>,
}

/// The tables that every run has.
const TABLES: [&str; 7] = [
    "study.csv",
    "curves.csv",
    "pressure.csv",
    "fem_error.csv",
    "errors.csv",
    "effects.csv",
    "verification.csv",
];

/// The tables of curves from files.
const BROUGHT: [&str; 3] = ["brought.csv", "brought_curves.csv", "brought_pressure.csv"];

const SUMMARY: &str = "summary.json";

impl StudyFiles {
    /// The files of a run. Numbers have the digits that the files hold, as if they had been read.
    pub fn of(run: &StudyRun, context: &Context) -> Self {
        let (effects, not_analysed) = effects::analyse(run);
        let summary = study_summary(run, context, &effects, &not_analysed);
        let layout = summary.layout();
        Self {
            study: as_written(&tables::study(run), layout),
            curves: as_written(&tables::curves(run), layout),
            pressure: as_written(&tables::pressure(run), layout),
            fem_error: as_written(&tables::own_errors(run), layout),
            errors: as_written(&tables::errors(run), layout),
            effects: as_written(&tables::effects(run, &effects), layout),
            verification: as_written(context.verification, layout),
            brought: as_written(&of_errors(context.brought), layout),
            brought_curves: as_written(&of_curves(context.brought), layout),
            brought_pressure: as_written(&of_pressure(context.brought), layout),
            summary,
        }
    }

    /// The names of all files that a run may have.
    pub fn names() -> impl Iterator<Item = &'static str> {
        TABLES.into_iter().chain(BROUGHT).chain([SUMMARY])
    }

    /// The run's own files by name: the tables, and `summary.json` last.
    pub fn contents(&self) -> Vec<(String, Vec<u8>)> {
        let layout = self.summary.layout();
        let brought = BROUGHT.into_iter().zip([
            to_csv(&self.brought, layout),
            to_csv(&self.brought_curves, layout),
            to_csv(&self.brought_pressure, layout),
        ]);
        let brought = brought.filter(|_| self.summary.has_brought());
        let tables = TABLES.into_iter().zip([
            to_csv(&self.study, layout),
            to_csv(&self.curves, layout),
            to_csv(&self.pressure, layout),
            to_csv(&self.fem_error, layout),
            to_csv(&self.errors, layout),
            to_csv(&self.effects, layout),
            to_csv(&self.verification, layout),
        ]);
        let all = tables.chain(brought).chain([(SUMMARY, pretty(&self.summary))]);
        all.map(|(name, text)| (name.to_string(), text.into_bytes())).collect()
    }

    /// Reads a finished run.
    ///
    /// # Errors
    /// [`Error::Io`] or [`Error::File`] when a file is missing or is not what
    /// [`super::page::write_run`] writes.
    pub fn read(folder: &Path) -> Result<Self> {
        let path = folder.join(SUMMARY);
        let refuse = |path: &Path, line: Option<usize>, message: String| Error::File {
            path: path.to_path_buf(),
            line,
            message,
            remedy: "give the folder that `edgeline study --out` wrote".to_string(),
        };
        if !path.is_file() {
            let there = if folder.is_dir() { "has no summary.json" } else { "is no folder" };
            return Err(refuse(folder, None, there.into()));
        }
        let text = table::read(&path)?;
        let of_study = |value: &Value| value.get("study").is_some();
        if serde_json::from_str(&text).is_ok_and(|value: Value| !of_study(&value)) {
            let message = "is the summary of another command, not of a study";
            return Err(refuse(&path, None, message.into()));
        }
        let summary: StudySummary = serde_json::from_str(&text).map_err(|e| {
            refuse(&path, Some(e.line()), format!("is not the summary of a study: {e}"))
        })?;
        let layout = summary.layout();
        Ok(Self {
            study: read(folder, "study.csv", layout)?,
            curves: read(folder, "curves.csv", layout)?,
            pressure: read(folder, "pressure.csv", layout)?,
            fem_error: read(folder, "fem_error.csv", layout)?,
            errors: read(folder, "errors.csv", layout)?,
            effects: read(folder, "effects.csv", layout)?,
            verification: read(folder, "verification.csv", layout)?,
            brought: read_brought(folder, "brought.csv", &summary)?,
            brought_curves: read_brought(folder, "brought_curves.csv", &summary)?,
            brought_pressure: read_brought(folder, "brought_pressure.csv", &summary)?,
            summary,
        })
    }

    /// The models and references, each once, in the order of `study.csv`.
    pub fn sources(&self) -> Vec<&Source> {
        let mut all: Vec<&Source> = Vec::new();
        for row in &self.study {
            if !all.contains(&&row.source) {
                all.push(&row.source);
            }
        }
        all
    }

    /// The value of the factor called `name` in a row of `study.csv`.
    pub fn factor(&self, row: &StudyRow, name: &str) -> Option<f64> {
        match name {
            "W" => Some(row.load),
            "S_l" => Some(row.slenderness),
            "L_r" => Some(row.length_ratio),
            _ => {
                let place = self.summary.further_factors.iter().position(|own| own == name)?;
                row.factors.get(place).copied().flatten().map(|Short(value)| value)
            }
        }
    }

    /// The row of `study.csv` of a case and source.
    pub fn row(&self, case: &str, source: &Source) -> Option<&StudyRow> {
        self.study.iter().find(|row| row.case == case && row.source == *source)
    }
}

/// Reads a table of a run.
fn read<R: Row>(folder: &Path, name: &str, layout: Layout) -> Result<Vec<R>> {
    let path = folder.join(name);
    from_csv(&table::read(&path)?, &path, layout)
}

/// Reads a table of curves from files; none where no such curves take part.
fn read_brought<R: Row>(folder: &Path, name: &str, summary: &StudySummary) -> Result<Vec<R>> {
    if summary.has_brought() { read(folder, name, summary.layout()) } else { Ok(Vec::new()) }
}

/// The rows with the digits that a file holds.
fn as_written<R: Row>(rows: &[R], layout: Layout) -> Vec<R> {
    let text = to_csv(rows, layout);
    from_csv(&text, Path::new("a table"), layout).expect("a table is read as it is written")
}

/// JSON with indents and a newline at its end.
pub fn pretty(value: &impl Serialize) -> String {
    let mut text =
        serde_json::to_string_pretty(value).expect("names and numbers are always written");
    text.push('\n');
    text
}
