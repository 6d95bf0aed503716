//! `edgeline explore`: a page in the browser.

use super::output::{Exit, print, say};
use crate::base::Result;
use crate::case::find_case;
use crate::explore::serve;
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// Shows a case in the browser: change it, and see pressures and stresses of all models.
///
/// Prints a link for the browser on this machine, and answers it until Ctrl-C or until the page is
/// closed. Nobody else is answered: the link has a secret word, and the port is open to this
/// machine alone. Writes nothing; the page offers files for download. Takes some hundredths of a
/// second for each change.
#[derive(Args)]
pub(super) struct Arguments {
    /// A case file, or the name of a case that `edgeline cases` lists
    #[arg(default_value = "flush-short", value_hint = ValueHint::FilePath)]
    pub(super) case: PathBuf,
    /// Port of 127.0.0.1; any free one by default
    #[arg(long, default_value_t = 0, hide_default_value = true)]
    port: u16,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit> {
    let case = find_case(&arguments.case)?;
    case.check_force("the page changes forces")?;
    case.check_smooth("the page solves along a line, where bodies are smooth")?;
    let explorer = serve(case, arguments.port)?;
    print(&format!("{}\n", explorer.link()))?;
    say(
        "open this link in the browser of this machine; Ctrl-C or closing the page ends the program",
    );
    explorer.run();
    say("the page was closed");
    Ok(Exit::Done)
}
