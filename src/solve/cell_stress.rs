//! Stresses on curves and at points under the pressures of cells.

use super::cells::{contact_ends, line_loads};
use super::lines;
use super::options::Options;
use super::scene::Scene;
use super::shaping::Shaping;
use super::solved::wanted_curves;
use crate::base::{HertzScales, PerBody, StressTensor};
use crate::case::Case;
use crate::cells::{CellField, CellPressure, CellProblem, EndLoads, EndStress, FreeBody, FreeEnds};
use crate::stress::round::{ContactEnds, LocalContact, RowLoad, add_skins, rounded};
use crate::stress::{
    BodyField, BodyKind, CurveSpec, FlatStress, LineLoad, RoundStress, StressCurve, Work,
};
use rayon::prelude::*;

/// The curve under the largest pressure of a rough contact, how deep it goes (C), and its points
/// less one.
pub const PEAK_CURVE: &str = "depth-peak";
const PEAK_DEPTH: f64 = 3.0;
const PEAK_POINTS: i32 = 40;

/// Places closer to an end face than this part of a body's length are on it.
const ON_FACE: f64 = 1e-9;

/// Curves and points with their stresses.
pub(super) struct Stressed {
    pub curves: Vec<StressCurve>,
    pub points: Vec<StressTensor>,
}

impl Stressed {
    /// Those that `options` ask for, under the `pressure` of the `problem` that `scene` makes.
    pub fn new(
        case: &Case,
        scene: &Scene,
        options: &Options,
        problem: &CellProblem,
        pressure: &CellPressure,
    ) -> Self {
        let HertzScales { c_m, .. } = case.hertz();
        let mut specs = wanted_curves(scene, options);
        if scene.rough {
            specs.extend(options.bodies.iter().map(|body| under_peak(scene, *body, pressure)));
        }
        let placed = |[x, y, z]: [f64; 3]| [x, scene.off_middle(y), z];
        let points: Vec<(BodyKind, [f64; 3])> =
            options.points.iter().map(|p| (p.body, placed(p.at_m.map(|v| v / c_m)))).collect();
        let curves: Vec<CurveSpec> = specs
            .iter()
            .map(|spec| CurveSpec {
                points: spec.points.iter().map(|at| placed(*at)).collect(),
                ..*spec
            })
            .collect();
        let found = match &problem.free {
            // The nodes that carry the ends carry a smooth pressure too.
            Some(free) if !scene.rough => by_nodes(scene, free, pressure, &curves, &points),
            free => sums(case, scene, free.as_deref(), pressure, &curves, &points),
        };
        let shaping = Shaping::of(case);
        let shaped = |body: BodyKind, stress: &RoundStress| shaping.stress(body, stress);
        let curves = specs.into_iter().zip(&found.curves).map(|(spec, stresses)| StressCurve {
            body: spec.body,
            name: spec.name.to_string(),
            stress: stresses.iter().map(|s| shaped(spec.body, s)).collect(),
            at: spec.points,
            own_error: None,
        });
        let points = options.points.iter().zip(&found.points);
        let points = points.map(|(point, s)| shaped(point.body, s)).collect();
        Self { curves: curves.collect(), points }
    }
}

/// The line into a body from the cell of largest pressure, where a rough contact is stressed most.
fn under_peak(scene: &Scene, body: BodyKind, pressure: &CellPressure) -> CurveSpec {
    let grid = &pressure.grid;
    let all = pressure.pressure.iter().enumerate();
    let (top, _) = all.max_by(|a, b| a.1.total_cmp(b.1)).expect("a grid has cells");
    let (x, y) = (grid.x(top % grid.nx), grid.y(top / grid.nx) + scene.middle);
    // From a part of a cell, on which the stresses under an asperity vary, in equal ratios.
    let (a, b) = grid.half_sides();
    let first = 0.25 * a.min(b);
    let depth = |i: i32| first * (PEAK_DEPTH / first).powf(f64::from(i) / f64::from(PEAK_POINTS));
    let points = (0..=PEAK_POINTS).map(|i| [x, y, depth(i)]).collect();
    CurveSpec { body, name: PEAK_CURVE, points }
}

/// The fields of the line engine under the pressures of cells.
fn by_nodes(
    scene: &Scene,
    free: &FreeEnds,
    pressure: &CellPressure,
    curves: &[CurveSpec],
    points: &[(BodyKind, [f64; 3])],
) -> lines::Stresses {
    let columns = free.columns(pressure);
    let moments = free.moments(&columns);
    let contact = scene.may_end().then(|| contact_ends(&line_loads(pressure, 0.0)));
    let field = |kind: BodyKind| {
        let [field, _] = free.fields(&scene.free_body(kind), &columns, &moments, scene.tolerance);
        BodyField::new(field.following_contact(contact), 1.0)
    };
    lines::stresses(free.shared() && scene.feels_alike(), field, curves, points)
}

/// The field of one body: Love's sums over cells and images, and what free ends add.
struct Summed<'a> {
    cells: CellField,
    ends: Option<EndStress<'a>>,
    /// y of the free end faces, and how close to them is on them.
    faces: [f64; 2],
    near: f64,
    /// Whether the surface is flat, and whether pressures are even in x.
    flat: bool,
    even: bool,
}

/// Love's sums on `curves` and at single `points` (C), with what `free` ends add.
fn sums(
    case: &Case,
    scene: &Scene,
    free: Option<&FreeEnds>,
    pressure: &CellPressure,
    curves: &[CurveSpec],
    points: &[(BodyKind, [f64; 3])],
) -> lines::Stresses {
    let loads = free.map(|free| EndLoads::new(free, pressure));
    let field = |kind: BodyKind| {
        let FreeBody { half, middle, .. } = scene.free_body(kind);
        let ends = loads.as_ref();
        Summed {
            cells: scene.mirrored_field(kind, pressure),
            ends: ends.map(|loads| loads.stress(&scene.free_body(kind), scene.tolerance)),
            faces: [middle - half, middle + half],
            near: ON_FACE * half,
            flat: Shaping::of(case).curvatures[kind] == 0.0,
            even: !scene.rough,
        }
    };
    let fields = PerBody { block: field(BodyKind::Block), roller: field(BodyKind::Roller) };
    let lines = line_loads(pressure, 0.0);
    let rows = scene.rough.then(|| row_loads(pressure, &lines));
    let rows = rows.as_deref();
    let contact =
        |kind: BodyKind, y: f64| local_contact(scene, (&lines, rows), y, fields[kind].faces);
    let curve = |spec: &CurveSpec| -> Vec<RoundStress> {
        let rows: Vec<&[[f64; 3]]> =
            spec.points.chunk_by(|a, b| a[1] == b[1] && a[2] == b[2]).collect();
        let row = |row: &&[[f64; 3]]| fields[spec.body].row(row, &contact(spec.body, row[0][1]));
        rows.par_iter().flat_map_iter(row).collect()
    };
    let point = |(kind, at): &(BodyKind, [f64; 3])| {
        fields[*kind].row(&[*at], &contact(*kind, at[1])).swap_remove(0)
    };
    lines::Stresses {
        curves: curves.iter().map(curve).collect(),
        points: points.par_iter().map(point).collect(),
        work: Work::default(),
    }
}

impl Summed<'_> {
    /// Stresses at points that differ in x only, with what a round surface adds in the local
    /// `contact`.
    fn row(&self, points: &[[f64; 3]], contact: &LocalContact) -> Vec<RoundStress> {
        let [_, y, z] = points[0];
        // Nothing moves along x where the surface is flat, nor in a plane of symmetry.
        let sloped = |x: f64| !self.flat && (x != 0.0 || !self.even);
        let xs: Vec<f64> = points.iter().map(|[x, ..]| *x).collect();
        let flat = |all: &[f64], places: &[f64]| {
            vec![self.at(y, z, all, places).into_iter().map(FlatStress::from).collect()]
        };
        let mut all = rounded(&xs, &[z], contact, sloped, flat).swap_remove(0);
        if let Some(ends) = self.ends.as_ref().filter(|_| !self.flat) {
            add_skins(&mut all, &ends.skin_at(y, z, &xs));
        }
        all
    }

    /// The flat body's stresses at `y`, `z` for each x of `xs`; the `places` for x decide which of
    /// them are far.
    fn at(&self, y: f64, z: f64, xs: &[f64], places: &[f64]) -> Vec<StressTensor> {
        let Some(ends) = &self.ends else {
            return xs.iter().map(|x| self.cells.at(*x, y, z)).collect();
        };
        let mut found = ends.at(y, z, xs, places);
        for ((sum, x), place) in found.iter_mut().zip(xs).zip(places) {
            if !ends.is_far(*place, z) {
                *sum += self.cells.at(*x, y, z);
            }
        }
        if self.faces.iter().any(|face| (face - y).abs() <= self.near) {
            found.iter_mut().for_each(|s| (s.yy, s.xy, s.yz) = (0.0, 0.0, 0.0));
        }
        found
    }
}

/// The loads of the rows of cells, with those per length of `lines`.
fn row_loads(pressure: &CellPressure, lines: &[LineLoad]) -> Vec<RowLoad> {
    let grid = &pressure.grid;
    let (a, _) = grid.half_sides();
    let rows = lines.iter().zip(pressure.pressure.chunks_exact(grid.nx));
    let row = |(line, row): (&LineLoad, &[f64])| {
        let moment: f64 = row.iter().enumerate().map(|(i, p)| p * grid.x(i)).sum();
        RowLoad { y: line.y, load: line.load, moment: 2.0 * a * moment }
    };
    rows.map(row).collect()
}

/// The plane contact that the surface of a body between the `faces` has at `y`: under the load per
/// length there, where that varies, which of a rough contact is that of the `rows` around.
fn local_contact(
    scene: &Scene,
    (lines, rows): (&[LineLoad], Option<&[RowLoad]>),
    y: f64,
    faces: [f64; 2],
) -> LocalContact {
    if !scene.may_end() && rows.is_none() {
        let at = [-scene.half_length, scene.half_length];
        return LocalContact::HERTZ.on_line(y, ContactEnds { at, open: [false; 2] }, faces);
    }
    let ends = contact_ends(lines);
    let place = LocalContact::place(y, ends.at);
    if let Some(rows) = rows {
        return LocalContact::under_rows(rows, place).on_line(y, ends, faces);
    }
    let nearest = lines.iter().min_by(|a, b| (a.y - place).abs().total_cmp(&(b.y - place).abs()));
    LocalContact::carrying(nearest.map_or(0.0, |line| line.load)).on_line(y, ends, faces)
}
