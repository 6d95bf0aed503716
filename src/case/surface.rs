//! The rough surface of a case: measured heights on the block, within the contact.

use super::document::{Table, nearest};
use super::draft::Draft;
use super::model::Case;
use crate::base::Result;
use crate::cells::{Detrend, Heights};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Heights that come on top of the smooth surfaces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Surface {
    /// Their file.
    pub heights: PathBuf,
    /// Distance of the samples across the contact (m).
    pub dx_m: f64,
    /// Distance of the samples along the contact (m).
    pub dy_m: f64,
    /// What is taken off them; nothing if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub detrend: Option<Detrend>,
    /// The heights in the file, at any distances.
    #[serde(skip)]
    pub samples: Option<Arc<Heights>>,
}

impl Surface {
    /// The heights, their trend taken off.
    pub fn heights(&self) -> Option<Heights> {
        let heights = self.samples.as_ref()?.with_steps([self.dx_m, self.dy_m]);
        Some(match self.detrend {
            Some(what) => heights.without(what),
            None => heights,
        })
    }
}

impl Case {
    /// The heights of the rough surface (m), if there is one.
    pub fn heights(&self) -> Option<Heights> {
        self.surface.as_ref()?.heights()
    }
}

/// Takes `[surface]` but for its numbers; its file is looked for beside the case file, which stands at `path`.
pub(super) fn read_surface(root: &Table, path: &Path, draft: &mut Draft) -> Result<()> {
    let Some(entry) = root.find("surface") else { return Ok(()) };
    let table = entry.table()?;
    let file = table.require("heights", "heights = \"rough.npy\"")?;
    let mut detrend = None;
    if let Some(entry) = table.get("detrend") {
        let name = entry.string()?;
        detrend = Detrend::ALL.into_iter().find(|detrend| detrend.name() == name);
        if detrend.is_none() {
            let known = Detrend::ALL.map(Detrend::name);
            let remedy = format!(
                "did you mean {}? There are {}; without the key nothing is taken off",
                nearest(name, &known),
                known.join(" and ")
            );
            return Err(entry.refuse("there is no such trend", remedy));
        }
    }
    for key in ["dx_m", "dy_m"] {
        table.require(key, &format!("{key} = 1e-6"))?;
    }
    let heights = path.parent().unwrap_or(Path::new("")).join(file.string()?);
    // The distances are numbers of the case: whatever they are, the samples are the same.
    let samples = Heights::read(&heights, [1.0; 2])?;
    draft.case.surface = Some(Surface {
        heights,
        dx_m: f64::NAN,
        dy_m: f64::NAN,
        detrend,
        samples: Some(Arc::new(samples)),
    });
    Ok(())
}
