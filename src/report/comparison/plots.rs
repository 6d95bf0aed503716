//! The plots of all files of a comparison.

use crate::report::brought::{Plots, plain};
use crate::report::draw::Figure;
use crate::study::brought::{Comparison, FileRun};

/// The plots by the names of their files, in the order of the files and curves.
pub(super) fn figures(comparison: &Comparison) -> Vec<(String, Figure)> {
    let (ends, excluded) = (comparison.case.overlap(), comparison.range.stress_c);
    let of_file = |run: &FileRun| {
        let file = &run.file;
        let plots = Plots { name: &file.name, all: run.all().collect(), ends, excluded };
        let named = |(curve, figure)| (plain(&format!("{}-{curve}", file.name)), figure);
        plots.figures().into_iter().map(named).collect::<Vec<_>>()
    };
    let all = comparison.files.iter().flat_map(of_file).enumerate();
    all.map(|(i, (name, figure))| (format!("plots/{:02}-{name}.svg", i + 1), figure)).collect()
}
