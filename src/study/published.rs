//! The published method as it was published: `guilbault` on uniform cells, beside the models on the
//! line.

use super::timing::Timing;
use crate::base::Result;
use crate::case::Case;
use crate::solve::{CellDetails, Solution};

/// Solves a case by the published method on so many cells across and along, or on as many as its
/// shape asks for.
pub type Published<'a> =
    dyn Fn(&Case, Option<[usize; 2]>) -> Result<Solution<CellDetails>> + Sync + 'a;

/// Grids for run time against error: cells across and along, coarsest first.
pub const GRIDS: [[usize; 2]; 5] = [[64, 64], [64, 128], [128, 256], [256, 512], [512, 1024]];

/// What the published method makes of one case.
pub(super) struct PublishedAttempt {
    /// Its solution.
    pub solution: Result<Solution<CellDetails>>,
    /// Its time on one thread, where times are asked for: of the solve itself, which is too slow to
    /// be repeated.
    pub timing: Option<Timing>,
}

impl PublishedAttempt {
    /// Solves `case`, and takes the time if it is to be `timed`.
    pub fn new(solve: &Published, timed: bool, case: &Case, cells: Option<[usize; 2]>) -> Self {
        let solution = match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
            Ok(pool) if timed => pool.install(|| solve(case, cells)),
            _ => solve(case, cells),
        };
        let seconds = solution.as_ref().ok().filter(|_| timed).map(|s| s.summary.seconds.total);
        Self { timing: seconds.map(|seconds| Timing::new(1, &[seconds])), solution }
    }
}
