//! Shared parts of the tests that run the program: its start and its files, a folder in which
//! `edgeline fem` runs with the stand-ins of `tests/fake/`, and a count of processes.

use std::collections::HashMap;
use std::fs;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// The program in `folder`, without variables of the environment that it reads.
pub fn edgeline(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_edgeline"));
    command.current_dir(folder).env_remove("EDGELINE_PYTHON").args(arguments).stdin(Stdio::null());
    command
}

/// All that a run printed.
pub fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// A row of a CSV file, by column.
pub type Row = HashMap<String, String>;

pub fn rows(path: &Path) -> Vec<Row> {
    csv::Reader::from_path(path).unwrap().deserialize().map(Result::unwrap).collect()
}

pub fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} of {row:?}"))
}

/// The sorted names in a folder, but for the program's list of them.
pub fn files(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.retain(|name| !(name.starts_with('.') && name.ends_with(".files")));
    names.sort();
    names
}

/// A stand-in of `tests/fake/`.
pub fn fake(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fake").join(name)
}

/// A folder in which `edgeline fem` runs.
pub struct Bench {
    /// The working folder, which contains the run's folder `run`.
    pub folder: TempDir,
}

impl Bench {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    pub fn out(&self) -> PathBuf {
        self.folder.path().join("run")
    }

    /// `edgeline fem` with the real tools.
    pub fn live(&self, case: &str) -> Command {
        let mut command = edgeline(self.folder.path(), &["fem", case, "--out"]);
        interruptible(&mut command);
        command.arg(self.out());
        command
    }

    /// `edgeline fem` with the stand-ins, whose behaviour `mode` selects.
    pub fn fake(&self, mode: &str) -> Command {
        let mut command = self.live("flush-short");
        command
            .arg("--python")
            .arg(fake("python3"))
            .arg("--gmsh")
            .arg(fake("gmsh"))
            .env("FAKE", mode)
            .env("FAKE_NOTES", self.folder.path().join("notes"));
        command
    }

    /// The calls of the stand-in so far.
    pub fn notes(&self) -> Vec<String> {
        let text = fs::read_to_string(self.folder.path().join("notes")).unwrap_or_default();
        text.lines().map(str::to_string).collect()
    }

    /// The results, without the parts that differ between runs.
    pub fn results(&self) -> [String; 2] {
        ["curves.csv", "pressure.csv"].map(|f| fs::read_to_string(self.out().join(f)).unwrap())
    }

    /// Processes of the runs in this folder and below it, without zombies.
    pub fn processes(&self) -> Vec<i32> {
        // A run that was refused at once has made no folder.
        let Ok(out) = self.out().canonicalize() else { return Vec::new() };
        let mark = format!("EDGELINE_RUN={}", out.display());
        let pids = fs::read_dir("/proc").unwrap().flatten();
        pids.filter_map(|entry| entry.file_name().to_str()?.parse().ok())
            .filter(|pid| {
                fs::read(format!("/proc/{pid}/environ")).is_ok_and(|text| {
                    text.split(|&b| b == 0).any(|v| v.starts_with(mark.as_bytes()))
                })
            })
            .collect()
    }

    /// Waits until all processes of this folder's runs have ended.
    pub fn assert_no_process_is_left(&self) {
        let until = Instant::now() + Duration::from_secs(5);
        while !self.processes().is_empty() {
            assert!(Instant::now() < until, "left over: {:?}", self.processes());
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

/// Runs a command that must be refused with exit code 2, and returns the message.
pub fn refused(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{command:?}: {said}");
    assert!(output.stdout.is_empty(), "{command:?} printed results");
    said
}

pub fn succeeded(command: &mut Command) -> Output {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    output
}

pub fn kill(pid: i32, signal: i32) {
    // SAFETY: a plain system call.
    unsafe {
        libc::kill(pid, signal);
    }
}

/// Waits until a condition is true.
pub fn wait_for(what: &str, condition: impl Fn() -> bool) {
    let until = Instant::now() + Duration::from_secs(20);
    while !condition() {
        assert!(Instant::now() < until, "{what} did not happen");
        std::thread::sleep(Duration::from_millis(10));
    }
}

pub fn start(command: &mut Command) -> Child {
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Gives signals their usual effect on a command.
pub fn interruptible(command: &mut Command) {
    // Under nohup or in the background of a script, SIGHUP and SIGINT are ignored. Children
    // inherit that, and edgeline respects it.
    // SAFETY: a plain system call that is async-signal-safe.
    unsafe {
        command.pre_exec(|| {
            for signal in [libc::SIGHUP, libc::SIGINT] {
                libc::signal(signal, libc::SIG_DFL);
            }
            Ok(())
        });
    }
}

/// A running explorer, which is killed with the test.
pub struct Explorer {
    pub child: Child,
    pub link: String,
    pub port: u16,
    pub token: String,
}

impl Explorer {
    pub fn start(folder: &Path, arguments: &[&str]) -> Self {
        let mut command = edgeline(folder, &["explore"]);
        interruptible(&mut command);
        let mut child =
            command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let mut link = String::new();
        let mut output = std::io::BufReader::new(child.stdout.take().unwrap());
        std::io::BufRead::read_line(&mut output, &mut link).unwrap();
        let link = link.trim().to_string();
        let rest = link.strip_prefix("http://127.0.0.1:").unwrap_or_else(|| panic!("{link:?}"));
        let (port, token) = rest.trim_end_matches('/').split_once('/').unwrap();
        assert!(token.len() == 32 && token.bytes().all(|b| b.is_ascii_hexdigit()), "{link}");
        let (port, token) = (port.parse().unwrap(), token.to_string());
        Self { child, link, port, token }
    }

    /// Waits until it has ended.
    pub fn ended(&mut self) -> std::process::ExitStatus {
        let until = Instant::now() + Duration::from_secs(20);
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status;
            }
            assert!(Instant::now() < until, "the explorer goes on");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

impl Drop for Explorer {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
