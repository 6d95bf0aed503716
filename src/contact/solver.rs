use super::check::check;
use crate::base::{Error, Panels, Result, Wavenumbers, linear};
use crate::kernels::strip;
use multiversion::{multiversion, target::target_cfg_f};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use std::f64::consts::PI;
use std::ops::Range;
use std::sync::LazyLock;

/// The compliance of both bodies together, one matrix per wavenumber.
#[derive(Debug, Clone)]
pub struct Compliance<'a> {
    /// Wavenumbers > 0 and their quadrature over (0, infinity).
    pub wavenumbers: &'a Wavenumbers,
    /// C(k) at the coarse wavenumbers: displacement at the axis's nodes per pressure at the nodes; it
    /// tends to 2 pi / k times the identity for large k.
    pub matrices: &'a [DMatrix<f64>],
}

/// Settings of the contact solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSettings {
    /// Modes of the pressure across the contact.
    pub modes: usize,
    /// Smallest distance along the line, of each other and from its end, of nodes whose half-width is
    /// an unknown of its own.
    pub spacing: f64,
    /// Largest amplitude of the pressure's edge singularity that counts as none (p0).
    pub tolerance: f64,
    /// Iterations after which it gives up.
    pub max_iterations: usize,
    /// How far a solution may break the laws of contact: penetration and gap under the pressure
    /// (C^2 / (2 R)), and pull (p0).
    pub soundness: f64,
}

/// Contact pressure of the whole line.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSolution {
    /// Half-width of the contact at each node.
    pub half_widths: Vec<f64>,
    /// Coefficients of the modes at each node.
    pub coefficients: Vec<Vec<f64>>,
    /// Approach in units of C^2 / (2 R), relative to points at a distance that the smallest
    /// wavenumber sets: subtract [`reference()`] for a depth of one's own.
    pub approach: f64,
    /// Iterations done.
    pub iterations: usize,
    /// [`ContactSettings::spacing`] with which it converged.
    pub spacing: f64,
    /// Amplitude of the edge singularity that was left (p0).
    pub residual: f64,
    /// |load - prescribed| / prescribed.
    pub load_error: f64,
}

impl ContactSolution {
    /// Fourier transform int p cos(k x) dx of the pressure at every node.
    pub(super) fn transform(&self, k: f64) -> DVector<f64> {
        let mut modes = Vec::new();
        DVector::from_fn(self.half_widths.len(), |j, _| {
            let coefficients = &self.coefficients[j];
            modes.resize(coefficients.len(), 0.0);
            strip::transforms(self.half_widths[j], k, &mut modes);
            modes.iter().zip(coefficients).map(|(t, c)| t * c).sum()
        })
    }
}

/// Distance at which the closed logarithmic kernel of the local, plane part is screened, so that
/// what is left for the quadrature over wavenumbers is finite at k = 0 and fades quickly.
const SCREEN: f64 = 2.0;

/// Entries of the collocation matrix per wavenumber that are as good as none, relative to the
/// tolerance of the singularity.
const NEGLIGIBLE: f64 = 0.1;

/// Distance from the line's end (C) beyond which a few modes describe the pressure.
const DISTURBED: f64 = 1.0;
const INNER_MODES: usize = 3;

/// Iterations of an attempt that is not the last.
const ATTEMPT: usize = 26;

/// Points across the contact at which a pressure's sign is looked at.
const SHAPE_POINTS: i32 = 8;

/// Points of the Gauss-Chebyshev rule for the screened part, smooth over the contact.
const SCREEN_POINTS: usize = 12;

/// Solves for the pressure whose mean over the axis is the Hertz line load pi/2.
///
/// For half-widths that are held the problem is linear: at every node the modes are found by
/// collocation, with the approach from the load. Nodes whose half-width is an unknown also have the
/// amplitude b of the singular mode 1/sqrt(1 - t^2); a boundary that lies right leaves b = 0. To
/// first order b / sqrt(1 - t^2) is what moving the boundary of S sqrt(1 - t^2) to
/// a sqrt(1 + 2 b / S) does, so the update is Newton's and converges quadratically.
///
/// # Errors
/// [`Error::NotConverged`] when the boundary does not settle, [`Error::Unsound`] when the solution breaks a
/// law of contact.
pub fn solve(
    compliance: &Compliance,
    axis: &Panels,
    settings: &ContactSettings,
) -> Result<ContactSolution> {
    let remainders = Remainders::new(compliance, axis.len(), NEGLIGIBLE * settings.tolerance);
    // A pressure that is singular at the end (a half-space's) may want fewer unknown half-widths.
    let mut attempt =
        ContactSettings { max_iterations: ATTEMPT.min(settings.max_iterations), ..*settings };
    let checked = |attempt: &ContactSettings| {
        let solution = solve_once(compliance, &remainders, axis, attempt)?;
        check(compliance, &remainders, axis, &solution, settings.soundness)?;
        Ok(solution)
    };
    for _ in 0..3 {
        let answer = checked(&attempt);
        if answer.is_ok() {
            return answer;
        }
        attempt.spacing *= 2.0;
    }
    attempt.max_iterations = settings.max_iterations;
    checked(&attempt)
}

/// [`solve`] with the spacing as it is given.
fn solve_once(
    compliance: &Compliance,
    remainders: &Remainders,
    axis: &Panels,
    settings: &ContactSettings,
) -> Result<ContactSolution> {
    let n = axis.len();
    let length: f64 = axis.weights().iter().sum();
    let load = 0.5 * PI * length;
    let mut layout = Layout::new(axis, settings);
    let mut half_widths = vec![1.0; n];
    // Edge slopes S of the pressure at the nodes: sum (2m + 1) c_m.
    let mut slopes = vec![1.0; n];
    let mut last = f64::INFINITY;
    for iteration in 1..=settings.max_iterations {
        let problem = Linear {
            compliance,
            remainders,
            axis,
            layout: &layout,
            half_widths: &half_widths,
            slopes: &slopes,
        };
        let unknowns = problem.solve(load)?;
        for (j, slope) in slopes.iter_mut().enumerate() {
            let own = &unknowns.as_slice()[layout.modes(j)];
            *slope = own.iter().enumerate().map(|(m, c)| (2 * m + 1) as f64 * c).sum();
        }
        let mut worst: f64 = 0.0;
        let wanted: Vec<f64> = layout
            .free
            .iter()
            .map(|&j| {
                let singular = unknowns[layout.singular(j)];
                worst = worst.max(singular.abs());
                // A step beyond a factor of two would leave the region where the linearisation holds.
                let grow = if slopes[j] > 0.0 { 1.0 + 2.0 * singular / slopes[j] } else { 0.25 };
                half_widths[j] * grow.clamp(0.25, 4.0).sqrt()
            })
            .collect();
        last = worst;
        if worst <= settings.tolerance && !layout.release(&unknowns) {
            let mut coefficients: Vec<Vec<f64>> =
                (0..n).map(|j| unknowns.as_slice()[layout.modes(j)].to_vec()).collect();
            // What the singular modes carry, below the tolerance, goes to the others.
            let carried = |coefficients: &[Vec<f64>]| -> f64 {
                let line = |j: usize| {
                    let a = half_widths[j];
                    axis.weights()[j] * strip::cumulative(a, &coefficients[j], a)
                };
                (0..n).map(line).sum()
            };
            let scale = load / carried(&coefficients);
            coefficients.iter_mut().flatten().for_each(|c| *c *= scale);
            let load_error = (carried(&coefficients) / load - 1.0).abs();
            let approach = unknowns[layout.size() - 1];
            return Ok(ContactSolution {
                half_widths,
                coefficients,
                approach,
                iterations: iteration,
                spacing: settings.spacing,
                residual: worst,
                load_error,
            });
        }
        for (a, shares) in half_widths.iter_mut().zip(&layout.shares) {
            *a = shares.iter().map(|(free, share)| share * wanted[*free]).sum::<f64>().max(0.05);
        }
    }
    Err(Error::NotConverged {
        iterations: settings.max_iterations,
        residual: last,
        remedy: "ask for a coarser [accuracy] tolerance, or check the case's lengths".into(),
    })
}

/// Which unknowns each node has. Free nodes have all modes and the singular one, whose amplitude
/// says how their half-width has to move. Next to the end of the line nodes stand closer than the
/// shortest wave: half-widths of their own would be noise there, so they follow linearly from those
/// of the free nodes, at least `spacing` apart. A node behind the last free one whose pressure would
/// pull loses modes, the higher ones first; with none left it carries no pressure.
#[derive(Debug, Clone)]
struct Layout {
    /// The free nodes, ascending.
    free: Vec<usize>,
    /// The half-width of each node in those of the free ones: positions in `free`, and shares.
    shares: Vec<[(usize, f64); 2]>,
    /// Modes of each node.
    counts: Vec<usize>,
    /// The first unknown of each node, and one more for the end.
    starts: Vec<usize>,
}

impl Layout {
    fn new(axis: &Panels, settings: &ContactSettings) -> Self {
        let mut limit = axis.end() - settings.spacing;
        let mut free = Vec::new();
        for (j, &y) in axis.nodes().iter().enumerate().rev() {
            if y <= limit || j == 0 && free.is_empty() {
                free.push(j);
                limit = y - settings.spacing;
            }
        }
        free.reverse();
        let shares = axis
            .nodes()
            .iter()
            .enumerate()
            .map(|(j, y)| {
                let after = free.partition_point(|f| *f < j);
                if after == 0 || free.len() == 1 {
                    return [(0, 1.0), (0, 0.0)];
                }
                let before = after.min(free.len() - 1) - 1;
                let [a, b] = [before, before + 1].map(|i| axis.nodes()[free[i]]);
                let share = (y - a) / (b - a);
                [(before, 1.0 - share), (before + 1, share)]
            })
            .collect();
        let inner = axis.end() - DISTURBED;
        let modes_at =
            |y: &f64| if *y < inner { settings.modes.min(INNER_MODES) } else { settings.modes };
        let counts = axis.nodes().iter().map(modes_at).collect();
        let mut layout = Self { free, shares, counts, starts: Vec::new() };
        layout.number();
        layout
    }

    /// Numbers the unknowns.
    fn number(&mut self) {
        let mut next = 0;
        self.starts.clear();
        for (j, modes) in self.counts.iter().enumerate() {
            self.starts.push(next);
            next += modes + usize::from(self.is_free(j));
        }
        self.starts.push(next);
    }

    fn is_free(&self, j: usize) -> bool {
        self.free.binary_search(&j).is_ok()
    }

    /// Unknowns and collocation equations of node `j`: its modes, then the singular one if it is free.
    fn unknowns(&self, j: usize) -> Range<usize> {
        self.starts[j]..self.starts[j + 1]
    }

    /// The modes of node `j`.
    fn modes(&self, j: usize) -> Range<usize> {
        self.starts[j]..self.starts[j] + self.counts[j]
    }

    /// The singular mode of the free node `j`.
    fn singular(&self, j: usize) -> usize {
        self.starts[j + 1] - 1
    }

    /// Unknowns in all, the approach included.
    fn size(&self) -> usize {
        self.starts[self.counts.len()] + 1
    }

    /// The amplitude of node `j`'s singular mode in those of the free nodes: columns and factors.
    /// Moving the boundary by a part moves amplitudes in proportion to the edge slopes.
    fn singular_parts(&self, j: usize, slopes: &[f64]) -> impl Iterator<Item = (usize, f64)> {
        let own = slopes[j];
        self.shares[j]
            .map(|(position, share)| {
                let free = self.free[position];
                let ratio = if free == j { 1.0 } else { (own / slopes[free]).clamp(0.0, 10.0) };
                (self.singular(free), share * ratio)
            })
            .into_iter()
            .filter(|(_, factor)| *factor != 0.0)
    }

    /// Collocation points of node `j`, as t in (0, 1): zeros of T_2n with the singular mode, else
    /// those of U_2n, the points of Gauss's rule for the weight sqrt(1 - t^2).
    fn points(&self, j: usize) -> impl Iterator<Item = f64> {
        let count = self.unknowns(j).len();
        let free = self.is_free(j);
        (0..count).map(move |l| {
            let angle = if free {
                PI * (2 * l + 1) as f64 / (4 * count) as f64
            } else {
                PI * (l + 1) as f64 / (2 * count + 1) as f64
            };
            angle.cos()
        })
    }

    /// Takes modes from the nodes that are not free and whose pressure is negative somewhere across the
    /// contact: the higher ones where the shape is to blame, all where the mean is; whether there was
    /// one.
    fn release(&mut self, unknowns: &DVector<f64>) -> bool {
        let mut released = false;
        let last = *self.free.last().expect("at least one");
        for j in last + 1..self.counts.len() {
            let c = &unknowns.as_slice()[self.modes(j)];
            let pulls = |modes: &[f64]| {
                (0..=SHAPE_POINTS).any(|i| {
                    // Just inside the edge the sign is that of the slope.
                    let t = 0.999 * f64::from(i) / f64::from(SHAPE_POINTS);
                    strip::pressure(1.0, modes, t) < 0.0
                })
            };
            let left = match c.len() {
                0 => continue,
                _ if c[0] < 0.0 => 0,
                _ if !pulls(c) => continue,
                1 | 2 => 1,
                _ => 2,
            };
            self.counts[j] = left;
            released = true;
        }
        self.number();
        released
    }
}

/// The plane, screened part of C(k), on its diagonal.
fn plane(k: f64) -> f64 {
    -2.0 * PI / k * (-k * SCREEN).exp_m1()
}

/// C(k) at the fine wavenumbers, less its [`plane`] part.
pub(super) struct Remainders {
    nodes: usize,
    /// For each column, each row of it, all wavenumbers.
    entries: Vec<f64>,
    wavenumbers: usize,
    /// For each column and row how many wavenumbers matter, the first ones: short waves are felt at their
    /// own node only, and near the line's end.
    counts: Vec<usize>,
}

/// Points of a node, or modes of one, that are summed side by side.
const TILE: usize = 4;
type Tile = [f64; TILE];

impl Remainders {
    /// Those that are interpolated from the coarse wavenumbers; `negligible` is the displacement that one
    /// entry may leave out.
    pub fn new(compliance: &Compliance, nodes: usize, negligible: f64) -> Self {
        let numbers = compliance.wavenumbers;
        let coarse: Vec<_> = numbers
            .coarse()
            .nodes()
            .iter()
            .zip(compliance.matrices)
            .map(|(&k, c)| c - DMatrix::identity(nodes, nodes) * plane(k))
            .collect();
        let fine = numbers.fine();
        let shares: Vec<_> = (0..fine.len()).map(|i| numbers.interpolation(i)).collect();
        // The singular mode's transform, pi J0(k), falls least.
        let limits = fine.nodes().iter().zip(fine.weights());
        let limits: Vec<f64> =
            limits.map(|(k, w)| negligible * PI / (w * (0.8 / k.sqrt()).min(1.0))).collect();
        let mut entries = vec![0.0; nodes * nodes * fine.len()];
        let mut own = vec![0.0; coarse.len()];
        let mut counts = Vec::with_capacity(nodes * nodes);
        for (at, entries) in entries.chunks_exact_mut(fine.len()).enumerate() {
            own.iter_mut().zip(&coarse).for_each(|(own, matrix)| *own = matrix.as_slice()[at]);
            let mut count = 0;
            for (i, ((first, weights), limit)) in shares.iter().zip(&limits).enumerate() {
                entries[i] = weights.iter().zip(&own[*first..]).map(|(w, c)| w * c).sum();
                if entries[i].abs() > *limit {
                    count = i + 1;
                }
            }
            counts.push(count);
        }
        Self { nodes, entries, wavenumbers: fine.len(), counts }
    }

    /// What node `j` does at node `i`, at all wavenumbers.
    pub fn entries(&self, i: usize, j: usize) -> &[f64] {
        let at = j * self.nodes + i;
        &self.entries[at * self.wavenumbers..(at + 1) * self.wavenumbers]
    }

    /// How many wavenumbers of [`Remainders::entries`] matter, the first ones.
    fn count(&self, i: usize, j: usize) -> usize {
        self.counts[j * self.nodes + i]
    }
}

/// Points x' = cos(f) of Gauss-Chebyshev's rule of the first kind: cos f, sin f and 2 cos 2 f.
pub(super) type ScreenPoint = [f64; 3];

static SCREEN_RULE: LazyLock<[ScreenPoint; SCREEN_POINTS]> = LazyLock::new(|| {
    std::array::from_fn(|q| {
        let angle = PI * (2 * q + 1) as f64 / (2 * SCREEN_POINTS) as f64;
        [angle.cos(), angle.sin(), 2.0 * (2.0 * angle).cos()]
    })
});

/// What screens the plane part at x = `t` `half_width`, (1 / pi) int ln((x - x')^2 + d^2) p(x') dx', by
/// Gauss-Chebyshev: points of x' / `half_width`, and weights of p sin(f) there.
pub(super) fn screened(half_width: f64, t: f64) -> impl Iterator<Item = (ScreenPoint, f64)> {
    SCREEN_RULE.iter().map(move |point| {
        let offset = half_width * (t - point[0]);
        let kernel = 0.5 * (offset * offset + SCREEN * SCREEN).ln();
        (*point, 2.0 / PI * kernel * half_width * PI / SCREEN_POINTS as f64)
    })
}

/// The linear problem for held half-widths: the unknowns of each node, then the approach.
struct Linear<'a> {
    compliance: &'a Compliance<'a>,
    remainders: &'a Remainders,
    axis: &'a Panels,
    layout: &'a Layout,
    half_widths: &'a [f64],
    slopes: &'a [f64],
}

impl Linear<'_> {
    fn solve(&self, load: f64) -> Result<DVector<f64>> {
        let size = self.layout.size();
        let mut matrix = DMatrix::zeros(size, size);
        let mut right = DMatrix::zeros(size, 1);
        self.add_waves(&mut matrix);
        self.add_local(&mut matrix, &mut right);
        right[size - 1] = load;
        let solution = linear::solve(matrix, right).ok_or_else(|| Error::NotConverged {
            iterations: 0,
            residual: f64::INFINITY,
            remedy: "the collocation matrix is singular: check the case's lengths".into(),
        })?;
        Ok(solution.column(0).into_owned())
    }

    /// Adds what the remainders of the compliance displace.
    fn add_waves(&self, matrix: &mut DMatrix<f64>) {
        let (layout, all) = (self.layout, self.remainders.wavenumbers);
        let nodes = 0..self.axis.len();
        let cosines: Vec<Vec<Tile>> = nodes.clone().map(|i| self.cosines(i)).collect();
        for j in nodes {
            let transforms = self.transforms(j);
            // Columns and factors of the node's modes, the singular one last.
            let columns: Vec<Vec<(usize, f64)>> = layout
                .modes(j)
                .map(|mode| vec![(mode, 1.0)])
                .chain([layout.singular_parts(j, self.slopes).collect()])
                .collect();
            for (i, cosines) in cosines.iter().enumerate() {
                let entries = &self.remainders.entries(i, j)[..self.remainders.count(i, j)];
                let rows = layout.unknowns(i);
                for (columns, transforms) in columns.chunks(TILE).zip(transforms.chunks_exact(all))
                {
                    for (row, cosines) in rows.clone().step_by(TILE).zip(cosines.chunks_exact(all))
                    {
                        let sums = sum_waves(entries, transforms, cosines);
                        add_tile(matrix, row..rows.end.min(row + TILE), columns, &sums);
                    }
                }
            }
        }
    }

    /// Cosines at the points of node `i`: tile by tile at all wavenumbers, zeros where none is felt.
    fn cosines(&self, i: usize) -> Vec<Tile> {
        let (all, fine) = (self.remainders.wavenumbers, self.compliance.wavenumbers.fine());
        let count = (0..self.axis.len()).map(|j| self.remainders.count(i, j)).max().unwrap_or(0);
        let mut tiles = vec![[0.0; TILE]; self.layout.unknowns(i).len().div_ceil(TILE) * all];
        for (point, t) in self.layout.points(i).enumerate() {
            let felt = tiles[point / TILE * all..].iter_mut().zip(&fine.nodes()[..count]);
            for (tile, k) in felt {
                tile[point % TILE] = (k * self.half_widths[i] * t).cos();
            }
        }
        tiles
    }

    /// Transforms of node `j`'s modes, the singular one last, times the quadrature's weights: as
    /// [`Linear::cosines`] has them.
    fn transforms(&self, j: usize) -> Vec<Tile> {
        let (all, fine) = (self.remainders.wavenumbers, self.compliance.wavenumbers.fine());
        let count = (0..self.axis.len()).map(|i| self.remainders.count(i, j)).max().unwrap_or(0);
        let mut modes = vec![0.0; self.layout.counts[j]];
        let mut tiles = vec![[0.0; TILE]; (modes.len() + 1).div_ceil(TILE) * all];
        for (at, (k, w)) in fine.nodes().iter().zip(fine.weights()).take(count).enumerate() {
            let singular = strip::transforms(self.half_widths[j], *k, &mut modes);
            for (mode, transform) in modes.iter().chain([&singular]).enumerate() {
                tiles[mode / TILE * all + at][mode % TILE] = w / (PI * PI) * transform;
            }
        }
        tiles
    }

    /// Adds the plane, screened part, the approach, the gap and the load's equation.
    fn add_local(&self, matrix: &mut DMatrix<f64>, right: &mut DMatrix<f64>) {
        let (layout, last) = (self.layout, self.layout.size() - 1);
        let most = layout.counts.iter().copied().max().unwrap_or(0);
        let mut local = vec![0.0; most];
        for (i, &a) in self.half_widths.iter().enumerate() {
            let modes = layout.modes(i);
            let singular: Vec<(usize, f64)> = layout.singular_parts(i, self.slopes).collect();
            for (row, t) in layout.unknowns(i).zip(layout.points(i)) {
                let amplitude = strip::logarithmic(a, t, &mut local[..modes.len()]);
                for (m, value) in modes.clone().zip(&local) {
                    matrix[(row, m)] += 2.0 / PI * value;
                }
                for (column, factor) in &singular {
                    matrix[(row, *column)] += 2.0 / PI * factor * amplitude;
                }
                for ([_, sin, turn], weight) in screened(a, t) {
                    // sqrt(1-t^2) U_2m = sin((2m+1) f), by the recurrence in steps of 2 f.
                    let (mut before, mut here) = (-sin, sin);
                    for column in modes.clone() {
                        matrix[(row, column)] += weight * here * sin;
                        (before, here) = (here, turn * here - before);
                    }
                    for (column, factor) in &singular {
                        matrix[(row, *column)] += weight * factor;
                    }
                }
                matrix[(row, last)] = -1.0;
                right[row] = -(a * t).powi(2);
            }
            if let Some(first) = modes.clone().next() {
                matrix[(last, first)] = self.axis.weights()[i] * a * 0.5 * PI;
            }
            for (column, factor) in &singular {
                matrix[(last, *column)] += self.axis.weights()[i] * a * PI * factor;
            }
        }
    }
}

/// Adds the sums of a tile's modes, whose `columns` have these factors, at its points, whose equations are
/// `rows`.
fn add_tile(
    matrix: &mut DMatrix<f64>,
    rows: Range<usize>,
    columns: &[Vec<(usize, f64)>],
    sums: &[Tile; TILE],
) {
    for (columns, sums) in columns.iter().zip(sums) {
        for (column, factor) in columns {
            for (row, sum) in rows.clone().zip(sums) {
                matrix[(row, *column)] += factor * sum;
            }
        }
    }
}

/// For each transform of a tile and each of its cosines the sum over wavenumbers of their products with the
/// `entries`, compiled for the processor's vector units too.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn sum_waves(entries: &[f64], transforms: &[Tile], cosines: &[Tile]) -> [Tile; TILE] {
    let times = |a: f64, b: f64, c: f64| -> f64 {
        if target_cfg_f!(target_feature = "fma") { a.mul_add(b, c) } else { a * b + c }
    };
    let mut sums = [[0.0; TILE]; TILE];
    for ((entry, transforms), cosines) in entries.iter().zip(transforms).zip(cosines) {
        let displaced = cosines.map(|c| entry * c);
        for mode in 0..TILE {
            for point in 0..TILE {
                sums[mode][point] = times(transforms[mode], displaced[point], sums[mode][point]);
            }
        }
    }
    sums
}

/// Wavenumber (1/C) below which a displacement at a depth counts as its difference to the surface's.
const LONG: f64 = 0.6;

/// Mean displacement along the line, in units of C^2 / (2 R), that the load causes at `depth`: with
/// the kernel e^(-k depth) the displacement's logarithmic growth with the extent of the bodies
/// drops out of the difference to the approach.
///
/// So does what the contact's few nodes make of displacements like 1/k and ln k: below a wavenumber
/// the sum over the same nodes is taken, less the integral of what fades on the way down.
pub fn reference(compliance: &Compliance, solution: &ContactSolution, depth: f64) -> f64 {
    let wavenumbers = compliance.wavenumbers;
    let fine = wavenumbers.fine();
    let numbers = fine.nodes();
    // Interpolated is what the plane, screened part leaves, as in the contact itself.
    let rests: Vec<DVector<f64>> = wavenumbers
        .coarse()
        .nodes()
        .iter()
        .zip(compliance.matrices)
        .map(|(&k, c)| c.row_mean_tr().add_scalar(-plane(k) / c.nrows() as f64))
        .collect();
    let mean_at = |(i, &k): (usize, &f64)| -> f64 {
        let transform = solution.transform(k);
        let (first, shares) = wavenumbers.interpolation(i);
        let rests = shares.iter().zip(&rests[first..]).map(|(w, rest)| w * rest.dot(&transform));
        plane(k) * transform.mean() + rests.sum::<f64>()
    };
    let means: Vec<f64> = numbers.iter().enumerate().map(mean_at).collect();
    let first = fine.breaks()[1];
    let top = fine.breaks().partition_point(|k| *k < LONG).min(fine.panel_count());
    let top = fine.breaks()[top];
    let below = numbers.partition_point(|k| *k < top);

    // alpha / k + beta + gamma ln k below the first panel's end, whatever the bodies' extent.
    let ends = [0, fine.order() / 2, fine.order() - 1];
    let rows = ends.map(|i| [1.0 / numbers[i], 1.0, numbers[i].ln()]);
    let system = Matrix3::from_fn(|i, j| rows[i][j]);
    let fit = system.lu().solve(&Vector3::from(ends.map(|i| means[i]))).unwrap_or_default();
    let mean = |k: f64| {
        if k < first {
            return fit[0] / k + fit[1] + fit[2] * k.ln();
        }
        // k times the mean is smooth in ln k: 2 pi / k for waves shorter than the line.
        let from = numbers.partition_point(|n| *n < k).saturating_sub(2).min(numbers.len() - 4);
        let at: [f64; 4] = std::array::from_fn(|i| numbers[from + i].ln());
        let term = |i: usize| -> f64 {
            let basis = (0..4).filter(|j| *j != i).map(|j| (k.ln() - at[j]) / (at[i] - at[j]));
            numbers[from + i] * means[from + i] * basis.product::<f64>()
        };
        (0..4).map(term).sum::<f64>() / k
    };
    // Panels that resolve e^(-k depth) and the fall of the mean.
    let smallest = (1e-3 / depth).min(first);
    let steps = ((top / smallest).ln() / 1.1f64).ceil().max(1.0) as i32;
    let graded = |i| smallest * (top / smallest).powf(f64::from(i) / f64::from(steps));
    let mut breaks: Vec<f64> = std::iter::once(0.0).chain((0..=steps).map(graded)).collect();
    breaks.push(first);
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|a, b| (*a - *b).abs() <= 1e-9 * *a);
    let own = Panels::new(breaks, 6);
    let faded: f64 = own
        .nodes()
        .iter()
        .zip(own.weights())
        .map(|(&k, w)| -(-k * depth).exp_m1() * w * mean(k))
        .sum();
    let terms = || numbers.iter().zip(fine.weights()).zip(&means);
    let long: f64 = terms().take(below).map(|((_, w), m)| w * m).sum();
    let short: f64 = terms().skip(below).map(|((k, w), m)| w * (-k * depth).exp() * m).sum();
    (long - faded + short) / (PI * PI)
}
