//! The symbols on axes.

use crate::stress::{Quantity, Variable};

/// The symbol of a variable as a fraction of p0.
pub fn in_p0(variable: Variable) -> String {
    let symbol = match variable {
        Variable::Pressure => "p",
        Variable::Stress(quantity) => symbol(quantity),
    };
    format!("{symbol} / p0")
}

/// The symbol of a scalar of the stress.
pub(super) fn symbol(quantity: Quantity) -> &'static str {
    ["σxx", "σyy", "σzz", "σxy", "σxz", "σyz", "von Mises", "τmax"][quantity.index()]
}
