//! The results of one source, a model or a reference, at the standard points: pressures and
//! stresses in units of C and p0, with the scales for the conversion to SI units.

use super::quantity::Quantity;
use crate::base::{BodyKind, HertzScales, StressTensor};

/// Contact pressure on a line of points.
#[derive(Debug, Clone, PartialEq)]
pub struct PressureLine {
    /// `along-y` (x = 0) or `along-x` (y = 0, or the middle of an overlap that does not contain
    /// that).
    pub name: String,
    /// Points x, y (C).
    pub at: Vec<[f64; 2]>,
    /// Pressure (p0), as long as `at`.
    pub p: Vec<f64>,
    /// The source's own error at the points (p0), if known.
    pub own_error: Option<Vec<f64>>,
}

impl PressureLine {
    /// The two standard lines, x = 0 at the places `along` and y = `centre` at the places `across`
    /// (C), with the pressure `p` (p0) at their points x, y.
    pub fn standard(
        along: Vec<f64>,
        across: Vec<f64>,
        centre: f64,
        p: impl Fn([f64; 2]) -> f64,
    ) -> Vec<Self> {
        let line = |name: &str, at: Vec<[f64; 2]>| Self {
            name: name.to_string(),
            p: at.iter().map(|at| p(*at)).collect(),
            at,
            own_error: None,
        };
        vec![
            line("along-y", along.into_iter().map(|y| [0.0, y]).collect()),
            line("along-x", across.into_iter().map(|x| [x, centre]).collect()),
        ]
    }
}

/// Stresses along a standard curve.
#[derive(Debug, Clone, PartialEq)]
pub struct StressCurve {
    /// The body.
    pub body: BodyKind,
    /// The curve's name.
    pub name: String,
    /// Points x, y, z (C), z into the body.
    pub at: Vec<[f64; 3]>,
    /// Stresses (p0), as long as `at`.
    pub stress: Vec<StressTensor>,
    /// The source's own error at the points (p0) for each of [`Quantity::ALL`], if known.
    pub own_error: Option<Vec<[f64; 8]>>,
}

/// One source's pressures and stresses for one case.
#[derive(Debug, Clone, PartialEq)]
pub struct Curves {
    /// The scales: C, p0 and E*.
    pub hertz: HertzScales,
    /// Pressure lines.
    pub pressure: Vec<PressureLine>,
    /// Standard curves, the block's first.
    pub stress: Vec<StressCurve>,
}

impl Curves {
    /// The pressure line called `name`.
    pub fn line(&self, name: &str) -> Option<&PressureLine> {
        self.pressure.iter().find(|l| l.name == name)
    }

    /// The curve of `body` called `name`.
    pub fn curve(&self, body: BodyKind, name: &str) -> Option<&StressCurve> {
        self.stress.iter().find(|c| c.body == body && c.name == name)
    }

    /// States one error (p0) of all values at all points.
    pub fn state_error(&mut self, error: f64) {
        for line in &mut self.pressure {
            line.own_error = Some(vec![error; line.at.len()]);
        }
        for curve in &mut self.stress {
            curve.own_error = Some(vec![[error; 8]; curve.at.len()]);
        }
    }

    /// The same curves, with the differences from `other` at every point as their own error; none
    /// for curves that `other` lacks.
    pub fn with_error_from(mut self, other: &Curves) -> Self {
        for line in &mut self.pressure {
            line.own_error = other
                .line(&line.name)
                .map(|o| line.p.iter().zip(&o.p).map(|(a, b)| (a - b).abs()).collect());
        }
        for curve in &mut self.stress {
            curve.own_error = other.curve(curve.body, &curve.name).map(|o| {
                let pairs = curve.stress.iter().zip(&o.stress);
                pairs.map(|(a, b)| Quantity::ALL.map(|q| (q.of(a) - q.of(b)).abs())).collect()
            });
        }
        self
    }
}
