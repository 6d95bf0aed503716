use crate::base::{Error, Panels, Result};
use crate::kernels::strip;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// The compliance of both bodies together, one matrix per wavenumber.
#[derive(Debug, Clone)]
pub struct Compliance<'a> {
    /// Wavenumbers > 0, ascending, and the weights of their quadrature over (0, infinity).
    pub wavenumbers: &'a Panels,
    /// C(k): displacement at the axis's nodes per pressure at the nodes; it tends to 2 pi / k
    /// times the identity for large k.
    pub matrices: &'a [DMatrix<f64>],
}

/// Settings of the contact solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSettings {
    /// Modes of the pressure across the contact.
    pub modes: usize,
    /// Distance from the line's end within which the half-width is not an unknown of its own.
    pub end_zone: f64,
    /// Largest amplitude of the pressure's edge singularity that counts as none (p0).
    pub tolerance: f64,
    /// Iterations after which it gives up.
    pub max_iterations: usize,
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
    /// Distance from the line's end within which the half-width was not an unknown of its own.
    pub end_zone: f64,
    /// Amplitude of the edge singularity that was left (p0).
    pub residual: f64,
    /// |load - prescribed| / prescribed.
    pub load_error: f64,
}

/// Distance at which the closed logarithmic kernel of the local, plane part is screened, so that
/// what is left for the quadrature over wavenumbers is finite at k = 0 and fades quickly.
const SCREEN: f64 = 2.0;

/// Entries of the collocation matrix per wavenumber that are as good as none.
const NEGLIGIBLE: f64 = 1e-9;

/// Points of the Gauss-Chebyshev rule for the screened part, smooth over the contact.
const SCREEN_POINTS: usize = 12;

/// Solves for the pressure whose mean over the axis is the Hertz line load pi/2.
///
/// For half-widths that are held the problem is linear: at every node the modes and the amplitude
/// b of the singular mode 1/sqrt(1 - t^2) are found by collocation at M + 1 points, with the
/// approach from the load. A boundary that lies right leaves b = 0. To first order
/// b / sqrt(1 - t^2) is what moving the boundary of S sqrt(1 - t^2) to a sqrt(1 + 2 b / S) does, so
/// the update is Newton's and converges quadratically.
///
/// # Errors
/// [`Error::NotConverged`] when the boundary does not settle.
pub fn solve(
    compliance: &Compliance,
    axis: &Panels,
    settings: &ContactSettings,
) -> Result<ContactSolution> {
    // A pressure that is singular at the end (a half-space's) may want a longer end zone.
    let mut settings = *settings;
    let mut answer = solve_once(compliance, axis, &settings);
    for _ in 0..3 {
        if answer.is_ok() {
            break;
        }
        settings.end_zone *= 2.0;
        answer = solve_once(compliance, axis, &settings);
    }
    answer
}

/// [`solve`] with the end zone as it is given.
fn solve_once(
    compliance: &Compliance,
    axis: &Panels,
    settings: &ContactSettings,
) -> Result<ContactSolution> {
    let n = axis.len();
    let length: f64 = axis.weights().iter().sum();
    let load = 0.5 * PI * length;
    let mut layout = Layout::new(axis, settings);
    let remainders = remainders(compliance, n);
    let mut half_widths = vec![1.0; n];
    // Edge slopes S of the end zone relative to the outermost free node's.
    let mut zone = vec![1.0; n - layout.free];
    let mut last = f64::INFINITY;
    for iteration in 1..=settings.max_iterations {
        let unknowns =
            linear_solve(compliance, &remainders, axis, &layout, &half_widths, &zone, load)?;
        let mut worst: f64 = 0.0;
        let mut next = half_widths.clone();
        let slopes: Vec<f64> = (0..n)
            .map(|j| {
                let own = &unknowns.as_slice()[layout.unknowns(j)][..layout.modes[j]];
                own.iter().enumerate().map(|(m, c)| (2 * m + 1) as f64 * c).sum()
            })
            .collect();
        for j in 0..layout.free {
            let singular = unknowns[layout.unknowns(j).end - 1];
            let slope = slopes[j];
            worst = worst.max(singular.abs());
            // A step beyond a factor of two would leave the region where the linearisation holds.
            let grow = if slope > 0.0 { 1.0 + 2.0 * singular / slope } else { 0.25 };
            next[j] *= grow.clamp(0.25, 4.0).sqrt();
        }
        let outermost = next[layout.free - 1];
        next[layout.free..].fill(outermost);
        for (ratio, slope) in zone.iter_mut().zip(&slopes[layout.free..]) {
            *ratio = (slope / slopes[layout.free - 1]).clamp(0.0, 10.0);
        }
        last = worst;
        if worst <= settings.tolerance && !layout.release(&unknowns) {
            let mut coefficients: Vec<Vec<f64>> = (0..n)
                .map(|j| {
                    let mut own = unknowns.as_slice()[layout.unknowns(j)].to_vec();
                    own.truncate(layout.modes[j]);
                    own
                })
                .collect();
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
                end_zone: settings.end_zone,
                residual: worst,
                load_error,
            });
        }
        half_widths = next;
    }
    Err(Error::NotConverged {
        iterations: settings.max_iterations,
        residual: last,
        remedy: "ask for a coarser [accuracy] tolerance, or check the case's lengths".into(),
    })
}

/// Which unknowns each node has: the free nodes, which come first, have all modes and the singular
/// one; the nodes of the end zone have the half-width of the outermost free node and up to two
/// modes. There wavenumbers beyond the largest one decide the shape, and a half-width of their own
/// would be noise. A node of the end zone whose pressure would pull loses a mode, its second one
/// first; with none left it carries no pressure.
#[derive(Debug, Clone)]
struct Layout {
    free: usize,
    all_modes: usize,
    modes: Vec<usize>,
    starts: Vec<usize>,
}

impl Layout {
    fn new(axis: &Panels, settings: &ContactSettings) -> Self {
        let end = axis.breaks()[axis.panel_count()] - settings.end_zone;
        let free = axis.nodes().iter().filter(|&&y| y <= end).count().max(1);
        let end_modes = settings.modes.min(2);
        let modes =
            (0..axis.len()).map(|j| if j < free { settings.modes } else { end_modes }).collect();
        let mut layout = Self { free, all_modes: settings.modes, modes, starts: Vec::new() };
        layout.number();
        layout
    }

    /// Numbers the unknowns.
    fn number(&mut self) {
        let mut next = 0;
        self.starts.clear();
        for (j, modes) in self.modes.iter().enumerate() {
            self.starts.push(next);
            next += modes + usize::from(j < self.free);
        }
        self.starts.push(next);
    }

    /// Unknowns and collocation equations of node `j`: its modes, then the singular one.
    fn unknowns(&self, j: usize) -> std::ops::Range<usize> {
        self.starts[j]..self.starts[j + 1]
    }

    /// Unknowns in all, the approach included.
    fn size(&self) -> usize {
        self.starts[self.modes.len()] + 1
    }

    /// Collocation points of node `j`, as t in (0, 1): zeros of T_2n with the singular mode, else
    /// those of U_2n, the points of Gauss's rule for the weight sqrt(1 - t^2).
    fn points(&self, j: usize) -> impl Iterator<Item = f64> {
        let count = self.unknowns(j).len();
        let free = j < self.free;
        (0..count).map(move |l| {
            let angle = if free {
                PI * (2 * l + 1) as f64 / (4 * count) as f64
            } else {
                PI * (l + 1) as f64 / (2 * count + 1) as f64
            };
            angle.cos()
        })
    }

    /// Takes modes from the nodes of the end zone whose pressure is negative somewhere across the
    /// contact: the second one where the shape is to blame, all where the mean is; whether there
    /// was one.
    fn release(&mut self, unknowns: &DVector<f64>) -> bool {
        let mut released = false;
        for j in self.free..self.modes.len() {
            let c = &unknowns.as_slice()[self.unknowns(j)];
            // c_0 + c_1 (4 t^2 - 1) is monotonic in t^2: its ends decide.
            let left = match c {
                [c0, ..] if *c0 < 0.0 => 0,
                [c0, c1] if c0 - c1 < 0.0 || c0 + 3.0 * c1 < 0.0 => 1,
                _ => continue,
            };
            self.modes[j] = left;
            released = true;
        }
        self.number();
        released
    }
}

/// C(k) less its plane, screened part (2 pi / k)(1 - e^(-k SCREEN)) on the diagonal.
fn remainders(compliance: &Compliance, n: usize) -> Vec<DMatrix<f64>> {
    let ks = compliance.wavenumbers.nodes();
    ks.iter()
        .zip(compliance.matrices)
        .map(|(&k, c)| c - DMatrix::identity(n, n) * (-2.0 * PI / k * (-k * SCREEN).exp_m1()))
        .collect()
}

/// The linear problem for held half-widths: the unknowns of each node, then the approach.
fn linear_solve(
    compliance: &Compliance,
    remainders: &[DMatrix<f64>],
    axis: &Panels,
    layout: &Layout,
    half_widths: &[f64],
    zone: &[f64],
    load: f64,
) -> Result<DVector<f64>> {
    let n = axis.len();
    // The end zone moves with the outermost free node: so does its singular mode.
    let shared = layout.unknowns(layout.free - 1).end - 1;
    let singular_column = |j: usize, own: &std::ops::Range<usize>| {
        if j < layout.free { own.end - 1 } else { shared }
    };
    let size = layout.size();
    let mut matrix = DMatrix::zeros(size, size);
    let mut right = DVector::zeros(size);
    let mut transform = vec![0.0; size - 1];
    let mut singular_transform = vec![0.0; n];
    let mut cosine = vec![0.0; size - 1];
    let wavenumbers = compliance.wavenumbers;
    for ((&k, w), remainder) in
        wavenumbers.nodes().iter().zip(wavenumbers.weights()).zip(remainders)
    {
        for (j, &a) in half_widths.iter().enumerate() {
            let modes = layout.modes[j];
            let own = &mut transform[layout.unknowns(j)];
            singular_transform[j] = strip::transforms(a, k, &mut own[..modes]);
            for (c, t) in cosine[layout.unknowns(j)].iter_mut().zip(layout.points(j)) {
                *c = (k * a * t).cos();
            }
        }
        for j in 0..n {
            let own = layout.unknowns(j);
            let modes = own.start..own.start + layout.modes[j];
            let ratio = if j < layout.free { 1.0 } else { zone[j - layout.free] };
            let singular = (singular_column(j, &own), ratio * singular_transform[j]);
            for (m, transform) in modes.map(|m| (m, transform[m])).chain([singular]) {
                let factor = w / (PI * PI) * transform;
                let column = &mut matrix.column_mut(m);
                let column = column.as_mut_slice();
                for (i, r) in remainder.column(j).iter().enumerate() {
                    let r = factor * r;
                    if r.abs() < NEGLIGIBLE {
                        continue;
                    }
                    let rows = layout.unknowns(i);
                    for (entry, c) in column[rows.clone()].iter_mut().zip(&cosine[rows]) {
                        *entry += r * c;
                    }
                }
            }
        }
    }
    let mut local = vec![0.0; layout.all_modes];
    for (i, &a) in half_widths.iter().enumerate() {
        let modes = layout.modes[i];
        let own = layout.unknowns(i);
        let ratio = if i < layout.free { 1.0 } else { zone[i - layout.free] };
        let singular_column = singular_column(i, &own);
        for (row, t) in own.clone().zip(layout.points(i)) {
            let singular = strip::logarithmic(a, t, &mut local[..modes]);
            for (m, value) in local[..modes].iter().enumerate() {
                matrix[(row, own.start + m)] += 2.0 / PI * value;
            }
            matrix[(row, singular_column)] += 2.0 / PI * ratio * singular;
            // (1/2) int ln((x - x')^2 + d^2) p(x') dx' by Gauss-Chebyshev of the first kind, with
            // sqrt(1-t^2) U_2m = sin((2m+1) f).
            for q in 0..SCREEN_POINTS {
                let angle = PI * (2 * q + 1) as f64 / (2 * SCREEN_POINTS) as f64;
                let offset = a * (t - angle.cos());
                let kernel = 0.5 * (offset * offset + SCREEN * SCREEN).ln();
                let weight = 2.0 / PI * kernel * a * PI / SCREEN_POINTS as f64;
                for m in 0..modes {
                    let mode = ((2 * m + 1) as f64 * angle).sin() * angle.sin();
                    matrix[(row, own.start + m)] += weight * mode;
                }
                matrix[(row, singular_column)] += weight * ratio;
            }
            matrix[(row, size - 1)] = -1.0;
            right[row] = -(a * t).powi(2);
        }
        if modes > 0 {
            matrix[(size - 1, own.start)] = axis.weights()[i] * a * 0.5 * PI;
        }
        matrix[(size - 1, singular_column)] += axis.weights()[i] * a * PI * ratio;
    }
    right[size - 1] = load;
    matrix.lu().solve(&right).ok_or_else(|| Error::NotConverged {
        iterations: 0,
        residual: f64::INFINITY,
        remedy: "the collocation matrix is singular: check the case's lengths".into(),
    })
}

/// Mean displacement along the line, in units of C^2 / (2 R), that the load causes at `depth`: with
/// the kernel e^(-k depth) the displacement's logarithmic growth with the extent of the bodies
/// drops out of the difference.
pub fn reference(compliance: &Compliance, solution: &ContactSolution, depth: f64) -> f64 {
    let mut modes = Vec::new();
    let mut sum = 0.0;
    let wavenumbers = compliance.wavenumbers;
    for ((&k, w), c) in
        wavenumbers.nodes().iter().zip(wavenumbers.weights()).zip(compliance.matrices)
    {
        let fade = (-k * depth).exp();
        if fade < 1e-12 {
            break;
        }
        let p = DVector::from_fn(solution.half_widths.len(), |j, _| {
            let coefficients = &solution.coefficients[j];
            modes.resize(coefficients.len(), 0.0);
            strip::transforms(solution.half_widths[j], k, &mut modes);
            modes.iter().zip(coefficients).map(|(t, c)| t * c).sum()
        });
        sum += w / (PI * PI) * fade * (c * p).mean();
    }
    sum
}
