//! Output of the subcommands: results on standard output, everything else on standard error.

use crate::base::{Error, Result};
use crate::report::study_files::pretty;
use serde::Serialize;
use std::io::Write;
use std::path::Path;

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

/// Writes what to beware of to standard error.
pub(super) fn warn(warnings: &[String]) {
    warnings.iter().for_each(|warning| say(&format!("warning: {warning}")));
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

/// The files of a run by their names, in one line. A picture in two formats is named once.
pub(super) fn wrote(names: &[String], folder: &Path) -> String {
    let stem = |name: &str| -> Option<String> {
        Some(name.strip_suffix(".svg").or(name.strip_suffix(".png"))?.to_string())
    };
    let mut shown: Vec<String> = Vec::new();
    for name in names {
        let twin = |other: &&String| *other != name && stem(other) == stem(name);
        let text = match stem(name) {
            Some(stem) if names.iter().any(|other| twin(&other)) => format!("{stem}.{{svg,png}}"),
            _ => name.clone(),
        };
        if !shown.contains(&text) {
            shown.push(text);
        }
    }
    format!("wrote {} into {}", shown.join(", "), folder.display())
}
