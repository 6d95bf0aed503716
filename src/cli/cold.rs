//! The time of a solve in a process of its own.

use crate::body::EdgeModel;
use crate::case::Case;
use crate::host::write_whole;
use crate::solve::Summary;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Runs `edgeline solve` on cases, in a temporary folder. The new process cannot use the tables
/// that this one has built.
pub(super) struct ColdRuns {
    folder: PathBuf,
}

impl ColdRuns {
    /// Runs in a hidden folder of this process below `folder`, which it has locked.
    pub(super) fn new(folder: &Path) -> Self {
        Self { folder: folder.join(format!(".cold-{}", std::process::id())) }
    }

    /// Time of the complete solution (s) as measured by that process, without start-up and files;
    /// `None` if it could not run.
    pub(super) fn seconds(&self, case: &Case, method: EdgeModel, threads: usize) -> Option<f64> {
        std::fs::create_dir_all(&self.folder).ok()?;
        let file = self.folder.join("case.toml");
        write_whole(&file, case.to_toml()).ok()?;
        let output = Command::new(std::env::current_exe().ok()?)
            .arg("solve")
            .arg(&file)
            .args(["--method", method.name(), "--json", "--out"])
            .arg(&self.folder)
            .env("RAYON_NUM_THREADS", threads.to_string())
            .stdin(Stdio::null())
            .stderr(Stdio::null())
            .output()
            .ok()?;
        let summary: Summary = serde_json::from_slice(&output.stdout).ok()?;
        Some(summary.seconds.total)
    }
}

impl Drop for ColdRuns {
    fn drop(&mut self) {
        // One that cannot be removed is hidden, and in nobody's way.
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}
