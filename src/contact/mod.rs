//! Load-controlled contact of two bodies.
//!
//! Conventions: lengths in units of C, pressures in units of p0. Along y the unknowns are at the
//! nodes of an axis over the contact line, or over one half of it if the contact is symmetric.
//! Across the contact the pressure at node j is
//!
//! p_j(x) = sum_m c_jm sqrt(1 - t^2) U_2m(t), t = x / a_j,
//!
//! with the half-width a_j also unknown. Inside the contact u(x, y) + gap(x, y) = D + theta y, with
//! the approach D, the tilt theta, and
//!
//! u_i(x) = (1 / pi^2) int_0^inf cos(k x) sum_j C_ij(k) p_j^(k) dk,
//!
//! where C is the compliance of both bodies together (the sum of e_b times each body's f; a
//! half-space's f is 2 K0(k|y|), whose row sums are 2 pi / k) and p^ is the Fourier transform
//! int p cos(k x) dx.

mod check;
mod ends;
mod galerkin;
mod gap;
mod layout;
mod operator;
mod problem;
mod settings;
mod slices;
mod solution;
mod solver;

pub use check::gaps;
pub use gap::{Gap, Shaped, Straight};
pub use operator::{Compliance, LineOperator, Operator};
pub use problem::{Problem, Rotation};
pub use settings::ContactSettings;
pub use slices::Slices;
pub use solution::{Coarser, ContactEnd, ContactSolution};
pub use solver::solve;
