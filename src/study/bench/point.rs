//! One way to solve a case: its time and its error.

use crate::body::EdgeModel;
use crate::case::Case;
use crate::stress::{Curves, Variable};
use crate::study::case_form::CaseForm;
use crate::study::errors::{ErrorRow, Range, compare, summarise};
use crate::study::source::Source;
use crate::study::timing::Timing;
use serde::{Deserialize, Serialize};

/// The model whose ratio to FEM is stated; at the tightest tolerance it is the models' limit.
pub const BEST: EdgeModel = EdgeModel::QuarterSpace;

/// Curves of both bodies whose worst RMS is [`Deviation::worst_rms`].
pub const CURVES: [&str; 3] = ["surface-along-y", "surface-along-x", "depth-end"];

/// Deviation of curves from a reference (p0) outside the excluded range.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Deviation {
    /// The largest RMS of any one curve: of the pressure on its two lines, and of each stress on
    /// [`CURVES`]. This is the "error" of run time against error.
    pub worst_rms: f64,
    /// RMS of the pressure over both lines.
    pub pressure_rms: f64,
    /// Largest difference of the pressure.
    pub pressure_max: f64,
    /// RMS of the six stresses over all standard curves of both bodies.
    pub stress_rms: f64,
    /// Largest difference of a stress.
    pub stress_max: f64,
}

impl Deviation {
    /// From the rows of a comparison over `range`; `None` when nothing was compared.
    pub fn of(rows: &[ErrorRow], range: &Range) -> Option<Self> {
        let summary = summarise(rows, range)?;
        let pressure_c = range.pressure_c.first()?;
        let counts = |r: &&ErrorRow| match r.variable {
            Variable::Pressure => r.excluded_c == *pressure_c,
            variable => variable.is_component() && CURVES.contains(&r.curve.as_str()),
        };
        let [pressure_max, pressure_rms] = *summary.pressure.first()?;
        let [stress_max, stress_rms] = summary.stress;
        Some(Self {
            worst_rms: rows.iter().filter(counts).map(|r| r.rms).reduce(f64::max)?,
            pressure_rms,
            pressure_max,
            stress_rms,
            stress_max,
        })
    }

    /// Of the curves of a source from `reference`, both of `case`.
    pub(super) fn between(
        case: &Case,
        reference: &Curves,
        curves: (&Source, &Curves),
        range: &Range,
    ) -> Option<Self> {
        // Both sides are sampled at the standard points, so the comparison cannot fail.
        let rows = compare(&case.name, case.overlap(), reference, curves, range).ok()?;
        Self::of(&rows, range)
    }
}

/// The origin of a point's time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// A model, in this run.
    Model,
    /// The published method on cells, in this run.
    Cells,
    /// FEM, in this run.
    LiveFem,
    /// FEM, from its record.
    RecordedFem,
}

/// One way to solve a case: its time and its error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BenchPoint {
    /// The model or FEM.
    pub source: Source,
    /// The origin of its time.
    pub origin: Origin,
    /// A model's tolerance (p0); a mesh's relative element size; the number of cells.
    pub setting: f64,
    /// Unknowns of both bodies (FEM).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unknowns: Option<u64>,
    /// Times on one thread; FEM's on one thread a process.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub timing: Option<Timing>,
    /// Times on all threads (models).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub all_threads: Option<Timing>,
    /// The processor where that is not of this run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub machine: Option<String>,
    /// Against FEM's finest mesh; for that mesh itself its difference to the next finest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to_fem: Option<Deviation>,
    /// Against quarter-space at the tightest tolerance; none for that solution itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to_limit: Option<Deviation>,
    /// Why there is no result.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub err: Option<String>,
}

impl BenchPoint {
    /// A point without times and errors.
    pub(super) fn new(source: impl Into<Source>, origin: Origin, setting: f64) -> Self {
        Self {
            source: source.into(),
            origin,
            setting,
            unknowns: None,
            timing: None,
            all_threads: None,
            machine: None,
            to_fem: None,
            to_limit: None,
            err: None,
        }
    }

    /// Median seconds.
    pub fn seconds(&self) -> Option<f64> {
        Some(self.timing.as_ref()?.median_s)
    }

    /// The error against a reference.
    pub fn error(&self, against: Against) -> Option<f64> {
        let accuracy = match against {
            Against::Fem => self.to_fem,
            Against::Limit => self.to_limit,
        };
        Some(accuracy?.worst_rms)
    }
}

/// A reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Against {
    /// FEM's finest mesh.
    Fem,
    /// Quarter-space at the tightest tolerance.
    Limit,
}

/// All ways to solve one case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseBench {
    /// The case; its tolerance is not used.
    #[serde(with = "CaseForm")]
    pub case: Case,
    /// The FEM mesh that is the reference, in words.
    pub fem_reference: Option<String>,
    /// The points.
    pub points: Vec<BenchPoint>,
}

/// The pairs of time and error that no other pair beats in both, fastest first.
pub fn front(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut best = f64::INFINITY;
    points.retain(|&(_, error)| {
        let better = error < best;
        best = best.min(error);
        better
    });
    points
}
