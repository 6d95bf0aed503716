//! Stress fields of both bodies: VTK files, and contours of von Mises stress.
//!
//! The field is evaluated on a quarter of each body and mirrored: sigma_xy and sigma_xz are odd in
//! x, sigma_xy and sigma_yz odd in y, everything else is even. Where the bodies slide on each other
//! it is evaluated on both sides of x = 0, and over the whole length where the scene is not
//! symmetric about y = 0.

use super::draw::{Figure, Map};
use super::plots::origin;
use super::vtk::VtkGrid;
use crate::base::number::significant;
use crate::base::{self, Result, StressTensor};
use crate::solve::SolvedCase;
use crate::stress::{self, BodyKind, EDGE, GridStress, away_from_edges};
use rayon::prelude::*;

/// Extent of the field from the middle of the contact in x, beyond the overlap's ends in y, and
/// into the body in z (C).
const REACH: [f64; 3] = [2.5, 3.0, 5.0];

/// Axes of a body's part in units of C: along x from 0, from one side to the other where the bodies
/// slide; along y from the middle, over the whole length where the scene is not symmetric; finer
/// towards the ends of the bodies' overlap and towards the surface along z. `counts` are at least 2
/// each.
fn axes(solved: &SolvedCase, body: BodyKind, counts: [usize; 3]) -> [Vec<f64>; 3] {
    let case = solved.case();
    let [from, to] = case.overlap();
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let shares = |n: usize| (0..n).map(move |i| i as f64 / (n - 1) as f64);
    let mut x: Vec<f64> = shares(counts[0]).map(|t| REACH[0] * t).collect();
    if case.sliding.friction != 0.0 {
        x = x[1..].iter().rev().map(|x| -x).chain(x.iter().copied()).collect();
    }
    let own = case.ends_m(body).map(|y| y / case.hertz().c_m);
    // From the overlap's middle outwards on one side, as distances.
    let side = |ledge: f64| -> Vec<f64> {
        let mut y: Vec<f64> =
            shares(counts[1]).map(|t| half * (std::f64::consts::FRAC_PI_2 * t).sin()).collect();
        // The computed sine of a right angle may differ from 1, but the last point must be on the
        // end face.
        y[counts[1] - 1] = half;
        if base::ledge(ledge, half) > 0.0 {
            let reach = ledge.min(REACH[1]);
            y.extend(shares(1 + counts[1] / 2).skip(1).map(|t| half + reach * t * t));
        }
        y
    };
    let mut y: Vec<f64> = side(own[1] - to).into_iter().map(|y| middle + y).collect();
    if !solved.is_symmetric() {
        let behind = side(from - own[0]).into_iter().skip(1).rev().map(|y| middle - y);
        y = behind.chain(y).collect();
        // The ends of the overlap exactly.
        let nearest = |end: f64| {
            move |a: &&mut f64, b: &&mut f64| (**a - end).abs().total_cmp(&(**b - end).abs())
        };
        for end in [from, to] {
            *y.iter_mut().min_by(nearest(end)).expect("places") = end;
        }
    }
    let z = shares(counts[2]).map(|t| REACH[2] * t * t).collect();
    [x, y, z]
}

/// A quarter of a body's field, with axes in units of C and stresses in units of p0.
struct Quarter<'a> {
    axes: [Vec<f64>; 3],
    stress: GridStress,
    solved: &'a SolvedCase,
    body: BodyKind,
    /// Whether x and y have one side only, which is mirrored.
    folded: [bool; 2],
}

impl<'a> Quarter<'a> {
    /// The field of `body`.
    fn new(solved: &'a SolvedCase, body: BodyKind, counts: [usize; 3]) -> Result<Self> {
        let axes = axes(solved, body, counts);
        let [x, y, z] = axes.clone();
        let stress = solved.on_grid(body, &stress::Grid { x, y, z })?;
        let folded = [solved.case().sliding.friction == 0.0, solved.is_symmetric()];
        Ok(Self { axes, stress, solved, body, folded })
    }

    fn at(&self, i: usize, j: usize, k: usize) -> StressTensor {
        let [x, y, _] = &self.axes;
        self.stress.at((k * y.len() + j) * x.len() + i)
    }

    /// The whole body in the global frame (m, Pa), in which z points into the block: the roller
    /// lies at z < 0 and its shears across z change their sign. The arrays are `sigma_xx_pa` ...
    /// `sigma_yz_pa`, `von_mises_pa` and `tau_max_pa`.
    fn grid(&self) -> VtkGrid {
        let roller = self.body == BodyKind::Roller;
        let mut zs: Vec<usize> = (0..self.axes[2].len()).collect();
        if roller {
            zs.reverse();
        }
        let side = if roller { -1.0 } else { 1.0 };
        let p0_pa = self.solved.case().hertz().p0_pa;
        // The quarter is computed once and mirrored.
        let quarter: Vec<[f32; 8]> = (0..self.stress.len())
            .into_par_iter()
            .map(|index| {
                let s = self.stress.at(index) * p0_pa;
                let [xx, yy, zz, xy, xz, yz] = s.components();
                let all = [xx, yy, zz, xy, side * xz, side * yz, s.von_mises(), s.tau_max()];
                all.map(|v| v as f32)
            })
            .collect();
        let odd = |name: &str| {
            [["sigma_xy", "sigma_xz"], ["sigma_xy", "sigma_yz"]].map(|n| n.contains(&name))
        };
        let arrays = StressTensor::NAMES.iter().chain(&["von_mises", "tau_max"]).enumerate().map(
            |(array, name)| {
                let value = |index: usize| quarter[index][array];
                (format!("{name}_pa"), self.mirrored(&zs, odd(name), value))
            },
        );
        let arrays = arrays.collect();
        VtkGrid { axes_m: self.axes_m(zs.iter().map(|&k| side * self.axes[2][k])), arrays }
    }

    /// The contact pressure in a grid of one layer.
    fn pressure(&self) -> VtkGrid {
        let p0_pa = self.solved.case().hertz().p0_pa;
        let [x, y, _] = &self.axes;
        let at = |index: usize| self.solved.pressure(x[index % x.len()], y[index / x.len()]);
        let value = |index: usize| (at(index) * p0_pa) as f32;
        let values = self.mirrored(&[0], [false; 2], value);
        VtkGrid {
            axes_m: self.axes_m(std::iter::once(0.0)),
            arrays: vec![("pressure_pa".to_string(), values)],
        }
    }

    /// Indices and signs of the points along x (0) or y (1) and their mirror images, ascending; an
    /// axis that has both sides is not mirrored.
    fn mirror(&self, axis: usize) -> impl Iterator<Item = (usize, f32)> + Clone + use<> {
        let count = self.axes[axis].len();
        let behind = if self.folded[axis] { 1..count } else { 1..1 };
        behind.rev().map(|i| (i, -1.0)).chain((0..count).map(|i| (i, 1.0)))
    }

    /// A scalar of the layers `zs` of the whole body, from its `value` at each point of the
    /// quarter; `odd` in x and in y.
    fn mirrored(&self, zs: &[usize], odd: [bool; 2], value: impl Fn(usize) -> f32) -> Vec<f32> {
        let [x, y, _] = &self.axes;
        let (nx, ny) = (x.len(), y.len());
        let sign = |odd: bool, side: f32| if odd { side } else { 1.0 };
        let mut values = Vec::with_capacity((2 * nx - 1) * (2 * ny - 1) * zs.len());
        for &k in zs {
            for (j, along) in self.mirror(1) {
                let row = (k * ny + j) * nx;
                values.extend(self.mirror(0).map(|(i, across)| {
                    sign(odd[0], across) * sign(odd[1], along) * value(row + i)
                }));
            }
        }
        values
    }

    /// Coordinates of the whole body (m), at the depths `z` (C, in the global frame).
    fn axes_m(&self, z: impl Iterator<Item = f64>) -> [Vec<f64>; 3] {
        let c_m = self.solved.case().hertz().c_m;
        let whole = |axis: usize| -> Vec<f64> {
            self.mirror(axis).map(|(i, side)| f64::from(side) * self.axes[axis][i] * c_m).collect()
        };
        [whole(0), whole(1), z.map(|z| z * c_m).collect()]
    }

    /// Whether a point is in the excluded surroundings of the edges, where stresses may be
    /// singular. Contours there are limited to the largest value outside.
    fn at_edge(&self, j: usize, k: usize) -> bool {
        let at = [0.0, self.axes[1][j], self.axes[2][k]];
        !away_from_edges(at, self.solved.case().overlap(), EDGE)
    }

    /// Von Mises stress (p0) at a point of the grid.
    fn von_mises(&self, i: usize, j: usize, k: usize) -> f64 {
        self.at(i, j, k).von_mises()
    }

    /// The largest von Mises stress (p0) outside the surroundings of the edge, and its layer.
    fn critical(&self) -> (f64, usize) {
        let [nx, ny, nz] = self.axes.each_ref().map(Vec::len);
        let places = (0..nz).flat_map(|k| (0..ny).map(move |j| (j, k)));
        let outside = places.filter(|&(j, k)| !self.at_edge(j, k));
        let values = outside.flat_map(|(j, k)| (0..nx).map(move |i| (self.von_mises(i, j, k), k)));
        values.fold((f64::NEG_INFINITY, 0), |most, v| if v.0 > most.0 { v } else { most })
    }

    /// Von Mises stress in the planes x = 0, y = the overlap's +y end and z = the depth of its
    /// largest value, with the names of their files.
    fn figures(&self) -> [(&'static str, Figure); 3] {
        let [x, y, z] = &self.axes;
        let [_, to] = self.solved.case().overlap();
        let far = |y: &f64| (y - to).abs();
        let end = (0..y.len()).min_by(|i, j| far(&y[*i]).total_cmp(&far(&y[*j]))).expect("places");
        let middle = x.iter().position(|v| *v == 0.0).expect("a point in the middle");
        let (limit, critical) = self.critical();
        let hertz = self.solved.case().hertz();
        let (mm, mpa) = (1e3 * hertz.c_m, 1e-6 * hertz.p0_pa);
        let figure = |place: &str,
                      labels,
                      axes: [&Vec<f64>; 2],
                      down,
                      value: &dyn Fn(usize, usize) -> f64| {
            let n = axes[0].len();
            let title = format!(
                "{}: {}",
                origin(&self.solved.case().name, self.solved.method()),
                self.body.name()
            );
            let values = (0..n * axes[1].len()).map(|i| mpa * value(i % n, i / n)).collect();
            let axes = axes.map(|axis| axis.iter().map(|v| mm * v).collect());
            let (label, limit) = ("von Mises (MPa)".to_string(), mpa * limit);
            let figure = Figure::of_map(title, labels, Map { label, axes, down, values, limit });
            figure.of_what(&format!("von Mises stress at {place}"))
        };
        let depth = format!("z = {} mm (critical depth)", significant(mm * z[critical], 3));
        [
            (
                "x0",
                figure("x = 0", ["y (mm)", "z (mm)"], [y, z], true, &|j, k| {
                    self.von_mises(middle, j, k)
                }),
            ),
            (
                "end",
                figure("the +y end of the contact", ["x (mm)", "z (mm)"], [x, z], true, &|i, k| {
                    self.von_mises(i, end, k)
                }),
            ),
            (
                "critical-depth",
                figure(&depth, ["y (mm)", "x (mm)"], [y, x], false, &|j, i| {
                    self.von_mises(i, j, critical)
                }),
            ),
        ]
    }
}

/// The files of the field by name: `field-block.vtr`, `field-roller.vtr`, `pressure.vtr` and the
/// contours `field-<body>-<plane>.svg` and `.png`.
///
/// `counts` are the numbers of a quarter's points across, along and into a body.
///
/// # Errors
/// Those of [`SolvedCase::on_grid`].
pub fn contents(solved: &SolvedCase, counts: [usize; 3]) -> Result<Vec<(String, Vec<u8>)>> {
    let mut files = Vec::new();
    let mut put = |name: String, content: Vec<u8>| files.push((name, content));
    for body in BodyKind::ALL {
        let quarter = Quarter::new(solved, body, counts)?;
        let name = body.name();
        put(format!("field-{name}.vtr"), quarter.grid().to_vtr());
        if body == BodyKind::Block {
            put("pressure.vtr".to_string(), quarter.pressure().to_vtr());
        }
        for (place, figure) in quarter.figures() {
            let picture = figure.draw();
            put(format!("field-{name}-{place}.svg"), picture.to_svg().into_bytes());
            put(format!("field-{name}-{place}.png"), picture.to_png());
        }
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::EdgeModel;
    use crate::case::Case;
    use crate::solve::Options;
    use std::path::Path;

    #[test]
    fn the_grid_reaches_the_ends_and_mirrors_the_shears() {
        let case = Case::find(Path::new("half-short")).unwrap();
        let solved = SolvedCase::new(&case, &Options::new(EdgeModel::Mirror)).unwrap();
        let quarter = |body| Quarter::new(&solved, body, [5, 7, 6]).unwrap();
        // The block's grid extends beyond the overlap's end.
        assert_eq!(quarter(BodyKind::Block).stress.len(), 5 * (7 + 3) * 6);
        let quarter = quarter(BodyKind::Roller);
        assert_eq!(quarter.stress.len(), 5 * 7 * 6);
        let [x, y, z] = &quarter.axes;
        assert_eq!((y[6], z[5], x[4]), (case.overlap()[1], 5.0, 2.5));
        let grid = quarter.grid();
        let [nx, ny, nz] = [0, 1, 2].map(|k| grid.axes_m[k].len());
        assert_eq!([nx, ny, nz], [9, 13, 6]);
        assert!(grid.axes_m.iter().all(|a| a.windows(2).all(|w| w[0] < w[1])));
        assert_eq!(grid.axes_m[2][5], 0.0, "the roller lies above the surface");
        let c_m = case.hertz().c_m;
        assert_eq!(grid.axes_m[2][3], -z[2] * c_m);
        let array = |name: &str| &grid.arrays.iter().find(|(n, _)| n == name).unwrap().1;
        let at = |i: usize, j: usize, k: usize| (k * ny + j) * nx + i;
        for (name, odd_x, odd_y) in [
            ("sigma_xx_pa", 1.0, 1.0),
            ("sigma_xy_pa", -1.0, -1.0),
            ("sigma_xz_pa", -1.0, 1.0),
            ("sigma_yz_pa", 1.0, -1.0),
        ] {
            let a = array(name);
            let here = a[at(6, 9, 3)];
            assert!(here != 0.0, "{name}");
            assert_eq!(a[at(2, 9, 3)], odd_x * here, "{name}");
            assert_eq!(a[at(6, 3, 3)], odd_y * here, "{name}");
        }
        // Shears across z are those of the block's axes.
        let own = solved.stress(BodyKind::Roller, &[[x[2], y[3], z[2]]]).unwrap()[0];
        for (name, own) in
            [("sigma_yz_pa", -own.yz), ("sigma_xz_pa", -own.xz), ("sigma_xy_pa", own.xy)]
        {
            let here = f64::from(array(name)[at(6, 9, 3)]) / case.hertz().p0_pa;
            assert!((here - own).abs() < 1e-3 && here * own > 0.0, "{name}: {here} {own}");
        }
    }

    /// Friction turns the tractions of a round surface, not the pressure.
    #[test]
    fn the_pressure_of_a_sliding_raceway_is_even_and_that_of_the_solution() {
        let mut case = Case::find(Path::new("half-short")).unwrap().with_tolerance(1e-2);
        case.block.radius_m = Some(-2.0 * case.roller.radius_m);
        case.sliding.friction = 0.3;
        let solved = SolvedCase::new(&case, &Options::new(EdgeModel::QuarterSpace)).unwrap();
        let quarter = Quarter::new(&solved, BodyKind::Block, [11, 5, 2]).unwrap();
        let grid = quarter.pressure();
        let (_, pressure) = &grid.arrays[0];
        let [nx, ny, _] = [0, 1, 2].map(|k| grid.axes_m[k].len());
        let scales = case.hertz();
        for (j, i) in (0..ny).flat_map(|j| (0..nx).map(move |i| (j, i))) {
            let [x, y] = [grid.axes_m[0][i], grid.axes_m[1][j]].map(|at| at / scales.c_m);
            let found = f64::from(pressure[j * nx + i]) / scales.p0_pa;
            assert_eq!(pressure[j * nx + i], pressure[j * nx + nx - 1 - i]);
            let wanted = solved.pressure(x, y);
            assert!((found - wanted).abs() < 1e-6 * wanted.max(1.0), "{x} {y}: {found} {wanted}");
        }
        assert!(pressure.iter().all(|p| p.is_finite()) && pressure.iter().any(|p| *p > 0.0));
    }

    #[test]
    fn a_scene_that_is_not_symmetric_has_a_field_of_its_whole_length() {
        let mut case = Case::find(Path::new("half-short")).unwrap();
        case.accuracy.tolerance = 1e-2;
        case.load.eccentricity_m = Some(1e-4);
        case.pose.offset_m = 2e-4;
        let solved = SolvedCase::new(&case, &Options::new(EdgeModel::Mirror)).unwrap();
        for body in BodyKind::ALL {
            let whole = Quarter::new(&solved, body, [3, 5, 4]).unwrap();
            let [x, y, z] = &whole.axes;
            assert!(case.overlap().iter().all(|end| y.contains(end)), "{y:?}");
            let beyond = if body == BodyKind::Block { 4 } else { 0 };
            assert_eq!(y.len(), 9 + beyond);
            let grid = whole.grid();
            assert_eq!(grid.axes_m[1].len(), y.len());
            let c_m = case.hertz().c_m;
            assert!(grid.axes_m[1].iter().zip(y).all(|(m, y)| (m - y * c_m).abs() < 1e-15));
            let mises = &grid.arrays.iter().find(|(name, _)| name == "von_mises_pa").unwrap().1;
            for (j, y) in y.iter().enumerate() {
                let there = solved.stress(body, &[[x[1], *y, z[2]]]).unwrap()[0];
                let wanted = there.von_mises() * case.hertz().p0_pa;
                // The roller's layers run upwards.
                let layer = if body == BodyKind::Roller { 1 } else { 2 };
                let found = f64::from(mises[(layer * grid.axes_m[1].len() + j) * 5 + 3]);
                let off = (found - wanted).abs() / case.hertz().p0_pa;
                assert!(off < 5e-3, "{body:?} {y}: {found} of {wanted}");
            }
        }
    }

    #[test]
    fn a_roller_longer_than_the_block_has_its_ledge() {
        let mut case = Case::find(Path::new("half-short")).unwrap();
        case.accuracy.tolerance = 1e-2;
        std::mem::swap(&mut case.roller.length_m, &mut case.block.length_m);
        let solved = SolvedCase::new(&case, &Options::new(EdgeModel::Mirror)).unwrap();
        let [block, roller] =
            BodyKind::ALL.map(|body| Quarter::new(&solved, body, [3, 6, 3]).unwrap().axes[1].len());
        assert_eq!([block, roller], [6, 9]);
    }
}
