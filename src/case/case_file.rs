//! The case file: one contact problem.

use super::check::of_factors;
use super::document::{Document, Entry, Table, known_names, read_text};
use super::draft::{Draft, Form};
use super::keys::{FLAGS, KEYS, Key, only_keys};
use super::model::Case;
use super::profile::{ProfileKind, ProfileSpec};
use super::profile_table::read_profile_table;
use super::surface_table::read_surface;
use crate::base::{BodyKind, Error, Result};
use std::path::Path;
use std::sync::Arc;

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
        Draft::parse(text, path)?.case()
    }

    /// An `error` that the solution of the case at `path` gave, with its place: the line of the key
    /// that it names, or the file. A built-in case has neither.
    pub fn place(path: &Path, error: Error) -> Error {
        // A pipe cannot be read again.
        if !path.is_file() {
            return error;
        }
        let of_file = |error| Error::Case { path: path.to_path_buf(), source: Box::new(error) };
        match &error {
            Error::Value { key, .. } if key.contains('.') => {
                let Ok(text) = read_text(path) else { return error };
                let Ok(document) = Document::parse(path, &text) else { return error };
                let root = document.root();
                let error = match root.get("dimensionless") {
                    Some(_) => of_factors(error),
                    None => error,
                };
                match &error {
                    Error::Value { key, .. } if root.find(key).is_some() => root.place(error),
                    _ => of_file(error),
                }
            }
            Error::NotConverged { .. } | Error::Unsound { .. } | Error::Uncovered { .. } => {
                of_file(error)
            }
            _ => error,
        }
    }
}

impl Draft {
    /// Reads a case file, whose numbers are those of a case, in its own form.
    ///
    /// # Errors
    /// As [`Case::read`].
    pub(super) fn read(path: &Path) -> Result<Draft> {
        Draft::parse(&read_text(path)?, path)
    }

    /// Parses the text of a case file.
    ///
    /// # Errors
    /// As [`Case::read`].
    pub(super) fn parse(text: &str, path: &Path) -> Result<Draft> {
        let document = Document::parse(path, text)?;
        let root = document.root();
        if root.get("factors").is_some() || root.get("cases").is_some() {
            return Err(
                root.error("is a study file, not a case file", "run `edgeline study` on it")
            );
        }
        if root.get("sweep").is_some() {
            return Err(
                root.error("is a sweep file, not a case file", "run `edgeline sweep` on it")
            );
        }
        only_tables(&root, &["name"])?;
        let (form, load) = form(&root)?;
        let mut draft = Draft::new(name(&root)?, form);
        read_profiles(&root, path, &mut draft)?;
        read_surface(&root, path, &mut draft)?;
        read_flags(&root, &mut draft)?;
        for (key, entry) in entries(&root, &keys_of(form))? {
            // Several numbers, as a list or a range.
            if entry.is_list() || entry.as_table().is_some() {
                let remedy = "write one, or run `edgeline sweep` on the file";
                return Err(entry.refuse("a case has one number here", remedy));
            }
            key.set(&mut draft, entry.number()?);
        }
        draft.case().map_err(|e| load.place(e))?;
        Ok(draft)
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
    let tables = KEYS.iter().map(Key::table).filter(|table| !table.contains('.'));
    let mut known: Vec<&str> = more.iter().copied().chain(tables).collect();
    known.sort_unstable();
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
        let table = match root.find(name) {
            None if of_table.iter().all(|key| !key.is_required()) => continue,
            None => root.table(name)?,
            Some(entry) => entry.table()?,
        };
        only_keys(&table, name, keys.iter().copied())?;
        check_one_of_several(&table, of_table)?;
        for &key in of_table {
            let leaf = key.leaf();
            let entry = match key.is_required() {
                false => table.get(leaf),
                true => Some(table.require(leaf, &format!("{leaf} = {}", key.example))?),
            };
            found.extend(entry.map(|entry| (key, entry)));
        }
    }
    Ok(found)
}

/// Refuses a table with none of the keys of which it takes exactly one, and one with several.
fn check_one_of_several(table: &Table, keys: &[&'static Key]) -> Result<()> {
    let several = || keys.iter().filter(|key| key.is_one_of_several());
    let Some(usual) = several().next() else { return Ok(()) };
    let mut given = several().filter_map(|key| Some((key.leaf(), table.get(key.leaf())?)));
    match (given.next(), given.next()) {
        (None, _) => {
            let leaf = usual.leaf();
            table.require(leaf, &format!("{leaf} = {}", usual.example)).map(drop)
        }
        (Some((first, _)), Some((second, entry))) => Err(entry.refuse(
            format!("{first} gives the load already"),
            format!("remove {first} or {second}"),
        )),
        _ => Ok(()),
    }
}

/// Takes what is on or off.
pub(super) fn read_flags(root: &Table, draft: &mut Draft) -> Result<()> {
    for flag in &FLAGS {
        if let Some(entry) = root.find(flag.path) {
            flag.set(&mut draft.case, entry.flag()?);
        }
    }
    Ok(())
}

/// Takes the kinds and the files of the bodies' profiles; files are looked for beside the case
/// file, which stands at `path`.
pub(super) fn read_profiles(root: &Table, path: &Path, draft: &mut Draft) -> Result<()> {
    for body in BodyKind::ALL {
        let Some(entry) = root.find(&format!("{}.profile", body.name())) else { continue };
        let table = entry.table()?;
        only_keys(&table, &format!("{}.profile", body.name()), KEYS.iter())?;
        let entry = table.require("kind", "kind = \"crown\"")?;
        let name = entry.string()?;
        let Some(kind) = ProfileKind::ALL.into_iter().find(|kind| kind.name() == name) else {
            let known = ProfileKind::ALL.map(ProfileKind::name);
            let remedy = known_names(name, &known, "there are");
            return Err(entry.refuse("there is no such profile", remedy));
        };
        let mut spec = ProfileSpec::new(kind);
        if let Some(file) = table.get("file") {
            if kind != ProfileKind::Table {
                let reason = format!("the profile {name} has no file");
                return Err(file.refuse(reason, "remove it, or write kind = \"table\""));
            }
            let place = file.beside(path)?;
            spec.table = Some(Arc::new(file.opened(read_profile_table(&place))?));
            spec.file = Some(place);
        }
        *draft.case.profile_mut(body) = Some(spec);
    }
    Ok(())
}
