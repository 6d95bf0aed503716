//! The table `[surface]` of a case file.

use super::document::{Table, known_names};
use super::draft::Draft;
use super::keys::{KEYS, only_keys};
use super::surface::Surface;
use crate::base::Result;
use crate::cells::{Detrend, Heights};
use std::path::Path;
use std::sync::Arc;

/// Takes `[surface]` but for its numbers; its file is looked for beside the case file, which stands
/// at `path`.
pub(super) fn read_surface(root: &Table, path: &Path, draft: &mut Draft) -> Result<()> {
    let Some(entry) = root.find("surface") else { return Ok(()) };
    let table = entry.table()?;
    only_keys(&table, "surface", KEYS.iter())?;
    let file = table.require("heights", "heights = \"rough.npy\"")?;
    let mut detrend = None;
    if let Some(entry) = table.get("detrend") {
        let name = entry.string()?;
        detrend = Detrend::ALL.into_iter().find(|detrend| detrend.name() == name);
        if detrend.is_none() {
            let known = Detrend::ALL.map(Detrend::name);
            let names = known_names(name, &known, "there are");
            let remedy = format!("{names}; without the key nothing is taken off");
            return Err(entry.refuse("there is no such trend", remedy));
        }
    }
    let heights = file.beside(path)?;
    // The distances are numbers of the case: whatever they are, the samples are the same.
    let samples = file.opened(Heights::read(&heights, [1.0; 2]))?;
    let has_steps = Heights::has_steps(&heights);
    if !has_steps {
        for key in ["dx_m", "dy_m"] {
            table.require(key, &format!("{key} = 1e-6"))?;
        }
    }
    let [dx_m, dy_m] = if has_steps { samples.steps_m() } else { [f64::NAN; 2] };
    draft.case.surface =
        Some(Surface { heights, dx_m, dy_m, detrend, samples: Some(Arc::new(samples)) });
    Ok(())
}
