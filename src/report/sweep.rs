//! The CSV file of a sweep: one row for each case, in the order of the input. Rows are written as
//! soon as they are known, so that a stopped run can be continued.

use super::columns::Value;
use super::table::number;
use crate::base::{Error, Result};
use crate::case::Case;
use crate::solve::{END_DISTANCES, KeyResults};
use crate::study::sweep::{Outcome, Rows};
use csv::StringRecord;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufRead, BufReader, Lines, Read, Seek, SeekFrom, Take, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// The columns of texts; all others but `row` are numbers.
#[cfg(feature = "parquet")]
pub(super) const TEXTS: [&str; 5] = ["name", "method", "critical_body", "warnings", "err"];

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
    row.push(text(
        "warnings",
        &solved.map_or(String::new(), |(_, found)| found.warnings.join(" ")),
    ));
    row.push(text("err", outcome.as_ref().err().map_or("", String::as_str)));
    row
}

/// The text on one line, so that each line of the file is a row.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// One line of CSV with its end.
pub(super) fn line(cells: &[String]) -> String {
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

/// What stands in the rows of a sweep besides its own columns and its results.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// The edge model.
    pub method: &'static str,
    /// The tolerance of the command line.
    pub tolerance: Option<f64>,
}

/// The file of a running sweep, locked for other processes. It is read and written row by row.
#[derive(Debug)]
pub struct SweepFile {
    path: PathBuf,
    file: File,
    label: Label,
    /// The rows of an earlier run that are still to be recognised.
    before: Option<Lines<Take<BufReader<File>>>>,
    /// Where they end (bytes).
    whole: u64,
    /// The line of the next row, from 1.
    line: usize,
    /// The row of an earlier run that was recognised last.
    last: StringRecord,
    /// Number of rows of an earlier run.
    kept: usize,
    /// Number of rows with an `err`, including those of an earlier run.
    failed: usize,
}

/// The relative difference of results that is rounding, and what counts as zero (p0, C, or SI
/// units).
const ROUNDING: f64 = 1e-5;
const LEAST: f64 = 1e-7;

impl SweepFile {
    /// Creates the file or continues an existing one. `columns` are the sweep's own.
    ///
    /// An incomplete last line, which a killed run may leave, is removed.
    ///
    /// # Errors
    /// [`Error::Busy`] when another process writes the file, [`Error::File`] when it is not that of
    /// a sweep with these columns, and [`Error::Io`].
    pub fn open(path: &Path, columns: &[String], label: Label) -> Result<Self> {
        let io = |action| move |source| Error::Io { action, path: path.to_path_buf(), source };
        let file = open_locked(path)?;
        let whole = whole_lines(&file).map_err(io("read"))?;
        let header = line(&header_names(columns));
        let reader = BufReader::new(file.try_clone().map_err(io("read"))?);
        let mut own = Self {
            path: path.to_path_buf(),
            file,
            label,
            before: None,
            whole,
            line: 2,
            last: StringRecord::new(),
            kept: 0,
            failed: 0,
        };
        let mut reader = reader.take(header.len() as u64);
        let mut start = Vec::new();
        reader.read_to_end(&mut start).map_err(io("read"))?;
        if whole == 0 {
            if !header.as_bytes().starts_with(&start) {
                return Err(own.refuse(1, "holds something else than a sweep's rows".into()));
            }
            own.file.set_len(0).map_err(io("write"))?;
            own.file.seek(SeekFrom::Start(0)).map_err(io("write"))?;
            own.append(&header)?;
            return Ok(own);
        }
        if start != header.as_bytes() {
            return Err(own.refuse(1, "has the columns of something else".into()));
        }
        own.before = Some(reader.into_inner().take(whole - header.len() as u64).lines());
        Ok(own)
    }

    /// The next row of an earlier run, its cells; none if there is no more, and new ones can be
    /// added.
    fn next_before(&mut self) -> Result<Option<StringRecord>> {
        let io = |action, source| Error::Io { action, path: self.path.clone(), source };
        let Some(lines) = &mut self.before else { return Ok(None) };
        let Some(line) = lines.next() else {
            self.before = None;
            self.file.set_len(self.whole).map_err(|e| io("write", e))?;
            self.file.seek(SeekFrom::Start(self.whole)).map_err(|e| io("write", e))?;
            return Ok(None);
        };
        let line = line.map_err(|e| io("read", e))?;
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(line.as_bytes());
        let mut record = StringRecord::new();
        let read = reader.read_record(&mut record);
        read.map_err(|e| self.refuse(self.line, e.to_string()))?;
        Ok(Some(record))
    }

    fn refuse(&self, line: usize, message: String) -> Error {
        Error::File {
            path: self.path.clone(),
            line: Some(line),
            message,
            remedy: "give another --out, or remove the file".into(),
        }
    }

    /// The cells of a row before its results.
    fn start(&self, row: usize, cells: &[String]) -> Vec<String> {
        std::iter::once((row + 1).to_string())
            .chain(cells.iter().map(|c| one_line(c)))
            .chain([self.label.method.to_string()])
            .collect()
    }

    /// Number of rows of an earlier run.
    pub fn kept(&self) -> usize {
        self.kept
    }

    /// Number of rows with an `err`.
    pub fn failed(&self) -> usize {
        self.failed
    }

    fn append(&mut self, text: &str) -> Result<()> {
        let io = |source| Error::Io { action: "write", path: self.path.clone(), source };
        // Rows in a removed file would be lost: it has no name any more.
        let identity = |data: std::fs::Metadata| (data.dev(), data.ino());
        let there = std::fs::metadata(&self.path).map_err(io)?;
        if identity(there) != identity(self.file.metadata().map_err(io)?) {
            return Err(io(std::io::Error::other(
                "another file was put in its place; run again to write all rows",
            )));
        }
        self.file.write_all(text.as_bytes()).map_err(io)
    }

    /// Stores the rows on the disk, so that they survive a power cut.
    ///
    /// # Errors
    /// [`Error::Io`] when they cannot be stored, [`Error::File`] when the file has more rows than
    /// the sweep.
    pub fn finish(&mut self) -> Result<()> {
        if self.next_before()?.is_some() {
            return Err(self.refuse(self.line, "has more rows than this sweep".into()));
        }
        let io = |source| Error::Io { action: "write", path: self.path.clone(), source };
        self.file.sync_data().map_err(io)
    }
}

impl Rows<Vec<String>> for SweepFile {
    /// Checks a row of an earlier run.
    fn has(&mut self, row: usize, cells: &Vec<String>) -> Result<bool> {
        let Some(record) = self.next_before()? else { return Ok(false) };
        let start = self.start(row, cells);
        let solved = record.get(start.len()).unwrap_or_default();
        let same = record.iter().zip(&start).all(|(a, b)| says_same(a, b))
            && self.label.tolerance.is_none_or(|t| solved.is_empty() || solved == number(t));
        if !same {
            let message = format!("is not row {} of this sweep by this method", row + 1);
            return Err(self.refuse(self.line, message));
        }
        self.failed += usize::from(record.iter().next_back().is_some_and(|e| !e.is_empty()));
        self.kept += 1;
        self.line += 1;
        self.last = record;
        Ok(true)
    }

    fn check(&mut self, row: usize, outcome: &Outcome) -> Result<()> {
        let results = results(outcome);
        let before = self.last.iter().skip(self.last.len().saturating_sub(results.len()));
        for ((name, value), before) in results.iter().zip(before) {
            let (same, now) = match value {
                Value::Number(value) => {
                    let found = before.parse().unwrap_or(f64::NAN);
                    (agree(found, *value), number(*value))
                }
                Value::Text(text) => (before == one_line(text), text.clone()),
            };
            if !same {
                let message = format!(
                    "row {} has {name} = {before:?}, and this sweep finds {now:?}: another base, other settings or \
                     another version made it",
                    row + 1
                );
                return Err(self.refuse(self.line - 1, message));
            }
        }
        Ok(())
    }

    fn add(&mut self, row: usize, cells: &Vec<String>, outcome: &Outcome) -> Result<()> {
        let mut cells = self.start(row, cells);
        cells.extend(results(outcome).into_iter().map(|(_, value)| match value {
            Value::Number(value) => number(value),
            Value::Text(text) => one_line(&text),
        }));
        self.failed += usize::from(outcome.is_err());
        self.append(&line(&cells))
    }
}

/// The header of a sweep with these columns of its own.
pub(super) fn header_names(columns: &[String]) -> Vec<String> {
    let results = results(&Err(String::new())).into_iter().map(|(name, _)| name);
    let own = columns.iter().map(|c| one_line(c));
    let start = std::iter::once("row".to_string()).chain(own).chain(["method".to_string()]);
    start.chain(results).collect()
}

/// Whether two results of one problem are the same, but for what another processor rounds.
fn agree(a: f64, b: f64) -> bool {
    a.is_nan() && b.is_nan() || (a - b).abs() <= ROUNDING * a.abs().max(b.abs()).max(LEAST)
}

/// Whether a cell of an earlier run says what is now to stand there. Numbers may be written
/// otherwise, and what was no number may be missing.
fn says_same(before: &str, now: &str) -> bool {
    let number = |text: &str| text.parse::<f64>().ok();
    before == now
        || match number(now) {
            Some(now) => number(before) == Some(now),
            None => before.is_empty(),
        }
}

/// Length of a file up to its last end of a line (bytes).
fn whole_lines(mut file: &File) -> std::io::Result<u64> {
    let mut end = file.metadata()?.len();
    let mut part = vec![0; 1 << 16];
    while end > 0 {
        let start = end.saturating_sub(part.len() as u64);
        let part = &mut part[..(end - start) as usize];
        file.seek(SeekFrom::Start(start))?;
        file.read_exact(part)?;
        if let Some(at) = part.iter().rposition(|b| *b == b'\n') {
            end = start + at as u64 + 1;
            break;
        }
        end = start;
    }
    file.seek(SeekFrom::Start(0))?;
    Ok(end)
}
