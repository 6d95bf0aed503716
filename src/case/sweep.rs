//! A sweep: thousands of cases as a grid or as lists of parameters, or as a table.
//!
//! A sweep stores neither its cases nor the rows of a table: a row is the base with the values of
//! that row, and is checked like every case. A mistake in the file is an error of the sweep; a
//! mistake in a row is an error of that row.

use super::builtin::{BUILTIN_STUDIES, builtin_case, is_given};
use super::draft::Draft;
use super::keys::Key;
use super::levels::Levels;
use super::model::Case;
use super::sweep_table::{RowCells, Table};
use crate::base::number::stated;
use crate::base::{Error, Result};
use std::path::Path;

/// Many cases that differ in some numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// The columns that vary.
    pub(super) columns: Vec<Column>,
    /// Names of the columns.
    pub(super) names: Vec<String>,
    /// The values that do not vary.
    pub(super) base: Draft,
    pub(super) rows: Rows,
}

/// The content of a column of a sweep.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Column {
    /// The names of the cases.
    Name,
    /// Values of these numbers.
    Numbers(Vec<&'static Key>),
}

/// The values of the columns.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Rows {
    /// Every combination of the columns' levels; the last column varies fastest.
    Grid(Vec<Levels>),
    /// The columns' values side by side, with equal lengths; one row if there is no column.
    Side(Vec<Levels>),
    /// Those of a table.
    Table(Table),
}

/// Why a sweep takes no rough surface.
pub(super) const SMOOTH: &str = "a sweep solves contacts along a line, which are smooth";

/// Why a number makes no difference to a sweep; `None` if it may make one.
pub(super) fn without_effect(key: &Key) -> Option<&'static str> {
    match key.table() {
        "surface" => Some(SMOOTH),
        "cells" => Some("a sweep solves contacts along a line, not on cells"),
        "fatigue" => Some("a sweep tells nothing of fatigue"),
        _ => None,
    }
}

/// What is wrong with the name of something built in, which is no sweep, and what to do.
fn built_in(path: &Path) -> Option<(String, String)> {
    let name = path.to_str()?;
    let (what, meant) = if builtin_case(name).is_some() {
        ("case", format!("a case file with lists of numbers, or a CSV table with --base {name}"))
    } else if BUILTIN_STUDIES.iter().any(|(known, _)| *known == name) {
        ("study", format!("a sweep file, or run `edgeline study {name}`"))
    } else {
        return None;
    };
    Some((format!("is a built-in {what}, not the file of a sweep"), format!("give {meant}")))
}

impl Sweep {
    /// Reads a sweep from a TOML file or, if its name ends in `.csv`, from a table. `base` gives
    /// the values that a table has no column for; a TOML file must contain all values.
    ///
    /// # Errors
    /// [`Error::Io`] when the file cannot be read; [`Error::File`] with the line when it is not
    /// TOML or CSV, has an unknown or missing key or column, a column or a list of numbers that no
    /// row depends on, or a value of the wrong type;
    /// [`Error::Value`] if the base has a rough surface. Values out of their range are no errors
    /// here: see [`Sweep::case`].
    pub fn read(path: &Path, base: Option<&Draft>) -> Result<Sweep> {
        if let (false, Some((message, remedy))) = (is_given(path), built_in(path)) {
            return Err(Error::File { path: path.to_path_buf(), line: None, message, remedy });
        }
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv")) {
            return Sweep::read_csv(path, base);
        }
        if base.is_some() {
            return Err(Error::File {
                path: path.to_path_buf(),
                line: None,
                message: "a sweep in TOML gives all parameters itself".into(),
                remedy: "leave out --base, or give a CSV table, whose name ends in .csv".into(),
            });
        }
        Sweep::read_toml(path)
    }

    /// Refuses a case with a rough surface.
    ///
    /// # Errors
    /// [`Error::Value`].
    pub fn check_smooth(case: &Case) -> Result<()> {
        case.check_smooth(SMOOTH)
    }

    /// Number of rows, at least 1.
    pub fn len(&self) -> usize {
        match &self.rows {
            // The readers have checked that the product is within the limit.
            Rows::Grid(levels) => levels.iter().map(Levels::len).product(),
            Rows::Side(columns) => columns.first().map_or(1, Levels::len),
            Rows::Table(table) => table.len(),
        }
    }

    /// Whether there are no rows (never, by construction).
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Names of the columns, in the order of the file.
    pub fn columns(&self) -> &[String] {
        &self.names
    }

    /// The texts of the columns, row by row. A table is read from its file meanwhile.
    ///
    /// # Errors
    /// [`Error::Io`] when the table cannot be opened. A row is an error when the file has changed
    /// since it was checked.
    pub fn rows(&self) -> Result<RowCells<'_>> {
        let text_of = |value: f64| format!("{value:e}");
        Ok(match &self.rows {
            Rows::Table(table) => table.rows()?,
            Rows::Side(columns) => Box::new(
                (0..self.len())
                    .map(move |i| Ok(columns.iter().map(|values| text_of(values.at(i))).collect())),
            ),
            Rows::Grid(levels) => Box::new((0..self.len()).map(move |i| {
                let mut rest = i;
                let cell = |l: &Levels| {
                    let value = l.at(rest % l.len());
                    rest /= l.len();
                    text_of(value)
                };
                let mut cells: Vec<String> = levels.iter().rev().map(cell).collect();
                cells.reverse();
                Ok(cells)
            })),
        })
    }

    /// The case of row `i`, whose texts are `cells`. Its name is in the column `name`; otherwise it
    /// is `row-1` and so on.
    ///
    /// # Errors
    /// [`Error::Value`] about the first value of the row that is not legal.
    pub fn case(&self, i: usize, cells: &[String]) -> Result<Case> {
        let mut draft = self.base.clone().named(format!("row-{}", i + 1));
        for ((cell, column), name) in cells.iter().zip(&self.columns).zip(&self.names) {
            let keys = match column {
                Column::Numbers(keys) => keys,
                Column::Name => {
                    draft = draft.named(cell);
                    continue;
                }
            };
            let value: f64 = cell.parse().map_err(|_| Error::Value {
                key: name.clone(),
                value: cell.clone(),
                reason: "a number belongs here".into(),
                remedy: "write for example 1.5".into(),
            })?;
            for key in keys {
                if !key.fits(&draft) {
                    let reason = "the case has no profile with this number".to_string();
                    let remedy =
                        "give the base case such a profile, or remove the column".to_string();
                    let (key, value) = (key.path.to_string(), stated(value));
                    return Err(Error::Value { key, value, reason, remedy });
                }
                key.set(&mut draft, value);
            }
        }
        draft.case()
    }
}
