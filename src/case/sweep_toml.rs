//! The sweep file in TOML: a case file in which every number may also be a list or a range.

use super::case_file::{entries, form, keys_of, only_tables, read_flags, read_profiles};
use super::check::ON_CELLS;
use super::document::{Document, Entry, Table, read_text};
use super::draft::Draft;
use super::keys::Key;
use super::levels::{Levels, MAX_ROWS, levels};
use super::sweep::{Column, Rows, SMOOTH, Sweep, without_effect};
use crate::base::Result;
use std::path::Path;

/// Size of a row of the results (bytes).
const ROW_BYTES: f64 = 330.0;

/// A number that varies: its place in the file, and its values.
struct Varying<'d> {
    key: &'static Key,
    entry: Entry<'d>,
    levels: Levels,
}

impl Sweep {
    pub(super) fn read_toml(path: &Path) -> Result<Sweep> {
        Sweep::parse(&read_text(path)?, path)
    }

    /// Parses a sweep file in TOML: a case file in which every number may also be a list of numbers
    /// or a range, and `[sweep] combine` says whether lists are combined (`grid`, the default) or
    /// read side by side (`list`).
    ///
    /// # Errors
    /// As [`Sweep::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Sweep> {
        let document = Document::parse(path, text)?;
        let root = document.root();
        only_tables(&root, &["name", "sweep"])?;
        if let Some(surface) = root.get("surface") {
            return Err(surface.refuse(SMOOTH, ON_CELLS));
        }
        if let Some(entry) = root.get("name") {
            // The name is only for readers, but must be legal.
            entry.string()?;
        }
        let side_by_side = side_by_side(&root)?;
        let (form, _) = form(&root)?;
        let mut base = Draft::new("", form);
        read_profiles(&root, path, &mut base)?;
        read_flags(&root, &mut base)?;
        let mut varying: Vec<Varying> = Vec::new();
        for (key, entry) in entries(&root, &keys_of(form))? {
            match levels(&entry)? {
                Levels::One(value) => key.set(&mut base, value),
                levels => match without_effect(key) {
                    None => varying.push(Varying { key, entry, levels }),
                    Some(reason) => return Err(entry.refuse(reason, "give one value, or none")),
                },
            }
        }
        // The columns have the order of the file.
        varying.sort_by_key(|v| v.entry.place());
        check_rows(&varying, side_by_side, &root)?;
        let keys: Vec<&'static Key> = varying.iter().map(|v| v.key).collect();
        let values = varying.into_iter().map(|v| v.levels).collect();
        Ok(Sweep {
            columns: keys.iter().map(|&key| Column::Numbers(vec![key])).collect(),
            names: keys.iter().map(|key| key.path.to_string()).collect(),
            base,
            rows: if side_by_side { Rows::Side(values) } else { Rows::Grid(values) },
        })
    }
}

/// Whether lists are read side by side.
fn side_by_side(root: &Table) -> Result<bool> {
    let Some(entry) = root.get("sweep") else { return Ok(false) };
    let table = entry.table()?;
    table.only(&["combine"])?;
    let combine = table.require("combine", "combine = \"grid\"")?;
    match combine.string()? {
        "grid" => Ok(false),
        "list" => Ok(true),
        _ => Err(combine.refuse(
            "lists are combined in one of two ways",
            "write \"grid\" for every combination, \"list\" for one row for each place in the lists",
        )),
    }
}

/// Refuses lists of unequal lengths and combinations of too many rows.
fn check_rows(varying: &[Varying], side_by_side: bool, root: &Table) -> Result<()> {
    let count = |v: &Varying| v.levels.len();
    let first = varying.first().map_or(1, count);
    if let Some(other) = varying.iter().find(|v| side_by_side && count(v) != first) {
        let (own, name) = (count(other), varying[0].key.path);
        return Err(other.entry.refuse(
            format!("it has {own} values and {name} has {first}, but lists are read side by side"),
            "give lists of one length, or [sweep] combine = \"grid\"",
        ));
    }
    let rows = match side_by_side {
        true => first as f64,
        false => varying.iter().map(|v| count(v) as f64).product(),
    };
    if rows > MAX_ROWS as f64 {
        let gib = rows * ROW_BYTES / (1u64 << 30) as f64;
        let message = format!(
            "the lists combine to more than {MAX_ROWS} rows: {rows:.2e} rows would be a file of about \
             {gib:.1e} GiB"
        );
        return Err(root.error(message, "give fewer values, or several files"));
    }
    Ok(())
}
