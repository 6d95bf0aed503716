//! `edgeline sweep`: many cases in one table.

use super::output::{Exit, print, print_json};
use super::progress::progress_bar;
use super::values::{checked_tolerance, count, edge_model};
use crate::base::Result;
use crate::body::EdgeModel;
use crate::case::{Sweep, find_draft};
use crate::host::prepare_folder;
use crate::report::sweep::{Label, SweepFile};
use crate::report::sweep_target::Target;
use crate::study::sweep::{self, Done, Outcome, Rows, Settings, Shard};
use clap::{Args, ValueHint};
use indicatif::ProgressBar;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Solves many cases: a grid or lists of parameters.
///
/// Writes one file with one row per case, in the order of the input: pressures at the centre
/// and towards the end, the largest stress and its place, and the approach. The row of a case that
/// cannot be solved gives the reason in `err`. The next run continues a sweep that was stopped.
/// Cases that differ only in scale are solved once. A case takes about ten milliseconds of
/// processor time at a tolerance of 1e-2.
#[derive(Args)]
pub(super) struct Arguments {
    /// A case file in which numbers may be lists or ranges (TOML), or a table with a column for
    /// each parameter (CSV, if its name ends in .csv)
    #[arg(value_hint = ValueHint::FilePath)]
    file: PathBuf,
    /// The file of the results, CSV or, if its name ends in .parquet, Parquet; existing rows are
    /// kept
    #[arg(long, value_name = "FILE", default_value = "sweep.csv", value_hint = ValueHint::FilePath)]
    out: PathBuf,
    /// A case file, or the name of a case that `edgeline cases` lists, for the values that a table
    /// has no column for
    #[arg(long, value_name = "CASE", value_hint = ValueHint::FilePath)]
    base: Option<PathBuf>,
    /// How the free ends of the bodies are modelled
    #[arg(long, default_value = "quarter-space", value_parser = edge_model())]
    method: EdgeModel,
    /// Accuracy of all cases as a fraction of p0, instead of their own
    #[arg(long)]
    tolerance: Option<f64>,
    /// Cases solved at the same time; one per processor by default
    #[arg(long, value_name = "N", value_parser = count("cases", 1..=1024))]
    jobs: Option<usize>,
    /// Solve only the i-th of n parts, for job arrays; each part needs its own --out
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// Print the summary as one JSON object and nothing else
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: Arguments) -> Result<Exit> {
    let began = Instant::now();
    let base = arguments.base.as_deref().map(find_draft).transpose()?;
    let sweep = Sweep::read(&arguments.file, base.as_ref())?;
    let settings = Settings {
        method: arguments.method,
        tolerance: arguments.tolerance.map(checked_tolerance).transpose()?,
    };
    if let Some(folder) = arguments.out.parent().filter(|p| *p != Path::new("")) {
        prepare_folder(folder)?;
    }
    let label = Label { method: settings.method.name(), tolerance: settings.tolerance };
    let mut target = Target::new(&arguments.out)?;
    let file = target.open(sweep.columns(), label)?;

    let bar = progress_bar();
    bar.set_length((sweep.len() / arguments.shard.map_or(1, |shard| shard.count)) as u64);
    let mut rows = Shown { file, bar };
    let solving = Instant::now();
    let done = sweep::run(&sweep, &settings, arguments.shard, jobs(&arguments), &mut rows);
    let Shown { mut file, bar } = rows;
    bar.finish_and_clear();
    let done = done.and_then(|done| file.finish().map(|()| done));
    let Done { rows, problems } = done.inspect_err(|_| target.leave())?;
    let solving = solving.elapsed().as_secs_f64();
    target.finish()?;
    let summary = SweepSummary {
        rows_of_sweep: sweep.len(),
        rows,
        kept: file.kept(),
        failed: file.failed(),
        problems,
        seconds: began.elapsed().as_secs_f64(),
        solving,
    };
    if arguments.json {
        print_json(&summary.json(&arguments))?;
    } else {
        print(&summary.text(&arguments))?;
    }
    Ok(Exit::Done)
}

/// The rows of a file with a bar of how many are there.
struct Shown {
    file: SweepFile,
    bar: ProgressBar,
}

impl Rows<Vec<String>> for Shown {
    fn has(&mut self, row: usize, cells: &Vec<String>) -> Result<bool> {
        let there = self.file.has(row, cells)?;
        self.bar.inc(u64::from(there));
        Ok(there)
    }

    fn check(&mut self, row: usize, outcome: &Outcome) -> Result<()> {
        self.file.check(row, outcome)
    }

    fn add(&mut self, row: usize, cells: &Vec<String>, outcome: &Outcome) -> Result<()> {
        self.bar.inc(1);
        self.file.add(row, cells, outcome)
    }
}

/// Number of cases solved at the same time.
fn jobs(arguments: &Arguments) -> usize {
    let all = || std::thread::available_parallelism().map_or(1, usize::from);
    arguments.jobs.unwrap_or_else(all)
}

/// The ending of the name of `count` things.
fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}

/// The results in numbers.
struct SweepSummary {
    rows_of_sweep: usize,
    /// Rows of this part of it.
    rows: usize,
    /// Rows that were in the file before.
    kept: usize,
    /// Rows with an `err`.
    failed: usize,
    /// Contact problems solved.
    problems: usize,
    /// Time of everything, and of solving alone (s).
    seconds: f64,
    solving: f64,
}

impl SweepSummary {
    /// Rows solved a second.
    fn rate(&self) -> f64 {
        if self.rows > self.kept { (self.rows - self.kept) as f64 / self.solving } else { 0.0 }
    }

    fn json(&self, arguments: &Arguments) -> serde_json::Value {
        json!({
            "file": arguments.file.display().to_string(),
            "out": arguments.out.display().to_string(),
            "method": arguments.method.name(),
            "rows_of_sweep": self.rows_of_sweep,
            "rows": self.rows,
            "rows_kept": self.kept,
            "rows_failed": self.failed,
            "problems_solved": self.problems,
            "jobs": jobs(arguments),
            "seconds": self.seconds,
            "rows_per_second": self.rate(),
        })
    }

    /// The short summary for a reader.
    fn text(&self, arguments: &Arguments) -> String {
        let SweepSummary { rows, kept, failed, problems, solving, .. } = self;
        let before = if *kept > 0 { format!(", {kept} of them before") } else { String::new() };
        let failures = if *failed > 0 { format!(", {failed} with an err") } else { String::new() };
        format!(
            "{rows} row{}{before}{failures}; {problems} problem{} solved by {} in {solving:.1} s, {:.0} \
             rows a second\nwrote {}\n",
            plural(*rows),
            plural(*problems),
            arguments.method,
            self.rate(),
            arguments.out.display()
        )
    }
}
