//! `edgeline fem`: solves one case by finite elements.

use super::fem_options::{FemOptions, Size};
use super::output::{Exit, print, print_json, say};
use super::progress::Progress;
use crate::base::Result;
use crate::case::{Case, find_case};
use crate::fem::{Driver, MeshResult};
use clap::{Args, ValueHint};
use serde_json::json;
use std::path::PathBuf;

/// Solves one case by finite elements: meshes by gmsh, contact by FEniCSx or CalculiX, as child
/// processes.
///
/// Writes curves.csv and pressure.csv (at the points of the semi-analytical solution), fem.json,
/// mesh.json, request.json and the log of each stage into the output folder. Takes a few seconds at
/// --size 2 and a minute at --size 1, with --engine calculix one to two minutes at --size 2; what
/// is not symmetric along y takes up to a minute at --size 2. The next run continues a run that was
/// stopped; a finished run is not repeated.
#[derive(Args)]
pub(super) struct Arguments {
    /// A case file, or the name of a case that `edgeline cases` lists
    #[arg(value_hint = ValueHint::FilePath)]
    pub(super) case: PathBuf,
    /// Folder for the results; created if it does not exist
    #[arg(long, default_value = "out", value_hint = ValueHint::DirPath)]
    out: PathBuf,
    #[command(flatten)]
    size: Size,
    #[command(flatten)]
    fem: FemOptions,
    /// Print the summary as one JSON object and nothing else
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit> {
    let case = find_case(&arguments.case)?;
    let code = arguments.fem.engine();
    code.check(&case)?;
    let driver = Driver::new(arguments.fem.settings(arguments.size.size))?;
    let interpreter = driver.interpreter();
    say(&format!(
        "using {} ({}), {} {}",
        interpreter.path.display(),
        interpreter.source,
        code.modules()[0],
        interpreter.versions.get(code.modules()[0]).map_or("unknown", String::as_str),
    ));
    let progress = Progress::new();
    let result = driver.run(&case, &arguments.out, &|text| progress.say(&case.name, text));
    progress.finish();
    let result = result?;
    if arguments.json {
        print_json(&json!({
            "case": case.name,
            "engine": arguments.fem.engine().name(),
            "size": result.size,
            "hertz": case.hertz(),
            "summary": result.summary,
        }))?;
    } else {
        print(&text(&case, &result, arguments))?;
    }
    Ok(Exit::Done)
}

/// The short summary for a reader.
fn text(case: &Case, result: &MeshResult, arguments: &Arguments) -> String {
    let (summary, p0) = (&result.summary, case.hertz().p0_pa);
    format!(
        "{} by {}: size {}, {} unknowns, {} process(es)\n  \
         pressure {:.4} p0 at the centre, {:.4} p0 at most\n  \
         load met to {:.0e}, equilibrium to {:.0e}, {:.1} s, {:.2} GiB\n\
         in {}: curves.csv, pressure.csv, mesh.json, fem.json\n",
        case.name,
        arguments.fem.engine().title(),
        result.size,
        summary.unknowns,
        summary.ranks,
        summary.p_centre_pa / p0,
        summary.p_max_pa / p0,
        summary.load_error_rel,
        summary.equilibrium_residual,
        summary.total_seconds(),
        summary.peak_memory_mib / 1024.0,
        arguments.out.display(),
    )
}
