//! One case on one mesh with gmsh and FEniCSx, as child processes.
//!
//! Each run has its own folder. The subfolder `work/` holds the input and output of the child
//! processes. When the results have been checked they are moved beside it, `fem.json` last. A run
//! that was stopped continues at its unfinished stage: each stage writes its JSON file last, and
//! `work/request.key` tells whether the files belong to the same request.

use super::code::Code;
use super::jit_cache;
use super::request::Request;
use super::result::{MeshResult, MeshSummary, ResultTexts};
use super::settings::{FemSettings, LinearSolver};
use super::sum::sha256;
use super::tools::{self, Interpreter};
use crate::base::{Error, Result};
use crate::case::Case;
use crate::host::{
    Lock, Stage, check_memory, kill_marked, prepare_folder, read_text, remove_if_there,
    remove_marker, write_set, write_whole,
};
use std::ffi::OsString;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// The sources of the finite-element program: name and text.
const SOURCES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/fem_sources.rs"));

/// Smallest number of unknowns on a mesh of relative size 1; it grows as size^-2.7.
const UNKNOWNS_OF_SIZE_1: f64 = 200e3;

/// Runs finite-element models with tools that were found and tested.
pub struct Driver {
    settings: FemSettings,
    interpreter: Interpreter,
    /// What gmsh and CalculiX say of their versions.
    versions: Vec<String>,
}

impl Driver {
    /// Finds the tools.
    ///
    /// # Errors
    /// [`Error::Missing`] if gmsh, a suitable interpreter or, for several ranks, mpirun is missing;
    /// [`Error::Value`] if a setting is not legal.
    pub fn new(settings: FemSettings) -> Result<Self> {
        let ccx = match settings.code {
            Code::Calculix => Some(tools::require_ccx(&settings.ccx)?),
            Code::Fenicsx => None,
        };
        let mut driver = Self::without_solver(settings)?;
        driver.versions.extend(ccx);
        Ok(driver)
    }

    /// The same for decks, which are written and not solved.
    ///
    /// # Errors
    /// As [`Driver::new`].
    pub fn without_solver(settings: FemSettings) -> Result<Self> {
        let (low, high) = FemSettings::SIZE_RANGE;
        let refuse = |key: &str, value: String, reason: String, remedy: &str| {
            Err(Error::Value { key: key.into(), value, reason, remedy: remedy.into() })
        };
        if !(low..=high).contains(&settings.size) {
            let reason = format!("the relative element size lies between {low} and {high}");
            return refuse("size", settings.size.to_string(), reason, "1 is the production mesh");
        }
        if settings.ranks == 0 {
            return refuse("ranks", "0".into(), "at least one process has to run".into(), "give 1");
        }
        if settings.code == Code::Calculix
            && (settings.ranks, settings.linear) != (1, LinearSolver::Direct)
        {
            let (key, value) = ("engine", settings.code.name().to_string());
            let reason = "CalculiX runs as one process with its own direct solver".to_string();
            return refuse(key, value, reason, "leave out --ranks and --linear");
        }
        let processors = std::thread::available_parallelism().map_or(1, NonZero::get);
        if settings.ranks > processors {
            let reason = format!("it is more than this machine has processors, {processors}");
            let remedy = "give at most as many; more of them only wait for each other";
            return refuse("ranks", settings.ranks.to_string(), reason, remedy);
        }
        // Refuses a mesh that is too large for this machine before it is made.
        check_memory(
            &format!("a mesh of size {}", settings.size),
            settings.linear.bytes(UNKNOWNS_OF_SIZE_1 * settings.size.powf(-2.7)),
            "take a coarser mesh with a larger --size",
        )?;
        for (key, program) in [("gmsh", &settings.gmsh), ("ccx", &settings.ccx)] {
            if program.to_str().is_none() {
                let reason = "a path that is not UTF-8 cannot be handed on".to_string();
                let remedy = "give another path to the program";
                return refuse(key, program.display().to_string(), reason, remedy);
            }
        }
        let versions = vec![tools::require_gmsh(&settings.gmsh)?];
        if settings.ranks > 1 {
            tools::require_mpirun()?;
        }
        let interpreter = tools::find_interpreter(settings.python.as_deref(), settings.code)?;
        Ok(Self { settings, interpreter, versions })
    }

    /// The interpreter that runs the model.
    pub fn interpreter(&self) -> &Interpreter {
        &self.interpreter
    }

    /// Solves `case` in `folder`, or takes the result from there if the same request has been
    /// solved before. `progress` receives messages on the state of the run.
    ///
    /// Leaves `curves.csv`, `pressure.csv`, `mesh.json`, `request.json`, `fem.json` and the log of
    /// each stage. On failure all files that help to find the cause are kept.
    ///
    /// # Errors
    /// [`Error::Value`] about a scene that the code does not take, [`Error::Busy`] when another run
    /// uses the folder, [`Error::Child`] when a stage fails or takes too long, [`Error::File`] when
    /// its output is invalid or the folder has a `work` of somebody else, [`Error::Interrupted`]
    /// when this process was asked to stop, [`Error::Io`] when a file cannot be written.
    pub fn run(&self, case: &Case, folder: &Path, progress: &dyn Fn(&str)) -> Result<MeshResult> {
        self.settings.code.check(case)?;
        let (folder, _lock) = &claim(folder)?;
        let (text, key) = self.request(case);
        let run = Run { driver: self, case, folder, work: folder.join("work") };
        if read(&folder.join("request.key")).is_ok_and(|known| known == key)
            && let Ok(result) = run.result(folder)
        {
            progress("done already");
            return Ok(result);
        }
        // A summary is that of another run, whose curves give way to these.
        remove_marker(folder, "summary.json")?;
        // In this order, so that a run killed here does not look finished.
        for name in ["request.key", "fem.json", "mesh.json", "curves.csv", "pressure.csv"] {
            remove_if_there(&folder.join(name))?;
        }
        run.prepare(&text, &key)?;
        run.mesh(progress)?;
        run.solve(progress)?;
        let result = run.result(&run.work)?;
        let mut files = Vec::new();
        for name in ["curves.csv", "pressure.csv", "mesh.json", "request.json", "fem.json"] {
            files.push((name, read(&run.work.join(name))?.into_bytes()));
        }
        write_set(folder, &files)?;
        write_whole(&folder.join("request.key"), key)?;
        jit_cache::keep(&run.cache());
        if !self.settings.keep {
            remove_if_there(&run.work)?;
        }
        Ok(result)
    }

    /// Writes the input deck of `case` and its meshes into `folder`; `progress` as in
    /// [`Driver::run`].
    ///
    /// # Errors
    /// As [`Driver::run`].
    pub fn deck(&self, case: &Case, folder: &Path, progress: &dyn Fn(&str)) -> Result<MeshSummary> {
        self.settings.code.check(case)?;
        let (folder, _lock) = &claim(folder)?;
        let (text, key) = self.request(case);
        let run = Run { driver: self, case, folder, work: folder.join("work") };
        run.prepare(&text, &key)?;
        run.mesh(progress)?;
        progress("writing the deck");
        let python = Command::new(&self.interpreter.path);
        run.stage("deck", python, self.settings.mesh_timeout, "--mesh-timeout")?;
        let mut files = Vec::new();
        for name in DECK_FILES {
            let path = run.work.join(name);
            let bytes = std::fs::read(&path).map_err(|source| Error::Io {
                action: "read",
                path: path.clone(),
                source,
            })?;
            files.push((name, bytes));
        }
        write_set(folder, &files)?;
        let done = run.work.join("mesh.json");
        let summary = MeshSummary::parse(&read(&done)?, &done)?;
        remove_if_there(&run.work)?;
        Ok(summary)
    }

    /// The text of the request for `case`, and its key.
    fn request(&self, case: &Case) -> (String, String) {
        let request = Request::new(case, &self.settings);
        let text = serde_json::to_string_pretty(&request).expect("plain data");
        let key = self.key(&text);
        (text, key)
    }

    /// The key that ties files to a request: everything that the result depends on.
    fn key(&self, request: &str) -> String {
        let mut text = request.to_string();
        text += &format!("{:?} {:?} {}", self.interpreter, self.versions, self.settings.ranks);
        for (name, source) in SOURCES {
            text += name;
            text += source;
        }
        format!("{}\n", sha256(&text))
    }
}

/// The files of a deck, the one that includes others last.
pub const DECK_FILES: [&str; 9] = [
    "request.json",
    "block.msh",
    "roller.msh",
    "block.vtu",
    "roller.vtu",
    "mesh.json",
    "mesh.inp",
    "bodies.inp",
    "model.inp",
];

/// Makes a folder, and claims it for this process: its full path, and the lock.
fn claim(folder: &Path) -> Result<(PathBuf, Lock)> {
    // Before anything is made there.
    search_path(&std::path::absolute(folder).unwrap_or_else(|_| folder.to_path_buf()))?;
    let lock = Lock::claim(folder)?;
    // The mark of the processes must not depend on how the folder is named.
    let folder = folder.canonicalize().map_err(|source| Error::Io {
        action: "find",
        path: folder.to_path_buf(),
        source,
    })?;
    // The process of an earlier run is dead; so are its children, unless the kernel cannot tell.
    kill_marked(&folder);
    Ok((folder, lock))
}

/// Where the interpreter looks for modules: below `folder` first.
///
/// # Errors
/// [`Error::Value`] for a folder whose name a search path cannot hold.
fn search_path(folder: &Path) -> Result<OsString> {
    let mut path = vec![folder.join("work/package")];
    if let Some(more) = std::env::var_os("PYTHONPATH") {
        path.extend(std::env::split_paths(&more));
    }
    std::env::join_paths(path).map_err(|e| Error::Value {
        key: "--out".into(),
        value: folder.display().to_string(),
        reason: format!("Python's search path cannot hold it: {e}"),
        remedy: "choose an output folder without that character".into(),
    })
}

/// One run in progress.
struct Run<'a> {
    driver: &'a Driver,
    case: &'a Case,
    folder: &'a Path,
    /// The working folder of the child processes.
    work: PathBuf,
}

impl Run<'_> {
    /// Prepares the working folder and keeps the files of the same request.
    fn prepare(&self, request: &str, key: &str) -> Result<()> {
        let marker = self.work.join("request.key");
        if self.work.exists() && !marker.exists() {
            return Err(Error::File {
                path: self.work.clone(),
                line: None,
                message: "was not made by this program, which would work there".into(),
                remedy: "give another --out, or move it away".into(),
            });
        }
        if read(&marker).ok().as_deref() != Some(key) {
            remove_if_there(&self.work)?;
        }
        // First of all: without it the folder would be taken for somebody else's.
        prepare_folder(&self.work)?;
        write_whole(&marker, key)?;
        let package = self.work.join("package/edgeline_fem");
        prepare_folder(&package)?;
        for (name, source) in SOURCES {
            write_whole(&package.join(name), source)?;
        }
        // Incomplete entries of an earlier run would block the compilation.
        remove_if_there(&self.work.join("cache"))?;
        jit_cache::seed(&self.cache());
        write_whole(&self.work.join("request.json"), request)
    }

    fn cache(&self) -> PathBuf {
        self.work.join("cache/fenics")
    }

    fn mesh(&self, progress: &dyn Fn(&str)) -> Result<()> {
        let done = self.work.join("mesh.json");
        let read = || read(&done).and_then(|text| MeshSummary::parse(&text, &done));
        if let Ok(meshes) = read() {
            progress("meshes are there already");
            return self.check_memory(meshes);
        }
        progress("meshing");
        let python = Command::new(&self.driver.interpreter.path);
        let timeout = self.driver.settings.mesh_timeout;
        self.stage("mesh", python, timeout, "--mesh-timeout")?;
        self.check_memory(read()?)
    }

    /// Refuses meshes whose equations do not fit into memory.
    fn check_memory(&self, meshes: MeshSummary) -> Result<()> {
        let unknowns = meshes.unknowns as f64;
        check_memory(
            &format!("solving for {unknowns:.1e} unknowns"),
            self.driver.settings.linear.bytes(unknowns),
            "take a coarser mesh with a larger --size, or --linear iterative",
        )
    }

    fn solve(&self, progress: &dyn Fn(&str)) -> Result<()> {
        let done = self.work.join("fem.json");
        if done.is_file() {
            if self.result(&self.work).is_ok() {
                progress("solved already");
                return Ok(());
            }
            remove_if_there(&done)?;
        }
        progress("solving");
        let settings = &self.driver.settings;
        let python = &self.driver.interpreter.path;
        let command = if settings.ranks == 1 {
            Command::new(python)
        } else {
            let mut mpirun = Command::new("mpirun");
            mpirun.arg("-n").arg(settings.ranks.to_string()).arg(python);
            // Open MPI refuses both by default, and containers are run as root.
            for variable in ["OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"] {
                mpirun.env(variable, "1");
            }
            mpirun.env("OMPI_MCA_rmaps_base_oversubscribe", "1");
            // Waiting ranks would otherwise block the cores that they share with others.
            mpirun.env("OMPI_MCA_mpi_yield_when_idle", "1");
            mpirun
        };
        self.stage("solve", command, settings.solve_timeout, "--solve-timeout")
    }

    /// Runs a stage of the finite-element program.
    fn stage(
        &self,
        stage: &str,
        mut command: Command,
        timeout: Duration,
        timeout_option: &str,
    ) -> Result<()> {
        let path = search_path(self.folder)?;
        command
            .args(["-m", "edgeline_fem", stage])
            .arg(self.work.join("request.json"))
            .arg(&self.work)
            .current_dir(&self.work)
            .env("PYTHONPATH", path)
            .env("PYTHONUNBUFFERED", "1")
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .env("XDG_CACHE_HOME", self.work.join("cache"));
        let stage = Stage {
            name: &format!("{}, stage {stage}", self.case.name),
            command,
            log: self.folder.join(format!("{stage}.log")),
            timeout,
            timeout_option,
            folder: self.folder,
            max_bytes: self.driver.settings.max_bytes,
        };
        stage.run()
    }

    /// Reads and checks the result in `folder`.
    fn result(&self, folder: &Path) -> Result<MeshResult> {
        let [summary, curves, pressure] =
            ["fem.json", "curves.csv", "pressure.csv"].map(|name| read(&folder.join(name)));
        let (summary, curves, pressure) = (summary?, curves?, pressure?);
        let texts = ResultTexts { summary: &summary, curves: &curves, pressure: &pressure };
        let settings = &self.driver.settings;
        MeshResult::parse(self.case, settings.size, settings.ranks, texts, folder)
    }
}

/// Size limit of a file from a child (bytes), far above that of any correct one.
const MAX_RESULT_BYTES: u64 = 256 << 20;

/// Reads a text file written by a child.
fn read(path: &Path) -> Result<String> {
    read_text(
        path,
        MAX_RESULT_BYTES,
        "the file was not written by this version; remove it and run again",
    )
}
