//! The skin of a body with a round surface: what lies between the surface and a tangent plane.
//!
//! A load's own field, behind its own tangent, carries the stresses xx, xy and yy along the surface
//! beside it. There, at the distance u across the contact, the surface lies g = u^2 / (2 R) below
//! the tangent, and the field has to do without this skin, whose membrane forces are g times those
//! stresses: to first order in C / R the flat body carries minus their divergence as tractions,
//! d/dx (g xx) + d/dy (g xy) along x and d/dx (g xy) + d/dy (g yy) along y. In plane strain there
//! are none: xx vanishes beside the load. Near a free end they keep their size from C to the length
//! of the body.
//!
//! With the amplitude S(k) of a stress under a unit load, g times it has the amplitude -S''(k) / (2
//! R). The tractions along y are written as pairs of forces, [`Direction::Apart`], of the
//! membrane's tension and the integral of what else acts along y: at a corner tensions vanish, but
//! steeply.
//!
//! The surface itself moves along its normal by u_z + g e_zz - (u / R) u_x, behind a load's own
//! tangent; the last two terms, with the displacement by the tractions, are what the round shape
//! adds to the compliance. In plane strain this is -pi (1 - 2 nu) / ((1 - nu) k^2): the surface
//! shrinks under the load, and is rounder there.
//!
//! All of this is a small part of the stresses, so that it has axes and wavenumbers of its own, few
//! where C / R is small beside the tolerance. Slopes along k ask for something else than the
//! solution's: that nothing is cut off at one wavenumber and not at the next.

use super::axes::Resolution;
use super::finite::Body;
use super::fold::Fold;
use super::part::Part;
use super::skin_waves::{BEFORE, NEAR_FACE, OnSurface, Skin, SkinCompliances};
use super::stack::Placed;
use crate::base::{Kink, Panels, Parity, Wavenumbers, spline};
use crate::kernels::wave::{Direction, WaveTable};
use nalgebra::DMatrix;
use std::f64::consts::PI;
use std::sync::Arc;

/// How finely a skin is resolved.
#[derive(Debug)]
struct Level {
    /// The largest error of pressures and stresses (p0 C / R) in straight scenes, 0.1 C and more
    /// from a corner.
    error: f64,
    /// The resolution, but for its smallest wavenumber.
    resolution: Resolution,
    /// Gauss nodes of a piece of a panel: pairs of forces have a stronger pole than loads.
    piece_nodes: usize,
    /// See [`Skins::nodes_per_e`].
    nodes_per_e: f64,
}

/// The coarsest resolution.
const COARSEST: Resolution = Resolution {
    order: 3,
    corner: 0.079,
    corner_ratio: 4.0,
    ratio: 2.8,
    modes: 0,
    spacing: [0.0; 2],
    k_max: 3.5,
    k_order: 2,
    k_across: 3.0,
    k_min: 0.0,
    k_ratio: 4.0,
    images: 1,
    face_reach: 9.0,
    reach: 7.0,
};

/// From the coarsest to the finest.
const LEVELS: [Level; 6] = [
    Level { error: 0.3, resolution: COARSEST, piece_nodes: 4, nodes_per_e: 0.3 },
    Level {
        error: 0.1,
        resolution: Resolution {
            order: 4,
            corner: 0.086,
            ratio: 2.6,
            k_max: 4.0,
            k_order: 2,
            k_ratio: 3.9,
            face_reach: 11.4,
            reach: 10.0,
            ..COARSEST
        },
        piece_nodes: 4,
        nodes_per_e: 0.35,
    },
    Level {
        error: 0.05,
        resolution: Resolution {
            order: 4,
            corner: 0.05,
            ratio: 2.5,
            k_max: 6.0,
            k_order: 3,
            k_ratio: 4.5,
            face_reach: 11.5,
            reach: 9.0,
            ..COARSEST
        },
        piece_nodes: 6,
        nodes_per_e: 0.6,
    },
    Level {
        error: 0.03,
        resolution: Resolution {
            order: 5,
            corner: 0.025,
            ratio: 2.7,
            k_max: 12.7,
            k_order: 5,
            k_ratio: 6.0,
            face_reach: 7.8,
            reach: 10.0,
            ..COARSEST
        },
        piece_nodes: 6,
        nodes_per_e: 1.7,
    },
    Level {
        error: 0.02,
        resolution: Resolution {
            order: 5,
            corner: 0.012,
            ratio: 2.5,
            k_max: 21.7,
            k_order: 5,
            k_ratio: 4.25,
            face_reach: 9.0,
            reach: 10.0,
            ..COARSEST
        },
        piece_nodes: 6,
        nodes_per_e: 1.8,
    },
    Level {
        error: 0.006,
        resolution: Resolution {
            order: 6,
            corner: 0.005,
            ratio: 2.4,
            k_max: 45.0,
            k_order: 5,
            k_ratio: 3.5,
            face_reach: 10.0,
            reach: 11.0,
            ..COARSEST
        },
        piece_nodes: 7,
        nodes_per_e: 2.2,
    },
];

/// Loads turn the bodies that they bend the more the longer the waves are: their errors are this
/// many times as large, and their wavenumbers grow no faster than this.
const BENDING_ERROR: f64 = 4.0;
const BENDING_RATIO: f64 = 3.0;

/// The largest panel at a corner of bodies that are pressed at one end alone: at the other one what
/// is even and what is odd about the middle has to cancel, of which coarser panels leave up to 10 C
/// / R p0 within 0.2 C.
const CANCELLING_CORNER: f64 = 0.005;

impl Level {
    /// The coarsest whose error (p0 C / R) is at most the `wanted` one.
    fn within(wanted: f64) -> &'static Self {
        let fine = LEVELS.iter().find(|level| level.error <= wanted);
        fine.unwrap_or(&LEVELS[LEVELS.len() - 1])
    }
}

/// The least wavenumber times a body's half-length that has a skin: under longer waves the body is
/// a plate whose surface carries no stress beside the load.
const LONGEST: f64 = 0.35;

/// The contact line of a skin.
#[derive(Debug, Clone, Copy)]
pub struct SkinLine<'a> {
    /// Its ends (C); the upper one alone counts if it is symmetric.
    pub ends: [f64; 2],
    /// The exponents of a pressure that grows towards them.
    pub exponents: [Option<f64>; 2],
    /// Kinks of the gap.
    pub kinks: &'a [Kink],
    /// Whether it is one half of a contact that is symmetric about y = 0.
    pub symmetric: bool,
    /// The least length (C) of its panels at corners.
    pub least_corner: f64,
}

/// The skin of a body at all wavenumbers.
#[derive(Debug)]
pub struct Skins {
    /// Place of the body's middle (C).
    pub middle: f64,
    /// The contact line.
    pub line: Panels,
    /// The same from the body's middle.
    pub fold: Fold,
    /// The body on axes of its own, for each part of the load.
    pub bodies: Vec<Body>,
    /// The wavenumbers; those of the first panel have no skin.
    pub wavenumbers: Wavenumbers,
    /// Nodes of interpolations of its stresses along lines, per factor e of the distance from what
    /// they vary with.
    pub nodes_per_e: f64,
    /// Stresses of loads along x and apart from lines along x.
    pub tables: [Arc<WaveTable>; 2],
    /// The loads on each of the bodies at each wavenumber from the second panel on.
    loads: Vec<Vec<Skin>>,
    /// What the skin of each body adds to the compliance at each of these wavenumbers.
    compliances: Vec<SkinCompliances>,
}

impl Skins {
    /// The skin of a body with free end faces and this C / R, for errors of about `error` (p0 C /
    /// R): beyond R from a load the surface is no longer near its tangent plane, and waves that
    /// long have no skin.
    pub fn new(
        line: SkinLine,
        Placed { middle, shape, end }: Placed,
        curvature: f64,
        error: f64,
    ) -> Self {
        let longest = (LONGEST / shape.half).max(curvature.abs());
        let SkinLine { ends, exponents, kinks, symmetric, least_corner } = line;
        let level = Level::within(if symmetric { error } else { error / BENDING_ERROR });
        let mut resolution = Resolution { k_min: longest, ..level.resolution };
        if !symmetric {
            resolution.k_ratio = resolution.k_ratio.min(BENDING_RATIO);
            let faces = [middle - shape.half, middle + shape.half];
            let [lower, upper] = [0, 1].map(|end| (faces[end] - ends[end]).abs() < NEAR_FACE);
            if lower != upper {
                resolution.corner = resolution.corner.min(CANCELLING_CORNER);
            }
        }
        resolution.corner = resolution.corner.max(least_corner);
        let (line, _) = resolution.contact_line(ends, exponents, kinks, symmetric);
        let fold = Fold::new(&line, middle, symmetric);
        let coarse = wavenumbers(&resolution, longest);
        let first = resolution.k_order;
        let k = &coarse.nodes()[first - BEFORE..];
        let tables = [Direction::Along, Direction::Apart]
            .map(|direction| WaveTable::shared(direction, shape.nu));
        let bends = fold.parities().contains(&Parity::Odd);
        let body = |&parity: &Parity| {
            let part = Part { parity, bends, slides: false };
            Body::with_pieces(fold.axis(), shape, end, part, &resolution, level.piece_nodes)
        };
        let bodies: Vec<Body> = fold.parities().iter().map(body).collect();
        let of_body = |body: &Body| OnSurface::new(body, k).skins(&tables);
        let (loads, compliances) = bodies.iter().map(of_body).unzip();
        let wavenumbers = Wavenumbers::new(coarse, resolution.k_across);
        let nodes_per_e = level.nodes_per_e;
        Self { middle, line, fold, bodies, wavenumbers, nodes_per_e, tables, loads, compliances }
    }

    /// The loads on body number `part` at coarse wavenumber number `i`; none of the first panel.
    pub fn loads(&self, part: usize, i: usize) -> Option<&Skin> {
        self.loads[part].get(i.checked_sub(self.wavenumbers.coarse().order())?)
    }

    /// The least wavenumber that has a skin.
    pub fn longest(&self) -> f64 {
        self.wavenumbers.coarse().breaks()[1]
    }

    /// Adds `factor` times what the skin adds to the compliance at each of the wavenumbers `k` to
    /// its matrix of `totals`, over the nodes of another `axis` of the line.
    pub fn add_compliances(
        &self,
        k: &[f64],
        factor: f64,
        axis: &Panels,
        totals: &mut [DMatrix<f64>],
    ) {
        let known = self.known();
        let mut onto = DMatrix::<f64>::zeros(self.line.len(), axis.len());
        for (i, y) in self.line.nodes().iter().enumerate() {
            axis.load_interpolation(*y).for_each(|(j, w)| onto[(i, j)] += w);
        }
        let mut back = DMatrix::<f64>::zeros(axis.len(), self.line.len());
        for (i, y) in axis.nodes().iter().enumerate() {
            self.line.interpolation(*y).for_each(|(j, w)| back[(i, j)] += w);
        }
        for (&k, total) in k.iter().zip(totals) {
            if k > known[known.len() - 1] {
                let plane = factor * plane(self.bodies[0].nu, k);
                (0..axis.len()).for_each(|i| total[(i, i)] += plane);
            } else {
                let mut sum = DMatrix::zeros(self.line.len(), self.line.len());
                for (body, compliances) in self.bodies.iter().zip(&self.compliances) {
                    self.fold.add(body.parity, &compliances.at(known, k), factor, &mut sum);
                }
                *total += &back * (sum * &onto);
            }
        }
    }

    /// [`Skins::add_compliances`] less the same of a half-space, on which the load is mirrored in
    /// the planes of the end faces. What is left is smooth along the line: it is interpolated by a
    /// spline, so that nothing jumps from one panel to the next.
    pub fn add_compliances_of_ends(
        &self,
        k: &[f64],
        factor: f64,
        axis: &Panels,
        totals: &mut [DMatrix<f64>],
    ) {
        let coarse = self.wavenumbers.coarse();
        let waves = &coarse.nodes()[coarse.order() - BEFORE..];
        let known = self.known();
        let line = self.fold.axis();
        for (body, free) in self.bodies.iter().zip(&self.compliances) {
            let (_, mirrored) = OnSurface::mirrored(body, waves).skins(&self.tables);
            let back = self.splines(axis, body.parity);
            // Of the density of a load: an even or odd part carries half of what acts on a side.
            let share = if self.fold.parities().len() == 1 { factor } else { 0.5 * factor };
            let onto = DMatrix::from_fn(line.len(), axis.len(), |i, j| {
                share * back[(j, i)] * axis.weights()[j] / line.weights()[i]
            });
            for (&k, total) in k.iter().zip(totals.iter_mut()) {
                if k <= known[known.len() - 1] {
                    *total += &back * ((free.at(known, k) - mirrored.at(known, k)) * &onto);
                }
            }
        }
    }

    /// The wavenumbers that have a skin.
    fn known(&self) -> &[f64] {
        let coarse = self.wavenumbers.coarse();
        &coarse.nodes()[coarse.order()..]
    }

    /// A part of a function, from the nodes of the folded line to those of an `axis` along the
    /// contact.
    fn splines(&self, axis: &Panels, parity: Parity) -> DMatrix<f64> {
        let line = self.fold.axis();
        let (n, sign) = (line.len(), parity.sign());
        // Where the line begins at the body's middle it goes on behind it.
        let behind = if line.breaks()[0] == 0.0 { n } else { 0 };
        let before = line.nodes()[..behind].iter().rev().map(|y| -y);
        let nodes: Vec<f64> = before.chain(line.nodes().iter().copied()).collect();
        let places: Vec<f64> = axis.nodes().iter().map(|y| (y - self.middle).abs()).collect();
        let all = spline(&nodes, &places);
        let mut folded = all.columns(behind, n).into_owned();
        for i in 0..behind {
            folded.column_mut(i).axpy(sign, &all.column(behind - 1 - i), 1.0);
        }
        for (mut row, y) in folded.row_iter_mut().zip(axis.nodes()) {
            if *y < self.middle {
                row *= sign;
            }
        }
        folded
    }
}

/// Panels of wavenumbers: one without a skin up to the `longest` wave's, then such that grow.
fn wavenumbers(resolution: &Resolution, longest: f64) -> Panels {
    let most = resolution.k_max / longest;
    let panels = (most.ln() / resolution.k_ratio.ln()).ceil().max(1.0);
    let breaks = (0..=panels as i32).map(|i| longest * most.powf(f64::from(i) / panels));
    Panels::new([0.0].into_iter().chain(breaks).collect(), resolution.k_order)
}

/// What a round surface adds to the compliance in plane strain, per C / R.
fn plane(nu: f64, k: f64) -> f64 {
    -PI * (1.0 - 2.0 * nu) / ((1.0 - nu) * k * k)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{EdgeModel, Shape};
    use crate::kernels::round;
    use nalgebra::DVector;

    /// Waves along the line are waves of a mirrored half-space, those of the forces of [`round`];
    /// slopes along k are accurate to some percent.
    #[test]
    fn a_mirrored_skin_has_the_compliance_of_forces() {
        let (half, nu) = (3.0, 0.3);
        let (shape, end) = (Shape { half, nu }, EdgeModel::QuarterSpace.end(nu, None));
        let ends = [-half, half];
        let (exponents, kinks) = ([None; 2], &[]);
        let line = SkinLine { ends, exponents, kinks, symmetric: true, least_corner: 0.0 };
        let skins = Skins::new(line, Placed { middle: 0.0, shape, end }, 0.03, 0.03);
        let axis = &skins.line;
        for (k, waves) in [(0.6, 0.0), (1.7, 0.0), (0.6, 1.0), (1.7, 1.0), (1.7, 2.0)] {
            let [mut all, mut of_ends] = [0; 2].map(|_| [DMatrix::zeros(axis.len(), axis.len())]);
            skins.add_compliances(&[k], 1.0, axis, &mut all);
            skins.add_compliances_of_ends(&[k], 1.0, axis, &mut of_ends);
            let [all, of_ends] = [&all[0], &of_ends[0]];
            let l = waves * PI / half;
            let wave =
                DVector::from_iterator(axis.len(), axis.nodes().iter().map(|y| (l * y).cos()));
            let weighted = wave.component_mul(&DVector::from_column_slice(axis.weights()));
            let got = weighted.dot(&((all - of_ends) * &wave)) / weighted.dot(&wave);
            let want = PI * round::wave(k, l, nu);
            let limit = if l == 0.0 { 1e-3 } else { 0.1 };
            assert!((got / want - 1.0).abs() < limit, "{k} {l}: {got} {want}");
        }
    }
}
