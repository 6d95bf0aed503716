//! `edgeline bench`: run time against error.

use super::cold::ColdRuns;
use super::fem_options::{FemOptions, FemSource, OfLive};
use super::output::{Exit, print, say};
use super::progress::{progress_bar, show};
use super::provenance::{command_line, now, processor};
use super::published;
use super::records::Records;
use super::values::{MOST_REPEATS, chosen_models, count, source, tolerance_of};
use crate::base::number::{duration, duration_with_spread, ratio_with_spread};
use crate::base::{Error, Result};
use crate::case::{Case, Study, find_case, is_given};
use crate::fem::{Code, Driver};
use crate::host::{self, Lock, read_text};
use crate::report::bench as files;
use crate::solve::{Options, solve_group};
use crate::study::bench::{
    self, Against, BEST, Bench, BenchSetup, CaseBench, CodeTime, CodeTimes, FemMeshes, Machine,
    MeshOf, Origin, Speedup,
};
use crate::study::{Models, Source};
use clap::{Args, ValueHint};
use std::path::{Path, PathBuf};

/// Measures run time against error: every model at several tolerances, and FEM on several meshes.
///
/// Writes pareto.csv (one row per case and tolerance or mesh), pareto.svg (run time against error,
/// both sides) and bench.json into the output folder. Errors are taken against FEM's finest mesh
/// and against quarter-space at the tightest tolerance. Only with --fem live are times of FEM and
/// the models divided; recorded ones are shown apart. A mesh that is done in the folder already is
/// not run again: give a new folder to time both sides anew. With meshes by several codes the
/// fastest within an error, of whichever code, is what quarter-space is compared with. Takes a few
/// minutes for the four default cases; with --fem live some minutes more a case, for the meshes.
#[derive(Args)]
pub(super) struct Arguments {
    /// Case or study files, built-in cases, cases of the built-in studies, or the studies by their
    /// names for all of one; the four corners of `factorial` of the lower load by default
    #[arg(value_hint = ValueHint::FilePath, value_name = "CASE")]
    cases: Vec<PathBuf>,
    /// Folder for the results; created if it does not exist
    #[arg(long, default_value = "out", value_hint = ValueHint::DirPath)]
    out: PathBuf,
    /// Models to run, separated by commas; all by default
    #[arg(long, value_delimiter = ',', value_parser = source())]
    methods: Vec<Source>,
    /// Tolerances of the models as fractions of p0; at the tightest quarter-space is the limit that
    /// errors are taken against beside FEM's finest mesh
    #[arg(
        long,
        value_delimiter = ',',
        value_name = "T,T",
        default_value = "1e-1,3e-2,1e-2,5e-3,1e-3,1e-4"
    )]
    tolerances: Vec<f64>,
    /// Errors (fractions of p0) at which the times of FEM and quarter-space are compared
    #[arg(long, value_delimiter = ',', value_name = "E,E", default_value = "0.02,0.01,0.005", value_parser = level)]
    levels: Vec<f64>,
    /// Repetitions of each timing of a model
    #[arg(long, default_value_t = 9, value_name = "N", value_parser = count("repetitions", 1..=MOST_REPEATS))]
    repeats: usize,
    /// Source of the finite-element times; the finest mesh is the reference
    #[arg(long, value_enum, default_value = "recorded")]
    fem: FemSource,
    /// Folder of recorded curves, one folder per case, instead of the built-in ones
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    reference: Option<PathBuf>,
    #[command(flatten)]
    live: OfLive<LiveOptions>,
    /// Print bench.json and nothing else
    #[arg(long)]
    json: bool,
}

/// How finite elements are run.
#[derive(Args)]
struct LiveOptions {
    /// Relative element sizes of the meshes with --fem live; ENGINE=S for one by another code than
    /// --engine, as in 2,1.4,calculix=2
    #[arg(
        long,
        value_delimiter = ',',
        value_name = "S,S",
        default_value = "2,1.4",
        value_parser = mesh_of
    )]
    sizes: Vec<(Option<Code>, f64)>,
    /// Runs of each mesh with --fem live
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = count("runs", 1..=MOST_REPEATS))]
    fem_repeats: usize,
    #[command(flatten)]
    options: FemOptions,
}

/// Parses the size of a mesh, with its code in front or not.
fn mesh_of(text: &str) -> std::result::Result<(Option<Code>, f64), String> {
    let (code, size) = match text.split_once('=') {
        None => (None, text),
        Some((name, size)) => match Code::ALL.into_iter().find(|code| code.name() == name) {
            Some(code) => (Some(code), size),
            None => {
                let names = Code::ALL.map(Code::name).join(", ");
                return Err(format!("there is no code {name}; there are {names}"));
            }
        },
    };
    size.parse().map(|size| (code, size)).map_err(|_| "give sizes, as in 2,1.4,calculix=2".into())
}

/// Parses an error level.
fn level(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value <= 1.0 => Ok(value),
        _ => Err("give a fraction of p0, more than 0 and at most 1".into()),
    }
}

/// Whether a file with this text is meant as a study.
fn is_study(text: &str) -> bool {
    text.lines().any(|line| line.starts_with("[factors") || line.starts_with("cases"))
}

/// The cases of the arguments, each once.
fn find_cases(named: &[PathBuf]) -> Result<Vec<Case>> {
    let built_in: Vec<Study> = Study::all_built_in().collect();
    let mut all: Vec<Case> = Vec::new();
    for path in named {
        let is = |name: &str| path.as_os_str() == name && !is_given(path);
        let found: Vec<Case> = if let Some(study) = built_in.iter().find(|s| is(&s.name)) {
            study.cases().cloned().collect()
        } else if read_text(path, Case::MAX_BYTES, "").is_ok_and(|text| is_study(&text)) {
            Study::read(path)?.cases().cloned().collect()
        } else {
            let case = find_case(path)?;
            let checked = case.check_force("every model would find another force");
            let smooth = "the models of a bench are those of smooth bodies";
            checked.and_then(|()| case.check_smooth(smooth)).map_err(|e| Case::place(path, e))?;
            vec![case]
        };
        all.extend(found);
    }
    if named.is_empty() {
        let corners = &built_in[0].corners;
        let low = corners.iter().map(|c| c.factors().load).fold(f64::INFINITY, f64::min);
        let light = |c: &&Case| c.factors().load < 1.01 * low;
        all.extend(corners.iter().filter(light).cloned());
    }
    for i in 1..all.len() {
        if all[..i].iter().any(|c| c.name == all[i].name) {
            return Err(Error::Value {
                key: "cases".into(),
                value: all[i].name.clone(),
                reason: "it is given twice".into(),
                remedy: "name each case once".into(),
            });
        }
    }
    Ok(all)
}

/// The distinct numbers, the largest first.
fn descending(values: &[f64]) -> Vec<f64> {
    let mut all = values.to_vec();
    all.sort_by(|a, b| b.total_cmp(a));
    all.dedup();
    all
}

pub(super) fn run(arguments: Arguments) -> Result<Exit> {
    let date = now();
    arguments.live.check(arguments.fem)?;
    let cases = find_cases(&arguments.cases)?;
    let tolerances: Vec<f64> = descending(&arguments.tolerances)
        .into_iter()
        .map(|tolerance| tolerance_of("--tolerances", tolerance))
        .collect::<Result<_>>()?;
    let records = Records::read(arguments.reference.as_deref())?;
    let _lock = Lock::claim(&arguments.out)?;
    let drivers = drivers(&arguments)?;
    // A damaged record is reported before the long run.
    cases.iter().try_for_each(|case| records.find(case).map(|_| ()))?;
    let benches = measure(&arguments, &cases, &tolerances, &records, &drivers);
    host::check_interrupt()?;
    report_failures(&benches)?;
    let bench = Bench::new(
        date,
        command_line(),
        Machine { processor: processor(), threads: rayon::current_num_threads() },
        tolerances.last().copied().unwrap_or(f64::NAN),
        descending(&arguments.levels),
        benches,
    );
    files::write(&bench, &arguments.out)?;
    if arguments.json {
        print(&files::json(&bench))?;
    } else {
        print(&text(&bench, &arguments.out))?;
    }
    Ok(Exit::Done)
}

/// Live FEM on each mesh, the coarsest of each code first.
fn drivers(arguments: &Arguments) -> Result<Vec<(MeshOf, Driver)>> {
    if arguments.fem == FemSource::Recorded {
        return Ok(Vec::new());
    }
    let LiveOptions { sizes, options, .. } = &arguments.live.options;
    let sizes = |code: Code| {
        let own = sizes.iter().filter(|(of, _)| of.unwrap_or(options.engine()) == code);
        descending(&own.map(|(_, size)| *size).collect::<Vec<_>>())
    };
    let meshes = Code::ALL
        .into_iter()
        .flat_map(|code| sizes(code).into_iter().map(move |size| MeshOf { code, size }));
    meshes.map(|of| Ok((of, Driver::new(options.settings_of(of.code, of.size))?))).collect()
}

/// Runs the cases by models and FEM.
fn measure(
    arguments: &Arguments,
    cases: &[Case],
    tolerances: &[f64],
    records: &Records,
    drivers: &[(MeshOf, Driver)],
) -> Vec<CaseBench> {
    let bar = progress_bar();
    let cold = ColdRuns::new(&arguments.out);
    let on_cells = |case: &Case, counts| published::solve(case, counts, None);
    let benches = bench::run(
        cases,
        &BenchSetup {
            models: Models {
                methods: chosen_models(&arguments.methods),
                repeats: arguments.repeats,
                solver: &|cases, method| solve_group(cases, &Options::new(method)),
                cold: &|case, method, threads| cold.seconds(case, method, threads),
                published: published::is_chosen(&arguments.methods).then_some(&on_cells),
            },
            tolerances: tolerances.to_vec(),
            fem: &|case| {
                let recorded = records.find(case).unwrap_or_default();
                let folder = arguments.out.join("fem").join(&case.name);
                let say = |text: &str| bar.set_message(format!("{}: {text}", case.name));
                FemMeshes::run(
                    recorded,
                    drivers,
                    arguments.live.options.fem_repeats,
                    case,
                    &folder,
                    &say,
                )
            },
            progress: &|done, all, what| show(&bar, done, all, what),
        },
    );
    bar.finish_and_clear();
    benches
}

/// Warns of missing results.
///
/// # Errors
/// [`Error::Value`] when no model has a result.
fn report_failures(benches: &[CaseBench]) -> Result<()> {
    let points = || benches.iter().flat_map(|c| c.points.iter().map(move |p| (c, p)));
    for (case, point) in points() {
        if let Some(message) = &point.err {
            let name = &case.case.name;
            say(&format!("warning: {name} by {} at {}: {message}", point.source, point.setting));
        }
    }
    let failed = points().filter(|(_, p)| p.origin == Origin::Model).all(|(_, p)| p.err.is_some());
    match points().next().filter(|_| failed) {
        Some((_, first)) => Err(Error::Value {
            key: "bench".into(),
            value: format!("{} cases", benches.len()),
            reason: first.err.clone().unwrap_or_default(),
            remedy: "no case could be solved; try one of them with `edgeline solve`".into(),
        }),
        None => Ok(()),
    }
}

/// The short summary for a reader.
fn text(bench: &Bench, out: &Path) -> String {
    let mut lines = Vec::new();
    for &level in &bench.levels {
        for (against, whose) in [
            (Against::Limit, "each against its own limit"),
            (Against::Fem, "both against FEM's finest mesh"),
        ] {
            let here: Vec<&Speedup> = bench
                .speedups
                .iter()
                .filter(|s| s.level == level && s.against == against)
                .collect();
            lines.extend(at_level(&here, level, whose, bench.cases.len()));
        }
    }
    let slowest_first = |a: &&Speedup, b: &&Speedup| a.ratio.value.total_cmp(&b.ratio.value);
    lines.extend(bench.published.iter().min_by(slowest_first).map(|s| {
        format!(
            "at the error that it reaches, {:.3} p0 and more, the published method on cells is at least {} times \
             faster than FEM, in {} of {} cases",
            bench.published.iter().map(|s| s.model_error).fold(f64::INFINITY, f64::min),
            ratio_with_spread(s.ratio.value, s.ratio.plus_minus),
            bench.published.len(),
            bench.cases.len()
        )
    }));
    lines.extend(bench.codes.iter().map(codes));
    if lines.is_empty() {
        lines.push(
            "no ratio: FEM did not run here, or no answer of it is good enough (--fem live, --sizes, \
             --levels)"
                .to_string(),
        );
    }
    lines.push(format!("wrote pareto.csv, pareto.svg and bench.json into {}", out.display()));
    lines.join("\n") + "\n"
}

/// Codes at equal error in one line: the fastest is what the models are compared with.
fn codes(of: &CodeTimes) -> String {
    let one = |c: &CodeTime| {
        format!(
            "{} {} (size {})",
            c.engine.title(),
            duration_with_spread(c.seconds.0, c.seconds.1),
            c.size
        )
    };
    let all: Vec<String> = of.codes.iter().map(one).collect();
    format!(
        "{} to {} p0: {}; the slowest takes {} times as long as the fastest",
        of.case,
        of.level,
        all.join(", "),
        ratio_with_spread(of.ratio.value, of.ratio.plus_minus)
    )
}

/// One level in one line: the range over the cases.
fn at_level(here: &[&Speedup], level: f64, whose: &str, cases: usize) -> Option<String> {
    let slowest = here.iter().min_by(|a, b| a.ratio.value.total_cmp(&b.ratio.value))?;
    let fastest = here.iter().max_by(|a, b| a.ratio.value.total_cmp(&b.ratio.value))?;
    let one = |s: &Speedup| {
        format!(
            "{} ({}: {} {}, {BEST} {})",
            ratio_with_spread(s.ratio.value, s.ratio.plus_minus),
            s.case,
            s.engine.title(),
            duration(s.fem_seconds.0),
            duration(s.model_seconds.0)
        )
    };
    Some(format!(
        "to {level} p0, {whose}, in {} of {cases} cases: {BEST} is {} to {} times faster",
        here.len(),
        one(slowest),
        one(fastest)
    ))
}
