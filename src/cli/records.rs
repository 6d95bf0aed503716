//! The recorded FEM curves that a run is compared with.

use crate::base::{Error, Result};
use crate::case::Case;
use crate::fem::{Code, FemResults};
use crate::study::Engine;
use std::path::Path;

/// The recorded FEM curves: those built into the program, or those of a folder.
pub(super) struct Records(Option<Vec<FemResults>>);

impl Records {
    /// Those in `folder`, or the built-in ones if there is none.
    ///
    /// # Errors
    /// As [`FemResults::read_all`]; [`Error::File`] for a folder without a record, with which
    /// nothing would be compared.
    pub(super) fn read(folder: Option<&Path>) -> Result<Self> {
        let Some(folder) = folder else { return Ok(Self(None)) };
        let all = FemResults::read_all(folder)?;
        if all.is_empty() {
            return Err(Error::File {
                path: folder.to_path_buf(),
                line: None,
                message: "holds no record".into(),
                remedy: "give a folder like results/reference, with a folder for each case that has a record.json"
                    .into(),
            });
        }
        Ok(Self(Some(all)))
    }

    /// The record of a case, if there is one.
    pub(super) fn find(&self, case: &Case) -> Result<Option<FemResults>> {
        match &self.0 {
            Some(all) => Ok(all.iter().find(|r| r.is_of(case)).cloned()),
            None => FemResults::embedded_of(case),
        }
    }

    /// The records of further codes for a case, or what is wrong with them: beside built-in records
    /// alone, since a folder of one's own has one code's.
    pub(super) fn further(&self, case: &Case) -> Vec<(Engine, Result<FemResults>)> {
        if self.0.is_some() {
            return Vec::new();
        }
        let codes = Code::ALL.into_iter().skip(1);
        let found =
            |code| Some((Engine::of(code), FemResults::embedded_by(code, case).transpose()?));
        codes.filter_map(found).collect()
    }
}
