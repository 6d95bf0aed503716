//! From cases to solutions.

use super::options::Options;
use super::scene::Scene;
use super::solved::{SharedStresses, Solution, SolvedCase};
use crate::base::Result;
use crate::case::Case;

/// Solves `case` with one method.
///
/// # Errors
/// As [`SolvedCase::new`].
pub fn solve(case: &Case, options: &Options) -> Result<Solution> {
    SolvedCase::new(case, options).map(|solved| solved.solution())
}

/// Solves cases that differ only in scale together: their scene is solved once, and each case gets
/// its own scales, approach and roller. A case of another scene is solved separately.
pub fn solve_group(cases: &[Case], options: &Options) -> Vec<Result<Solution>> {
    let mut shared: Option<(SolvedCase, SharedStresses)> = None;
    cases
        .iter()
        .map(|case| {
            options.check_line(case)?;
            let key = Scene::new(case, options.method, options.psi).key();
            // Extra points are in metres and therefore differ between cases; a force that has to be
            // found is no other case's.
            let own = !options.points.is_empty() || case.load.approach_m.is_some();
            let fits =
                |(first, _): &&(SolvedCase, SharedStresses)| first.scene().scene.key() == key;
            if let Some((first, stresses)) = shared.as_ref().filter(|_| !own).filter(fits) {
                let solved = SolvedCase::of_scene(case, options, first.scene().clone());
                return Ok(solved.solution_with(stresses));
            }
            let solved = SolvedCase::new(case, options)?;
            let stresses = solved.stresses();
            let solution = solved.solution_with(&stresses);
            shared = Some((solved, stresses));
            Ok(solution)
        })
        .collect()
}
