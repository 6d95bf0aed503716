//! Values of options that several subcommands share.

use super::output::say;
use crate::base::number::stated;
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::{Case, Key};
use crate::report::solution::too_fine;
use crate::study::{Engine, Source};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::ops::RangeInclusive;

/// An option that does not suit the others.
pub(super) fn unsuited((option, value): (&str, &str), reason: &str, remedy: &str) -> Error {
    Error::Value {
        key: format!("--{option}"),
        value: value.into(),
        reason: reason.into(),
        remedy: remedy.into(),
    }
}

/// Parses the name of one of `all`.
pub(super) fn one_of<T: Copy + Send + Sync + 'static>(
    all: &'static [T],
    name_of: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let names = all.iter().map(move |value| name_of(*value));
    PossibleValuesParser::new(names).map(move |name| {
        let named = |value: &&T| name_of(**value) == name;
        *all.iter().find(named).expect("only these names pass")
    })
}

/// Parses the name of an edge model.
pub(super) fn edge_model() -> impl TypedValueParser<Value = EdgeModel> {
    one_of(&EdgeModel::ALL, EdgeModel::name)
}

/// Parses the name of an edge model or of the published method on cells.
pub(super) fn source() -> impl TypedValueParser<Value = Source> {
    let names = EdgeModel::ALL.map(EdgeModel::name).into_iter().chain([Engine::PUBLISHED]);
    PossibleValuesParser::new(names).map(|name| {
        let named = |model: &EdgeModel| model.name() == name;
        let model = EdgeModel::ALL.into_iter().find(named).map(Source::from);
        model.unwrap_or_else(|| Engine::published().into())
    })
}

/// The chosen models, simplest first; all of them if none is chosen.
pub(super) fn chosen_models(named: &[Source]) -> Vec<EdgeModel> {
    let wanted = |m: &EdgeModel| named.is_empty() || named.contains(&Source::from(*m));
    EdgeModel::ALL.into_iter().filter(wanted).collect()
}

/// Most repetitions of a timing.
pub(super) const MOST_REPEATS: usize = 10_000;

/// Parses a number of `what` within the range.
pub(super) fn count(
    what: &'static str,
    range: RangeInclusive<usize>,
) -> impl Fn(&str) -> std::result::Result<usize, String> + Clone {
    move |text| match text.parse::<usize>() {
        Ok(value) if range.contains(&value) => Ok(value),
        _ => Err(format!("give a number of {what} between {} and {}", range.start(), range.end())),
    }
}

/// The values of a list as they are given to an option.
pub(super) fn listed<T: ToString>(values: &[T]) -> String {
    values.iter().map(T::to_string).collect::<Vec<_>>().join(",")
}

/// The numbers `given` with an option, one for each direction, of which `what` says how many there
/// are.
///
/// # Errors
/// [`Error::Value`] that names the option where there are more or fewer.
pub(super) fn directions<const N: usize>(
    option: &str,
    given: &[usize],
    what: &str,
    usual: &str,
) -> Result<[usize; N]> {
    given.try_into().map_err(|_| Error::Value {
        key: option.into(),
        value: listed(given),
        reason: format!("{what} directions"),
        remedy: format!("give for example {usual}"),
    })
}

/// Legal range of the residual of an iteration: smaller ones are lost in rounding.
const RESIDUALS: (f64, f64) = (1e-12, 1e-2);

/// The tolerance if it is within its legal range.
///
/// # Errors
/// [`Error::Value`] that names `--tolerance`.
pub fn checked_tolerance(tolerance: f64) -> Result<f64> {
    tolerance_of("--tolerance", tolerance)
}

/// [`checked_tolerance`] of another `option`, which its error names.
///
/// # Errors
/// [`Error::Value`].
pub fn tolerance_of(option: &str, tolerance: f64) -> Result<f64> {
    let range = Key::find("accuracy.tolerance").expect("a key of the list").range;
    checked(option, tolerance, range, "a fraction of p0", "1e-3")
}

/// Says so where a case is [`too_fine`].
pub fn say_if_too_fine(case: &Case) {
    if let Some(note) = too_fine(case) {
        say(&format!("note: {note}"));
    }
}

/// The relative residual if it is within its legal range.
///
/// # Errors
/// As [`checked_tolerance`].
pub fn checked_residual(residual: f64) -> Result<f64> {
    checked("--tolerance", residual, RESIDUALS, "a relative residual on cells", "1e-8")
}

fn checked(
    option: &str,
    tolerance: f64,
    (low, high): (f64, f64),
    what: &str,
    usual: &str,
) -> Result<f64> {
    if (low..=high).contains(&tolerance) {
        return Ok(tolerance);
    }
    Err(Error::Value {
        key: option.into(),
        value: stated(tolerance),
        reason: format!("it is {what} between {} and {}", stated(low), stated(high)),
        remedy: format!("give for example {usual}"),
    })
}
