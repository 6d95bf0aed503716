//! Contact pressure and stresses at the ends of finite line contacts.
//!
//! A cylindrical roller is pressed on a rectangular block; both end in free faces. The library
//! solves the frictionless contact and the stress fields of both bodies semi-analytically, and
//! compares them with finite elements.
//!
//! # From a case to pressures and stresses
//!
//! ```
//! use edgeline::base::BodyKind;
//! use edgeline::body::EdgeModel;
//! use edgeline::case::Case;
//! use edgeline::solve::{Options, SolvedCase};
//!
//! let case = Case::from_toml(
//!     "name = 'roller'
//!      roller = { radius_m = 10e-3, length_m = 10e-3, young_pa = 210e9, poisson = 0.3 }
//!      block = { length_m = 20e-3, young_pa = 210e9, poisson = 0.3 }
//!      load = { force_n = 10e3 }",
//! )?;
//! let solved = SolvedCase::new(&case, &Options::new(EdgeModel::QuarterSpace))?;
//! let end = 0.5 * case.roller.length_m / solved.hertz().c_m;
//! let pressure = solved.pressure(0.0, end - 0.5);
//! let stress = solved.stress(BodyKind::Block, &[[0.0, end - 0.5, 0.78]])?[0];
//! assert!(pressure > 1.0, "{pressure} p0: it rises towards the end of the shorter body");
//! assert!(stress.zz < 0.0 && stress.von_mises() > 0.5, "{stress:?} p0");
//! # Ok::<(), edgeline::base::Error>(())
//! ```
//!
//! Points are x, y, z in units of C, results in units of p0. [`solve::solve`] also gives the
//! standard curves, the pressure in cells and a summary in SI units. Without its default features
//! the crate contains the numerics alone, without the program and its dependencies.
//!
//! # Conventions
//!
//! - Axes: `x` across the contact, `y` along the contact line, `z` into the body at hand; the
//!   origin is on the surface, in the middle of the roller's length. `s` is the distance from an
//!   end face, into the body.
//! - Stress is positive in tension, pressure is positive in compression.
//! - Inside the solver lengths are in units of the Hertz half-width `C` and stresses in units of
//!   the Hertz maximum pressure `p0` (see [`base::HertzScales`]); names that end in `_m`, `_pa` or
//!   `_n` are in SI units.
//!
//! # Layers
//!
//! Each module imports only modules above it in this list; `tests/numerics/layering.rs` checks
//! that. `docs/architecture.md` shows the way of a case through them, and what to touch to add
//! something.
//!
//! | module | contents |
//! |---|---|
//! | [`base`] | materials, Hertz scales, axes, quadrature, the stress tensor, the error type |
//! | [`kernels`] | closed forms: deflection, Love's stresses, Hertz, loads of one wavenumber |
//! | [`body`] | a finite body's compliance per wavenumber, one file per edge model |
//! | [`contact`] | load-controlled contact of two bodies |
//! | [`stress`] | stresses at points, standard curves, critical points |
//! | [`fatigue`] | measures of fatigue on histories of stresses |
//! | `host` | complete files, locked folders, memory, child processes |
//! | [`cells`] | contact and stresses on uniform cells of constant pressure, the published method |
//! | [`case`](mod@case) | case and study files, their validation and expansion |
//! | [`solve`](mod@solve) | one case and one method to one [`solve::Solution`] |
//! | [`fem`] | the driver of gmsh, FEniCSx and CalculiX, and the reader of recorded curves |
//! | [`study`] | pairing of curves, errors, factorial effects, timing, gates |
//! | [`report`] | one file per form of output |
//! | [`explore`] | the page in the browser on which a case is changed, and its server |
//! | [`cli`] | one file per subcommand |

// The one exception is `host/system.rs`, which gives the reason.
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod base;
pub mod kernels;

pub mod body;

pub mod contact;

pub mod stress;

pub mod fatigue;

mod host;

pub mod cells;

pub mod case;

pub mod solve;

#[cfg(feature = "cli")]
pub mod fem;

#[cfg(feature = "cli")]
pub mod study;

#[cfg(feature = "cli")]
pub mod report;

#[cfg(feature = "cli")]
pub mod explore;

#[cfg(feature = "cli")]
pub mod cli;
