//! `edgeline cases`: what is built in.

use super::output::{Exit, print};
use crate::base::{Error, Result};
use crate::case::{BUILTIN_CASES, BUILTIN_STUDIES, Case, Study, did_you_mean, find_case};
use clap::Args;
use std::path::Path;

/// Lists the built-in cases and studies, or prints the file of one of them.
///
/// Prints a line for each case, each study and each case of a study's design; with a name the file,
/// to be copied and changed: `edgeline cases flush-short > mine.toml`. Writes no files. Takes some
/// milliseconds.
#[derive(Args)]
pub(super) struct Arguments {
    /// A name of the list
    #[arg(value_name = "NAME")]
    name: Option<String>,
}

pub(super) fn run(arguments: Arguments) -> Result<Exit> {
    print(&match &arguments.name {
        None => list(),
        Some(name) => file(name)?,
    })?;
    Ok(Exit::Done)
}

/// All files that are built in, by name.
fn files() -> impl Iterator<Item = (&'static str, &'static str)> {
    BUILTIN_CASES.into_iter().chain(BUILTIN_STUDIES)
}

/// The text of the file called `name`, or of the file that makes the case of a study.
fn file(name: &str) -> Result<String> {
    match files().find(|(known, _)| *known == name) {
        Some((_, text)) => Ok(text.to_string()),
        None => find_case(Path::new(name)).map(|case| case.to_toml()).map_err(|error| {
            let meant = did_you_mean(name, &BUILTIN_STUDIES.map(|(study, _)| study));
            if meant.is_empty() {
                return error;
            }
            Error::Value {
                key: "NAME".to_string(),
                value: name.to_string(),
                reason: "nothing of this name is built in".to_string(),
                remedy: format!("{meant}`edgeline cases` lists all"),
            }
        }),
    }
}

/// All names, each with what it is.
fn list() -> String {
    let mut rows: Vec<(String, String)> =
        files().map(|(name, text)| (name.to_string(), first_sentence(text))).collect();
    for study in Study::all_built_in() {
        let own = |case: &Case| (format!("{}/{}", study.name, case.name), String::new());
        rows.extend(study.corners.iter().chain(&study.centre).map(own));
    }
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let line = |(name, what): &(String, String)| {
        format!("{name:width$}  {what}").trim_end().to_string() + "\n"
    };
    rows.iter().map(line).collect()
}

/// The first sentence of the comment above a file.
fn first_sentence(text: &str) -> String {
    let comment = text.lines().map_while(|line| line.strip_prefix("# "));
    let comment = comment.collect::<Vec<_>>().join(" ");
    comment.split_once(". ").map_or(comment.clone(), |(first, _)| format!("{first}."))
}
