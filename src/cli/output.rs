//! What subcommands say: results on standard output, everything else on standard error.

use crate::base::{Error, Result};
use crate::report::study_files::pretty;
use serde::Serialize;
use std::io::Write;

/// What a subcommand that ran to its end has to say.
pub(super) enum Exit {
    /// All was done.
    Done,
    /// All was done, and an accuracy gate does not hold.
    GateFailed,
}

/// Says something on standard error. That it cannot be said is no reason to fail.
pub(super) fn say(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// Prints to standard output. That nobody reads on (`edgeline ... | head -1`) is no error: the
/// files are what counts.
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
