//! Accuracy gates: limits for the numbers of a study, and the drift from the numbers that were
//! accepted last.
//!
//! A gate takes the worst of all numbers that it selects. A gate that selects nothing fails: a
//! wrong filter must not look like a pass. Each built-in study has thresholds of its own.

use super::errors::ErrorRow;
use super::response::Response;
use super::run::{Role, StudyRun};
use super::source::Source;
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// The thresholds that are built into the program, by the name of their study; the default one's
/// first.
const BUILTIN_GATES: [(&str, &str); 3] = [
    ("factorial", include_str!("gates/factorial.toml")),
    ("profiled", include_str!("gates/profiled.toml")),
    ("scenes", include_str!("gates/scenes.toml")),
];

/// The accepted numbers that are built into the program.
const DEFAULT_BASELINE: &str = include_str!("../../results/baseline.json");

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

    /// The thresholds that are built into the program for the built-in `study`, and the default
    /// study's for any other.
    ///
    /// # Errors
    /// As [`parse`].
    pub fn built_in_for(study: &str) -> Result<Self> {
        let own = BUILTIN_GATES.iter().find(|(name, _)| *name == study);
        let (name, text) = own.unwrap_or(&BUILTIN_GATES[0]);
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
    pub quantity: String,
    /// `max`, `rms` or `l1`; left out for the last four quantities.
    #[serde(default)]
    pub measure: Option<String>,
    /// Names of cases; a final `*` matches any ending.
    #[serde(default)]
    pub cases: Vec<String>,
    /// Names of curves or pressure lines; a final `*` matches any ending.
    #[serde(default)]
    pub curves: Vec<String>,
    /// `block` or `roller`.
    #[serde(default)]
    pub body: Option<String>,
    /// Only numbers with this excluded distance from the roller's edge (C).
    #[serde(default)]
    pub excluded_c: Option<f64>,
    /// The upper limit (p0; C for a depth), or the lower limit of a speed-up.
    pub limit: f64,
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

/// A number that gates can select.
#[derive(Debug, Clone, PartialEq)]
pub struct Number {
    /// The case.
    pub case: String,
    /// The method.
    pub method: EdgeModel,
    /// `block`, `roller`, `contact`, or empty for a number of the whole case.
    pub body: String,
    /// The curve, or empty.
    pub curve: String,
    /// As in [`Gate::quantity`].
    pub quantity: String,
    /// Excluded distance (C), if there is one.
    pub excluded_c: Option<f64>,
    /// `max`, `rms`, `l1`, or empty.
    pub measure: &'static str,
    /// The value.
    pub value: f64,
}

impl Number {
    /// Its case, curve and quantity in words.
    fn place(&self) -> String {
        let mut text = self.case.clone();
        for part in [&self.body, &self.curve, &self.quantity] {
            if !part.is_empty() {
                text.push_str(", ");
                text.push_str(part);
            }
        }
        text
    }

    /// Its key among the accepted numbers, in a run of `study`.
    fn key(&self, study: &str) -> String {
        let excluded = self.excluded_c.map(|c| format!(" {c}")).unwrap_or_default();
        let (case, method) = (&self.case, self.method);
        let (body, curve) = (&self.body, &self.curve);
        format!("{study} {case} {method} {body} {curve}{excluded}")
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
    }
}

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
    /// Its name after that of its study, if it is one of a study.
    pub fn title(&self) -> String {
        match self.study.as_str() {
            "" => self.name.clone(),
            study => format!("{study}: {}", self.name),
        }
    }
}

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

/// Parses the text of the thresholds file `path`.
///
/// # Errors
/// [`Error::File`] with the line when it is not TOML, or has an unknown key, an unknown name, a
/// limit that is not a positive number, or nothing to be held to.
pub fn parse(text: &str, path: &Path) -> Result<Gates> {
    let refuse = |line: Option<usize>, message: String, remedy: &str| Error::File {
        path: path.to_path_buf(),
        line,
        message,
        remedy: remedy.to_string(),
    };
    let gates: Gates = toml::from_str(text).map_err(|e| {
        let line = e.span().map(|s| text[..s.start.min(text.len())].matches('\n').count() + 1);
        refuse(line, e.message().to_string(), "compare with the thresholds in docs/methodology.md")
    })?;
    if gates.gate.is_empty() && gates.drift.is_none() {
        let remedy = "add [[gate]] tables, as docs/methodology.md describes them";
        return Err(refuse(None, "holds no gate".to_string(), remedy));
    }
    for gate in &gates.gate {
        let whole = ["critical_value", "critical_depth", "load", "speedup"];
        let measured = ["pressure", "stress", "von_mises", "tau_max"];
        let q = gate.quantity.as_str();
        let is_component = crate::base::StressTensor::NAMES.contains(&q);
        let problem = if !gate.limit.is_finite() || gate.limit <= 0.0 {
            Some(format!("limit = {} is not a positive number", gate.limit))
        } else if whole.contains(&q) {
            gate.measure.as_ref().map(|m| format!("measure = {m:?} means nothing for {q}"))
        } else if is_component || measured.contains(&q) {
            match gate.measure.as_deref() {
                Some("max" | "rms" | "l1") => None,
                other => Some(format!("measure = {other:?} is none of max, rms, l1")),
            }
        } else {
            Some(format!("quantity = {q:?} is not known"))
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

/// The numbers of the errors of a model in a case.
pub(super) fn of_errors<'a>(
    case: &str,
    method: EdgeModel,
    rows: impl IntoIterator<Item = &'a ErrorRow>,
) -> Vec<Number> {
    let of_row = |row: &ErrorRow| {
        [("max", row.max), ("rms", row.rms), ("l1", row.l1)].map(|(measure, value)| Number {
            case: case.to_string(),
            method,
            body: row.body.clone(),
            curve: row.curve.clone(),
            quantity: row.quantity.clone(),
            excluded_c: Some(row.excluded_c),
            measure,
            value,
        })
    };
    rows.into_iter().flat_map(of_row).collect()
}

/// All numbers of a run that a gate can look at.
pub fn numbers(run: &StudyRun) -> Vec<Number> {
    let mut all = Vec::new();
    for case in &run.cases {
        for m in &case.methods {
            let (Source::Model(method), Ok(result)) = (&m.source, &m.result) else { continue };
            all.extend(of_errors(&case.case.name, *method, &result.errors));
            let mut whole = |quantity: &str, value: Option<f64>| {
                all.extend(value.map(|value| Number {
                    case: case.case.name.clone(),
                    method: *method,
                    body: String::new(),
                    curve: String::new(),
                    quantity: quantity.to_string(),
                    excluded_c: None,
                    measure: "",
                    value,
                }));
            };
            let response = |response: Response| response.value(case, m);
            whole("critical_value", response(Response::CriticalValue).map(f64::abs));
            whole("critical_depth", response(Response::CriticalDepth).map(f64::abs));
            whole("load", Some(result.solution.summary.load_error_rel));
            whole("speedup", response(Response::Log10Speedup).map(|d| 10f64.powf(d)));
        }
    }
    all
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
    pub(super) fn takes(&self, n: &Number) -> bool {
        let quantity = match self.quantity.as_str() {
            "stress" => n.quantity.starts_with("sigma_"),
            q => n.quantity == q,
        };
        quantity
            && n.method == self.method
            && n.measure == self.measure.as_deref().unwrap_or("")
            && selects(&self.cases, &n.case)
            && selects(&self.curves, &n.curve)
            && self.body.as_ref().is_none_or(|b| *b == n.body)
            && self.excluded_c.is_none_or(|c| n.excluded_c == Some(c))
    }

    pub(super) fn evaluate(&self, numbers: &[Number], failed_cases: &[String]) -> GateOutcome {
        let at_least = self.quantity == "speedup";
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
        for n in numbers(run).iter().filter(|n| matches!(n.measure, "max" | "rms")) {
            // Five digits after the point of an error in p0 are far below any drift limit.
            let value = (n.value * 1e6).round() / 1e6;
            let name = format!("{}_{}", n.quantity, n.measure);
            baseline.numbers.entry(n.key(&run.study)).or_default().insert(name, value);
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
    fn of_model(&self, study: &str, method: EdgeModel) -> Self {
        let numbers = self.numbers.iter().filter(|(place, _)| is_of(place, study, method));
        Self {
            version: self.version.clone(),
            numbers: numbers.map(|(place, values)| (place.clone(), values.clone())).collect(),
        }
    }

    /// Parses the text of the file of accepted numbers `path`.
    ///
    /// # Errors
    /// [`Error::File`] when they are not what [`Baseline::to_json`] writes.
    pub fn parse(text: &str, path: &Path) -> Result<Self> {
        serde_json::from_str(text).map_err(|e| Error::File {
            path: path.to_path_buf(),
            line: Some(e.line()),
            message: e.to_string(),
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

/// Evaluates all gates on a run. `baseline` are the accepted numbers for the drift gates, one for
/// each method; without them (and with a `[drift]` in the file) the drift gates fail.
pub fn evaluate(run: &StudyRun, gates: &Gates, baseline: Option<&Baseline>) -> Vec<GateOutcome> {
    let all = numbers(run);
    let failed = |method: EdgeModel| -> Vec<String> {
        run.cases
            .iter()
            .filter(|c| c.methods.iter().any(|m| m.source == method.into() && m.result.is_err()))
            .map(|c| c.case.name.clone())
            .collect()
    };
    let mut outcomes = vec![coverage(run)];
    outcomes.extend(
        gates
            .gate
            .iter()
            .filter(|g| run.methods.contains(&g.method))
            .map(|g| g.evaluate(&all, &failed(g.method))),
    );
    // The speed of a wrong solution is worth nothing: a speed-up counts only if every accuracy gate
    // of its method holds.
    let inaccurate: Vec<String> =
        outcomes.iter().filter(|o| !o.passed).map(|o| o.method.clone()).collect();
    for (outcome, gate) in outcomes
        .iter_mut()
        .skip(1)
        .zip(gates.gate.iter().filter(|g| run.methods.contains(&g.method)))
    {
        if gate.quantity == "speedup" && inaccurate.contains(&outcome.method) {
            outcome.passed = false;
            outcome.note = "not counted: an accuracy gate of this method failed".to_string();
        }
    }
    if let Some(drift) = &gates.drift {
        let live = run.cases.iter().any(|c| c.reference().is_some_and(|r| r.provenance.live));
        let limit = if live { drift.live } else { drift.recorded };
        let now = Baseline::of(run);
        let accepted = gates.methods();
        let methods = run.methods.iter().filter(|&method| accepted.contains(method));
        outcomes.extend(methods.map(|&method| {
            let of_model = |all: &Baseline| all.of_model(&run.study, method);
            drift_gate(method, limit, &of_model(&now), baseline.map(of_model))
        }));
    }
    if outcomes.len() == 1 {
        outcomes.push(GateOutcome {
            study: String::new(),
            name: "any gate".to_string(),
            method: "all".to_string(),
            kind: Kind::Coverage,
            passed: false,
            value: None,
            limit: 1.0,
            margin: None,
            compared: 0,
            note: "no gate of the thresholds file applies to this run".to_string(),
        });
    }
    for outcome in &mut outcomes {
        outcome.study.clone_from(&run.study);
    }
    outcomes
}

/// Every corner and the centre of the study must have a reference to be compared with; in a study
/// without a design every case.
fn coverage(run: &StudyRun) -> GateOutcome {
    let designed = run.cases.iter().any(|c| c.role != Role::Extra);
    let design: Vec<_> = run.cases.iter().filter(|c| !designed || c.role != Role::Extra).collect();
    let missing: Vec<&str> =
        design.iter().filter(|c| c.reference().is_none()).map(|c| c.case.name.as_str()).collect();
    let compared = run.cases.iter().filter(|c| c.reference().is_some()).count();
    GateOutcome {
        study: String::new(),
        name: "every case of the design has a FEM answer".to_string(),
        method: "all".to_string(),
        kind: Kind::Coverage,
        passed: missing.is_empty() && compared > 0,
        value: Some((design.len() - missing.len()) as f64),
        limit: design.len() as f64,
        margin: Some(-(missing.len() as f64)),
        compared,
        note: if missing.is_empty() {
            format!("{compared} cases compared")
        } else {
            format!("no FEM answer for {}", missing.join(", "))
        },
    }
}

/// The drift of one model's numbers in one study, `now` against those of the `baseline`.
fn drift_gate(
    method: EdgeModel,
    limit: f64,
    now: &Baseline,
    baseline: Option<Baseline>,
) -> GateOutcome {
    let has_baseline = baseline.is_some();
    let accepted = baseline.unwrap_or_default();
    let compared: usize = now.numbers.values().map(BTreeMap::len).sum();
    // Changes beyond the limit, and the largest change.
    let beyond = accepted.changes(now, limit);
    let largest = accepted.changes(now, -1.0).iter().filter_map(Change::size).fold(0.0, f64::max);
    let note = if !has_baseline {
        "there are no accepted numbers: accept them with `edgeline gate --accept`".to_string()
    } else if compared == 0 {
        "nothing was compared".to_string()
    } else {
        match beyond.first() {
            None => "nothing moved".to_string(),
            Some(first) => {
                let more = beyond.len() - 1;
                let rest = if more > 0 { format!(" (and {more} more)") } else { String::new() };
                format!("{}{rest}", first.describe())
            }
        }
    };
    GateOutcome {
        study: String::new(),
        name: "drift from the accepted numbers".to_string(),
        method: method.name().to_string(),
        kind: Kind::Drift,
        passed: compared > 0 && beyond.is_empty(),
        value: Some(largest),
        limit,
        margin: Some(limit - largest),
        compared,
        note,
    }
}

#[cfg(test)]
mod tests;
