//! `edgeline deck`: the input deck of a case for CalculiX and Abaqus.

use super::fem_options::Size;
use super::output::{Exit, print};
use super::progress::Progress;
use crate::base::Result;
use crate::case::find_case;
use crate::fem::{Code, DECK_FILES, Driver, FemSettings};
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// Writes a case as an input deck for CalculiX and Abaqus.
///
/// Writes model.inp with the files that it includes (mesh.inp, bodies.inp), the meshes as .msh and
/// .vtu, mesh.json and request.json into the output folder, in mm, N and MPa: 20-node bricks, node
/// sets, contact pair, steps and output requests, with comments (docs/deck.md). `edgeline fem
/// --engine calculix` runs the same deck, but for large displacements. Takes a few seconds.
#[derive(Args)]
pub(super) struct Arguments {
    /// A case file, or the name of a case that `edgeline cases` lists
    #[arg(value_hint = ValueHint::FilePath)]
    pub(super) case: PathBuf,
    /// Folder for the deck; created if it does not exist
    #[arg(long, default_value = "out", value_hint = ValueHint::DirPath)]
    out: PathBuf,
    #[command(flatten)]
    size: Size,
    /// Ask for large displacements: equilibrium where the bodies have moved to (NLGEOM)
    #[arg(long)]
    large_displacements: bool,
    /// Interpreter that imports numpy [default: $EDGELINE_PYTHON, /usr/bin/python3, python3]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::ExecutablePath)]
    python: Option<PathBuf>,
    /// The gmsh program
    #[arg(long, value_name = "FILE", default_value = "gmsh", value_hint = ValueHint::ExecutablePath)]
    gmsh: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit> {
    let case = find_case(&arguments.case)?;
    Code::Calculix.check(&case)?;
    let driver = Driver::without_solver(FemSettings {
        code: Code::Calculix,
        size: arguments.size.size,
        large_displacements: arguments.large_displacements,
        python: arguments.python.clone(),
        gmsh: arguments.gmsh.clone(),
        ..FemSettings::default()
    })?;
    let progress = Progress::new();
    let written = driver.deck(&case, &arguments.out, &|text| progress.say(&case.name, text));
    progress.finish();
    written?;
    let (files, out) = (DECK_FILES.join(", "), arguments.out.display());
    print(&format!("{}: wrote {files} into {out}\n", case.name))?;
    Ok(Exit::Done)
}
