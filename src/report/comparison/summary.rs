//! `summary.json` of a comparison, and its verdict in words.

use crate::base::HertzScales;
use crate::base::number::{fixed, significant};
use crate::body::EdgeModel;
use crate::study::brought::{Comparison, FileRun, UNSTATED_ERROR};
use crate::study::gate::GateOutcome;
use crate::study::{ErrorRow, Range};
use serde::Serialize;

/// What a comparison does not know of itself.
pub struct Context<'a> {
    /// The time.
    pub date: &'a str,
    /// The command.
    pub command: &'a str,
    /// Whether the limits are those of a file.
    pub own_limits: bool,
}

/// The largest and the root-mean-square error, each the worst of all curves (p0).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Worst {
    /// The largest error.
    pub max: f64,
    /// The largest RMS of a curve.
    pub rms: f64,
}

/// The errors of a source against a file's curves.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SourceErrors {
    /// The model, or `fem`.
    pub source: String,
    /// Of the pressure, outside the first range.
    pub pressure: Option<Worst>,
    /// Of the stress components.
    pub stress: Option<Worst>,
    /// Of the von Mises stress.
    pub von_mises: Option<Worst>,
}

/// A file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FileSummary {
    /// What its curves are called.
    pub name: String,
    /// Where it was.
    pub path: String,
    /// Units and axes in words.
    pub units: String,
    /// Number of curves and lines.
    pub curves: usize,
    /// Number of points.
    pub points: usize,
    /// The error that it states (p0).
    pub error_p0: Option<f64>,
    /// Columns that mean nothing here.
    pub ignored_columns: Vec<String>,
    /// Curves all of whose points are next to an edge.
    pub left_out: Vec<String>,
    /// The errors of each source.
    pub errors: Vec<SourceErrors>,
}

/// `summary.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// The case.
    pub case: String,
    /// Its scales.
    pub hertz: HertzScales,
    /// What it says in words.
    pub verdict: Vec<String>,
    /// Whether all gates hold.
    pub gates_hold: bool,
    /// The files.
    pub files: Vec<FileSummary>,
    /// The gates.
    pub gates: Vec<GateOutcome>,
    /// Whether the limits are those of a file; the built-in ones are widened by the files' errors.
    pub own_limits: bool,
    /// The range of the errors.
    pub range: Range,
    /// The command.
    pub command: String,
    /// The time.
    pub date: String,
    /// The program's version.
    pub version: &'static str,
}

fn worst(rows: &[&ErrorRow], select: impl Fn(&ErrorRow) -> bool) -> Option<Worst> {
    let chosen: Vec<&&ErrorRow> = rows.iter().filter(|r| select(r)).collect();
    // total_cmp puts a NaN above everything.
    let top = |of: fn(&ErrorRow) -> f64| chosen.iter().map(|r| of(r)).max_by(f64::total_cmp);
    Some(Worst { max: top(|r| r.max)?, rms: top(|r| r.rms)? })
}

impl FileSummary {
    fn of(run: &FileRun, range: &Range) -> Self {
        let file = &run.file;
        let errors = run.sources.iter().map(|(source, _)| {
            let own: Vec<&ErrorRow> =
                run.errors.iter().filter(|r| r.method == source.name()).collect();
            let first = range.pressure_c.first().copied();
            SourceErrors {
                source: source.name().to_string(),
                pressure: worst(&own, |r| r.quantity == "pressure" && Some(r.excluded_c) == first),
                stress: worst(&own, |r| r.quantity.starts_with("sigma_")),
                von_mises: worst(&own, |r| r.quantity == "von_mises"),
            }
        });
        Self {
            name: file.name.clone(),
            path: file.path.display().to_string(),
            units: file.statements.describe(),
            curves: file.curves.pressure.len() + file.curves.stress.len(),
            points: file.points,
            error_p0: file.statements.error_p0,
            ignored_columns: file.ignored.clone(),
            left_out: run.left_out.clone(),
            errors: errors.collect(),
        }
    }

    /// The errors of the gated model in words.
    fn words(&self) -> String {
        let gated = EdgeModel::QuarterSpace.name();
        let own = self.errors.iter().find(|e| e.source == gated);
        let part = |what: &str, worst: Option<Worst>| {
            worst.map(|w| {
                format!(
                    "{what} {} p0 (RMS of the worst curve {})",
                    fixed(w.max, 4),
                    fixed(w.rms, 4)
                )
            })
        };
        let parts: Vec<String> = own
            .map(|e| [part("pressure", e.pressure), part("a stress", e.stress)])
            .into_iter()
            .flatten()
            .flatten()
            .collect();
        let error = match self.error_p0 {
            Some(error) => format!("states an error of {} p0", significant(error, 3)),
            None => format!("states no error, {UNSTATED_ERROR} p0 is assumed"),
        };
        let largest = if parts.is_empty() {
            "nothing was compared".to_string()
        } else {
            format!("largest difference in {}", parts.join(", in "))
        };
        format!("{} against quarter-space: {largest}. The file {error}.", self.name)
    }
}

impl Summary {
    /// The summary of a comparison.
    pub fn of(comparison: &Comparison, context: &Context) -> Self {
        let gates = comparison.outcomes();
        let gates_hold = !gates.is_empty() && gates.iter().all(|o| o.passed);
        let files: Vec<FileSummary> =
            comparison.files.iter().map(|f| FileSummary::of(f, &comparison.range)).collect();
        Self {
            case: comparison.case.name.clone(),
            hertz: comparison.case.hertz(),
            verdict: verdict(&files, &gates),
            gates_hold,
            files,
            gates,
            own_limits: context.own_limits,
            range: comparison.range.clone(),
            command: context.command.to_string(),
            date: context.date.to_string(),
            version: env!("CARGO_PKG_VERSION"),
        }
    }
}

/// The outcome in words: the gates, each file, and what a comparison of calculations means.
fn verdict(files: &[FileSummary], gates: &[GateOutcome]) -> Vec<String> {
    let failed: Vec<&GateOutcome> = gates.iter().filter(|o| !o.passed).collect();
    let mut lines = vec![match failed.len() {
        0 => format!("Quarter-space and the curves agree: all {} gates hold.", gates.len()),
        n => {
            format!("Quarter-space and the curves do not agree: {n} of {} gates fail.", gates.len())
        }
    }];
    lines.extend(failed.iter().map(|o| {
        let value = o.value.map_or_else(String::new, |v| {
            format!(": {} instead of at most {}", significant(v, 3), significant(o.limit, 3))
        });
        format!("{}{value}; {}.", o.name, o.note)
    }));
    lines.extend(files.iter().map(FileSummary::words));
    lines.push(
        "This is code-to-code verification: calculations are compared with each other. Whether they describe \
         real bodies is another question (validation), which takes measurements."
            .to_string(),
    );
    lines
}
