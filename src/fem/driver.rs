//! One case on one mesh with gmsh and FEniCSx, as child processes.
//!
//! Each run has its own folder. The subfolder `work/` holds the input, output and logs of the child
//! processes. When the results have been checked they take the place of those beside it in one
//! step, `request.key` last, which has the request's key and the results' check sums. A run that
//! was stopped continues at its unfinished stage: each stage writes its JSON file last,
//! `work/request.key` tells whether the files belong to the same request, and `work/mesh.key`
//! whether the meshes are whole.

use super::code::Code;
use super::jit_cache;
use super::request::Request;
use super::result::{MeshResult, MeshSummary, ResultTexts};
use super::settings::{FemSettings, LinearSolver};
use super::sum::{sha256, sha256_of};
use super::tools::{self, Interpreter};
use crate::base::{Error, Result};
use crate::case::Case;
use crate::host::{
    Lock, Stage, check_memory, check_not_given, kill_marked, make_folder, prepare_folder,
    read_text, remove_folder, remove_if_there, write_set_over, write_whole,
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
    pub fn new(mut settings: FemSettings) -> Result<Self> {
        settings.ccx = tools::from_here(&settings.ccx);
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
    pub fn without_solver(mut settings: FemSettings) -> Result<Self> {
        settings.gmsh = tools::from_here(&settings.gmsh);
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
        let versions = vec![tools::require_gmsh(&settings.gmsh, settings.code)?];
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
    /// each stage. On failure what was there stays as it is, and all files that help to find the
    /// cause are kept in `work/`.
    ///
    /// # Errors
    /// [`Error::Value`] about a scene that the code does not take, [`Error::Busy`] when another run
    /// uses the folder, [`Error::Child`] when a stage fails, takes too long or writes invalid
    /// output, [`Error::File`] when the folder has a `work` of somebody else or a file that was
    /// given to this run has the name of a result, [`Error::Interrupted`] when this process was
    /// asked to stop, [`Error::Io`] when a file cannot be written.
    pub fn run(&self, case: &Case, folder: &Path, progress: &dyn Fn(&str)) -> Result<MeshResult> {
        self.settings.code.check(case)?;
        let (folder, _lock) = &claim(folder)?;
        let run = Run::new(self, case, folder);
        if is_whole(&run.key, folder, &RESULTS, KEY)
            && let Ok(result) = run.result(folder)
        {
            progress("done already");
            return Ok(result);
        }
        check_not_given(folder, RESULTS.iter().chain(&LOGS).chain([&KEY]))?;
        run.prepare()?;
        run.mesh(progress)?;
        let result = run.solve(progress)?;
        let mut files = run.files(&RESULTS)?;
        files.extend(run.logs());
        files.push((KEY, check_sums(&run.key, &run.work, &RESULTS)?.into_bytes()));
        // A summary is that of another run, whose curves give way to these.
        write_set_over(folder, &files, &["fem.json", "summary.json"])?;
        jit_cache::keep(&run.cache());
        if !self.settings.keep {
            remove_folder(&run.work)?;
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
        let run = Run::new(self, case, folder);
        run.prepare()?;
        let summary = run.mesh(progress)?;
        progress("writing the deck");
        let python = Command::new(&self.interpreter.path);
        let timeout = self.settings.mesh_timeout;
        let deck = || run.files(&DECK_FILES);
        let deck = run.stage("deck", python, timeout, "--mesh-timeout", deck)?;
        // Its last file marks the deck as complete.
        let files: Vec<_> = run.logs().chain(deck).collect();
        // The meshes of results give way to these.
        write_set_over(folder, &files, &["fem.json"])?;
        remove_folder(&run.work)?;
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

/// The results of a run, the one that says that they are complete last.
const RESULTS: [&str; 5] = ["curves.csv", "pressure.csv", "mesh.json", "request.json", "fem.json"];

/// The logs of the stages.
const LOGS: [&str; 3] = ["mesh.log", "deck.log", "solve.log"];

/// The file beside results, and in the working folder, that says to which request they belong.
const KEY: &str = "request.key";

/// What the mesh stage writes.
const MESHES: [&str; 3] = ["block.msh", "roller.msh", "mesh.json"];

/// The file in the working folder that says that the meshes of a request are whole.
const MESH_KEY: &str = "mesh.key";

/// The `key` of a request, and below it the check sums of the files `names` in `folder`.
fn check_sums(key: &str, folder: &Path, names: &[&str]) -> Result<String> {
    let mut text = key.to_string();
    for name in names {
        let path = folder.join(name);
        let sum = sha256_of(&path).map_err(|source| Error::Io { action: "read", path, source })?;
        text += &format!("{sum}  {name}\n");
    }
    Ok(text)
}

/// Whether the files `names` in `folder` are those of the request with `key`, and as they were when
/// the file `mark` beside them was written.
fn is_whole(key: &str, folder: &Path, names: &[&str], mark: &str) -> bool {
    let known = read(&folder.join(mark)).ok();
    known.is_some() && known == check_sums(key, folder, names).ok()
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
    /// The text of the request, and its key.
    request: String,
    key: String,
}

impl<'a> Run<'a> {
    fn new(driver: &'a Driver, case: &'a Case, folder: &'a Path) -> Self {
        let (request, key) = driver.request(case);
        Self { driver, case, folder, work: folder.join("work"), request, key }
    }

    /// Prepares the working folder and keeps the files of the same request.
    fn prepare(&self) -> Result<()> {
        let marker = self.work.join(KEY);
        if self.work.exists() && !marker.exists() {
            return Err(Error::File {
                path: self.work.clone(),
                line: None,
                message: "was not made by this program, which would work there".into(),
                remedy: "give another --out, or move it away".into(),
            });
        }
        if read(&marker).ok().as_ref() != Some(&self.key) {
            remove_folder(&self.work)?;
            // Without its marker the folder would be taken for somebody else's.
            make_folder(&self.work, KEY, &self.key)?;
        }
        let package = self.work.join("package/edgeline_fem");
        prepare_folder(&package)?;
        for (name, source) in SOURCES {
            write_whole(&package.join(name), source)?;
        }
        // Incomplete entries of an earlier run would block the compilation.
        remove_if_there(&self.work.join("cache"))?;
        jit_cache::seed(&self.cache());
        write_whole(&self.work.join("request.json"), &self.request)
    }

    fn cache(&self) -> PathBuf {
        self.work.join("cache/fenics")
    }

    /// Makes the meshes, unless they are there and whole; refuses those whose equations do not fit
    /// into memory.
    fn mesh(&self, progress: &dyn Fn(&str)) -> Result<MeshSummary> {
        let done = self.work.join("mesh.json");
        let parse = || read(&done).and_then(|text| MeshSummary::parse(&text, &done));
        let meshes = if is_whole(&self.key, &self.work, &MESHES, MESH_KEY) {
            progress("meshes are there already");
            parse()?
        } else {
            progress("meshing");
            let python = Command::new(&self.driver.interpreter.path);
            let timeout = self.driver.settings.mesh_timeout;
            let made = || Ok((parse()?, check_sums(&self.key, &self.work, &MESHES)?));
            let (meshes, sums) = self.stage("mesh", python, timeout, "--mesh-timeout", made)?;
            write_whole(&self.work.join(MESH_KEY), sums)?;
            meshes
        };
        let unknowns = meshes.unknowns as f64;
        check_memory(
            &format!("solving for {unknowns:.1e} unknowns"),
            self.driver.settings.linear.bytes(unknowns),
            "take a coarser mesh with a larger --size, or --linear iterative",
        )?;
        Ok(meshes)
    }

    fn solve(&self, progress: &dyn Fn(&str)) -> Result<MeshResult> {
        let done = self.work.join("fem.json");
        if done.is_file() {
            if let Ok(result) = self.result(&self.work) {
                progress("solved already");
                return Ok(result);
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
        let solved = || self.result(&self.work);
        self.stage("solve", command, settings.solve_timeout, "--solve-timeout", solved)
    }

    /// Runs a stage of the finite-element program, and returns what `output` reads of its files.
    fn stage<T>(
        &self,
        stage: &str,
        mut command: Command,
        timeout: Duration,
        timeout_option: &str,
        output: impl FnOnce() -> Result<T>,
    ) -> Result<T> {
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
            log: self.work.join(format!("{stage}.log")),
            timeout,
            timeout_option,
            folder: self.folder,
            max_bytes: self.driver.settings.max_bytes,
        };
        stage.run(output)
    }

    /// The content of the files `names` in the working folder.
    fn files(&self, names: &[&'static str]) -> Result<Vec<(&'static str, Vec<u8>)>> {
        let mut files = Vec::new();
        for name in names {
            let path = self.work.join(name);
            let content = std::fs::read(&path).map_err(|source| Error::Io {
                action: "read",
                path,
                source,
            })?;
            files.push((*name, content));
        }
        Ok(files)
    }

    /// The logs of the stages that have one.
    fn logs(&self) -> impl Iterator<Item = (&'static str, Vec<u8>)> {
        let log = |name| Some((name, std::fs::read(self.work.join(name)).ok()?));
        LOGS.into_iter().filter_map(log)
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
