//! Options of uncertain inputs.

use super::values::count;
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::Case;
use crate::report::uncertainty;
use crate::stress::Curves;
use crate::study::uncertain::{Input, MOST_SAMPLES, propagate};
use clap::Args;

/// Uncertain numbers of a case, and how they are sampled.
#[derive(Args)]
pub(super) struct UncertainOptions {
    /// A number of the case and its standard deviation, as load_n=5% or roller.radius_m=1e-5; may
    /// be given several times. Writes uncertainty.csv and .json and plot-uncertainty (.svg and
    /// .png)
    #[arg(long, value_name = "KEY=DEVIATION")]
    uncertain: Vec<String>,
    /// Samples of the Latin hypercube
    #[arg(long, default_value_t = 64, value_name = "N", requires = "uncertain", value_parser = count("samples", 2..=MOST_SAMPLES))]
    samples: usize,
    /// Seed of the samples
    #[arg(long, default_value_t = 1, value_name = "N", requires = "uncertain")]
    seed: u64,
}

impl UncertainOptions {
    /// Whether an input is uncertain.
    pub(super) fn is_given(&self) -> bool {
        !self.uncertain.is_empty()
    }

    /// The uncertain numbers of `case`.
    ///
    /// # Errors
    /// As [`Input::parse`]; [`Error::Value`] for a number that is given twice.
    pub(super) fn inputs(&self, case: &Case) -> Result<Vec<Input>> {
        let mut all: Vec<Input> = Vec::new();
        for text in &self.uncertain {
            let input = Input::parse(text, case)?;
            if all.iter().any(|known| known.key == input.key) {
                return Err(Error::Value {
                    key: "--uncertain".into(),
                    value: text.clone(),
                    reason: format!("{} is uncertain already", input.key.path),
                    remedy: "give one standard deviation for each number".into(),
                });
            }
            all.push(input);
        }
        Ok(all)
    }

    /// The files of the spreads of a solution with these `curves`; none without an uncertain input.
    ///
    /// # Errors
    /// As [`propagate`].
    pub(super) fn contents(
        &self,
        case: &Case,
        method: EdgeModel,
        curves: &Curves,
    ) -> Result<Vec<(String, Vec<u8>)>> {
        if !self.is_given() {
            return Ok(Vec::new());
        }
        let sampling = (self.samples, self.seed);
        let found = propagate(case, method, curves, self.inputs(case)?, sampling)?;
        Ok(uncertainty::contents(case, &found, method))
    }
}
