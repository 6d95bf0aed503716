use super::end::End;
use super::{guilbault, half_space, mirror, quarter_space};
use crate::base::{Error, Result};
use serde::{Deserialize, Serialize};

/// How a free end face is modelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum EdgeModel {
    /// No correction: both bodies are half-spaces.
    HalfSpace,
    /// Every pressure is mirrored once in both end faces.
    Mirror,
    /// Mirrored pressures weighted with Guilbault's factor psi, and a stress correction.
    Guilbault,
    /// Both end faces free of traction.
    QuarterSpace,
}

impl EdgeModel {
    /// All models, simplest first.
    pub const ALL: [EdgeModel; 4] =
        [EdgeModel::HalfSpace, EdgeModel::Mirror, EdgeModel::Guilbault, EdgeModel::QuarterSpace];

    /// The name used in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            EdgeModel::HalfSpace => "half-space",
            EdgeModel::Mirror => "mirror",
            EdgeModel::Guilbault => "guilbault",
            EdgeModel::QuarterSpace => "quarter-space",
        }
    }

    /// The treatment of the end faces of a body of Poisson's ratio `nu`; `psi` replaces the image
    /// weight of a model that has such a factor.
    pub fn end(self, nu: f64, psi: Option<f64>) -> End {
        match self {
            EdgeModel::HalfSpace => half_space::end(),
            EdgeModel::Mirror => mirror::end(),
            EdgeModel::Guilbault => guilbault::end(nu, psi),
            EdgeModel::QuarterSpace => quarter_space::end(),
        }
    }
}

impl std::str::FromStr for EdgeModel {
    type Err = Error;

    /// The model called `name`.
    fn from_str(name: &str) -> Result<Self> {
        EdgeModel::ALL.into_iter().find(|model| model.name() == name).ok_or_else(|| Error::Value {
            key: "method".into(),
            value: format!("{name:?}"),
            reason: "there is no model of this name".into(),
            remedy: format!("give one of {}", EdgeModel::ALL.map(EdgeModel::name).join(", ")),
        })
    }
}

impl std::fmt::Display for EdgeModel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
