//! What brought curves are compared with: the models at their points, and recorded FEM where its
//! lines pass.

use super::between::Between;
use super::file::BroughtFile;
use crate::base::{BodyKind, Result, StressTensor, gauss_legendre};
use crate::body::EdgeModel;
use crate::case::Case;
use crate::solve::{Options, Scene, SolvedCase};
use crate::stress::{Curves, PressureLine, StressCurve};
use crate::study::errors::{ErrorRow, Range, compare};
use crate::study::run::Reference;
use crate::study::source::{Engine, Source};

/// Nodes of a mean over a cell. In the cell at the contact's edge the pressure ends like a square
/// root.
const MEAN_NODES: usize = 48;

/// The model whose difference to FEM is interpolated, and that comparisons hold to limits.
pub const GATED: EdgeModel = EdgeModel::QuarterSpace;

/// A model or recorded FEM on the points of a file.
#[derive(Debug, Clone)]
pub struct OnPoints {
    /// The model or code.
    pub source: Source,
    /// Its values at the points.
    pub curves: Curves,
    /// Relative sizes of its meshes, finest first; empty for a model.
    pub sizes: Vec<f64>,
    /// What shows how uncertain it is, at the same points: its coarser meshes, finest first; of a
    /// model its solution at a tighter tolerance, where there is one.
    pub others: Vec<Curves>,
}

/// A file and what it was compared with.
#[derive(Debug, Clone)]
pub struct FileRun {
    /// The name of the case.
    pub case: String,
    /// The file, its curves with the error that it states.
    pub file: BroughtFile,
    /// The models and recorded FEM on its points.
    pub sources: Vec<OnPoints>,
    /// The errors of all sources against the file's curves.
    pub errors: Vec<ErrorRow>,
    /// Curves all of whose points are left out, by body and name.
    pub left_out: Vec<String>,
}

impl FileRun {
    /// The file's own curves and those of all sources on its points.
    pub fn all(&self) -> impl Iterator<Item = (Source, &Curves)> {
        let own = (Engine::brought(&self.file.name).into(), &self.file.curves);
        std::iter::once(own).chain(self.sources.iter().map(|s| (s.source.clone(), &s.curves)))
    }
}

/// A solved model.
struct Model {
    method: EdgeModel,
    solved: SolvedCase,
}

impl Model {
    fn solve(case: &Case, method: EdgeModel, psi: Option<f64>) -> Result<Self> {
        let none = Options { bodies: Vec::new(), curves: Vec::new(), ..Options::new(method) };
        Ok(Self { method, solved: SolvedCase::new(case, &Options { psi, ..none })? })
    }

    /// Its pressures and stresses on the points of `brought`; with `widths`, pressures are means
    /// over them, see [`BroughtFile::widths`].
    fn on(&self, brought: &Curves, widths: &[Vec<f64>]) -> Result<Curves> {
        let (nodes, weights) = gauss_legendre(MEAN_NODES);
        let mean = |[x, y]: [f64; 2], width: f64| -> f64 {
            let parts = nodes.iter().zip(&weights);
            parts.map(|(t, w)| 0.5 * w * self.solved.pressure(x + 0.5 * width * t, y)).sum()
        };
        let pressure = brought.pressure.iter().enumerate().map(|(i, line)| {
            let width = |j: usize| widths.get(i).map_or(0.0, |own| own[j]);
            let at = line.at.iter().enumerate().map(|(j, at)| (*at, width(j)));
            let p = at.map(|(at, width)| match width > 0.0 {
                true => mean(at, width),
                false => self.solved.pressure(at[0], at[1]),
            });
            PressureLine { p: p.collect(), own_error: None, ..line.clone() }
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

/// The solved models of a case, to be evaluated at the points of files.
pub struct Beside {
    case: Case,
    range: Range,
    /// The models that are compared.
    methods: Vec<EdgeModel>,
    /// These, and the gated one in any case.
    models: Vec<Model>,
    /// The gated one at a tighter tolerance.
    refined: Option<Model>,
}

impl Beside {
    /// Solves `case` by `methods`, `psi` being the weight of guilbault's images, see
    /// [`Options::psi`].
    ///
    /// # Errors
    /// As [`SolvedCase::new`].
    pub fn new(
        case: &Case,
        methods: &[EdgeModel],
        psi: Option<f64>,
        range: &Range,
    ) -> Result<Self> {
        let wanted = |m: &EdgeModel| *m == GATED || methods.contains(m);
        let models = EdgeModel::ALL.into_iter().filter(wanted);
        Ok(Self {
            models: models.map(|m| Model::solve(case, m, psi)).collect::<Result<_>>()?,
            case: case.clone(),
            range: range.clone(),
            methods: methods.to_vec(),
            refined: None,
        })
    }

    /// Solves the gated model again at `tolerance`, which shows how uncertain it is.
    ///
    /// # Errors
    /// As [`SolvedCase::new`].
    pub fn with_refined(mut self, tolerance: f64) -> Result<Self> {
        let case = self.case.clone().with_tolerance(tolerance);
        self.refined = Some(Model::solve(&case, GATED, None)?);
        Ok(self)
    }

    fn gated(&self) -> &Model {
        self.models.iter().find(|m| m.method == GATED).expect("it is always solved")
    }

    /// The relative error of the gated model's load.
    pub fn load_error_rel(&self) -> f64 {
        self.gated().solved.solution().summary.load_error_rel
    }

    /// Compares the models and `references`, the curves of codes for the case, with those of
    /// `file`.
    ///
    /// # Errors
    /// As [`SolvedCase::stress`].
    pub fn file(
        &self,
        mut file: BroughtFile,
        references: &[(Engine, &Reference)],
    ) -> Result<FileRun> {
        if let Some(error) = file.statements.error_p0 {
            file.curves.state_error(error);
        }
        let brought = &file.curves;
        let mut sources = Vec::new();
        for model in self.models.iter().filter(|m| self.methods.contains(&m.method)) {
            let refined = self.refined.iter().filter(|r| r.method == model.method);
            sources.push(OnPoints {
                source: model.method.into(),
                curves: model.on(brought, &file.widths)?,
                sizes: Vec::new(),
                others: refined.map(|r| r.on(brought, &file.widths)).collect::<Result<_>>()?,
            });
        }
        if !references.is_empty() {
            let own = self.gated().on(brought, &file.widths)?;
            for (engine, reference) in references {
                sources.extend(self.recorded(brought, &own, engine, reference)?);
            }
        }
        let (name, ends) = (&self.case.name, self.case.overlap());
        let mut errors = Vec::new();
        for on in &sources {
            errors.extend(compare(name, ends, brought, (&on.source, &on.curves), &self.range)?);
        }
        let left_out = left_out(brought, &errors);
        Ok(FileRun { case: name.clone(), file, sources, errors, left_out })
    }

    /// The meshes of a code on the curves of a file that lie on the lines of its record; the gated
    /// model has `own` there.
    fn recorded(
        &self,
        brought: &Curves,
        own: &Curves,
        engine: &Engine,
        reference: &Reference,
    ) -> Result<Option<OnPoints>> {
        let scene = Scene::new(&self.case, GATED, None);
        let on_record = self.gated().on(&reference.curves, &[])?;
        let mesh = |fem: &Curves| {
            let symmetric = [!scene.slides, scene.is_symmetric()];
            let between = Between { fem, model: &on_record, symmetric };
            let lines = brought.pressure.iter().zip(&own.pressure);
            let pressure: Vec<_> =
                lines.filter_map(|(line, own)| between.pressure(line, &own.p)).collect();
            let curves = brought.stress.iter().zip(&own.stress);
            let stress: Vec<_> =
                curves.filter_map(|(c, own)| between.stress(c, &own.stress)).collect();
            let any = !pressure.is_empty() || !stress.is_empty();
            any.then_some(Curves { hertz: brought.hertz, pressure, stress })
        };
        let coarser = || reference.coarser.iter();
        let sizes = reference.size.into_iter().chain(coarser().map(|(size, _)| *size)).collect();
        let others = coarser().map_while(|(_, curves)| mesh(curves)).collect();
        let source = engine.clone().into();
        Ok(mesh(&reference.curves).map(|curves| OnPoints { source, curves, sizes, others }))
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
