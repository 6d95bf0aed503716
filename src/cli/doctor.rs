//! `edgeline doctor`: what is installed, and what is missing.

use super::output::{Exit, print, print_json};
use crate::base::number::duration;
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::builtin_case;
use crate::fem::{Code, FemResults, tools};
use crate::solve::{Options, solve};
use clap::Args;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Reports what is installed, which interpreter finite elements would use, and what to install.
///
/// Solves a built-in case as a check of the program. Writes no files. Takes a few seconds, because
/// it starts the interpreters. Missing finite-element tools are an error only with --fem.
#[derive(Args)]
pub(super) struct Arguments {
    /// Exit with code 2 unless all tools for finite elements are installed
    #[arg(long)]
    fem: bool,
    /// Interpreter to check instead of the usual ones
    #[arg(long, value_name = "FILE")]
    python: Option<PathBuf>,
    /// The gmsh program to check
    #[arg(long, value_name = "FILE", default_value = "gmsh")]
    gmsh: PathBuf,
    /// Print the findings as one JSON object and nothing else
    #[arg(long)]
    json: bool,
}

/// The findings, as `--json` prints them.
#[derive(Serialize)]
struct Findings {
    version: &'static str,
    solver: SolverFindings,
    /// Number of recorded cases.
    records: usize,
    fem: FemFindings,
}

/// The solve of a built-in case.
#[derive(Serialize)]
struct SolverFindings {
    works: bool,
    milliseconds: f64,
}

/// The tools for finite elements; one that cannot be used is `None`.
#[derive(Serialize)]
struct FemFindings {
    ready: bool,
    gmsh: Option<String>,
    /// Why gmsh cannot be used.
    gmsh_fault: Option<String>,
    /// The interpreter that finite elements would use.
    interpreter: Option<String>,
    interpreters: Vec<Interpreter>,
    mpirun: Option<String>,
    ccx: Option<String>,
    blas: Option<String>,
}

/// An interpreter that was checked.
#[derive(Serialize)]
struct Interpreter {
    path: String,
    /// The option or variable that names it, or the usual place.
    source: &'static str,
    /// Whether there is such a file.
    found: bool,
    /// Versions of the imported packages; `None` if it does not import dolfinx.
    imports: Option<BTreeMap<String, String>>,
    /// Why it does not.
    fault: Option<String>,
}

pub(super) fn run(arguments: Arguments) -> Result<Exit> {
    let case = builtin_case("flush-short").expect("a built-in case")?;
    let summary = solve(&case, &Options::new(EdgeModel::QuarterSpace))?.summary;
    let findings = Findings {
        version: env!("CARGO_PKG_VERSION"),
        solver: SolverFindings {
            works: summary.converged,
            milliseconds: summary.seconds.total * 1e3,
        },
        records: FemResults::embedded_names().count(),
        fem: fem_findings(&arguments),
    };
    if arguments.json {
        print_json(&findings)?;
    } else {
        print(&text(&findings))?;
    }
    if arguments.fem && !findings.fem.ready {
        let tool = if findings.fem.gmsh.is_none() { "gmsh" } else { "dolfinx" };
        return Err(Error::Missing {
            tool: tool.into(),
            searched: "see the findings above".into(),
            remedy: Code::Fenicsx.install().into(),
        });
    }
    Ok(Exit::Done)
}

/// Looks for the tools for finite elements.
fn fem_findings(arguments: &Arguments) -> FemFindings {
    let (gmsh, gmsh_fault) = parts(tools::gmsh_version(&arguments.gmsh));
    let mpirun = tools::version(Path::new("mpirun")).ok();
    let mut interpreters = Vec::new();
    let mut chosen: Option<PathBuf> = None;
    for (path, source) in tools::candidates(arguments.python.as_deref()) {
        let (imports, fault) = parts(tools::imports(&path, Code::Fenicsx));
        if imports.is_some() && chosen.is_none() {
            chosen = Some(path.clone());
        }
        let (found, path) = (tools::is_there(&path), path.display().to_string());
        interpreters.push(Interpreter { path, source, found, imports, fault });
    }
    FemFindings {
        ready: gmsh.is_some() && chosen.is_some(),
        gmsh,
        gmsh_fault,
        interpreter: chosen.as_ref().map(|path| path.display().to_string()),
        interpreters,
        mpirun,
        ccx: tools::ccx_version(Path::new("ccx")).ok(),
        blas: chosen.as_deref().and_then(tools::blas),
    }
}

/// What was found, and why it was not.
fn parts<T>(found: tools::Found<T>) -> (Option<T>, Option<String>) {
    match found {
        Ok(value) => (Some(value), None),
        Err(why) => (None, Some(why)),
    }
}

/// The findings for a reader.
fn text(findings: &Findings) -> String {
    let fem = &findings.fem;
    let or = |value: &Option<String>, otherwise: &str| {
        value.clone().unwrap_or_else(|| otherwise.to_string())
    };
    let mut lines = vec![
        format!("edgeline {}", findings.version),
        format!(
            "semi-analytical solver: {} ({} for a built-in case)",
            if findings.solver.works { "works" } else { "does not work: install it anew" },
            duration(findings.solver.milliseconds * 1e-3)
        ),
        format!("recorded finite-element cases: {}", findings.records),
        format!("gmsh: {}", fem.gmsh.as_ref().or(fem.gmsh_fault.as_ref()).expect("one of the two")),
    ];
    for Interpreter { path, source, found, imports, fault } in &fem.interpreters {
        let why = fault.as_deref().unwrap_or_default();
        let imports = match imports {
            Some(versions) => {
                let all = versions.iter().map(|(name, version)| format!("{name} {version}"));
                all.collect::<Vec<_>>().join(", ")
            }
            None if *found => format!("does not import dolfinx: it {why}"),
            None => "not found".to_string(),
        };
        let mark = if fem.interpreter.as_ref() == Some(path) { " <- used" } else { "" };
        lines.push(format!("interpreter {path} ({source}): {imports}{mark}"));
    }
    lines.push(format!("mpirun: {}", or(&fem.mpirun, "not found (needed for --ranks only)")));
    lines.push(format!(
        "CalculiX: {}",
        or(&fem.ccx, "not found (needed for --engine calculix only)")
    ));
    lines.push(format!("BLAS: {}", or(&fem.blas, "not known")));
    if fem.blas.as_deref().is_some_and(tools::is_slow_blas) {
        lines.push(
            "  this BLAS makes direct solves several times slower than they need be; \
             on Debian or Ubuntu: apt-get install libopenblas0-serial"
                .into(),
        );
    }
    if fem.ready {
        lines.push("finite elements: ready".into());
    } else {
        lines.push(format!("finite elements: not ready; {}", Code::Fenicsx.install()));
    }
    lines.join("\n") + "\n"
}
