//! Brought curves held to limits: the gates of quarter-space.

use super::beside::{Beside, FileRun, GATED};
use super::file::BroughtFile;
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::Case;
use crate::study::errors::Range;
use crate::study::gate::{Gate, GateOutcome, Kind, Number, NumberOf, Selected, Whole, of_errors};
use crate::study::run::Reference;
use crate::study::source::Engine;

/// What limits are widened by where a file states no error of its curves (p0).
pub const UNSTATED_ERROR: f64 = 0.01;

/// Files of curves, compared.
#[derive(Debug, Clone)]
pub struct Comparison {
    /// The case.
    pub case: Case,
    /// The range of the errors.
    pub range: Range,
    /// The files.
    pub files: Vec<FileRun>,
    /// The gates of all files.
    pub outcomes: Vec<GateOutcome>,
}

/// The limits that curves are held to.
pub enum Limits<'a> {
    /// The built-in ones, widened by the error that a file states.
    Widened(&'a [Gate]),
    /// Those of a file, as they are.
    Given(&'a [Gate]),
}

impl Comparison {
    /// Compares `files` with all models and with `references`, the recorded curves of the case.
    ///
    /// # Errors
    /// As [`Beside::new`]; [`Error::File`] for a file with curves that no limit holds.
    pub fn new(
        case: &Case,
        files: Vec<BroughtFile>,
        references: &[(Engine, &Reference)],
        limits: &Limits,
        range: &Range,
    ) -> Result<Self> {
        let beside = Beside::new(case, &EdgeModel::ALL, None, range)?;
        let files: Vec<FileRun> =
            files.into_iter().map(|file| beside.file(file, references)).collect::<Result<_>>()?;
        let held = Held { limits, load_error_rel: beside.load_error_rel() };
        let mut outcomes: Vec<GateOutcome> = files.iter().flat_map(|f| held.gates(f)).collect();
        files.iter().try_for_each(|file| held.check(file))?;
        outcomes.extend(held.idle_gates(&outcomes));
        Ok(Self { case: case.clone(), range: range.clone(), files, outcomes })
    }
}

/// What files are held to.
struct Held<'a> {
    limits: &'a Limits<'a>,
    /// The relative error of the gated model's load.
    load_error_rel: f64,
}

impl Held<'_> {
    /// The gates that a file's curves have numbers for.
    fn gates(&self, run: &FileRun) -> Vec<GateOutcome> {
        let FileRun { case, file, .. } = run;
        let mut numbers = of_curves(run);
        numbers.push(Number {
            case: case.clone(),
            method: GATED,
            of: NumberOf::Whole(Whole::Load),
            value: self.load_error_rel,
        });
        let error = file.statements.error_p0.unwrap_or(UNSTATED_ERROR);
        let evaluate = |gate: &Gate| {
            let widened = match self.limits {
                Limits::Widened(_) if gate.selected != LOAD => gate.limit + error,
                _ => gate.limit,
            };
            let name = format!("{}: {}", file.name, gate.name);
            Gate { name, limit: widened, ..gate.clone() }.evaluate(&numbers, &[])
        };
        let chosen = self.gated().filter(|gate| numbers.iter().any(|n| gate.takes(n)));
        let mut outcomes: Vec<GateOutcome> = chosen.map(evaluate).collect();
        if numbers.len() == 1 {
            // A file none of whose points count must not look like a pass.
            let note = "no curve was compared, or all points are next to an edge";
            outcomes.push(nothing_compared(&format!("{}: curves", file.name), note));
        }
        outcomes
    }

    /// Refuses a file whose curves have numbers of which no gate takes any: that the load is met
    /// says nothing of them.
    fn check(&self, run: &FileRun) -> Result<()> {
        let numbers = of_curves(run);
        let of_curves = || self.gated().filter(|gate| gate.selected != LOAD);
        let takes = |gate: &Gate| numbers.iter().any(|n| gate.takes(n));
        if numbers.is_empty() || of_curves().any(takes) {
            return Ok(());
        }
        // Those that would, were the numbers of other points.
        let elsewhere = |gate: &&Gate| takes(&Gate { excluded_c: None, ..(*gate).clone() });
        let wanted = distances(of_curves().filter(elsewhere).filter_map(|gate| gate.excluded_c));
        let [message, remedy] = if wanted.is_empty() {
            [
                "no gate of quarter-space takes any of its curves".to_string(),
                "give one that does, of its quantity, curves and body, or leave the file out"
                    .to_string(),
            ]
        } else {
            let own = distances(numbers.iter().filter_map(|n| n.of.excluded_c()));
            let (of, option) = match run.file.curves.stress.is_empty() {
                true => ("pressure", format!("add {wanted} to --exclude-pressure")),
                false => ("stress", "give such a distance to --exclude".to_string()),
            };
            [
                format!(
                    "nothing of it is held to a limit: those of {of} are for points outside \
                     {wanted} C of the edge, and it is compared outside {own} C"
                ),
                format!(
                    "{option}, with points further from the edge in the file, or give other \
                     limits by --gates"
                ),
            ]
        };
        Err(Error::File { path: run.file.path.clone(), line: None, message, remedy })
    }

    /// The gates of the gated model that a comparison has numbers for.
    fn gated(&self) -> impl Iterator<Item = &Gate> {
        let (Limits::Widened(gates) | Limits::Given(gates)) = self.limits;
        gates
            .iter()
            .filter(|gate| gate.method == GATED)
            .filter(|gate| matches!(gate.selected, Selected::Error(_) | LOAD))
    }

    /// Given gates that no file has numbers for fail: a wrong filter must not look like a pass.
    fn idle_gates(&self, met: &[GateOutcome]) -> Vec<GateOutcome> {
        let Limits::Given(_) = self.limits else { return Vec::new() };
        let idle = |gate: &&Gate| {
            let ending = format!(": {}", gate.name);
            !met.iter().any(|outcome| outcome.name.ends_with(&ending))
        };
        let note = "nothing was compared: it takes no number of any file";
        self.gated().filter(idle).map(|gate| nothing_compared(&gate.name, note)).collect()
    }
}

/// The numbers of a file's curves against the gated model.
fn of_curves(run: &FileRun) -> Vec<Number> {
    of_errors(&run.case, GATED, run.errors.iter().filter(|r| r.method == GATED.into()))
}

/// Distances in words, each once.
fn distances(all: impl Iterator<Item = f64>) -> String {
    let mut all: Vec<f64> = all.collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all.iter().map(f64::to_string).collect::<Vec<_>>().join(" and ")
}

/// The gates of the load.
const LOAD: Selected = Selected::Whole(Whole::Load);

fn nothing_compared(name: &str, note: &str) -> GateOutcome {
    GateOutcome::nothing(name, Some(GATED), Kind::Coverage, note)
}
