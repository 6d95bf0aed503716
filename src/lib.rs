//! Contact pressure and stresses at the ends of finite line contacts.
//!
//! A cylindrical roller is pressed on a rectangular block; both end in free faces. The library
//! solves the frictionless contact and the stress fields of both bodies semi-analytically and
//! holds the harness that compares them with finite elements.
//!
//! # Conventions
//!
//! - Axes: `x` across the contact, `y` along the contact line, `z` into the body at hand; the
//!   origin is the centre of the contact. `s` is the distance from an end face, into the body.
//! - Stress is positive in tension, pressure is positive in compression.
//! - Inside the solver lengths are in units of the Hertz half-width `C` and stresses in units of
//!   the Hertz maximum pressure `p0` (see [`base::HertzScales`]); names that end in `_m`, `_pa` or
//!   `_n` are in SI units.
//!
//! # Layers
//!
//! Each module imports only modules above it in this list; `tests/numerics/layering.rs` checks that.
//! `docs/architecture.md` shows the way of a case through them, and what to touch to add something.
//!
//! | module | what lives there |
//! |---|---|
//! | [`base`] | materials, Hertz scales, axes, quadrature, the stress tensor, the error type |
//! | [`kernels`] | closed forms: deflection, Love's stresses, Hertz, loads of one wavenumber |
//! | [`body`] | a finite body's compliance per wavenumber, one file per edge model |
//! | [`contact`] | load-controlled contact of two bodies |
//! | [`stress`] | stresses at points, standard curves, critical points |
//! | `host` | files that appear whole or not at all, locked folders, memory, child processes |
//! | [`case`](mod@case) | case and study files, their validation and expansion |
//! | [`solve`](mod@solve) | one case and one method to one [`solve::Solution`] |
//! | [`fem`] | the driver of gmsh and FEniCSx, and the reader of recorded curves |
//! | [`study`] | pairing of curves, errors, factorial effects, timing, gates |
//! | [`report`] | one file per form of output |
//! | [`cli`] | one file per subcommand |

// The one exception is `host/system.rs`, which says why.
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod base;
pub mod kernels;

pub mod body;

pub mod contact;

pub mod stress;

mod host;

pub mod case;

pub mod solve;

#[cfg(feature = "cli")]
pub mod fem;

#[cfg(feature = "cli")]
pub mod study;

#[cfg(feature = "cli")]
pub mod report;

#[cfg(feature = "cli")]
pub mod cli;
