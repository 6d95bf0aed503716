//! The rows of a table in CSV, which are read anew each time and not kept.

use super::levels::MAX_ROWS;
use crate::base::{Error, Result};
use crate::host::{csv_fault, csv_line_from};
use csv::{ErrorKind, Position, ReaderBuilder, StringRecord};
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

/// Rows in their order, each the texts of its columns.
pub type RowCells<'a> = Box<dyn Iterator<Item = Result<Vec<String>>> + Send + 'a>;

/// A table with a header. All its rows are as long as that.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table {
    path: PathBuf,
    /// Its text, if it is not to be read from the file.
    text: Option<String>,
    /// The names in the header.
    pub header: Vec<String>,
    rows: usize,
}

impl Table {
    /// Reads the header of the file `path`, or of `text` in its place.
    ///
    /// # Errors
    /// [`Error::Io`] when the file cannot be read, [`Error::File`] when there is no header.
    pub fn new(path: &Path, text: Option<String>) -> Result<Self> {
        let (path, header) = (path.to_path_buf(), Vec::new());
        let mut own = Self { path, text, header, rows: 0 };
        let header = own.reader()?.headers().map(texts).map_err(|e| own.broken(e))?;
        own.header = header;
        Ok(own)
    }

    /// Reads all rows once and counts them.
    ///
    /// # Errors
    /// [`Error::File`] with the line of a row that is no CSV or of another length than the header,
    /// or when there are no rows or too many.
    pub fn counted(mut self) -> Result<Self> {
        self.rows = self.count()?;
        match self.rows {
            0 => Err(self.refuse(None, "has 0 rows", format!("give between 1 and {MAX_ROWS}"))),
            n if n > MAX_ROWS => {
                let message = format!("has more than {MAX_ROWS} rows");
                Err(self.refuse(None, &message, "split it into several files".into()))
            }
            _ => Ok(self),
        }
    }

    /// Number of rows, as far as one more than is allowed.
    fn count(&self) -> Result<usize> {
        let mut reader = self.reader()?;
        let mut record = StringRecord::new();
        let mut rows = 0;
        while rows <= MAX_ROWS && reader.read_record(&mut record).map_err(|e| self.broken(e))? {
            rows += 1;
        }
        Ok(rows)
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows
    }

    /// The rows.
    ///
    /// # Errors
    /// [`Error::Io`] when the file cannot be opened. A row is an error when the file has changed
    /// since its rows were counted.
    pub fn rows(&self) -> Result<RowCells<'_>> {
        let mut records = self.reader()?.into_records();
        let mut seen = 0;
        Ok(Box::new(std::iter::from_fn(move || match records.next() {
            Some(Ok(record)) if seen < self.rows => {
                seen += 1;
                Some(Ok(texts(&record)))
            }
            None if seen == self.rows => None,
            Some(Err(e)) => Some(Err(self.broken(e))),
            _ => {
                let remedy = "leave it as it is while the sweep runs";
                Some(Err(self.refuse(None, "has changed since the sweep began", remedy.into())))
            }
        })))
    }

    fn reader(&self) -> Result<csv::Reader<Box<dyn Read + Send + '_>>> {
        Ok(ReaderBuilder::new().trim(csv::Trim::All).from_reader(self.source()?))
    }

    fn source(&self) -> Result<Box<dyn Read + Send + '_>> {
        Ok(match &self.text {
            Some(text) => Box::new(text.as_bytes()),
            None => Box::new(File::open(&self.path).map_err(|e| self.unread(e))?),
        })
    }

    /// The line of a row, from 1; that of its reader if the table cannot be read again.
    fn line(&self, at: &Position) -> usize {
        let source = self.source().unwrap_or_else(|_| Box::new(std::io::empty()));
        let mut rest = BufReader::new(source);
        match std::io::copy(&mut rest.by_ref().take(at.byte()), &mut std::io::sink()) {
            Ok(_) => csv_line_from(at, rest, false),
            Err(_) => at.line() as usize,
        }
    }

    fn unread(&self, source: std::io::Error) -> Error {
        Error::Io { action: "read", path: self.path.clone(), source }
    }

    fn broken(&self, error: csv::Error) -> Error {
        let line = error.position().map(|at| self.line(at));
        let fault = csv_fault(&error);
        match error.into_kind() {
            ErrorKind::Io(source) => self.unread(source),
            ErrorKind::Utf8 { .. } => self.refuse(line, &fault, "save it as UTF-8".into()),
            _ => {
                let remedy = "give as many cells in every row as in the header";
                self.refuse(line, &fault, remedy.into())
            }
        }
    }

    fn refuse(&self, line: Option<usize>, message: &str, remedy: String) -> Error {
        Error::File { path: self.path.clone(), line, message: message.to_string(), remedy }
    }
}

/// The cells of a record.
fn texts(record: &StringRecord) -> Vec<String> {
    record.iter().map(str::to_string).collect()
}
