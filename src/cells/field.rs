//! Stresses under cells, by Love's sums.

use super::problem::CellPressure;
use crate::base::StressTensor;
use crate::body::transition;
use crate::kernels::love;

/// The stress field of one body under the pressures of cells.
#[derive(Debug, Clone)]
pub struct CellField {
    /// Pressed cells: x, y of the centre and the pressure.
    pressed: Vec<[f64; 3]>,
    half_sides: (f64, f64),
    end: FieldEnd,
    nu: f64,
}

/// What the end faces of a body do to its stresses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldEnd {
    /// Half-length H of the body (C).
    pub half: f64,
    /// Whether every cell has its image, of full weight, in both faces.
    pub mirrored: bool,
    /// Factor gamma of the [`transition`] with which the normal stress of a face is taken off; none without.
    pub gamma: Option<f64>,
}

impl CellField {
    /// The field of a body with Poisson's ratio `nu`.
    pub fn new(solution: &CellPressure, end: FieldEnd, nu: f64) -> Self {
        let grid = &solution.grid;
        let cell = |(i, p): (usize, &f64)| [grid.x(i % grid.nx), grid.y(i / grid.nx), *p];
        let all = solution.pressure.iter().enumerate();
        let pressed = all.filter(|(_, p)| **p > 0.0).map(cell).collect();
        Self { pressed, half_sides: grid.half_sides(), end, nu }
    }

    /// The stress (p0) at (`x`, `y`, `z`), z >= 0 into the body. On the surface it is finite everywhere, and
    /// sigma_zz is less the cell's pressure.
    ///
    /// Eqs. 4 to 10 over the cells and their images. The images leave the normal stress on an end face, and no shear: of this, at the place
    /// of the face next to the point, the share [`transition`] is taken off, for both faces.
    pub fn at(&self, x: f64, y: f64, z: f64) -> StressTensor {
        let mut stress = self.mirrored(x, y, z);
        if let Some(gamma) = self.end.gamma {
            for face in [self.end.half, -self.end.half] {
                let share = transition((face - y).abs(), z, gamma);
                if share > 0.0 {
                    stress.yy -= share * self.mirrored(x, face, z).yy;
                }
            }
        }
        stress
    }

    /// Love's sum over the cells and their images.
    fn mirrored(&self, x: f64, y: f64, z: f64) -> StressTensor {
        let (a, b) = self.half_sides;
        let faces = if self.end.mirrored { 2.0 * self.end.half } else { f64::INFINITY };
        let mut sum = StressTensor::default();
        for &[from_x, from_y, p] in &self.pressed {
            let one = |from_y: f64| love::stress(x - from_x, y - from_y, z, a, b, self.nu);
            let mut unit = one(from_y);
            if self.end.mirrored {
                unit += one(faces - from_y);
                unit += one(-faces - from_y);
            }
            sum += unit * p;
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::super::grid::Grid;
    use super::*;

    /// Unequal pressures on some cells.
    fn solution() -> CellPressure {
        let grid = Grid::new(6, 8, 1.2, 4.0).unwrap();
        let pressure = (0..grid.len()).map(|i| ((i * i) as f64).sin().max(0.0)).collect();
        CellPressure { grid, pressure, approach: 0.0, iterations: 0, residual: 0.0 }
    }

    fn field(mirrored: bool, gamma: Option<f64>) -> CellField {
        CellField::new(&solution(), FieldEnd { half: 4.0, mirrored, gamma }, 0.3)
    }

    #[test]
    fn sums_are_those_of_every_cell_and_image() {
        let solution = solution();
        let (a, b) = solution.grid.half_sides();
        let (x, y, z) = (0.31, 3.4, 0.57);
        let mut want = StressTensor::default();
        for (i, p) in solution.pressure.iter().enumerate() {
            let (from_x, from_y) = (solution.grid.x(i % 6), solution.grid.y(i / 6));
            for from_y in [from_y, 8.0 - from_y, -8.0 - from_y] {
                want += love::stress(x - from_x, y - from_y, z, a, b, 0.3) * *p;
            }
        }
        let got = field(true, None).at(x, y, z);
        for (got, want) in got.components().iter().zip(want.components()) {
            assert!((got - want).abs() < 1e-12, "{got} {want}");
        }
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
