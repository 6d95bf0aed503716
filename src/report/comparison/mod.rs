//! The files of a comparison of brought curves: tables, gates, plots, page and summary.

mod page;
mod plots;
mod summary;
mod tables;

use super::gates;
use super::study_files::pretty;
use crate::base::Result;
use crate::study::brought::Comparison;

pub use summary::{Context, Summary};

/// All files of a comparison, `summary.json` last.
///
/// # Errors
/// [`crate::base::Error::File`] if the page cannot be made.
pub fn files(comparison: &Comparison, summary: &Summary) -> Result<Vec<(String, Vec<u8>)>> {
    let outcomes = &comparison.outcomes;
    let figures = plots::figures(comparison);
    let page = page::html(comparison, summary, &figures)?;
    let plots = figures.iter().map(|(name, figure)| (name.clone(), figure.draw().to_svg()));
    let texts = [
        ("gates.md".to_string(), gates::markdown(outcomes)),
        ("gates.json".to_string(), pretty(&gates::json(outcomes))),
    ];
    let rest = [("compare.html".to_string(), page), ("summary.json".to_string(), pretty(summary))];
    let all = plots.chain(tables::tables(comparison)).chain(texts).chain(rest);
    Ok(all.map(|(name, text)| (name, text.into_bytes())).collect())
}
