//! `edgeline extras`: what shells, manuals and editors take of the program.

use super::output::{Exit, print};
use super::reference::markdown;
use crate::base::Result;
use crate::case::case_schema;
use crate::host::{Lock, write_set};
use crate::report::study_files::pretty;
use crate::solve::{CellDetails, Details, Summary};
use clap::{Args, Command, ValueHint};
use clap_complete::Shell;
use clap_mangen::Man;
use schemars::JsonSchema;
use std::path::PathBuf;

/// Writes shell completions, manual pages, JSON Schemas and the reference.
///
/// Writes the completions for bash, fish and zsh, a manual page for each command, the schemas of
/// case files (case.schema.json) and of `solve`'s summary.json (summary.schema.json), and every
/// key, option, file and column as Markdown (reference.md) into the output folder. Takes less than
/// a second.
#[derive(Args)]
pub(super) struct Arguments {
    /// Folder for the files; made if it is not there
    #[arg(long, default_value = "extras", value_hint = ValueHint::DirPath)]
    out: PathBuf,
}

/// The `details` of a summary, by its engine.
#[derive(JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "only the schema is taken")]
enum EngineDetails {
    Line(Box<Details>),
    Cells(CellDetails),
}

/// Writes what belongs to `program`.
pub(super) fn run(arguments: Arguments, mut program: Command) -> Result<Exit> {
    program.build();
    let name = program.get_name().to_string();
    let mut files = Vec::new();
    for (file, shell) in [
        (format!("{name}.bash"), Shell::Bash),
        (format!("{name}.fish"), Shell::Fish),
        (format!("_{name}"), Shell::Zsh),
    ] {
        let mut text = Vec::new();
        clap_complete::generate(shell, &mut program, &name, &mut text);
        files.push((file, text));
    }
    let subcommands = program.get_subcommands().filter(|command| command.get_name() != "help");
    for command in std::iter::once(&program).chain(subcommands) {
        let title = command.get_display_name().unwrap_or(&name).to_string();
        let mut text = Vec::new();
        Man::new(command.clone())
            .title(&title)
            .render(&mut text)
            .expect("a vector takes all bytes");
        files.push((format!("{title}.1"), text));
    }
    let mut summary = schemars::schema_for!(Summary<EngineDetails>);
    summary.insert("title".into(), "summary.json of edgeline solve".into());
    let described = serde_json::to_value(&summary).expect("a schema is JSON");
    files.push(("reference.md".into(), markdown(&program, &described)?.into_bytes()));
    files.push(("summary.schema.json".into(), pretty(&summary).into_bytes()));
    files.push(("case.schema.json".into(), pretty(&case_schema()).into_bytes()));
    let _lock = Lock::claim(&arguments.out)?;
    write_set(&arguments.out, &files)?;
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    print(&format!("wrote {} into {}\n", names.join(", "), arguments.out.display()))?;
    Ok(Exit::Done)
}
