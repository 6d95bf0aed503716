//! The case files that are built into the binary, so that it runs from any folder.

use super::document::did_you_mean;
use super::draft::Draft;
use super::model::Case;
use crate::base::{Error, Result};
use std::path::Path;

/// Name and text of every case file in `cases/`.
pub const BUILTIN_CASES: [(&str, &str); 18] = [
    ("crown-inside", include_str!("../../cases/crown-inside.toml")),
    ("crown-to-the-ends", include_str!("../../cases/crown-to-the-ends.toml")),
    ("designed-roller", include_str!("../../cases/designed-roller.toml")),
    ("eccentric-flush", include_str!("../../cases/eccentric-flush.toml")),
    ("eccentric-half", include_str!("../../cases/eccentric-half.toml")),
    ("flush-short", include_str!("../../cases/flush-short.toml")),
    ("half-short", include_str!("../../cases/half-short.toml")),
    ("logarithmic-eccentric", include_str!("../../cases/logarithmic-eccentric.toml")),
    ("logarithmic-steel-aluminium", include_str!("../../cases/logarithmic-steel-aluminium.toml")),
    ("long-contact", include_str!("../../cases/long-contact.toml")),
    ("longer-roller", include_str!("../../cases/longer-roller.toml")),
    ("offset-flush-end", include_str!("../../cases/offset-flush-end.toml")),
    ("sliding-flush", include_str!("../../cases/sliding-flush.toml")),
    ("sliding-half", include_str!("../../cases/sliding-half.toml")),
    ("sliding-steel-aluminium", include_str!("../../cases/sliding-steel-aluminium.toml")),
    ("validation-nu025", include_str!("../../cases/validation-nu025.toml")),
    ("validation-nu040", include_str!("../../cases/validation-nu040.toml")),
    ("validation-steel-aluminium", include_str!("../../cases/validation-steel-aluminium.toml")),
];

/// Name and text of every study file in `cases/`, the default one first.
pub const BUILTIN_STUDIES: [(&str, &str); 3] = [
    ("factorial", include_str!("../../cases/factorial.toml")),
    ("profiled", include_str!("../../cases/profiled.toml")),
    ("scenes", include_str!("../../cases/scenes.toml")),
];

/// Whether there is a file, or a pipe, at `path`; a folder does not hide what is built in under its
/// name.
pub(crate) fn is_given(path: &Path) -> bool {
    path.exists() && !path.is_dir()
}

/// The built-in case called `name`, if there is one.
pub fn builtin_case(name: &str) -> Option<Result<Case>> {
    Some(builtin_draft(name)?.and_then(|draft| draft.case()))
}

/// [`builtin_case`] in its own form.
fn builtin_draft(name: &str) -> Option<Result<Draft>> {
    let (name, text) = BUILTIN_CASES.iter().find(|(known, _)| *known == name)?;
    Some(Draft::parse(text, Path::new(name)))
}

impl Case {
    /// Reads the case file at `path`, or takes the built-in case of that name if there is no such
    /// file.
    ///
    /// # Errors
    /// As [`Case::read`]; the error about a missing file names the built-in cases, the nearest
    /// first.
    pub fn find(path: &Path) -> Result<Case> {
        Draft::find(path)?.case()
    }
}

impl Draft {
    /// [`Case::find`] in the form of its file.
    ///
    /// # Errors
    /// As [`Case::find`].
    pub fn find(path: &Path) -> Result<Draft> {
        if is_given(path) {
            return Draft::read(path);
        }
        path.to_str().and_then(builtin_draft).unwrap_or_else(|| Err(not_found(path)))
    }
}

/// The error about a `path` at which there is neither a case file nor a built-in case.
fn not_found(path: &Path) -> Error {
    let word = path.to_str().unwrap_or_default();
    let (message, remedy) = no_case(word, nothing_at(path).into(), "a case file");
    Error::File { path: path.to_path_buf(), line: None, message, remedy }
}

/// What is wrong with a `word` that is no case, `nothing` if it is no study either, and what to
/// give: `file`, or a name.
pub(super) fn no_case(word: &str, nothing: String, file: &str) -> (String, String) {
    let names = BUILTIN_CASES.map(|(name, _)| name);
    // A path is not meant for a name.
    let word = if word.contains(['/', '.']) { "" } else { word };
    let is_study = BUILTIN_STUDIES.iter().any(|(name, _)| *name == word);
    let meant = match word {
        "-" => "for a case from standard input give /dev/stdin, or ".to_string(),
        _ if is_study => format!("run `edgeline study {word}`, or "),
        _ => did_you_mean(word, &names),
    };
    let message = if is_study { "is a study, not a case".into() } else { nothing };
    (message, format!("{meant}give {file}, or a built-in case: {}", names.join(", ")))
}

/// What there is at a `path` without a file.
pub(super) fn nothing_at(path: &Path) -> &'static str {
    if path.is_dir() { "is a folder" } else { "no such file" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_case_is_valid_and_named_like_its_file() {
        for (name, text) in BUILTIN_CASES {
            let case = Case::parse(text, Path::new(name)).unwrap();
            assert_eq!(case.name, name);
        }
        let studies = BUILTIN_STUDIES.map(|(name, _)| name);
        let mut files: Vec<String> =
            std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/cases"))
                .unwrap()
                .map(|entry| entry.unwrap().file_name().into_string().unwrap())
                .filter_map(|file| file.strip_suffix(".toml").map(str::to_string))
                .filter(|name| !studies.contains(&name.as_str()))
                .collect();
        files.sort();
        assert_eq!(files, BUILTIN_CASES.map(|(name, _)| name), "cases/ against the built-in files");
    }
}
