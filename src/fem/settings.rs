//! Settings of finite-element runs.

use super::code::Code;
use std::path::PathBuf;
use std::time::Duration;

/// The linear solver of the finite-element program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinearSolver {
    /// Sparse Cholesky factors, once per body.
    Direct,
    /// Conjugate gradients with algebraic multigrid; needs less memory on large meshes.
    Iterative,
}

impl LinearSolver {
    /// Both, the default first.
    pub const ALL: [LinearSolver; 2] = [LinearSolver::Direct, LinearSolver::Iterative];

    /// The name in requests and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            LinearSolver::Direct => "direct",
            LinearSolver::Iterative => "iterative",
        }
    }

    /// Memory for the solution of `unknowns` (bytes), from the measured growth in docs/fem.md.
    pub(super) fn bytes(self, unknowns: f64) -> f64 {
        match self {
            LinearSolver::Direct => 3.0 * GIB * (unknowns / 250e3).powf(1.3),
            LinearSolver::Iterative => 1.5 * GIB * (unknowns / 250e3),
        }
    }
}

const GIB: f64 = (1u64 << 30) as f64;

/// Settings of finite-element runs.
#[derive(Debug, Clone, PartialEq)]
pub struct FemSettings {
    /// The code that solves.
    pub code: Code,
    /// The CalculiX program, where that is the code.
    pub ccx: PathBuf,
    /// Whether a deck's bodies are in equilibrium where they have moved to. Of a deck alone: runs
    /// take small displacements.
    pub large_displacements: bool,
    /// Relative element size, 1 is the production mesh; see [`FemSettings::SIZE_RANGE`].
    pub size: f64,
    /// The linear solver.
    pub linear: LinearSolver,
    /// Number of MPI ranks, at least 1.
    pub ranks: usize,
    /// The interpreter; searched for if none.
    pub python: Option<PathBuf>,
    /// The gmsh program.
    pub gmsh: PathBuf,
    /// Time limit of the mesh stage.
    pub mesh_timeout: Duration,
    /// Time limit of the solve stage.
    pub solve_timeout: Duration,
    /// Largest size of the folder of a run (bytes).
    pub max_bytes: u64,
    /// Whether meshes and requests are kept after success.
    pub keep: bool,
}

impl FemSettings {
    /// Legal range of the relative element size.
    pub const SIZE_RANGE: (f64, f64) = (0.1, 10.0);
}

impl Default for FemSettings {
    fn default() -> Self {
        Self {
            code: Code::Fenicsx,
            ccx: "ccx".into(),
            large_displacements: false,
            size: 1.0,
            linear: LinearSolver::Direct,
            ranks: 1,
            python: None,
            gmsh: "gmsh".into(),
            mesh_timeout: Duration::from_secs(300),
            solve_timeout: Duration::from_secs(3600),
            max_bytes: 10 << 30,
            keep: false,
        }
    }
}
