//! A contact on a grid of cells, from the gap to the pressures.

use super::convolution::EvenConvolution;
use super::cosine::good_length;
use super::ends::FreeEnds;
use super::grid::Grid;
use super::influence::{Images, Table};
use super::linear::Linear;
use super::pressure::CellPressure;
use super::solver::{Complementarity, State};
use super::whole::WholeConvolution;
use crate::base::stop::go_on;
use crate::base::{Error, Parity, Result, Secants};
use crate::contact::Gap;
use crate::host::check_memory;
use std::f64::consts::PI;
use std::sync::Arc;

/// Cells in a direction below which no coarser grid gives a start.
const COARSEST: usize = 48;

/// Most held tilts that are tried for the one that a load leads to, and how far the line's ends
/// move (C^2 / (2 R)) at one that moves the load's resultant by some half of the line.
const MOST_TILTS: usize = 200;
const FIRST_TILT: f64 = 0.01;

/// Residual to which a coarser grid is solved: its own error is larger.
const START: f64 = 1e-3;

/// Relative difference of gaps that counts as none.
const SAME: f64 = 1e-12;

/// What to do where cells do not cover the contact.
pub(crate) const WIDER: &str = "give a larger [cells] half_width_m, or none";

/// Bytes for each padded cell: spectra, transforms and the vectors of the iteration.
const BYTES: f64 = 60.0;

/// A contact of two bodies on cells.
#[derive(Debug, Clone)]
pub struct CellProblem {
    /// The cells.
    pub grid: Grid,
    /// The images of every cell, for each body that has some.
    pub images: Vec<Images>,
    /// What ends that are free of traction add to images of full weight.
    pub free: Option<Arc<FreeEnds>>,
    /// Load (C^2 p0); (pi / 2) times the length of the contact for the Hertz pressure p0.
    pub load: f64,
    /// The tilt.
    pub tilt: CellTilt,
    /// Relative residual of the iteration.
    pub tolerance: f64,
    /// Most applications of the compliance on the finest grid.
    pub most_iterations: usize,
}

/// What is known of the bodies' tilt, of far points as the approach is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CellTilt {
    /// It is held (C / (2 R)).
    Held(f64),
    /// It is free, and the load's line of action lies at this y (C).
    Free(f64),
}

/// Whether a field is even in x and y, so that a quarter of it tells all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Symmetry {
    Quarter,
    None,
}

/// What the grids of one problem share.
struct Level<'a> {
    gap: &'a dyn Gap,
    symmetry: Symmetry,
    ends: Option<&'a FreeEnds>,
    /// Told of every step: applications of the compliance so far, and the residual.
    progress: &'a dyn Fn(usize, f64),
}

impl CellProblem {
    /// Solves the contact of bodies with this `gap`.
    ///
    /// # Errors
    /// [`Error::Uncovered`] where the contact reaches the edge of the cells in x,
    /// [`Error::NotConverged`], and [`Error::Memory`] before anything large is allocated.
    pub fn solve(&self, gap: &dyn Gap) -> Result<CellPressure> {
        self.solve_telling(gap, None, &|_, _| {})
    }

    /// [`CellProblem::solve`] that begins with the pressures `first`, those of a similar problem on
    /// the same cells, and tells `progress` of every step on any of its grids: how often the
    /// compliance was applied there, and the relative residual.
    ///
    /// # Errors
    /// As [`CellProblem::solve`].
    pub fn solve_telling(
        &self,
        gap: &dyn Gap,
        first: Option<&CellPressure>,
        progress: &dyn Fn(usize, f64),
    ) -> Result<CellPressure> {
        let grid = &self.grid;
        let ends = self.free.as_ref().map_or(0.0, |ends| ends.bytes(grid));
        check_memory(
            &format!("a contact on {} x {} cells", grid.nx, grid.ny),
            BYTES * 4.0 * grid.len() as f64 + ends,
            "ask for fewer cells, or for a [cells] half_width_m that just covers the contact",
        )?;
        let gap = &Tilted { gap, tilt: self.tilt };
        let gaps = grid.sample(|x, y| gap.at(x, y));
        let symmetry = self.symmetry(&gaps);
        let quarter = self.free.as_ref().is_some_and(|free| free.is_symmetric());
        if symmetry == Symmetry::None && quarter {
            return Err(Error::Value {
                key: "free ends".into(),
                value: "those of a symmetric contact".into(),
                reason: "the contact is not symmetric in x and y".into(),
                remedy: "build them for any pressure".into(),
            });
        }
        let level = Level { gap, symmetry, ends: self.free.as_deref(), progress };
        let own = first.filter(|first| first.grid == *grid).map(|first| &first.pressure[..]);
        let state = self.solve_level(&level, gaps, *grid, own, self.tolerance)?;
        let State { pressure, gap, motion, residual, iterations } = state;
        if residual.is_nan() || residual > self.tolerance {
            go_on()?;
            if let CellTilt::Free(arm) = self.tilt {
                return self.solve_balanced(level.gap, arm, progress);
            }
            return Err(Error::NotConverged {
                iterations,
                residual,
                remedy: "give a larger --tolerance, or other --cells".into(),
            });
        }
        let [pressure, gap] = [pressure, gap].map(|part| unfold(grid, symmetry, part));
        check_covered(grid, &pressure)?;
        let tilt = match self.tilt {
            CellTilt::Held(tilt) => tilt,
            CellTilt::Free(_) => motion.tilt,
        };
        let approach = motion.approach;
        Ok(CellPressure { grid: *grid, pressure, gap, approach, tilt, iterations, residual })
    }

    /// A contact that is free to tilt, under a load whose line of action lies at `arm`, by the held
    /// tilt at which the pressures' resultant lies there. On few cells, of two asperities or one
    /// row, force and moment leave the iteration no freedom; a held tilt leaves it some. The
    /// resultant moves towards the side that is tilted deeper.
    fn solve_balanced(
        &self,
        gap: &dyn Gap,
        arm: f64,
        progress: &dyn Fn(usize, f64),
    ) -> Result<CellPressure> {
        let grid = &self.grid;
        let mut iterations = 0;
        let mut last: Option<CellPressure> = None;
        let mut held = |tilt: f64| -> Result<(f64, CellPressure)> {
            let problem = Self { tilt: CellTilt::Held(tilt), ..self.clone() };
            let mut found = problem.solve_telling(gap, last.as_ref(), progress)?;
            iterations += found.iterations;
            found.iterations = iterations;
            let places = found.pressure.iter().enumerate();
            let moment: f64 = places.map(|(i, p)| p * grid.y(i / grid.nx)).sum();
            last = Some(found.clone());
            Ok((moment / found.pressure.iter().sum::<f64>() - arm, found))
        };
        // Both in units in which the one is about the other.
        let unit = FIRST_TILT / grid.half_length;
        let (mut secants, mut tilt, mut off) = (Secants::new(), 0.0, f64::INFINITY);
        for _ in 0..MOST_TILTS {
            let (by, found) = held(unit * tilt)?;
            let value = by / grid.half_length;
            off = value.abs();
            if off <= self.tolerance {
                return Ok(found);
            }
            tilt = secants.next(tilt, value);
        }
        Err(Error::NotConverged {
            iterations,
            residual: off,
            remedy: "give other --cells, or a held tilt_rad in place of eccentricity_m".into(),
        })
    }

    /// The symmetry of a contact with these `gaps`.
    fn symmetry(&self, gaps: &[f64]) -> Symmetry {
        let apart = |images: &Images| images.middle != 0.0;
        let skew = self.images.iter().any(apart)
            || matches!(self.tilt, CellTilt::Free(_))
            || self.free.as_ref().is_some_and(|free| !free.is_symmetric());
        if skew { Symmetry::None } else { symmetry(&self.grid, gaps) }
    }

    /// Solves on `grid`, from `first` or else from what a grid of half as many cells in each
    /// direction gives.
    fn solve_level(
        &self,
        level: &Level,
        gaps: Vec<f64>,
        grid: Grid,
        first: Option<&[f64]>,
        tolerance: f64,
    ) -> Result<State> {
        let symmetry = level.symmetry;
        let Grid { nx, ny, .. } = grid;
        let start = if let Some(first) = first {
            first.to_vec()
        } else if nx.min(ny) < COARSEST {
            vec![1.0; grid.len()]
        } else {
            // Even numbers stay symmetric.
            let half = |n: usize| n.div_ceil(4) * 2;
            let coarse = Grid { nx: half(nx), ny: half(ny), ..grid };
            let gaps = coarse.sample(|x, y| level.gap.at(x, y));
            let state = self.solve_level(level, gaps, coarse, None, tolerance.max(START))?;
            let pressure = unfold(&coarse, symmetry, state.pressure);
            refine(&coarse, &pressure, &grid)
        };
        let (a, b) = grid.half_sides();
        let mut displacement = self.displacement(&grid, symmetry, level.ends);
        let (mut inverse, share) = match symmetry {
            Symmetry::Quarter => (inverse(&grid, [nx / 2, ny / 2], 0.5), 0.25),
            Symmetry::None => (inverse(&grid, [nx, ny], 1.0), 1.0),
        };
        let total = share * self.load / (4.0 * a * b);
        let arms = match self.tilt {
            CellTilt::Held(_) => None,
            CellTilt::Free(arm) => Some((grid.sample(|_, y| y), arm * total)),
        };
        let mut problem = Complementarity {
            displacement: &mut *displacement,
            inverse: &mut inverse,
            gap: &fold(&grid, symmetry, gaps),
            total,
            arms: arms.as_ref().map(|(arms, moment)| (&arms[..], *moment)),
        };
        let start = fold(&grid, symmetry, start);
        Ok(problem.solve(start, tolerance, self.most_iterations, level.progress))
    }

    /// The gaps (C^2 / (2 R)) over the cells under the pressures of `solution`, those of the
    /// problem's contact with this `gap`.
    pub fn gaps(&self, gap: &dyn Gap, solution: &CellPressure) -> Vec<f64> {
        let grid = &self.grid;
        let gap = &Tilted { gap, tilt: CellTilt::Held(solution.tilt) };
        let gaps = grid.sample(|x, y| gap.at(x, y));
        let symmetry = self.symmetry(&gaps);
        let pressure = fold(grid, symmetry, solution.pressure.clone());
        let mut moved = vec![0.0; pressure.len()];
        let mut displacement = self.displacement(grid, symmetry, self.free.as_deref());
        displacement.apply(&pressure, &mut moved);
        let moved = unfold(grid, symmetry, moved);
        gaps.iter().zip(moved).map(|(gap, u)| gap + u - solution.approach).collect()
    }

    /// Eq. 2 with free ends.
    fn displacement(
        &self,
        grid: &Grid,
        symmetry: Symmetry,
        ends: Option<&FreeEnds>,
    ) -> Box<dyn Linear> {
        match symmetry {
            Symmetry::Quarter => Box::new(self.even(grid, ends)),
            Symmetry::None => Box::new(self.whole(grid, ends)),
        }
    }

    /// Eq. 2 for an even pressure.
    fn even(&self, grid: &Grid, ends: Option<&FreeEnds>) -> EvenConvolution {
        let [mx, my] = [good_length(grid.nx), good_length(grid.ny)];
        let scale = 1.0 / (mx * my) as f64;
        let round = ends.map_or(&[][..], FreeEnds::round);
        let table = Table::even(grid, [mx, my], &self.images, round);
        let spectrum = table.spectrum(Parity::Even, scale);
        let ends = ends.map(|ends| ends.on_cells(grid, mx));
        EvenConvolution::new([grid.nx / 2, grid.ny / 2], [mx, my], spectrum, ends)
    }

    /// Eq. 2 for any pressure.
    fn whole(&self, grid: &Grid, ends: Option<&FreeEnds>) -> WholeConvolution {
        let [mx, my] = [good_length(grid.nx), good_length(grid.ny)];
        let scale = 1.0 / (4 * mx * my) as f64;
        let round = ends.map_or(&[][..], FreeEnds::round);
        let direct = Table::direct(grid, [mx, my], round).spectrum(Parity::Even, scale);
        let apart = self.images.iter().any(|images| images.middle != 0.0);
        let images = Parity::BOTH.map(|parity| match parity {
            Parity::Even if self.images.is_empty() => Vec::new(),
            Parity::Odd if !apart => Vec::new(),
            _ => Table::images(grid, [mx, my], &self.images, round, parity).spectrum(parity, scale),
        });
        let ends = ends.map(|ends| ends.on_cells(grid, mx));
        WholeConvolution::new([grid.nx, grid.ny], [mx, my], direct, images, ends)
    }
}

/// A gap with a tilt that is held.
struct Tilted<'a> {
    gap: &'a dyn Gap,
    tilt: CellTilt,
}

impl Gap for Tilted<'_> {
    fn at(&self, x: f64, y: f64) -> f64 {
        let closed = match self.tilt {
            CellTilt::Held(tilt) => tilt * y,
            CellTilt::Free(_) => 0.0,
        };
        self.gap.at(x, y) - closed
    }
}

/// An approximate inverse of the compliance on `nx` x `ny` cells, `part` of the grid's width and
/// length, whose edges mirror: u = 2 p / k for waves of wavenumber k on a half-space. The longest
/// waves are not told from those of half a period over the region's width.
fn inverse(grid: &Grid, [nx, ny]: [usize; 2], part: f64) -> EvenConvolution {
    let base = |half: f64| PI / (2.0 * half * part);
    let (kx, ky) = (base(grid.half_width), base(grid.half_length));
    let scale = 0.5 / (nx * ny) as f64;
    let factor = |k: usize, l: usize| scale * (k as f64 * kx).hypot(l as f64 * ky).max(0.5 * kx);
    let spectrum = (0..=nx).flat_map(|k| (0..=ny).map(move |l| factor(k, l))).collect();
    EvenConvolution::new([nx, ny], [nx, ny], spectrum, None)
}

/// The symmetry of `values` over the grid.
fn symmetry(grid: &Grid, values: &[f64]) -> Symmetry {
    let Grid { nx, ny, .. } = *grid;
    let scale = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let same = |a: f64, b: f64| (a - b).abs() <= SAME * scale;
    let even = nx.is_multiple_of(2)
        && ny.is_multiple_of(2)
        && values.chunks_exact(nx).zip(values.chunks_exact(nx).rev()).all(|(row, opposite)| {
            let mirrored = || row.iter().zip(row.iter().rev());
            mirrored().all(|(a, b)| same(*a, *b))
                && row.iter().zip(opposite).all(|(a, b)| same(*a, *b))
        });
    if even { Symmetry::Quarter } else { Symmetry::None }
}

/// The part of a field that tells all of it.
fn fold(grid: &Grid, symmetry: Symmetry, field: Vec<f64>) -> Vec<f64> {
    let Grid { nx, ny, .. } = *grid;
    match symmetry {
        Symmetry::Quarter => {
            field.chunks_exact(nx).skip(ny / 2).flat_map(|row| row[nx / 2..].to_vec()).collect()
        }
        Symmetry::None => field,
    }
}

/// The inverse of [`fold`].
fn unfold(grid: &Grid, symmetry: Symmetry, part: Vec<f64>) -> Vec<f64> {
    if symmetry == Symmetry::None {
        return part;
    }
    let (nx, ny) = (grid.nx / 2, grid.ny / 2);
    let mirror = |i: usize, n: usize| if i < n { n - 1 - i } else { i - n };
    let rows = (0..grid.ny).map(|j| &part[mirror(j, ny) * nx..][..nx]);
    rows.flat_map(|row| (0..grid.nx).map(move |i| row[mirror(i, nx)])).collect()
}

/// The field over the cells of `coarse` at the centres of those of `fine`, bilinearly between
/// centres.
fn refine(coarse: &Grid, field: &[f64], fine: &Grid) -> Vec<f64> {
    let places = |from: usize, to: usize| -> Vec<(usize, f64)> {
        let place = |i: usize| {
            let at =
                ((i as f64 + 0.5) * from as f64 / to as f64 - 0.5).clamp(0.0, (from - 1) as f64);
            let below = (at as usize).min(from - 2);
            (below, at - below as f64)
        };
        (0..to).map(place).collect()
    };
    let (xs, ys) = (places(coarse.nx, fine.nx), places(coarse.ny, fine.ny));
    let value = |i: usize, j: usize| field[j * coarse.nx + i];
    let at = |&(i, s): &(usize, f64), &(j, t): &(usize, f64)| {
        let row = |j| (1.0 - s) * value(i, j) + s * value(i + 1, j);
        (1.0 - t) * row(j) + t * row(j + 1)
    };
    ys.iter().flat_map(|y| xs.iter().map(|x| at(x, y)).collect::<Vec<_>>()).collect()
}

/// Refuses a contact that reaches the edges of the cells in x, where it would go on.
fn check_covered(grid: &Grid, pressure: &[f64]) -> Result<()> {
    let edges = pressure.chunks_exact(grid.nx).flat_map(|row| [row[0], row[grid.nx - 1]]);
    let largest = edges.fold(0.0, f64::max);
    if largest > 0.0 {
        return Err(Error::Uncovered {
            half_width: grid.half_width,
            touched: grid.half_width,
            reason: format!("there are {largest:.1e} p0 at their edge"),
            remedy: WIDER.into(),
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::influence::influence;
    use super::*;
    use crate::base::linear;
    use crate::body::guilbault_psi;
    use crate::contact::Straight;
    use nalgebra::DMatrix;

    /// A crowned cylinder, tilted and moved across.
    struct Skew;

    impl Gap for Skew {
        fn at(&self, x: f64, y: f64) -> f64 {
            (x - 0.1).powi(2) + 0.01 * (y + 0.3).powi(2) + 0.02 * y + 0.01 * x * y
        }
    }

    fn problem(nx: usize, ny: usize, images: Vec<Images>) -> CellProblem {
        let grid = Grid::new(nx, ny, 1.6, 3.0).unwrap();
        let load = 0.5 * PI * 2.0 * grid.half_length;
        let tilt = CellTilt::Held(0.0);
        CellProblem { grid, images, free: None, load, tilt, tolerance: 1e-12, most_iterations: 500 }
    }

    /// One body that ends with the contact, one that goes on for a while, by Guilbault's psi.
    fn guilbault() -> Vec<Images> {
        [(3.0, 0.3, 0.55), (4.37, 0.2, 0.45)]
            .map(|(half, nu, share)| Images {
                half,
                middle: 0.0,
                weight: share * guilbault_psi(nu),
            })
            .to_vec()
    }

    /// Two bodies beside each other.
    fn offset() -> Vec<Images> {
        [(3.5, 0.5, 0.8), (4.2, -0.7, 0.6)]
            .map(|(half, middle, weight)| Images { half, middle, weight })
            .to_vec()
    }

    /// The flexibility matrix, entry by entry: Eqs. 2 and 3, with the images where they are.
    fn dense(problem: &CellProblem) -> DMatrix<f64> {
        let (grid, cell) = (&problem.grid, problem.grid.half_sides());
        let at = |cell: usize| (grid.x(cell % grid.nx), grid.y(cell / grid.nx));
        DMatrix::from_fn(grid.len(), grid.len(), |row, column| {
            let ((x, y), (from_x, from_y)) = (at(row), at(column));
            let faces = problem.images.iter().flat_map(|i| [(i, i.half), (i, -i.half)]);
            let image = |(i, half): (&Images, f64)| {
                let image = 2.0 * (i.middle + half) - from_y;
                i.weight * influence(x - from_x, y - image, cell)
            };
            influence(x - from_x, y - from_y, cell) + faces.map(image).sum::<f64>()
        })
    }

    /// The contact by elimination on sets of cells that change until they are right.
    fn dense_solution(problem: &CellProblem, gap: &dyn Gap) -> (Vec<f64>, [f64; 2]) {
        let matrix = dense(problem);
        let gaps = problem.grid.sample(|x, y| gap.at(x, y));
        let (a, b) = problem.grid.half_sides();
        let mut set: Vec<usize> = (0..gaps.len()).collect();
        loop {
            let n = set.len();
            let free = match problem.tilt {
                CellTilt::Held(_) => None,
                CellTilt::Free(arm) => Some(arm),
            };
            let size = n + 1 + usize::from(free.is_some());
            let mut system = DMatrix::zeros(size, size);
            let mut right = DMatrix::zeros(size, 1);
            for (i, &row) in set.iter().enumerate() {
                set.iter()
                    .enumerate()
                    .for_each(|(j, &column)| system[(i, j)] = matrix[(row, column)]);
                (system[(i, n)], system[(n, i)], right[i]) = (-1.0, 1.0, -gaps[row]);
            }
            right[n] = problem.load / (4.0 * a * b);
            let y = |cell: usize| problem.grid.y(cell / problem.grid.nx);
            if let Some(arm) = free {
                for (i, &row) in set.iter().enumerate() {
                    (system[(i, n + 1)], system[(n + 1, i)]) = (-y(row), y(row));
                }
                right[n + 1] = arm * right[n];
            }
            let solution = linear::solve(system, right).unwrap();
            let mut p = vec![0.0; gaps.len()];
            set.iter().zip(solution.iter()).for_each(|(cell, value)| p[*cell] = *value);
            let u = &matrix * DMatrix::from_column_slice(p.len(), 1, &p);
            let tilt = free.map_or(0.0, |_| solution[n + 1]);
            let moved = |cell: usize| solution[n] + tilt * y(cell);
            let inside = |cell: &usize| match set.binary_search(cell) {
                Ok(_) => p[*cell] > 0.0,
                Err(_) => u[*cell] + gaps[*cell] < moved(*cell) - 1e-13,
            };
            let next: Vec<usize> = (0..gaps.len()).filter(inside).collect();
            if next == set {
                return (p, [solution[n], tilt]);
            }
            set = next;
        }
    }

    fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()))
    }

    #[test]
    fn convolutions_are_the_flexibility_matrix() {
        for (nx, ny, images) in [(10, 14, guilbault()), (11, 7, guilbault()), (10, 9, offset())] {
            let problem = problem(nx, ny, images);
            let skew: Vec<f64> = (0..nx * ny).map(|i| (1.0 + (i * i) as f64).sin()).collect();
            let mut got = vec![f64::NAN; skew.len()];
            problem.whole(&problem.grid, None).apply(&skew, &mut got);
            let want = dense(&problem) * DMatrix::from_column_slice(nx * ny, 1, &skew);
            assert!(largest_difference(&got, want.as_slice()) < 1e-12);
        }
        let problem = problem(10, 14, guilbault());
        let even = problem.grid.sample(|x, y| (1.0 + x * x + 3.0 * y * y).sin());
        let want = dense(&problem) * DMatrix::from_column_slice(even.len(), 1, &even);
        let want = fold(&problem.grid, Symmetry::Quarter, want.as_slice().to_vec());
        let mut got = vec![f64::NAN; want.len()];
        let even = fold(&problem.grid, Symmetry::Quarter, even);
        problem.even(&problem.grid, None).apply(&even, &mut got);
        assert!(largest_difference(&got, &want) < 1e-12);
    }

    #[test]
    fn contacts_are_those_of_the_dense_equations() {
        for images in [Vec::new(), guilbault(), offset()] {
            for (gap, tilt) in [
                (&Straight as &dyn Gap, CellTilt::Held(0.0)),
                (&Skew, CellTilt::Held(0.0)),
                (&Skew, CellTilt::Free(-0.2)),
                (&Straight, CellTilt::Free(0.3)),
            ] {
                let problem = CellProblem { tilt, ..problem(18, 16, images.clone()) };
                let got = problem.solve(gap).unwrap();
                let (pressure, [approach, tilt]) = dense_solution(&problem, gap);
                let off = largest_difference(&got.pressure, &pressure);
                assert!(off < 1e-10, "{off:e} {got:?}");
                assert!((got.approach - approach).abs() < 1e-10);
                assert!((got.tilt - tilt).abs() < 1e-10);
            }
        }
    }

    #[test]
    fn symmetric_contacts_are_told_and_solved_alike_on_the_quarter() {
        let problem = problem(20, 30, guilbault());
        let gaps = |gap: &dyn Gap| problem.grid.sample(|x, y| gap.at(x, y));
        assert_eq!(symmetry(&problem.grid, &gaps(&Straight)), Symmetry::Quarter);
        assert_eq!(symmetry(&problem.grid, &gaps(&Skew)), Symmetry::None);
        let [quarter, whole] = [Symmetry::Quarter, Symmetry::None].map(|symmetry| {
            let level = Level { gap: &Straight, symmetry, ends: None, progress: &|_, _| {} };
            let all = gaps(&Straight);
            let state = problem.solve_level(&level, all, problem.grid, None, 1e-12).unwrap();
            unfold(&problem.grid, symmetry, state.pressure)
        });
        assert!(largest_difference(&quarter, &whole) < 1e-10);
    }

    #[test]
    fn coarser_grids_only_give_the_start_and_threads_change_nothing() {
        for gap in [&Straight as &dyn Gap, &Skew] {
            let problem = CellProblem { tolerance: 1e-10, ..problem(110, 98, guilbault()) };
            let [one, three] = [1, 3].map(|threads| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| problem.solve(gap).unwrap())
            });
            assert_eq!(one, three);
            let (a, b) = problem.grid.half_sides();
            let load = 4.0 * a * b * one.pressure.iter().sum::<f64>();
            assert!((load / problem.load - 1.0).abs() < 1e-12);
            assert!(one.iterations < 60, "{}", one.iterations);
        }
    }

    /// Two spherical asperities on a plane.
    struct Asperities;

    impl Gap for Asperities {
        fn at(&self, x: f64, y: f64) -> f64 {
            let about =
                |[u, v, height]: [f64; 3]| 5.0 * ((x - u).powi(2) + (y - v).powi(2)) - height;
            about([0.3, -1.9, 0.0]).min(about([-0.4, 1.3, 0.2])).min(0.5)
        }
    }

    /// A few cells, which force and moment all but determine; a tilt of their own ended in no
    /// numbers.
    #[test]
    fn a_free_tilt_is_found_on_few_cells() {
        for (nx, ny, load) in [(24, 26, 1e-4), (24, 26, 1e-2), (60, 58, 1e-3)] {
            for arm in [-1.2, 0.4] {
                let images = guilbault();
                let tilt = CellTilt::Free(arm);
                let problem =
                    CellProblem { load, tilt, tolerance: 1e-9, ..problem(nx, ny, images) };
                let got = problem.solve(&Asperities).unwrap();
                let (a, b) = problem.grid.half_sides();
                let carried = 4.0 * a * b * got.pressure.iter().sum::<f64>();
                assert!((carried / load - 1.0).abs() < 1e-12);
                let places = got.pressure.iter().enumerate();
                let moment: f64 = places.map(|(i, p)| p * problem.grid.y(i / nx)).sum();
                assert!((4.0 * a * b * moment / load - arm).abs() < 1e-8);
                for (p, gap) in got.pressure.iter().zip(problem.gaps(&Asperities, &got)) {
                    let open = if *p > 0.0 { gap.abs() } else { (-gap).max(0.0) };
                    assert!(open < 1e-6 * load, "{nx} {load} {arm}: {p} {gap}");
                }
            }
        }
    }

    #[test]
    fn cells_that_do_not_cover_the_contact_are_refused() {
        let mut problem = problem(40, 40, Vec::new());
        problem.grid.half_width = 0.8;
        let said = problem.solve(&Straight).unwrap_err().to_string();
        assert!(
            said.starts_with("the cells, which end at x = 0.8000 C, do not cover the contact"),
            "{said}"
        );
    }
}
