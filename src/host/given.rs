//! The files that were given to this process, which no result may take the place of.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard};

static GIVEN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn given() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    GIVEN.lock().unwrap_or_else(|e| e.into_inner())
}

/// Remembers that a user gave the file `path`. What is no file on a disk needs no such care.
pub fn remember_given(path: &Path) {
    if path.is_file()
        && let Ok(path) = path.canonicalize()
    {
        given().insert(path);
    }
}

/// Whether a user gave the file `path`, by whatever name.
#[cfg(feature = "cli")]
pub(super) fn is_given(path: &Path) -> bool {
    path.canonicalize().is_ok_and(|path| given().contains(&path))
}
