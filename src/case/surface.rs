//! The rough surface of a case: measured heights on the block, within the contact.

use crate::cells::{Detrend, Heights};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
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
