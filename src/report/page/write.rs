//! Writes plots, page and Markdown of a run.

use super::render::{html, markdown};
use crate::base::Result;
use crate::host::{prepare_folder, replace_set};
use crate::report::plots;
use crate::report::study_files::StudyFiles;
use std::path::Path;

/// Writes all files of a run into `folder`: tables, plots and page, and `summary.json` last. Its
/// presence means that the run is complete.
///
/// # Errors
/// As [`write()`].
pub fn write_run(files: &StudyFiles, folder: &Path) -> Result<()> {
    let made = made(files)?.into_iter();
    write_with_plots(folder, made.chain(files.contents()).collect())
}

/// Writes `report.html`, `report.md` and `plots/*.svg` into `folder`.
///
/// # Errors
/// [`crate::base::Error::Io`] when a file cannot be written, [`crate::base::Error::File`] when the
/// run's files lack data of the page.
pub fn write(files: &StudyFiles, folder: &Path) -> Result<()> {
    write_with_plots(folder, made(files)?)
}

fn write_with_plots(folder: &Path, contents: Vec<(String, Vec<u8>)>) -> Result<()> {
    prepare_folder(&folder.join("plots"))?;
    replace_set(folder, &contents)
}

/// Plots, Markdown and page, by the names of their files.
fn made(files: &StudyFiles) -> Result<Vec<(String, Vec<u8>)>> {
    let plots = plots::all(files).into_iter();
    let mut made: Vec<(String, Vec<u8>)> =
        plots.map(|(name, svg)| (format!("plots/{name}"), svg.into_bytes())).collect();
    made.push(("report.md".to_string(), markdown(files)?.into_bytes()));
    made.push(("report.html".to_string(), html(files)?.into_bytes()));
    Ok(made)
}
