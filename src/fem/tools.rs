//! The external tools: a Python interpreter with dolfinx, gmsh, and mpirun.

use crate::base::{Error, Result};
use crate::host::{capture, check_interrupt};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// The environment variable that names the interpreter.
pub const PYTHON_VARIABLE: &str = "EDGELINE_PYTHON";

/// What to install, on Debian or Ubuntu.
pub const INSTALL: &str =
    "install it, on Debian or Ubuntu: apt-get install gmsh python3-dolfinx libopenblas0-serial";

/// Imports the modules of the finite-element program and prints their versions.
const PROBE: &str = "\
import json, sys
import dolfinx, mpi4py, numpy, petsc4py
import dolfinx.fem.petsc
print(json.dumps({'python': sys.version.split()[0], 'dolfinx': dolfinx.__version__,
                  'petsc4py': petsc4py.__version__, 'mpi4py': mpi4py.__version__,
                  'numpy': numpy.__version__}))
";

/// The first import takes long on a cold disk.
const IMPORT_TIMEOUT: Duration = Duration::from_secs(120);
const VERSION_TIMEOUT: Duration = Duration::from_secs(20);

/// A Python interpreter that imports dolfinx.
#[derive(Debug, Clone, PartialEq)]
pub struct Interpreter {
    /// The program.
    pub path: PathBuf,
    /// Where it was found, e.g. `--python` or `the PATH`.
    pub source: &'static str,
    /// Versions of the interpreter and what it imports.
    pub versions: BTreeMap<String, String>,
}

/// Candidate interpreters, best first: only an explicit setting if there is one, otherwise Debian's
/// own and the PATH's.
pub fn candidates(explicit: Option<&Path>) -> Vec<(PathBuf, &'static str)> {
    if let Some(path) = explicit {
        return vec![(path.to_path_buf(), "--python")];
    }
    if let Some(path) = std::env::var_os(PYTHON_VARIABLE).filter(|value| !value.is_empty()) {
        return vec![(path.into(), PYTHON_VARIABLE)];
    }
    let mut found = vec![(PathBuf::from("/usr/bin/python3"), "the system's")];
    if let Some(path) = which("python3")
        && path != found[0].0
    {
        found.push((path, "the PATH"));
    }
    found
}

/// Versions of the modules of an interpreter, or `None` if it does not import dolfinx.
pub fn imports(python: &Path) -> Option<BTreeMap<String, String>> {
    let (out, _) = capture(Command::new(python).args(["-c", PROBE]), IMPORT_TIMEOUT)?;
    serde_json::from_str(out.lines().last()?).ok()
}

/// The interpreter to use: the first candidate that imports dolfinx.
///
/// # Errors
/// [`Error::Missing`] that lists what was tried.
pub fn find_interpreter(explicit: Option<&Path>) -> Result<Interpreter> {
    let candidates = candidates(explicit);
    for (path, source) in &candidates {
        if let Some(versions) = imports(path) {
            return Ok(Interpreter { path: path.clone(), source, versions });
        }
    }
    check_interrupt()?;
    let tried: Vec<String> =
        candidates.iter().map(|(path, source)| format!("{} ({source})", path.display())).collect();
    Err(Error::Missing {
        tool: "a Python interpreter that imports dolfinx".into(),
        searched: format!("tried {}", tried.join(", ")),
        remedy: format!("{INSTALL}; or name an interpreter with --python or {PYTHON_VARIABLE}"),
    })
}

/// The version that a program prints with `--version`: the first line with a digit.
pub fn version(program: &Path) -> Option<String> {
    let (out, err) = capture(Command::new(program).arg("--version"), VERSION_TIMEOUT)?;
    let line = out.lines().chain(err.lines()).find(|l| l.chars().any(|c| c.is_ascii_digit()))?;
    Some(line.trim().to_string())
}

/// Fails unless `program` can be run.
///
/// # Errors
/// [`Error::Missing`] when it cannot.
pub(super) fn require(program: &Path, option: &str) -> Result<()> {
    if version(program).is_some() {
        return Ok(());
    }
    check_interrupt()?;
    Err(Error::Missing {
        tool: program.display().to_string(),
        searched: format!("`{} --version` does not run", program.display()),
        remedy: format!("{INSTALL}; or name it with {option}"),
    })
}

/// The BLAS library that an interpreter's numpy and PETSc load, as `folder/file`.
pub fn blas(python: &Path) -> Option<String> {
    const PROBE: &str = "\
import os
import dolfinx.fem.petsc
names = {os.path.realpath(line.split()[-1]) for line in open('/proc/self/maps') if 'libblas' in line}
print(min('/'.join(name.split('/')[-2:]) for name in names))
";
    let (out, _) = capture(Command::new(python).args(["-c", PROBE]), IMPORT_TIMEOUT)?;
    out.lines().last().map(str::to_string)
}

/// Whether a BLAS, as [`blas`] names it, is the reference implementation.
pub fn is_slow_blas(name: &str) -> bool {
    name.starts_with("blas/")
}

/// The path of a program on the PATH.
pub fn which(program: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(program)).find(|file| file.is_file())
}
