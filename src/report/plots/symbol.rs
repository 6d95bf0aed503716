//! The symbols on axes.

use crate::stress::{Quantity, Variable};

/// The symbol of a variable as a fraction of p0.
pub fn in_p0(variable: Variable) -> String {
    format!("{} / p0", symbol_of(variable))
}

/// The symbol of a variable.
pub fn symbol_of(variable: Variable) -> &'static str {
    match variable {
        Variable::Pressure => "p",
        Variable::Stress(quantity) => symbol(quantity),
    }
}

/// The symbol of a scalar of the stress.
pub(super) fn symbol(quantity: Quantity) -> &'static str {
    ["σxx", "σyy", "σzz", "σxy", "σxz", "σyz", "von Mises", "τmax"][quantity.index()]
}
