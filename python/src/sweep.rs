//! Many cases on all processors.

use crate::case::Case;
use crate::errors::{Error, raised};
use crate::tables::table;
use crate::work::{PATIENCE, guarded, panicked};
use edgeline::base;
use edgeline::cli::values::checked_tolerance;
use edgeline::report::columns::{Columns, Value};
use edgeline::report::sweep::results;
use edgeline::study::sweep as rows;
use edgeline::study::sweep::{Outcome, Rows, Settings, Shard};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};

/// A row and what became of it.
type Row = (usize, Outcome);

/// Solves cases and returns which rows were solved, and their table; `progress` gets the number of
/// rows that are done, and of all.
#[pyfunction]
#[pyo3(signature = (cases, method, tolerance, jobs, shard, progress))]
pub fn sweep<'py>(
    py: Python<'py>,
    cases: Vec<Bound<'py, Case>>,
    method: &str,
    tolerance: Option<f64>,
    jobs: Option<usize>,
    shard: Option<[usize; 2]>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Bound<'py, PyArray1<i64>>, Bound<'py, PyDict>)> {
    let cases: Vec<edgeline::case::Case> = cases.iter().map(|case| case.get().0.clone()).collect();
    let settings = Settings {
        method: method.parse().map_err(raised)?,
        tolerance: tolerance.map(checked_tolerance).transpose().map_err(raised)?,
    };
    // The text is the command line's, and so is its check.
    let shard: Option<Shard> = shard
        .map(|[index, count]| format!("{index}/{count}").parse())
        .transpose()
        .map_err(|e: String| Error::new_err(format!("shard: {e}")))?;
    let jobs = jobs.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
    let (rows, columns) = guarded(py, |_| {
        let solved = run(&cases, &settings, shard, jobs, progress.as_ref())?;
        let named = |(row, outcome): &Row| {
            let name = cases.get(*row).map_or("", |case| &case.name);
            let mut columns = vec![
                ("case".to_string(), Value::Text(name.to_string())),
                ("method".to_string(), Value::Text(settings.method.name().to_string())),
            ];
            columns.extend(results(outcome));
            columns
        };
        let columns = match solved.is_empty() {
            // Without rows there are the same columns.
            true => Columns::of_rows("sweep", [named(&(0, Err(String::new())))]).without_rows(),
            false => Columns::of_rows("sweep", solved.iter().map(named)),
        };
        let rows: Vec<i64> = solved.iter().map(|(row, _)| *row as i64).collect();
        PyResult::Ok((rows, columns))
    })??;
    Ok((rows.into_pyarray(py), table(py, columns)?))
}

/// Solves the cases beside this thread, which alone talks to Python.
fn run(
    cases: &Vec<edgeline::case::Case>,
    settings: &Settings,
    shard: Option<Shard>,
    jobs: usize,
    progress: Option<&Py<PyAny>>,
) -> PyResult<Vec<Row>> {
    let total = match shard {
        None => cases.len(),
        Some(_) => rows::count(cases, settings, shard).map_err(raised)?,
    };
    let (give, take) = channel();
    std::thread::scope(|scope| {
        let solving = scope.spawn(|| rows::run(cases, settings, shard, jobs, &mut Given(give)));
        // Nobody takes rows any more where this fails, which ends the solving.
        let rows = collect(take, total, progress)?;
        solving.join().map_err(|_| panicked())?.map_err(raised)?;
        Ok(rows)
    })
}

/// Rows on their way to the thread that talks to Python.
struct Given(Sender<Row>);

impl Rows<()> for Given {
    fn has(&mut self, _: usize, (): &()) -> base::Result<bool> {
        Ok(false)
    }

    fn add(&mut self, row: usize, (): &(), outcome: &Outcome) -> base::Result<()> {
        self.0.send((row, outcome.clone())).map_err(|e| {
            let source = std::io::Error::other(e.to_string());
            base::Error::Io { action: "hand on", path: "a row".into(), source }
        })
    }
}

/// Takes the rows as they come; tells `progress`, and listens to signals.
fn collect(take: Receiver<Row>, total: usize, progress: Option<&Py<PyAny>>) -> PyResult<Vec<Row>> {
    let mut rows = Vec::with_capacity(total);
    loop {
        match take.recv_timeout(PATIENCE) {
            Ok(row) => rows.push(row),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(rows),
        }
        rows.extend(take.try_iter());
        Python::attach(|py| {
            py.check_signals()?;
            progress.map_or(Ok(()), |to| to.call1(py, (rows.len(), total)).map(drop))
        })?;
    }
}
