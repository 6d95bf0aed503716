//! What one source (an edge model or FEM) says at the standard points of one case.

use crate::base::StressTensor;
use crate::solve::Solution;
use crate::stress::BodyKind;

/// A scalar that is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quantity {
    /// A component of the stress tensor, by its index in [`StressTensor::components`].
    Stress(u8),
    /// Von Mises equivalent stress.
    VonMises,
    /// Largest shear stress.
    TauMax,
}

impl Quantity {
    /// All quantities that a stress has, in the order of the files' columns.
    pub const ALL: [Quantity; 8] = [
        Quantity::Stress(0),
        Quantity::Stress(1),
        Quantity::Stress(2),
        Quantity::Stress(3),
        Quantity::Stress(4),
        Quantity::Stress(5),
        Quantity::VonMises,
        Quantity::TauMax,
    ];

    /// The name used in files, e.g. `sigma_yy`.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Stress(i) => StressTensor::NAMES[usize::from(i)],
            Quantity::VonMises => "von_mises",
            Quantity::TauMax => "tau_max",
        }
    }

    /// The quantity with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|q| q.name() == name)
    }

    /// Its value, in the tensor's unit.
    pub fn of(self, stress: &StressTensor) -> f64 {
        match self {
            Quantity::Stress(i) => stress.components()[usize::from(i)],
            Quantity::VonMises => stress.von_mises(),
            Quantity::TauMax => stress.tau_max(),
        }
    }
}

/// Contact pressure on a line of points, in units of C and p0.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledLine {
    /// `along-y` or `along-x`.
    pub name: String,
    /// Points x, y (C).
    pub at: Vec<[f64; 2]>,
    /// Pressure (p0), as long as `at`.
    pub p: Vec<f64>,
    /// The source's own error at the points (p0), where it is known.
    pub own_error: Option<Vec<f64>>,
}

/// Stresses along a standard curve, in units of C and p0.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledCurve {
    /// The body.
    pub body: BodyKind,
    /// The curve's name.
    pub name: String,
    /// Points x, y, z (C), z into the body.
    pub at: Vec<[f64; 3]>,
    /// Stresses (p0), as long as `at`.
    pub stress: Vec<StressTensor>,
    /// The source's own error at the points (p0) for each of [`Quantity::ALL`], where it is known.
    pub own_error: Option<Vec<[f64; 8]>>,
}

/// One source's answer for one case, in units of C and p0.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    /// The source: a method's name, or `fem`.
    pub source: String,
    /// Pressure lines.
    pub lines: Vec<SampledLine>,
    /// Standard curves.
    pub curves: Vec<SampledCurve>,
}

impl Sampled {
    /// The semi-analytical answer.
    pub fn from_solution(solution: &Solution) -> Self {
        let (c, p0) = (solution.hertz.c_m, solution.hertz.p0_pa);
        let lines = solution
            .lines
            .iter()
            .map(|line| SampledLine {
                name: line.name.to_string(),
                at: line.at_m.iter().map(|at| at.map(|v| v / c)).collect(),
                p: line.p_pa.iter().map(|p| p / p0).collect(),
                own_error: None,
            })
            .collect();
        let curves = solution
            .curves
            .iter()
            .map(|curve| SampledCurve {
                body: curve.body,
                name: curve.name.to_string(),
                at: curve.at_m.iter().map(|at| at.map(|v| v / c)).collect(),
                stress: curve.stress_pa.iter().map(|&s| s * (1.0 / p0)).collect(),
                own_error: None,
            })
            .collect();
        Self { source: solution.method.name().to_string(), lines, curves }
    }

    /// The curve of `body` called `name`.
    pub fn curve(&self, body: BodyKind, name: &str) -> Option<&SampledCurve> {
        self.curves.iter().find(|c| c.body == body && c.name == name)
    }

    /// The pressure line called `name`.
    pub fn line(&self, name: &str) -> Option<&SampledLine> {
        self.lines.iter().find(|l| l.name == name)
    }
}
