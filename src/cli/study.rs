//! `edgeline study`: every case by every model, against FEM.

use super::cold::ColdRuns;
use super::fem::{FemOptions, Size};
use super::solve::edge_model;
use super::{Outcome, print, print_json, say};
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::{Case, Study};
use crate::fem;
use crate::host::{self, Lock, check_memory};
use crate::report::page;
use crate::report::study_files::{Context, StudyFiles};
use crate::solve::{Options, Solution, solve_group};
use crate::study::bench::{Bench, Speedup};
use crate::study::gate::{self, Baseline, Gates};
use crate::study::live::Live;
use crate::study::{Range, Reference, Setup, StudyRun, reference, run as run_study};
use clap::{Args, ValueEnum, ValueHint};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// Runs a study: every case by every model, compared with finite elements.
///
/// Writes study.csv (one row a case and source), curves.csv, pressure.csv, fem_error.csv,
/// errors.csv (one row a case, model, curve and quantity), effects.csv, summary.json, plots/*.svg,
/// report.html and report.md into the output folder. With recorded finite-element curves it takes
/// half a minute, nearly all of it for timing (--repeats 0: some seconds); with --fem live, minutes
/// a case.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    what: What,
    /// Warm repeats of each model's timing; 0 leaves the timing out
    #[arg(long, default_value_t = 7, value_name = "N")]
    repeats: usize,
    /// Print the summary as one JSON object and nothing else
    #[arg(long)]
    json: bool,
}

/// Where FEM's curves come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum FemSource {
    /// The recorded curves: those built into the program, or those of --reference
    Recorded,
    /// gmsh and FEniCSx, now
    Live,
}

impl FemSource {
    pub(super) fn name(self) -> &'static str {
        match self {
            FemSource::Recorded => "recorded",
            FemSource::Live => "live",
        }
    }
}

/// What a study and its gates have in common.
#[derive(Args)]
pub(super) struct What {
    /// A study file; the built-in two-level factorial study if left out
    #[arg(value_hint = ValueHint::FilePath)]
    study: Option<PathBuf>,
    /// Folder for the results; made if it is not there
    #[arg(long, default_value = "out", value_hint = ValueHint::DirPath)]
    pub(super) out: PathBuf,
    /// Models to run, separated by commas; all of them if left out
    #[arg(long, value_delimiter = ',', value_parser = edge_model())]
    methods: Vec<EdgeModel>,
    /// Where the finite-element curves come from
    #[arg(long, value_enum, default_value = "recorded")]
    pub(super) fem: FemSource,
    /// Folder of recorded curves, one folder a case, in place of those built into the program
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    reference: Option<PathBuf>,
    /// Distance from the roller's edge within which stresses are not compared, in half-widths C
    #[arg(long, value_name = "C", default_value_t = 0.1, value_parser = distance)]
    exclude: f64,
    /// The same for pressure, separated by commas; summaries use the first
    #[arg(long, value_name = "C,C", default_values_t = [0.1, 0.2], value_delimiter = ',', value_parser = distance)]
    exclude_pressure: Vec<f64>,
    /// Runs of the finite elements of each case with --fem live: their median counts
    #[arg(long, value_name = "N", default_value_t = 2)]
    fem_repeats: usize,
    /// Factor of the images of guilbault, in place of the one that follows from Poisson's ratio
    #[arg(long, value_parser = factor)]
    psi: Option<f64>,
    #[command(flatten)]
    size: Size,
    #[command(flatten)]
    options: FemOptions,
}

/// Parses the factor of images.
fn factor(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=2.0).contains(&value) => Ok(value),
        _ => Err("give a factor between 0 and 2".into()),
    }
}

/// The recorded FEM curves: those built into the program, or those of a folder.
pub(super) struct Records(Option<Vec<fem::Reference>>);

impl Records {
    /// Those below `folder`; the built-in ones without it.
    pub(super) fn read(folder: Option<&Path>) -> Result<Self> {
        folder.map(fem::Reference::read_all).transpose().map(Self)
    }

    /// The record of a case, if there is one.
    pub(super) fn find(&self, case: &Case) -> Result<Option<fem::Reference>> {
        match &self.0 {
            Some(all) => Ok(all.iter().find(|r| r.is_of(case)).cloned()),
            None => fem::Reference::embedded_of(case),
        }
    }
}

/// Memory that a case's curves take by one model or FEM, with their rows in the tables (bytes).
const CASE_BYTES: f64 = 2e6;

/// Parses a distance in units of C.
fn distance(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=10.0).contains(&value) => Ok(value),
        _ => Err("give a distance between 0 and 10 C".into()),
    }
}

impl What {
    /// The study of a file, or the built-in one.
    pub(super) fn find_study(&self) -> Result<Study> {
        self.study.as_deref().map_or_else(|| Ok(Study::built_in()), Study::read)
    }

    /// The range of the errors.
    fn range(&self) -> Range {
        Range { stress_c: self.exclude, pressure_c: self.exclude_pressure.clone() }
    }

    /// The models, simplest first.
    fn methods(&self) -> Vec<EdgeModel> {
        let wanted = |m: &EdgeModel| self.methods.is_empty() || self.methods.contains(m);
        EdgeModel::ALL.into_iter().filter(wanted).collect()
    }

    /// Runs `study` with live FEM in folders below the one for the results.
    pub(super) fn run(&self, study: &Study, repeats: usize) -> Result<StudyRun> {
        let folder = &self.out;
        let (cases, models) = (study.cases().count(), self.methods().len());
        check_memory(
            &format!("a study of {cases} cases by {models} models"),
            CASE_BYTES * (cases * (models + 1)) as f64,
            "give fewer cases or models, or take a sweep",
        )?;
        let live = match self.fem {
            FemSource::Live => {
                Some(Live::new(self.options.settings(self.size.size), self.fem_repeats)?)
            }
            FemSource::Recorded => None,
        };
        let recorded = Records::read(self.reference.as_deref())?;
        let times = Bench::recorded()?;
        let cold = ColdRuns::new(folder);
        let bar = progress_bar();
        let answer = |case: &Case| -> std::result::Result<Reference, String> {
            if let Some(live) = &live {
                let say = |text: &str| bar.set_message(format!("{}: {text}", case.name));
                return live
                    .run(case, &folder.join("fem").join(&case.name), &say)
                    .map_err(|e| e.to_string());
            }
            match recorded.find(case) {
                Ok(Some(r)) => {
                    let mut answer = reference::from_fem(&r);
                    answer.provenance.timed = times.timed(case);
                    Ok(answer)
                }
                Ok(None) => Err("there is no record of it".to_string()),
                Err(e) => Err(e.to_string()),
            }
        };
        let run = run_study(
            study,
            &Setup {
                methods: self.methods(),
                range: self.range(),
                repeats,
                solver: &|cases, method| {
                    solve_group(cases, &Options { psi: self.psi, ..Options::new(method) })
                },
                cold: &|case, method, threads| cold.seconds(case, method, threads),
                reference: &answer,
                progress: &|done, all, what| {
                    bar.set_length(all as u64);
                    bar.set_position(done as u64);
                    bar.set_message(what.to_string());
                },
            },
        );
        bar.finish_and_clear();
        // What was asked to stop is no study, even though every case has a row.
        host::check_interrupt()?;
        for case in &run.cases {
            for m in &case.methods {
                if let Err(message) = &m.answer {
                    say(&format!("warning: {} by {}: {message}", case.case.name, m.method));
                }
            }
        }
        Ok(run)
    }
}

/// All standard curves of both bodies.
pub(super) fn solve_all(cases: &[Case], method: EdgeModel) -> Vec<Result<Solution>> {
    solve_group(cases, &Options::new(method))
}

/// A bar on a terminal and nothing elsewhere.
pub(super) fn progress_bar() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}");
    bar.set_style(style.expect("a constant template"));
    bar
}

pub(super) fn run(arguments: Arguments) -> Result<Outcome> {
    let began = Instant::now();
    let date = now();
    let study = arguments.what.find_study()?;
    let out = &arguments.what.out;
    let _lock = Lock::claim(out)?;
    let run = arguments.what.run(&study, arguments.repeats)?;
    if run.cases.iter().flat_map(|c| &c.methods).all(|m| m.answer.is_err()) {
        return Err(first_failure(&run));
    }
    // The thresholds are made for the built-in study; another one has its own in `edgeline gate`.
    let outcomes = match arguments.what.study {
        Some(_) => Vec::new(),
        None => {
            let gates = built_in_gates()?;
            let usual = arguments.what.range() == Range::default();
            let drift = if usual { gates.drift } else { None };
            gate::evaluate(&run, &Gates { drift, ..gates }, Some(&built_in_baseline()?))
        }
    };
    let speedups: Vec<Speedup> = match arguments.what.fem {
        FemSource::Recorded => {
            let times = Bench::recorded()?;
            study.cases().flat_map(|case| times.speedups_of(case)).collect()
        }
        FemSource::Live => Vec::new(),
    };
    let files = StudyFiles::of(
        &run,
        &Context {
            date: &date,
            command: &command_line(),
            fem: arguments.what.fem.name(),
            machine: (&processor(), rayon::current_num_threads()),
            seconds: began.elapsed().as_secs_f64(),
            gates: &outcomes,
            speedups: &speedups,
        },
    );
    page::write_run(&files, out)?;
    if arguments.json {
        print_json(&files.summary)?;
    } else {
        print(&text(&files, out))?;
    }
    Ok(Outcome::Done)
}

/// The short summary for a reader.
fn text(files: &StudyFiles, out: &Path) -> String {
    let mut text = String::new();
    for line in files.summary["verdict"].as_array().into_iter().flatten() {
        text.push_str(line.as_str().unwrap_or_default());
        text.push('\n');
    }
    for line in files.summary["not_done"].as_array().into_iter().flatten() {
        text.push_str("note: ");
        text.push_str(line.as_str().unwrap_or_default());
        text.push('\n');
    }
    text + &format!("wrote report.html, report.md, tables and plots into {}\n", out.display())
}

/// Why nothing at all could be solved.
fn first_failure(run: &StudyRun) -> Error {
    let first = run.cases.iter().flat_map(|c| &c.methods).find_map(|m| m.answer.as_ref().err());
    Error::Value {
        key: "study".to_string(),
        value: run.study.clone(),
        reason: first.map_or_else(|| "it has no cases".to_string(), Clone::clone),
        remedy: "no case could be solved; try one of them with `edgeline solve`".to_string(),
    }
}

/// The thresholds built into the program.
pub(super) fn built_in_gates() -> Result<Gates> {
    gate::parse(gate::DEFAULT_GATES, Path::new("gates.toml"))
}

/// The accepted numbers built into the program.
pub(super) fn built_in_baseline() -> Result<Baseline> {
    Baseline::parse(gate::DEFAULT_BASELINE, Path::new("baseline.json"))
}

/// The command that was given, as one can give it again.
pub(super) fn command_line() -> String {
    let quoted = |a: String| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,+:".contains(c);
        if a.chars().all(plain) && !a.is_empty() {
            a
        } else {
            format!("'{}'", a.replace('\'', "'\\''"))
        }
    };
    let rest = std::env::args_os().skip(1).map(|a| quoted(a.to_string_lossy().into_owned()));
    std::iter::once("edgeline".to_string()).chain(rest).collect::<Vec<_>>().join(" ")
}

/// The processor's name as the system states it.
pub(super) fn processor() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    info.lines()
        .find_map(|l| l.strip_prefix("model name")?.split_once(':'))
        .map_or_else(|| std::env::consts::ARCH.to_string(), |(_, name)| name.trim().to_string())
}

/// The time now (UTC) as ISO 8601.
pub(super) fn now() -> String {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs());
    iso_8601(since)
}

/// Seconds since 1970 as a date and time, by the proleptic Gregorian calendar of 400-year periods.
fn iso_8601(seconds: u64) -> String {
    let (days, rest) = (seconds / 86_400, seconds % 86_400);
    // Days since 1 March 0000, so that the leap day ends a year.
    let shifted = days + 719_468;
    let (period, day) = (shifted / 146_097, shifted % 146_097);
    let year_of_period = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day_of_year = day - (365 * year_of_period + year_of_period / 4 - year_of_period / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day_of_month = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = period * 400 + year_of_period + u64::from(month <= 2);
    let (h, m, s) = (rest / 3600, rest / 60 % 60, rest % 60);
    format!("{year:04}-{month:02}-{day_of_month:02}T{h:02}:{m:02}:{s:02}Z")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_of_known_seconds() {
        assert_eq!(iso_8601(0), "1970-01-01T00:00:00Z");
        assert_eq!(iso_8601(951_782_400), "2000-02-29T00:00:00Z");
        assert_eq!(iso_8601(1_709_251_199), "2024-02-29T23:59:59Z");
        assert_eq!(iso_8601(4_102_444_800), "2100-01-01T00:00:00Z");
    }
}
