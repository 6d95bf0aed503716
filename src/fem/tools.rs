//! The external tools: a Python interpreter, gmsh, mpirun, and CalculiX.

use super::code::Code;
use crate::base::{Error, Result};
use crate::host::{capture, capture_any, check_interrupt};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// The environment variable that names the interpreter.
pub const PYTHON_VARIABLE: &str = "EDGELINE_PYTHON";

/// The first import takes long on a cold disk.
const IMPORT_TIMEOUT: Duration = Duration::from_secs(120);
const VERSION_TIMEOUT: Duration = Duration::from_secs(20);

/// A program as children in other folders find it: a path from here in full, and a bare name, which
/// is looked up on the PATH, as it is.
pub(super) fn from_here(program: &Path) -> PathBuf {
    if is_bare(program) {
        return program.to_path_buf();
    }
    // Links stay: an interpreter finds its modules by the name that it is called by.
    std::path::absolute(program).unwrap_or_else(|_| program.to_path_buf())
}

/// Whether a program is named alone, without a folder.
fn is_bare(program: &Path) -> bool {
    !program.as_os_str().as_encoded_bytes().contains(&b'/')
}

/// A Python interpreter that imports what a code takes.
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
        return vec![(from_here(path), "--python")];
    }
    if let Some(path) = std::env::var_os(PYTHON_VARIABLE).filter(|value| !value.is_empty()) {
        return vec![(from_here(Path::new(&path)), PYTHON_VARIABLE)];
    }
    let mut found = vec![(PathBuf::from("/usr/bin/python3"), "the system's")];
    if let Some(path) = which("python3")
        && path != found[0].0
    {
        found.push((path, "the PATH"));
    }
    found
}

/// What was found out about a program, or in words why it is not usable.
pub type Found<T> = std::result::Result<T, String>;

/// Versions of what an interpreter imports for `code`, or why it does not.
pub fn imports(python: &Path, code: Code) -> Found<BTreeMap<String, String>> {
    let modules = code.modules().join(", ");
    let named = code.modules().iter().filter(|name| !name.contains('.'));
    let versions: Vec<String> = named.map(|name| format!("'{name}': {name}.__version__")).collect();
    let probe = format!(
        "import json, sys\nimport {modules}\n\
         print(json.dumps({{'python': sys.version.split()[0], {}}}))\n",
        versions.join(", ")
    );
    let (out, _) = capture(Command::new(python).args(["-c", &probe]), IMPORT_TIMEOUT)?;
    let versions = out.lines().last().and_then(|line| serde_json::from_str(line).ok());
    versions.ok_or_else(|| "does not print the versions that it is asked for".to_string())
}

/// The interpreter to use: the first candidate that imports what `code` takes.
///
/// # Errors
/// [`Error::Missing`] that lists what was tried.
pub fn find_interpreter(explicit: Option<&Path>, code: Code) -> Result<Interpreter> {
    let mut tried = Vec::new();
    for (path, source) in candidates(explicit) {
        match imports(&path, code) {
            Ok(versions) => return Ok(Interpreter { path, source, versions }),
            Err(why) => tried.push(format!("{} ({source}), which {why}", path.display())),
        }
    }
    check_interrupt()?;
    Err(Error::Missing {
        tool: format!("a Python interpreter that imports {}", code.modules()[0]),
        searched: format!("tried {}", tried.join(", ")),
        remedy: format!(
            "{}; or name an interpreter with --python or {PYTHON_VARIABLE}",
            code.install()
        ),
    })
}

/// The version that a program prints with `--version`: the first line with a digit.
pub fn version(program: &Path) -> Found<String> {
    let (out, err) = capture(Command::new(program).arg("--version"), VERSION_TIMEOUT)?;
    let has_digit = |line: &&str| line.chars().any(|c| c.is_ascii_digit());
    let line = out.lines().chain(err.lines()).find(has_digit);
    line.map(|line| line.trim().to_string()).ok_or_else(no_version)
}

/// The version that gmsh prints: a line of nothing but it, which other programs do not have.
pub fn gmsh_version(program: &Path) -> Found<String> {
    let version = version(program)?;
    let is_version = version.contains('.') && version.starts_with(|c: char| c.is_ascii_digit());
    if is_version { Ok(version) } else { Err(no_version()) }
}

fn no_version() -> String {
    "does not print a version of it".to_string()
}

/// The version of the gmsh `program`, which meshes for `code`.
///
/// # Errors
/// [`Error::Missing`] when it cannot be run.
pub(super) fn require_gmsh(program: &Path, code: Code) -> Result<String> {
    let remedy = format!("{}; or name it with --gmsh", code.install());
    require(program, "--version", gmsh_version(program), remedy)
}

/// The version of mpirun.
///
/// # Errors
/// [`Error::Missing`] when it cannot be run.
pub(super) fn require_mpirun() -> Result<String> {
    let program = Path::new("mpirun");
    let remedy = format!("{}; or put it on the PATH", Code::Fenicsx.install());
    require(program, "--version", version(program), remedy)
}

/// The version that a program printed, or an error with the reason why there is none.
fn require(program: &Path, option: &str, version: Found<String>, remedy: String) -> Result<String> {
    let why = match version {
        Ok(version) => return Ok(version),
        Err(why) => why,
    };
    check_interrupt()?;
    Err(Error::Missing {
        tool: format!("a working {}", program.display()),
        searched: format!("`{} {option}` {why}", program.display()),
        remedy,
    })
}

/// The version that the CalculiX program prints with `-v`.
pub fn ccx_version(program: &Path) -> Found<String> {
    // It calls that a failure.
    let (out, _) = capture_any(Command::new(program).arg("-v"), VERSION_TIMEOUT)?;
    let line = out.lines().find(|l| l.contains("Version")).ok_or_else(no_version)?;
    Ok(line.trim().trim_start_matches("This is ").to_string())
}

/// The version of the CalculiX `program`.
///
/// # Errors
/// [`Error::Missing`] when it cannot be run.
pub(super) fn require_ccx(program: &Path) -> Result<String> {
    let remedy = format!("{}; or name it with --ccx", Code::Calculix.install());
    require(program, "-v", ccx_version(program), remedy)
}

/// The BLAS library that an interpreter's numpy and PETSc load, as `folder/file`.
pub fn blas(python: &Path) -> Option<String> {
    const PROBE: &str = "\
import os
import dolfinx.fem.petsc
names = {os.path.realpath(line.split()[-1]) for line in open('/proc/self/maps') if 'libblas' in line}
print(min('/'.join(name.split('/')[-2:]) for name in names))
";
    let (out, _) = capture(Command::new(python).args(["-c", PROBE]), IMPORT_TIMEOUT).ok()?;
    out.lines().last().map(str::to_string)
}

/// Whether a BLAS, as [`blas`] names it, is the reference implementation.
pub fn is_slow_blas(name: &str) -> bool {
    name.starts_with("blas/")
}

/// Whether there is a file where a program is named, or on the PATH if it is named alone.
pub fn is_there(program: &Path) -> bool {
    match program.to_str() {
        Some(name) if is_bare(program) => which(name).is_some(),
        _ => program.is_file(),
    }
}

/// The path of a program on the PATH.
pub fn which(program: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(program)).find(|file| file.is_file())
}
