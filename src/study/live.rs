//! FEM that runs within a study, on this machine.

use super::reference::from_fem;
use super::run::Reference;
use super::timing::Timing;
use crate::base::Result;
use crate::case::Case;
use crate::fem::{self, Driver, FemSettings, MeshResult};
use std::path::Path;

/// Runs `case` by one driver `repeats` times (at least once), each in its own folder below
/// `folder`. Returns the first result and the wall-clock times of all runs.
///
/// A run that is finished in its folder is not repeated: its recorded time is used.
///
/// # Errors
/// As [`Driver::run`].
pub fn repeated(
    driver: &Driver,
    repeats: usize,
    case: &Case,
    folder: &Path,
    progress: &dyn Fn(&str),
) -> Result<(MeshResult, Timing)> {
    let first = driver.run(case, &folder.join("run-1"), progress)?;
    let mut seconds = vec![first.summary.total_seconds()];
    for i in 2..=repeats {
        let again = driver.run(case, &folder.join(format!("run-{i}")), progress)?;
        seconds.push(again.summary.total_seconds());
    }
    let timing = Timing::new(first.summary.ranks, &seconds);
    Ok((first, timing))
}

/// Ratio of the element sizes of the second mesh and the first. Their difference is FEM's own
/// error.
const COARSER: f64 = 1.4;

/// Live FEM: the drivers of the requested mesh and of a coarser one.
pub struct Live {
    fine: Driver,
    coarse: Driver,
    repeats: usize,
}

impl Live {
    /// Finds the tools. `repeats` (at least 1) runs of the finer mesh give the time's spread.
    ///
    /// # Errors
    /// As [`Driver::new`].
    pub fn new(settings: FemSettings, repeats: usize) -> Result<Self> {
        let coarser = FemSettings { size: settings.size * COARSER, ..settings.clone() };
        Ok(Self {
            fine: Driver::new(settings)?,
            coarse: Driver::new(coarser)?,
            repeats: repeats.max(1),
        })
    }

    /// Solves a case in folders below `folder`, and reports its steps to `progress`.
    ///
    /// # Errors
    /// As [`Driver::run`].
    pub fn run(&self, case: &Case, folder: &Path, progress: &dyn Fn(&str)) -> Result<Reference> {
        let coarse = self.coarse.run(case, &folder.join("coarser"), progress)?;
        let (fine, timing) = repeated(&self.fine, self.repeats, case, folder, progress)?;
        let meshes = vec![fine, coarse];
        let mut reference = from_fem(&fem::FemResults {
            case: case.clone(),
            source: "live",
            meshes,
            errors: Vec::new(),
        });
        reference.provenance.seconds = Some(timing.median_s);
        if self.repeats > 1 {
            reference.provenance.seconds_spread = Some(timing.spread_s());
        }
        Ok(reference)
    }
}
