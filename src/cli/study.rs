//! `edgeline study`: every case by every model, compared with FEM.

use super::brought::{Brought, CurvesOf, curves_of};
use super::fem_options::FemSource;
use super::output::{Exit, print, print_json, say};
use super::provenance::{command_line, now, processor};
use super::study_options::StudyOptions;
use super::values::{MOST_REPEATS, count};
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::{Case, Study, builtin_case};
use crate::fem::FemResults;
use crate::host::{Lock, check_not_given};
use crate::report::page;
use crate::report::study_files::StudyFiles;
use crate::report::study_summary::FemOrigin;
use crate::report::summarise::Context;
use crate::solve::{Options, solve};
use crate::stress::Curves;
use crate::study::bench::{Bench, Machine, Speedup};
use crate::study::brought::FileRun;
use crate::study::gate::{self, Baseline, Gates};
use crate::study::reference::from_fem;
use crate::study::verification::{self, VerificationRow};
use crate::study::{CaseRun, Engine, Range, StudyRun};
use clap::{Args, ValueHint};
use rayon::prelude::*;
use std::path::Path;
use std::time::Instant;

/// Runs a study, `factorial` by default: every case by every model, compared with finite elements.
///
/// Writes study.csv (one row per case and source), curves.csv, pressure.csv, fem_error.csv,
/// errors.csv (one row per case, model, curve and quantity), effects.csv, verification.csv,
/// summary.json, plots/*.svg, report.html and report.md into the output folder; with --curves also
/// brought.csv, brought_curves.csv and brought_pressure.csv (docs/compare.md). With recorded
/// finite-element curves it takes about a minute, nearly all of it for timing and for the published
/// method on cells (half as long with --repeats 0); with --fem live it takes minutes per case.
/// `edgeline study profiled` runs five factors in 16 runs and a centre point, `edgeline study
/// scenes` fourteen cases that slide, that have profiles, eccentric loads and offsets, or other
/// materials; they take several times as long.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    study: StudyOptions,
    /// Curves of a case from elsewhere (CSV as for `edgeline compare`), beside its references; may
    /// be repeated
    #[arg(long, value_name = "CASE=FILE", value_parser = curves_of, value_hint = ValueHint::FilePath)]
    curves: Vec<CurvesOf>,
    /// Warm repetitions of each timing of a model; 0 for no timing
    #[arg(long, default_value_t = 7, value_name = "N", value_parser = count("repetitions", 0..=MOST_REPEATS))]
    repeats: usize,
    /// Print the summary as one JSON object and nothing else
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: Arguments) -> Result<Exit> {
    let began = Instant::now();
    let date = now();
    arguments.study.check(&EdgeModel::ALL, true)?;
    let study = arguments.study.find_study()?;
    let brought = Brought::read(&arguments.curves, &study, &arguments.study)?;
    let out = &arguments.study.out;
    check_not_given(out, StudyFiles::names().chain(page::NAMES))?;
    let _lock = Lock::claim(out)?;
    let run = arguments.study.run(&study, &EdgeModel::ALL, arguments.repeats, true)?;
    if run.cases.iter().flat_map(|c| &c.methods).all(|m| m.result.is_err()) {
        return Err(first_failure(&run));
    }
    let outcomes = gates(&arguments.study, &run)?;
    let [speedups, published] = speedups(&arguments.study, &study)?;
    let brought: Vec<Vec<FileRun>> =
        brought.into_iter().map(|of_case| of_case.compared(&run)).collect::<Result<_>>()?;
    let brought = brought.concat();
    let verification = verification(&arguments.study, &run, &brought)?;
    let files = StudyFiles::of(
        &run,
        &Context {
            date: &date,
            command: &command_line(),
            fem: match arguments.study.fem {
                FemSource::Recorded => FemOrigin::Recorded,
                FemSource::Live => FemOrigin::Live,
            },
            machine: Machine { processor: processor(), threads: rayon::current_num_threads() },
            seconds: began.elapsed().as_secs_f64(),
            gates: &outcomes,
            speedups: &speedups,
            published_speedups: &published,
            verification: &verification,
            brought: &brought,
        },
    );
    page::write_run(&files, out)?;
    if arguments.json {
        print_json(&files.summary)?;
    } else {
        print(&text(&files, out))?;
    }
    Ok(Exit::Done)
}

/// The outcomes of the gates of a built-in study.
fn gates(options: &StudyOptions, run: &StudyRun) -> Result<Vec<gate::GateOutcome>> {
    let Some(study) = options.built_in() else { return Ok(Vec::new()) };
    let gates = Gates::built_in_for(study)?;
    let usual = options.range() == Range::default();
    let drift = if usual { gates.drift } else { None };
    Ok(gate::evaluate(run, &Gates { drift, ..gates }, Some(&Baseline::built_in()?)))
}

/// Cases on record to which nothing was ever tuned.
const HELD_BACK: [&str; 3] = ["validation-nu025", "validation-nu040", "validation-steel-aluminium"];

/// The differences of quarter-space beside the numerical uncertainty of both sides: for the cases
/// of the run, and in the built-in study for those held back.
fn verification(
    options: &StudyOptions,
    run: &StudyRun,
    brought: &[FileRun],
) -> Result<Vec<VerificationRow>> {
    let model = EdgeModel::QuarterSpace;
    // Without it nothing is said of the differences; the run is complete all the same.
    let refined = |case: &Case| -> Option<Curves> {
        let tighter = case.clone().with_tolerance(verification::refined_tolerance(case)?);
        match solve(&tighter, &Options::new(model)) {
            Ok(solution) => Some(solution.curves),
            Err(e) => {
                say(&format!("note: {}, refined: {e}", case.name));
                None
            }
        }
    };
    let of_case = |case: &CaseRun| -> Vec<VerificationRow> {
        let found = case.references.iter();
        let references: Vec<_> =
            found.filter_map(|r| Some((r.engine.clone(), r.result.as_ref().ok()?))).collect();
        let own = case.methods.iter().find(|m| m.source == model.into());
        let mut rows = Vec::new();
        if let (Some(Ok(own)), false) = (own.map(|m| &m.result), references.is_empty()) {
            let refined = refined(&case.case);
            let curves = (model.into(), &own.solution.curves, refined.as_ref());
            rows = verification::rows(&case.case, false, curves, &references);
        }
        let files = brought.iter().filter(|file| file.case == case.case.name);
        rows.extend(files.flat_map(|file| verification::of_file(file, case.case.overlap())));
        rows
    };
    // A refined solution takes several times as long as those of the run.
    let mut all = run.cases.par_iter().map(of_case).collect::<Vec<_>>().concat();
    let built_in = options.is_default() && options.fem == FemSource::Recorded;
    if !built_in || !all.iter().any(|row| row.source == model.into()) {
        return Ok(all);
    }
    let held_back = |name: &&str| -> Result<Vec<VerificationRow>> {
        let case = builtin_case(name).expect("it is built in")?;
        let Some(record) = FemResults::embedded_of(&case)? else { return Ok(Vec::new()) };
        let (reference, own) = (from_fem(&record), solve(&case, &Options::new(model))?);
        let refined = refined(&case);
        let curves = (model.into(), &own.curves, refined.as_ref());
        let references = [(Engine::fenicsx(), &reference)];
        Ok(verification::rows(&case, true, curves, &references))
    };
    all.extend(HELD_BACK.par_iter().map(held_back).collect::<Result<Vec<_>>>()?.concat());
    Ok(all)
}

/// Ratios of the FEM time to the model's time and to the published method's, if a record has them
/// from one run.
fn speedups(options: &StudyOptions, study: &Study) -> Result<[Vec<Speedup>; 2]> {
    match options.fem {
        FemSource::Recorded => {
            let times = Bench::recorded()?;
            let all = |of: &[Speedup]| {
                study.cases().flat_map(|case| times.speedups_of(case, of)).collect::<Vec<_>>()
            };
            Ok([all(&times.speedups), all(&times.published)])
        }
        FemSource::Live => Ok(Default::default()),
    }
}

/// The short summary for a reader.
fn text(files: &StudyFiles, out: &Path) -> String {
    let mut text = String::new();
    for line in &files.summary.verdict {
        text.push_str(line);
        text.push('\n');
    }
    for line in &files.summary.not_done {
        text.push_str("note: ");
        text.push_str(line);
        text.push('\n');
    }
    text + &format!("wrote report.html, report.md, tables and plots into {}\n", out.display())
}

/// The reason why no case could be solved.
fn first_failure(run: &StudyRun) -> Error {
    let first = run.cases.iter().flat_map(|c| &c.methods).find_map(|m| m.result.as_ref().err());
    Error::Value {
        key: "study".to_string(),
        value: run.study.clone(),
        reason: first.map_or_else(|| "it has no cases".to_string(), Clone::clone),
        remedy: "no case could be solved; try one of them with `edgeline solve`".to_string(),
    }
}
