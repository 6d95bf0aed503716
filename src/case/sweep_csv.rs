//! A sweep as a CSV table: one row per case, and a column for each number that varies.

use super::document::known_names;
use super::draft::{Draft, Form};
use super::keys::{KEYS, Key};
use super::sweep::{Column, Rows, Sweep, without_effect};
use super::sweep_table::Table;
use crate::base::{Error, Result};
use crate::host::{WRITE_COMMAS, other_separators, read_text};
use std::path::Path;

/// Columns that give both bodies the same value.
const BOTH: [&str; 2] = ["young_pa", "poisson"];

/// Size above which tables are refused (bytes); the most rows that are allowed are smaller.
const MAX_BYTES: u64 = 4 << 30;

impl Sweep {
    pub(super) fn read_csv(path: &Path, base: Option<&Draft>) -> Result<Sweep> {
        let remedy = "split it into several files";
        let file = std::fs::metadata(path).ok();
        if file.as_ref().is_some_and(|file| file.len() > MAX_BYTES) {
            return Err(Error::File {
                path: path.to_path_buf(),
                line: None,
                message: format!("is larger than {} MiB", MAX_BYTES >> 20),
                remedy: remedy.into(),
            });
        }
        // What is no file, a pipe for example, cannot be read twice.
        let text = match file.is_some_and(|file| !file.is_file()) {
            true => Some(read_text(path, MAX_BYTES, remedy)?),
            false => None,
        };
        Sweep::of_table(Table::new(path, text)?, path, base)
    }

    /// Parses a CSV table with a column for each number and optionally a column `name`. `base`
    /// gives the values without a column.
    ///
    /// # Errors
    /// As [`Sweep::read`].
    pub fn parse_csv(text: &str, path: &Path, base: Option<&Draft>) -> Result<Sweep> {
        Sweep::of_table(Table::new(path, Some(text.to_string()))?, path, base)
    }

    fn of_table(table: Table, path: &Path, base: Option<&Draft>) -> Result<Sweep> {
        if let Some(base) = base {
            Sweep::check_smooth(&base.case)?;
        }
        let in_header = |(message, remedy)| Error::File {
            path: path.to_path_buf(),
            line: Some(1),
            message,
            remedy,
        };
        let names = table.header.clone();
        if let Some(message) = other_separators(&names.join(",")) {
            return Err(in_header((message, WRITE_COMMAS.into())));
        }
        let columns = names
            .iter()
            .map(|name| column(name))
            .collect::<Finding<Vec<_>>>()
            .map_err(in_header)?;
        let given = given_once(&columns).map_err(in_header)?;
        let form = form_of(&given, base).map_err(in_header)?;
        let base = match base {
            Some(base) if base.form() == form => base.clone(),
            Some(base) => Draft::of(&base.case()?, form),
            None => {
                nothing_missing(&given, form).map_err(in_header)?;
                Draft::new("", form)
            }
        };
        Ok(Sweep { columns, names, base, rows: Rows::Table(table.counted()?) })
    }
}

/// The content of the header, or what is wrong with it and what to do.
type Finding<T> = std::result::Result<T, (String, String)>;

/// The column called `name`.
fn column(name: &str) -> Finding<Column> {
    if name == "name" {
        return Ok(Column::Name);
    }
    if BOTH.contains(&name) {
        return Ok(Column::Numbers(KEYS.iter().filter(|key| key.leaf() == name).collect()));
    }
    if let Some(key) = KEYS.iter().find(|key| key.path == name || key.column == name) {
        return match without_effect(key) {
            None => Ok(Column::Numbers(vec![key])),
            Some(reason) => Err((format!("column {name}: {reason}"), "remove the column".into())),
        };
    }
    let mut known = vec!["name"];
    known.extend(BOTH);
    let columns = KEYS.iter().filter(|key| without_effect(key).is_none());
    known.extend(columns.map(|key| key.column));
    let remedy = known_names(name, &known, "the columns are");
    Err((format!("unknown column {name}"), remedy))
}

/// The numbers that the columns give, each by one column only.
fn given_once(columns: &[Column]) -> Finding<Vec<&'static Key>> {
    let remedy = || "remove one of them".to_string();
    if columns.iter().filter(|column| **column == Column::Name).count() > 1 {
        return Err(("has two columns name".into(), remedy()));
    }
    let mut given: Vec<&'static Key> = Vec::new();
    for column in columns {
        let Column::Numbers(keys) = column else { continue };
        for &key in keys {
            if given.contains(&key) {
                return Err((format!("{} is given by two columns", key.path), remedy()));
            }
            given.push(key);
        }
    }
    Ok(given)
}

/// The form in which the columns give the load; without such columns that of the base.
fn form_of(given: &[&Key], base: Option<&Draft>) -> Finding<Form> {
    let several: Vec<&str> =
        given.iter().filter(|key| key.is_one_of_several()).map(|key| key.path).collect();
    if let [first, second, ..] = several[..] {
        let message = format!("gives the load twice, by {first} and by {second}");
        return Err((message, "remove one of them".into()));
    }
    let any_of = |form: Form| {
        let other = if form == Form::Load { Form::Factors } else { Form::Load };
        given.iter().any(|key| key.is_of(form) && !key.is_of(other))
    };
    match (any_of(Form::Factors), any_of(Form::Load)) {
        (true, true) => Err((
            "gives the load twice, by W, S_l, L_r and by force_n and lengths".into(),
            "keep the columns of one of the two".into(),
        )),
        (false, true) => Ok(Form::Load),
        (true, false) => Ok(Form::Factors),
        (false, false) => Ok(base.map_or(Form::Factors, Draft::form)),
    }
}

/// Refuses a table without a base that lacks a required number.
fn nothing_missing(given: &[&Key], form: Form) -> Finding<()> {
    let needed = |key: &&Key| key.is_of(form) && key.is_required();
    let mut missing: Vec<&str> =
        KEYS.iter().filter(needed).filter(|key| !given.contains(key)).map(|key| key.path).collect();
    if form == Form::Load && !given.iter().any(|key| key.is_one_of_several()) {
        missing.push("load.force_n");
    }
    if missing.is_empty() {
        return Ok(());
    }
    let message = format!("has no column for {}", missing.join(", "));
    Err((message, "add them, or take them from a case with --base".into()))
}
