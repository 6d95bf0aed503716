//! Options of the subcommands that run finite elements.

use super::values::{count, one_of, unsuited};
use crate::base::Result;
use crate::fem::{Code, FemSettings, LinearSolver};
use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, FromArgMatches, ValueEnum, ValueHint};
use std::path::PathBuf;
use std::time::Duration;

/// Source of the FEM curves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum FemSource {
    /// The recorded curves: the built-in ones, or those of --reference
    Recorded,
    /// A run of gmsh and a finite-element code now
    Live,
}

/// Options that have an effect with --fem live alone, and the first of them that is given.
pub(super) struct OfLive<T> {
    /// The options.
    pub options: T,
    given: Option<String>,
}

impl<T> OfLive<T> {
    /// Refuses an option that would change nothing.
    ///
    /// # Errors
    /// [`crate::base::Error::Value`] that names it.
    pub fn check(&self, source: FemSource) -> Result<()> {
        match &self.given {
            Some(option) if source == FemSource::Recorded => {
                let reason =
                    format!("--{option} is given, and has no effect on recorded finite elements");
                let remedy = format!("add --fem live, or leave out --{option}");
                Err(unsuited(("fem", "recorded"), &reason, &remedy))
            }
            _ => Ok(()),
        }
    }
}

impl<T: Args> Args for OfLive<T> {
    fn augment_args(command: Command) -> Command {
        T::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        T::augment_args_for_update(command)
    }
}

impl<T: Args> OfLive<T> {
    /// The first option of `T` that stands on the command line.
    fn given(matches: &ArgMatches) -> Option<String> {
        let own = T::augment_args(Command::new(""));
        let stands = |id: &str| matches.value_source(id) == Some(ValueSource::CommandLine);
        let first = own.get_arguments().find(|option| stands(option.get_id().as_str()))?;
        first.get_long().map(String::from)
    }
}

impl<T: Args> FromArgMatches for OfLive<T> {
    fn from_arg_matches(matches: &ArgMatches) -> std::result::Result<Self, clap::Error> {
        Ok(Self { given: Self::given(matches), options: T::from_arg_matches(matches)? })
    }

    fn from_arg_matches_mut(matches: &mut ArgMatches) -> std::result::Result<Self, clap::Error> {
        // Reading the options takes them out of the matches.
        let given = Self::given(matches);
        Ok(Self { given, options: T::from_arg_matches_mut(matches)? })
    }

    fn update_from_arg_matches(
        &mut self,
        matches: &ArgMatches,
    ) -> std::result::Result<(), clap::Error> {
        self.given = Self::given(matches);
        self.options.update_from_arg_matches(matches)
    }
}

/// The mesh of a subcommand that uses a single one.
#[derive(Args)]
pub(super) struct Size {
    /// Relative element size of the mesh: 1 is the production mesh, 2 is coarse
    #[arg(long, default_value_t = 1.0)]
    pub size: f64,
}

/// Options of all subcommands that run finite elements.
#[derive(Args)]
pub(super) struct FemOptions {
    /// The finite-element code
    #[arg(long, default_value = "fenicsx", value_parser = one_of(&Code::ALL, Code::name))]
    engine: Code,
    /// Linear solver of the finite elements
    #[arg(long, default_value = "direct", value_parser = one_of(&LinearSolver::ALL, LinearSolver::name))]
    linear: LinearSolver,
    /// MPI processes per finite-element run, at most as many as there are processors
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = count("processes", 1..=65536))]
    ranks: usize,
    /// Interpreter that imports dolfinx (for CalculiX: numpy) [default: $EDGELINE_PYTHON,
    /// /usr/bin/python3, python3]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::ExecutablePath)]
    python: Option<PathBuf>,
    /// The gmsh program
    #[arg(long, value_name = "FILE", default_value = "gmsh", value_hint = ValueHint::ExecutablePath)]
    gmsh: PathBuf,
    /// The CalculiX program, for --engine calculix
    #[arg(long, value_name = "FILE", default_value = "ccx", value_hint = ValueHint::ExecutablePath)]
    ccx: PathBuf,
    /// Time limit for meshing one case, in seconds
    #[arg(long, value_name = "S", default_value_t = 300.0, value_parser = seconds)]
    mesh_timeout: f64,
    /// Time limit for solving one case, in seconds
    #[arg(long, value_name = "S", default_value_t = 3600.0, value_parser = seconds)]
    solve_timeout: f64,
    /// Limit for the files of one run, in GiB
    #[arg(long, value_name = "GIB", default_value_t = 10, value_parser = count("GiB", 1..=65536))]
    max_disk: usize,
    /// Keep meshes and requests after a successful run
    #[arg(long)]
    keep: bool,
}

impl FemOptions {
    /// The code.
    pub fn engine(&self) -> Code {
        self.engine
    }

    /// The settings for a mesh of relative element size `size`.
    pub fn settings(&self, size: f64) -> FemSettings {
        self.settings_of(self.engine, size)
    }

    /// The settings for a mesh of relative element size `size` by `code`.
    pub fn settings_of(&self, code: Code, size: f64) -> FemSettings {
        FemSettings {
            code,
            ccx: self.ccx.clone(),
            size,
            linear: self.linear,
            ranks: self.ranks,
            python: self.python.clone(),
            gmsh: self.gmsh.clone(),
            mesh_timeout: Duration::from_secs_f64(self.mesh_timeout),
            solve_timeout: Duration::from_secs_f64(self.solve_timeout),
            max_bytes: (self.max_disk as u64) << 30,
            keep: self.keep,
            large_displacements: false,
        }
    }
}

/// Parses a time limit.
fn seconds(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value <= 1e8 => Ok(value),
        _ => Err("give seconds, more than 0 and at most 1e8".into()),
    }
}
