//! Files that appear whole or not at all, in folders that were checked before the long run.

use crate::base::{Error, Result};
use std::fs::File;
use std::io::Write;
use std::path::Path;

/// Makes the folder `path` and checks that files can be written there, so that a bad path fails
/// before a calculation and not after it.
///
/// # Errors
/// [`Error::Io`] when it cannot be made or written into.
pub fn prepare_folder(path: &Path) -> Result<()> {
    let io = |action| move |source| Error::Io { action, path: path.to_path_buf(), source };
    std::fs::create_dir_all(path).map_err(io("create the folder"))?;
    // One name for all: what a run that is killed here leaves is removed by the next.
    let probe = path.join(".probe");
    // Not empty: a full disk still takes names.
    let written = std::fs::write(&probe, [0; 4096]);
    let removed = remove(&probe);
    written.and(removed).map_err(io("write into the folder"))
}

/// Writes a file under another name and moves it into place: readers, and runs that go on where
/// this one was stopped, never see half of it, not even after a power cut.
///
/// # Errors
/// [`Error::Io`] when it cannot be written; what was there before is left as it was.
pub fn write_whole(path: &Path, content: impl AsRef<[u8]>) -> Result<()> {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".part-{}", std::process::id()));
    let part = path.with_file_name(name);
    let written =
        write_through(&part, content.as_ref()).and_then(|()| std::fs::rename(&part, path));
    written.map_err(|source| {
        // What is left of the attempt is in the way; the first error is the one to report.
        let _ = std::fs::remove_file(&part);
        Error::Io { action: "write", path: path.to_path_buf(), source }
    })
}

/// Writes files that belong together into `folder`, which this process has locked, by name. The last
/// one says that all are there: nothing is changed until all have been written elsewhere, and it is
/// taken away first and put in place last.
///
/// # Errors
/// [`Error::Io`] when one cannot be written; unless the moving itself failed, what was there before
/// is left as it was.
///
/// # Panics
/// When there are no files.
pub fn write_set<N: AsRef<Path>>(folder: &Path, files: &[(N, Vec<u8>)]) -> Result<()> {
    let (last, _) = files.last().expect("a set has files");
    let last = folder.join(last);
    let parts = folder.join(PARTS);
    let failed = |action, path: &Path| {
        let path = path.to_path_buf();
        move |source| Error::Io { action, path, source }
    };
    let write = || {
        remove(&parts)
            .and_then(|()| std::fs::create_dir(&parts))
            .map_err(failed("write", &parts))?;
        for (i, (name, content)) in files.iter().enumerate() {
            let part = parts.join(i.to_string());
            write_through(&part, content).map_err(failed("write", &folder.join(name)))?;
        }
        remove(&last).map_err(failed("replace", &last))?;
        for (i, (name, _)) in files.iter().enumerate() {
            let path = folder.join(name);
            std::fs::rename(parts.join(i.to_string()), &path).map_err(failed("write", &path))?;
        }
        Ok(())
    };
    let written = write();
    // If it failed, that is the error to report.
    let _ = remove(&parts);
    written
}

/// The folder in which a set of files is written before any is put in its place.
const PARTS: &str = ".parts";

/// Removes what a run that was killed in `folder` had not put in its place yet. The caller has locked
/// the folder.
///
/// # Errors
/// [`Error::Io`] when it cannot be removed.
pub(super) fn remove_parts(folder: &Path) -> Result<()> {
    remove_if_there(&folder.join(PARTS))
}

/// Removes a file or a folder with all that is in it, if it is there.
///
/// # Errors
/// [`Error::Io`] when it cannot be removed.
pub fn remove_if_there(path: &Path) -> Result<()> {
    let io = |source| Error::Io { action: "remove", path: path.to_path_buf(), source };
    remove(path).map_err(io)
}

/// [`remove_if_there`], with the system's own error.
fn remove(path: &Path) -> std::io::Result<()> {
    let is_folder = std::fs::symlink_metadata(path).is_ok_and(|m| m.is_dir());
    let removed =
        if is_folder { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
    match removed {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(e),
        _ => Ok(()),
    }
}

/// Writes a file down to the disk: else its name could outlive a power cut that its content does not.
fn write_through(path: &Path, content: &[u8]) -> std::io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(content)?;
    file.sync_data()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_replaced_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("a/b");
        prepare_folder(&deep).unwrap();
        write_whole(&deep.join("f"), "one").unwrap();
        write_whole(&deep.join("f"), "two").unwrap();
        assert_eq!(std::fs::read_to_string(deep.join("f")).unwrap(), "two");
        assert_eq!(std::fs::read_dir(&deep).unwrap().count(), 1);
    }

    #[test]
    fn what_is_no_folder_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        write_whole(&file, "").unwrap();
        assert!(
            prepare_folder(&file).unwrap_err().to_string().contains("cannot create the folder")
        );
        assert!(write_whole(&file.join("below"), "").is_err());
        assert!(write_whole(folder.path(), "").is_err());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_set_without_its_last_file_is_not_complete() {
        let folder = tempfile::tempdir().unwrap();
        let set = |text: &str| ["a", "b", "done"].map(|name| (name, text.as_bytes().to_vec()));
        let files = || std::fs::read_dir(folder.path()).unwrap().count();
        // What a run that was killed left is in nobody's way.
        std::fs::create_dir(folder.path().join(PARTS)).unwrap();
        std::fs::write(folder.path().join(PARTS).join("0"), "half").unwrap();
        write_set(folder.path(), &set("one")).unwrap();
        write_set(folder.path(), &set("two")).unwrap();
        assert_eq!(std::fs::read_to_string(folder.path().join("a")).unwrap(), "two");
        assert_eq!(files(), 3);
        // A place that cannot be taken leaves the set without the file that calls it complete.
        std::fs::remove_file(folder.path().join("b")).unwrap();
        std::fs::create_dir(folder.path().join("b")).unwrap();
        write_set(folder.path(), &set("three")).unwrap_err();
        assert!(!folder.path().join("done").exists());
        assert_eq!(files(), 2);
    }
}
