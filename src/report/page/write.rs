//! What is made of a run's own files: plots, page and Markdown.

use super::render::{html, markdown};
use crate::base::Result;
use crate::host::{prepare_folder, write_set};
use crate::report::plots;
use crate::report::study_files::StudyFiles;
use std::path::Path;

/// Writes all files of a run into `folder`: its tables, the plots and the page that are made of them,
/// and `summary.json`, which says that the run is complete, last.
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
/// [`crate::base::Error::Io`] when a file cannot be written, [`crate::base::Error::File`] when the run's files lack what the
/// page shows.
pub fn write(files: &StudyFiles, folder: &Path) -> Result<()> {
    write_with_plots(folder, made(files)?)
}

fn write_with_plots(folder: &Path, contents: Vec<(String, Vec<u8>)>) -> Result<()> {
    prepare_folder(&folder.join("plots"))?;
    write_set(folder, &contents)
}

/// What is made of a run's own files, by name: plots, Markdown and the page.
fn made(files: &StudyFiles) -> Result<Vec<(String, Vec<u8>)>> {
    let plots = plots::all(files).into_iter();
    let mut made: Vec<(String, Vec<u8>)> =
        plots.map(|(name, svg)| (format!("plots/{name}"), svg.into_bytes())).collect();
    made.push(("report.md".to_string(), markdown(files)?.into_bytes()));
    made.push(("report.html".to_string(), html(files)?.into_bytes()));
    Ok(made)
}
