//! Case, study and sweep files. `cases/README.md` explains the formats to users.

mod builtin;
mod case_file;
mod check;
#[cfg(feature = "cli")]
mod design_file;
mod document;
mod draft;
#[cfg(feature = "cli")]
mod factor;
mod keys;
#[cfg(feature = "cli")]
mod levels;
mod model;
mod objective;
mod profile;
mod profile_table;
mod profiles;
#[cfg(feature = "cli")]
mod schema;
#[cfg(feature = "cli")]
mod study_file;
mod surface;
mod surface_table;
#[cfg(feature = "cli")]
mod sweep;
#[cfg(feature = "cli")]
mod sweep_csv;
#[cfg(feature = "cli")]
mod sweep_table;
#[cfg(feature = "cli")]
mod sweep_toml;
#[cfg(all(test, feature = "cli"))]
mod tests;
#[cfg(feature = "cli")]
pub mod two_level;

pub use builtin::{BUILTIN_CASES, BUILTIN_STUDIES, builtin_case};
pub use draft::{Draft, Form};
pub use keys::{FLAGS, Flag, KEYS, Key, Presence, WORDS, Word};
pub use model::{Accuracy, Block, Case, Cells, Factors, Fatigue, Load, Pose, Roller, Sliding};
pub use objective::Objective;
pub use profile::{ProfileKind, ProfileSpec};
pub use surface::Surface;
#[cfg(feature = "cli")]
pub(crate) use {
    builtin::is_given,
    document::{did_you_mean, known_names, unknown_word},
};
#[cfg(feature = "cli")]
pub use {
    design_file::{Design, DesignLoad, Parameter},
    factor::FactorKey,
    schema::case_schema,
    study_file::{DEFAULT_STUDY, Study, Varied, find_case, find_draft},
    sweep::Sweep,
};
