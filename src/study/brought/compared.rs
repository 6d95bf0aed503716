//! Brought curves against the models and recorded FEM, and the gates of quarter-space.

use super::between::Between;
use super::file::BroughtFile;
use crate::base::{BodyKind, Result, StressTensor};
use crate::body::EdgeModel;
use crate::case::Case;
use crate::solve::{Options, Scene, SolvedCase};
use crate::stress::{Curves, PressureLine, StressCurve};
use crate::study::errors::{ErrorRow, Range, compare};
use crate::study::gate::{Gate, GateOutcome, Number, of_errors};
use crate::study::run::Reference;
use crate::study::source::{Engine, Source};

/// What limits are widened by where a file states no error of its curves (p0).
pub const UNSTATED_ERROR: f64 = 0.01;

/// The gated model.
const GATED: EdgeModel = EdgeModel::QuarterSpace;

/// A file and what it was compared with.
#[derive(Debug, Clone)]
pub struct FileRun {
    /// The file, its curves with the error that it states.
    pub file: BroughtFile,
    /// The models and recorded FEM on its points.
    pub sources: Vec<(Source, Curves)>,
    /// The errors of all sources against the file's curves.
    pub errors: Vec<ErrorRow>,
    /// Curves all of whose points are left out, by body and name.
    pub left_out: Vec<String>,
    /// The gates.
    pub outcomes: Vec<GateOutcome>,
}

/// Files of curves, compared.
#[derive(Debug, Clone)]
pub struct Comparison {
    /// The case.
    pub case: Case,
    /// The range of the errors.
    pub range: Range,
    /// The models.
    pub methods: Vec<EdgeModel>,
    /// The files.
    pub files: Vec<FileRun>,
}

/// The limits that curves are held to.
pub enum Limits<'a> {
    /// The built-in ones, widened by the error that a file states.
    Widened(&'a [Gate]),
    /// Those of a file, as they are.
    Given(&'a [Gate]),
}

/// A solved model, and the relative error of its load.
struct Model {
    method: EdgeModel,
    solved: SolvedCase,
    load_error_rel: f64,
}

impl Model {
    fn solve(case: &Case, method: EdgeModel) -> Result<Self> {
        let options = Options { bodies: Vec::new(), curves: Vec::new(), ..Options::new(method) };
        let solved = SolvedCase::new(case, &options)?;
        let load_error_rel = solved.solution().summary.load_error_rel;
        Ok(Self { method, solved, load_error_rel })
    }

    /// Its pressures and stresses on the points of `brought`.
    fn on(&self, brought: &Curves) -> Result<Curves> {
        let pressure = brought.pressure.iter().map(|line| PressureLine {
            p: line.at.iter().map(|[x, y]| self.solved.pressure(*x, *y)).collect(),
            own_error: None,
            ..line.clone()
        });
        // All points of a body at once: they share the layers of a column.
        let mut stress = brought.stress.clone();
        for body in BodyKind::ALL {
            let own = |c: &&StressCurve| c.body == body;
            // Files have nine digits, in which an end may lie outside the body.
            let [from, to] = self.solved.case().ends_m(body).map(|y| y / brought.hertz.c_m);
            let inside = |[x, y, z]: [f64; 3]| [x, y.clamp(from, to), z];
            let points: Vec<[f64; 3]> = brought
                .stress
                .iter()
                .filter(own)
                .flat_map(|c| c.at.iter().map(|at| inside(*at)))
                .collect();
            let mut found: Vec<StressTensor> = self.solved.stress(body, &points)?;
            for curve in stress.iter_mut().filter(|c| c.body == body) {
                let rest = found.split_off(curve.at.len());
                (curve.stress, curve.own_error) = (std::mem::replace(&mut found, rest), None);
            }
        }
        Ok(Curves { hertz: brought.hertz, pressure: pressure.collect(), stress })
    }
}

/// Recorded FEM on the curves of a file that lie on the lines of its record.
fn recorded(case: &Case, brought: &Curves, model: &Curves, record: &Record) -> Option<Curves> {
    let scene = Scene::new(case, GATED, None);
    let between = Between {
        fem: &record.fem.curves,
        model: &record.model,
        symmetric: [!scene.slides, scene.is_symmetric()],
    };
    let lines = brought.pressure.iter().zip(&model.pressure);
    let pressure: Vec<_> = lines.filter_map(|(line, own)| between.pressure(line, &own.p)).collect();
    let curves = brought.stress.iter().zip(&model.stress);
    let stress: Vec<_> = curves.filter_map(|(c, own)| between.stress(c, &own.stress)).collect();
    let any = !pressure.is_empty() || !stress.is_empty();
    any.then_some(Curves { hertz: brought.hertz, pressure, stress })
}

/// Recorded FEM, and the gated model on the same points.
struct Record<'a> {
    fem: &'a Reference,
    model: Curves,
}

impl Comparison {
    /// Compares `files` with `methods`, among them quarter-space, and with `fem`, the recorded curves of
    /// the case.
    ///
    /// # Errors
    /// As [`SolvedCase::new`].
    pub fn new(
        case: &Case,
        files: Vec<BroughtFile>,
        fem: Option<&Reference>,
        limits: &Limits,
        range: &Range,
    ) -> Result<Self> {
        let methods = EdgeModel::ALL.to_vec();
        let models: Vec<Model> =
            methods.iter().map(|m| Model::solve(case, *m)).collect::<Result<_>>()?;
        let gated = models.iter().find(|m| m.method == GATED).expect("one of the models");
        let record =
            fem.map(|fem| Result::Ok(Record { fem, model: gated.on(&fem.curves)? })).transpose()?;
        let with = Compared { case, models: &models, record: record.as_ref(), limits, range };
        let mut files: Vec<FileRun> =
            files.into_iter().map(|file| with.file(file)).collect::<Result<_>>()?;
        with.idle_gates(&mut files);
        Ok(Self { case: case.clone(), range: range.clone(), methods, files })
    }

    /// All gates of all files.
    pub fn outcomes(&self) -> Vec<GateOutcome> {
        self.files.iter().flat_map(|f| f.outcomes.iter().cloned()).collect()
    }
}

/// What files are compared with.
struct Compared<'a> {
    case: &'a Case,
    models: &'a [Model],
    record: Option<&'a Record<'a>>,
    limits: &'a Limits<'a>,
    range: &'a Range,
}

impl Compared<'_> {
    fn file(&self, mut file: BroughtFile) -> Result<FileRun> {
        if let Some(error) = file.statements.error_p0 {
            for line in &mut file.curves.pressure {
                line.own_error = Some(vec![error; line.at.len()]);
            }
            for curve in &mut file.curves.stress {
                curve.own_error = Some(vec![[error; 8]; curve.at.len()]);
            }
        }
        let brought = &file.curves;
        let mut sources: Vec<(Source, Curves)> = Vec::new();
        for model in self.models {
            sources.push((model.method.into(), model.on(brought)?));
        }
        let gated = self.models.iter().position(|m| m.method == GATED).expect("one of the models");
        let fem = self.record.and_then(|r| recorded(self.case, brought, &sources[gated].1, r));
        sources.extend(fem.map(|curves| (Source::from(Engine::fenicsx()), curves)));
        let (name, ends) = (&self.case.name, self.case.overlap());
        let mut errors = Vec::new();
        for (source, curves) in &sources {
            errors.extend(compare(name, ends, brought, (source, curves), self.range)?);
        }
        let left_out = left_out(brought, &errors);
        let own: Vec<ErrorRow> =
            errors.iter().filter(|r| r.method == GATED.name()).cloned().collect();
        let outcomes = self.gates(&file, &own, self.models[gated].load_error_rel);
        Ok(FileRun { file, sources, errors, left_out, outcomes })
    }

    /// The gates that a file's curves have numbers for.
    fn gates(&self, file: &BroughtFile, errors: &[ErrorRow], load: f64) -> Vec<GateOutcome> {
        let mut numbers = of_errors(&self.case.name, GATED, errors);
        numbers.push(Number {
            case: self.case.name.clone(),
            method: GATED,
            body: String::new(),
            curve: String::new(),
            quantity: LOAD.to_string(),
            excluded_c: None,
            measure: "",
            value: load,
        });
        let error = file.statements.error_p0.unwrap_or(UNSTATED_ERROR);
        let evaluate = |gate: &Gate| {
            let widened = match self.limits {
                Limits::Widened(_) if gate.quantity != LOAD => gate.limit + error,
                _ => gate.limit,
            };
            let name = format!("{}: {}", file.name, gate.name);
            Gate { name, limit: widened, ..gate.clone() }.evaluate(&numbers, &[])
        };
        let chosen = self.gated().filter(|gate| numbers.iter().any(|n| gate.takes(n)));
        let mut outcomes: Vec<GateOutcome> = chosen.map(evaluate).collect();
        if numbers.len() == 1 {
            // A file none of whose points count must not look like a pass.
            outcomes.push(nothing_compared(&format!("{}: curves", file.name)));
        }
        outcomes
    }

    /// The gates of the gated model that a comparison has numbers for.
    fn gated(&self) -> impl Iterator<Item = &Gate> {
        let (Limits::Widened(gates) | Limits::Given(gates)) = self.limits;
        gates
            .iter()
            .filter(|gate| gate.method == GATED && !ELSEWHERE.contains(&gate.quantity.as_str()))
    }

    /// Given gates that no file has numbers for fail: a wrong filter must not look like a pass.
    fn idle_gates(&self, files: &mut [FileRun]) {
        let Limits::Given(_) = self.limits else { return };
        for gate in self.gated() {
            let ending = format!(": {}", gate.name);
            let met = |f: &FileRun| f.outcomes.iter().any(|o| o.name.ends_with(&ending));
            if !files.iter().any(met)
                && let Some(last) = files.last_mut()
            {
                last.outcomes.push(nothing_compared(&gate.name));
            }
        }
    }
}

/// The gate of the load.
const LOAD: &str = "load";

/// Quantities of gates that a study has and a comparison has not.
const ELSEWHERE: [&str; 3] = ["critical_value", "critical_depth", "speedup"];

fn nothing_compared(name: &str) -> GateOutcome {
    GateOutcome {
        study: String::new(),
        name: name.to_string(),
        method: GATED.name().to_string(),
        kind: crate::study::gate::Kind::Coverage,
        passed: false,
        value: None,
        limit: 0.0,
        margin: None,
        compared: 0,
        note: "nothing was compared: no curve, or all points next to an edge".to_string(),
    }
}

/// Curves that have no error: all their points are next to an edge.
fn left_out(brought: &Curves, errors: &[ErrorRow]) -> Vec<String> {
    let missing =
        |body: &str, curve: &str| !errors.iter().any(|r| r.body == body && r.curve == curve);
    let lines = brought.pressure.iter().map(|line| (crate::study::CONTACT, &line.name));
    let curves = brought.stress.iter().map(|c| (c.body.name(), &c.name));
    let all = lines.chain(curves).filter(|(body, curve)| missing(body, curve));
    all.map(|(body, curve)| format!("{body} {curve}")).collect()
}
