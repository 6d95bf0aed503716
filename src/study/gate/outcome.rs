//! What comes of a gate.

use crate::body::EdgeModel;
use serde::{Deserialize, Serialize};

/// The kind of a gate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// An absolute limit.
    Limit,
    /// The accepted numbers.
    Drift,
    /// A result for every case.
    Coverage,
}

impl Kind {
    /// The name used in files.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Limit => "limit",
            Kind::Drift => "drift",
            Kind::Coverage => "coverage",
        }
    }
}

/// The outcome of one gate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GateOutcome {
    /// The study that was run; empty for curves that were brought in.
    #[serde(default)]
    pub study: String,
    /// Its name.
    pub name: String,
    /// The method, or `all`.
    pub method: String,
    /// The kind of gate.
    pub kind: Kind,
    /// Whether it holds.
    pub passed: bool,
    /// Its worst value, where there is one.
    pub value: Option<f64>,
    /// Its limit.
    pub limit: f64,
    /// Distance of the value from the limit, positive if the gate holds.
    pub margin: Option<f64>,
    /// Number of numbers compared.
    pub compared: usize,
    /// The place of the worst value, or why the gate failed, in words.
    pub note: String,
}

impl GateOutcome {
    /// A gate of this name, model and kind that fails because it has nothing to judge, as the
    /// `note` says. It names no study.
    pub fn nothing(name: &str, method: Option<EdgeModel>, kind: Kind, note: &str) -> Self {
        Self {
            study: String::new(),
            name: name.to_string(),
            method: method.map_or("all", EdgeModel::name).to_string(),
            kind,
            passed: false,
            value: None,
            limit: 1.0,
            margin: None,
            compared: 0,
            note: note.to_string(),
        }
    }

    /// Its name after that of its study, if it is one of a study.
    pub fn title(&self) -> String {
        match self.study.as_str() {
            "" => self.name.clone(),
            study => format!("{study}: {}", self.name),
        }
    }
}
