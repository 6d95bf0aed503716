//! `summary.json` of a comparison, and its verdict in words.

use crate::base::HertzScales;
use crate::base::number::significant;
use crate::body::EdgeModel;
use crate::report::brought::FileSummary;
use crate::study::Range;
use crate::study::brought::{Comparison, UNSTATED_ERROR};
use crate::study::gate::GateOutcome;
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

/// The errors of the gated model in words.
fn words(file: &FileSummary) -> String {
    let error = match file.error_p0 {
        Some(error) => format!("states an error of {} p0", significant(error, 3)),
        None => format!("states no error, {UNSTATED_ERROR} p0 is assumed"),
    };
    let largest = match file.differences(&EdgeModel::QuarterSpace.into()) {
        None => "nothing was compared".to_string(),
        Some(differences) => format!("largest difference in {differences}"),
    };
    format!("{} against quarter-space: {largest}. The file {error}.", file.name)
}

impl Summary {
    /// The summary of a comparison.
    pub fn of(comparison: &Comparison, context: &Context) -> Self {
        let gates = comparison.outcomes.clone();
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
    lines.extend(files.iter().map(words));
    lines.push(
        "This is code-to-code verification: calculations are compared with each other. Whether they describe \
         real bodies is another question (validation), which takes measurements."
            .to_string(),
    );
    lines
}
