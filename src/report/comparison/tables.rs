//! The tables of a comparison: those of a study, with the file's name in front.

use crate::report::study_rows::{CurveRow, PressureRow};
use crate::report::table::{Layout, Row, to_csv};
use crate::stress::{Curves, Quantity};
use crate::study::brought::{Comparison, FileRun};
use crate::study::{Engine, Source};

/// A row about a file's curves.
struct Of<R> {
    reference: String,
    row: R,
}

impl<R: Row> Row for Of<R> {
    fn columns(layout: Layout) -> Vec<Vec<String>> {
        let own = std::iter::once(vec!["reference".to_string()]);
        own.chain(R::columns(layout)).collect()
    }

    fn cells(&self) -> Vec<Vec<String>> {
        std::iter::once(vec![self.reference.clone()]).chain(self.row.cells()).collect()
    }

    fn from_cells(fields: &[&[&str]]) -> Result<Self, usize> {
        let (own, rest) = fields.split_first().ok_or(0usize)?;
        let row = R::from_cells(rest).map_err(|field| field + 1)?;
        Ok(Self { reference: own.concat(), row })
    }
}

/// Rows of all files.
fn table<R: Row>(comparison: &Comparison, rows: impl Fn(&FileRun) -> Vec<R>) -> String {
    let of_file = |file: &FileRun| {
        let of = |row| Of { reference: file.file.name.clone(), row };
        rows(file).into_iter().map(of).collect::<Vec<_>>()
    };
    let all: Vec<Of<R>> = comparison.files.iter().flat_map(of_file).collect();
    to_csv(&all, &comparison.range)
}

/// The file's own curves and those of all sources on its points.
fn sources(file: &FileRun) -> impl Iterator<Item = (Source, &Curves)> {
    let own = (Engine::brought(&file.file.name).into(), &file.file.curves);
    std::iter::once(own).chain(file.sources.iter().map(|(s, c)| (s.clone(), c)))
}

/// `errors.csv`.
pub(super) fn errors(comparison: &Comparison) -> String {
    table(comparison, |file| file.errors.clone())
}

/// `curves.csv`.
pub(super) fn curves(comparison: &Comparison) -> String {
    let case = &comparison.case;
    table(comparison, |file| {
        let mut rows = Vec::new();
        for (source, curves) in sources(file) {
            for curve in &curves.stress {
                rows.extend(curve.at.iter().zip(&curve.stress).map(|(at, stress)| CurveRow {
                    case: case.name.clone(),
                    source: source.clone(),
                    body: curve.body,
                    curve: curve.name.clone(),
                    at_m: at.map(|v| v * curves.hertz.c_m),
                    stress_pa: Quantity::ALL.map(|q| q.of(stress) * curves.hertz.p0_pa),
                }));
            }
        }
        rows
    })
}

/// `pressure.csv`.
pub(super) fn pressure(comparison: &Comparison) -> String {
    let case = &comparison.case;
    table(comparison, |file| {
        let mut rows = Vec::new();
        for (source, curves) in sources(file) {
            for line in &curves.pressure {
                rows.extend(line.at.iter().zip(&line.p).map(|(at, p)| PressureRow {
                    case: case.name.clone(),
                    source: source.clone(),
                    line: line.name.clone(),
                    at_m: at.map(|v| v * curves.hertz.c_m),
                    p_pa: p * curves.hertz.p0_pa,
                }));
            }
        }
        rows
    })
}
