//! Numbers, lists and ranges in a sweep file.

use super::document::Entry;
use crate::base::Result;

/// Longer ranges and sweeps with more rows are refused as mistakes.
pub(super) const MAX_ROWS: usize = 10_000_000;

/// A number, or several.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Levels {
    /// One number, which does not vary.
    One(f64),
    /// A list.
    Many(Vec<f64>),
    /// Numbers in equal steps or equal ratios, both ends included.
    Range { low: f64, high: f64, count: usize, logarithmic: bool },
}

impl Levels {
    pub fn len(&self) -> usize {
        match self {
            Levels::One(_) => 1,
            Levels::Many(values) => values.len(),
            Levels::Range { count, .. } => *count,
        }
    }

    /// The value `i`, from 0.
    pub fn at(&self, i: usize) -> f64 {
        let (low, high, count, logarithmic) = match self {
            Levels::One(value) => return *value,
            Levels::Many(values) => return values[i],
            Levels::Range { low, high, count, logarithmic } => (*low, *high, *count, *logarithmic),
        };
        let t = i as f64 / (count - 1) as f64;
        // The ends are exact.
        if i == 0 {
            low
        } else if i == count - 1 {
            high
        } else if logarithmic {
            // Thirteen digits, so that the middle of a decade is a round number.
            let value = (low.ln() + t * (high / low).ln()).exp();
            format!("{value:.12e}").parse().expect("a formatted number")
        } else {
            low + t * (high - low)
        }
    }
}

/// A number, a list of numbers, or a range `{ from, to, count, spacing }`.
pub(super) fn levels(entry: &Entry) -> Result<Levels> {
    if entry.is_list() {
        let values = entry.list()?.iter().map(Entry::number).collect::<Result<_>>()?;
        return Ok(Levels::Many(values));
    }
    let Some(table) = entry.as_table() else {
        return entry.number().map(Levels::One);
    };
    table.only(&["from", "to", "count", "spacing"])?;
    let (from, to) = (table.require("from", "from = 1.0")?, table.require("to", "to = 2.0")?);
    let (low, high) = (from.number()?, to.number()?);
    let entry = table.require("count", "count = 10")?;
    let count = entry.number()?;
    if count.fract() != 0.0 || !(2.0..=MAX_ROWS as f64).contains(&count) {
        return Err(entry.refuse(
            format!("the number of values is a whole number between 2 and {MAX_ROWS}"),
            "write for example 10",
        ));
    }
    let logarithmic = match table.get("spacing") {
        None => false,
        Some(entry) => match entry.string()? {
            "linear" => false,
            "log" if low > 0.0 && high > 0.0 => true,
            "log" => {
                return Err(entry.refuse(
                    "only ranges of positive numbers have equal ratios",
                    "write \"linear\", or correct from and to",
                ));
            }
            _ => return Err(entry.refuse("it is not known", "write \"linear\" or \"log\"")),
        },
    };
    Ok(Levels::Range { low, high, count: count as usize, logarithmic })
}
