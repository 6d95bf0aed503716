//! The program: its subcommands and exit codes.

use super::output::{Exit, say};
use super::{
    bench, cases, compare, deck, design, doctor, explore, extras, fatigue, fem, gate, report,
    solve, study, sweep,
};
use crate::base::Result;
use crate::case::Case;
use crate::host::let_large_files_fail;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

/// Contact pressure and stresses at the ends of finite line contacts: a semi-analytical solver, and
/// finite-element models that verify it.
///
/// Results go to files and a short summary to standard output; progress and warnings go to
/// standard error. Only one run at a time can use a folder. What an earlier run of the same command
/// wrote there and the new one does not is removed; files of other commands may stay: give each its
/// own folder. No result takes the place of a file that was given.
/// The exit code is 0 for success, 1 if a gate of `gate` does not hold or `compare` finds curves
/// too far apart, and 2 if the command could not run: bad input, a missing tool, a failed child
/// process.
#[derive(Parser)]
#[command(name = "edgeline", version, arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Solve(solve::Arguments),
    Fatigue(fatigue::Arguments),
    Explore(explore::Arguments),
    Fem(fem::Arguments),
    Deck(deck::Arguments),
    Study(study::Arguments),
    Sweep(sweep::Arguments),
    Design(design::Arguments),
    Compare(compare::Arguments),
    Gate(gate::Arguments),
    Bench(bench::Arguments),
    Report(report::Arguments),
    Cases(cases::Arguments),
    Doctor(doctor::Arguments),
    Extras(extras::Arguments),
}

/// The command line. A negative number is the value of the option before it, which says what is
/// wrong with it, and no option itself.
fn command() -> clap::Command {
    Arguments::command().mut_subcommands(|command| {
        command.mut_args(|option| match option.get_value_delimiter() {
            Some(_) => option.allow_hyphen_values(true),
            None if option.get_action().takes_values() => option.allow_negative_numbers(true),
            None => option,
        })
    })
}

/// What `run` does with the case at `path`; an error about the case names its file and line.
fn on_case(path: &Path, run: impl FnOnce() -> Result<Exit>) -> Result<Exit> {
    run().map_err(|e| Case::place(path, e))
}

/// Runs the program with `arguments`, the program's name first, and returns its exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let parsed = command().try_get_matches_from(arguments);
    let parsed = parsed.and_then(|mut matches| Arguments::from_arg_matches_mut(&mut matches));
    let arguments = match parsed {
        Ok(arguments) => arguments,
        Err(e) => {
            // Help and version are not errors and go to standard output.
            let _ = e.print();
            return ExitCode::from(if e.use_stderr() { 2 } else { 0 });
        }
    };
    let_large_files_fail();
    let outcome = match arguments.command {
        Command::Solve(own) => on_case(&own.case, || solve::run(&own)),
        Command::Fatigue(own) => on_case(&own.case, || fatigue::run(&own)),
        Command::Explore(own) => on_case(&own.case, || explore::run(&own)),
        Command::Deck(own) => on_case(&own.case, || deck::run(&own)),
        Command::Fem(own) => on_case(&own.case, || fem::run(&own)),
        Command::Study(arguments) => study::run(arguments),
        Command::Sweep(arguments) => sweep::run(arguments),
        Command::Design(arguments) => design::run(arguments),
        Command::Compare(own) => on_case(&own.case, || compare::run(&own)),
        Command::Gate(arguments) => gate::run(arguments),
        Command::Bench(arguments) => bench::run(arguments),
        Command::Report(arguments) => report::run(arguments),
        Command::Cases(arguments) => cases::run(arguments),
        Command::Doctor(arguments) => doctor::run(arguments),
        Command::Extras(arguments) => extras::run(arguments, command()),
    };
    match outcome {
        Ok(Exit::Done) => ExitCode::SUCCESS,
        Ok(Exit::GateFailed) => ExitCode::from(1),
        Err(e) => {
            say(&format!("error: {e}"));
            ExitCode::from(2)
        }
    }
}
