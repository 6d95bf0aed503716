//! `summary.json` of a study: the facts about a run beside its tables.

use super::brought::FileSummary;
use super::table::Layout;
use crate::base::HertzScales;
use crate::body::EdgeModel;
use crate::case::{Block, Pose, Roller, Sliding};
use crate::solve::Details;
use crate::study::bench::{Machine, Speedup};
use crate::study::gate::GateOutcome;
use crate::study::response::Response;
use crate::study::timing::Timing;
use crate::study::{BlockForm, Engine, Factor, Provenance, Range, Role, RollerForm};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The origin of a run's FEM curves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FemOrigin {
    /// Records.
    Recorded,
    /// The run itself.
    Live,
}

/// The content of `summary.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StudySummary {
    /// The program that ran it.
    pub program: Program,
    /// The study's name.
    pub study: String,
    /// When it ran (UTC, ISO 8601).
    pub date: String,
    /// The command.
    pub command: String,
    /// The origin of the FEM curves.
    pub fem: FemOrigin,
    /// The machine.
    pub machine: Machine,
    /// Wall-clock seconds of the whole run.
    pub seconds: f64,
    /// The models, simplest first.
    pub methods: Vec<EdgeModel>,
    /// The range of the errors.
    pub range: Range,
    /// The factors with two levels.
    pub factors: Vec<Factor>,
    /// The two-level design of these factors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub design: Option<DesignSummary>,
    /// The factors that the study varies beside W, S_l and L_r, which have columns of their own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub further_factors: Vec<String>,
    /// Number of contact problems solved.
    pub contact_problems_solved: usize,
    /// The worst numbers of each model.
    pub method_summary: Vec<MethodSummary>,
    /// The published method on cells, where it was compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub published: Option<PublishedSummary>,
    /// Its ratios to FEM on record, at the error that it reaches.
    #[serde(default)]
    pub published_speedups: Vec<Speedup>,
    /// The largest own error of FEM.
    pub fem_error: FemError,
    /// Whether there are gates and all hold.
    pub gates_hold: bool,
    /// Outcomes of the gates.
    pub gates: Vec<GateOutcome>,
    /// The effects in words.
    pub effects_in_words: Vec<EffectText>,
    /// Ratios at equal error on record.
    pub speedups: Vec<Speedup>,
    /// What is missing, one sentence each.
    pub not_done: Vec<String>,
    /// The cases, in the study's order.
    pub cases: Vec<CaseSummary>,
    /// The verdict, the most important sentence first.
    pub verdict: Vec<String>,
}

/// A two-level design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DesignSummary {
    /// Its name, such as `2^(5-1), resolution V`.
    pub name: String,
    /// Number of its runs.
    pub runs: usize,
    /// Its resolution; none of a full design.
    pub resolution: Option<usize>,
    /// The factors' letters, in the order of the factors.
    pub letters: Vec<char>,
    /// The words of the defining relation, which are +1 in all runs; none of a full design.
    pub defining_relation: Vec<String>,
    /// The sums of effects that can be estimated, without aliases that are long; none for a full
    /// design.
    pub aliases: Vec<String>,
    /// The mean that the centre point is for each factor, `geometric` or `arithmetic`.
    pub centre: Vec<String>,
}

/// A program and its version.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Program {
    /// Its name.
    pub name: String,
    /// Its version.
    pub version: String,
}

/// The worst errors of one model over all cases (p0), and its times (s).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MethodSummary {
    /// The model.
    pub method: EdgeModel,
    /// Number of cases.
    pub cases: usize,
    /// Number of cases without a solution.
    pub failed: usize,
    /// Number of cases compared with FEM.
    pub compared: usize,
    /// [`Response::PRESSURE_RMS`].
    pub pressure_rms: Option<f64>,
    /// [`Response::PRESSURE_MAX`].
    pub pressure_max: Option<f64>,
    /// [`Response::STRESS_RMS`].
    pub stress_rms: Option<f64>,
    /// [`Response::STRESS_MAX`].
    pub stress_max: Option<f64>,
    /// [`Response::VON_MISES_RMS`].
    pub von_mises_rms: Option<f64>,
    /// [`Response::VON_MISES_MAX`].
    pub von_mises_max: Option<f64>,
    /// Median seconds on one thread of the slowest case.
    pub seconds: Option<f64>,
    /// FEM's time over the model's.
    pub speedup: Option<Span>,
    /// Number of gates on this model.
    pub gates: usize,
    /// Number of these that hold.
    pub gates_passed: usize,
}

/// Errors of the published method on cells over the cases compared (p0), and its time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PublishedSummary {
    /// Number of cases compared.
    pub cases: usize,
    /// [`Response::PRESSURE_RMS`].
    pub pressure_rms: Span,
    /// [`Response::PRESSURE_MAX`].
    pub pressure_max: Span,
    /// [`Response::STRESS_RMS`].
    pub stress_rms: Span,
    /// [`Response::STRESS_MAX`].
    pub stress_max: Span,
    /// Seconds on one thread of the slowest case.
    pub seconds: Option<f64>,
}

/// A lowest and a highest value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Span {
    /// The lowest.
    pub low: f64,
    /// The highest.
    pub high: f64,
}

/// The largest own error of FEM over the range of the comparison (p0).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FemError {
    /// Of a pressure.
    pub pressure: Option<f64>,
    /// Of a stress component.
    pub stress: Option<f64>,
}

/// The effects on one response of one model in words.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EffectText {
    /// The model.
    pub method: EdgeModel,
    /// The response.
    pub response: Response,
    /// The text.
    pub text: String,
}

/// One case of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CaseSummary {
    /// Its name.
    pub name: String,
    /// Its role in the study.
    pub role: RoleName,
    /// W.
    #[serde(rename = "W")]
    pub load: f64,
    /// S_l.
    #[serde(rename = "S_l")]
    pub slenderness: f64,
    /// L_r.
    #[serde(rename = "L_r")]
    pub length_ratio: f64,
    /// The further factors of the study, see [`StudySummary::further_factors`].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub factors: Vec<Option<f64>>,
    /// The scales.
    pub hertz: HertzScales,
    /// y of the ends of the bodies' overlap (m).
    pub overlap_m: [f64; 2],
    /// Load (N).
    pub load_n: f64,
    /// The models' tolerance (p0).
    pub tolerance: f64,
    /// The roller.
    #[serde(with = "RollerForm")]
    pub roller: Roller,
    /// The block.
    #[serde(with = "BlockForm")]
    pub block: Block,
    /// y of the load's line of action from the roller's middle (m), where it is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub eccentricity_m: Option<f64>,
    /// How the bodies stand to each other.
    #[serde(default, skip_serializing_if = "Pose::is_plain")]
    pub pose: Pose,
    /// How they slide on each other.
    #[serde(default, skip_serializing_if = "Sliding::is_none")]
    pub sliding: Sliding,
    /// The reference that errors are taken against.
    pub fem: CaseReference,
    /// The other references by engine.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub references: BTreeMap<Engine, CaseReference>,
    /// Curves from files, and what they were compared with.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub brought: Vec<FileSummary>,
    /// The models.
    pub methods: BTreeMap<EdgeModel, CaseMethod>,
}

impl CaseSummary {
    /// y of the ends of the bodies' overlap (C).
    pub fn overlap(&self) -> [f64; 2] {
        self.overlap_m.map(|y| y / self.hertz.c_m)
    }
}

/// The role of a case in its study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RoleName {
    /// A corner of the design.
    Corner,
    /// The centre point.
    Centre,
    /// A further case.
    Extra,
}

/// A reference in a case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum CaseReference {
    /// There are no curves.
    Missing {
        /// Why.
        missing: String,
    },
    /// The origin of the curves.
    Found(Box<Provenance>),
}

/// A model in a case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum CaseMethod {
    /// There is no solution.
    Failed {
        /// The error.
        err: String,
    },
    /// The cost of the solution.
    Solved {
        /// Repeated timing on one thread and on all.
        timing: Vec<Timing>,
        /// The resolution and other details of the solver.
        details: Box<Details>,
    },
}

impl StudySummary {
    /// Whether curves from files take part.
    pub fn has_brought(&self) -> bool {
        self.cases.iter().any(|case| !case.brought.is_empty())
    }

    /// What the columns of the run's tables depend on.
    pub fn layout(&self) -> Layout<'_> {
        let aliases = self.design.as_ref().is_some_and(|design| design.resolution.is_some());
        Layout { range: &self.range, further: &self.further_factors, aliases }
    }
}

impl RoleName {
    /// The name of a role.
    pub fn of(role: &Role) -> Self {
        match role {
            Role::Corner(_) => RoleName::Corner,
            Role::Centre => RoleName::Centre,
            Role::Extra => RoleName::Extra,
        }
    }
}

impl CaseSummary {
    /// The origin of the curves that errors are taken against, if there are any.
    pub fn provenance(&self) -> Option<&Provenance> {
        match &self.fem {
            CaseReference::Found(provenance) => Some(provenance),
            CaseReference::Missing { .. } => None,
        }
    }

    /// The solver's details of each model that has a solution.
    pub fn details(&self) -> impl Iterator<Item = (EdgeModel, &Details)> {
        self.methods.iter().filter_map(|(method, solved)| match solved {
            CaseMethod::Solved { details, .. } => Some((*method, &**details)),
            CaseMethod::Failed { .. } => None,
        })
    }
}
