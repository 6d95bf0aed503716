//! The published method on cells, for the commands that compare it.

use crate::base::Result;
use crate::body::EdgeModel;
use crate::case::Case;
use crate::solve::{CellDetails, CellOptions, Options, Solution, solve_on_cells};
use crate::study::{Engine, Source};

/// Whether the published method was named; so it was if nothing was.
pub(super) fn is_chosen(named: &[Source]) -> bool {
    named.is_empty() || named.contains(&Engine::published().into())
}

/// Its solution of `case` on so many cells across and along, or on as many as the case's shape asks
/// for; `psi` as in [`Options`].
pub(super) fn solve(
    case: &Case,
    counts: Option<[usize; 2]>,
    psi: Option<f64>,
) -> Result<Solution<CellDetails>> {
    let options = Options { psi, ..Options::new(EdgeModel::Guilbault) };
    let cells = CellOptions { counts, ..CellOptions::default() };
    Ok(solve_on_cells(case, &options, &cells, &|_, _| {})?.solution)
}
