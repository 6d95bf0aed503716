//! The waves of a body with a round surface: what its skin has to do without, at each wavenumber.
//!
//! See [`super::skin`].

use super::finite::{Body, Faces, Rows};
use super::stencil::Stencil;
use crate::base::{Panels, Parity};
use crate::kernels::line_load::WaveStress;
use crate::kernels::wave::{Places, WAVES, Wanted, WaveTable};
use nalgebra::DMatrix;
use std::f64::consts::PI;
use std::sync::Arc;

/// Number of wavenumbers below that are known, for slopes along k.
pub(super) const BEFORE: usize = 2;

/// Distance from an end face (C) within which the tension of the skin is taken to vanish, as it
/// does on the face, and the displacement to be one: what the nodes at the corner have of them are
/// differences of large numbers.
pub(super) const NEAR_FACE: f64 = 0.05;

/// Number of wavenumbers whose polynomial in ln k gives slopes and values between them.
const WIDTH: usize = 5;

/// The loads on a body at one wavenumber that its round surface adds, per C / R and per contact
/// pressure at the contact nodes.
#[derive(Debug, Clone)]
pub struct Skin {
    /// Traction along x at the surface nodes, with sin(k x).
    pub along: DMatrix<f64>,
    /// Forces apart from lines along x at the surface nodes.
    pub apart: DMatrix<f64>,
    /// P at the surface nodes, which with q frees the end faces of these tractions' stress.
    pub surface: DMatrix<f64>,
    /// q at the face nodes.
    pub face: DMatrix<f64>,
}

/// What the skin of a part of a body adds to the compliance, per C / R, over the contact's nodes.
#[derive(Debug)]
pub(super) struct SkinCompliances {
    own: Vec<DMatrix<f64>>,
    /// That of all longer waves.
    longest: DMatrix<f64>,
}

impl SkinCompliances {
    /// That at a wavenumber `k` up to the last of those `known`.
    pub fn at(&self, known: &[f64], k: f64) -> DMatrix<f64> {
        if k < known[0] {
            return self.longest.clone();
        }
        let (first, places) = nearest(known, k);
        let mut sum = DMatrix::zeros(self.longest.nrows(), self.longest.ncols());
        for (j, compliance) in self.own[first..first + places.len()].iter().enumerate() {
            sum += compliance * derivatives(&places, j, k.ln())[0];
        }
        sum
    }
}

/// What one wavenumber of a body leads to, per contact pressure.
struct Wave {
    /// P at the surface nodes.
    own: DMatrix<f64>,
    /// (k / 2) e^(-k |u|) over the surface's loads at the offsets u from each of its nodes.
    spread: DMatrix<f64>,
    /// Stresses xx, yy and xy on the surface at its nodes.
    stresses: [DMatrix<f64>; 3],
    /// What frees the end faces; none where the load is mirrored in them.
    free: Option<FreeWave>,
}

/// What frees the end faces of a body at one wavenumber.
struct FreeWave {
    /// q at the face nodes per contact pressure.
    q: DMatrix<f64>,
    faces: Faces,
    /// Displacement at the contact nodes per P.
    displacement: DMatrix<f64>,
}

/// A skin at one wavenumber.
struct SkinWave {
    number: usize,
    /// The first and the second slope along k of the stresses on the surface.
    once: [DMatrix<f64>; 3],
    twice: [DMatrix<f64>; 3],
    skin: Skin,
}

/// Waves whose compliance is wanted.
#[derive(Debug, Clone, Copy)]
enum Waves {
    Own,
    /// All that are longer, if none of these has a skin.
    Longer,
}

/// The waves of a body, and its surface.
pub(super) struct OnSurface<'a> {
    body: &'a Body,
    k: &'a [f64],
    waves: Vec<Wave>,
    /// Derivatives and integrals along the surface.
    slope: DMatrix<f64>,
    integral: DMatrix<f64>,
}

impl<'a> OnSurface<'a> {
    /// Those of a `body` at the ascending wavenumbers `k`.
    pub fn new(body: &'a Body, k: &'a [f64]) -> Self {
        let mut all = Self::beside(body, k, |k| {
            let (own, free) = FreeWave::new(body, k);
            (own, Some(free))
        });
        for (k, waves) in k.chunks(WAVES).zip(all.waves.chunks_mut(WAVES)) {
            add_faces(body, k, waves);
        }
        all
    }

    /// Those of the half-space on which the load on a `body` is mirrored in its end faces.
    pub fn mirrored(body: &'a Body, k: &'a [f64]) -> Self {
        Self::beside(body, k, |_| (pressed(body), None))
    }

    /// Those under the loads on the surface that `loads` gives, with the stresses beside them.
    fn beside(
        body: &'a Body,
        k: &'a [f64],
        loads: impl Fn(f64) -> (DMatrix<f64>, Option<FreeWave>),
    ) -> Self {
        let axis = &body.surface.axis;
        let stencils: Vec<Stencil> =
            axis.nodes().iter().map(|y| body.surface_stencil(*y, 0.0)).collect();
        let wave = |&k: &f64| {
            let (own, free) = loads(k);
            let [spread, odd] = spread(body, &stencils, k);
            let softer = 1.0 - 2.0 * body.nu;
            let beside = softer * &spread * &own;
            let stresses = [-2.0 * body.nu * &own - &beside, beside - &own, softer * odd * &own];
            Wave { own, spread, stresses, free }
        };
        let waves = k.iter().map(wave).collect();
        Self { body, k, waves, slope: slopes(axis), integral: integrals(axis, body.parity) }
    }

    /// The skins at all wavenumbers but the first [`BEFORE`], and what they add to the compliance.
    pub fn skins(&self, tables: &[Arc<WaveTable>; 2]) -> (Vec<Skin>, SkinCompliances) {
        let (mut skins, mut own) = (Vec::new(), Vec::new());
        let mut longest = None;
        for i in BEFORE..self.k.len() {
            let wave = self.skin(i, tables);
            own.push(self.compliance(&wave, Waves::Own));
            longest.get_or_insert_with(|| self.compliance(&wave, Waves::Longer));
            skins.push(wave.skin);
        }
        (skins, SkinCompliances { own, longest: longest.expect("a skin") })
    }

    /// The skin at wavenumber number `i`.
    fn skin(&self, i: usize, tables: &[Arc<WaveTable>; 2]) -> SkinWave {
        let k = self.k[i];
        let (first, places) = nearest(self.k, k);
        let (rows, columns) = self.waves[i].own.shape();
        let zeros = || [0; 3].map(|_| DMatrix::zeros(rows, columns));
        let (mut once, mut twice) = (zeros(), zeros());
        for (j, wave) in self.waves[first..first + places.len()].iter().enumerate() {
            let [_, by_ln, twice_by_ln] = derivatives(&places, j, k.ln());
            for (component, stress) in wave.stresses.iter().enumerate() {
                once[component] += stress * (by_ln / k);
                twice[component] += stress * ((twice_by_ln - by_ln) / (k * k));
            }
        }
        let [xx, yy, xy] = &twice;
        let mut tension = yy.clone();
        for (mut row, y) in tension.row_iter_mut().zip(self.body.surface.axis.nodes()) {
            let square = ((self.body.half - y) / NEAR_FACE).powi(2);
            row *= square / (1.0 + square);
        }
        let apart = -0.5 * k * (tension + k * (&self.integral * xy));
        let along = -0.5 * (k * xx - &self.slope * xy);
        let freeing = self.waves[i].free.as_ref();
        let freeing = freeing.map(|free| free.freeing(self.body, k, tables, [&along, &apart]));
        let [surface, face] = freeing.unwrap_or_else(|| [0; 2].map(|_| DMatrix::zeros(0, 0)));
        SkinWave { number: i, once, twice, skin: Skin { along, apart, surface, face } }
    }

    /// What a skin adds to the compliance at its own wavenumber or under longer waves.
    fn compliance(&self, own: &SkinWave, waves: Waves) -> DMatrix<f64> {
        let SkinWave { number, once, twice, skin } = own;
        let (body, k, wave) = (self.body, self.k[*number], &self.waves[*number]);
        let (nu, contact) = (body.nu, body.contact());
        let rows = |matrix: &DMatrix<f64>| matrix.rows_range(contact.clone()).into_owned();
        // E e_zz and E e_xx; zz is minus the pressure, the same at all wavenumbers.
        let pressed = DMatrix::<f64>::identity(contact.len(), contact.len());
        let down = |[xx, yy, _]: &[DMatrix<f64>; 3]| -nu * (rows(xx) + rows(yy));
        let across = |[xx, yy, _]: &[DMatrix<f64>; 3]| rows(xx) - nu * rows(yy);
        let strain = across(&wave.stresses) + nu * pressed;
        // u_x = e_xx / k with sin(k x), and u sin(k u) is minus the slope of cos(k u) along k. The
        // load's own place does not move: the sum over all waves, here in closed form, is zero.
        let beside = match waves {
            Waves::Own => -0.5 * down(twice) - across(once) / k + strain / (k * k),
            Waves::Longer => -0.5 * down(once) / k - strain / (k * k),
        };
        let shear = 0.5 * PI * (1.0 - 2.0 * nu) / (1.0 - nu);
        let dragged = 2.0 / k * (&wave.spread * (&skin.apart - &skin.along) - &skin.apart);
        let mut all = PI / (1.0 - nu * nu) * beside + shear * rows(&dragged);
        if let Some(free) = &wave.free {
            all += &free.displacement * &skin.surface;
        }
        // A displacement is smooth at the corner, where stresses need not be.
        let from_face: Vec<f64> =
            body.surface.axis.nodes()[contact].iter().map(|y| body.half - y).collect();
        let near = from_face.partition_point(|s| *s >= NEAR_FACE);
        if near > 0 {
            let inner = all.row(near - 1).into_owned();
            (near..from_face.len()).for_each(|i| all.set_row(i, &inner));
        }
        all
    }
}

impl FreeWave {
    /// That of a `body` at the wavenumber `k`, with P at the surface nodes per contact pressure.
    fn new(body: &Body, k: f64) -> (DMatrix<f64>, Self) {
        let faces = Faces::new(body, k);
        let [more, q] = freed(&faces, &faces.to.columns_range(body.contact()).into_owned());
        (pressed(body) + more, Self { q, faces, displacement: body.displacement(k) })
    }

    /// P and q that free the end faces of the loads `along` and `apart`.
    fn freeing(
        &self,
        body: &Body,
        k: f64,
        tables: &[Arc<WaveTable>; 2],
        [along, apart]: [&DMatrix<f64>; 2],
    ) -> [DMatrix<f64>; 2] {
        // sin(k x) is a quarter of a wave behind: stresses across the contact are - cos(k x).
        let left =
            body.surface_matrix(k, &tables[1]) * apart - body.surface_matrix(k, &tables[0]) * along;
        freed(&self.faces, &left)
    }
}

/// The surface nodes' P under the pressure at each contact node alone.
fn pressed(body: &Body) -> DMatrix<f64> {
    let contact = body.contact();
    let at = |i, j| f64::from(u8::from(i == contact.start + j));
    DMatrix::from_fn(body.surface.axis.len(), contact.len(), at)
}

/// P and q that free these `faces` of the stresses `left` on them; zero if nothing does.
fn freed(faces: &Faces, left: &DMatrix<f64>) -> [DMatrix<f64>; 2] {
    let q =
        faces.freed(left).map_or_else(|| DMatrix::zeros(left.nrows(), left.ncols()), |(q, _)| q);
    [-(&faces.from * &q), q]
}

/// Sums of (k / 2) e^(-k |u|) over the surface's loads at the offsets u of `stencils`, one for each
/// of its nodes, and of the same with the sign of u: the stresses beside line loads.
fn spread(body: &Body, stencils: &[Stencil], k: f64) -> [DMatrix<f64>; 2] {
    let n = body.surface.axis.len();
    let reach = body.reach(k);
    let even = |u: f64| if u.abs() < reach { 0.5 * k * (-k * u.abs()).exp() } else { 0.0 };
    let mut rows = [0; 2].map(|_| Rows::new(&body.surface, n, n));
    for (stencil, &y) in stencils.iter().zip(body.surface.axis.nodes()) {
        let values: Vec<f64> = stencil.offsets().iter().map(|u| even(*u)).collect();
        let signs = stencil.offsets().iter().map(|u| if *u == 0.0 { 0.0 } else { u.signum() });
        let signed: Vec<f64> = values.iter().zip(signs).map(|(v, sign)| sign * v).collect();
        let mut strips = [0.0; 2];
        body.for_strips(k, y, 0.0, |u, w| {
            strips[0] += w * even(u);
            strips[1] += w * u.signum() * even(u);
        });
        for ((rows, values), strips) in rows.iter_mut().zip([values, signed]).zip(strips) {
            rows.push(|charges, nodes| {
                stencil.add_row(&values, charges, nodes);
                body.add_mean(strips, nodes);
            });
        }
    }
    rows.map(Rows::finish)
}

/// Adds the stresses on the surface under q on the end faces to those of up to [`WAVES`] `waves`.
fn add_faces(body: &Body, k: &[f64], waves: &mut [Wave]) {
    let mut own = [f64::INFINITY; WAVES];
    own[..k.len()].copy_from_slice(k);
    let of_wave = |wave: &Wave| {
        let loads = wave.free.as_ref().map_or(0, |free| free.q.nrows());
        [0; 3].map(|_| Rows::new(&body.face, body.surface.axis.len(), loads))
    };
    let mut rows: Vec<[Rows; 3]> = waves.iter().map(of_wave).collect();
    let (unit, reach) = ([[1.0; WAVES]], body.reach(1.0));
    for &y in body.surface.axis.nodes() {
        let sides = body.face_stencils(y, 0.0);
        let depths = [body.half - y, body.half + y];
        let values = [0, 1].map(|side| {
            let of_load = |u: &f64| {
                let places = Places::new(vec![*u], depths[side], true);
                let all = body.kernel.sum(&own, &places, reach, &unit, Wanted::ALL);
                all.map(|(stress, _)| stress)
            };
            sides[side].offsets().iter().map(of_load).collect::<Vec<_>>()
        });
        for (wave, rows) in rows.iter_mut().enumerate() {
            for (component, rows) in rows.iter_mut().enumerate() {
                rows.push(|charges, nodes| {
                    for ((stencil, values), into) in sides.iter().zip(&values).zip([-1.0, 1.0]) {
                        let own = |stresses: &[WaveStress; WAVES]| {
                            let s = &stresses[wave];
                            [s.xx, s.dd, into * s.xd][component]
                        };
                        let own: Vec<f64> = values.iter().map(own).collect();
                        stencil.add_row(&own, charges, nodes);
                    }
                });
            }
        }
    }
    for ((rows, wave), &k) in rows.into_iter().zip(waves).zip(k) {
        let Some(free) = &wave.free else { continue };
        let mut per_load = rows.map(Rows::finish);
        add_plate(body, k, &mut per_load);
        let sums = wave.stresses.iter_mut().zip(per_load);
        sums.for_each(|(sum, per_load)| *sum += per_load * &free.q);
    }
}

/// Adds the plate's remainder to stresses on the surface per q.
fn add_plate(body: &Body, k: f64, stresses: &mut [DMatrix<f64>; 3]) {
    let waves = body.plate_waves(k);
    if waves.is_empty() {
        return;
    }
    let nodes = body.surface.axis.nodes();
    let kernels: Vec<Vec<[f64; 6]>> = nodes.iter().map(|y| body.plate_kernel(&waves, *y)).collect();
    let columns = stresses[0].ncols();
    for (stress, component) in stresses.iter_mut().zip([0, 1, 3]) {
        let at = |i: usize, l: usize| kernels[i][l][component];
        let kernel = DMatrix::from_fn(nodes.len(), waves.len(), at);
        *stress += kernel * body.cosines().columns(0, columns);
    }
}

/// The first of the wavenumbers `known` whose polynomial in ln k serves `k`, and their logarithms.
fn nearest(known: &[f64], k: f64) -> (usize, Vec<f64>) {
    let count = WIDTH.min(known.len());
    let above = known.partition_point(|other| *other < k);
    let first = (above + 1).saturating_sub(count.div_ceil(2)).min(known.len() - count);
    (first, known[first..first + count].iter().map(|k| k.ln()).collect())
}

/// Value, first and second derivative at `x` of the Lagrange polynomial number `j` of `nodes`.
fn derivatives(nodes: &[f64], j: usize, x: f64) -> [f64; 3] {
    // One factor after the other.
    let (mut value, mut first, mut second) = (1.0, 0.0, 0.0);
    for (i, node) in nodes.iter().enumerate() {
        if i != j {
            let slope = 1.0 / (nodes[j] - node);
            let factor = (x - node) * slope;
            second = second * factor + 2.0 * first * slope;
            first = first * factor + value * slope;
            value *= factor;
        }
    }
    [value, first, second]
}

/// The derivative at the nodes of an `axis` of the panels' polynomials through the values there.
fn slopes(axis: &Panels) -> DMatrix<f64> {
    let order = axis.order();
    let mut matrix = DMatrix::zeros(axis.len(), axis.len());
    for from in (0..axis.len()).step_by(order) {
        let own = &axis.nodes()[from..from + order];
        for (i, x) in own.iter().enumerate() {
            (0..order).for_each(|j| matrix[(from + i, from + j)] = derivatives(own, j, *x)[1]);
        }
    }
    matrix
}

/// The integral of loads from the middle of the body to each node of its `axis`; of loads whose
/// integral is even, `parity`, minus that from the node to the end. Both vanish at the end, as
/// forces apart cannot do without: an odd one does so less its share of what all loads come to. A
/// force at the corner itself would take the place of that.
fn integrals(axis: &Panels, parity: Parity) -> DMatrix<f64> {
    let order = axis.order();
    let mut matrix = DMatrix::zeros(axis.len(), axis.len());
    for (i, &y) in axis.nodes().iter().enumerate() {
        let panel = axis.panel_of(y);
        let [a, b] = axis.panel(panel);
        let (part, others, sign) = match parity {
            Parity::Even => ([y, b], (panel + 1) * order..axis.len(), -1.0),
            Parity::Odd => ([a, y], 0..panel * order, 1.0),
        };
        for (j, w) in axis.integrals(panel, part).into_iter().enumerate() {
            matrix[(i, panel * order + j)] = sign * w;
        }
        others.for_each(|j| matrix[(i, j)] = sign * axis.weights()[j]);
        if parity == Parity::Odd {
            let share = y / axis.end();
            (0..axis.len()).for_each(|j| matrix[(i, j)] -= share * axis.weights()[j]);
        }
    }
    matrix
}
