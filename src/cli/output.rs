//! Output of the subcommands: results on standard output, everything else on standard error.

use crate::base::{Error, Result};
use crate::report::study_files::pretty;
use serde::Serialize;
use std::io::Write;

/// How a subcommand ended that could run.
pub(super) enum Exit {
    /// Success.
    Done,
    /// Success, but an accuracy gate does not hold.
    GateFailed,
}

/// Writes a message to standard error. The program does not fail if that is impossible.
pub(super) fn say(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// Prints to standard output. A closed pipe (`edgeline ... | head -1`) is not an error, because the
/// results are in the files.
pub(super) fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Error::Io { action: "write to", path: "standard output".into(), source: e })
        }
        _ => Ok(()),
    }
}

/// Prints a JSON value as the only thing on standard output.
pub(super) fn print_json(value: &impl Serialize) -> Result<()> {
    print(&pretty(value))
}
