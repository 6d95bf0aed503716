//! The numbers that gates judge.

use crate::body::EdgeModel;
use crate::stress::Variable;
use crate::study::errors::ErrorRow;
use crate::study::measure::Measure;
use crate::study::response::Response;
use crate::study::run::StudyRun;
use crate::study::source::Source;

/// A number that gates can select.
#[derive(Debug, Clone, PartialEq)]
pub struct Number {
    /// The case.
    pub case: String,
    /// The method.
    pub method: EdgeModel,
    /// What it is.
    pub of: NumberOf,
    /// The value.
    pub value: f64,
}

/// What a number is.
#[derive(Debug, Clone, PartialEq)]
pub enum NumberOf {
    /// An error on a curve (p0).
    Curve {
        /// `block`, `roller` or `contact`.
        body: String,
        /// The curve or pressure line.
        curve: String,
        /// What is compared.
        variable: Variable,
        /// Excluded distance from an edge (C).
        excluded_c: f64,
        /// Its measure.
        measure: Measure,
    },
    /// A number of the whole case.
    Whole(Whole),
}

/// A number of a whole case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Whole {
    /// Error of the largest von Mises stress (p0).
    CriticalValue,
    /// Error of its depth (C).
    CriticalDepth,
    /// Relative error of the load.
    Load,
    /// FEM's time over the model's.
    Speedup,
}

impl NumberOf {
    /// Excluded distance from an edge (C), if there is one.
    pub fn excluded_c(&self) -> Option<f64> {
        match self {
            Self::Curve { excluded_c, .. } => Some(*excluded_c),
            Self::Whole(_) => None,
        }
    }
}

impl Whole {
    /// All of them.
    pub const ALL: [Self; 4] =
        [Self::CriticalValue, Self::CriticalDepth, Self::Load, Self::Speedup];

    /// The name used in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::CriticalValue => "critical_value",
            Self::CriticalDepth => "critical_depth",
            Self::Load => "load",
            Self::Speedup => "speedup",
        }
    }
}

impl Number {
    /// Its case, curve and quantity in words.
    pub fn place(&self) -> String {
        let case = &self.case;
        match &self.of {
            NumberOf::Curve { body, curve, variable, .. } => {
                format!("{case}, {body}, {curve}, {variable}")
            }
            NumberOf::Whole(whole) => format!("{case}, {}", whole.name()),
        }
    }
}

/// The numbers of the errors of a model in a case.
pub fn of_errors<'a>(
    case: &str,
    method: EdgeModel,
    rows: impl IntoIterator<Item = &'a ErrorRow>,
) -> Vec<Number> {
    let of_row = |row: &ErrorRow| {
        Measure::ALL.map(|measure| Number {
            case: case.to_string(),
            method,
            of: NumberOf::Curve {
                body: row.body.clone(),
                curve: row.curve.clone(),
                variable: row.variable,
                excluded_c: row.excluded_c,
                measure,
            },
            value: row.measured(measure),
        })
    };
    rows.into_iter().flat_map(of_row).collect()
}

/// All numbers of a run that a gate can look at.
pub fn numbers(run: &StudyRun) -> Vec<Number> {
    let mut all = Vec::new();
    for case in &run.cases {
        for m in &case.methods {
            let (Source::Model(method), Ok(result)) = (&m.source, &m.result) else { continue };
            all.extend(of_errors(&case.case.name, *method, &result.errors));
            let of = |whole: Whole| match whole {
                Whole::CriticalValue => Response::CriticalValue.value(case, m).map(f64::abs),
                Whole::CriticalDepth => Response::CriticalDepth.value(case, m).map(f64::abs),
                Whole::Load => Some(result.solution.summary.load_error_rel),
                Whole::Speedup => Response::Log10Speedup.value(case, m).map(|d| 10f64.powf(d)),
            };
            let number = |whole: Whole| {
                let (case, of_whole) = (case.case.name.clone(), NumberOf::Whole(whole));
                of(whole).map(|value| Number { case, method: *method, of: of_whole, value })
            };
            all.extend(Whole::ALL.into_iter().filter_map(number));
        }
    }
    all
}
