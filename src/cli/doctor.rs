//! `edgeline doctor`: what is installed, and what is missing.

use super::output::{Exit, print, print_json};
use crate::base::number::duration;
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::builtin_case;
use crate::fem::{FemResults, tools};
use crate::solve::{Options, solve};
use clap::Args;
use serde_json::{Value, json};
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

pub(super) fn run(arguments: Arguments) -> Result<Exit> {
    let case = builtin_case("flush-short").expect("a built-in case")?;
    let solution = solve(&case, &Options::new(EdgeModel::QuarterSpace))?;
    let solver_ms = solution.summary.seconds.total * 1e3;
    let records = FemResults::embedded_names().count();

    let gmsh = tools::version(&arguments.gmsh);
    let mpirun = tools::version(Path::new("mpirun"));
    let mut interpreters = Vec::new();
    let mut chosen: Option<PathBuf> = None;
    for (path, source) in tools::candidates(arguments.python.as_deref()) {
        let imports = tools::imports(&path);
        if imports.is_some() && chosen.is_none() {
            chosen = Some(path.clone());
        }
        interpreters.push(
            json!({"path": path.display().to_string(), "source": source, "imports": imports}),
        );
    }
    let blas = chosen.as_deref().and_then(tools::blas);
    let fast_blas = blas.as_deref().is_none_or(|name| !tools::is_slow_blas(name));
    let fem_ready = gmsh.is_some() && chosen.is_some();
    let findings = json!({
        "version": env!("CARGO_PKG_VERSION"),
        "solver": {"works": solution.summary.converged, "milliseconds": solver_ms},
        "records": records,
        "fem": {
            "ready": fem_ready,
            "gmsh": gmsh,
            "interpreter": chosen.as_ref().map(|path| path.display().to_string()),
            "interpreters": interpreters,
            "mpirun": mpirun,
            "blas": blas,
        },
    });
    if arguments.json {
        print_json(&findings)?;
    } else {
        print(&text(&findings, fast_blas))?;
    }
    if arguments.fem && !fem_ready {
        return Err(Error::Missing {
            tool: if gmsh.is_none() { "gmsh".into() } else { "dolfinx".to_string() },
            searched: "see the findings above".into(),
            remedy: tools::INSTALL.into(),
        });
    }
    Ok(Exit::Done)
}

/// The findings for a reader.
fn text(findings: &Value, fast_blas: bool) -> String {
    let fem = &findings["fem"];
    let or = |value: &Value, otherwise: &str| match value.as_str() {
        Some(text) => text.to_string(),
        None => otherwise.to_string(),
    };
    let mut lines = vec![
        format!("edgeline {}", or(&findings["version"], "")),
        format!(
            "semi-analytical solver: works ({} for a built-in case)",
            duration(findings["solver"]["milliseconds"].as_f64().unwrap_or(f64::NAN) * 1e-3)
        ),
        format!("recorded finite-element cases: {}", findings["records"]),
        format!("gmsh: {}", or(&fem["gmsh"], "not found")),
    ];
    for interpreter in fem["interpreters"].as_array().into_iter().flatten() {
        let path = or(&interpreter["path"], "");
        let source = or(&interpreter["source"], "");
        let imports = match interpreter["imports"].as_object() {
            Some(versions) => versions
                .iter()
                .map(|(name, version)| format!("{name} {}", or(version, "")))
                .collect::<Vec<_>>()
                .join(", "),
            None => "does not import dolfinx".to_string(),
        };
        let mark = if interpreter["path"] == fem["interpreter"] { " <- taken" } else { "" };
        lines.push(format!("interpreter {path} ({source}): {imports}{mark}"));
    }
    lines.push(format!("mpirun: {}", or(&fem["mpirun"], "not found (needed for --ranks only)")));
    lines.push(format!("BLAS: {}", or(&fem["blas"], "not known")));
    if !fast_blas {
        lines.push(
            "  this BLAS makes direct solves several times slower than they need be; \
             on Debian or Ubuntu: apt-get install libopenblas0-serial"
                .into(),
        );
    }
    if fem["ready"] == true {
        lines.push("finite elements: ready".into());
    } else {
        lines.push(format!("finite elements: not ready; {}", tools::INSTALL));
    }
    lines.join("\n") + "\n"
}
