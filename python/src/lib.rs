//! The native part of the Python package: cases, solutions and sweeps, as thin as it can be. What
//! users see, with its documentation, is the Python code in `edgeline/`.
//!
//! Everything that takes time runs within [`work::work`], which releases the interpreter's lock and
//! lets no panic out.

#![forbid(unsafe_code)]

mod case;
mod errors;
mod solution;
mod sweep;
mod tables;
mod work;

use pyo3::prelude::*;

/// The allocator of the program, for the same reason.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// The native part of edgeline.
#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::case::Case;
    #[pymodule_export]
    use crate::errors::Error;
    #[pymodule_export]
    use crate::solution::{Solution, solve};
    #[pymodule_export]
    use crate::sweep::sweep;
    #[pymodule_export]
    use crate::work::fail;
}
