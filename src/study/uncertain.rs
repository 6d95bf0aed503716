//! What uncertain inputs make of a solution: first-order propagation, and a seeded Latin hypercube.
//!
//! Inputs are normal and independent, given by their standard deviations. To first order the
//! standard deviation of a result is the root of the sum of (df/dx_i s_i)^2, the derivatives taken
//! over one deviation to both sides (JCGM 100:2008, 5.1.2). A Latin hypercube (McKay, Beckman and
//! Conover, Technometrics 21 (1979) 239) has one sample in each of equally likely strata of every
//! input, and no correlation between inputs; it sees what is not linear, too. Both use places in
//! metres that do not move with the inputs.

use crate::base::number::stated;
use crate::base::{BodyKind, Error, Result};
use crate::body::EdgeModel;
use crate::case::{Case, Draft, Form, KEYS, Key};
use crate::solve::{Options, SolvedCase};
use crate::stress::{Curves, EDGE, Quantity, Variable, away_from_edges};
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, Normal};

/// An uncertain number of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// The number.
    pub key: &'static Key,
    /// Its value.
    pub value: f64,
    /// Its standard deviation.
    pub deviation: f64,
}

/// Most samples.
pub const MOST_SAMPLES: usize = 10_000;

/// What a deviation may be at most, as a part of its value: beyond, first order means nothing.
const MOST_RELATIVE: f64 = 0.5;

/// Tables whose numbers are no part of the contact.
const OTHERS: [&str; 3] = ["accuracy", "cells", "fatigue"];

impl Input {
    /// Reads `load_n=5%` (a part of the value) or `roller.radius_m=1e-5` (in the number's unit): a
    /// number of `case` by its path, its column or its own name.
    ///
    /// # Errors
    /// [`Error::Value`] with what to write.
    pub fn parse(text: &str, case: &Case) -> Result<Self> {
        let refuse = |reason: String| Error::Value {
            key: "--uncertain".into(),
            value: text.into(),
            reason,
            remedy: "give for example load_n=5% or roller.radius_m=1e-5".into(),
        };
        let (name, amount) = text
            .split_once('=')
            .ok_or_else(|| refuse("a number and its standard deviation belong here".into()))?;
        let name = if name == "load_n" { "load.force_n" } else { name };
        let draft = Draft::of(case, Form::Load);
        let fits = |key: &&Key| key.fits(&draft) && !OTHERS.contains(&key.table());
        let given = || KEYS.iter().filter(fits).filter_map(|key| Some((key, key.get(&draft)?)));
        let named = |(key, _): &(&Key, f64)| key.path == name || key.column == name;
        let (key, value) = given().find(named).ok_or_else(|| {
            let known: Vec<&str> = given().map(|(key, _)| key.path).collect();
            refuse(format!("the case gives no number {name}; it gives {}", known.join(", ")))
        })?;
        let number =
            |text: &str| text.trim().parse::<f64>().ok().filter(|v| v.is_finite() && *v > 0.0);
        let deviation = match amount.trim().strip_suffix('%') {
            Some(percent) => number(percent).map(|p| 0.01 * p * value.abs()),
            None => number(amount),
        };
        let deviation = deviation.filter(|d| *d > 0.0).ok_or_else(|| {
            refuse(format!(
                "'{amount}' is no standard deviation of {}: it is greater than zero",
                stated(value)
            ))
        })?;
        if value != 0.0 && deviation > MOST_RELATIVE * value.abs() {
            return Err(refuse(format!(
                "a deviation of more than half the value {} is no small one",
                stated(value)
            )));
        }
        let input = Self { key, value, deviation };
        // Before anything is solved: first order takes one deviation to both sides.
        input.moved(case, 1.0).and_then(|_| input.moved(case, -1.0))?;
        Ok(input)
    }

    /// The case with this number moved by `deviations`.
    ///
    /// # Errors
    /// [`Error::Value`] that names `--uncertain`, if that is no legal case.
    fn moved(&self, case: &Case, deviations: f64) -> Result<Case> {
        let mut draft = Draft::of(case, Form::Load);
        let moved = self.value + deviations * self.deviation;
        self.key.set(&mut draft, moved);
        draft.case().map_err(|e| match e {
            Error::Value { reason, .. } => Error::Value {
                key: "--uncertain".into(),
                value: format!("{}={}", self.key.path, stated(self.deviation)),
                reason: format!("a sample is {}, and {reason}", stated(moved)),
                remedy: "give a smaller deviation, or leave it out".into(),
            },
            other => other,
        })
    }
}

/// A result and what is not known of it, in the result's own unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Spread {
    /// With the inputs as they are.
    pub value: f64,
    /// Standard deviation to first order.
    pub first_order: f64,
    /// The part of each input in it.
    pub parts: Vec<f64>,
    /// Mean of the samples.
    pub mean: f64,
    /// Their standard deviation.
    pub deviation: f64,
    /// The samples' 2.5 % and 97.5 % quantiles.
    pub interval: [f64; 2],
}

/// A result on a curve: where it is, and what.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// The body; none for the contact pressure.
    pub body: Option<BodyKind>,
    /// The curve or pressure line.
    pub curve: String,
    /// The point (m).
    pub at_m: [f64; 3],
    /// What it is.
    pub variable: Variable,
}

/// The spreads of a solution (SI units).
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertain {
    /// The uncertain numbers.
    pub inputs: Vec<Input>,
    /// Number of samples.
    pub samples: usize,
    /// The seed.
    pub seed: u64,
    /// Results of the whole contact by name.
    pub whole: Vec<(&'static str, Spread)>,
    /// Results on curves.
    pub curves: Vec<(Place, Spread)>,
}

/// Names of the results of the whole contact.
const WHOLE: [&str; 4] = ["p_centre_pa", "p_max_pa", "approach_m", "critical_pa"];

/// Propagates `inputs` through the solution of `case` by `method`, with `samples` of a Latin
/// hypercube from `seed`.
///
/// `nominal` has the curves whose points the results are at.
///
/// # Errors
/// [`Error::Value`] for no or too many samples, or where a sample is no legal case; as
/// [`SolvedCase::new`].
pub fn propagate(
    case: &Case,
    method: EdgeModel,
    nominal: &Curves,
    inputs: Vec<Input>,
    (samples, seed): (usize, u64),
) -> Result<Uncertain> {
    if !(2..=MOST_SAMPLES).contains(&samples) {
        return Err(Error::Value {
            key: "--samples".into(),
            value: samples.to_string(),
            reason: format!("a Latin hypercube has 2 to {MOST_SAMPLES} samples"),
            remedy: "64 are usual".into(),
        });
    }
    // Which points count for the critical stress does not change with the inputs.
    let overlap = case.overlap();
    let results = |case: &Case| results(case, method, nominal, overlap);
    let value = results(case)?;
    let steps = inputs.iter().flat_map(|input| [(input, 1.0), (input, -1.0)]);
    let moved: Vec<Case> = steps.map(|(input, by)| input.moved(case, by)).collect::<Result<_>>()?;
    let cube = latin_hypercube(inputs.len(), samples, seed);
    let drawn = cube.iter().map(|point| {
        let mut by = inputs.iter().zip(point);
        by.try_fold(case.clone(), |case, (input, by)| input.moved(&case, *by))
    });
    let drawn: Vec<Case> = drawn.collect::<Result<_>>()?;
    let moved: Vec<Vec<f64>> = moved.par_iter().map(results).collect::<Result<_>>()?;
    let drawn: Vec<Vec<f64>> = drawn.par_iter().map(results).collect::<Result<_>>()?;
    let spread = |i: usize| {
        let parts: Vec<f64> =
            moved.chunks(2).map(|pair| 0.5 * (pair[0][i] - pair[1][i]).abs()).collect();
        Spread {
            value: value[i],
            first_order: parts.iter().map(|p| p * p).sum::<f64>().sqrt(),
            parts,
            ..sampled(drawn.iter().map(|sample| sample[i]).collect())
        }
    };
    let whole = WHOLE.iter().enumerate().map(|(i, name)| (*name, spread(i))).collect();
    let places = places(nominal).into_iter().enumerate();
    let curves = places.map(|(i, place)| (place, spread(WHOLE.len() + i))).collect();
    Ok(Uncertain { inputs, samples, seed, whole, curves })
}

/// Mean, deviation and quantiles of samples.
fn sampled(mut values: Vec<f64>) -> Spread {
    values.sort_by(f64::total_cmp);
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let quantile = |q: f64| {
        let at = q * (count - 1.0);
        let (low, part) = (at.floor() as usize, at.fract());
        let high = (low + 1).min(values.len() - 1);
        values[low] * (1.0 - part) + values[high] * part
    };
    Spread {
        value: f64::NAN,
        first_order: f64::NAN,
        parts: Vec::new(),
        mean,
        deviation: square.sqrt(),
        interval: [quantile(0.025), quantile(0.975)],
    }
}

/// The places of results, in the order of [`results`].
fn places(nominal: &Curves) -> Vec<Place> {
    let c_m = nominal.hertz.c_m;
    let lines = nominal.pressure.iter().flat_map(|line| {
        line.at.iter().map(move |[x, y]| Place {
            body: None,
            curve: line.name.clone(),
            at_m: [x * c_m, y * c_m, 0.0],
            variable: Variable::Pressure,
        })
    });
    let curves = nominal.stress.iter().flat_map(|curve| {
        curve.at.iter().flat_map(move |at| {
            Quantity::ALL.into_iter().map(move |quantity| Place {
                body: Some(curve.body),
                curve: curve.name.clone(),
                at_m: at.map(|v| v * c_m),
                variable: Variable::Stress(quantity),
            })
        })
    });
    lines.chain(curves).collect()
}

/// All results of `case` at the points of `nominal`, whose bodies overlap as given (C), in SI
/// units: those of [`WHOLE`], then those of [`places`]. Points that a shorter body does not reach
/// are those of its end.
fn results(
    case: &Case,
    method: EdgeModel,
    nominal: &Curves,
    overlap: [f64; 2],
) -> Result<Vec<f64>> {
    let options = Options { curves: Vec::new(), ..Options::new(method) };
    let solved = SolvedCase::new(case, &options)?;
    let summary = solved.solution().summary;
    let (from, to) = (nominal.hertz.c_m, *solved.hertz());
    let scaled = |v: f64| v * from / to.c_m;
    let [low, high] = case.overlap();
    let mut at_places = Vec::new();
    for line in &nominal.pressure {
        let at = line.at.iter().map(|[x, y]| [scaled(*x), scaled(*y).clamp(low, high)]);
        at_places.extend(at.map(|[x, y]| solved.pressure(x, y) * to.p0_pa));
    }
    let mut critical = f64::NAN;
    for curve in &nominal.stress {
        let [low, high] = case.ends_m(curve.body).map(|y| y / to.c_m);
        let inside = |at: &[f64; 3]| {
            let [x, y, z] = at.map(scaled);
            [x, y.clamp(low, high), z]
        };
        let points: Vec<[f64; 3]> = curve.at.iter().map(inside).collect();
        for (at, stress) in curve.at.iter().zip(solved.stress(curve.body, &points)?) {
            at_places.extend(Quantity::ALL.map(|q| q.of(&stress) * to.p0_pa));
            if away_from_edges(*at, overlap, EDGE) {
                critical = critical.max(stress.von_mises() * to.p0_pa);
            }
        }
    }
    let mut all = vec![summary.p_centre_pa, summary.p_max_pa, summary.approach_m, critical];
    all.extend(at_places);
    Ok(all)
}

/// Points of a Latin hypercube in `inputs` directions, as deviations of a normal distribution.
/// Inputs are independent, so the points are ordered to have no correlation: by chance two inputs
/// would have one of some samples^(-1/2), which changes the deviation of what depends on both.
fn latin_hypercube(inputs: usize, samples: usize, seed: u64) -> Vec<Vec<f64>> {
    let normal = Normal::new(0.0, 1.0).expect("a positive deviation");
    let mut points = unit_hypercube(inputs, samples, seed);
    points.iter_mut().flatten().for_each(|part| *part = normal.inverse_cdf(*part));
    // One pass leaves a tenth of the correlations, further ones half of that.
    for input in (0..3).flat_map(|_| 1..inputs) {
        uncorrelate(&mut points, input);
    }
    points
}

/// Reorders the values of one input among the `points` by what the inputs before it do not explain
/// (ranked Gram-Schmidt: Owen, J. Am. Stat. Assoc. 89 (1994) 1517). The strata stay.
fn uncorrelate(points: &mut [Vec<f64>], input: usize) {
    let mut rest: Vec<f64> = points.iter().map(|point| point[input]).collect();
    let mut values = rest.clone();
    for before in 0..input {
        let along: f64 = points.iter().zip(&rest).map(|(point, r)| point[before] * r).sum();
        let square: f64 = points.iter().map(|point| point[before].powi(2)).sum();
        rest.iter_mut().zip(&*points).for_each(|(r, point)| *r -= along / square * point[before]);
    }
    let mut ranked: Vec<usize> = (0..points.len()).collect();
    ranked.sort_by(|a, b| rest[*a].total_cmp(&rest[*b]));
    values.sort_by(f64::total_cmp);
    ranked.into_iter().zip(values).for_each(|(point, value)| points[point][input] = value);
}

/// Points of a Latin hypercube of `inputs` directions, each between 0 and 1.
pub(super) fn unit_hypercube(inputs: usize, samples: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut state = seed;
    let mut next = || {
        // Steele, Lea and Flood (OOPSLA 2014): SplitMix64.
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as f64 / 2f64.powi(64)
    };
    let mut points = vec![vec![0.0; inputs]; samples];
    for input in 0..inputs {
        let mut strata: Vec<usize> = (0..samples).collect();
        // Fisher and Yates.
        for i in (1..samples).rev() {
            strata.swap(i, ((next() * (i + 1) as f64) as usize).min(i));
        }
        for (point, stratum) in points.iter_mut().zip(strata) {
            let within = next().clamp(1e-6, 1.0 - 1e-6);
            point[input] = (stratum as f64 + within) / samples as f64;
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::solve;
    use std::path::Path;

    fn case() -> Case {
        let mut case = Case::find(Path::new("flush-short")).unwrap();
        case.accuracy.tolerance = 1e-2;
        case
    }

    #[test]
    fn a_cube_has_one_sample_in_each_stratum_and_repeats_itself() {
        let points = latin_hypercube(3, 50, 7);
        let normal = Normal::new(0.0, 1.0).unwrap();
        for input in 0..3 {
            let mut strata: Vec<usize> =
                points.iter().map(|p| (50.0 * normal.cdf(p[input])) as usize).collect();
            strata.sort_unstable();
            assert_eq!(strata, (0..50).collect::<Vec<_>>());
        }
        assert_eq!(points, latin_hypercube(3, 50, 7));
        assert_ne!(points, latin_hypercube(3, 50, 8));
    }

    /// By chance correlations of 32 samples would have a root mean square of 0.18.
    #[test]
    fn samples_of_independent_inputs_are_uncorrelated() {
        for seed in 1..=20 {
            let points = latin_hypercube(4, 32, seed);
            let product = |i: usize, j: usize| points.iter().map(|p| p[i] * p[j]).sum::<f64>();
            for (i, j) in [(0, 1), (0, 2), (1, 2), (0, 3), (1, 3), (2, 3)] {
                let correlation = product(i, j) / (product(i, i) * product(j, j)).sqrt();
                assert!(correlation.abs() < 0.07, "seed {seed}, {i} and {j}: {correlation}");
            }
        }
    }

    /// Of a longer block, whose most stressed point lies at the overlap's end.
    #[test]
    fn the_critical_stress_is_that_of_all_curves() {
        let mut case = case();
        case.block.length_m = 2.0 * case.roller.length_m;
        let solution = solve(&case, &Options::new(EdgeModel::Mirror)).unwrap();
        let inputs = vec![Input::parse("load_n=5%", &case).unwrap()];
        let found = propagate(&case, EdgeModel::Mirror, &solution.curves, inputs, (2, 1)).unwrap();
        let (name, critical) = &found.whole[3];
        let wanted = solution.summary.critical.unwrap();
        assert_eq!(*name, "critical_pa");
        assert!(wanted.at_m[1].abs() > 0.8 * 0.5 * case.roller.length_m, "{wanted:?}");
        assert!((critical.value / wanted.value_pa - 1.0).abs() < 5e-3, "{critical:?}, {wanted:?}");
        // The stress of a line contact goes with the root of the load, at a fixed place beside a
        // singular end with a little more.
        assert!((critical.parts[0] / critical.value - 0.029).abs() < 5e-3, "{critical:?}");
    }

    /// In a line contact the pressure goes with the root of the load and of the modulus: 5 % and 4
    /// % make 2.5 % and 2 %, and 3.2 % together.
    #[test]
    fn the_pressure_of_a_line_contact_spreads_as_the_root_of_load_and_modulus() {
        let mut case = case();
        // One rigid body, so that the other's modulus is that of the contact.
        case.roller.material.young_pa = 1e14;
        let options =
            Options { curves: vec!["depth-centre".into()], ..Options::new(EdgeModel::Mirror) };
        let nominal = solve(&case, &options).unwrap().curves;
        let inputs: Vec<Input> = ["load_n=5%", "block.young_pa=4%"]
            .iter()
            .map(|t| Input::parse(t, &case).unwrap())
            .collect();
        let found = propagate(&case, EdgeModel::Mirror, &nominal, inputs, (32, 1)).unwrap();
        let (name, centre) = &found.whole[0];
        assert_eq!(*name, "p_centre_pa");
        let relative = |v: f64| v / centre.value;
        assert!((relative(centre.parts[0]) - 0.025).abs() < 1e-3, "{centre:?}");
        assert!((relative(centre.parts[1]) - 0.020).abs() < 1e-3, "{centre:?}");
        assert!((relative(centre.first_order) - 0.032).abs() < 2e-3, "{centre:?}");
        // The samples say the same, within what 32 of them can.
        assert!((centre.deviation / centre.first_order - 1.0).abs() < 0.1, "{centre:?}");
        assert!(centre.interval[0] < centre.value && centre.value < centre.interval[1]);
        let on_line = found.curves.iter().find(|(place, _)| place.body.is_none()).unwrap();
        assert!((on_line.1.value / centre.value - 1.0).abs() < 1e-3);
        assert_eq!(found.curves.len(), places(&nominal).len());
    }

    #[test]
    fn inputs_that_mean_nothing_are_refused() {
        for (text, wanted) in [
            ("load_n", "a number and its standard deviation"),
            ("lod_n=5%", "the case gives no number lod_n; it gives roller.radius_m"),
            ("load_n=5x", "'5x' is no standard deviation"),
            ("load_n=-5%", "'-5%' is no standard deviation"),
            ("load_n=80%", "no small one"),
            ("W=5%", "the case gives no number W"),
            ("load.approach_m=1e-7", "the case gives no number load.approach_m"),
            ("accuracy.tolerance=5%", "the case gives no number"),
            (
                "sliding.friction=0.1",
                "--uncertain = sliding.friction=0.1 is not valid: a sample is -0.1, and the friction",
            ),
        ] {
            let said = Input::parse(text, &case()).unwrap_err().to_string();
            assert!(said.contains(wanted), "{text}: {said}");
            assert!(!said.contains(", load.approach_m"), "{said}");
        }
        let radius = Input::parse("roller.radius_m=1e-5", &case()).unwrap();
        assert_eq!(radius.deviation, 1e-5);
    }
}
