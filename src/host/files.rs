//! Files that are written completely or not at all, in folders that are checked before a long run.

use super::inputs::is_input;
use crate::base::{Error, Result};
use std::fs::File;
use std::io::Write;
use std::path::{Component, Path, PathBuf};

/// Creates the folder `path` and checks that files can be written there, so that a bad path is an
/// error before the calculation and not after it.
///
/// # Errors
/// [`Error::Io`] when it cannot be created or written to.
pub fn prepare_folder(path: &Path) -> Result<()> {
    let io = |action| move |source| Error::Io { action, path: path.to_path_buf(), source };
    std::fs::create_dir_all(path).map_err(io("create the folder"))?;
    // A fixed name: the next run removes the file of a run that was killed here.
    let probe = path.join(".probe");
    // Not empty, because a full disk still accepts names.
    let written = std::fs::write(&probe, [0; 4096]);
    let removed = remove_file(&probe);
    written.and(removed).map_err(io("write into the folder"))
}

/// Writes a file under another name and moves it into place. Readers and later runs never see an
/// incomplete file, not even after a power failure.
///
/// # Errors
/// [`Error::Io`] when it cannot be written; the previous file then remains.
pub fn write_whole(path: &Path, content: impl AsRef<[u8]>) -> Result<()> {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".part-{}", std::process::id()));
    let part = path.with_file_name(name);
    let written =
        write_through(&part, content.as_ref()).and_then(|()| std::fs::rename(&part, path));
    written.map_err(|source| {
        // Removes the rest of the attempt; the first error is the one to report.
        let _ = std::fs::remove_file(&part);
        Error::Io { action: "write", path: path.to_path_buf(), source }
    })
}

/// Writes files that belong together into `folder`, which this process has locked. The last file
/// marks the set as complete: it is removed first and moved into place last. Nothing is changed
/// until all files have been written elsewhere. Folders in `folder` that a name has are created.
///
/// # Errors
/// [`Error::File`] when one would take the place of a file that was given to this run;
/// [`Error::Io`] when one cannot be written; the previous files then remain, unless the move itself
/// failed.
///
/// # Panics
/// When there are no files.
pub fn write_set<N: AsRef<Path>>(folder: &Path, files: &[(N, Vec<u8>)]) -> Result<()> {
    move_into_place(folder, files, &|| Ok(()))
}

/// As [`write_set`], for files whose names those of other sets may have: what `marks` such a set as
/// complete is removed before its first file gives way. A folder of that name is somebody else's,
/// and stays.
///
/// # Errors
/// As [`write_set`].
///
/// # Panics
/// As [`write_set`].
pub fn write_set_over<N: AsRef<Path>>(
    folder: &Path,
    files: &[(N, Vec<u8>)],
    marks: &[&str],
) -> Result<()> {
    move_into_place(folder, files, &|| {
        marks.iter().try_for_each(|mark| remove_marker(folder, mark))
    })
}

/// As [`write_set`], for a set whose files depend on what was asked for: those of the last set with
/// this mark that are not in this one are removed. They would be taken for parts of it.
///
/// # Errors
/// As [`write_set`].
///
/// # Panics
/// As [`write_set`].
pub fn replace_set<N: AsRef<Path>>(folder: &Path, files: &[(N, Vec<u8>)]) -> Result<()> {
    let names: Vec<&Path> = files.iter().map(|(name, _)| name.as_ref()).collect();
    let list = list_of(folder, names.last().expect("a set has files"));
    move_into_place(folder, files, &|| {
        let earlier = listed(&list).into_iter().filter(|name| !names.contains(&name.as_path()));
        let own = |path: &PathBuf| path.is_file() && !is_input(path);
        for path in earlier.map(|name| folder.join(name)).filter(own) {
            remove_if_there(&path)?;
        }
        let text: String = names.iter().map(|name| format!("{}\n", name.display())).collect();
        write_through(&list, text.as_bytes()).map_err(failed("write", &list))
    })
}

/// [`write_set`], with `before` between the removal of the file that marks an earlier set and the
/// moves.
fn move_into_place<N: AsRef<Path>>(
    folder: &Path,
    files: &[(N, Vec<u8>)],
    before: &dyn Fn() -> Result<()>,
) -> Result<()> {
    let (last, _) = files.last().expect("a set has files");
    let last = folder.join(last);
    check_not_given(folder, files.iter().map(|(name, _)| name))?;
    let parts = folder.join(PARTS);
    let write = || {
        remove(&parts)
            .and_then(|()| std::fs::create_dir(&parts))
            .map_err(failed("write", &parts))?;
        for (i, (name, content)) in files.iter().enumerate() {
            let part = parts.join(i.to_string());
            write_through(&part, content).map_err(failed("write", &folder.join(name)))?;
        }
        for path in files.iter().map(|(name, _)| folder.join(name)) {
            let parent = path.parent().unwrap_or(folder);
            std::fs::create_dir_all(parent).map_err(failed("create the folder", parent))?;
        }
        remove_file(&last).map_err(failed("replace", &last))?;
        before()?;
        for (i, (name, _)) in files.iter().enumerate() {
            let path = folder.join(name);
            std::fs::rename(parts.join(i.to_string()), &path).map_err(failed("write", &path))?;
        }
        Ok(())
    };
    let written = write();
    // A failure of the write is the error to report.
    let _ = remove(&parts);
    written
}

/// Refuses results of these names in `folder` where one would take the place of a file that was
/// given to this run.
///
/// # Errors
/// [`Error::File`] that names the file.
pub fn check_not_given<N: AsRef<Path>>(
    folder: &Path,
    names: impl IntoIterator<Item = N>,
) -> Result<()> {
    match names.into_iter().map(|name| folder.join(name)).find(|path| is_input(path)) {
        None => Ok(()),
        Some(path) => Err(Error::File {
            path,
            line: None,
            message: "was given to this run, and a result has its name".into(),
            remedy: "give another --out, or rename it".into(),
        }),
    }
}

/// What makes an error of a failed `action` on `path`.
fn failed(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Error {
    let path = path.to_path_buf();
    move |source| Error::Io { action, path, source }
}

/// The folder in which a set of files is written before the move.
const PARTS: &str = ".parts";

/// The file in `folder` that has the names of the files of the set with this mark, one a line.
fn list_of(folder: &Path, mark: &Path) -> PathBuf {
    folder.join(format!(".{}.files", mark.display()))
}

/// The names in a list of files, but for those that lead out of its folder. None if it cannot be
/// read.
fn listed(list: &Path) -> Vec<PathBuf> {
    let text = std::fs::read_to_string(list).unwrap_or_default();
    let within = |name: &PathBuf| name.components().all(|c| matches!(c, Component::Normal(_)));
    text.lines().map(PathBuf::from).filter(within).collect()
}

/// Removes the unfinished files of a run that was killed in `folder`. The caller has locked the
/// folder.
///
/// # Errors
/// [`Error::Io`] when it cannot be removed.
pub(super) fn remove_parts(folder: &Path) -> Result<()> {
    remove_if_there(&folder.join(PARTS))
}

/// Makes the folder `path`, which does not exist, with a file of this `name` in it. A process that
/// is killed leaves both or neither. This process has locked the folder around it.
///
/// # Errors
/// [`Error::Io`] when it cannot be made or written into.
pub fn make_folder(path: &Path, name: &str, content: impl AsRef<[u8]>) -> Result<()> {
    let parts = path.with_file_name(PARTS);
    prepare_folder(&parts)?;
    write_whole(&parts.join(name), content)?;
    std::fs::rename(&parts, path).map_err(failed("create the folder", path))
}

/// Removes the folder `path` with its content, if it exists: a process that is killed leaves all of
/// it or nothing. This process has locked the folder around it.
///
/// # Errors
/// [`Error::Io`] when it cannot be removed.
pub fn remove_folder(path: &Path) -> Result<()> {
    let parts = path.with_file_name(PARTS);
    unless_missing(std::fs::rename(path, &parts))
        .and_then(|()| remove(&parts))
        .map_err(failed("remove", path))
}

/// Removes the file that marks a run of another kind in `folder` as complete, some of whose files
/// give way to others. A folder of that name is somebody else's, and stays.
///
/// # Errors
/// [`Error::Io`] when it cannot be removed.
pub fn remove_marker(folder: &Path, name: &str) -> Result<()> {
    let path = folder.join(name);
    if path.is_file() { remove_if_there(&path) } else { Ok(()) }
}

/// Removes a file, or a folder with its content, if it exists.
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
    unless_missing(removed)
}

/// Removes a file if it exists. A folder of that name is somebody else's.
fn remove_file(path: &Path) -> std::io::Result<()> {
    unless_missing(std::fs::remove_file(path))
}

/// The outcome of a removal, for which it is no failure that there was nothing to remove.
fn unless_missing(removed: std::io::Result<()>) -> std::io::Result<()> {
    match removed {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(e),
        _ => Ok(()),
    }
}

/// Writes a file to the disk. Otherwise a power failure could keep its name without its content.
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
    fn folders_are_made_and_removed_whole() {
        let folder = tempfile::tempdir().unwrap();
        let work = folder.path().join("work");
        remove_folder(&work).unwrap();
        make_folder(&work, "mark", "own").unwrap();
        assert_eq!(std::fs::read_to_string(work.join("mark")).unwrap(), "own");
        assert_eq!(std::fs::read_dir(&work).unwrap().count(), 1);
        assert!(make_folder(&work, "mark", "other").is_err());
        assert_eq!(std::fs::read_to_string(work.join("mark")).unwrap(), "own");
        remove_parts(folder.path()).unwrap();
        remove_folder(&work).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
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
    fn what_was_given_is_neither_replaced_nor_removed() {
        let folder = tempfile::tempdir().unwrap();
        let (folder, mine) = (folder.path(), folder.path().join("mine"));
        let set = |names: &[&str]| names.iter().map(|n| (n.to_string(), Vec::new())).collect();
        let replace = |files: Vec<(String, Vec<u8>)>| replace_set(folder, &files);
        replace(set(&["mine", "done"])).unwrap();
        std::fs::write(&mine, "own").unwrap();
        crate::host::remember_input(&folder.join("./mine"));
        let said = replace(set(&["mine", "done"])).unwrap_err().to_string();
        assert!(said.contains("mine: was given to this run"), "{said}");
        assert!(folder.join("done").is_file());
        // A list of an earlier set has its name.
        replace(set(&["other", "done"])).unwrap();
        assert_eq!(std::fs::read_to_string(&mine).unwrap(), "own");
    }

    #[test]
    fn a_set_without_its_last_file_is_not_complete() {
        let folder = tempfile::tempdir().unwrap();
        let set = |text: &str| ["a", "b", "done"].map(|name| (name, text.as_bytes().to_vec()));
        let files = || std::fs::read_dir(folder.path()).unwrap().count();
        // The rest of a killed run is not an obstacle.
        std::fs::create_dir(folder.path().join(PARTS)).unwrap();
        std::fs::write(folder.path().join(PARTS).join("0"), "half").unwrap();
        write_set(folder.path(), &set("one")).unwrap();
        write_set(folder.path(), &set("two")).unwrap();
        assert_eq!(std::fs::read_to_string(folder.path().join("a")).unwrap(), "two");
        assert_eq!(files(), 3);
        // If a file cannot be moved, the set lacks the file that marks it as complete.
        std::fs::remove_file(folder.path().join("b")).unwrap();
        std::fs::create_dir(folder.path().join("b")).unwrap();
        write_set(folder.path(), &set("three")).unwrap_err();
        assert!(!folder.path().join("done").exists());
        assert_eq!(files(), 2);
    }

    #[test]
    fn marks_of_other_sets_go_with_the_first_file_and_not_before() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let write = |last: &str| {
            write_set_over(folder, &[("a", b"new".to_vec()), (last, Vec::new())], &["other"])
        };
        for name in ["a", "other"] {
            std::fs::write(folder.join(name), "old").unwrap();
        }
        // The second set cannot be put together: its last file would be below a file.
        write("a/b").unwrap_err();
        assert_eq!(std::fs::read_to_string(folder.join("a")).unwrap(), "old");
        assert!(folder.join("other").exists());
        write("done").unwrap();
        assert_eq!(std::fs::read_to_string(folder.join("a")).unwrap(), "new");
        assert!(folder.join("done").exists() && !folder.join("other").exists());
        std::fs::create_dir(folder.join("other")).unwrap();
        write("done").unwrap();
        assert!(folder.join("other").exists());
    }

    #[test]
    fn files_of_an_earlier_set_do_not_stay_beside_a_new_one() {
        let folder = tempfile::tempdir().unwrap();
        let outside = folder.path().join("outside");
        std::fs::write(&outside, "").unwrap();
        let folder = folder.path().join("run");
        std::fs::create_dir_all(folder.join("plots")).unwrap();
        let write = |names: &[&str]| {
            let set: Vec<_> = names.iter().map(|name| (*name, Vec::new())).collect();
            replace_set(&folder, &set).unwrap();
        };
        let there = |names: &[&str]| names.iter().all(|name| folder.join(name).exists());
        write(&["a", "plots/b", "done"]);
        write(&["c", "other"]);
        std::fs::write(folder.join("own"), "").unwrap();
        write(&["d", "done"]);
        assert!(there(&["c", "d", "done", "other", "own"]) && !there(&["a"]));
        assert!(!there(&["plots/b"]));
        // A list is a file that anybody can write.
        std::fs::write(list_of(&folder, "done".as_ref()), "../outside\nd\n").unwrap();
        write(&["e", "done"]);
        assert!(there(&["e", "done"]) && !there(&["d"]) && outside.exists());
    }
}
