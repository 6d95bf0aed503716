//! Stresses under cells, by Love's sums.

use super::grid::Grid;
use super::pressure::CellPressure;
use crate::base::StressTensor;
use crate::body::transition;
use crate::kernels::corners::{CornerRow, CornerSums};
use std::sync::Arc;

/// Corners further from another than this part of the body's length are not the same.
const SAME: f64 = 1e-12;

/// The stress field of one body under the pressures of cells.
#[derive(Debug, Clone)]
pub struct CellField {
    /// Corners of the pressed cells and of their images, in rows of one y.
    rows: Vec<Row>,
    /// A length of the size of a cell.
    unit: f64,
    end: FieldEnd,
    nu: f64,
    /// Whether the pressure is even in y.
    even: bool,
}

/// Corners of cells that have one y.
#[derive(Debug, Clone)]
struct Row {
    y: f64,
    /// 1, and -1 for images: a second difference changes its sign in a mirror.
    sign: f64,
    corners: Arc<RowCorners>,
}

#[derive(Debug)]
struct RowCorners {
    all: CornerRow,
    /// Those at x > 0, if the others are their mirror images with the opposite weight: all that
    /// counts in the plane x = 0.
    half: Option<CornerRow>,
}

/// What the end faces of a body do to its stresses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldEnd {
    /// Half-length H of the body (C).
    pub half: f64,
    /// Place y of its middle (C), from that of the cells.
    pub middle: f64,
    /// Whether every cell has its image, of full weight, in both faces.
    pub mirrored: bool,
    /// Factor gamma of the [`transition`] with which the normal stress of a face is taken off; none
    /// without.
    pub gamma: Option<f64>,
}

impl FieldEnd {
    /// y of both faces.
    pub(super) fn faces(&self) -> [f64; 2] {
        [self.middle + self.half, self.middle - self.half]
    }
}

impl CellField {
    /// The field of a body with Poisson's ratio `nu`.
    pub fn new(solution: &CellPressure, end: FieldEnd, nu: f64) -> Self {
        let grid = &solution.grid;
        let (a, b) = grid.half_sides();
        let FieldEnd { half, mirrored, .. } = end;
        let mut rows = Vec::new();
        for j in 0..=grid.ny {
            let y = 2.0 * b * j as f64 - grid.half_length;
            let Some(corners) = corners(solution, j) else { continue };
            let corners = Arc::new(corners);
            let own = Row { y, sign: 1.0, corners };
            // On an end face a corner and its image cancel.
            let on_face = |face: &f64| (face - y).abs() <= SAME * half;
            let faces = end.faces();
            if !mirrored {
                rows.push(own);
                continue;
            }
            if !faces.iter().any(on_face) {
                rows.push(own.clone());
            }
            let faces = faces.into_iter().filter(|face| !on_face(face));
            rows.extend(faces.map(|face| Row { y: 2.0 * face - y, sign: -1.0, ..own.clone() }));
        }
        let pressures = solution.pressure.chunks_exact(grid.nx);
        let even = end.middle == 0.0 && pressures.clone().eq(pressures.rev());
        Self { rows, unit: (a * b).sqrt(), end, nu, even }
    }

    /// The stress (p0) at (`x`, `y`, `z`), z >= 0 into the body. On the surface it is finite
    /// everywhere, and sigma_zz is less the cell's pressure.
    ///
    /// Eqs. 4 to 10 over the cells and their images. The images leave the normal stress on an end
    /// face, and no shear: of this, at the place of the face next to the point, the share
    /// [`transition`] is taken off, for both faces.
    pub fn at(&self, x: f64, y: f64, z: f64) -> StressTensor {
        let mut stress = self.mirrored(x, y, z);
        let Some(gamma) = self.end.gamma else { return stress };
        let faces = self.end.faces();
        let shares = faces.map(|face| transition((face - y).abs(), z, gamma));
        let mut take = |share: f64, face: f64| {
            if share > 0.0 {
                stress.yy -= share * self.mirrored(x, face, z).yy;
            }
        };
        if self.even {
            take(shares[0] + shares[1], faces[0]);
        } else {
            take(shares[0], faces[0]);
            take(shares[1], faces[1]);
        }
        stress
    }

    /// Love's sum over the cells and their images.
    fn mirrored(&self, x: f64, y: f64, z: f64) -> StressTensor {
        let mut sums = CornerSums::default();
        let central = x == 0.0 && self.rows.iter().all(|row| row.corners.half.is_some());
        for row in &self.rows {
            let apart = y - row.y;
            let apart = if apart.abs() <= SAME * self.end.half { 0.0 } else { apart };
            let at = [x, apart, z];
            match &row.corners.half {
                Some(half) if central => sums.add(half, 2.0 * row.sign, at, self.unit),
                _ => sums.add(&row.corners.all, row.sign, at, self.unit),
            }
        }
        let stress = sums.stress(self.nu);
        if central { StressTensor { xy: 0.0, xz: 0.0, ..stress } } else { stress }
    }
}

/// The corners at the edge below the cells of row `j`, weighted with the second differences of the
/// pressures; none if all are zero.
fn corners(solution: &CellPressure, j: usize) -> Option<RowCorners> {
    let Grid { nx, ny, half_width, .. } = solution.grid;
    let p = |i: Option<usize>, j: Option<usize>| match (i, j) {
        (Some(i), Some(j)) if i < nx && j < ny => solution.pressure[j * nx + i],
        _ => 0.0,
    };
    let step = |i: Option<usize>| p(i, Some(j)) - p(i, j.checked_sub(1));
    let corner = |i: usize| {
        let x = half_width * (2.0 * i as f64 - nx as f64) / nx as f64;
        (x, step(Some(i)) - step(i.checked_sub(1)))
    };
    let all: Vec<(f64, f64)> = (0..=nx).map(corner).collect();
    let odd = all.iter().zip(all.iter().rev()).all(|(own, other)| own.1 == -other.1);
    let mut pressed = all;
    pressed.retain(|(_, weight)| *weight != 0.0);
    let right = || pressed.iter().copied().filter(|(x, _)| *x > 0.0).collect::<Vec<_>>();
    (!pressed.is_empty()).then(|| RowCorners {
        all: CornerRow::new(&pressed),
        half: odd.then(|| CornerRow::new(&right())),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::love;

    /// Unequal pressures on some cells.
    fn solution() -> CellPressure {
        let grid = Grid::new(6, 8, 1.2, 4.0).unwrap();
        let pressure = (0..grid.len()).map(|i| ((i * i) as f64).sin().max(0.0)).collect();
        CellPressure::of(grid, pressure)
    }

    fn field(mirrored: bool, gamma: Option<f64>) -> CellField {
        CellField::new(&solution(), FieldEnd { half: 4.0, middle: 0.0, mirrored, gamma }, 0.3)
    }

    /// Love's rectangles, one by one.
    fn direct(solution: &CellPressure, faces: &[f64], [x, y, z]: [f64; 3]) -> StressTensor {
        let (a, b) = solution.grid.half_sides();
        let mut sum = StressTensor::default();
        for (i, p) in solution.pressure.iter().enumerate() {
            let (from_x, from_y) = (solution.grid.x(i % 6), solution.grid.y(i / 6));
            let images = faces.iter().map(|face| 2.0 * face - from_y);
            for from_y in std::iter::once(from_y).chain(images) {
                sum += love::stress(x - from_x, y - from_y, z, a, b, 0.3) * *p;
            }
        }
        sum
    }

    #[test]
    fn sums_over_corners_are_those_of_every_cell_and_image() {
        let skew = solution();
        let mut even = solution();
        let p =
            |i: usize, j: usize| (1.0 + (i.min(5 - i) + 3 * j.min(7 - j)) as f64).sin().max(0.0);
        even.pressure = (0..48).map(|cell| p(cell % 6, cell / 6)).collect();
        for solution in [&skew, &even] {
            // Flush ends, a longer body, no images.
            for (half, middle, faces) in [
                (4.0, 0.0, &[4.0, -4.0][..]),
                (5.3, 0.0, &[5.3, -5.3]),
                (5.3, 0.7, &[6.0, -4.6]),
                (4.0, 0.0, &[]),
            ] {
                let end = FieldEnd { half, middle, mirrored: !faces.is_empty(), gamma: None };
                let field = CellField::new(solution, end, 0.3);
                for at in [
                    [0.31, 3.4, 0.57],
                    [0.0, 1.0, 0.2],
                    [0.4, -2.0, 0.0],
                    [0.0, 4.0, 0.01],
                    [9.0, 0.3, 40.0],
                ] {
                    let (got, want) = (field.at(at[0], at[1], at[2]), direct(solution, faces, at));
                    for (got, want) in got.components().iter().zip(want.components()) {
                        assert!((got - want).abs() < 1e-13, "{half} {at:?}: {got} {want}");
                    }
                }
            }
        }
    }

    #[test]
    fn both_faces_correct_an_even_field_alike() {
        let mut even = solution();
        even.pressure =
            (0..48).map(|cell| ((cell / 6).min(7 - cell / 6) + cell % 6) as f64).collect();
        let end = FieldEnd { half: 4.0, middle: 0.0, mirrored: true, gamma: Some(2.03) };
        let both = CellField::new(&even, end, 0.3);
        let each = CellField { even: false, ..both.clone() };
        assert!(both.even && !field(true, None).even);
        let [both, each] = [both, each].map(|field| field.at(0.2, 3.1, 0.4));
        assert!((both.yy - each.yy).abs() < 1e-13);
    }

    #[test]
    fn images_and_the_correction_free_an_end_face() {
        let (x, z) = (0.2, 0.6);
        let [plain, mirrored, corrected] = [(false, None), (true, None), (true, Some(2.03))]
            .map(|(m, g)| field(m, g).at(x, 4.0, z));
        assert!(plain.xy.abs() > 1e-2 && plain.yz.abs() > 1e-2);
        // The image in this face takes off the shear and doubles the normal stress; what is left is
        // the image in the other face.
        let solution = solution();
        let (a, b) = solution.grid.half_sides();
        let mut far = StressTensor::default();
        for (i, p) in solution.pressure.iter().enumerate() {
            let (from_x, from_y) = (solution.grid.x(i % 6), solution.grid.y(i / 6));
            far += love::stress(x - from_x, 12.0 + from_y, z, a, b, 0.3) * *p;
        }
        assert!((mirrored.xy - far.xy).abs() < 1e-12 && (mirrored.yz - far.yz).abs() < 1e-12);
        assert!((mirrored.yy - far.yy - 2.0 * plain.yy).abs() < 1e-12);
        // The other face's correction takes its small share here, too.
        let other = transition(8.0, z, 2.03);
        let there = field(true, None).at(x, -4.0, z).yy;
        assert!(other < 0.02 && (corrected.yy + other * there).abs() < 1e-12);
        assert_eq!([corrected.xx, corrected.zz], [mirrored.xx, mirrored.zz]);
    }

    #[test]
    fn the_surface_carries_the_cells_pressure() {
        let solution = solution();
        let stress = field(true, None).at(solution.grid.x(2), solution.grid.y(3), 0.0);
        assert!((stress.zz + solution.pressure[3 * 6 + 2]).abs() < 1e-13);
        assert_eq!([stress.xz, stress.yz], [0.0, 0.0]);
    }
}
