//! The file of a measured profile: CSV with the columns `y_m` and `drop_m`.

use crate::base::number::stated;
use crate::base::profile::Table;
use crate::base::{Error, Result};
use crate::host;
use std::path::Path;

/// Larger files are refused unread (bytes).
const MAX_BYTES: u64 = 1 << 20;

/// The header of a file.
const HEADER: &str = "y_m,drop_m";

/// Reads a table of drops: places y in metres from the body's middle, ascending, and drops in
/// metres.
///
/// # Errors
/// [`Error::Io`] when the file cannot be read; [`Error::File`] with the line that is wrong.
pub(super) fn read_profile_table(path: &Path) -> Result<Table> {
    let text =
        host::read_input(path, MAX_BYTES, "give a profile as CSV with the columns y_m,drop_m")?;
    let refuse = |line: usize, message: String, remedy: &str| Error::File {
        path: path.to_path_buf(),
        line: Some(line),
        message,
        remedy: remedy.into(),
    };
    let lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
    let mut rows = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let columns = |line: &str| line.split(',').map(str::trim).collect::<Vec<_>>().join(",");
    match rows.next() {
        Some((_, header)) if columns(header) == HEADER => {}
        found => {
            let line = found.map_or(1, |(line, _)| line);
            if let Some(message) = found.and_then(|(_, header)| host::other_separators(header)) {
                return Err(refuse(line, message, host::WRITE_COMMAS));
            }
            let message = format!("the first line is not the header {HEADER}");
            return Err(refuse(line, message, "name the columns, in metres"));
        }
    }
    let (mut places, mut drops) = (Vec::new(), Vec::new());
    for (line, row) in rows {
        let number = |word: &str| word.trim().parse().ok().filter(|v: &f64| v.is_finite());
        let numbers: Vec<Option<f64>> = row.split(',').map(number).collect();
        let [Some(y), Some(drop)] = numbers[..] else {
            let message = format!("{row:?} is not two finite numbers");
            return Err(refuse(
                line,
                message,
                "write y and drop in metres, with a comma between them",
            ));
        };
        if places.last().is_some_and(|last| y <= *last) {
            let message = format!("y = {} m does not lie beyond the line before it", stated(y));
            return Err(refuse(line, message, "sort the lines by y, with one drop for each y"));
        }
        places.push(y);
        drops.push(drop);
    }
    if places.len() < Table::LEAST {
        let message = format!("it has {} points", places.len());
        return Err(refuse(1, message, "give at least two, at both ends of the body"));
    }
    Ok(Table::new(places, drops))
}
