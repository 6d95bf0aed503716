//! The thresholds file, and what its gates select.

use super::number::{Number, NumberOf, Whole};
use super::outcome::{GateOutcome, Kind};
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::unknown_word;
use crate::study::measure::{Measure, Of};
use serde::{Deserialize, Deserializer, de};
use std::path::Path;

/// The thresholds that are built into the program, by the name of their study; the default one's
/// first.
pub(super) const BUILTIN_GATES: [(&str, &str); 3] = [
    ("factorial", include_str!("../gates/factorial.toml")),
    ("profiled", include_str!("../gates/profiled.toml")),
    ("scenes", include_str!("../gates/scenes.toml")),
];

/// Those of cases in no built-in study.
const OTHERS: (&str, &str) = ("others", include_str!("../gates/others.toml"));

/// The thresholds file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gates {
    /// Absolute limits.
    #[serde(default)]
    pub gate: Vec<Gate>,
    /// The largest change of a number from the accepted one.
    pub drift: Option<Drift>,
}

impl Gates {
    /// The thresholds of the default study that are built into the program.
    ///
    /// # Errors
    /// As [`parse`].
    pub fn built_in() -> Result<Self> {
        Self::built_in_for(BUILTIN_GATES[0].0)
    }

    /// The thresholds that are built into the program for the built-in `study`, and those of
    /// [`Gates::for_others`] for any other.
    ///
    /// # Errors
    /// As [`parse`].
    pub fn built_in_for(study: &str) -> Result<Self> {
        let own = BUILTIN_GATES.iter().find(|(name, _)| *name == study);
        Self::embedded(own.unwrap_or(&OTHERS))
    }

    /// The thresholds for cases in no built-in study, which may be without the terms of first order
    /// that the default study has.
    ///
    /// # Errors
    /// As [`parse`].
    pub fn for_others() -> Result<Self> {
        Self::embedded(&OTHERS)
    }

    fn embedded((name, text): &(&str, &str)) -> Result<Self> {
        parse(text, &Path::new("gates").join(name).with_extension("toml"))
    }

    /// The models whose numbers the gates take: [`Drift::methods`], or all.
    pub fn methods(&self) -> Vec<EdgeModel> {
        let stated = self.drift.iter().flat_map(|drift| drift.methods.clone());
        let stated: Vec<EdgeModel> = stated.collect();
        if stated.is_empty() { EdgeModel::ALL.to_vec() } else { stated }
    }
}

/// One absolute limit. Filters that are not given select everything.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gate {
    /// Its name in tables.
    pub name: String,
    /// The edge model.
    pub method: EdgeModel,
    /// `pressure`, a stress (`sigma_xx` ...), `stress` (any of the six), `von_mises`, `tau_max`,
    /// `critical_value`, `critical_depth`, `load` (relative error of the load) or `speedup`.
    #[serde(rename = "quantity")]
    pub selected: Selected,
    /// `max`, `rms` or `l1`; left out for the last four quantities.
    #[serde(default)]
    pub measure: Option<Measure>,
    /// Names of cases; a final `*` matches any ending.
    #[serde(default)]
    pub cases: Vec<String>,
    /// Names of curves or pressure lines; a final `*` matches any ending.
    #[serde(default)]
    pub curves: Vec<String>,
    /// `block` or `roller`.
    #[serde(default)]
    pub body: Option<String>,
    /// Only numbers with this excluded distance from the edges (C).
    #[serde(default)]
    pub excluded_c: Option<f64>,
    /// The upper limit (p0; C for a depth), or the lower limit of a speed-up.
    pub limit: f64,
}

/// What a gate selects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Selected {
    /// Errors on curves.
    Error(Of),
    /// A number of whole cases.
    Whole(Whole),
}

impl Selected {
    /// The name used in files.
    fn name(self) -> &'static str {
        match self {
            Self::Error(of) => of.name(),
            Self::Whole(whole) => whole.name(),
        }
    }

    /// Whether a number is one of it.
    pub fn takes(self, number: &NumberOf) -> bool {
        match (self, number) {
            (Self::Error(of), NumberOf::Curve { variable, .. }) => of.takes(*variable),
            (Self::Whole(own), NumberOf::Whole(whole)) => own == *whole,
            _ => false,
        }
    }
}

impl<'de> Deserialize<'de> for Selected {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        let whole = Whole::ALL.into_iter().find(|whole| whole.name() == name);
        let error = || Of::from_name(&name).map(Self::Error);
        whole
            .map(Self::Whole)
            .or_else(error)
            .ok_or_else(|| de::Error::custom(format!("quantity = {name:?} is not known")))
    }
}

/// Limit of the drift.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drift {
    /// Largest change of a maximum or RMS error with recorded FEM curves (p0).
    pub recorded: f64,
    /// The same with FEM computed in the run, whose mesh follows the installed gmsh (p0).
    pub live: f64,
    /// The models whose numbers are accepted; empty for all.
    #[serde(default)]
    pub methods: Vec<EdgeModel>,
}

/// Parses the text of the thresholds file `path`.
///
/// # Errors
/// [`Error::File`] with the line when it is not TOML, or has an unknown key, an unknown name, a
/// limit that is not a positive number, a distance that is not zero or more, or nothing to be held
/// to.
pub fn parse(text: &str, path: &Path) -> Result<Gates> {
    let refuse = |line: Option<usize>, message: String, remedy: &str| Error::File {
        path: path.to_path_buf(),
        line,
        message,
        remedy: remedy.to_string(),
    };
    let gates: Gates = toml::from_str(text).map_err(|e| {
        let line = e.span().map(|s| text[..s.start.min(text.len())].matches('\n').count() + 1);
        match unknown_word(e.message()) {
            Some((message, remedy)) => refuse(line, message, &remedy),
            None => {
                let remedy = "compare with the thresholds in docs/methodology.md";
                refuse(line, e.message().to_string(), remedy)
            }
        }
    })?;
    if gates.gate.is_empty() && gates.drift.is_none() {
        let remedy = "add [[gate]] tables, as docs/methodology.md describes them";
        return Err(refuse(None, "holds no gate".to_string(), remedy));
    }
    for gate in &gates.gate {
        let problem = match (gate.selected, gate.measure) {
            _ if !gate.limit.is_finite() || gate.limit <= 0.0 => {
                Some(format!("limit = {} is not a positive number", gate.limit))
            }
            (Selected::Whole(_), Some(measure)) => {
                let [measure, name] = [measure.name(), gate.selected.name()];
                Some(format!("measure = {measure:?} means nothing for {name}"))
            }
            (Selected::Error(_), None) => Some("has no measure: max, rms or l1".to_string()),
            _ => (gate.excluded_c.filter(|c| !c.is_finite() || *c < 0.0))
                .map(|c| format!("excluded_c = {c} is no distance, zero or more")),
        };
        if let Some(problem) = problem {
            return Err(refuse(
                None,
                format!("gate {:?}: {problem}", gate.name),
                "correct the gate",
            ));
        }
    }
    let drifts = gates.drift.iter().flat_map(|d| [d.recorded, d.live]);
    if let Some(bad) = drifts.into_iter().find(|d| !d.is_finite() || *d <= 0.0) {
        return Err(refuse(None, format!("drift of {bad} is not a positive number"), "correct it"));
    }
    Ok(gates)
}

/// Whether a list of names selects `name`; a final `*` matches any ending, an empty list anything.
fn selects(list: &[String], name: &str) -> bool {
    list.is_empty()
        || list.iter().any(|l| match l.strip_suffix('*') {
            Some(start) => name.starts_with(start),
            None => l == name,
        })
}

impl Gate {
    /// Whether it selects a number.
    pub fn takes(&self, number: &Number) -> bool {
        let on_curve = match &number.of {
            NumberOf::Curve { body, curve, excluded_c, measure, .. } => {
                self.measure == Some(*measure)
                    && selects(&self.curves, curve)
                    && self.body.as_ref().is_none_or(|own| own == body)
                    && self.excluded_c.is_none_or(|own| own == *excluded_c)
            }
            NumberOf::Whole(_) => true,
        };
        let selected = self.selected.takes(&number.of) && on_curve;
        selected && number.method == self.method && selects(&self.cases, &number.case)
    }

    /// Whether it is a lower limit of the speed.
    pub fn is_speedup(&self) -> bool {
        self.selected == Selected::Whole(Whole::Speedup)
    }

    /// Its outcome for these `numbers`, of which it names no study; it fails if its model could not
    /// solve some cases.
    pub fn evaluate(&self, numbers: &[Number], failed_cases: &[String]) -> GateOutcome {
        let at_least = self.is_speedup();
        let chosen: Vec<&Number> = numbers.iter().filter(|n| self.takes(n)).collect();
        // total_cmp puts a NaN above everything, so it is the worst of errors.
        let worst = if at_least {
            chosen.iter().min_by(|a, b| a.value.total_cmp(&b.value))
        } else {
            chosen.iter().max_by(|a, b| a.value.total_cmp(&b.value))
        };
        let value = worst.map(|w| w.value);
        let margin = value.map(|v| if at_least { v - self.limit } else { self.limit - v });
        let holds = margin.is_some_and(|m| m >= 0.0) && failed_cases.is_empty();
        let note = match worst {
            _ if !failed_cases.is_empty() => {
                format!("{} could not solve {}", self.method, failed_cases.join(", "))
            }
            None => "nothing was compared".to_string(),
            Some(w) => format!("worst at {}", w.place()),
        };
        GateOutcome {
            study: String::new(),
            name: self.name.clone(),
            method: self.method.name().to_string(),
            kind: Kind::Limit,
            passed: holds,
            value,
            limit: self.limit,
            margin,
            compared: chosen.len(),
            note,
        }
    }
}
