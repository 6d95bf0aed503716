//! The file that a sweep is to make: its rows in CSV themselves, or a Parquet file made of them at
//! the end.

use super::sweep::{Label, SweepFile};
#[cfg(feature = "parquet")]
use super::sweep_parquet::{read, write};
use crate::base::{Error, Result};
use std::path::{Path, PathBuf};

/// The file that a sweep makes.
#[derive(Debug)]
pub struct Target {
    /// The CSV file that the rows are written to.
    rows: PathBuf,
    /// The Parquet file that is made of them, if one is wanted.
    parquet: Option<PathBuf>,
    /// Whether the rows were read from the finished file.
    restored: bool,
}

impl Target {
    /// The file `out`, whose name says by `.parquet` that it is one of Parquet. Its rows stand in a
    /// CSV file of the same name with `.part` behind it until it is finished, so that a stopped
    /// sweep can be continued.
    ///
    /// # Errors
    /// [`Error::File`] when this build writes no Parquet.
    pub fn new(out: &Path) -> Result<Self> {
        if !out.extension().is_some_and(|e| e.eq_ignore_ascii_case("parquet")) {
            return Ok(Self { rows: out.to_path_buf(), parquet: None, restored: false });
        }
        if cfg!(not(feature = "parquet")) {
            return Err(missing(out));
        }
        let parquet = Some(out.to_path_buf());
        Ok(Self { rows: with_suffix(out, ".part"), parquet, restored: false })
    }

    /// Opens the rows for a sweep whose own columns are `columns`.
    ///
    /// # Errors
    /// As [`SweepFile::open`]; and [`Error::File`] when a Parquet file is there that is not of such
    /// a sweep.
    pub fn open(&mut self, columns: &[String], label: Label) -> Result<SweepFile> {
        let finished = self.parquet.as_ref().filter(|out| out.exists() && !self.rows.exists());
        if let Some(out) = finished {
            let restored = read(out, columns, &self.rows);
            self.restored = true;
            restored.inspect_err(|_| self.leave())?;
        }
        SweepFile::open(&self.rows, columns, label)
    }

    /// Leaves a sweep that could not be run to its end: rows of the finished file stay there alone.
    pub fn leave(&self) {
        if self.restored {
            // The rows are in the finished file; the error that led here is the one to report.
            let _ = std::fs::remove_file(&self.rows);
        }
    }

    /// Makes the file of the finished rows.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be written; the rows then remain.
    pub fn finish(&self) -> Result<()> {
        let Some(out) = &self.parquet else { return Ok(()) };
        let new = with_suffix(out, ".new");
        let io = |source| Error::Io { action: "write", path: out.clone(), source };
        let written = write(&self.rows, &new).and_then(|()| std::fs::rename(&new, out).map_err(io));
        // The rest of a failed attempt; the first error is the one to report.
        written.inspect_err(|_| drop(std::fs::remove_file(&new)))?;
        std::fs::remove_file(&self.rows).map_err(io)
    }
}

/// The error of a build without Parquet.
fn missing(out: &Path) -> Error {
    let remedy =
        "build it by `cargo install --path . --features parquet`, or give a name that ends in .csv";
    Error::File {
        path: out.to_path_buf(),
        line: None,
        message: "this program was built without Parquet".into(),
        remedy: remedy.into(),
    }
}

#[cfg(not(feature = "parquet"))]
fn read(out: &Path, _columns: &[String], _rows: &Path) -> Result<()> {
    Err(missing(out))
}

#[cfg(not(feature = "parquet"))]
fn write(_rows: &Path, out: &Path) -> Result<()> {
    Err(missing(out))
}

fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(suffix);
    path.with_file_name(name)
}
