//! What `edgeline study` and `edgeline gate` share: the study, its cases by every model, and FEM.

use super::cold::ColdRuns;
use super::fem_options::{FemOptions, FemSource, OfLive, Size};
use super::output::say;
use super::progress::{progress_bar, show};
use super::published;
use super::records::Records;
use super::values::{MOST_REPEATS, chosen_models, count, source, unsuited};
use crate::base::Result;
use crate::body::EdgeModel;
use crate::case::{BUILTIN_STUDIES, Case, Study, is_given};
use crate::fem::FemResults;
use crate::host::{self, check_memory};
use crate::solve::{Options, solve_group};
use crate::study::bench::Bench;
use crate::study::brought::Beside;
use crate::study::live::Live;
use crate::study::{
    Engine, FoundReference, Models, Range, Reference, Source, StudyRun, StudySetup, reference,
    run as run_study,
};
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// The study, and how it is run.
#[derive(Args)]
pub(super) struct StudyOptions {
    /// A study file, or a built-in study: `factorial`, `profiled` or `scenes`
    #[arg(value_hint = ValueHint::FilePath)]
    pub(super) study: Option<PathBuf>,
    /// Folder for the results; created if it does not exist
    #[arg(long, default_value = "out", value_hint = ValueHint::DirPath)]
    pub(super) out: PathBuf,
    /// Models to run, separated by commas; all by default, or those that a gate is about
    #[arg(long, value_delimiter = ',', value_parser = source())]
    methods: Vec<Source>,
    /// Source of the finite-element curves
    #[arg(long, value_enum, default_value = "recorded")]
    pub(super) fem: FemSource,
    /// Folder of recorded curves, one folder per case, instead of the built-in ones
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    reference: Option<PathBuf>,
    #[command(flatten)]
    range: RangeOptions,
    /// Weight of the images of guilbault, instead of the one that follows from Poisson's ratio
    #[arg(long, value_parser = factor)]
    psi: Option<f64>,
    #[command(flatten)]
    live: OfLive<LiveOptions>,
}

/// How finite elements are run.
#[derive(Args)]
struct LiveOptions {
    /// Finite-element runs of each case with --fem live; the median time is reported
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = count("runs", 1..=MOST_REPEATS))]
    fem_repeats: usize,
    #[command(flatten)]
    size: Size,
    #[command(flatten)]
    options: FemOptions,
}

/// What is left out of errors.
#[derive(Args)]
pub(super) struct RangeOptions {
    /// Distance from the contact's edges, at the ends of the bodies' overlap, within which stresses
    /// are not compared, in half-widths C
    #[arg(long, value_name = "C", default_value_t = 0.1, value_parser = distance)]
    exclude: f64,
    /// The same for pressure: one or more distances, separated by commas; summaries use the first
    #[arg(long, value_name = "C,C", default_value = "0.1,0.2", value_delimiter = ',', value_parser = distance)]
    exclude_pressure: Vec<f64>,
}

impl RangeOptions {
    /// The range of the errors.
    pub(super) fn range(&self) -> Range {
        Range { stress_c: self.exclude, pressure_c: self.exclude_pressure.clone() }
    }
}

/// Memory of the curves of one case by one model or by FEM, with their rows in the tables (bytes).
const CASE_BYTES: f64 = 2e6;

impl StudyOptions {
    /// The study of a file, or a built-in one.
    pub(super) fn find_study(&self) -> Result<Study> {
        self.study.as_deref().map_or_else(|| Ok(Study::built_in()), Study::find)
    }

    /// The name of the built-in study that it is, the default one where none is named; none of a
    /// study in a file.
    pub(super) fn built_in(&self) -> Option<&'static str> {
        let mut names = BUILTIN_STUDIES.iter().map(|(name, _)| *name);
        match &self.study {
            None => names.next(),
            Some(path) if is_given(path) => None,
            Some(path) => names.find(|name| path.as_os_str() == *name),
        }
    }

    /// Whether it is the default study.
    pub(super) fn is_default(&self) -> bool {
        self.built_in() == Some(BUILTIN_STUDIES[0].0)
    }

    /// The range of the errors.
    pub(super) fn range(&self) -> Range {
        self.range.range()
    }

    /// Refuses options that would change nothing: those of live finite elements or of records where
    /// the others run, the method on cells where it does not take part, and a weight of images that
    /// no model has. `usual` and `with_cells` as for [`StudyOptions::run`].
    ///
    /// # Errors
    /// [`crate::base::Error::Value`] that names the option.
    pub(super) fn check(&self, usual: &[EdgeModel], with_cells: bool) -> Result<()> {
        self.live.check(self.fem)?;
        if let (FemSource::Live, Some(folder)) = (self.fem, &self.reference) {
            let reason = "recorded curves have no effect on live finite elements";
            return Err(unsuited(
                ("reference", &folder.display().to_string()),
                reason,
                "leave it out, or leave out --fem live",
            ));
        }
        let on_cells = !self.methods.is_empty() && published::is_chosen(&self.methods);
        if on_cells && !with_cells {
            return Err(unsuited(
                ("methods", Engine::published().name()),
                "the method on cells is in studies alone",
                "leave it out; `edgeline study` has its errors",
            ));
        }
        let has_images = self.methods_of(usual).contains(&EdgeModel::Guilbault)
            || with_cells && published::is_chosen(&self.methods);
        if let Some(psi) = self.psi.filter(|_| !has_images) {
            let reason = "only guilbault has images with such a weight";
            return Err(unsuited(
                ("psi", &psi.to_string()),
                reason,
                "leave it out, or add guilbault to --methods",
            ));
        }
        Ok(())
    }

    /// The chosen models, the `usual` ones if none was chosen.
    fn methods_of(&self, usual: &[EdgeModel]) -> Vec<EdgeModel> {
        match self.methods.is_empty() {
            true => usual.to_vec(),
            false => chosen_models(&self.methods),
        }
    }

    /// The models of a case, solved to be evaluated at the points of files.
    ///
    /// # Errors
    /// As [`Beside::new`].
    pub(super) fn beside(&self, case: &Case) -> Result<Beside> {
        Beside::new(case, &chosen_models(&self.methods), self.psi, &self.range())
    }

    /// Runs `study` by the chosen models, by the `usual` ones if none was chosen, with live FEM in
    /// folders below the one for the results.
    ///
    /// `with_cells` tells whether the published method on cells may take part.
    pub(super) fn run(
        &self,
        study: &Study,
        usual: &[EdgeModel],
        repeats: usize,
        with_cells: bool,
    ) -> Result<StudyRun> {
        let methods = self.methods_of(usual);
        let (cases, models) = (study.cases().count(), methods.len());
        check_memory(
            &format!("a study of {cases} cases by {models} models"),
            CASE_BYTES * (cases * (models + 1)) as f64,
            "give fewer cases or models, or use a sweep",
        )?;
        let references = self.references()?;
        let engine = match self.fem {
            FemSource::Live => Engine::of(self.live.options.options.engine()),
            FemSource::Recorded => Engine::fenicsx(),
        };
        let cold = ColdRuns::new(&self.out);
        let with_cells = with_cells && published::is_chosen(&self.methods);
        let on_cells = |case: &Case, counts| published::solve(case, counts, self.psi);
        let bar = progress_bar();
        let run = run_study(
            study,
            &StudySetup {
                models: Models {
                    methods,
                    repeats,
                    solver: &|cases, method| {
                        solve_group(cases, &Options { psi: self.psi, ..Options::new(method) })
                    },
                    cold: &|case, method, threads| cold.seconds(case, method, threads),
                    published: with_cells.then_some(&on_cells),
                },
                range: self.range(),
                references: &|case| {
                    let say = |text: &str| bar.set_message(format!("{}: {text}", case.name));
                    let mut all = vec![(engine.clone(), references.of(case, &say))];
                    all.extend(references.further(case));
                    all
                },
                progress: &|done, all, what| show(&bar, done, all, what),
            },
        );
        bar.finish_and_clear();
        // An interrupted run is not a study, although every case has a row.
        host::check_interrupt()?;
        for case in &run.cases {
            for m in &case.methods {
                if let Err(message) = &m.result {
                    say(&format!("warning: {} by {}: {message}", case.case.name, m.source));
                }
            }
        }
        Ok(run)
    }

    /// Source of the FEM curves.
    fn references(&self) -> Result<FemCurves> {
        Ok(match self.fem {
            FemSource::Live => {
                let LiveOptions { fem_repeats, size, options } = &self.live.options;
                FemCurves::Live {
                    live: Live::new(options.settings(size.size), *fem_repeats)?,
                    folder: self.out.join("fem"),
                }
            }
            FemSource::Recorded => FemCurves::Recorded {
                records: Records::read(self.reference.as_deref())?,
                times: Bench::recorded()?,
            },
        })
    }
}

/// The FEM curves of a study's cases.
enum FemCurves {
    /// Computed now, each in a subfolder of this folder.
    Live { live: Live, folder: PathBuf },
    /// Recorded, with times of one run if there are any.
    Recorded { records: Records, times: Bench },
}

impl FemCurves {
    /// The curves of `case`, or why there are none. Calls `progress` with the current step.
    fn of(&self, case: &Case, progress: &dyn Fn(&str)) -> std::result::Result<Reference, String> {
        match self {
            FemCurves::Live { live, folder } => {
                live.run(case, &folder.join(&case.name), progress).map_err(|e| e.to_string())
            }
            FemCurves::Recorded { records, times } => {
                let found = records.find(case).map_err(|e| e.to_string())?;
                let record = found.ok_or_else(|| "there is no record of it".to_string())?;
                let mut reference = reference::from_fem(&record);
                reference.provenance.timed = times.timed(case);
                Ok(reference)
            }
        }
    }

    /// The recorded curves of further codes, where there are any.
    fn further(&self, case: &Case) -> Vec<FoundReference> {
        let FemCurves::Recorded { records, .. } = self else { return Vec::new() };
        let of_record = |(engine, record): (Engine, Result<FemResults>)| {
            (engine, record.map(|r| reference::from_fem(&r)).map_err(|e| e.to_string()))
        };
        records.further(case).into_iter().map(of_record).collect()
    }
}

/// Parses the weight of the images.
fn factor(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=2.0).contains(&value) => Ok(value),
        _ => Err("give a factor between 0 and 2".into()),
    }
}

/// Parses a distance in units of C.
fn distance(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=10.0).contains(&value) => Ok(value),
        _ => Err("give a distance between 0 and 10 C".into()),
    }
}
