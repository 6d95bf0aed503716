//! `edgeline report`: rebuilds the page of a finished run.

use super::output::{Exit, print};
use crate::base::Result;
use crate::host::Lock;
use crate::report::page;
use crate::report::study_files::StudyFiles;
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// Rebuilds report.html, report.md and plots/*.svg from the files of a finished study.
///
/// Reads summary.json and the CSV files of the run and writes into the same folder. Takes about a
/// second.
#[derive(Args)]
pub(super) struct Arguments {
    /// The folder that `edgeline study --out` wrote
    #[arg(value_hint = ValueHint::DirPath)]
    run: PathBuf,
}

pub(super) fn run(arguments: Arguments) -> Result<Exit> {
    // A study that writes there meanwhile would mix its files with those that are read. A folder
    // that is not there has no lock either.
    let _lock = arguments.run.is_dir().then(|| Lock::claim(&arguments.run)).transpose()?;
    let files = StudyFiles::read(&arguments.run)?;
    page::write(&files, &arguments.run)?;
    print(&format!("wrote report.html, report.md and plots into {}\n", arguments.run.display()))?;
    Ok(Exit::Done)
}
