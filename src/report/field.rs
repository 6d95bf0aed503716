//! Stress fields of both bodies: VTK files, and contours of von Mises stress.
//!
//! The field is evaluated on a quarter of each body and mirrored: sigma_xy and sigma_xz are odd in
//! x, sigma_xy and sigma_yz odd in y, everything else is even. Where the bodies slide on each other it is
//! evaluated on both sides of x = 0.

use super::draw::{Figure, Map};
use super::vtk::VtkGrid;
use crate::base::{Result, StressTensor};
use crate::case::Case;
use crate::solve::SolvedCase;
use crate::stress::{self, BodyKind, EDGE, GridStress, away_from_edge};
use rayon::prelude::*;

/// Extent of the field from the middle of the contact in x, beyond the roller's end in y, and into
/// the body in z (C).
const REACH: [f64; 3] = [2.5, 3.0, 5.0];

/// Axes of a quarter of a body in units of C, each from 0 (or the surface) outwards, that along x from
/// one side to the other where the bodies slide: finer towards the roller's end along y and towards the surface along z. `counts` are at least 2 each.
fn axes(case: &Case, body: BodyKind, counts: [usize; 3]) -> [Vec<f64>; 3] {
    let factors = case.factors();
    let half = factors.slenderness;
    let shares = |n: usize| (0..n).map(move |i| i as f64 / (n - 1) as f64);
    let mut x: Vec<f64> = shares(counts[0]).map(|t| REACH[0] * t).collect();
    if case.sliding.friction != 0.0 {
        x = x[1..].iter().rev().map(|x| -x).chain(x.iter().copied()).collect();
    }
    let mut y: Vec<f64> =
        shares(counts[1]).map(|t| half * (std::f64::consts::FRAC_PI_2 * t).sin()).collect();
    // The computed sine of a right angle may differ from 1, but the last point must be on the end
    // face.
    y[counts[1] - 1] = half;
    let ledge = half / factors.length_ratio - half;
    if body == BodyKind::Block && ledge > 1e-9 * half {
        let reach = ledge.min(REACH[1]);
        y.extend(shares(1 + counts[1] / 2).skip(1).map(|t| half + reach * t * t));
    }
    let z = shares(counts[2]).map(|t| REACH[2] * t * t).collect();
    [x, y, z]
}

/// A quarter of a body's field, with axes in units of C and stresses in units of p0.
struct Quarter<'a> {
    axes: [Vec<f64>; 3],
    stress: GridStress,
    case: &'a Case,
    body: BodyKind,
}

impl<'a> Quarter<'a> {
    /// The field of `body`.
    fn new(solved: &'a SolvedCase, body: BodyKind, counts: [usize; 3]) -> Result<Self> {
        let axes = axes(solved.case(), body, counts);
        let [x, y, z] = axes.clone();
        let stress = solved.on_grid(body, &stress::Grid { x, y, z })?;
        Ok(Self { axes, stress, case: solved.case(), body })
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
        let p0_pa = self.case.hertz().p0_pa;
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

    /// The contact pressure, which is -sigma_zz on the loaded surface, in a grid of one layer.
    fn pressure(&self) -> VtkGrid {
        let p0_pa = self.case.hertz().p0_pa;
        let value = |index: usize| ((-self.stress.at(index).zz * p0_pa) as f32).max(0.0);
        let values = self.mirrored(&[0], [false; 2], value);
        VtkGrid {
            axes_m: self.axes_m(std::iter::once(0.0)),
            arrays: vec![("pressure_pa".to_string(), values)],
        }
    }

    /// Indices and signs of the points along an axis and its mirror image, ascending; an axis that has both
    /// sides is not mirrored.
    fn mirror(axis: &[f64]) -> impl Iterator<Item = (usize, f32)> + Clone {
        let behind = if axis[0] < 0.0 { 1..1 } else { 1..axis.len() };
        behind.rev().map(|i| (i, -1.0)).chain((0..axis.len()).map(|i| (i, 1.0)))
    }

    /// A scalar of the layers `zs` of the whole body, from its `value` at each point of the
    /// quarter; `odd` in x and in y.
    fn mirrored(&self, zs: &[usize], odd: [bool; 2], value: impl Fn(usize) -> f32) -> Vec<f32> {
        let [x, y, _] = &self.axes;
        let (nx, ny) = (x.len(), y.len());
        let sign = |odd: bool, side: f32| if odd { side } else { 1.0 };
        let mut values = Vec::with_capacity((2 * nx - 1) * (2 * ny - 1) * zs.len());
        for &k in zs {
            for (j, along) in Self::mirror(y) {
                let row = (k * ny + j) * nx;
                values.extend(Self::mirror(x).map(|(i, across)| {
                    sign(odd[0], across) * sign(odd[1], along) * value(row + i)
                }));
            }
        }
        values
    }

    /// Coordinates of the whole body (m), at the depths `z` (C, in the global frame).
    fn axes_m(&self, z: impl Iterator<Item = f64>) -> [Vec<f64>; 3] {
        let c_m = self.case.hertz().c_m;
        let whole = |axis: &[f64]| -> Vec<f64> {
            Self::mirror(axis).map(|(i, side)| f64::from(side) * axis[i] * c_m).collect()
        };
        [whole(&self.axes[0]), whole(&self.axes[1]), z.map(|z| z * c_m).collect()]
    }

    /// Whether a point is in the excluded surroundings of the roller's edge, where stresses may be
    /// singular. Contours there are limited to the largest value outside.
    fn at_edge(&self, j: usize, k: usize) -> bool {
        let at = [0.0, self.axes[1][j], self.axes[2][k]];
        !away_from_edge(at, self.case.factors().slenderness, EDGE)
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

    /// Von Mises stress in the planes x = 0, y = the roller's end and z = the depth of its largest
    /// value, with the names of their files.
    fn figures(&self) -> [(&'static str, Figure); 3] {
        let [x, y, z] = &self.axes;
        let half = self.case.factors().slenderness;
        let end = y.iter().position(|v| *v == half).unwrap_or(y.len() - 1);
        let middle = x.iter().position(|v| *v == 0.0).expect("a point in the middle");
        let (largest, critical) = self.critical();
        let shown = |i: usize, j: usize, k: usize| {
            let v = self.von_mises(i, j, k);
            if self.at_edge(j, k) { v.min(largest) } else { v }
        };
        let figure = |place: &str,
                      labels,
                      axes: [&Vec<f64>; 2],
                      down,
                      value: &dyn Fn(usize, usize) -> f64| {
            let (case, body, n) = (&self.case.name, self.body.name(), axes[0].len());
            let title = format!("{case}, {body}: von Mises stress at {place}");
            let values = (0..n * axes[1].len()).map(|i| value(i % n, i / n)).collect();
            let (label, axes) = ("von Mises / p0".to_string(), axes.map(Clone::clone));
            Figure::of_map(title, labels, Map { label, axes, down, values })
        };
        let depth = format!("z = {:.2} C (critical depth)", z[critical]);
        [
            ("x0", figure("x = 0", ["y / C", "z / C"], [y, z], true, &|j, k| shown(middle, j, k))),
            (
                "end",
                figure("y = L1/2 (end)", ["x / C", "z / C"], [x, z], true, &|i, k| {
                    shown(i, end, k)
                }),
            ),
            (
                "critical-depth",
                figure(&depth, ["y / C", "x / C"], [y, x], false, &|j, i| shown(i, j, critical)),
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
    use crate::solve::Options;
    use std::path::Path;

    #[test]
    fn the_grid_reaches_the_ends_and_mirrors_the_shears() {
        let case = Case::find(Path::new("half-short")).unwrap();
        let solved = SolvedCase::new(&case, &Options::new(EdgeModel::Mirror)).unwrap();
        let quarter = |body| Quarter::new(&solved, body, [5, 7, 6]).unwrap();
        // The block's grid extends beyond the roller's end.
        assert_eq!(quarter(BodyKind::Block).stress.len(), 5 * (7 + 3) * 6);
        let quarter = quarter(BodyKind::Roller);
        assert_eq!(quarter.stress.len(), 5 * 7 * 6);
        let [x, y, z] = &quarter.axes;
        assert_eq!((y[6], z[5], x[4]), (case.factors().slenderness, 5.0, 2.5));
        let grid = quarter.grid();
        let [nx, ny, nz] = [0, 1, 2].map(|k| grid.axes_m[k].len());
        assert_eq!([nx, ny, nz], [9, 13, 6]);
        assert!(grid.axes_m.iter().all(|a| a.windows(2).all(|w| w[0] < w[1])));
        assert_eq!(grid.axes_m[2][5], 0.0, "the roller lies above the surface");
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
    }
}
