//! TOML with places: every value knows its key and its line, so that every error can name them.

// Study and sweep files, which only the program reads, need more of this file than case files do.
#![cfg_attr(not(feature = "cli"), allow(dead_code))]

use super::model::Case;
use crate::base::{Error, Result};
use crate::host;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Reads the text of a case, study or sweep file.
///
/// # Errors
/// [`Error::Io`] when it cannot be read, [`Error::File`] when it is too large or not UTF-8.
pub(super) fn read_text(path: &Path) -> Result<String> {
    host::read_input(path, Case::MAX_BYTES, "give a case or study file in TOML")
}

/// The question whether the known name most like `name` is meant, with a blank behind it; nothing
/// if none is like it: none begins with it, and none differs by few letters.
pub(crate) fn did_you_mean(name: &str, known: &[&str]) -> String {
    let name = name.to_lowercase();
    let distance = |known: &str| match known.to_lowercase() {
        known if known.starts_with(&name) => 0,
        known => strsim::damerau_levenshtein(&known, &name),
    };
    let few = (name.len() / 3).max(1).min(name.len().saturating_sub(1));
    let nearest = known.iter().map(|known| (distance(known), known)).min();
    match nearest.filter(|(distance, _)| !name.is_empty() && *distance <= few) {
        Some((_, known)) => format!("did you mean {known}? "),
        None => String::new(),
    }
}

/// The known name that is most like `name`, if one is, and all that are `known`, told as `lead`.
pub(crate) fn known_names(name: &str, known: &[&str], lead: &str) -> String {
    let meant = did_you_mean(name, known);
    let first = if meant.is_empty() { lead[..1].to_lowercase() } else { lead[..1].to_uppercase() };
    format!("{meant}{first}{} {}", &lead[1..], known.join(", "))
}

/// What is wrong with a key or a name that a parser does not know, and what it knows, in the words
/// of all files; `None` of another `fault`.
#[cfg(feature = "cli")]
pub(crate) fn unknown_word(fault: &str) -> Option<(String, String)> {
    let kinds = [("unknown field `", "unknown key"), ("unknown variant `", "unknown name")];
    let (rest, what) =
        kinds.iter().find_map(|(begin, what)| Some((fault.split_once(begin)?.1, what)))?;
    // "limt`, expected one of `name`, `limit`"
    let mut words = rest.split('`').step_by(2);
    let word = words.next()?;
    let known: Vec<&str> = words.filter(|known| !known.is_empty()).collect();
    Some((format!("{what} {word}"), known_names(word, &known, "there are")))
}

/// A parsed file that knows the places of its values.
pub(super) struct Document<'a> {
    path: &'a Path,
    text: &'a str,
    root: DeTable<'a>,
}

impl<'a> Document<'a> {
    /// Parses `text`; `path` is only named in errors.
    pub fn parse(path: &'a Path, text: &'a str) -> Result<Self> {
        let mut document = Self { path, text, root: DeTable::new() };
        match DeTable::parse(text) {
            Ok(root) => document.root = root.into_inner(),
            Err(e) => {
                let message = format!("is not valid TOML: {}", e.message().trim());
                return Err(document.error(e.span(), message, "correct this line"));
            }
        }
        Ok(document)
    }

    /// The top level.
    pub fn root(&self) -> Table<'_> {
        Table { document: self, name: String::new(), span: None, entries: &self.root }
    }

    fn error(
        &self,
        span: Option<Range<usize>>,
        message: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Error {
        let line = span.map(|s| {
            let before = &self.text.as_bytes()[..s.start.min(self.text.len())];
            1 + before.iter().filter(|&&b| b == b'\n').count()
        });
        Error::File {
            path: self.path.to_path_buf(),
            line,
            message: message.into(),
            remedy: remedy.into(),
        }
    }
}

/// A table of a document.
pub(super) struct Table<'d> {
    document: &'d Document<'d>,
    /// Its name, empty at the top level.
    name: String,
    span: Option<Range<usize>>,
    entries: &'d DeTable<'d>,
}

impl<'d> Table<'d> {
    /// Refuses every key that is not in `known`.
    pub fn only(&self, known: &[&str]) -> Result<()> {
        // In the order of the file: the first mistake is the one to report.
        let unknown = self
            .entries
            .keys()
            .filter(|k| !known.contains(&k.get_ref().as_ref()))
            .min_by_key(|k| k.span().start);
        let Some(key) = unknown else { return Ok(()) };
        let meant = did_you_mean(key.get_ref(), known);
        let place = match self.name.as_str() {
            "" => "the top level".to_string(),
            name => format!("[{name}]"),
        };
        let takes = format!("{meant}{place} takes {}", known.join(", "));
        Err(self.unknown(key.get_ref(), takes))
    }

    /// An error about a key that the table does not take, with what to do.
    pub fn unknown(&self, key: &str, remedy: String) -> Error {
        let own = self.entries.keys().find(|own| own.get_ref() == key);
        let message = format!("unknown key {}", self.full_key(key));
        self.document.error(own.map(|own| own.span()), message, remedy)
    }

    /// All keys and their values.
    pub fn all(&self) -> Vec<(&'d str, Entry<'d>)> {
        let entry =
            |key: &str, value| Entry { document: self.document, key: self.full_key(key), value };
        let entries: &'d DeTable<'d> = self.entries;
        entries.iter().map(|(key, v)| (&**key.get_ref(), entry(key.get_ref(), v))).collect()
    }

    /// The value of `key`, if the file has it.
    pub fn get(&self, key: &str) -> Option<Entry<'d>> {
        let (_, value) = self.entries.iter().find(|(k, _)| k.get_ref() == key)?;
        Some(Entry { document: self.document, key: self.full_key(key), value })
    }

    /// The required value of `key`; `example` shows in the error how to write it.
    pub fn require(&self, key: &str, example: &str) -> Result<Entry<'d>> {
        self.get(key).ok_or_else(|| {
            self.document.error(
                self.span.clone(),
                format!("{} is missing", self.full_key(key)),
                format!("add for example `{example}`"),
            )
        })
    }

    /// The required table `key`.
    pub fn table(&self, key: &str) -> Result<Table<'d>> {
        match self.get(key) {
            Some(entry) => entry.table(),
            None => {
                let message = format!("the table [{}] is missing", self.full_key(key));
                Err(self.document.error(self.span.clone(), message, "add it"))
            }
        }
    }

    /// The value at a path below this table, for example `roller.radius_m`, if the file has it.
    pub fn find(&self, path: &str) -> Option<Entry<'d>> {
        match path.split_once('.') {
            None => self.get(path),
            Some((table, rest)) => self.get(table)?.as_table()?.find(rest),
        }
    }

    /// An error about a value with its place in the file. A value that is not in the file gets the
    /// place of this table.
    pub fn place(&self, error: Error) -> Error {
        let Error::Value { key, value, reason, remedy } = error else { return error };
        match self.document.root().find(&key) {
            Some(entry) => entry.refuse(reason, remedy),
            None => self.error(format!("{key} = {value} is not valid: {reason}"), remedy),
        }
    }

    /// An error about the whole table.
    pub fn error(&self, message: impl Into<String>, remedy: impl Into<String>) -> Error {
        self.document.error(self.span.clone(), message, remedy)
    }

    fn full_key(&self, key: &str) -> String {
        if self.name.is_empty() { key.to_string() } else { format!("{}.{key}", self.name) }
    }
}

/// A key and its value.
pub(super) struct Entry<'d> {
    document: &'d Document<'d>,
    key: String,
    value: &'d Spanned<DeValue<'d>>,
}

impl<'d> Entry<'d> {
    /// An error about this value: "`key` = `value` is not valid: `reason`; `remedy`".
    pub fn refuse(&self, reason: impl AsRef<str>, remedy: impl Into<String>) -> Error {
        let span = self.value.span();
        let found = self.document.text.get(span.clone()).unwrap_or("?");
        let shown: String = match found.lines().next() {
            Some(line) if line.len() < found.len() || line.chars().count() > 60 => {
                line.chars().take(57).chain("...".chars()).collect()
            }
            line => line.unwrap_or("").to_string(),
        };
        let message = format!("{} = {shown} is not valid: {}", self.key, reason.as_ref());
        self.document.error(Some(span), message, remedy)
    }

    /// The result of a check of this value; an error gets the place in the file.
    pub fn placed<T>(&self, checked: Result<T>) -> Result<T> {
        checked.map_err(|e| match e {
            Error::Value { reason, remedy, .. } => self.refuse(reason, remedy),
            other => other,
        })
    }

    /// The value as a table.
    pub fn table(self) -> Result<Table<'d>> {
        self.as_table()
            .ok_or_else(|| self.refuse("a table belongs here", format!("write [{}]", self.key)))
    }

    /// Where the value begins in the text, in bytes.
    pub fn place(&self) -> usize {
        self.value.span().start
    }

    /// Whether the value is a list.
    pub fn is_list(&self) -> bool {
        matches!(self.value.get_ref(), DeValue::Array(_))
    }

    /// The value as a table, if it is one.
    pub fn as_table(&self) -> Option<Table<'d>> {
        let DeValue::Table(entries) = self.value.get_ref() else { return None };
        let (document, span) = (self.document, Some(self.value.span()));
        Some(Table { document, span, name: self.key.clone(), entries })
    }

    /// The value as a finite number.
    pub fn number(&self) -> Result<f64> {
        let parsed = match self.value.get_ref() {
            // A case needs no hexadecimal, octal or binary integers.
            DeValue::Integer(i) if i.radix() == 10 => i.as_str().parse().ok(),
            DeValue::Float(f) => f.as_str().parse().ok(),
            DeValue::String(_) => {
                return Err(self.refuse("a number belongs here", "write it without quotes"));
            }
            _ => None,
        };
        match parsed {
            Some(v) if f64::is_finite(v) => Ok(v),
            _ => Err(self.refuse("a finite number belongs here", "write for example 1.5 or 2e-4")),
        }
    }

    /// What was read of the file that this value names; that it cannot be read is an error about
    /// this value.
    pub fn opened<T>(&self, read: Result<T>) -> Result<T> {
        read.map_err(|e| match e {
            Error::Io { path, source, .. } => {
                let reason = format!("cannot read {}: {source}", path.display());
                self.refuse(reason, "correct the path, which is relative to this file")
            }
            other => other,
        })
    }

    /// The file whose path this is, beside the file at `path`: its whole path, so that what is
    /// written of the case may stand anywhere.
    ///
    /// # Errors
    /// [`Error::File`] if it is no string or an empty one, or if a folder has a name that no case
    /// file can have.
    pub fn beside(&self, path: &Path) -> Result<PathBuf> {
        let own = self.string()?;
        if own.is_empty() {
            let remedy = "write its path, relative to this file or from the root";
            return Err(self.refuse("the path of a file belongs here", remedy));
        }
        let place = path.parent().unwrap_or(Path::new("")).join(own);
        let place = std::path::absolute(&place).map_err(|source| Error::Io {
            action: "find",
            path: place,
            source,
        })?;
        if place.to_str().is_none() {
            let reason = format!("{} is not UTF-8, and a case file is", place.display());
            return Err(self.refuse(reason, "give the folders names in UTF-8"));
        }
        Ok(place)
    }

    /// The value as a string.
    pub fn string(&self) -> Result<&'d str> {
        match self.value.get_ref() {
            DeValue::String(s) => Ok(s.as_ref()),
            _ => Err(self.refuse("a text belongs here", "write it in double quotes")),
        }
    }

    /// The value as true or false.
    pub fn flag(&self) -> Result<bool> {
        match self.value.get_ref() {
            DeValue::Boolean(b) => Ok(*b),
            _ => Err(self.refuse("true or false belongs here", "write true or false")),
        }
    }

    /// The value as a list, not empty.
    pub fn list(&self) -> Result<Vec<Entry<'d>>> {
        match self.value.get_ref() {
            DeValue::Array(items) if !items.is_empty() => {
                let item = |value| Entry { document: self.document, key: self.key.clone(), value };
                Ok(items.iter().map(item).collect())
            }
            DeValue::Array(_) => Err(self.refuse("the list is empty", "give one or more values")),
            _ => Err(self.refuse("a list belongs here", "write [first, second]")),
        }
    }
}
