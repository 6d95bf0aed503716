use std::path::PathBuf;

/// The errors of the library. Each says what went wrong, where, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A value outside its legal range.
    #[error("{key} = {value} is not valid: {reason}; {remedy}")]
    Value {
        /// The key as it stands in the file, e.g. `block.poisson`.
        key: String,
        /// The value found.
        value: String,
        /// Why it is refused.
        reason: String,
        /// What to write instead.
        remedy: String,
    },
    /// A file that does not parse or has illegal content.
    #[error("{}{}: {message}; {remedy}", path.display(), line.map(|l| format!(":{l}")).unwrap_or_default())]
    File {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1, where it is known.
        line: Option<usize>,
        /// What is wrong.
        message: String,
        /// What to do.
        remedy: String,
    },
    /// An error of the solution of a case, with the file of the case.
    #[error("{}: {source}", path.display())]
    Case {
        /// The case file.
        path: PathBuf,
        /// The error.
        source: Box<Error>,
    },
    /// Reading or writing failed.
    #[error("cannot {action} {}: {source}{}", path.display(), remedy(source))]
    Io {
        /// The action that failed, e.g. `read` or `create`.
        action: &'static str,
        /// Where.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// A request that would take more memory than is free.
    #[error("{what} takes about {} GiB of memory, but only {free_gib:.1} GiB are free; {remedy}", gib(*needed_gib))]
    Memory {
        /// The request.
        what: String,
        /// Estimated memory (GiB).
        needed_gib: f64,
        /// Free memory (GiB).
        free_gib: f64,
        /// What to request instead.
        remedy: String,
    },
    /// The contact solver did not converge.
    #[error(
        "contact did not converge after {iterations} iterations (residual {residual:.1e}); {remedy}"
    )]
    NotConverged {
        /// Iterations done.
        iterations: usize,
        /// The remaining residual: on the line of the pressure at its edges (p0), on cells the
        /// relative one.
        residual: f64,
        /// What to do.
        remedy: String,
    },
    /// A calculation that was stopped because nobody waits for it any more.
    #[error("the calculation was stopped: nobody waits for it any more")]
    Stopped,
    /// A solution that violates a law of contact or elasticity.
    #[error("the solution is not sound: {law} is {value:.1e}, more than {limit:.1e}; {remedy}")]
    Unsound {
        /// The quantity measured, with its unit.
        law: &'static str,
        /// Its value.
        value: f64,
        /// The largest value that passes.
        limit: f64,
        /// What to do.
        remedy: String,
    },
    /// Cells that do not cover the contact.
    #[error(
        "the cells, which end at x = {half_width:.4} C, do not cover the contact: {reason}; {remedy}"
    )]
    Uncovered {
        /// Half-width of the region (C).
        half_width: f64,
        /// Half-width (C) up to which bodies are known to touch.
        touched: f64,
        /// How it is known.
        reason: String,
        /// What to do.
        remedy: String,
    },
    /// A child process that failed, hung or wrote invalid output.
    #[error("{program}: {message}\n{log_tail}\n{remedy}")]
    Child {
        /// The program and its stage.
        program: String,
        /// What happened.
        message: String,
        /// The end of its output.
        log_tail: String,
        /// What to do.
        remedy: String,
    },
    /// The process received a signal to stop while a child ran; the child was ended.
    #[error("stopped by signal {signal}; run again to continue")]
    Interrupted {
        /// The signal, e.g. 2 for Ctrl-C.
        signal: i32,
    },
    /// A folder or a file that is in use by another run.
    #[error("{} is in use by another run{}; wait for it, or give another path", path.display(), pid.map(|p| format!(" (process {p})")).unwrap_or_default())]
    Busy {
        /// The folder or the file.
        path: PathBuf,
        /// The other run's process, where it is known.
        pid: Option<u32>,
    },
    /// A tool that is missing.
    #[error("{tool} was not found ({searched}); {remedy}")]
    Missing {
        /// The tool.
        tool: String,
        /// Where it was looked for.
        searched: String,
        /// What to install.
        remedy: String,
    },
}

#[cfg(feature = "cli")]
impl Error {
    /// The error about a number of a case that comes from the `value` of an option.
    pub fn of_option(self, option: &str, value: &str) -> Self {
        match self {
            Self::Value { reason, remedy, .. } => {
                Self::Value { key: option.into(), value: value.into(), reason, remedy }
            }
            other => other,
        }
    }
}

/// The remedy for a system error, where the system's own message gives none.
fn remedy(source: &std::io::Error) -> &'static str {
    use std::io::ErrorKind;
    match source.kind() {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
            "; make room there, or give a folder on another disk, then run again"
        }
        ErrorKind::FileTooLarge => "; allow larger files (ulimit -f), then run again",
        ErrorKind::ReadOnlyFilesystem | ErrorKind::PermissionDenied => {
            "; give another path, or change the permissions there"
        }
        ErrorKind::NotFound => "; check the path, and that nobody removed it meanwhile",
        ErrorKind::IsADirectory => "; give a file, not a folder",
        ErrorKind::AlreadyExists | ErrorKind::NotADirectory => {
            "; a file is in the way: give another path, or move it away"
        }
        _ => "",
    }
}

/// A size as text, with a few digits whatever its magnitude.
fn gib(size: f64) -> String {
    if size < 1e4 { format!("{size:.1}") } else { format!("{size:.1e}") }
}

/// The library's result.
pub type Result<T> = std::result::Result<T, Error>;

/// The larger one of two measures of what is refused beyond a limit; infinite if the second one is
/// not a number, which must not pass as small.
pub(crate) fn worse(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}
