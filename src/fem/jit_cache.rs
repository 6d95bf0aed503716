//! A separate cache of compiled forms for each run.
//!
//! FEniCSx compiles each form once and keeps it in a cache. A process that is killed while it
//! compiles leaves an incomplete entry there, on which the next process waits and then fails. Each
//! run therefore has its own cache. It starts with the complete entries of earlier runs, and its
//! new complete entries are added to them at the end.

use crate::host::write_whole;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

/// The suffix of the file whose presence says that an entry is complete.
const READY: &str = ".c.cached";

/// The folders of the user's cache that complete entries are taken from: our own, and FEniCSx's.
fn stores() -> Option<[PathBuf; 2]> {
    let home = std::env::var_os("XDG_CACHE_HOME")
        .filter(|value| !value.is_empty())
        .map(PathBuf::from)
        .or_else(|| std::env::home_dir().map(|home| home.join(".cache")))?;
    Some([home.join("edgeline/fenics"), home.join("fenics")])
}

/// Fills the cache of a run; entries that cannot be copied are compiled again.
pub(super) fn seed(folder: &Path) {
    for store in stores().into_iter().flatten() {
        copy_complete(&store, folder);
    }
}

/// Adds the entries of a run to the user's cache; entries that cannot be copied are compiled again.
pub(super) fn keep(folder: &Path) {
    if let Some([own, _]) = stores() {
        copy_complete(folder, &own);
    }
}

/// Copies the complete entries that `to` lacks, the READY file of each last.
fn copy_complete(from: &Path, to: &Path) {
    if fs::create_dir_all(to).is_err() {
        return;
    }
    let names: Vec<OsString> =
        fs::read_dir(from).into_iter().flatten().flatten().map(|entry| entry.file_name()).collect();
    let texts: Vec<&str> = names.iter().filter_map(|name| name.to_str()).collect();
    for ready in texts.iter().filter(|name| name.ends_with(READY)) {
        if to.join(ready).exists() {
            continue;
        }
        let stem = &ready[..ready.len() - READY.len()];
        let parts = texts.iter().filter(|name| {
            name.strip_prefix(stem).is_some_and(|rest| rest.starts_with('.')) && *name != ready
        });
        let copied = parts.chain([ready]).all(|name| {
            fs::read(from.join(name)).is_ok_and(|b| write_whole(&to.join(name), b).is_ok())
        });
        if !copied {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_complete_entries_are_copied() {
        let folder = tempfile::tempdir().unwrap();
        let (from, to) = (folder.path().join("from"), folder.path().join("to"));
        fs::create_dir(&from).unwrap();
        for name in ["a.c", "a.o", "a.cpython.so", "a.c.cached", "b.c", "b.c.failed", "ab.c"] {
            fs::write(from.join(name), name).unwrap();
        }
        copy_complete(&from, &to);
        let mut copied: Vec<_> = fs::read_dir(&to)
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        copied.sort();
        assert_eq!(copied, ["a.c", "a.c.cached", "a.cpython.so", "a.o"]);
        assert_eq!(fs::read_to_string(to.join("a.cpython.so")).unwrap(), "a.cpython.so");
        copy_complete(&folder.path().join("nowhere"), &to);
    }
}
