//! Tables of results as lists of numpy arrays.

use edgeline::report::columns::{Columns, Values};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// A table as a dict of columns: arrays of numbers, and lists of texts.
pub fn table(py: Python<'_>, columns: Columns) -> PyResult<Bound<'_, PyDict>> {
    let table = PyDict::new(py);
    for (name, values) in columns.columns {
        match values {
            Values::Numbers(values) => table.set_item(name, values.into_pyarray(py))?,
            Values::Texts(values) => table.set_item(name, PyList::new(py, values)?)?,
        }
    }
    Ok(table)
}
