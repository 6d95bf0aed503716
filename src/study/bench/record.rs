//! The content of `bench.json`, and the record that is built into the program.

use super::point::{Against, BenchPoint, CaseBench, Origin};
use super::speedup::{CodeTimes, Speedup, code_times, published_speedups, speedups};
use crate::base::{Error, Result};
use crate::case::Case;
use crate::study::errors::Range;
use crate::study::run::Timed;
use crate::study::source::Engine;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The record of a run with live FEM that is built into the program.
const RECORD: &str = include_str!("../../../results/bench.json");

/// The layout of the file in this version.
const SCHEMA: u32 = 1;

/// The machine of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Its processor.
    pub processor: String,
    /// Number of its threads.
    pub threads: usize,
}

/// A run: the content of `bench.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Bench {
    /// Layout of the file.
    pub schema: u32,
    /// Version of the program.
    pub version: String,
    /// When it ran (UTC, ISO 8601); empty when nothing was recorded yet.
    pub date: String,
    /// The command.
    pub command: String,
    /// The machine.
    pub machine: Machine,
    /// The range of the errors.
    pub range: Range,
    /// Errors at which FEM and [`super::BEST`] are compared (p0).
    pub levels: Vec<f64>,
    /// The tolerance of the models' limit (p0).
    pub limit: f64,
    /// The cases.
    pub cases: Vec<CaseBench>,
    /// The ratios.
    pub speedups: Vec<Speedup>,
    /// Those of the published method on cells, at the error that it reaches in each case.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub published: Vec<Speedup>,
    /// The times of the codes at equal error, where several ran.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub codes: Vec<CodeTimes>,
}

impl Bench {
    /// A run with the ratios of its cases. `levels` and `limit` are as in the fields.
    pub fn new(
        date: String,
        command: String,
        machine: Machine,
        limit: f64,
        levels: Vec<f64>,
        cases: Vec<CaseBench>,
    ) -> Self {
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION").to_string(),
            date,
            command,
            machine,
            range: Range::default(),
            speedups: speedups(&cases, &levels),
            published: published_speedups(&cases),
            codes: code_times(&cases, &levels),
            levels,
            limit,
            cases,
        }
    }

    /// Parses the text of the `bench.json` at `path`.
    ///
    /// # Errors
    /// [`Error::File`] when it is no such file or has another layout.
    pub fn parse(text: &str, path: &Path) -> Result<Self> {
        let refuse = |line, message: String| Error::File {
            path: path.to_path_buf(),
            line,
            message,
            remedy: "make it anew with `edgeline bench --fem live`".to_string(),
        };
        let bench: Self =
            serde_json::from_str(text).map_err(|e| refuse(Some(e.line()), e.to_string()))?;
        if bench.schema != SCHEMA {
            let message = format!("has schema {}, this program reads {SCHEMA}", bench.schema);
            return Err(refuse(None, message));
        }
        Ok(bench)
    }

    /// The record that is built into the program.
    ///
    /// # Errors
    /// As [`Bench::parse`].
    pub fn recorded() -> Result<Self> {
        Self::parse(RECORD, Path::new("results/bench.json"))
    }

    /// The ratios among `all` of the run's that are those of `case`, under its own name.
    pub fn speedups_of(&self, case: &Case, all: &[Speedup]) -> Vec<Speedup> {
        let found = self.cases.iter().find(|c| c.case.is_same_problem(case));
        let named = |s: &&Speedup| found.is_some_and(|c| c.case.name == s.case);
        let own = all.iter().filter(named);
        own.map(|s| Speedup { case: case.name.clone(), ..s.clone() }).collect()
    }

    /// Times of the finest live mesh of `case` and of the models at its tolerance.
    pub fn timed(&self, case: &Case) -> Option<Timed> {
        let found = self.cases.iter().find(|c| c.case.is_same_problem(case))?;
        let first = Engine::fenicsx().into();
        let live = found.points.iter().filter(|p| p.origin == Origin::LiveFem && p.source == first);
        let fem =
            live.filter(|p| p.timing.is_some()).min_by(|a, b| a.setting.total_cmp(&b.setting))?;
        let same = |p: &&BenchPoint| (p.setting / case.accuracy.tolerance - 1.0).abs() < 1e-9;
        let models = found.points.iter().filter(|p| p.origin == Origin::Model).filter(same);
        let methods: std::collections::BTreeMap<_, _> =
            models.filter_map(|p| Some((p.source.to_string(), p.timing?.with_spread()))).collect();
        (!methods.is_empty()).then(|| Timed {
            date: self.date.clone(),
            machine: self.machine.processor.clone(),
            command: self.command.clone(),
            size: fem.setting,
            unknowns: fem.unknowns.unwrap_or(0),
            seconds: fem.timing.map(|t| t.with_spread()).expect("filtered above"),
            error: fem.error(Against::Fem),
            tolerance: case.accuracy.tolerance,
            methods,
        })
    }
}
