//! Child processes with a time limit and a log, which end together with all their own children.
//!
//! A child has its own process group. The kernel kills it when this process dies, even by
//! `kill -9`. A mark in its environment is inherited by its own children. Every process with that
//! mark is killed after the child's end, including MPI ranks, which leave the process group.

use super::signals::{Active, check_interrupt};
use super::system;
use crate::base::{Error, Result};
use rustix::process::{Pid, Signal, getpid, kill_process, kill_process_group};
use std::fs::{self, File};
use std::io::{ErrorKind, Read, Seek, SeekFrom};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// The environment variable that marks all processes of a run; its value is the run's folder.
const MARK: &str = "EDGELINE_RUN";

/// The environment variable that names the driver to the children of a child, as
/// `<boot id>:<process id>`; `lifetime.py` reads it.
const DRIVER: &str = "EDGELINE_DRIVER";

/// Size of a log above which the child is stopped (bytes).
const MAX_LOG_BYTES: u64 = 64 << 20;

/// Time for a child to end after SIGTERM.
const GRACE: Duration = Duration::from_secs(3);

/// A child process and its limits.
pub(crate) struct Stage<'a> {
    /// Its name in messages.
    pub name: &'a str,
    /// The program and its arguments.
    pub command: Command,
    /// The file for its output.
    pub log: PathBuf,
    /// Its time limit.
    pub timeout: Duration,
    /// The option that sets `timeout`, for messages.
    pub timeout_option: &'a str,
    /// Its working folder, which is also the mark of its processes.
    pub folder: &'a Path,
    /// Largest size of that folder (bytes).
    pub max_bytes: u64,
}

impl Stage<'_> {
    /// Runs the child to its end, and returns what `output` reads of the files that it wrote.
    ///
    /// # Errors
    /// [`Error::Child`] with the end of the log when it cannot be started, fails, takes too long,
    /// fills the disk, or ends well without files that `output` takes; [`Error::Interrupted`] when
    /// this process received a request to stop. No process of the child is left in any case.
    pub fn run<T>(mut self, output: impl FnOnce() -> Result<T>) -> Result<T> {
        let _active = Active::new();
        check_interrupt()?;
        let log = File::create(&self.log).and_then(|log| Ok((log.try_clone()?, log)));
        let (out, err) =
            log.map_err(|source| Error::Io { action: "create", path: self.log.clone(), source })?;
        self.command.stdin(Stdio::null()).stdout(out).stderr(err);
        let mut child = spawn(&mut self.command, self.folder).map_err(|e| {
            let program = self.command.get_program().display().to_string();
            self.failed(format!("{program} cannot be started: {e}"), "check the path")
        })?;
        let ended = self.watch(&mut child);
        if ended.is_err() {
            stop(&mut child);
        }
        kill_marked(self.folder);
        let status = ended?;
        let message = if status.success() {
            match output() {
                Ok(output) => return Ok(output),
                Err(error) => format!("ended with exit code 0, but {}", fault(error)),
            }
        } else {
            ending(status)
        };
        Err(self.failed(message, if is_full(self.folder) {
            "no space is left on the disk; make room there, or give a folder on another disk, then run again"
        } else {
            "correct what the log tells, then run again"
        }))
    }

    /// Waits for the end of the child, or for a reason to stop it.
    fn watch(&self, child: &mut Child) -> Result<ExitStatus> {
        let began = Instant::now();
        let mut next_look = Duration::from_secs(1);
        loop {
            match child.try_wait() {
                Ok(Some(status)) => return Ok(status),
                Ok(None) => {}
                Err(e) => {
                    let message = format!("cannot be waited for: {e}");
                    return Err(self.failed(message, "run again"));
                }
            }
            check_interrupt()?;
            let elapsed = began.elapsed();
            if elapsed > self.timeout {
                return Err(self.failed(
                    format!("took longer than {} s and was stopped", self.timeout.as_secs_f64()),
                    format!("allow more time with {}", self.timeout_option),
                ));
            }
            if elapsed > next_look {
                next_look = elapsed + Duration::from_secs(1);
                if fs::metadata(&self.log).is_ok_and(|m| m.len() > MAX_LOG_BYTES) {
                    let message = format!("wrote more than {} MiB of log", MAX_LOG_BYTES >> 20);
                    return Err(self.failed(message, "correct what the log tells, then run again"));
                }
                if size_of(self.folder) > self.max_bytes {
                    return Err(self.failed(
                        format!("filled its folder with more than {} MiB", self.max_bytes >> 20),
                        "allow more with --max-disk, or take a coarser mesh",
                    ));
                }
            }
            // Short stages are not delayed, and long ones are rarely interrupted.
            std::thread::sleep(
                (elapsed / 20).clamp(Duration::from_millis(2), Duration::from_millis(50)),
            );
        }
    }

    fn failed(&self, message: String, remedy: impl Into<String>) -> Error {
        Error::Child {
            program: self.name.to_string(),
            message,
            log_tail: tail(&self.log),
            remedy: format!("{} (the whole log: {})", remedy.into(), self.log.display()),
        }
    }
}

/// How a child ended that did not succeed.
fn ending(status: ExitStatus) -> String {
    match (status.code(), status.signal()) {
        (Some(code), _) => format!("failed with exit code {code}"),
        (None, Some(signal)) if signal == Signal::KILL.as_raw() => {
            "was killed (signal 9), perhaps because memory ran out".to_string()
        }
        (None, signal) => format!("was ended by signal {}", signal.unwrap_or(0)),
    }
}

/// What is wrong with a file that a child was to write, without the remedy of the error: that is
/// for files which somebody gave.
fn fault(error: Error) -> String {
    match error {
        Error::Io { path, source, .. } if source.kind() == ErrorKind::NotFound => {
            format!("did not write {}", path.display())
        }
        Error::Io { path, source, .. } => format!("{} cannot be read: {source}", path.display()),
        Error::File { path, line, message, .. } => {
            let line = line.map(|line| format!(":{line}")).unwrap_or_default();
            format!("{}{line}: {message}", path.display())
        }
        other => other.to_string(),
    }
}

/// What a short command printed on both streams, or in words why it has no such answer: it cannot
/// be started, fails, or takes longer than `timeout`.
pub(crate) type Captured = std::result::Result<(String, String), String>;

/// Runs a short command that is to succeed.
pub(crate) fn capture(command: &mut Command, timeout: Duration) -> Captured {
    let (status, (out, err)) = captured(command, timeout)?;
    if status.success() {
        return Ok((out, err));
    }
    let last = err.lines().rev().find(|line| !line.trim().is_empty());
    let cause = last.map(|line| format!(": {}", plain(line).trim())).unwrap_or_default();
    Err(format!("{}{cause}", ending(status)))
}

/// As [`capture`], whatever the exit code is.
pub(crate) fn capture_any(command: &mut Command, timeout: Duration) -> Captured {
    captured(command, timeout).map(|(_, texts)| texts)
}

/// The exit status and the output of a child, or in words why there are none.
fn captured(
    command: &mut Command,
    timeout: Duration,
) -> std::result::Result<(ExitStatus, (String, String)), String> {
    let _active = Active::new();
    let reader = |stream: Option<Box<dyn Read + Send>>| {
        std::thread::spawn(move || {
            let mut bytes = Vec::new();
            // The output before an error is used; a megabyte is more than any version text.
            let _ = stream.map(|s| s.take(1 << 20).read_to_end(&mut bytes));
            String::from_utf8_lossy(&bytes).into_owned()
        })
    };
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let count = COUNT.fetch_add(1, Ordering::SeqCst);
    let mark = PathBuf::from(format!("probe-{}-{count}", std::process::id()));
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = spawn(command, &mark).map_err(|e| format!("cannot be started: {e}"))?;
    let out = reader(child.stdout.take().map(|s| Box::new(s) as _));
    let err = reader(child.stderr.take().map(|s| Box::new(s) as _));
    let began = Instant::now();
    let status = loop {
        match child.try_wait() {
            Ok(Some(status)) => break Ok(status),
            Ok(None) if check_interrupt().is_err() => break Err("was interrupted".to_string()),
            Ok(None) if began.elapsed() > timeout => {
                break Err(format!("took longer than {} s", timeout.as_secs_f64()));
            }
            Ok(None) => std::thread::sleep(Duration::from_millis(2)),
            Err(e) => break Err(format!("cannot be waited for: {e}")),
        }
    };
    if status.is_err() {
        stop(&mut child);
    }
    kill_marked(&mark);
    // A reader has no reason to panic; it would have no text then.
    let texts = (out.join().unwrap_or_default(), err.join().unwrap_or_default());
    status.map(|status| (status, texts))
}

/// Starts a child in a process group of its own that dies with this process.
fn spawn(command: &mut Command, mark: &Path) -> std::io::Result<Child> {
    let driver = std::process::id();
    let boot = fs::read_to_string("/proc/sys/kernel/random/boot_id").unwrap_or_default();
    command.process_group(0).env(MARK, mark).env(DRIVER, format!("{}:{driver}", boot.trim()));
    system::die_with_this_process(command);
    command.spawn()
}

/// Ends a child and its process group, by SIGTERM first, so that `mpirun` can end its ranks.
fn stop(child: &mut Child) {
    signal_group(child, Signal::TERM);
    let began = Instant::now();
    while began.elapsed() < GRACE {
        if !matches!(child.try_wait(), Ok(None)) {
            break;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    // Members of the group may outlive its leader.
    signal_group(child, Signal::KILL);
    let _ = child.wait();
}

/// Sends a signal to the child's process group. The number cannot belong to another group: the
/// system does not reuse it before the leader is waited for, or while the group has members.
fn signal_group(child: &Child, signal: Signal) {
    // A group that has ended needs no signal.
    let _ = Pid::from_raw(child.id() as i32).map(|pid| kill_process_group(pid, signal));
}

/// Kills all processes with the mark of the run in `folder`, until there are none.
pub(crate) fn kill_marked(folder: &Path) {
    use std::os::unix::ffi::OsStrExt;
    let mut wanted = format!("{MARK}=").into_bytes();
    wanted.extend(folder.as_os_str().as_bytes());
    for _ in 0..200 {
        let found = marked(&wanted);
        if found.is_empty() {
            return;
        }
        for pid in found {
            // A process that has ended needs no signal.
            let _ = kill_process(pid, Signal::KILL);
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Processes other than this one that have `wanted` in their environment.
fn marked(wanted: &[u8]) -> Vec<Pid> {
    let own = getpid();
    let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
    entries
        .filter_map(|entry| Pid::from_raw(entry.file_name().to_str()?.parse().ok()?))
        .filter(|&pid| pid != own)
        // The environment of other users' processes cannot be read, and they are not children.
        .filter(|pid| {
            fs::read(format!("/proc/{}/environ", pid.as_raw_pid()))
                .is_ok_and(|text| text.split(|&b| b == 0).any(|variable| variable == wanted))
        })
        .collect()
}

/// The end of a log for a message.
fn tail(log: &Path) -> String {
    const BYTES: u64 = 4096;
    const LINES: usize = 12;
    let read = || -> std::io::Result<Vec<u8>> {
        let mut file = File::open(log)?;
        let length = file.metadata()?.len();
        file.seek(SeekFrom::Start(length.saturating_sub(BYTES)))?;
        let mut bytes = Vec::new();
        file.take(BYTES).read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let text = String::from_utf8_lossy(&read().unwrap_or_default()).into_owned();
    let lines: Vec<String> = text.lines().map(|line| format!("  | {}", plain(line))).collect();
    match lines.len() {
        0 => "  (it printed nothing)".to_string(),
        n => lines[n.saturating_sub(LINES)..].join("\n"),
    }
}

/// A line without a child's control characters, which must not reach the user's terminal.
fn plain(line: &str) -> String {
    line.replace(|c: char| c.is_control(), " ")
}

/// Whether the disk of a folder is almost full. A child that stopped for this reason has an empty
/// log.
fn is_full(folder: &Path) -> bool {
    let probe = folder.join(".probe");
    let written = fs::write(&probe, vec![0; 1 << 20]);
    let _ = fs::remove_file(&probe);
    written.is_err_and(|e| e.kind() == std::io::ErrorKind::StorageFull)
}

/// Bytes of all files below a folder, without those that vanish meanwhile.
fn size_of(folder: &Path) -> u64 {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries
        .map(|entry| match entry.metadata() {
            Ok(data) if data.is_dir() => size_of(&entry.path()),
            Ok(data) => data.len(),
            Err(_) => 0,
        })
        .sum()
}
