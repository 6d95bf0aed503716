//! The files of a state that the page offers for download.

use crate::base::Result;
use crate::base::stop::go_on;
use crate::body::EdgeModel;
use crate::case::Case;
use crate::report::plots::PROGRAM;
use crate::report::study_files::pretty;
use crate::report::{page, solution};
use crate::solve::{Options, SolvedCase};

/// The files of a state that can be downloaded.
pub const FILES: [&str; 12] = [
    "case.toml",
    "curves.csv",
    "pressure.csv",
    "line_load.csv",
    "summary.json",
    "summary.html",
    "plot-pressure.png",
    "plot-pressure-map.png",
    "plot-along-block.png",
    "plot-depth-block.png",
    "plot-along-roller.png",
    "plot-depth-roller.png",
];

/// The kind of a file, as HTTP names it.
pub fn kind_of(file: &str) -> &'static str {
    match file.rsplit_once('.').map_or("", |(_, ending)| ending) {
        "html" => "text/html; charset=utf-8",
        "json" => "application/json",
        "png" => "image/png",
        "csv" => "text/csv; charset=utf-8",
        _ => "text/plain; charset=utf-8",
    }
}

/// One of [`FILES`] for a case, as `edgeline solve --plots` writes it.
///
/// # Errors
/// As [`SolvedCase::new`].
pub fn made(case: &Case, method: EdgeModel, file: &str) -> Result<Vec<u8>> {
    if file == "case.toml" {
        return Ok(case.to_toml().into_bytes());
    }
    let options = Options::new(method);
    let found = SolvedCase::new(case, &options)?.solution();
    go_on()?;
    if file == "summary.json" {
        return Ok(pretty(&found.summary).into_bytes());
    }
    if let Some(table) = file.strip_suffix(".csv") {
        let table = solution::tables(&found, &options).into_iter().find(|t| t.name == table);
        return Ok(table.expect("a solution has these tables").to_csv().into_bytes());
    }
    let label = page::Label {
        by: method.to_string(),
        program: PROGRAM.into(),
        date: String::new(),
        cells: None,
    };
    let files = page::of_solution(case, &label, &found)?;
    Ok(files.into_iter().find(|(name, _)| name == file).expect("a solution has these pictures").1)
}
