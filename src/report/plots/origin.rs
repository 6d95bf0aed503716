//! Where a picture of a case comes from.

use std::fmt::Display;

/// The program and its version.
pub const PROGRAM: &str = concat!("edgeline ", env!("CARGO_PKG_VERSION"));

/// What the title of a picture begins with: the case, what solved it, and the program.
pub fn origin(case: &str, by: impl Display) -> String {
    format!("{case}, {by}, {PROGRAM}")
}
