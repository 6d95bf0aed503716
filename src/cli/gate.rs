//! `edgeline gate`: checks of the accuracy.

use super::output::{Exit, print, print_json, warn};
use super::study_options::StudyOptions;
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::Study;
use crate::host::{Lock, write_set, write_whole};
use crate::report::gates;
use crate::report::study_files::pretty;
use crate::report::table::read;
use crate::study::StudyRun;
use crate::study::gate::{self, Baseline, Gates};
use clap::{Args, ValueHint};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Checks the models against their accuracy gates: absolute limits, and drift from accepted
/// numbers.
///
/// Without a study, and without thresholds of one's own, runs all built-in studies, each with its
/// gates. Prints a table of all gates with value, limit and margin; writes gates.json, gates.md and
/// junit.xml into the output folder, and the Markdown also to the file that $GITHUB_STEP_SUMMARY
/// names. Exit code 0: all hold; 1: one failed; 2: could not run. Takes half a minute with recorded
/// finite-element curves; with --fem live minutes per case, so name a study.
#[derive(Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    study: StudyOptions,
    /// Thresholds (TOML) of one study, the default one if none is named, instead of the built-in
    /// ones
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    gates: Option<PathBuf>,
    /// Accepted numbers (JSON), instead of the built-in ones
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    baseline: Option<PathBuf>,
    /// Accept the numbers of this run: show the changes and write the numbers to --baseline
    #[arg(long, requires = "baseline")]
    accept: bool,
    /// Print the outcomes as one JSON object and nothing else
    #[arg(long)]
    json: bool,
}

/// Largest number of changes that `--accept` lists; the others are counted.
const LISTED: usize = 40;

pub(super) fn run(arguments: Arguments) -> Result<Exit> {
    let studies: Vec<Study> = match (&arguments.study.study, &arguments.gates) {
        (None, None) => Study::all_built_in().collect(),
        _ => vec![arguments.study.find_study()?],
    };
    let accepted = match &arguments.baseline {
        // A file that is to be written need not exist.
        Some(path) if arguments.accept && !path.exists() => Baseline::default(),
        Some(path) => Baseline::parse(&read(path)?, path)?,
        None => Baseline::built_in()?,
    };
    let thresholds_of = |study: &Study| match &arguments.gates {
        Some(path) => gate::parse(&read(path)?, path),
        None => Gates::built_in_for(&study.name),
    };
    let thresholds: Vec<Gates> = studies.iter().map(thresholds_of).collect::<Result<_>>()?;
    let usual: Vec<EdgeModel> = thresholds.iter().flat_map(Gates::methods).collect();
    arguments.study.check(&usual, false)?;
    let out = &arguments.study.out;
    let _lock = Lock::claim(out)?;
    let (mut outcomes, mut now) = (Vec::new(), Baseline::default());
    let mut kept = accepted.clone();
    for (study, thresholds) in studies.iter().zip(&thresholds) {
        let timed = thresholds.gate.iter().any(|g| g.is_speedup());
        let repeats = if timed { 5 } else { 0 };
        let run = arguments.study.run(study, &thresholds.methods(), repeats, false)?;
        if arguments.accept {
            check_solved(&run)?;
            kept = kept.without(&run);
            now = now.with(Baseline::of(&run));
        } else {
            warn(&left_out(thresholds, &run));
            outcomes.extend(gate::evaluate(&run, thresholds, Some(&accepted)));
        }
    }
    if let Some(path) = arguments.baseline.as_deref().filter(|_| arguments.accept) {
        return accept(path, &accepted, kept, now, arguments.json);
    }
    let markdown = gates::markdown(&outcomes);
    let json = gates::json(&outcomes);
    let files = [
        ("gates.md", markdown.clone().into_bytes()),
        ("junit.xml", gates::junit(&outcomes).into_bytes()),
        ("gates.json", pretty(&json).into_bytes()),
    ];
    write_set(out, &files)?;
    if let Some(path) = std::env::var_os("GITHUB_STEP_SUMMARY") {
        append(Path::new(&path), &markdown)?;
    }
    if arguments.json {
        print_json(&json)?;
    } else {
        print(&format!("{}{}\n", gates::table(&outcomes), gates::headline(&outcomes)))?;
    }
    let hold = outcomes.iter().all(|o| o.passed);
    Ok(if hold { Exit::Done } else { Exit::GateFailed })
}

/// What to say of the gates of models that the run does not have: it may pass without them.
fn left_out(thresholds: &Gates, run: &StudyRun) -> Vec<String> {
    let missing = EdgeModel::ALL.into_iter().filter(|model| !run.methods.contains(model));
    let gates_of = |model| thresholds.gate.iter().filter(|gate| gate.method == model).count();
    let counted = missing.map(|model| (model, gates_of(model))).filter(|(_, count)| *count > 0);
    let text = |(model, count): (EdgeModel, usize)| {
        format!("{}: {count} gates of {model} are not checked: it is not run", run.study)
    };
    counted.map(text).collect()
}

/// Refuses a run in which a model has no solution: its numbers would be missing among the accepted
/// ones.
fn check_solved(run: &StudyRun) -> Result<()> {
    let all = run.cases.iter().flat_map(|case| case.methods.iter().map(move |m| (case, m)));
    let mut failed = all.filter_map(|(case, m)| Some((case, m, m.result.as_ref().err()?)));
    let Some((case, method, error)) = failed.next() else { return Ok(()) };
    Err(Error::Value {
        key: "--accept".to_string(),
        value: format!("{} of {}", method.source.name(), case.case.name),
        reason: format!("it has no solution: {error}"),
        remedy: "accept numbers when all cases are solved".to_string(),
    })
}

/// Writes the numbers `now` of a run as the accepted ones, beside those of others that are `kept`,
/// and lists the changes.
fn accept(
    path: &Path,
    accepted: &Baseline,
    kept: Baseline,
    now: Baseline,
    json: bool,
) -> Result<Exit> {
    let places: usize = now.numbers.values().map(|v| v.len()).sum();
    let sound = now.numbers.values().flat_map(|v| v.values()).all(|v| v.is_finite());
    if places == 0 || !sound {
        return Err(Error::Value {
            key: "--accept".to_string(),
            value: format!("{places} numbers"),
            reason: "nothing was compared, or a number is not finite".to_string(),
            remedy: "run `edgeline study` to find the cause".to_string(),
        });
    }
    let all = kept.with(now);
    let changes = accepted.changes(&all, 0.0);
    write_whole(path, all.to_json())?;
    let mut lines: Vec<String> = changes.iter().map(gate::Change::describe).collect();
    if json {
        return print_json(&serde_json::json!({ "accepted": places, "changes": lines }))
            .map(|()| Exit::Done);
    }
    let more = lines.len().saturating_sub(LISTED);
    lines.truncate(LISTED);
    if more > 0 {
        lines.push(format!("and {more} more"));
    }
    lines.push(format!("accepted {places} numbers into {}", path.display()));
    print(&(lines.join("\n") + "\n"))?;
    Ok(Exit::Done)
}

/// Appends to a file, because other steps of a job write to it too.
fn append(path: &Path, text: &str) -> Result<()> {
    let io = |source| Error::Io { action: "append to", path: path.to_path_buf(), source };
    let mut file = std::fs::OpenOptions::new().create(true).append(true).open(path).map_err(io)?;
    file.write_all(text.as_bytes()).map_err(io)
}
