//! The plots by the names of their files.

use super::{case, effects, times};
use crate::report::draw::Figure;
use crate::report::study_files::StudyFiles;

/// The plots of the whole study, by name.
fn summary_figures(files: &StudyFiles) -> Vec<(String, Figure)> {
    let mut plots = effects::figures(files);
    plots.push(("time-error".to_string(), times::figure(files)));
    plots
}

/// All plots of a run: names of the files, and SVG.
pub fn all(files: &StudyFiles) -> Vec<(String, String)> {
    let figures = case::figures(files).into_iter().chain(summary_figures(files));
    figures.map(|(name, f)| (format!("{name}.svg"), f.draw().to_svg())).collect()
}

/// One of the plots of the whole study (`time-error`, `half-normal-<method>`, `pareto-<method>`,
/// `interactions-<method>`) as SVG in the colours of a page.
pub fn named(files: &StudyFiles, name: &str) -> Option<String> {
    summary_figures(files)
        .into_iter()
        .find(|(n, _)| n == name)
        .map(|(_, f)| f.draw().to_themed_svg())
}
