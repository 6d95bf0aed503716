//! The accepted numbers, and what has moved from them.

use super::number::{Number, NumberOf, numbers};
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::study::measure::Measure;
use crate::study::run::StudyRun;
use crate::study::source::Source;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The accepted numbers that are built into the program.
const DEFAULT_BASELINE: &str = include_str!("../../../results/baseline.json");

/// Steps of an accepted number in p0: far finer than any limit of the drift.
const STEPS: f64 = 1e6;

/// Accepted numbers: for each place (study, case, method, body, curve, range) the value of each
/// `quantity_measure`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Baseline {
    /// The version that accepted them.
    pub version: String,
    /// The numbers (p0).
    pub numbers: BTreeMap<String, BTreeMap<String, f64>>,
}

/// A number that differs from its accepted value, or that only one side has.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// Where, and which measure.
    pub place: String,
    /// The accepted value.
    pub accepted: Option<f64>,
    /// The value now.
    pub now: Option<f64>,
}

/// Whether a place of accepted numbers is one of a model in a study.
fn is_of(place: &str, study: &str, method: EdgeModel) -> bool {
    let mut words = place.split(' ');
    words.next() == Some(study) && words.nth(1) == Some(method.name())
}

impl Baseline {
    /// The accepted numbers that are built into the program.
    ///
    /// # Errors
    /// As [`Baseline::parse`].
    pub fn built_in() -> Result<Self> {
        Self::parse(DEFAULT_BASELINE, Path::new("baseline.json"))
    }

    /// The numbers of a run, to be accepted.
    pub fn of(run: &StudyRun) -> Self {
        let mut baseline =
            Self { version: env!("CARGO_PKG_VERSION").to_string(), numbers: BTreeMap::new() };
        for Number { case, method, of, value } in numbers(run) {
            let NumberOf::Curve { body, curve, variable, excluded_c, measure } = of else {
                continue;
            };
            if measure != Measure::L1 {
                let place = format!("{} {case} {method} {body} {curve} {excluded_c}", run.study);
                let name = format!("{variable}_{}", measure.name());
                let value = (value * STEPS).round() / STEPS;
                baseline.numbers.entry(place).or_default().insert(name, value);
            }
        }
        baseline
    }

    /// These numbers and those of `other`.
    #[must_use]
    pub fn with(mut self, other: Baseline) -> Self {
        self.numbers.extend(other.numbers);
        Self { version: other.version, ..self }
    }

    /// All but the numbers of the models of `run` in its study.
    #[must_use]
    pub fn without(mut self, run: &StudyRun) -> Self {
        let sources = || run.cases.iter().flat_map(|case| case.methods.iter().map(|m| &m.source));
        let of_run = |place: &str| {
            sources().any(|s| matches!(s, Source::Model(m) if is_of(place, &run.study, *m)))
        };
        self.numbers.retain(|place, _| !of_run(place));
        self
    }

    /// The numbers of one model in one study.
    pub fn of_model(&self, study: &str, method: EdgeModel) -> Self {
        let numbers = self.numbers.iter().filter(|(place, _)| is_of(place, study, method));
        Self {
            version: self.version.clone(),
            numbers: numbers.map(|(place, values)| (place.clone(), values.clone())).collect(),
        }
    }

    /// The distances from the edges (C) outside which the numbers are, as they stand in places.
    pub(super) fn distances_c(&self) -> BTreeSet<&str> {
        self.numbers.keys().filter_map(|place| Some(place.rsplit_once(' ')?.1)).collect()
    }

    /// Parses the text of the file of accepted numbers `path`.
    ///
    /// # Errors
    /// [`Error::File`] when they are not what [`Baseline::to_json`] writes.
    pub fn parse(text: &str, path: &Path) -> Result<Self> {
        serde_json::from_str(text).map_err(|e| Error::File {
            path: path.to_path_buf(),
            line: Some(e.line()),
            message: format!("is no JSON file of accepted numbers: {e}"),
            remedy: "write it with `edgeline gate --accept --baseline FILE`".to_string(),
        })
    }

    /// One place a line, so that a change of one number is one line of a diff.
    pub fn to_json(&self) -> String {
        let lines: Vec<String> = self
            .numbers
            .iter()
            .map(|(place, values)| {
                let values: Vec<String> =
                    values.iter().map(|(name, v)| format!("\"{name}\": {v}")).collect();
                format!("    \"{place}\": {{ {} }}", values.join(", "))
            })
            .collect();
        let version = &self.version;
        format!(
            "{{\n  \"version\": \"{version}\",\n  \"numbers\": {{\n{}\n  }}\n}}\n",
            lines.join(",\n")
        )
    }

    /// The numbers that differ from the accepted ones by more than `limit`, largest change first.
    /// Numbers that only one side has come before them.
    pub fn changes(&self, now: &Baseline, limit: f64) -> Vec<Change> {
        let flat = |b: &Baseline| -> BTreeMap<String, f64> {
            b.numbers
                .iter()
                .flat_map(|(place, v)| v.iter().map(move |(n, v)| (format!("{place}: {n}"), *v)))
                .collect()
        };
        let (old, new) = (flat(self), flat(now));
        let places: std::collections::BTreeSet<&String> = old.keys().chain(new.keys()).collect();
        let mut all: Vec<Change> = places
            .into_iter()
            .map(|p| Change {
                place: p.clone(),
                accepted: old.get(p).copied(),
                now: new.get(p).copied(),
            })
            .filter(|c| c.size().is_none_or(|s| s.is_nan() || s > limit))
            .collect();
        all.sort_by(|a, b| {
            let size = |c: &Change| c.size().unwrap_or(f64::INFINITY);
            size(b).total_cmp(&size(a))
        });
        all
    }
}

impl Change {
    /// |now - accepted|; `None` if one of them is missing.
    pub fn size(&self) -> Option<f64> {
        Some((self.now? - self.accepted?).abs())
    }

    /// In words.
    pub fn describe(&self) -> String {
        let number = |v: Option<f64>| v.map_or("absent".to_string(), |v| format!("{v:.5}"));
        format!("{}: {} -> {}", self.place, number(self.accepted), number(self.now))
    }
}
