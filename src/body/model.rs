use serde::{Deserialize, Serialize};

/// How a free end face is modelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EdgeModel {
    /// No correction: both bodies are half-spaces.
    HalfSpace,
    /// Every pressure is mirrored once in both end faces.
    Mirror,
    /// Mirrored pressures weighted with Guilbault's factor psi, and a stress correction.
    Guilbault,
    /// The complete solution: both end faces free of traction.
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
}

impl std::fmt::Display for EdgeModel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
