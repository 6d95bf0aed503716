//! Pairing of curves, error measures, factorial effects, timing, gates, and the run of a study.
//!
//! All lengths are in units of C and all stresses in units of p0 (see
//! [`crate::base::HertzScales`]): a study compares cases of different loads.

pub mod bench;
pub mod brought;
mod case_form;
pub mod effects;
pub mod errors;
pub mod factorial;
pub mod gate;
mod groups;
pub mod live;
pub mod measure;
mod models;
pub mod optimum;
mod published;
pub mod reference;
pub mod response;
mod run;
mod source;
pub mod sweep;
pub mod timing;
pub mod uncertain;
pub mod verification;

pub use case_form::{BlockForm, RollerForm};
pub use errors::{CONTACT, ErrorRow, Range};
pub use models::{Cold, Models, Solver};
pub use published::{GRIDS, Published};
pub use run::{
    CaseRun, Factor, FoundReference, MethodDetails, MethodResult, MethodRun, Provenance, Reference,
    ReferenceRun, Role, StudyRun, StudySetup, Timed, run,
};
pub use source::{Engine, Source};

#[cfg(test)]
pub(crate) mod synthetic;
