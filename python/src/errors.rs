//! The library's errors as Python's.

use pyo3::exceptions::PyException;
use pyo3::{PyErr, create_exception};

create_exception!(
    edgeline,
    Error,
    PyException,
    "What could not be done: what went wrong, where, and what to do.\n\nThe message is that of the \
     command line."
);

/// The exception for an error of the library.
pub fn raised(error: edgeline::base::Error) -> PyErr {
    Error::new_err(error.to_string())
}
