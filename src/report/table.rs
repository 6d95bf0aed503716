//! Tables of text as they stand in CSV files.

use crate::base::{Error, Result};
use crate::host::{check_memory, read_text};
use serde_json::{Value, json};
use std::path::Path;

/// A CSV table: a header and rows of the same width.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    /// Names of the columns.
    pub header: Vec<String>,
    /// The rows, each as wide as the header.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// An empty table with these columns.
    pub fn new<S: Into<String>>(header: impl IntoIterator<Item = S>) -> Self {
        Self { header: header.into_iter().map(Into::into).collect(), rows: Vec::new() }
    }

    /// Adds a row, which must be as wide as the header.
    pub fn push(&mut self, row: Vec<String>) {
        assert_eq!(row.len(), self.header.len(), "a row of another width than the header");
        self.rows.push(row);
    }

    /// Where the column called `name` stands.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|h| h == name)
    }

    /// The cell of a row in the column called `name`; empty where there is no such column.
    pub fn text<'a>(&self, row: &'a [String], name: &str) -> &'a str {
        self.column(name).map_or("", |c| row[c].as_str())
    }

    /// The cell as a number; `None` where it is empty or is none.
    pub fn number(&self, row: &[String], name: &str) -> Option<f64> {
        self.text(row, name).parse().ok()
    }

    /// The cell as a JSON number; null where it is empty or is none.
    pub fn json(&self, row: &[String], name: &str) -> Value {
        self.number(row, name).map_or(Value::Null, |v| json!(v))
    }

    /// The table as CSV.
    pub fn to_csv(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        // Writing to memory fails only for rows of unequal width, which `push` refuses.
        for row in std::iter::once(&self.header).chain(&self.rows) {
            writer.write_record(row).expect("rows of equal width");
        }
        let bytes = writer.into_inner().expect("a vector takes all bytes");
        String::from_utf8(bytes).expect("text in, text out")
    }

    /// Reads a CSV file.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be read, [`Error::File`] with the line when it is no table.
    pub fn read(path: &Path) -> Result<Self> {
        let text = read(path)?;
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let refuse = |e: csv::Error| Error::File {
            path: path.to_path_buf(),
            line: e.position().map(|p| p.line() as usize),
            message: e.to_string(),
            remedy: "run the study again".to_string(),
        };
        let header = reader.headers().map_err(refuse)?.iter().map(String::from).collect();
        let rows = reader
            .records()
            .map(|r| r.map(|r| r.iter().map(String::from).collect()))
            .collect::<std::result::Result<_, _>>()
            .map_err(refuse)?;
        Ok(Self { header, rows })
    }
}

/// A number for a CSV cell, seven significant digits; empty for what is not a finite number.
pub fn number(value: f64) -> String {
    if value == 0.0 {
        "0".to_string()
    } else if value.is_finite() {
        format!("{value:.6e}")
    } else {
        String::new()
    }
}

/// As [`number`], empty for `None`.
pub fn optional(value: Option<f64>) -> String {
    value.map(number).unwrap_or_default()
}

/// Larger files are refused, pipes and devices too, which do not tell their size (bytes).
const MAX_BYTES: u64 = 4 << 30;

/// Reads a text file of a run.
///
/// # Errors
/// [`Error::Io`] when it cannot be read, [`Error::Memory`] when it does not fit into memory, and
/// [`Error::File`] when it is not UTF-8.
pub fn read(path: &Path) -> Result<String> {
    let size = std::fs::metadata(path).map_or(0, |m| m.len());
    check_memory(&format!("reading {}", path.display()), size as f64, "give a smaller file")?;
    read_text(path, MAX_BYTES, "give a smaller file")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_survive_the_file() {
        let mut table = Table::new(["a", "b"]);
        table.push(vec!["with, comma and \"quote\"".to_string(), number(-0.001_234_567_89)]);
        table.push(vec![String::new(), optional(Some(f64::NAN))]);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.csv");
        std::fs::write(&path, table.to_csv()).unwrap();
        let back = Table::read(&path).unwrap();
        assert_eq!(back, table);
        assert_eq!(back.number(&back.rows[0], "b"), Some(-0.001_234_568));
        assert_eq!((back.number(&back.rows[1], "b"), back.text(&back.rows[0], "c")), (None, ""));
    }
}
