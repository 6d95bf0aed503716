//! `edgeline compare`: curves from anywhere against the models and recorded FEM.

use super::output::{Exit, print, print_json, say};
use super::provenance::{command_line, now};
use super::records::Records;
use super::study_options::RangeOptions;
use super::values::unsuited;
use crate::base::{Error, Result};
use crate::case::find_case;
use crate::host::{Lock, replace_set};
use crate::report::comparison::{Context, Summary, files};
use crate::report::gates;
use crate::report::table::read;
use crate::study::brought::{BroughtFile, Comparison, Limits, Statements};
use crate::study::gate::{self, Gates};
use crate::study::{Engine, Reference, reference};
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// Compares curves from anywhere (another program, measurements) with the models and recorded FEM.
///
/// A file is CSV with a column for each coordinate and either stress components and a body, or a
/// pressure; lines `# key: value` above it state units and axes (docs/compare.md). The models are
/// evaluated at its points. Quarter-space is held to the limits of --gates, or to the built-in ones
/// widened by the error that the file states. Writes errors.csv, curves.csv, pressure.csv,
/// gates.json, gates.md, plots/*.svg, compare.html and summary.json into the output folder. Exit
/// code 0: all gates hold; 1: one failed; 2: could not run. Takes about a second.
#[derive(Args)]
pub(super) struct Arguments {
    /// A case file, or the name of a case that `edgeline cases` lists
    #[arg(value_hint = ValueHint::FilePath)]
    pub(super) case: PathBuf,
    /// Files of curves (CSV)
    #[arg(required = true, value_name = "CURVES.csv", value_hint = ValueHint::FilePath)]
    curves: Vec<PathBuf>,
    /// Folder for the results; created if it does not exist
    #[arg(long, default_value = "out", value_hint = ValueHint::DirPath)]
    out: PathBuf,
    /// Thresholds (TOML) as they are, instead of the built-in ones widened by the files' errors
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    gates: Option<PathBuf>,
    /// Folder of recorded curves, one folder per case, instead of the built-in ones
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    reference: Option<PathBuf>,
    #[command(flatten)]
    range: RangeOptions,
    #[command(flatten)]
    stated: StatedOptions,
    /// Print the summary as one JSON object and nothing else
    #[arg(long)]
    json: bool,
}

/// Why a curve is left out.
const TOO_FEW: &str = "too few points away from the edges, of which a curve takes two in a row";

/// What options state in place of the files' headers.
#[derive(Args)]
struct StatedOptions {
    /// Unit of coordinates, in place of the files' own: m, cm, mm, um or in
    #[arg(long, value_name = "UNIT")]
    length_unit: Option<String>,
    /// Unit of stresses and pressures: Pa, kPa, MPa, GPa, psi or ksi
    #[arg(long, value_name = "UNIT")]
    stress_unit: Option<String>,
    /// The files' directions across the contact, along it, and into the block, as in "z -x y"
    #[arg(long, allow_hyphen_values = true)]
    axes: Option<String>,
    /// The files' coordinates of the contact's origin, as in "0 12.5 0"
    #[arg(long, allow_hyphen_values = true)]
    origin: Option<String>,
    /// bodies: z goes into each body; space: one system of axes for both
    #[arg(long)]
    system: Option<String>,
    /// block or roller, where no column says so
    #[arg(long)]
    body: Option<String>,
    /// Largest error of the curves as a fraction of p0
    #[arg(long, value_name = "P0")]
    error_p0: Option<String>,
}

impl StatedOptions {
    fn statements(&self) -> Result<Statements> {
        let mut statements = Statements::default();
        for (key, value) in [
            ("length_unit", &self.length_unit),
            ("stress_unit", &self.stress_unit),
            ("axes", &self.axes),
            ("origin", &self.origin),
            ("system", &self.system),
            ("body", &self.body),
            ("error_p0", &self.error_p0),
        ] {
            let Some(value) = value else { continue };
            statements.set(key, value).map_err(|reason| Error::Value {
                key: format!("--{}", key.replace('_', "-")),
                value: value.clone(),
                reason,
                remedy: "docs/compare.md describes it".to_string(),
            })?;
        }
        Ok(statements)
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit> {
    let case = find_case(&arguments.case)?;
    case.check_force("every model would find another force")?;
    let stated = arguments.stated.statements()?;
    let thresholds = match &arguments.gates {
        Some(path) => gate::parse(&read(path)?, path)?,
        None => Gates::for_others()?,
    };
    let limits = match &arguments.gates {
        Some(_) => Limits::Given(&thresholds.gate),
        None => Limits::Widened(&thresholds.gate),
    };
    let mut brought: Vec<BroughtFile> = Vec::new();
    for path in &arguments.curves {
        let file = BroughtFile::read(path, &case, &stated)?;
        file.check_foreign()?;
        file.check_name(&brought)?;
        brought.push(file);
    }
    let pressures = |file: &BroughtFile| file.curves.stress.is_empty();
    if let Some(body) = arguments.stated.body.as_deref().filter(|_| brought.iter().all(pressures)) {
        return Err(unsuited(("body", body), "a pressure is that of both bodies", "leave it out"));
    }
    let records = Records::read(arguments.reference.as_deref())?;
    let first = records.find(&case)?.map(|record| (Engine::fenicsx(), Ok(record)));
    let found = first.into_iter().chain(records.further(&case));
    let fem = found.map(|(engine, record)| Ok((engine, reference::from_fem(&record?))));
    let fem: Vec<(Engine, Reference)> = fem.collect::<Result<_>>()?;
    let fem: Vec<_> = fem.iter().map(|(engine, reference)| (engine.clone(), reference)).collect();
    let compared = Comparison::new(&case, brought, &fem, &limits, &arguments.range.range())?;
    if let Some(file) = compared.files.iter().find(|file| file.errors.is_empty()) {
        return Err(Error::File {
            path: file.file.path.clone(),
            line: None,
            message: format!("nothing can be compared: {TOO_FEW}: {}", file.left_out.join(", ")),
            remedy: "give more points, or a smaller --exclude or --exclude-pressure".into(),
        });
    }
    let (date, command) = (now(), command_line());
    let own_limits = arguments.gates.is_some();
    let summary = Summary::of(&compared, &Context { date: &date, command: &command, own_limits });
    let contents = files(&compared, &summary)?;
    let out = &arguments.out;
    let _lock = Lock::claim(out)?;
    replace_set(out, &contents)?;
    for file in &summary.files {
        if !file.left_out.is_empty() {
            let left_out = file.left_out.join(", ");
            say(&format!("note: {}: {TOO_FEW}: {left_out}", file.name));
        }
    }
    if arguments.json {
        print_json(&summary)?;
    } else {
        print(&text(&summary, arguments))?;
    }
    Ok(if summary.gates_hold { Exit::Done } else { Exit::GateFailed })
}

/// The short summary for a reader.
fn text(summary: &Summary, arguments: &Arguments) -> String {
    let table = gates::table(&summary.gates);
    let verdict = summary.verdict.join("\n");
    let out = arguments.out.display();
    format!("{table}{verdict}\nwrote compare.html, tables and plots into {out}\n")
}
