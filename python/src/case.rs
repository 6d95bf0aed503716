//! Cases, read and checked by the command line's own reader.

use crate::errors::raised;
use edgeline::base;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyInt, PyList, PyMapping, PyString, PyTuple};
use std::path::PathBuf;
use toml::Value;

/// A contact problem that is known to be legal.
#[pyclass(frozen, module = "edgeline._native")]
pub struct Case(pub edgeline::case::Case);

#[pymethods]
impl Case {
    /// Reads a case file, or takes a built-in case or one of a built-in study.
    #[staticmethod]
    fn from_path(path: PathBuf) -> PyResult<Self> {
        edgeline::case::find_case(&path).map(Self).map_err(raised)
    }

    /// Takes a case from the text of a case file.
    #[staticmethod]
    fn from_text(text: &str) -> PyResult<Self> {
        edgeline::case::Case::from_toml(text).map(Self).map_err(raised)
    }

    /// Takes a case from what its file would hold.
    #[staticmethod]
    fn from_tables(tables: &Bound<'_, PyDict>) -> PyResult<Self> {
        let text = toml::to_string(&table(tables.as_mapping(), "")?).map_err(|e| {
            PyTypeError::new_err(format!("these tables do not make a case file: {e}"))
        })?;
        // The lines are those of a text that nobody has seen.
        edgeline::case::Case::from_toml(&text).map(Self).map_err(|e| raised(without_line(e)))
    }

    /// The case file, to the last digit.
    fn to_toml(&self) -> String {
        self.0.to_toml()
    }

    /// Whether it is the same case, with the same data from the files that it names.
    fn same(&self, other: &Self) -> bool {
        self.0 == other.0
    }

    /// The case's name.
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// The case file as JSON.
    fn to_json(&self) -> String {
        serde_json::to_string(&self.0).expect("a case has the form of its file")
    }

    /// E* (Pa), C (m) and p0 (Pa) as JSON.
    fn hertz(&self) -> PyResult<String> {
        self.0.check_force("its scales follow from a force").map_err(raised)?;
        Ok(serde_json::to_string(&self.0.hertz()).expect("scales are plain data"))
    }

    /// W, S_l and L_r.
    fn factors(&self) -> PyResult<[f64; 3]> {
        self.0.check_force("its factors follow from a force").map_err(raised)?;
        let factors = self.0.factors();
        Ok([factors.load, factors.slenderness, factors.length_ratio])
    }
}

/// The same error without a line.
fn without_line(error: base::Error) -> base::Error {
    match error {
        base::Error::File { path, message, remedy, .. } => {
            base::Error::File { path, line: None, message, remedy }
        }
        other => other,
    }
}

/// Levels of tables, each deeper than those of any case file, beyond which no more is read.
const MOST_LEVELS: usize = 8;

/// A table of a case file; what is None does not stand there.
fn table(values: &Bound<'_, PyMapping>, path: &str) -> PyResult<toml::Table> {
    if path.matches('.').count() >= MOST_LEVELS {
        return Err(PyTypeError::new_err(format!(
            "tables stand in each other {MOST_LEVELS} levels deep, or one in itself: a case file has three \
             levels at most"
        )));
    }
    let mut table = toml::Table::new();
    for item in values.items()? {
        let (key, given): (String, Bound<'_, PyAny>) = item.extract()?;
        if !given.is_none() {
            let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            table.insert(key, value(&given, &path)?);
        }
    }
    Ok(table)
}

/// A value of a case file; `path` is where it stands.
fn value(given: &Bound<'_, PyAny>, path: &str) -> PyResult<Value> {
    // A flag of numpy is one, too: as a number it would be 0 or 1.
    if let Ok(flag) = given.extract() {
        return Ok(Value::Boolean(flag));
    }
    if given.is_instance_of::<PyInt>() {
        // What is too large for an integer of TOML is a number all the same.
        return match given.extract() {
            Ok(value) => Ok(Value::Integer(value)),
            Err(_) => given.extract().map(Value::Float).map_err(|_| {
                PyTypeError::new_err(format!("{path} is larger than any number of a case file"))
            }),
        };
    }
    if given.is_instance_of::<PyFloat>() {
        return given.extract().map(Value::Float);
    }
    if given.is_instance_of::<PyString>() {
        return given.extract().map(Value::String).map_err(|_| {
            PyTypeError::new_err(format!("{path} is no Unicode text: it has a lone surrogate"))
        });
    }
    if let Ok(values) = given.cast::<PyMapping>() {
        return table(values, path).map(Value::Table);
    }
    if given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>() {
        let items = given.try_iter()?.map(|item| value(&item?, path));
        return items.collect::<PyResult<_>>().map(Value::Array);
    }
    if let Ok(path) = given.extract::<PathBuf>() {
        return Ok(Value::String(path.to_string_lossy().into_owned()));
    }
    // Other numbers: those of numpy.
    given.extract().map(Value::Float).map_err(|_| {
        let kind = given.get_type();
        PyTypeError::new_err(format!("{path} is a {kind}, which a case file cannot hold"))
    })
}
