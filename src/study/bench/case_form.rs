//! The form of a case in `bench.json`, which is older than the one of case files.

use crate::base::Material;
use crate::case::{Accuracy, Block, Case, Load, Roller};
use serde::{Deserialize, Serialize};

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
    accuracy: Accuracy,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Roller")]
struct RollerForm {
    radius_m: f64,
    length_m: f64,
    material: Material,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Block")]
struct BlockForm {
    length_m: f64,
    material: Material,
}
