//! A body that ends at y = -H and y = +H, as a set of layers, one per wavenumber across the
//! contact.
//!
//! Symmetry: pressures are even in x, and even or odd in y about the body's middle, so only y >= 0
//! is stored; the loads q on the two end faces are equal or opposite, and even in z. Lengths are in
//! units of C. A layer's displacement is f p with u = (1 - nu^2)/(pi E) f p, so a half-space's f is
//! 2 K0(k |y|).

use super::axes::{Edge, PLATE_FADES, Resolution};
use super::end::End;
use super::part::Part;
use super::stencil::{Image, PIECE_NODES, Peak, Sources, Stencil};
use crate::base::{Corner, Growth, Panels, Parity, StressTensor, ledge, linear, worse};
use crate::kernels::bessel::k0;
use crate::kernels::bessel_table::k0_of_all;
use crate::kernels::plate;
use crate::kernels::wave::{Direction, WaveTable, WwPlaces};
use nalgebra::{DMatrix, Dyn, Matrix, Storage};
use std::f64::consts::PI;
use std::ops::Range;
use std::sync::Arc;

/// A finite body: everything that does not depend on the wavenumber.
#[derive(Debug, Clone)]
pub struct Body {
    /// Half-length along y.
    pub half: f64,
    /// Poisson's ratio.
    pub nu: f64,
    /// The treatment of its end faces.
    pub end: End,
    /// The part of the loads that it carries.
    pub parity: Parity,
    /// Axis of the surface pressure P that acts on the half-space: the contact and, for freed end
    /// faces, the surface up to the end face.
    pub surface: Sources,
    /// Axis of the depth along an end face.
    pub face: Sources,
    /// Stresses of line loads in this body's material.
    pub kernel: Arc<WaveTable>,
    /// The same of loads along x; none without a traction along x.
    pub along: Option<Arc<WaveTable>>,
    /// Images of the surface axis for the displacement, including itself and its mirror image in y
    /// = 0.
    images: Vec<Image>,
    /// The same for the stresses: an image weighted by psi has its full weight here.
    stress_images: Vec<Image>,
    /// Nodes of `surface` that belong to the contact.
    contact: Range<usize>,
    /// Uniform strips beyond the images, which carry the mean of P: |y| and weight of quadrature
    /// points.
    strips: Vec<(f64, f64)>,
    face_wavenumbers: Panels,
    resolution: Resolution,
    compliance_stencils: Vec<Stencil>,
    to_face: Vec<(Stencil, WwPlaces)>,
    /// The strips behind y = 0, seen from the face's nodes.
    strips_to_face: Vec<WwPlaces>,
    from_faces: Vec<[(Stencil, WwPlaces); 2]>,
    reach: f64,
    /// Distance from the contact's end to the end face.
    ledge: f64,
    cosines: DMatrix<f64>,
}

/// A body at one wavenumber.
#[derive(Debug, Clone)]
pub struct Layer {
    /// Surface displacement f at the contact nodes per contact pressure at the contact nodes.
    pub compliance: DMatrix<f64>,
    /// The loads that free the end faces; none if the effect of the end is negligible, and for
    /// models without q, where P is the contact pressure.
    pub ends: Option<FreeEnds>,
    /// Condition number of the system solved for them, in the column-sum norm over what the
    /// contact's nodes load it with; 1 without a system, infinite if it could not be solved.
    pub condition: f64,
}

/// The loads that free the end faces of a body at one wavenumber: q on the faces, and P = p - T_yz
/// q on the surface under the contact pressure p.
#[derive(Debug, Clone)]
pub struct FreeEnds {
    /// T_yz: compressive stress zz at the surface nodes per q at the face nodes.
    pub from_face: DMatrix<f64>,
    /// q at the face nodes per contact pressure.
    pub face: DMatrix<f64>,
    /// q under a traction along x at the contact nodes in place of the pressure, in the phase in
    /// which the stress across the contact varies: sin(k x) where the traction is cos(k x). None
    /// without such a traction. P is - T_yz q.
    pub under_traction: Option<DMatrix<f64>>,
}

/// Wavenumber times half-length up to which odd loads bend the body: q moves the surface as
/// 1 / k^2.
const BENT: f64 = 1.0;

/// The matrices between the surface and the end faces of a body at one wavenumber.
///
/// Loads on the surface of the half-space and their images leave the compressive stress b on the
/// end faces. P and q free the faces of it where P + T_yz q = 0 and T_zy P + q + b = 0. One of both
/// taken out, these are (I - T_zy T_yz) q = -b or (I - T_yz T_zy) P = T_yz b.
pub(super) struct Faces {
    /// T_zy: compressive stress yy at the face nodes per P at the surface nodes.
    pub to: DMatrix<f64>,
    /// T_yz: compressive stress zz at the surface nodes per q at the face nodes.
    pub from: DMatrix<f64>,
    /// Those of the surface nodes that the faces reach, which are the last ones.
    near: Range<usize>,
    /// Whether the body bends. Then only the equations of P stay of the second kind.
    bends: bool,
}

impl Faces {
    /// Those of a `body` at the wavenumber `k`.
    pub fn new(body: &Body, k: f64) -> Self {
        let to = body.surface_matrix(k, &body.kernel);
        let from = body.faces_matrix(k, to.nrows());
        let n = from.nrows();
        let first_row = |first: usize, column: &[f64]| leading_zeros(&column[..first]);
        let to_first = leading_zeros(to.as_slice()) / to.nrows().max(1);
        let first = from.as_slice().chunks_exact(n).fold(to_first.min(n), first_row);
        let bends = body.parity == Parity::Odd && k * body.half < BENT;
        Self { to, from, near: first..n, bends }
    }

    /// q that frees the faces of the stresses `left` on them, a column for each load, and the
    /// condition number of its equations; none if they have no solution.
    pub fn freed(&self, left: &DMatrix<f64>) -> Option<(DMatrix<f64>, f64)> {
        // Short waves of distant nodes leave nothing.
        let is_loaded = |j: &usize| left.column(*j).iter().any(|b| *b != 0.0);
        let loaded: Vec<usize> = (0..left.ncols()).filter(is_loaded).collect();
        let b = left.select_columns(&loaded);
        // The faces have fewer nodes than the contact lines of most real rollers.
        let (of_loaded, condition) = if self.bends {
            let (p, condition) = solved(difference(&self.from, &self.to), &self.from * &b)?;
            (-(b + &self.to * p), condition)
        } else {
            let to = self.to.columns_range(self.near.clone());
            solved(difference(&to, &self.from.rows_range(self.near.clone())), -b)?
        };
        let mut q = DMatrix::zeros(left.nrows(), left.ncols());
        loaded.iter().zip(of_loaded.column_iter()).for_each(|(j, own)| q.set_column(*j, &own));
        Some((q, condition))
    }

    /// Adds to `sum`, per load, what P = - T_yz q moves under the loads `q` on the faces:
    /// `of_surface` is what P at the surface nodes moves.
    pub fn add_under(&self, of_surface: &DMatrix<f64>, q: &DMatrix<f64>, sum: &mut DMatrix<f64>) {
        let near = of_surface.columns_range(self.near.clone());
        // For short waves these are the last nodes alone.
        let rows = near
            .column_iter()
            .fold(near.nrows(), |first, column| leading_zeros(&column.as_slice()[..first]));
        let columns = leading_zeros(q.as_slice()) / q.nrows().max(1);
        let per_load = near.rows_range(rows..) * self.from.rows_range(self.near.clone());
        let mut own = sum.view_range_mut(rows.., columns..);
        own.gemm(-1.0, &per_load, &q.columns_range(columns..), 1.0);
    }
}

/// Number of entries before the first that is not zero.
fn leading_zeros(entries: &[f64]) -> usize {
    entries.iter().take_while(|entry| **entry == 0.0).count()
}

/// I - `left` `right`.
fn difference<A: Storage<f64, Dyn, Dyn>, B: Storage<f64, Dyn, Dyn>>(
    left: &Matrix<f64, Dyn, Dyn, A>,
    right: &Matrix<f64, Dyn, Dyn, B>,
) -> DMatrix<f64> {
    let mut difference = DMatrix::identity(left.nrows(), left.nrows());
    difference.gemm(-1.0, left, right, 1.0);
    difference
}

/// The solution of a `system` of equations for some `right` sides, and its condition number in the
/// column-sum norm over these.
fn solved(system: DMatrix<f64>, right: DMatrix<f64>) -> Option<(DMatrix<f64>, f64)> {
    let sums = |matrix: &DMatrix<f64>| -> Vec<f64> {
        matrix.column_iter().map(|column| column.lp_norm(1)).collect()
    };
    let (norm, before) = (sums(&system).into_iter().fold(0.0, worse), sums(&right));
    let solution = linear::solve(system, right)?;
    let grown = sums(&solution).into_iter().zip(before).map(|(after, before)| after / before);
    Some((solution, norm * grown.fold(0.0, worse)))
}

/// The length and the material of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// Half-length of the body (C).
    pub half: f64,
    /// Poisson's ratio.
    pub nu: f64,
}

/// 186 zeta(5) / pi^5: the part of its torsional stiffness that a rectangle lacks, in thicknesses
/// over widths.
const TWIST: f64 = 0.630_249;

impl Shape {
    /// The wavenumber k times the turn of the body by a unit moment under waves far longer than it
    /// is, in the compliance's unit: Kirchhoff's plate between two free faces, loaded on its edge.
    pub fn turned(&self) -> f64 {
        3.0 * PI / (self.half.powi(3) * (1.0 - self.nu) * (3.0 + self.nu))
    }

    /// How much farther the plate turns under shorter waves, as a part of [`Shape::turned`] per k
    /// times the half-length: Kirchhoff's edge is too stiff in torsion. A rectangle lacks a part
    /// 0.63 of the thickness over the width, half of it at either edge (Saint-Venant;
    /// Timoshenko and Goodier, Theory of Elasticity, 1970, Art. 109).
    pub fn twisted(&self) -> f64 {
        4.0 * TWIST / (3.0 + self.nu)
    }

    /// The wavenumber k times the body's displacement by a unit load under waves far longer than it
    /// is, in the compliance's unit: plane stress.
    pub fn moved(&self) -> f64 {
        PI / (self.half * (1.0 - self.nu * self.nu))
    }

    /// The wavenumber k times the displacement of free ends' long waves, at `y` from the body's
    /// middle, under a `load` and its `moment` about the middle.
    pub fn as_plate(&self, load: f64, moment: f64, y: f64) -> f64 {
        self.moved() * load + self.turned() * moment * y
    }
}

/// Shares of the last images of an alternating series, which close it (Euler's transformation of
/// fifth order).
const CLOSING: [f64; 5] = [31.0 / 32.0, 26.0 / 32.0, 16.0 / 32.0, 6.0 / 32.0, 1.0 / 32.0];

/// A load at s >= 0 and its other half at -s, and their images in the end faces of a body.
///
/// Even loads have the period 2 H of the body's length, and strips replace the images beyond the
/// last. Odd loads change sign from one length to the next; [`CLOSING`] shares of five more images
/// close their series.
fn images(half: f64, end: &End, parity: Parity, resolution: &Resolution) -> Vec<Image> {
    let image = |lengths: i32, weight: f64| {
        let shift = 2.0 * half * f64::from(lengths);
        let weight = if lengths % 2 == 0 { weight } else { parity.sign() * weight };
        [
            Image { sign: 1.0, shift, weight },
            Image { sign: -1.0, shift, weight: parity.sign() * weight },
        ]
    };
    let mut images = image(0, 1.0).to_vec();
    let Some(weight) = end.image_weight else { return images };
    let closing: &[f64] = if end.freed && parity == Parity::Odd { &CLOSING } else { &[] };
    let full = if end.freed { resolution.images } else { 1 };
    let weights = (0..full).map(|_| 1.0).chain(closing.iter().copied());
    for (n, share) in (1..).zip(weights) {
        let weight = share * weight;
        images.extend([-n, n].into_iter().flat_map(|lengths| image(lengths, weight)));
    }
    images
}

/// The least distance from an edge, in the lengths of the panel there.
const BESIDE: f64 = 1e-3;

impl Body {
    /// A body of this `shape` with end faces `end`, under one `part` of the loads on `contact`, an
    /// axis on one side of the body's middle.
    pub fn new(
        contact: &Panels,
        shape: Shape,
        end: End,
        part: Part,
        resolution: &Resolution,
    ) -> Self {
        let piece_nodes = resolution.order.max(PIECE_NODES);
        Self::with_pieces(contact, shape, end, part, resolution, piece_nodes)
    }

    /// The same, with `piece_nodes` Gauss nodes on pieces of panels.
    pub(super) fn with_pieces(
        contact: &Panels,
        shape: Shape,
        end: End,
        part: Part,
        resolution: &Resolution,
        piece_nodes: usize,
    ) -> Self {
        let Shape { half, nu } = shape;
        let Part { parity, slides, .. } = part;
        let edge = Edge::new(contact, half, part);
        let surface =
            if end.freed { resolution.body_axis(contact, half, edge) } else { contact.clone() };
        let first = surface.nodes().partition_point(|y| *y < contact.breaks()[0]);
        let ledge = ledge(half - contact.end(), half);
        let contact = first..first + contact.len();
        let face = resolution.face_axis(ledge, half, parity, edge);
        let [face, surface] = [face, surface].map(|axis| Sources::new(axis, piece_nodes));
        let images = images(half, &end, parity, resolution);
        // An image that the displacement weighs has its full weight in the stresses.
        let full = End { image_weight: end.image_weight.map(|_| 1.0), ..end };
        let stress_images = self::images(half, &full, parity, resolution);
        let mut body = Self {
            half,
            stress_images,
            nu,
            end,
            parity,
            face_wavenumbers: resolution.face_wavenumbers(half, parity),
            resolution: *resolution,
            contact: contact.clone(),
            images,
            strips: Vec::new(),
            compliance_stencils: Vec::new(),
            to_face: Vec::new(),
            strips_to_face: Vec::new(),
            from_faces: Vec::new(),
            kernel: WaveTable::shared(Direction::Into, nu),
            along: slides.then(|| WaveTable::shared(Direction::Along, nu)),
            reach: resolution.reach,
            ledge,
            cosines: DMatrix::zeros(0, 0),
            surface,
            face,
        };
        body.compliance_stencils = body.surface.axis.nodes()[contact]
            .iter()
            .map(|&y| {
                let shortest = 2.0 / resolution.k_max;
                Stencil::new(&body.surface, &body.images, y, 0.0, shortest, Peak::Logarithm)
            })
            .collect();
        if end.freed {
            body.prepare_faces();
        }
        body
    }

    /// Stencils between the surface and the end faces, the strips and the plate's transforms.
    fn prepare_faces(&mut self) {
        let half = self.half;
        let near = (2 * self.resolution.images + 1) as f64 * half;
        let mut breaks = vec![near];
        let mut last = near;
        let deepest = self.face.axis.end();
        while last < near + deepest {
            last *= 2.5;
            breaks.push(last);
        }
        if self.parity == Parity::Even {
            let strip = Panels::new(breaks, self.resolution.order);
            let nodes = strip.nodes().iter().copied();
            self.strips = nodes.zip(strip.weights().iter().copied()).collect();
        }
        // Everything is even about the face: the images behind it double those before it.
        let before: Vec<Image> = self
            .images
            .iter()
            .filter(|i| i.shift <= 0.0)
            .map(|i| Image { weight: 2.0 * i.weight, ..*i })
            .collect();
        let with_places = |from: &Sources, images: &[Image], along: f64, depth: f64| {
            let stencil = Stencil::new(from, images, along, depth, 0.0, Peak::Kink);
            let places = WwPlaces::new(stencil.offsets(), depth);
            (stencil, places)
        };
        self.to_face = self
            .face
            .axis
            .nodes()
            .iter()
            .map(|&z| with_places(&self.surface, &before, half, z))
            .collect();
        let offsets: Vec<f64> = self.strips.iter().map(|(s, _)| half + s).collect();
        self.strips_to_face =
            self.face.axis.nodes().iter().map(|&z| WwPlaces::new(&offsets, z)).collect();
        let both = |load: f64| [Image { sign: 1.0, shift: 0.0, weight: 2.0 * load }];
        let loads = self.face_loads();
        self.from_faces = self
            .surface
            .axis
            .nodes()
            .iter()
            .map(|&y| {
                let side = |(depth, load)| with_places(&self.face, &both(load), 0.0, depth);
                [(half - y, loads[0]), (half + y, loads[1])].map(side)
            })
            .collect();
        self.cosines = self.face_cosines();
    }

    /// Cosine transforms over the depth of the face's loads: a row for each of the face's
    /// wavenumbers, over its nodes.
    fn face_cosines(&self) -> DMatrix<f64> {
        let (face, axis) = (&self.face.axis, &self.face_wavenumbers);
        let order = face.order();
        let mut cosines = DMatrix::zeros(axis.len(), face.len());
        let mut moments = vec![0.0; order];
        for (row, &l) in axis.nodes().iter().enumerate() {
            for panel in 0..face.panel_count() {
                face.cosine_moments(panel, l, &mut moments);
                for (i, m) in moments.iter().enumerate() {
                    cosines[(row, panel * order + i)] = 2.0 * m;
                }
            }
        }
        cosines
    }

    /// The loads of the faces at +H and -H in units of q.
    fn face_loads(&self) -> [f64; 2] {
        [1.0, self.parity.sign()]
    }

    /// Stencils from the loads of the faces at +H and -H, both even in z, to the point (`y`, `z`).
    pub fn face_stencils(&self, y: f64, z: f64) -> [Stencil; 2] {
        let loads = self.face_loads();
        [(self.half - y, loads[0]), (self.half + y, loads[1])].map(|(depth, load)| {
            let image = |sign, weight| Image { sign, shift: 0.0, weight };
            // At z = 0 both halves of the even load have the same effect.
            let (one, both) = ([image(1.0, 2.0 * load)], [image(1.0, load), image(-1.0, load)]);
            let images: &[Image] = if z == 0.0 { &one } else { &both };
            self.stress_stencil(&self.face, images, z, depth)
        })
    }

    /// Stencil from the load on the surface to the point (`y`, `z`), for stresses.
    pub fn surface_stencil(&self, y: f64, z: f64) -> Stencil {
        self.stress_stencil(&self.surface, &self.stress_images, y, z)
    }

    /// On a loaded surface itself the stress kernels vary only over lengths of 1/k.
    fn stress_stencil(&self, from: &Sources, images: &[Image], along: f64, depth: f64) -> Stencil {
        Stencil::new(from, images, along, depth, 2.0 / self.resolution.k_max, Peak::Kink)
    }

    /// The least distance from the edge (C) at which stresses on the surface are those of the loads
    /// there. At the edge itself those of both faces have no limit, only their sum has one.
    pub fn beside_edge(&self) -> f64 {
        let (axis, last) = (&self.surface.axis, self.surface.axis.panel_count() - 1);
        let [from, to] = axis.panel(last);
        let grows = |corner: Corner| corner.side < 0.0 && corner.growth == Growth::Logarithm;
        if axis.corner_of(last).is_some_and(grows) { BESIDE * (to - from) } else { 0.0 }
    }

    /// The nodes of `surface` that belong to the contact.
    pub fn contact(&self) -> Range<usize> {
        self.contact.clone()
    }

    /// Number of face nodes within the reach of a wavenumber.
    pub fn face_len(&self, k: f64) -> usize {
        let deepest = self.resolution.face_reach / k;
        let face = &self.face.axis;
        let panels = (0..face.panel_count()).take_while(|&i| face.panel(i)[0] < deepest).count();
        panels * face.order()
    }

    /// Whether the plate's part beyond its two half-spaces matters at wavenumber `k`.
    fn plate_matters(&self, k: f64) -> bool {
        k * self.half < PLATE_FADES
    }

    /// Distance beyond which loads of wavenumber `k` are negligible.
    pub fn reach(&self, k: f64) -> f64 {
        self.reach / k
    }

    /// Calls `act(offset, weight)` for the quadrature points of the uniform strips that reach (`y`,
    /// `depth`) at wavenumber `k`.
    pub fn for_strips(&self, k: f64, y: f64, depth: f64, mut act: impl FnMut(f64, f64)) {
        let reach = self.reach(k);
        for &(s, w) in &self.strips {
            // Ascending in s: the nearer end decides.
            if s - y.abs() > reach {
                break;
            }
            for u in [y - s, y + s] {
                if u * u + depth * depth < reach * reach {
                    act(u, w);
                }
            }
        }
    }

    /// Largest number of calls by [`Body::for_strips`].
    pub fn most_strips(&self) -> usize {
        2 * self.strips.len()
    }

    /// The body at wavenumber `k` > 0.
    pub fn layer(&self, k: f64) -> Layer {
        let displacement = self.displacement(k);
        let mut compliance = displacement.columns_range(self.contact()).into_owned();
        // An end face beyond the reach of this wavenumber carries no load.
        if !self.end.freed || self.ledge > self.reach(k) {
            return Layer { compliance, ends: None, condition: 1.0 };
        }
        let faces = Faces::new(self, k);
        let columns = self.contact.len();
        let mut left = faces.to.columns_range(self.contact()).into_owned();
        if let Some(along) = &self.along {
            let own = self.surface_matrix(k, along);
            left.resize_horizontally_mut(2 * columns, 0.0);
            left.columns_range_mut(columns..).copy_from(&own.columns_range(self.contact()));
        }
        let Some((mut face, condition)) = faces.freed(&left) else {
            return Layer { compliance, ends: None, condition: f64::INFINITY };
        };
        let under_traction =
            self.along.is_some().then(|| face.columns_range(columns..).into_owned());
        face.resize_horizontally_mut(columns, 0.0);
        faces.add_under(&displacement, &face, &mut compliance);
        let ends = FreeEnds { from_face: faces.from, face, under_traction };
        Layer { compliance, ends: Some(ends), condition }
    }

    /// Displacement f at the contact nodes per P.
    pub(super) fn displacement(&self, k: f64) -> DMatrix<f64> {
        let mut displacement =
            Rows::new(&self.surface, self.compliance_stencils.len(), self.surface.axis.len());
        let reach = self.reach(k);
        let mut values = Vec::new();
        for (i, stencil) in self.compliance_stencils.iter().enumerate() {
            displacement.push(|charges, nodes| {
                k0_of_all(k, stencil.offsets(), reach, &mut values);
                stencil.add_row(&values, charges, nodes);
                let mut strips = 0.0;
                let y = self.surface.axis.nodes()[self.contact.start + i];
                self.for_strips(k, y, 0.0, |u, w| strips += w * k0(k * u.abs()));
                self.add_mean(strips, nodes);
            });
        }
        // f = 2 K0.
        2.0 * displacement.finish()
    }

    /// Adds the effect of strips of unit pressure to a row over the surface's nodes; they carry the
    /// mean.
    pub(super) fn add_mean(&self, strips: f64, row: &mut [f64]) {
        if strips != 0.0 {
            for (r, w) in row.iter_mut().zip(self.surface.axis.weights()) {
                *r += strips * w / self.half;
            }
        }
    }

    /// Compressive stress across the loaded line of a unit load of `kernel` at each of `places`,
    /// into `values`.
    fn press(&self, kernel: &WaveTable, k: f64, places: &WwPlaces, values: &mut Vec<f64>) {
        kernel.ww(k, places, self.reach(k), values);
        values.iter_mut().for_each(|v| *v = -*v);
    }

    /// Compressive stress yy on the end face per load of `kernel` on the surface: T_zy per P, T_sy
    /// per traction along x.
    pub(super) fn surface_matrix(&self, k: f64, kernel: &WaveTable) -> DMatrix<f64> {
        let rows = self.face_len(k);
        let mut matrix = Rows::new(&self.surface, rows, self.surface.axis.len());
        let mut values = Vec::new();
        let faces = self.to_face.iter().zip(&self.strips_to_face).take(rows);
        for (i, ((stencil, places), strips)) in faces.enumerate() {
            let z = self.face.axis.nodes()[i];
            matrix.push(|charges, nodes| {
                if k * z > self.reach {
                    return;
                }
                self.press(kernel, k, places, &mut values);
                stencil.add_row(&values, charges, nodes);
                self.press(kernel, k, strips, &mut values);
                // The strip behind y = 0 and its mirror image in the face.
                let strip: f64 = values.iter().zip(&self.strips).map(|(v, (_, w))| v * w).sum();
                self.add_mean(2.0 * strip, nodes);
            });
        }
        matrix.finish()
    }

    /// T_yz: compressive stress zz on z = 0 per q on both end faces.
    pub(super) fn faces_matrix(&self, k: f64, columns: usize) -> DMatrix<f64> {
        let n = self.surface.axis.len();
        let mut matrix = Rows::new(&self.face, n, columns);
        let mut values = Vec::new();
        for (i, stencils) in self.from_faces.iter().enumerate() {
            let y = self.surface.axis.nodes()[i];
            matrix.push(|charges, nodes| {
                for ((stencil, places), depth) in
                    stencils.iter().zip([self.half - y, self.half + y])
                {
                    if k * depth < self.reach {
                        self.press(&self.kernel, k, places, &mut values);
                        stencil.add_row(&values, charges, nodes);
                    }
                }
            });
        }
        let mut matrix = matrix.finish();
        if self.plate_matters(k) {
            let axis = &self.face_wavenumbers;
            let waves = self.plate_waves(k);
            let plate = DMatrix::from_fn(n, axis.len(), |i, m| {
                let weight = axis.weights()[m] / PI;
                -weight * waves[m].at(self.surface.axis.nodes()[i])[2]
            });
            matrix += plate * self.cosines.columns(0, columns);
        }
        matrix
    }

    /// The plate's remainder at its wavenumbers; empty if it is negligible.
    pub fn plate_waves(&self, k: f64) -> Vec<plate::Remainder> {
        if !self.plate_matters(k) {
            return Vec::new();
        }
        let wave = |l: &f64| plate::Remainder::new(self.parity, self.half, self.nu, k, *l);
        self.face_wavenumbers.nodes().iter().map(wave).collect()
    }

    /// The plate's remainder at `y` per unit of each entry of [`Body::plate_transform`], in the
    /// components of [`plate::Remainder::at`], from its [`Body::plate_waves`].
    pub fn plate_kernel(&self, waves: &[plate::Remainder], y: f64) -> Vec<[f64; 6]> {
        let terms = waves.iter().zip(self.face_wavenumbers.weights());
        terms.map(|(wave, w)| wave.at(y).map(|s| w / PI * s)).collect()
    }

    /// Sines and cosines of the plate's wavenumbers at the depth `z`.
    pub fn plate_phases(&self, z: f64) -> Vec<(f64, f64)> {
        self.face_wavenumbers.nodes().iter().map(|l| (l * z).sin_cos()).collect()
    }

    /// Amplitudes of the plate's remainder, from [`Body::plate_kernel`], [`Body::plate_transform`]
    /// and [`Body::plate_phases`].
    pub fn plate_stress(kernel: &[[f64; 6]], transform: &[f64], phases: &[(f64, f64)]) -> [f64; 6] {
        let mut sum = [0.0; 6];
        for ((s, q), (sin, cos)) in kernel.iter().zip(transform).zip(phases) {
            for (i, (sum, s)) in sum.iter_mut().zip(s).enumerate() {
                *sum += q * s * if StressTensor::ODD_IN_Z[i] { sin } else { cos };
            }
        }
        sum
    }

    /// Cosine transforms over the depth of the face's loads: a row for each of the plate's
    /// wavenumbers, over the face's nodes.
    pub(super) fn cosines(&self) -> &DMatrix<f64> {
        &self.cosines
    }

    /// Cosine transform in z of the face load, at the plate's wavenumbers; empty if the plate's
    /// remainder is negligible.
    pub fn plate_transform(&self, k: f64, q: &[f64]) -> Vec<f64> {
        if !self.plate_matters(k) {
            return Vec::new();
        }
        let q = nalgebra::DVector::from_column_slice(q);
        (self.cosines.columns(0, q.len()) * q).data.into()
    }
}

/// Rows over the nodes of sources, filled one after the other.
pub(super) struct Rows<'a> {
    sources: &'a Sources,
    columns: usize,
    charges: Vec<f64>,
    nodes: Vec<f64>,
}

impl<'a> Rows<'a> {
    /// No rows yet, with room for as many; `columns` first nodes are kept.
    pub fn new(sources: &'a Sources, rows: usize, columns: usize) -> Self {
        let charges = Vec::with_capacity(rows * sources.charge_count());
        Self { sources, columns, charges, nodes: Vec::with_capacity(rows * columns) }
    }

    /// Appends a row that `fill` writes over the charges and over the nodes, both initially zero.
    pub fn push(&mut self, fill: impl FnOnce(&mut [f64], &mut [f64])) {
        let (charge, node) = (self.charges.len(), self.nodes.len());
        self.charges.resize(charge + self.sources.charge_count(), 0.0);
        self.nodes.resize(node + self.columns, 0.0);
        fill(&mut self.charges[charge..], &mut self.nodes[node..]);
    }

    /// The matrix over the nodes.
    pub fn finish(self) -> DMatrix<f64> {
        let rows = self.nodes.len() / self.columns;
        let mut nodes = DMatrix::from_vec(self.columns, rows, self.nodes);
        self.sources.scatter(&self.charges, &mut nodes);
        nodes.transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::EdgeModel;

    /// The loads that free the faces are the same whether P or q is taken out of their equations,
    /// and short waves are those of all nodes.
    #[test]
    fn either_unknown_may_be_taken_out() {
        let resolution = Resolution::for_tolerance(1e-2);
        let (shape, line) = (Shape { half: 9.0, nu: 0.3 }, resolution.contact_axis(8.9));
        let end = EdgeModel::QuarterSpace.end(shape.nu, None);
        for parity in Parity::BOTH {
            let bends = parity == Parity::Odd;
            let part = Part { parity, bends, slides: false };
            let body = Body::new(&line, shape, end, part, &resolution);
            let n = body.surface.axis.len();
            for (k, is_near) in [(0.05, false), (0.15, false), (0.4, false), (5.0, true)] {
                let own = Faces::new(&body, k);
                assert_eq!(own.near.start > 0, is_near, "{parity:?} {k}: {:?}", own.near);
                let left = own.to.columns_range(body.contact()).into_owned();
                let (q, _) = own.freed(&left).unwrap();
                let other = Faces { near: 0..n, bends: !own.bends, ..Faces::new(&body, k) };
                let (by_other, _) = other.freed(&left).unwrap();
                let off = (&q - by_other).amax() / q.amax();
                assert!(off < 1e-9, "{parity:?} {k}: {off:e}");
                // What P moves, from the last nodes alone and from all.
                let displacement = body.displacement(k);
                let mut sum = DMatrix::zeros(displacement.nrows(), q.ncols());
                own.add_under(&displacement, &q, &mut sum);
                let off = (&sum + &displacement * (&own.from * &q)).amax();
                assert!(off < 1e-12 * (1.0 + sum.amax()), "{parity:?} {k}: {off:e}");
            }
        }
    }
}
