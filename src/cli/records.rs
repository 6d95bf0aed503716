//! The recorded FEM curves that a run is compared with.

use crate::base::Result;
use crate::case::Case;
use crate::fem;
use std::path::Path;

/// The recorded FEM curves: those built into the program, or those of a folder.
pub(super) struct Records(Option<Vec<fem::FemResults>>);

impl Records {
    /// Those in `folder`, or the built-in ones if there is none.
    pub(super) fn read(folder: Option<&Path>) -> Result<Self> {
        folder.map(fem::FemResults::read_all).transpose().map(Self)
    }

    /// Whether they are those built into the program.
    pub(super) fn are_built_in(&self) -> bool {
        self.0.is_none()
    }

    /// The record of a case, if there is one.
    pub(super) fn find(&self, case: &Case) -> Result<Option<fem::FemResults>> {
        match &self.0 {
            Some(all) => Ok(all.iter().find(|r| r.is_of(case)).cloned()),
            None => fem::FemResults::embedded_of(case),
        }
    }
}
