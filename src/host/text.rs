//! Text files of limited size.

use crate::base::{Error, Result};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// What some programs write before the text, to say that it is UTF-8.
pub const MARK: char = '\u{feff}';

/// Reads a text file of at most `most` bytes, without a mark of its byte order; `remedy` says what
/// to do about a larger one.
///
/// # Errors
/// [`Error::Io`] when it cannot be read, [`Error::File`] when it is larger or not UTF-8.
pub fn read_text(path: &Path, most: u64, remedy: &str) -> Result<String> {
    let io = |source| Error::Io { action: "read", path: path.to_path_buf(), source };
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(io)?;
    // A pipe, a device or a growing file can be longer than its stated length.
    file.take(most + 1).read_to_end(&mut bytes).map_err(io)?;
    let refuse = |message: String, remedy: &str| Error::File {
        path: path.to_path_buf(),
        line: None,
        message,
        remedy: remedy.to_string(),
    };
    if bytes.len() as u64 > most {
        return Err(refuse(format!("is larger than {} MiB", most >> 20), remedy));
    }
    let other = "give a text file, or save this one as UTF-8";
    let text = String::from_utf8(bytes).map_err(|_| refuse("is not UTF-8 text".into(), other))?;
    Ok(match text.strip_prefix(MARK) {
        Some(rest) => rest.to_string(),
        None => text,
    })
}

/// What is wrong with a CSV table's `header`, if something other than commas is between columns.
pub fn other_separators(header: &str) -> Option<String> {
    let known = [(';', "semicolons"), ('\t', "tabs")];
    let found = known.into_iter().find(|(mark, _)| !header.contains(',') && header.contains(*mark));
    found.map(|(_, name)| format!("has {name} between its columns"))
}

/// What to do about [`other_separators`].
pub const WRITE_COMMAS: &str = "write commas, and points in numbers";

/// What is wrong with the text of a CSV table, without the place, which errors have before it.
#[cfg(feature = "cli")]
pub fn csv_fault(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            let cells = if *len == 1 { "cell" } else { "cells" };
            format!("has {len} {cells} where the header has {expected_len}")
        }
        csv::ErrorKind::Utf8 { .. } => "is not UTF-8 text".to_string(),
        csv::ErrorKind::Deserialize { err, .. } => err.to_string(),
        _ => error.to_string(),
    }
}

/// The line of a record of the CSV table `text`, from 1, whose comments begin with #.
#[cfg(feature = "cli")]
pub fn csv_line(text: &str, at: &csv::Position) -> usize {
    csv_line_from(at, text.as_bytes().get(at.byte() as usize..).unwrap_or_default(), true)
}

/// The same with the `rest` of a table from the record on. It begins where the one before it ended:
/// empty lines are before it, and comments, if the table has some.
#[cfg(feature = "cli")]
pub fn csv_line_from(at: &csv::Position, rest: impl std::io::BufRead, comments: bool) -> usize {
    let other = |line: &String| line.is_empty() || comments && line.starts_with('#');
    at.line() as usize + rest.lines().map_while(|line| line.ok().filter(other)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_large_or_no_text_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("f");
        std::fs::write(&path, vec![b'x'; 2 << 20]).unwrap();
        assert_eq!(read_text(&path, 2 << 20, "").unwrap().len(), 2 << 20);
        let said = read_text(&path, 1 << 20, "give less").unwrap_err().to_string();
        assert!(said.ends_with("is larger than 1 MiB; give less"), "{said}");
        std::fs::write(&path, "\u{feff}y_m,drop_m\n").unwrap();
        assert_eq!(read_text(&path, 99, "").unwrap(), "y_m,drop_m\n");
        std::fs::write(&path, [0xff]).unwrap();
        assert!(read_text(&path, 9, "").unwrap_err().to_string().contains("UTF-8"));
        // A file without end is refused as well.
        assert!(read_text(Path::new("/dev/zero"), 9, "").is_err());
    }
}
