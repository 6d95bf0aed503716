//! The case file: one contact problem.

use super::document::{Document, Entry, Table, read_text};
use super::draft::{Draft, Form};
use super::keys::{KEYS, Key, Presence};
use super::model::Case;
use crate::base::Result;
use std::path::Path;

impl Case {
    /// Reads a case file.
    ///
    /// # Errors
    /// [`crate::base::Error::Io`] when the file cannot be read; [`crate::base::Error::File`] with
    /// the line when it is not TOML, has an unknown or missing key, or a value that is not legal.
    pub fn read(path: &Path) -> Result<Case> {
        Case::parse(&read_text(path)?, path)
    }

    /// Takes a case from the text of a case file.
    ///
    /// # Errors
    /// [`crate::base::Error::File`] as [`Case::read`].
    pub fn from_toml(text: &str) -> Result<Case> {
        Case::parse(text, Path::new("the case"))
    }

    /// Parses the text of a case file; `path` is only named in errors.
    ///
    /// # Errors
    /// As [`Case::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Case> {
        let document = Document::parse(path, text)?;
        let root = document.root();
        if root.get("factors").is_some() {
            return Err(
                root.error("is a study file, not a case file", "run `edgeline study` on it")
            );
        }
        only_tables(&root, &["name"])?;
        let (form, load) = form(&root)?;
        let mut draft = Draft::new(name(&root)?, form);
        for (key, entry) in entries(&root, &keys_of(form))? {
            key.set(&mut draft, entry.number()?);
        }
        draft.case().map_err(|e| load.place(e))
    }
}

/// How the load is given, and the table that gives it.
pub(super) fn form<'d>(root: &Table<'d>) -> Result<(Form, Table<'d>)> {
    match (root.get("dimensionless"), root.get("load")) {
        (Some(dimensionless), None) => Ok((Form::Factors, dimensionless.table()?)),
        (None, Some(load)) => Ok((Form::Load, load.table()?)),
        (Some(_), Some(load)) => Err(load.table()?.error(
            "the load is given twice, by [dimensionless] and by [load]",
            "keep one of the two",
        )),
        (None, None) => Err(root.error(
            "there is no load: neither [dimensionless] nor [load]",
            "add [dimensionless] with W, S_l and L_r, or [load] with force_n and both lengths",
        )),
    }
}

/// The name. Folders are named after it.
pub(super) fn name<'d>(root: &Table<'d>) -> Result<&'d str> {
    root.require("name", "name = \"flush-short\"")?.string()
}

/// The keys that a file of this form may have.
pub(super) fn keys_of(form: Form) -> Vec<&'static Key> {
    KEYS.iter().filter(|key| key.is_of(form)).collect()
}

/// Refuses keys at the top level that are neither in `more` nor tables of a case file.
pub(super) fn only_tables(root: &Table, more: &[&'static str]) -> Result<()> {
    let mut known: Vec<&str> = more.iter().copied().chain(KEYS.iter().map(Key::table)).collect();
    known.dedup();
    root.only(&known)
}

/// The values of `keys` in a file, in the order of the keys. Their tables must not contain other
/// keys.
pub(super) fn entries<'d>(
    root: &Table<'d>,
    keys: &[&'static Key],
) -> Result<Vec<(&'static Key, Entry<'d>)>> {
    let lengths = KEYS.iter().filter(|key| key.leaf() == "length_m" && !keys.contains(key));
    if let Some(length) = lengths.filter_map(|key| root.find(key.path)).next() {
        return Err(length.refuse(
            "the lengths follow from W, S_l and L_r",
            "remove it: lengths are given with [load] only",
        ));
    }
    let mut found = Vec::new();
    for of_table in keys.chunk_by(|a, b| a.table() == b.table()) {
        let name = of_table[0].table();
        let optional = of_table.iter().all(|key| key.presence == Presence::Optional);
        if optional && root.get(name).is_none() {
            continue;
        }
        let table = root.table(name)?;
        table.only(&of_table.iter().map(|key| key.leaf()).collect::<Vec<_>>())?;
        for &key in of_table {
            let leaf = key.leaf();
            let entry = match key.presence {
                Presence::Optional => table.get(leaf),
                _ => Some(table.require(leaf, &format!("{leaf} = {}", key.example))?),
            };
            found.extend(entry.map(|entry| (key, entry)));
        }
    }
    Ok(found)
}
