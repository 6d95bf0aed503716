//! The CSV file of a sweep: one row for each case, in the order of the input. Rows are written as
//! soon as they are known, so that a stopped run can be continued.

use super::columns::Value;
use super::table::number;
use crate::base::{Error, Result};
use crate::case::Case;
use crate::host::check_memory;
use crate::solve::{END_DISTANCES, KeyResults};
use crate::study::sweep::Outcome;
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// What a row says besides its number, its parameters and its results.
#[derive(Debug, Clone, PartialEq)]
pub struct RowLabel {
    /// The cells of the sweep's own columns.
    pub cells: Vec<String>,
    /// The edge model.
    pub method: &'static str,
    /// The tolerance of the command line.
    pub tolerance: Option<f64>,
}

/// A number of a row's results.
type Number = fn(&Case, &KeyResults) -> f64;

/// The numbers of the results as far as the pressure.
const PRESSURES: [(&str, Number); 13] = [
    ("tolerance_p0", |case, _| case.accuracy.tolerance),
    ("load_factor", |case, _| case.factors().load),
    ("slenderness", |case, _| case.factors().slenderness),
    ("length_ratio", |case, _| case.factors().length_ratio),
    ("load_n", |_, found| found.load_n),
    ("c_m", |_, found| found.hertz.c_m),
    ("p0_pa", |_, found| found.hertz.p0_pa),
    ("approach_m", |_, found| found.approach_m),
    ("p_centre_pa", |_, found| found.p_centre * found.hertz.p0_pa),
    ("p_centre_p0", |_, found| found.p_centre),
    ("p_max_pa", |_, found| found.p_max * found.hertz.p0_pa),
    ("p_max_x_m", |_, found| found.p_max_at[0] * found.hertz.c_m),
    ("p_max_y_m", |_, found| found.p_max_at[1] * found.hertz.c_m),
];

/// Those of the critical stress.
const CRITICAL: [(&str, Number); 5] = [
    ("critical_von_mises_pa", |_, found| found.critical.value * found.hertz.p0_pa),
    ("critical_von_mises_p0", |_, found| found.critical.value),
    ("critical_x_m", |_, found| found.critical.at[0] * found.hertz.c_m),
    ("critical_y_m", |_, found| found.critical.at[1] * found.hertz.c_m),
    ("critical_z_m", |_, found| found.critical.at[2] * found.hertz.c_m),
];

/// The results of a row by their columns, in their order; of a row that failed, only `err` is
/// there.
pub fn results(outcome: &Outcome) -> Vec<(String, Value)> {
    let solved = outcome.as_ref().ok();
    let number = |name: &str, of: &dyn Fn(&Case, &KeyResults) -> f64| {
        let value = solved.map_or(f64::NAN, |(case, found)| of(case, found));
        (name.to_string(), Value::Number(value))
    };
    let text = |name: &str, text: &str| (name.to_string(), Value::Text(text.to_string()));
    let mut row: Vec<_> = PRESSURES.iter().map(|(name, of)| number(name, of)).collect();
    for (i, s) in END_DISTANCES.iter().enumerate() {
        row.push(number(&format!("p_{s}C_p0"), &|_, found| found.p_at[i].unwrap_or(f64::NAN)));
    }
    row.push(number("end_to_centre", &|_, found| {
        found.p_at[0].map_or(f64::NAN, |p| p / found.p_centre)
    }));
    row.push(text("critical_body", solved.map_or("", |(_, found)| found.critical.body.name())));
    row.extend(CRITICAL.iter().map(|(name, of)| number(name, of)));
    row.push(text("err", outcome.as_ref().err().map_or("", String::as_str)));
    row
}

/// The text on one line, so that each line of the file is a row.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// One line of CSV with its end.
fn line(cells: &[String]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(cells).expect("a vector takes a record");
    let bytes = writer.into_inner().expect("a vector takes all bytes");
    String::from_utf8(bytes).expect("text in, text out")
}

/// Opens a file, or creates it, and locks it for other processes.
fn open_locked(path: &Path) -> Result<File> {
    let io = |action| move |source| Error::Io { action, path: path.to_path_buf(), source };
    let mut options = OpenOptions::new();
    let file = options.read(true).write(true).create(true).truncate(false).open(path);
    let file = file.map_err(io("open"))?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(Error::Busy { path: path.to_path_buf(), pid: None }),
        // Some file systems have no locks. There the user must not start two runs into one file.
        Err(TryLockError::Error(e)) if e.kind() == std::io::ErrorKind::Unsupported => Ok(file),
        Err(TryLockError::Error(e)) => Err(io("lock")(e)),
    }
}

/// The file of a running sweep, locked for other processes.
#[derive(Debug)]
pub struct SweepFile {
    path: PathBuf,
    file: File,
    /// The rows of the file in order, and the place of the next one.
    order: Vec<usize>,
    next: usize,
    /// Rows that wait for an earlier row.
    waiting: BTreeMap<usize, String>,
    /// Number of rows of an earlier run.
    kept: usize,
    /// Number of rows with an `err`, including those of an earlier run.
    failed: usize,
}

impl SweepFile {
    /// Creates the file or continues an existing one. `columns` are the sweep's own; `order` holds
    /// the indices of the rows of the file, ascending; `label` gives the label of a row, by which
    /// the file of another sweep is recognised and refused.
    ///
    /// An incomplete last line, which a killed run may leave, is removed.
    ///
    /// # Errors
    /// [`Error::Busy`] when another process writes the file, [`Error::File`] when it is not the
    /// beginning of this sweep, and [`Error::Io`].
    pub fn open(
        path: &Path,
        columns: &[String],
        order: Vec<usize>,
        label: impl Fn(usize) -> RowLabel,
    ) -> Result<Self> {
        let io = |action| move |source| Error::Io { action, path: path.to_path_buf(), source };
        let mut file = open_locked(path)?;
        let header: Vec<String> = std::iter::once("row".to_string())
            .chain(columns.iter().map(|c| one_line(c)))
            .chain(["method".to_string()])
            .chain(results(&Err(String::new())).into_iter().map(|(name, _)| name))
            .collect();
        let header = line(&header);
        let size = file.metadata().map_err(io("read"))?.len();
        let what = format!("continuing {}", path.display());
        check_memory(&what, size as f64, "give another --out")?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(io("read"))?;
        let whole = bytes.iter().rposition(|b| *b == b'\n').map_or(0, |end| end + 1);
        // An incomplete row may end within a character.
        let text = String::from_utf8_lossy(&bytes[..whole]);
        let mut own = Self {
            path: path.to_path_buf(),
            file,
            order,
            next: 0,
            waiting: BTreeMap::new(),
            kept: 0,
            failed: 0,
        };
        if whole == 0 {
            if !header.as_bytes().starts_with(&bytes) {
                return Err(own.refuse(1, "holds something else than a sweep's rows".into()));
            }
            own.file.set_len(0).map_err(io("write"))?;
            own.append(&header, 0)?;
            return Ok(own);
        }
        if !text.starts_with(&header) {
            return Err(own.refuse(1, "has the columns of something else".into()));
        }
        own.recognise(&text, &label)?;
        own.file.set_len(whole as u64).map_err(io("write"))?;
        own.file.seek(SeekFrom::Start(whole as u64)).map_err(io("write"))?;
        Ok(own)
    }

    /// Checks the existing rows.
    fn recognise(&mut self, text: &str, label: &impl Fn(usize) -> RowLabel) -> Result<()> {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        for (i, record) in reader.records().enumerate() {
            let place = i + 2;
            let record = record.map_err(|e| self.refuse(place, e.to_string()))?;
            let Some(&row) = self.order.get(i) else {
                return Err(self.refuse(place, "has more rows than this sweep".into()));
            };
            let label = label(row);
            let start: Vec<String> = std::iter::once((row + 1).to_string())
                .chain(label.cells.iter().map(|c| one_line(c)))
                .chain([label.method.to_string()])
                .collect();
            let solved = record.get(start.len()).unwrap_or_default();
            let same = record.iter().zip(&start).all(|(a, b)| a == b)
                && label.tolerance.is_none_or(|t| solved.is_empty() || solved == number(t));
            if !same {
                let message = format!("is not row {} of this sweep by this method", row + 1);
                return Err(self.refuse(place, message));
            }
            self.failed += usize::from(record.iter().next_back().is_some_and(|e| !e.is_empty()));
            self.next = i + 1;
        }
        self.kept = self.next;
        Ok(())
    }

    fn refuse(&self, line: usize, message: String) -> Error {
        Error::File {
            path: self.path.clone(),
            line: Some(line),
            message,
            remedy: "give another --out, or remove the file".into(),
        }
    }

    /// Number of rows of an earlier run.
    pub fn kept(&self) -> usize {
        self.kept
    }

    /// Number of rows with an `err`.
    pub fn failed(&self) -> usize {
        self.failed
    }

    /// Whether a row is still to be written.
    pub fn wants(&self, row: usize) -> bool {
        self.order[self.next..].binary_search(&row).is_ok()
    }

    /// Adds a row. It is written as soon as all rows before it are written.
    ///
    /// # Errors
    /// [`Error::Io`] when the file cannot be written.
    pub fn add(&mut self, row: usize, label: &RowLabel, outcome: &Outcome) -> Result<()> {
        let mut cells = vec![(row + 1).to_string()];
        cells.extend(label.cells.iter().map(|c| one_line(c)));
        cells.push(label.method.to_string());
        cells.extend(results(outcome).into_iter().map(|(_, value)| match value {
            Value::Number(value) => number(value),
            Value::Text(text) => one_line(&text),
        }));
        self.failed += usize::from(outcome.is_err());
        self.waiting.insert(row, line(&cells));
        let mut ready = String::new();
        let mut rows = 0;
        while let Some(text) =
            self.order.get(self.next + rows).and_then(|row| self.waiting.remove(row))
        {
            ready.push_str(&text);
            rows += 1;
        }
        if rows == 0 { Ok(()) } else { self.append(&ready, rows) }
    }

    fn append(&mut self, text: &str, rows: usize) -> Result<()> {
        let io = |source| Error::Io { action: "write", path: self.path.clone(), source };
        // Rows in a removed file would be lost: it has no name any more.
        let identity = |data: std::fs::Metadata| (data.dev(), data.ino());
        let there = std::fs::metadata(&self.path).map_err(io)?;
        if identity(there) != identity(self.file.metadata().map_err(io)?) {
            return Err(io(std::io::Error::other(
                "another file was put in its place; run again to write all rows",
            )));
        }
        self.file.write_all(text.as_bytes()).map_err(io)?;
        self.next += rows;
        Ok(())
    }

    /// Stores the rows on the disk, so that they survive a power cut.
    ///
    /// # Errors
    /// [`Error::Io`] when they cannot be stored.
    pub fn finish(&self) -> Result<()> {
        let io = |source| Error::Io { action: "write", path: self.path.clone(), source };
        self.file.sync_data().map_err(io)
    }
}
