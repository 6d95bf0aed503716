//! Recorded FEM between the points of its record.
//!
//! On the lines of the record the difference of FEM and a model is interpolated linearly and the
//! model put back: the difference is small and smooth, the curves themselves are not (at the
//! contact's edge the pressure falls like a square root). At the record's own points that is FEM
//! exactly.

use crate::base::StressTensor;
use crate::stress::{Curves, PressureLine, StressCurve};

/// Points this near to a line of the record (C) are on it.
const ON_THE_LINE: f64 = 1e-4;

/// Recorded FEM, and a model's solution on the same points.
pub(super) struct Between<'a> {
    pub fem: &'a Curves,
    pub model: &'a Curves,
    /// Whether x = 0 and y = 0 are planes of symmetry, so that the record has one half alone.
    pub symmetric: [bool; 2],
}

/// Where a point lies on a line: the number of the segment, and the part of it.
type Place = (usize, f64);

/// Where `point` lies on the line through `at`, and how far from one of its points (C).
fn place_on(at: &[[f64; 3]], point: [f64; 3]) -> Option<(Place, f64)> {
    (0..at.len().saturating_sub(1)).find_map(|i| {
        let along: [f64; 3] = std::array::from_fn(|k| at[i + 1][k] - at[i][k]);
        let from: [f64; 3] = std::array::from_fn(|k| point[k] - at[i][k]);
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
        let length = dot(along, along);
        let t = if length > 0.0 { (dot(from, along) / length).clamp(0.0, 1.0) } else { 0.0 };
        let off: [f64; 3] = std::array::from_fn(|k| from[k] - t * along[k]);
        let near = dot(off, off).sqrt() <= ON_THE_LINE;
        near.then(|| ((i, t), t.min(1.0 - t) * length.sqrt()))
    })
}

impl Between<'_> {
    /// The signs of x and y that bring a point to where the record is.
    fn fold(&self, [x, y, z]: [f64; 3]) -> ([f64; 3], [bool; 2]) {
        let flips = [self.symmetric[0] && x < 0.0, self.symmetric[1] && y < 0.0];
        let turned = |v: f64, flip| if flip { -v } else { v };
        ([turned(x, flips[0]), turned(y, flips[1]), z], flips)
    }

    /// FEM's stress less the model's at `point` of the body of `curve`; `None` off the record's
    /// lines.
    fn stress_difference(&self, curve: &StressCurve, point: [f64; 3]) -> Option<StressTensor> {
        let (folded, flips) = self.fold(point);
        // Of lines that cross there, the one with the nearest point.
        let lines = self.fem.stress.iter().filter(|line| line.body == curve.body);
        let places = lines.filter_map(|line| Some((line, place_on(&line.at, folded)?)));
        let nearest = places.min_by(|(_, (_, a)), (_, (_, b))| a.total_cmp(b));
        nearest.and_then(|(line, ((i, t), _))| {
            let own = self.model.curve(line.body, &line.name)?;
            let at = |i: usize| line.stress[i] + own.stress[i] * -1.0;
            let mut found = at(i) * (1.0 - t) + at(i + 1) * t;
            for (flip, odd) in flips.iter().zip([StressTensor::ODD_IN_X, StressTensor::ODD_IN_Y]) {
                if *flip {
                    found = found.mirrored(odd);
                }
            }
            Some(found)
        })
    }

    /// FEM on the points of `curve`, on which the model has `model`; `None` if one of them is off
    /// the record's lines.
    pub fn stress(&self, curve: &StressCurve, model: &[StressTensor]) -> Option<StressCurve> {
        let points = curve.at.iter().zip(model);
        let stress: Option<Vec<StressTensor>> =
            points.map(|(at, own)| Some(self.stress_difference(curve, *at)? + *own)).collect();
        Some(StressCurve { stress: stress?, own_error: None, ..curve.clone() })
    }

    /// FEM's pressure on the points of `line`, on which the model has `model`; `None` as above.
    pub fn pressure(&self, line: &PressureLine, model: &[f64]) -> Option<PressureLine> {
        let difference = |[x, y]: [f64; 2]| {
            let (folded, _) = self.fold([x, y, 0.0]);
            self.fem.pressure.iter().find_map(|fem| {
                let at: Vec<[f64; 3]> = fem.at.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
                let ((i, t), _) = place_on(&at, folded)?;
                let own = self.model.line(&fem.name)?;
                let at = |i: usize| fem.p[i] - own.p[i];
                Some(at(i) * (1.0 - t) + at(i + 1) * t)
            })
        };
        let p: Option<Vec<f64>> =
            line.at.iter().zip(model).map(|(at, own)| Some(difference(*at)? + own)).collect();
        Some(PressureLine { p: p?, own_error: None, ..line.clone() })
    }
}
