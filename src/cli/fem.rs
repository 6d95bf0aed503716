//! `edgeline fem`: one case by finite elements, now.

use super::{Outcome, Progress, print, print_json, say};
use crate::base::Result;
use crate::case::Case;
use crate::fem::{Driver, Linear, MeshResult, Settings};
use crate::host::prepare_folder;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueHint};
use serde_json::json;
use std::path::PathBuf;
use std::time::Duration;

/// Solves one case by finite elements: meshes by gmsh, contact by FEniCSx, as child processes.
///
/// Writes curves.csv and pressure.csv (at the points of the semi-analytical solution), fem.json,
/// mesh.json and the log of each stage into the output folder. Takes some seconds at --size 2, a
/// minute at --size 1. A run that was stopped goes on where it was; one that is done is not
/// repeated.
#[derive(Args)]
pub(super) struct Arguments {
    /// A case file, or the name of a built-in case
    #[arg(value_hint = ValueHint::FilePath)]
    case: PathBuf,
    /// Folder for the results; made if it is not there
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

/// The mesh of whatever runs finite elements on one.
#[derive(Args)]
pub(super) struct Size {
    /// Relative element size of the mesh: 1 is the production mesh, 2 is coarse
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    pub size: f64,
}

/// Options of everything that runs finite elements.
#[derive(Args)]
pub(super) struct FemOptions {
    /// Linear solver of the finite elements
    #[arg(long, default_value = "direct", value_parser = linear())]
    linear: Linear,
    /// MPI processes per finite-element run
    #[arg(long, default_value_t = 1, value_name = "N")]
    ranks: usize,
    /// Interpreter that imports dolfinx [default: $EDGELINE_PYTHON, /usr/bin/python3, python3]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::ExecutablePath)]
    python: Option<PathBuf>,
    /// The gmsh program
    #[arg(long, value_name = "FILE", default_value = "gmsh", value_hint = ValueHint::ExecutablePath)]
    gmsh: PathBuf,
    /// Seconds that meshing one case may take
    #[arg(long, value_name = "S", default_value_t = 300.0, value_parser = seconds, allow_negative_numbers = true)]
    mesh_timeout: f64,
    /// Seconds that the calculation of one case may take
    #[arg(long, value_name = "S", default_value_t = 3600.0, value_parser = seconds, allow_negative_numbers = true)]
    solve_timeout: f64,
    /// GiB that the files of one run may take
    #[arg(long, value_name = "GIB", default_value_t = 10)]
    max_disk: u16,
    /// Keep meshes and requests after success
    #[arg(long)]
    keep: bool,
}

impl FemOptions {
    /// The settings that they amount to, for a mesh of relative element size `size`.
    pub fn settings(&self, size: f64) -> Settings {
        Settings {
            size,
            linear: self.linear,
            ranks: self.ranks,
            python: self.python.clone(),
            gmsh: self.gmsh.clone(),
            mesh_timeout: Duration::from_secs_f64(self.mesh_timeout),
            solve_timeout: Duration::from_secs_f64(self.solve_timeout),
            max_bytes: u64::from(self.max_disk) << 30,
            keep: self.keep,
        }
    }
}

fn linear() -> impl TypedValueParser<Value = Linear> {
    PossibleValuesParser::new(Linear::ALL.map(Linear::name)).map(|name| {
        let named = |linear: &Linear| linear.name() == name;
        Linear::ALL.into_iter().find(named).expect("only these names pass")
    })
}

/// Parses a time limit.
fn seconds(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value <= 1e8 => Ok(value),
        _ => Err("give seconds, more than 0 and at most 1e8".into()),
    }
}

pub(super) fn run(arguments: Arguments) -> Result<Outcome> {
    let case = Case::find(&arguments.case)?;
    prepare_folder(&arguments.out)?;
    let driver = Driver::new(arguments.fem.settings(arguments.size.size))?;
    let interpreter = driver.interpreter();
    say(&format!(
        "using {} ({}), dolfinx {}",
        interpreter.path.display(),
        interpreter.source,
        interpreter.versions.get("dolfinx").map_or("unknown", String::as_str),
    ));
    let progress = Progress::new();
    let result = driver.run(&case, &arguments.out, &|text| progress.say(&case.name, text));
    progress.finish();
    let result = result?;
    if arguments.json {
        print_json(&json!({
            "case": case.name,
            "size": result.size,
            "hertz": case.hertz(),
            "summary": result.summary,
        }))?;
    } else {
        print(&text(&case, &result, &arguments))?;
    }
    Ok(Outcome::Done)
}

/// The short summary for a reader.
fn text(case: &Case, result: &MeshResult, arguments: &Arguments) -> String {
    let (summary, p0) = (&result.summary, case.hertz().p0_pa);
    format!(
        "{} by finite elements: size {}, {} unknowns, {} process(es)\n  \
         pressure {:.4} p0 at the centre, {:.4} p0 at most\n  \
         load met to {:.0e}, equilibrium to {:.0e}, {:.1} s, {:.2} GiB\n\
         wrote curves.csv, pressure.csv, mesh.json, fem.json into {}\n",
        case.name,
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
