//! The form of a case in the files of runs, `bench.json` and `summary.json`, for serde's `with`.
//! There a body's material is a table of its own; in case files and records it is not.

use crate::base::Material;
use crate::case::{
    Accuracy, Block, Case, Cells, Fatigue, Load, Pose, ProfileSpec, Roller, Sliding, Surface,
};
use serde::{Deserialize, Serialize};

/// A case in `bench.json`.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Case")]
pub(super) struct CaseForm {
    name: String,
    #[serde(with = "RollerForm")]
    roller: Roller,
    #[serde(with = "BlockForm")]
    block: Block,
    #[serde(flatten)]
    load: Load,
    #[serde(flatten)]
    pose: Pose,
    #[serde(flatten)]
    sliding: Sliding,
    #[serde(default, skip_serializing_if = "Fatigue::is_none")]
    fatigue: Fatigue,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    surface: Option<Surface>,
    #[serde(flatten)]
    accuracy: Accuracy,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    cells: Option<Cells>,
}

/// A roller, with its material as a table.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Roller")]
pub struct RollerForm {
    radius_m: f64,
    length_m: f64,
    material: Material,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    profile: Option<ProfileSpec>,
}

/// A block, with its material as a table.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Block")]
pub struct BlockForm {
    length_m: f64,
    material: Material,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    radius_m: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    profile: Option<ProfileSpec>,
}
