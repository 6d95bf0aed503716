//! A lock on the folder of a run. The kernel releases it when the process that holds it ends.

use super::files::remove_parts;
use super::prepare_folder;
use crate::base::{Error, Result};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// A folder that only this process uses.
#[derive(Debug)]
pub struct Lock {
    path: PathBuf,
    _file: File,
    /// Whether the folder was made for it, and goes with it if it is empty then.
    made_folder: bool,
}

impl Lock {
    /// Creates `folder`, checks that files can be written there, takes its lock, and removes the
    /// unfinished files of a run that was killed. A folder that is made here and empty in the end
    /// is removed.
    ///
    /// # Errors
    /// As [`prepare_folder`] and [`Lock::take`].
    pub fn claim(folder: &Path) -> Result<Lock> {
        let made_folder = !folder.exists();
        prepare_folder(folder)?;
        let mut lock = Lock::take(folder)?;
        lock.made_folder = made_folder;
        remove_parts(folder)?;
        Ok(lock)
    }

    /// Takes the lock of `folder`, which exists.
    ///
    /// # Errors
    /// [`Error::Busy`] when another process has it, [`Error::Io`] when the lock cannot be made.
    pub fn take(folder: &Path) -> Result<Lock> {
        let path = folder.join(".lock");
        let io = |source| Error::Io { action: "lock", path: path.clone(), source };
        loop {
            let mut options = OpenOptions::new();
            options.read(true).write(true).create(true).truncate(false);
            let mut file = options.open(&path).map_err(io)?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => {
                    let mut text = String::new();
                    let _ = file.read_to_string(&mut text);
                    let pid = text.trim().parse().ok();
                    return Err(Error::Busy { path: folder.to_path_buf(), pid });
                }
                // On a file system without locks the user must keep two runs apart.
                Err(TryLockError::Error(e)) if e.kind() == std::io::ErrorKind::Unsupported => {}
                Err(TryLockError::Error(e)) => return Err(io(e)),
            }
            // The previous holder may have removed the file after it was opened here and before it
            // was locked. A third process would then lock another file of the same name.
            let there = std::fs::metadata(&path).map(|m| m.ino()).ok();
            if there.is_none() || there != file.metadata().map(|m| m.ino()).ok() {
                continue;
            }
            file.set_len(0).map_err(io)?;
            writeln!(file, "{}", std::process::id()).map_err(io)?;
            return Ok(Lock { path: path.clone(), _file: file, made_folder: false });
        }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // The file is removed while it is locked; if that fails, the next run takes it over.
        let _ = std::fs::remove_file(&self.path);
        if self.made_folder
            && let Some(folder) = self.path.parent()
        {
            // A run that failed leaves nothing; a folder with files stays.
            let _ = std::fs::remove_dir(folder);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_that_is_made_and_stays_empty_goes_with_its_lock() {
        let folder = tempfile::tempdir().unwrap();
        let made = folder.path().join("made");
        drop(Lock::claim(&made).unwrap());
        assert!(!made.exists());
        drop(Lock::claim(folder.path()).unwrap());
        assert!(folder.path().exists());
        let lock = Lock::claim(&made).unwrap();
        std::fs::write(made.join("summary.json"), "{}").unwrap();
        drop(lock);
        assert!(made.join("summary.json").exists());
    }

    #[test]
    fn a_folder_is_locked_until_the_lock_ends() {
        let folder = tempfile::tempdir().unwrap();
        let lock = Lock::take(folder.path()).unwrap();
        // The lock belongs to the open file, so a second one in the same process is refused too.
        let message = Lock::take(folder.path()).unwrap_err().to_string();
        assert!(message.contains(&format!("process {}", std::process::id())), "{message}");
        drop(lock);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        // The lock of a dead process is taken over.
        std::fs::write(folder.path().join(".lock"), "999999\n").unwrap();
        Lock::take(folder.path()).unwrap();
    }
}
