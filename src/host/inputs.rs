//! The files that were given to this process, which no result may take the place of.

use super::text::read_text;
use crate::base::Result;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard};

static INPUTS: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn inputs() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    INPUTS.lock().unwrap_or_else(|e| e.into_inner())
}

/// [`read_text`] of a file that a user gave.
///
/// # Errors
/// As [`read_text`].
pub fn read_input(path: &Path, most: u64, remedy: &str) -> Result<String> {
    remember_input(path);
    read_text(path, most, remedy)
}

/// Remembers that a user gave the file `path`. What is no file on a disk needs no such care.
pub fn remember_input(path: &Path) {
    if path.is_file()
        && let Ok(path) = path.canonicalize()
    {
        inputs().insert(path);
    }
}

/// Whether a user gave the file `path`, by whatever name.
#[cfg(feature = "cli")]
pub(super) fn is_input(path: &Path) -> bool {
    path.canonicalize().is_ok_and(|path| inputs().contains(&path))
}
