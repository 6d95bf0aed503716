//! What free end faces add to a mirrored half-space.
//!
//! R(k) = C(k) - C_mirrored(k), the compliance of a body with end faces free of traction less that
//! of the half-space with one image of every pressure in each face, is smooth but at the corner:
//! panels of polynomials, graded towards the end, carry it with a few nodes ([`crate::body`]),
//! however many cells there are. With E the means of the panels' polynomials over the cells, W the
//! nodes' weights and 2 b the length of a cell,
//!
//! p_nodes = 2 b W^-1 E^T p_cells (least squares),    u_cells = E R p_nodes,
//!
//! which is symmetric as R W^-1 is. R fades within a few 1/k of the ends, so few shapes along the
//! line make up all of it: the eigenvectors of the sum of W^1/2 R W^-1/2 squared over the
//! wavenumbers. Across the contact R is a convolution with r(x) = (1/pi^2) int_0^inf R(k) cos(k x)
//! dk, taken at the cells' distances: it fades too slowly for a sum over the grid's own
//! wavenumbers.
//!
//! Towards k = 0 R grows like 1 / k, too fast to be interpolated, for the two shapes of a rigid
//! motion: a body of half-length H and of a plane wave's width is a plate, loaded on its edge. What
//! it does is taken out in closed form, faded beyond 1 / H, and put back at all wavenumbers: a load
//! displaces by pi / (k H (1 - nu^2)) wherever it acts, plane stress, and a moment turns the plate
//! by 3 pi / (k H^3 (1 - nu) (3 + nu)) (Kirchhoff's plate w = (A + B k z) e^(-k z) cos k x under
//! the moment M cos k x on its edge without shear, whose slope is 2 M / (D k (1 - nu) (3 + nu))
//! with the plate's stiffness D).
//!
//! What a round surface adds to the compliance ([`Skins`]) is split in the same way: cells and
//! their images have that of a round half-space ([`crate::kernels::round`]), R the rest.

use super::columns::Columns;
use super::convolution::LINES;
use super::grid::Grid;
use super::influence::{HalfTransform, Images, RoundImages};
use super::means::means;
use super::pressure::CellPressure;
use crate::base::{Panels, Wavenumbers};
use crate::body::{
    EdgeModel, Generatrix, LoadedLine, Placed, Resolution, Shape, SkinLine, Skins, Stack,
};
use crate::stress::{Field, Load};
use multiversion::multiversion;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rustfft::num_complex::Complex;
use std::f64::consts::PI;

/// A body with free end faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeBody {
    /// Half-length H (C).
    pub half: f64,
    /// Place y of its middle (C), from that of the cells.
    pub middle: f64,
    /// Poisson's ratio.
    pub nu: f64,
    /// Share of the compliance.
    pub share: f64,
    /// C / R of its surface, to which first order the compliance is wanted.
    pub curvature: f64,
    /// That as a part of the surface's own C / R.
    pub felt: f64,
}

/// Accuracy (p0) of the nodes that carry the free ends.
const TOLERANCE: f64 = 5e-4;

/// The error of skins that is aimed at, at least (p0 C / R), and their least panel at a corner (C):
/// splines along the line waver between panels as unlike as those of finer skins.
const SKIN_ERROR: f64 = 0.12;
const SKIN_CORNER: f64 = 0.025;

/// How closely their nodes follow a gap along the line (p0): stresses are those of the pressure at
/// them.
const FOLLOWS: f64 = 5e-3;

/// Shapes along the line that displace less than this part of the largest one are left out.
const NEGLIGIBLE: f64 = 1e-5;

/// A body with free ends at the coarse wavenumbers, and the same as a mirrored half-space.
#[derive(Debug)]
struct Freed {
    stack: Stack,
    mirrored: Stack,
    /// Its skin, where it is round.
    skins: Option<Skins>,
    /// What [`FreeEnds::long`] has of it, times k e^(k H).
    long: DMatrix<f64>,
}

/// R(k) of all bodies together at some wavenumbers, on the nodes of panels along the contact.
#[derive(Debug)]
pub struct FreeEnds {
    axis: Panels,
    /// Whether pressures are even in x and y, and the axis lies along half of the contact.
    symmetric: bool,
    /// Exponents m of the pressure s^-m at the distance s from the contact's ends, zero where it is
    /// finite.
    exponents: [f64; 2],
    wavenumbers: Wavenumbers,
    /// Bodies of one place, one length and one Poisson's ratio are one.
    bodies: Vec<Freed>,
    /// The surfaces that are round.
    round: Vec<RoundImages>,
    /// B, a column for each of the few shapes along the line that R consists of: those of rigid
    /// motions, then the others.
    basis: DMatrix<f64>,
    /// r at the coarse wavenumbers, with (R - [`FreeEnds::long`]) W^-1 = B r B^T.
    matrices: Vec<DMatrix<f64>>,
}

impl FreeEnds {
    /// For a contact of half-length `half_length` (C) between `bodies`, of which some have free
    /// ends, under pressures that are even in x and y if it is `symmetric`, and that go like s^-m
    /// at the distance s (C) from its ends, m of `exponents`, zero where they are finite, and
    /// follow the `gap` along it.
    pub fn new(
        half_length: f64,
        bodies: &[FreeBody],
        symmetric: bool,
        exponents: [f64; 2],
        gap: &Generatrix,
    ) -> Self {
        let resolution = Resolution::for_tolerance(TOLERANCE);
        let ends = [-half_length, half_length];
        let (axis, parity) = resolution.contact_line(ends, [None; 2], &gap.kinks, symmetric);
        let axis = resolution.resolving(axis, gap, FOLLOWS);
        let halves: Vec<f64> = bodies.iter().map(|body| body.half).collect();
        let wavenumbers = resolution.wavenumbers_of(&halves, parity);
        let distinct = distinct(bodies);
        let mut sums = vec![DMatrix::zeros(axis.len(), axis.len()); wavenumbers.coarse().len()];
        let mut round = Vec::new();
        let bodies = distinct.iter().map(|Distinct { own, rounded }| {
            let coarse = wavenumbers.coarse();
            let line = LoadedLine { axis: &axis, symmetric, slides: false };
            let placed = |model: EdgeModel| {
                let (middle, shape) = (own.middle, Shape { half: own.half, nu: own.nu });
                Placed { middle, shape, end: model.end(own.nu, None) }
            };
            // The cells' own images make a mirrored half-space.
            let models = [EdgeModel::QuarterSpace, EdgeModel::Mirror];
            let [stack, mirrored] =
                models.map(|model| Stack::new(line, placed(model), &resolution, coarse));
            for (i, sum) in sums.iter_mut().enumerate() {
                stack.add_compliance(i, own.share, sum);
                mirrored.add_compliance(i, -own.share, sum);
            }
            let skins = (own.curvature != 0.0).then(|| {
                let exponents = exponents.map(|m| (m != 0.0).then_some(m));
                let (kinks, least_corner) = (&gap.kinks, SKIN_CORNER);
                let line = SkinLine { ends, exponents, kinks, symmetric, least_corner };
                let error = SKIN_ERROR.max(TOLERANCE / own.curvature.abs());
                Skins::new(line, placed(EdgeModel::QuarterSpace), own.curvature, error)
            });
            if let Some(skins) = &skins {
                skins.add_compliances_of_ends(coarse.nodes(), *rounded, &axis, &mut sums);
                let FreeBody { half, middle, nu, .. } = *own;
                let images = Images { half, middle, weight: *rounded };
                round.push(RoundImages { images, nu, zero: 1.0 / skins.longest() });
            }
            Freed { stack, mirrored, skins, long: long(own, symmetric) }
        });
        let bodies = bodies.collect();
        let basis = rigid(&axis, symmetric);
        let matrices = Vec::new();
        let mut ends =
            Self { bodies, round, axis, symmetric, exponents, wavenumbers, basis, matrices };
        ends.compress(sums);
        ends
    }

    /// The surfaces that are round.
    pub(super) fn round(&self) -> &[RoundImages] {
        &self.round
    }

    /// Finds the shapes that R(k), given at the coarse wavenumbers, consists of.
    fn compress(&mut self, all: Vec<DMatrix<f64>>) {
        let roots =
            DVector::from_iterator(self.axis.len(), self.axis.weights().iter().map(|w| w.sqrt()));
        let nodes = self.wavenumbers.coarse().nodes().iter();
        let all: Vec<_> = nodes.zip(all).map(|(k, r)| self.remainder(*k, r, &roots)).collect();
        let shapes = shapes(&all, self.wavenumbers.coarse().weights());
        let (rigid, rank) = (self.basis.ncols(), self.basis.ncols() + shapes.ncols());
        let matrix = |own: &DMatrix<f64>| {
            let mut whole = DMatrix::zeros(rank, rank);
            let own = shapes.tr_mul(&(own * &shapes));
            whole.view_mut((rigid, rigid), own.shape()).copy_from(&own);
            whole
        };
        self.matrices = all.par_iter().map(matrix).collect();
        let mut basis = self.basis.clone().resize_horizontally(rank, 0.0);
        let others = scaled(shapes, &roots, |value, root| value / root);
        basis.columns_mut(rigid, others.ncols()).copy_from(&others);
        self.basis = basis;
    }

    /// W^1/2 (R - [`FreeEnds::long`]) W^-1/2 of the compliance `r` at `k`, with the square `roots`
    /// of the weights.
    fn remainder(&self, k: f64, r: DMatrix<f64>, roots: &DVector<f64>) -> DMatrix<f64> {
        let columns = scaled(r.transpose(), roots, |value, root| value / root);
        let sum = scaled(columns.transpose(), roots, |value, root| value * root);
        let rigid = scaled(self.basis.clone(), roots, |value, root| value * root);
        let long = &rigid * self.long(k) * rigid.transpose();
        // R is symmetric, but the strips in the place of far images carry the mean of a pressure:
        // right at the place that moves, not at the one that is pressed. The symmetric part
        // therefore gets the displacement by a uniform pressure.
        let symmetric = (&sum + sum.transpose()) * 0.5;
        let missing = (&sum - &symmetric) * roots / roots.norm_squared();
        let both = &missing * roots.transpose() + roots * missing.transpose();
        symmetric + both - long
    }

    /// Memory of the correction on `grid` (bytes).
    pub(super) fn bytes(&self, grid: &Grid) -> f64 {
        let padded = if self.symmetric { 1.0 } else { 2.0 } * grid.nx as f64;
        8.0 * padded * (self.matrices.len() + self.basis.ncols().pow(2)) as f64
    }

    /// Axis along the contact, or along its half.
    pub fn axis(&self) -> &Panels {
        &self.axis
    }

    /// Whether pressures are even in x and y.
    pub fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    /// What long waves displace in bodies that end, over the shapes of rigid motions.
    fn long(&self, k: f64) -> DMatrix<f64> {
        let rigid = self.bodies[0].long.nrows();
        self.bodies
            .iter()
            .fold(DMatrix::zeros(rigid, rigid), |sum, own| sum + &own.long * own.fading(k))
    }

    /// The wavenumbers for fields over the cells of `grid`, which are padded to twice their extent.
    fn resolving(&self, grid: &Grid) -> Wavenumbers {
        self.wavenumbers.resolving(4.0 * grid.half_width)
    }

    /// The pressures of `cells` on the nodes.
    pub fn columns(&self, cells: &CellPressure) -> Columns<'_> {
        Columns::new(cells, &self.axis, self.symmetric, self.exponents)
    }

    /// The moments of `pressure`, see [`Load::moments`].
    pub fn moments(&self, pressure: &dyn Load) -> DMatrix<f64> {
        pressure.moments(&self.wavenumbers)
    }

    /// Whether all bodies are alike.
    pub fn shared(&self) -> bool {
        self.bodies.len() == 1
    }

    /// The stresses in `body`, one of those given, under `pressure` with its [`FreeEnds::moments`],
    /// by free ends and by mirrored ones; contributions below `tolerance` (p0) are neglected.
    pub fn fields<'a>(
        &'a self,
        body: &FreeBody,
        pressure: &'a dyn Load,
        moments: &DMatrix<f64>,
        tolerance: f64,
    ) -> [Field<'a>; 2] {
        let own = |freed: &&Freed| {
            let (middle, own) = (freed.stack.middle, freed.stack.body());
            own.half == body.half && own.nu == body.nu && middle == body.middle
        };
        let freed = self.bodies.iter().find(own).expect("one of the bodies");
        let [free, mirrored] = [&freed.stack, &freed.mirrored]
            .map(|stack| Field::new(stack, &self.wavenumbers, pressure, moments, None, tolerance));
        [free.with_skins(freed.skins.as_ref(), body.felt), mirrored]
    }

    /// The displacement (C^2 / (2 R)) of the line x = 0 that free ends and round surfaces add, at
    /// `y`, under the pressures of `cells`, which on the axis are `pressure`.
    pub fn lift<'a>(
        &'a self,
        pressure: &dyn Load,
        cells: &'a CellPressure,
    ) -> impl Fn(f64) -> f64 + use<'a> {
        let wavenumbers = self.resolving(&cells.grid);
        let fine = wavenumbers.fine();
        let weights = DVector::from_column_slice(self.axis.weights());
        let shapes = scaled(self.basis.clone(), &weights, |value, weight| value * weight);
        let loads = shapes.tr_mul(&pressure.transforms(fine));
        let rank = self.basis.ncols();
        let moments = wavenumbers.moments(loads.as_slice(), rank);
        let mut moved = DVector::zeros(rank);
        for (matrix, load) in self.matrices.iter().zip(moments.chunks_exact(rank)) {
            moved += matrix * DVector::from_column_slice(load);
        }
        let rigid = self.bodies[0].long.nrows();
        for (i, (k, weight)) in fine.iter().zip(wavenumbers.weights()).enumerate() {
            let mut long = moved.rows_mut(0, rigid);
            long += self.long(*k) * loads.column(i).rows(0, rigid) * *weight;
        }
        moved /= PI * PI;
        let displaced = &self.basis * moved;
        move |y| {
            let round: f64 = self.round.iter().map(|body| body.displacement(cells, y)).sum();
            let y = if self.symmetric { y.abs() } else { y };
            let ends = self.axis.interpolation(y).map(|(node, share)| share * displaced[node]);
            round + ends.sum::<f64>()
        }
    }

    /// On the cells of `grid`, or on their quarter if pressures are symmetric, for transforms
    /// across the contact that are padded to `mx` cells on either side.
    pub(super) fn on_cells(&self, grid: &Grid, mx: usize) -> EndCorrection {
        let (a, b) = grid.half_sides();
        let (rank, rigid) = (self.basis.ncols(), self.bodies[0].long.nrows());
        let wavenumbers = self.resolving(grid);
        // Of each coarse wavenumber, and of each body's long waves, the share in the matrix of each
        // of the cells' own wavenumbers.
        let fine = wavenumbers.fine();
        let mut shares = vec![vec![0.0; mx + 1]; self.matrices.len()];
        let mut long_shares = vec![vec![0.0; mx + 1]; self.bodies.len()];
        let mut transform = HalfTransform::new(mx);
        let add = |share: f64, wave: &[f64], into: &mut [f64]| {
            into.iter_mut().zip(wave).for_each(|(into, wave)| *into += share * wave);
        };
        for (i, (k, weight)) in fine.iter().zip(wavenumbers.weights()).enumerate() {
            let width = 2.0 * (k * a).sin() / k;
            let mut wave: Vec<f64> = (0..=mx)
                .map(|d| (k * 2.0 * a * d as f64).cos() * weight * width / (PI * PI))
                .collect();
            transform.even(&mut wave);
            for (own, into) in self.bodies.iter().zip(&mut long_shares) {
                add(own.fading(*k), &wave, into);
            }
            let (first, interpolation) = wavenumbers.interpolation(i);
            for (share, into) in interpolation.iter().zip(&mut shares[first..]) {
                add(*share, &wave, into);
            }
        }
        let mut parts: Vec<(&[f64], DMatrix<f64>)> =
            shares.iter().map(Vec::as_slice).zip(self.matrices.iter().cloned()).collect();
        for (own, shares) in self.bodies.iter().zip(&long_shares) {
            let mut matrix = DMatrix::zeros(rank, rank);
            matrix.view_mut((0, 0), (rigid, rigid)).copy_from(&own.long);
            parts.push((shares, matrix));
        }
        // The cosine transforms both ways across the contact make mx times the sequence, others 2
        // mx.
        let (waves, both_ways) = if self.symmetric { (mx, mx) } else { (mx + 1, 2 * mx) };
        let scale = 2.0 * b / both_ways as f64;
        let mut matrices = vec![0.0; waves * rank * rank];
        matrices.par_chunks_mut(rank * rank).enumerate().for_each(|(k, into)| {
            for (shares, matrix) in &parts {
                add(scale * shares[k], matrix.as_slice(), into);
            }
        });
        let of_cell = |means: &Vec<(usize, f64)>| -> Vec<f64> {
            let shape =
                |i: usize| means.iter().map(|(node, mean)| mean * self.basis[(*node, i)]).sum();
            (0..rank).map(shape).collect()
        };
        let means = means(&self.axis, grid, self.symmetric);
        let shapes: Vec<f64> = means.iter().flat_map(of_cell).collect();
        let count = means.len();
        let turned = (0..rank).flat_map(|i| (0..count).map(move |j| (i, j)));
        let turned = turned.map(|(i, j)| shapes[j * rank + i]).collect();
        EndCorrection { shapes, turned, rank, matrices }
    }
}

impl Freed {
    /// e^(-k H) / k.
    fn fading(&self, k: f64) -> f64 {
        (-k * self.stack.body().half).exp() / k
    }
}

/// A body with the shares of those like it.
struct Distinct {
    /// With the largest C / R of them.
    own: FreeBody,
    /// Their C / R times their shares.
    rounded: f64,
}

/// The bodies that differ in more than their surfaces.
fn distinct(bodies: &[FreeBody]) -> Vec<Distinct> {
    let mut distinct: Vec<Distinct> = Vec::new();
    for body in bodies {
        let FreeBody { half: _, middle: _, nu: _, share, curvature, felt } = *body;
        let rounded = curvature * share;
        let like = |b: &&mut Distinct| FreeBody { share, curvature, felt, ..b.own } == *body;
        match distinct.iter_mut().find(like) {
            Some(Distinct { own, rounded: sum }) => {
                own.share += share;
                *sum += rounded;
                if curvature.abs() > own.curvature.abs() {
                    own.curvature = curvature;
                }
            }
            None => distinct.push(Distinct { own: *body, rounded }),
        }
    }
    distinct
}

/// The shapes of rigid motions on the nodes of `axis`: 1, and y where pressures are not even.
fn rigid(axis: &Panels, symmetric: bool) -> DMatrix<f64> {
    let count = if symmetric { 1 } else { 2 };
    DMatrix::from_fn(axis.len(), count, |node, i| if i == 0 { 1.0 } else { axis.nodes()[node] })
}

/// What a body's long waves displace over the shapes of rigid motions, times k.
fn long(body: &FreeBody, symmetric: bool) -> DMatrix<f64> {
    let FreeBody { half, middle, nu, share, .. } = *body;
    let uniform = share * Shape { half, nu }.moved();
    if symmetric {
        // A node acts on both sides of the middle.
        return DMatrix::from_element(1, 1, 2.0 * uniform);
    }
    let turned = share * Shape { half, nu }.turned();
    let first = uniform + turned * middle * middle;
    let mixed = -turned * middle;
    DMatrix::from_row_slice(2, 2, &[first, mixed, mixed, turned])
}

/// The eigenvectors that all of the symmetric `matrices` consist of, those of the sum of their
/// squares.
fn shapes(matrices: &[DMatrix<f64>], weights: &[f64]) -> DMatrix<f64> {
    let n = matrices[0].nrows();
    let squares = matrices.iter().zip(weights).map(|(matrix, weight)| matrix * matrix * *weight);
    let sum = squares.fold(DMatrix::zeros(n, n), |sum, square| sum + square);
    let eigen = sum.symmetric_eigen();
    let most = eigen.eigenvalues.max();
    let wanted = |i: &usize| eigen.eigenvalues[*i] > NEGLIGIBLE * NEGLIGIBLE * most;
    let columns: Vec<_> = (0..n).filter(wanted).map(|i| eigen.eigenvectors.column(i)).collect();
    DMatrix::from_columns(&columns)
}

/// The rows of `matrix` combined with the numbers of `scales` by `with`.
fn scaled(
    mut matrix: DMatrix<f64>,
    scales: &DVector<f64>,
    with: fn(f64, f64) -> f64,
) -> DMatrix<f64> {
    for mut column in matrix.column_iter_mut() {
        column
            .iter_mut()
            .zip(scales.iter())
            .for_each(|(value, scale)| *value = with(*value, *scale));
    }
    matrix
}

/// [`FreeEnds`] on cells, in the wavenumbers of their transform.
#[derive(Debug, Clone)]
pub(super) struct EndCorrection {
    /// E B: for each cell along the line the mean of each shape; and for each shape those of all
    /// cells.
    shapes: Vec<f64>,
    turned: Vec<f64>,
    rank: usize,
    /// For each wavenumber 2 b r, the long waves in it.
    matrices: Vec<f64>,
}

/// Numbers of a transform, real or complex: `PARTS` real ones each.
pub(super) trait Amplitude<const PARTS: usize>: Copy {
    /// Its real numbers.
    fn parts(self) -> [f64; PARTS];
    /// Adds to one of them.
    fn add(&mut self, part: usize, value: f64);
}

impl Amplitude<1> for f64 {
    fn parts(self) -> [f64; 1] {
        [self]
    }

    fn add(&mut self, _part: usize, value: f64) {
        *self += value;
    }
}

impl Amplitude<2> for Complex<f64> {
    fn parts(self) -> [f64; 2] {
        [self.re, self.im]
    }

    fn add(&mut self, part: usize, value: f64) {
        *if part == 0 { &mut self.re } else { &mut self.im } += value;
    }
}

/// Rows of a matrix that [`thin_product`] takes at once.
const ROWS: usize = 4;

/// The product of a `matrix`, row by row, with some `columns` side by side.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn thin_product(matrix: &[f64], columns: &[[f64; LINES]], out: &mut [[f64; LINES]]) {
    let n = columns.len();
    for (rows, out) in matrix.chunks(ROWS * n).zip(out.chunks_mut(ROWS)) {
        let mut sums = [[0.0; LINES]; ROWS];
        for (j, column) in columns.iter().enumerate() {
            for (sum, row) in sums.iter_mut().zip(rows.chunks_exact(n)) {
                sum.iter_mut().zip(column).for_each(|(sum, v)| *sum += row[j] * v);
            }
        }
        out.copy_from_slice(&sums[..out.len()]);
    }
}

impl EndCorrection {
    /// Adds the displacement that pressures cause to `out`: those of up to [`LINES`] wavenumbers
    /// from number `first` on, `p(j)` for cell j, all cells of one wavenumber after the other.
    pub(super) fn add<'a, const PARTS: usize, T: Amplitude<PARTS> + 'a>(
        &self,
        first: usize,
        p: impl Fn(usize) -> &'a [T],
        out: &mut [T],
    ) {
        let rank = self.rank;
        let ny = self.shapes.len() / rank;
        let none = [0.0; LINES];
        let mut fields: [_; PARTS] = std::array::from_fn(|_| vec![none; ny]);
        for (part, field) in fields.iter_mut().enumerate() {
            for (j, field) in field.iter_mut().enumerate() {
                field.iter_mut().zip(p(j)).for_each(|(own, p)| *own = p.parts()[part]);
            }
        }
        let (mut loads, mut moved) = (vec![none; rank], vec![none; rank]);
        let mut sums = vec![0.0; rank];
        let matrices = self.matrices.chunks_exact(rank * rank).skip(first);
        for field in &mut fields {
            thin_product(&self.turned, field, &mut loads);
            for (line, matrix) in matrices.clone().take(out.len() / ny).enumerate() {
                sums.fill(0.0);
                for (column, load) in matrix.chunks_exact(rank).zip(&loads) {
                    sums.iter_mut().zip(column).for_each(|(sum, v)| *sum += load[line] * v);
                }
                moved.iter_mut().zip(&sums).for_each(|(moved, sum)| moved[line] = *sum);
            }
            thin_product(&self.shapes, &moved, field);
        }
        for (line, out) in out.chunks_exact_mut(ny).enumerate() {
            for (part, field) in fields.iter().enumerate() {
                out.iter_mut().zip(field).for_each(|(out, field)| out.add(part, field[line]));
            }
        }
    }
}
