//! The rows of tables about brought curves: those of a study, with the name of the file's curves in
//! front.

use crate::report::study_rows::{CurveRow, PressureRow};
use crate::report::table::{Layout, Row};
use crate::report::tables::{curve_rows, pressure_rows};
use crate::study::ErrorRow;
use crate::study::brought::FileRun;

/// A row about a file's curves.
#[derive(Debug, Clone, PartialEq)]
pub struct Of<R> {
    /// What the file's curves are called.
    pub reference: String,
    /// The row.
    pub row: R,
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

/// The rows that `rows` gives for each of `files`.
fn of_files<R>(files: &[FileRun], rows: impl Fn(&FileRun) -> Vec<R>) -> Vec<Of<R>> {
    let of_file = |file: &FileRun| {
        let of = |row| Of { reference: file.file.name.clone(), row };
        rows(file).into_iter().map(of).collect::<Vec<_>>()
    };
    files.iter().flat_map(of_file).collect()
}

/// The errors of all sources against the curves of each file (p0, C).
pub fn of_errors(files: &[FileRun]) -> Vec<Of<ErrorRow>> {
    of_files(files, |file| file.errors.clone())
}

/// The stresses of each file and of all sources on its points (Pa).
pub fn of_curves(files: &[FileRun]) -> Vec<Of<CurveRow>> {
    of_files(files, |f| f.all().flat_map(|(s, c)| curve_rows(&f.case, &s, c)).collect())
}

/// The contact pressure of each file and of all sources on its points (Pa).
pub fn of_pressure(files: &[FileRun]) -> Vec<Of<PressureRow>> {
    of_files(files, |f| f.all().flat_map(|(s, c)| pressure_rows(&f.case, &s, c)).collect())
}
