//! Writes plots, page and Markdown of a run.

use super::render::{html, markdown};
use crate::base::Result;
use crate::host::replace_set;
use crate::report::plots;
use crate::report::study_files::StudyFiles;
use std::path::Path;

/// The names of Markdown and page.
pub const NAMES: [&str; 2] = ["report.md", "report.html"];

/// Writes all files of a run into `folder`: tables, plots and page, and `summary.json` last. Its
/// presence means that the run is complete.
///
/// # Errors
/// As [`write()`].
pub fn write_run(files: &StudyFiles, folder: &Path) -> Result<()> {
    let made = made(files)?.into_iter();
    replace_set(folder, &made.chain(files.contents()).collect::<Vec<_>>())
}

/// Writes `report.html`, `report.md` and `plots/*.svg` into `folder`.
///
/// # Errors
/// [`crate::base::Error::Io`] when a file cannot be written, [`crate::base::Error::File`] when the
/// run's files lack data of the page.
pub fn write(files: &StudyFiles, folder: &Path) -> Result<()> {
    replace_set(folder, &made(files)?)
}

/// Plots, Markdown and page, by the names of their files.
fn made(files: &StudyFiles) -> Result<Vec<(String, Vec<u8>)>> {
    let plots = plots::all(files).into_iter();
    let mut made: Vec<(String, Vec<u8>)> =
        plots.map(|(name, svg)| (format!("plots/{name}"), svg.into_bytes())).collect();
    let [md, page] = NAMES.map(String::from);
    made.push((md, markdown(files)?.into_bytes()));
    made.push((page, html(files)?.into_bytes()));
    Ok(made)
}
