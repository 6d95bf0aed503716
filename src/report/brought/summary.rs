//! A file of curves and what it was compared with, in numbers.

use crate::report::fraction::fraction;
use crate::stress::{Quantity, Variable};
use crate::study::brought::{FileRun, OnPoints};
use crate::study::{ErrorRow, Range, Source};
use serde::{Deserialize, Serialize};

/// The largest and the root-mean-square error, each the worst of all curves (p0).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// The largest error.
    pub max: f64,
    /// The largest RMS of a curve.
    pub rms: f64,
}

/// The errors of a source against a file's curves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SourceErrors {
    /// The model or code.
    pub source: Source,
    /// Of the pressure, outside the first range.
    pub pressure: Option<Worst>,
    /// Of the stress components.
    pub stress: Option<Worst>,
    /// Of the von Mises stress.
    pub von_mises: Option<Worst>,
}

/// A file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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

fn worst(rows: &[&ErrorRow], select: impl Fn(&ErrorRow) -> bool) -> Option<Worst> {
    let chosen: Vec<&&ErrorRow> = rows.iter().filter(|r| select(r)).collect();
    // total_cmp puts a NaN above everything.
    let top = |of: fn(&ErrorRow) -> f64| chosen.iter().map(|r| of(r)).max_by(f64::total_cmp);
    Some(Worst { max: top(|r| r.max)?, rms: top(|r| r.rms)? })
}

impl FileSummary {
    /// The summary of a file's comparison with the models and codes over this range.
    pub fn of(run: &FileRun, range: &Range) -> Self {
        let file = &run.file;
        let errors = run.sources.iter().map(|OnPoints { source, .. }| {
            let own: Vec<&ErrorRow> = run.errors.iter().filter(|r| r.method == *source).collect();
            let first = range.pressure_c.first().copied();
            SourceErrors {
                source: source.clone(),
                pressure: worst(&own, |r| {
                    r.variable == Variable::Pressure && Some(r.excluded_c) == first
                }),
                stress: worst(&own, |r| r.variable.is_component()),
                von_mises: worst(&own, |r| r.variable == Variable::Stress(Quantity::VonMises)),
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

    /// The largest differences of a source in words; `None` where nothing was compared.
    pub fn differences(&self, source: &Source) -> Option<String> {
        let own = self.errors.iter().find(|e| e.source == *source)?;
        let part = |what: &str, worst: Option<Worst>| {
            let Worst { max, rms } = worst?;
            let [max, rms] = [max, rms].map(fraction);
            Some(format!("{what} {max} p0 (RMS of the worst curve {rms})"))
        };
        let parts = [part("pressure", own.pressure), part("a stress", own.stress)];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        (!parts.is_empty()).then(|| parts.join(", in "))
    }
}
