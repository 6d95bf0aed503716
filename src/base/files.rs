//! Files that appear whole or not at all, in folders that were checked before the long run.

use super::{Error, Result};
use std::path::Path;

/// Makes the folder `path` and checks that files can be written there, so that a bad path fails
/// before a calculation and not after it.
///
/// # Errors
/// [`Error::Io`] when it cannot be made or written into.
pub fn prepare_folder(path: &Path) -> Result<()> {
    let io = |action| move |source| Error::Io { action, path: path.to_path_buf(), source };
    std::fs::create_dir_all(path).map_err(io("create the folder"))?;
    let probe = path.join(format!(".probe-{}", std::process::id()));
    std::fs::write(&probe, []).map_err(io("write into the folder"))?;
    std::fs::remove_file(&probe).map_err(io("write into the folder"))
}

/// Writes a file under another name and moves it into place: readers, and runs that go on where
/// this one was stopped, never see half of it.
///
/// # Errors
/// [`Error::Io`] when it cannot be written; what was there before is left as it was.
pub fn write_whole(path: &Path, content: impl AsRef<[u8]>) -> Result<()> {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".part-{}", std::process::id()));
    let part = path.with_file_name(name);
    let written = std::fs::write(&part, content).and_then(|()| std::fs::rename(&part, path));
    written.map_err(|source| {
        // What is left of the attempt is in the way; the first error is the one to report.
        let _ = std::fs::remove_file(&part);
        Error::Io { action: "write", path: path.to_path_buf(), source }
    })
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
}
