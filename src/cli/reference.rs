//! The reference as Markdown: every key of a case, every option, every file and its columns, from
//! the code that reads and writes them.

use crate::base::Result;
use crate::base::number::significant;
use crate::body::EdgeModel;
use crate::case::{FLAGS, Form, KEYS, Key, ProfileKind, WORDS, builtin_case};
use crate::report::solution::tables;
use crate::solve::{Options, Point, solve};
use crate::stress::BodyKind;
use clap::{Arg, ArgAction, Command};
use serde_json::Value;
use std::fmt::Write;

/// The reference of `program`, whose summaries have the JSON Schema `summary`.
///
/// # Errors
/// As [`solve`]: a small case is solved for the names of the columns.
pub(super) fn markdown(program: &Command, summary: &Value) -> Result<String> {
    let mut text = format!(
        "# Reference\n\nWritten by `edgeline extras` of version {} from the code itself.\n\n",
        env!("CARGO_PKG_VERSION")
    );
    keys(&mut text);
    commands(&mut text, program);
    files(&mut text, summary)?;
    Ok(text)
}

/// Adds a line.
fn line(text: &mut String, content: std::fmt::Arguments) {
    writeln!(text, "{content}").expect("a string takes every text");
}

/// Text within a cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ").replace('<', "&lt;")
}

/// The least and the largest legal value. A limit that is no round number belongs to what is less.
fn limits((low, high): (f64, f64)) -> String {
    let [least, largest] = [low, high].map(|value| significant(value, 4));
    match largest.parse() == Ok(high) {
        true => format!("{least}, {largest}"),
        false => format!("{least}, less than {largest}"),
    }
}

fn keys(text: &mut String) {
    text.push_str(
        "## Keys of a case file\n\nBesides these numbers a case has a `name`. The load and the lengths are given by \
         `[load]` with `length_m` of both bodies, or by `[dimensionless]`.\n\n\
         | key | meaning | least and largest | example | given |\n|---|---|---|---|---|\n",
    );
    for key in &KEYS {
        let limits = limits(key.range);
        let given = given(key);
        let what = cell(key.what.trim_end_matches(','));
        line(
            text,
            format_args!("| `{}` | {what} | {limits} | {} | {given} |", key.path, key.example),
        );
    }
    text.push_str("\n### Words\n\n| key | meaning | words |\n|---|---|---|\n");
    for word in &WORDS {
        let paths: Vec<String> = word.paths.iter().map(|path| format!("`{path}`")).collect();
        let choices: Vec<String> =
            (word.choices)().iter().map(|choice| format!("`\"{choice}\"`")).collect();
        let choices = if choices.is_empty() { "a file".to_string() } else { choices.join(", ") };
        line(text, format_args!("| {} | {} | {choices} |", paths.join(", "), cell(word.what)));
    }
    for flag in &FLAGS {
        let what = cell(flag.what);
        line(text, format_args!("| `{}` | whether to take in {what} | true, false |", flag.path));
    }
    text.push_str("\n### Profiles\n\n| `kind` | keys |\n|---|---|\n");
    for kind in ProfileKind::ALL {
        let keys = kind.keys().iter().map(|key| format!("`{key}`")).collect::<Vec<_>>();
        let keys = if kind == ProfileKind::Table { "`file`".to_string() } else { keys.join(", ") };
        line(text, format_args!("| `{}` | {keys} |", kind.name()));
    }
    text.push('\n');
}

/// When a file has a key.
fn given(key: &Key) -> &'static str {
    match (key.is_required(), key.is_of(Form::Load), key.is_of(Form::Factors)) {
        _ if key.table().ends_with(".profile") => "by kind",
        _ if key.table() == "surface" => "with `[surface]`, but for .x3p",
        _ if key.is_one_of_several() => "one of the two with `[load]`",
        (true, true, true) => "always",
        (true, true, false) => "with `[load]`",
        (true, false, _) => "with `[dimensionless]`",
        (false, true, true) => "optional",
        (false, true, false) => "optional with `[load]`",
        (false, false, _) => "optional with `[dimensionless]`",
    }
}

fn commands(text: &mut String, program: &Command) {
    text.push_str("## Commands\n\n");
    for command in program.get_subcommands().filter(|command| command.get_name() != "help") {
        let about = command.get_long_about().or(command.get_about());
        let about = about.map(ToString::to_string).unwrap_or_default();
        line(text, format_args!("### edgeline {}\n\n{about}\n", command.get_name()));
        text.push_str("| option | default | meaning |\n|---|---|---|\n");
        for argument in command.get_arguments().filter(|a| a.get_id() != "help" && !a.is_hide_set())
        {
            line(text, format_args!("{}", option(argument)));
        }
        text.push('\n');
    }
}

/// The row of an option.
fn option(argument: &Arg) -> String {
    let takes = matches!(argument.get_action(), ArgAction::Set | ArgAction::Append);
    let values = argument.get_value_names().unwrap_or_default();
    let values: Vec<&str> = values.iter().map(|name| name.as_str()).collect();
    let name = match argument.get_long() {
        Some(long) if takes => format!("`--{long} {}`", values.join(" ")),
        Some(long) => format!("`--{long}`"),
        None => format!("`{}`", values.join(" ")),
    };
    let defaults: Vec<String> = argument
        .get_default_values()
        .iter()
        .map(|v| format!("`{}`", v.to_string_lossy()))
        .collect();
    let default = if takes { defaults.join(" ") } else { String::new() };
    let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
    let known = argument.get_possible_values();
    let known: Vec<String> = known.iter().map(|v| format!("`{}`", v.get_name())).collect();
    let known =
        if known.is_empty() || !takes { String::new() } else { format!(": {}", known.join(", ")) };
    format!("| {name} | {default} | {}{known} |", cell(&help))
}

fn files(text: &mut String, summary: &Value) -> Result<()> {
    text.push_str(
        "## Files of a solution\n\nAll numbers are in SI units.\n\n| file | columns |\n|---|---|\n",
    );
    let case = builtin_case("flush-short").expect("a case of that name")?.with_tolerance(5e-2);
    let mut options = Options::new(EdgeModel::HalfSpace);
    options.points = vec![Point { body: BodyKind::Block, at_m: [0.0; 3] }];
    for table in tables(&solve(&case, &options)?, &options) {
        let columns: Vec<String> =
            table.columns.iter().map(|(name, _)| format!("`{name}`")).collect();
        line(text, format_args!("| `{}.csv` | {} |", table.name, columns.join(", ")));
    }
    text.push_str("\n### summary.json\n\n| key | meaning |\n|---|---|\n");
    members(text, summary, summary, "");
    Ok(())
}

/// The rows of an object's members, and of those of the objects below it.
fn members(text: &mut String, root: &Value, schema: &Value, path: &str) {
    for (name, member) in schema["properties"].as_object().into_iter().flatten() {
        let (path, said) = (format!("{path}{name}"), member["description"].as_str());
        let told = said.unwrap_or("");
        line(text, format_args!("| `{path}` | {} |", cell(told)));
        // A member that may be absent is one of several schemas.
        let choices = member["anyOf"].as_array();
        let forms = choices.into_iter().flatten().chain(std::iter::once(member));
        for below in forms.filter_map(|form| form["$ref"].as_str()) {
            if let Some(found) = below.strip_prefix('#').and_then(|place| root.pointer(place)) {
                members(text, root, found, &format!("{path}."));
                for form in found["anyOf"].as_array().into_iter().flatten() {
                    let place = form["$ref"].as_str().and_then(|place| place.strip_prefix('#'));
                    if let Some(found) = place.and_then(|place| root.pointer(place)) {
                        members(text, root, found, &format!("{path}."));
                    }
                }
            }
        }
    }
}
