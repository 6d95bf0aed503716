//! Error measures of a source against a reference on the same points.
//!
//! Lengths are in units of C, stresses and pressures in units of p0. The edges of the contact are
//! the lines y = either end of the bodies' overlap, z = 0 (any x): stress and pressure are singular
//! or very steep there. Points nearer to one than a given distance are excluded. The distance is
//! measured in space; on `depth-end` it is the depth.
//!
//! With e the difference at the retained points and w trapezoid weights of the curve's arc length
//! (segments with a point left out do not count), the measures are max |e|, RMS = sqrt(sum w e^2 /
//! sum w) and L1 = sum w |e| / sum w. The weights make RMS and L1 properties of the curve, not of
//! how densely it was sampled. [`POINTS`] are on no curve: each counts alike.

use super::measure::Measure;
use super::source::Source;
use crate::base::{Error, Result};
use crate::stress::{Critical, Curves, Quantity, Variable, away_from_edges};
use serde::{Deserialize, Serialize};

/// The name that stands in place of a body for the contact pressure.
pub const CONTACT: &str = "contact";

/// The name of points that lie on no curve.
pub const POINTS: &str = "points";

/// The range over which errors are taken.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Range {
    /// Distance from an edge within which stresses are excluded (C), >= 0.
    pub stress_c: f64,
    /// The same for pressure (C): one set of rows for each distance. Summaries use the first.
    pub pressure_c: Vec<f64>,
}

impl Default for Range {
    fn default() -> Self {
        Self { stress_c: 0.1, pressure_c: vec![0.1, 0.2] }
    }
}

/// Errors of one quantity on one curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ErrorRow {
    /// The case.
    pub case: String,
    /// The source whose error this is.
    pub method: Source,
    /// `block`, `roller`, or [`CONTACT`] for the pressure.
    pub body: String,
    /// The curve or pressure line.
    pub curve: String,
    /// What is compared.
    #[serde(rename = "quantity")]
    pub variable: Variable,
    /// Excluded distance from an edge (C).
    pub excluded_c: f64,
    /// Number of points compared.
    pub points: usize,
    /// Largest difference (p0).
    pub max: f64,
    /// Where it is (C).
    pub max_at: [f64; 3],
    /// Root mean square (p0).
    pub rms: f64,
    /// Mean of the absolute difference (p0).
    pub l1: f64,
    /// The source's value of largest magnitude, with its sign (p0).
    pub peak: f64,
    /// Where it is (C).
    pub peak_at: [f64; 3],
    /// The reference's value of largest magnitude, with its sign (p0).
    pub peak_ref: f64,
    /// Where it is (C).
    pub peak_ref_at: [f64; 3],
    /// Largest own error of the reference over the same points (p0), where it states one.
    pub ref_error_max: Option<f64>,
    /// RMS of the reference's own error over the same points (p0), where it states one.
    pub ref_error_rms: Option<f64>,
}

impl ErrorRow {
    /// The error in a measure (p0).
    pub fn measured(&self, measure: Measure) -> f64 {
        match measure {
            Measure::Max => self.max,
            Measure::Rms => self.rms,
            Measure::L1 => self.l1,
        }
    }
}

/// Measures of a difference over a range.
struct Measures {
    points: usize,
    max: f64,
    max_index: usize,
    rms: f64,
    l1: f64,
}

/// Trapezoid weights of the arc length between kept points (C); a segment counts when both its
/// ends are kept.
fn weights(at: &[[f64; 3]], kept: &[bool]) -> Vec<f64> {
    let mut w = vec![0.0; at.len()];
    for i in 1..at.len() {
        if kept[i - 1] && kept[i] {
            let length = (0..3).map(|k| (at[i][k] - at[i - 1][k]).powi(2)).sum::<f64>().sqrt();
            w[i - 1] += 0.5 * length;
            w[i] += 0.5 * length;
        }
    }
    w
}

/// Measures of `difference` with weights `w`; `None` when these are zero: no segment of the curve
/// is kept.
fn measure(w: &[f64], difference: &[f64], kept: &[bool]) -> Option<Measures> {
    let total: f64 = w.iter().sum();
    if total <= 0.0 {
        return None;
    }
    let (mut max, mut max_index, mut square, mut absolute) = (-1.0, 0, 0.0, 0.0);
    for i in (0..w.len()).filter(|&i| kept[i]) {
        let e = difference[i].abs();
        // A NaN must show as one, not lose every comparison.
        if e > max || e.is_nan() {
            (max, max_index) = (e, i);
        }
        square += w[i] * e * e;
        absolute += w[i] * e;
    }
    Some(Measures {
        points: kept.iter().filter(|&&k| k).count(),
        max,
        max_index,
        rms: (square / total).sqrt(),
        l1: absolute / total,
    })
}

/// Index of the kept value of largest magnitude.
fn peak(values: &[f64], kept: &[bool]) -> usize {
    (0..values.len())
        .filter(|&i| kept[i])
        .max_by(|&a, &b| values[a].abs().total_cmp(&values[b].abs()))
        .unwrap_or(0)
}

/// For each point of the reference the index of the same point in `at`.
///
/// # Errors
/// [`Error::Value`] naming the point when `at` does not hold it.
fn matching(reference: &[[f64; 3]], at: &[[f64; 3]], what: &str) -> Result<Vec<usize>> {
    let near = |a: &[f64; 3], b: &[f64; 3]| {
        (0..3).all(|k| (a[k] - b[k]).abs() <= 1e-6 * a[k].abs().max(1.0))
    };
    reference
        .iter()
        .enumerate()
        .map(|(i, point)| {
            // Both sides usually hold the same list, so the same index is tried first.
            if at.get(i).is_some_and(|p| near(point, p)) {
                return Ok(i);
            }
            at.iter().position(|p| near(point, p)).ok_or_else(|| Error::Value {
                key: what.to_string(),
                value: format!("point {i} at ({}, {}, {}) C", point[0], point[1], point[2]),
                reason: "the reference holds this point and the solution does not".to_string(),
                remedy: "record the reference again for this version's standard curves".to_string(),
            })
        })
        .collect()
}

/// One comparison: its names, and the values of both sides at the reference's points.
struct Pair<'a> {
    body: &'a str,
    curve: &'a str,
    variable: Variable,
    excluded_c: f64,
    at: &'a [[f64; 3]],
    value: &'a [f64],
    reference: &'a [f64],
    own_error: Option<Vec<f64>>,
}

impl Pair<'_> {
    fn row(&self, case: &str, method: &Source, ends: [f64; 2]) -> Option<ErrorRow> {
        let away = |at: &[f64; 3]| away_from_edges(*at, ends, self.excluded_c);
        let kept: Vec<bool> = self.at.iter().map(away).collect();
        let w = match self.curve {
            POINTS => kept.iter().map(|&k| f64::from(u8::from(k))).collect(),
            _ => weights(self.at, &kept),
        };
        let difference: Vec<f64> =
            self.value.iter().zip(self.reference).map(|(a, b)| a - b).collect();
        let m = measure(&w, &difference, &kept)?;
        let own = self.own_error.as_ref().and_then(|e| measure(&w, e, &kept));
        let (peak_here, peak_there) = (peak(self.value, &kept), peak(self.reference, &kept));
        Some(ErrorRow {
            case: case.to_string(),
            method: method.clone(),
            body: self.body.to_string(),
            curve: self.curve.to_string(),
            variable: self.variable,
            excluded_c: self.excluded_c,
            points: m.points,
            max: m.max,
            max_at: self.at[m.max_index],
            rms: m.rms,
            l1: m.l1,
            peak: self.value[peak_here],
            peak_at: self.at[peak_here],
            peak_ref: self.reference[peak_there],
            peak_ref_at: self.at[peak_there],
            ref_error_max: own.as_ref().map(|o| o.max),
            ref_error_rms: own.as_ref().map(|o| o.rms),
        })
    }
}

/// Errors of `candidate`, the curves of `source`, against `reference`: one row for each quantity of
/// each curve of the reference, and one for each pressure line and range.
///
/// `ends` are those of the bodies' overlap (C). Curves of the reference that the candidate does not
/// have are left out, and so is a quantity that the reference does not state (NaN at all points); a
/// curve on other points is an error.
///
/// # Errors
/// [`Error::Value`] when a point of the reference is missing from the candidate's curve.
pub fn compare(
    case: &str,
    ends: [f64; 2],
    reference: &Curves,
    (source, candidate): (&Source, &Curves),
    range: &Range,
) -> Result<Vec<ErrorRow>> {
    let mut rows = Vec::new();
    for line in &reference.pressure {
        let Some(other) = candidate.line(&line.name) else { continue };
        let lift = |at: &[[f64; 2]]| at.iter().map(|a| [a[0], a[1], 0.0]).collect::<Vec<_>>();
        let (at, theirs) = (lift(&line.at), lift(&other.at));
        let index = matching(&at, &theirs, &format!("{case}: pressure {}", line.name))?;
        let value: Vec<f64> = index.iter().map(|&i| other.p[i]).collect();
        for &excluded_c in &range.pressure_c {
            let pair = Pair {
                body: CONTACT,
                curve: &line.name,
                variable: Variable::Pressure,
                excluded_c,
                at: &at,
                value: &value,
                reference: &line.p,
                own_error: line.own_error.clone(),
            };
            rows.extend(pair.row(case, source, ends));
        }
    }
    for curve in &reference.stress {
        let Some(other) = candidate.curve(curve.body, &curve.name) else { continue };
        let what = format!("{case}: {} of the {}", curve.name, curve.body.name());
        let index = matching(&curve.at, &other.at, &what)?;
        for (k, quantity) in Quantity::ALL.into_iter().enumerate() {
            let value: Vec<f64> = index.iter().map(|&i| quantity.of(&other.stress[i])).collect();
            let truth: Vec<f64> = curve.stress.iter().map(|s| quantity.of(s)).collect();
            if truth.iter().all(|v| v.is_nan()) {
                continue;
            }
            let pair = Pair {
                body: curve.body.name(),
                curve: &curve.name,
                variable: Variable::Stress(quantity),
                excluded_c: range.stress_c,
                at: &curve.at,
                value: &value,
                reference: &truth,
                own_error: curve.own_error.as_ref().map(|e| e.iter().map(|v| v[k]).collect()),
            };
            rows.extend(pair.row(case, source, ends));
        }
    }
    Ok(rows)
}

/// The largest von Mises stress of all curves. On a depth curve the parabola through the largest
/// point and its neighbours gives value and depth, so that the place does not depend on the
/// sampling. `None` when no point is left.
pub fn critical_point(curves: &Curves, ends: [f64; 2], excluded_c: f64) -> Option<Critical> {
    let mut best: Option<Critical> = None;
    for curve in &curves.stress {
        let v: Vec<f64> = curve.stress.iter().map(|s| s.von_mises()).collect();
        let kept = |i: usize| away_from_edges(curve.at[i], ends, excluded_c);
        for i in (0..v.len()).filter(|&i| kept(i)) {
            if best.is_some_and(|b| v[i] <= b.value) {
                continue;
            }
            let mut point = Critical { body: curve.body, value: v[i], at: curve.at[i] };
            let inside = i > 0 && i + 1 < v.len() && kept(i - 1) && kept(i + 1);
            if curve.name.starts_with("depth") && inside && v[i] >= v[i - 1] && v[i] >= v[i + 1] {
                let z = [curve.at[i - 1][2], curve.at[i][2], curve.at[i + 1][2]];
                if let Some((at, value)) = parabola_peak(z, [v[i - 1], v[i], v[i + 1]]) {
                    (point.at[2], point.value) = (at, value);
                }
            }
            best = Some(point);
        }
    }
    best
}

/// Vertex (place, value) of the parabola through three points whose middle one is the highest.
fn parabola_peak(x: [f64; 3], y: [f64; 3]) -> Option<(f64, f64)> {
    let left = (y[1] - y[0]) / (x[1] - x[0]);
    let right = (y[2] - y[1]) / (x[2] - x[1]);
    let bend = (right - left) / (x[2] - x[0]);
    if bend >= 0.0 || !bend.is_finite() {
        return None;
    }
    // Newton's form y0 + left (x - x0) + bend (x - x0)(x - x1), derivative zero.
    let at = 0.5 * (x[0] + x[1]) - 0.5 * left / bend;
    Some((at, y[0] + left * (at - x[0]) + bend * (at - x[0]) * (at - x[1])))
}

/// Errors of one source in one case, over all curves of both bodies: the columns of `study.csv`.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorSummary {
    /// Largest and RMS error of the pressure over both lines, for each range of
    /// [`Range::pressure_c`] (p0).
    pub pressure: Vec<[f64; 2]>,
    /// Largest and RMS error of each of [`Quantity::ALL`] (p0).
    pub quantities: Vec<[f64; 2]>,
    /// Largest and RMS error of the six stress components together (p0).
    pub stress: [f64; 2],
    /// The largest own error that the reference states for a pressure (p0).
    pub ref_error_pressure: Option<f64>,
    /// The largest own error that the reference states for a stress component (p0).
    pub ref_error_stress: Option<f64>,
}

/// Summarises the rows of one source in one case. The RMS over several curves is the root of the
/// mean of their squares, with equal weights for all curves. `None` without rows.
pub fn summarise(rows: &[ErrorRow], range: &Range) -> Option<ErrorSummary> {
    let both = |select: &dyn Fn(&ErrorRow) -> bool| -> Option<[f64; 2]> {
        let chosen: Vec<&ErrorRow> = rows.iter().filter(|r| select(r)).collect();
        if chosen.is_empty() {
            return None;
        }
        let max = chosen
            .iter()
            .map(|r| r.max)
            .fold(0.0, |a: f64, b| if b > a || b.is_nan() { b } else { a });
        let mean = chosen.iter().map(|r| r.rms * r.rms).sum::<f64>() / chosen.len() as f64;
        Some([max, mean.sqrt()])
    };
    let is_component = |r: &ErrorRow| r.variable.is_component();
    let is_pressure = |r: &ErrorRow| r.variable == Variable::Pressure;
    let own = |select: &dyn Fn(&ErrorRow) -> bool| {
        rows.iter().filter(|r| select(r)).filter_map(|r| r.ref_error_max).reduce(f64::max)
    };
    Some(ErrorSummary {
        pressure: range
            .pressure_c
            .iter()
            .map(|&c| both(&|r| is_pressure(r) && r.excluded_c == c))
            .collect::<Option<_>>()?,
        quantities: Quantity::ALL
            .iter()
            .map(|q| both(&|r| r.variable == Variable::Stress(*q)))
            .collect::<Option<_>>()?,
        stress: both(&is_component)?,
        ref_error_pressure: own(&is_pressure),
        ref_error_stress: own(&is_component),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::HertzScales;
    use crate::base::StressTensor;
    use crate::body::EdgeModel;
    use crate::stress::{BodyKind, PressureLine, StressCurve};
    use approx::assert_relative_eq;

    const ENDS: [f64; 2] = [-5.0, 5.0];

    /// A depth curve under the overlap's end with sigma_xx = f(z) and a pressure line p = g(y).
    fn sampled(f: impl Fn(f64) -> f64, g: impl Fn(f64) -> f64) -> Curves {
        let z = [0.0, 0.05, 0.1, 0.3, 0.7, 1.5];
        let y = [0.0, 3.0, 4.5, 4.8, 4.9, 4.95, 5.0];
        Curves {
            hertz: HertzScales { e_star_pa: 1.0, c_m: 1.0, p0_pa: 1.0 },
            pressure: vec![PressureLine {
                name: "along-y".to_string(),
                at: y.iter().map(|&y| [0.0, y]).collect(),
                p: y.iter().map(|&y| g(y)).collect(),
                own_error: Some(vec![0.003; y.len()]),
            }],
            stress: vec![StressCurve {
                body: BodyKind::Block,
                name: "depth-end".to_string(),
                at: z.iter().map(|&z| [0.0, 5.0, z]).collect(),
                stress: z
                    .iter()
                    .map(|&z| StressTensor { xx: f(z), ..Default::default() })
                    .collect(),
                own_error: None,
            }],
        }
    }

    fn mirror() -> Source {
        EdgeModel::Mirror.into()
    }

    #[test]
    fn measures_of_known_differences() {
        let reference = sampled(|_| 0.0, |_| 1.0);
        // The differences at the end itself are huge and must not count.
        let other = sampled(
            |z| if z < 0.09 { 99.0 } else { z },
            |y| if y > 4.91 { 50.0 } else { 1.0 - 0.01 * y },
        );
        let rows = compare("c", ENDS, &reference, (&mirror(), &other), &Range::default()).unwrap();
        let xx = rows.iter().find(|r| r.variable == Variable::Stress(Quantity::Stress(0))).unwrap();
        assert_eq!((xx.points, xx.excluded_c), (4, 0.1));
        assert_eq!((xx.max, xx.max_at), (1.5, [0.0, 5.0, 1.5]));
        // Trapezoid of z and z^2 over 0.1, 0.3, 0.7, 1.5.
        assert_relative_eq!(xx.l1, (1.5f64.powi(2) - 0.01) / 2.0 / 1.4, epsilon = 1e-14);
        let square = 0.2 * 0.05 + 0.4 * 0.29 + 0.8 * 1.37;
        assert_relative_eq!(xx.rms, (square / 1.4f64).sqrt(), epsilon = 1e-14);
        assert_eq!(xx.ref_error_max, None);
        let p: Vec<_> = rows.iter().filter(|r| r.variable == Variable::Pressure).collect();
        assert_eq!((p.len(), p[0].points, p[1].points), (2, 5, 4));
        assert_relative_eq!(p[0].max, 0.049, epsilon = 1e-14);
        assert_eq!(p[1].max_at, [0.0, 4.8, 0.0]);
        assert_eq!((p[0].peak, p[0].peak_at), (1.0, [0.0; 3]));
        assert_relative_eq!(p[0].ref_error_rms.unwrap(), 0.003, epsilon = 1e-15);
    }

    #[test]
    fn a_gap_in_the_range_is_not_bridged() {
        let at: Vec<[f64; 3]> = [0.0, 1.0, 1.5, 2.0, 4.0].map(|y| [0.0, y, 0.0]).to_vec();
        let w = weights(&at, &[true, true, false, true, true]);
        assert_eq!(w, [0.5, 0.5, 0.0, 1.0, 1.0]);
    }

    #[test]
    fn other_points_are_refused_and_nan_is_not_swallowed() {
        let reference = sampled(|_| 0.0, |_| 1.0);
        let mut moved = reference.clone();
        moved.stress[0].at[3][2] = 0.31;
        let message =
            compare("c", ENDS, &reference, (&mirror(), &moved), &Range::default()).unwrap_err();
        assert!(message.to_string().contains("depth-end of the block"), "{message}");
        let broken = sampled(|z| if z == 0.3 { f64::NAN } else { 0.0 }, |_| 1.0);
        let rows = compare("c", ENDS, &reference, (&mirror(), &broken), &Range::default()).unwrap();
        let summary = summarise(&rows, &Range::default()).unwrap();
        assert!(summary.stress[0].is_nan() && summary.stress[1].is_nan());
    }

    #[test]
    fn critical_depth_lies_between_samples() {
        // sigma_xx alone is its own von Mises stress: a parabola that peaks at 0.6.
        let s = sampled(|z| 1.0 - (z - 0.6) * (z - 0.6), |_| 1.0);
        let critical = critical_point(&s, ENDS, 0.1).unwrap();
        assert_relative_eq!(critical.at[2], 0.6, epsilon = 1e-12);
        assert_relative_eq!(critical.value, 1.0, epsilon = 1e-12);
    }
}
