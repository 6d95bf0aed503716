//! Effects of a two-level factorial study.
//!
//! A study is deterministic: a repeated run gives the same numbers, so no error can be estimated
//! from replicates. Instead, Lenth's pseudo standard error treats the small effects as noise (R. V.
//! Lenth, "Quick and Easy Analysis of Unreplicated Factorials", Technometrics 31 (1989) 469-473).
//!
//! An effect is the mean of the response at the factor's high level less the mean at its low level
//! (for an interaction: where the product of the coded levels is +1 less where it is -1), so it is
//! twice the coefficient of a regression on coded levels -1 and +1.

use crate::base::{Error, Result};
use crate::case::two_level::{TwoLevel, Word, positive};
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// One main effect or interaction.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect {
    /// The factors it belongs to, as indices into the design's factors, ascending.
    pub factors: Vec<usize>,
    /// Its value, in the response's unit; the sum of it and its aliases.
    pub value: f64,
    /// The effects that it cannot be told from, with the signs in which they stand in the sum;
    /// short ones first. None in a full design.
    pub aliases: Vec<Word>,
}

/// The analysis of one response.
#[derive(Debug, Clone, PartialEq)]
pub struct Analysis {
    /// Mean of the response over the corners.
    pub mean: f64,
    /// One effect for each product of basic factors in standard order (A, B, AB, C, AC, BC, ABC):
    /// in a full design all 2^k - 1 effects, else the shortest of each set of aliases.
    pub effects: Vec<Effect>,
    /// Lenth's limits; `None` for fewer than three effects.
    pub lenth: Option<Lenth>,
    /// Mean of the corners less the mean at the centre, where the study has a centre point.
    pub curvature: Option<f64>,
}

/// Lenth's limits for a set of effects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lenth {
    /// Pseudo standard error of an effect.
    pub pse: f64,
    /// Margin of error: an effect beyond it is active at 95 % taken by itself.
    pub me: f64,
    /// Simultaneous margin of error: 95 % for all effects together.
    pub sme: f64,
}

/// How an effect compares with Lenth's limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Beyond the simultaneous margin of error.
    Active,
    /// Between the two margins.
    Likely,
    /// Within the margin of error.
    Noise,
}

impl Lenth {
    /// Limits at 95 % for at least three effects.
    pub fn new(effects: &[f64]) -> Option<Self> {
        let m = effects.len();
        if m < 3 || effects.iter().any(|e| !e.is_finite()) {
            return None;
        }
        let magnitudes: Vec<f64> = effects.iter().map(|e| e.abs()).collect();
        let s0 = 1.5 * median(magnitudes.clone());
        let small: Vec<f64> = magnitudes.into_iter().filter(|&e| e < 2.5 * s0).collect();
        // More than half of the effects are zero: no small effect is left.
        let pse = if small.is_empty() { 0.0 } else { 1.5 * median(small) };
        let t = StudentsT::new(0.0, 1.0, m as f64 / 3.0).ok()?;
        let simultaneous = 0.5 * (1.0 + 0.95f64.powf(1.0 / m as f64));
        Some(Self { pse, me: t.inverse_cdf(0.975) * pse, sme: t.inverse_cdf(simultaneous) * pse })
    }

    /// Classifies an effect by the limits.
    pub fn verdict(&self, effect: f64) -> Verdict {
        if effect.abs() > self.sme {
            Verdict::Active
        } else if effect.abs() > self.me {
            Verdict::Likely
        } else {
            Verdict::Noise
        }
    }
}

/// Median of a list that is not empty.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    if n % 2 == 1 { values[n / 2] } else { 0.5 * (values[n / 2 - 1] + values[n / 2]) }
}

/// The responses in the standard order of the basic factors' levels.
///
/// # Errors
/// As [`analyse`].
fn in_standard_order(design: &TwoLevel, coded: &[Vec<i8>], response: &[f64]) -> Result<Vec<f64>> {
    let refuse = |value: String, reason: &str| Error::Value {
        key: "factorial design".to_string(),
        value,
        reason: reason.to_string(),
        remedy: "give every run of the design once".to_string(),
    };
    let n = 1usize << design.basic();
    if coded.len() != n || response.len() != n {
        return Err(refuse(format!("{} runs", coded.len()), "it is not complete"));
    }
    let mut ordered = vec![f64::NAN; n];
    for (levels, &y) in coded.iter().zip(response) {
        if levels.len() != design.factors() || levels.iter().any(|l| l.abs() != 1) {
            return Err(refuse(format!("{levels:?}"), "a level is neither -1 nor +1"));
        }
        let (basic, generated) = levels.split_at(design.basic());
        if design.generated(basic) != generated {
            return Err(refuse(format!("{levels:?}"), "the design has no such run"));
        }
        let slot: usize = basic.iter().enumerate().map(|(i, &l)| usize::from(l > 0) << i).sum();
        if !y.is_finite() {
            return Err(refuse(format!("{y}"), "the response of a run is not finite"));
        }
        if !ordered[slot].is_nan() {
            return Err(refuse(format!("{levels:?}"), "the run is there twice"));
        }
        ordered[slot] = y;
    }
    Ok(ordered)
}

/// Analyses one response of a two-level design.
///
/// `coded[i]` are the levels (-1 or +1) of the factors in run i, in any order of the runs;
/// `response[i]` is the response of run i. `centre` is the response at the centre point, if there
/// is one.
///
/// # Errors
/// [`Error::Value`] when the runs are not those of the design exactly once, or a response is not
/// finite.
pub fn analyse(
    design: &TwoLevel,
    coded: &[Vec<i8>],
    response: &[f64],
    centre: Option<f64>,
) -> Result<Analysis> {
    let mut ordered = in_standard_order(design, coded, response)?;
    let (k, n) = (design.basic(), ordered.len());
    // Yates' algorithm: k passes of pairwise sums and differences leave the contrasts in standard
    // order.
    for _ in 0..k {
        let half = n / 2;
        let sums: Vec<f64> = (0..half).map(|i| ordered[2 * i] + ordered[2 * i + 1]).collect();
        let differences = (0..half).map(|i| ordered[2 * i + 1] - ordered[2 * i]);
        ordered = sums.iter().copied().chain(differences).collect();
    }
    let mean = ordered[0] / n as f64;
    // The contrast of a product of basic factors is the sum of its set of aliases.
    let effect = |(set, contrast): (Vec<Word>, &f64)| Effect {
        factors: set[0].factors(),
        value: f64::from(set[0].sign()) * contrast / (n / 2) as f64,
        aliases: positive(&set)[1..].to_vec(),
    };
    let effects: Vec<Effect> =
        design.aliases().into_iter().zip(&ordered[1..]).map(effect).collect();
    let lenth = Lenth::new(&effects.iter().map(|e| e.value).collect::<Vec<_>>());
    Ok(Analysis { mean, effects, lenth, curvature: centre.map(|c| mean - c) })
}

/// Half-normal quantile that the i-th smallest (from 0) of `m` absolute effects is plotted at.
pub fn half_normal_quantile(i: usize, m: usize) -> f64 {
    Normal::standard().inverse_cdf(0.5 + 0.5 * (i as f64 + 0.5) / m as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::two_level::{short, sum};
    use approx::assert_relative_eq;

    fn full(factors: usize) -> TwoLevel {
        TwoLevel::full(factors).unwrap()
    }

    #[test]
    fn coefficients_of_a_known_response_come_back() {
        // Coefficients on coded levels, indexed like the standard order: 1, A, B, AB, C, ...
        let beta = [10.0, 3.0, -2.0, 0.5, 0.25, -0.125, 1.75, -4.0];
        let mut runs = full(3).runs();
        runs.reverse();
        runs.swap(1, 5);
        let response: Vec<f64> = runs
            .iter()
            .map(|x| {
                (0..8usize)
                    .map(|term| {
                        let product: i8 =
                            (0..3).map(|i| if term >> i & 1 == 1 { x[i] } else { 1 }).product();
                        beta[term] * f64::from(product)
                    })
                    .sum()
            })
            .collect();
        let analysis = analyse(&full(3), &runs, &response, Some(9.5)).unwrap();
        assert_relative_eq!(analysis.mean, beta[0], epsilon = 1e-12);
        assert_relative_eq!(analysis.curvature.unwrap(), 0.5, epsilon = 1e-12);
        for (effect, b) in analysis.effects.iter().zip(&beta[1..]) {
            assert_relative_eq!(effect.value, 2.0 * b, epsilon = 1e-12);
        }
        let names: Vec<&[usize]> = analysis.effects.iter().map(|e| &e.factors[..]).collect();
        let expected: [&[usize]; 7] = [&[0], &[1], &[0, 1], &[2], &[0, 2], &[1, 2], &[0, 1, 2]];
        assert_eq!(names, expected);
    }

    /// D. C. Montgomery, Design and Analysis of Experiments, 8th ed. (2013), Example 6.2 (the
    /// filtration rate of a pilot plant) and the section on Lenth's method that follows it:
    /// PSE = 2.625, ME = 2.571 x 2.625 = 6.75, SME = 5.219 x 2.625 = 13.70.
    #[test]
    fn lenth_limits_agree_with_a_published_example() {
        let rate = [
            45.0, 71.0, 48.0, 65.0, 68.0, 60.0, 80.0, 65.0, 43.0, 100.0, 45.0, 104.0, 75.0, 86.0,
            70.0, 96.0,
        ];
        let analysis = analyse(&full(4), &full(4).runs(), &rate, None).unwrap();
        let effect = |factors: &[usize]| {
            analysis.effects.iter().find(|e| e.factors == factors).unwrap().value
        };
        assert_relative_eq!(analysis.mean, 70.0625, epsilon = 1e-12);
        assert_relative_eq!(effect(&[0]), 21.625, epsilon = 1e-12);
        assert_relative_eq!(effect(&[0, 2]), -18.125, epsilon = 1e-12);
        assert_relative_eq!(effect(&[0, 3]), 16.625, epsilon = 1e-12);
        let lenth = analysis.lenth.unwrap();
        assert_relative_eq!(lenth.pse, 2.625, epsilon = 1e-12);
        assert_relative_eq!(lenth.me, 6.75, epsilon = 0.005);
        assert_relative_eq!(lenth.sme, 13.70, epsilon = 0.005);
        // A, AC, D and AD are beyond both margins, C beyond the first only, and nothing else is.
        let with = |verdict: Verdict| -> Vec<&[usize]> {
            let all = analysis.effects.iter();
            all.filter(|e| lenth.verdict(e.value) == verdict).map(|e| &e.factors[..]).collect()
        };
        let active: [&[usize]; 4] = [&[0], &[0, 2], &[3], &[0, 3]];
        assert_eq!(with(Verdict::Active), active);
        assert_eq!(with(Verdict::Likely), [&[2usize][..]]);
    }

    #[test]
    fn incomplete_designs_are_refused() {
        let full = full(2);
        let mut runs = full.runs();
        assert!(analyse(&full, &runs[..3], &[1.0, 2.0, 3.0], None).is_err());
        assert!(analyse(&full, &runs, &[1.0, 2.0, 3.0, f64::NAN], None).is_err());
        let half = TwoLevel::fractional(3, &["C = AB"]).unwrap();
        let others: Vec<Vec<i8>> = runs.iter().map(|run| vec![run[0], run[1], 1]).collect();
        let message = analyse(&half, &others, &[1.0; 4], None).unwrap_err().to_string();
        assert!(message.contains("the design has no such run"), "{message}");
        runs[3] = vec![-1, -1];
        let message = analyse(&full, &runs, &[1.0, 2.0, 3.0, 4.0], None).unwrap_err().to_string();
        assert!(message.contains("twice"), "{message}");
    }

    /// Montgomery, example 8.1: the filtration rates of the half fraction of four factors.
    #[test]
    fn the_filtration_rates_of_a_half_fraction_give_the_published_estimates() {
        let half = TwoLevel::fractional(4, &["D = ABC"]).unwrap();
        let rates = [45.0, 100.0, 45.0, 65.0, 75.0, 60.0, 80.0, 96.0];
        let effects = analyse(&half, &half.runs(), &rates, None).unwrap().effects;
        let found: Vec<(Vec<usize>, String, f64)> =
            effects.iter().map(|e| (e.factors.clone(), sum(short(&e.aliases)), e.value)).collect();
        let wanted = [
            (vec![0], "BCD", 19.0),
            (vec![1], "ACD", 1.5),
            (vec![0, 1], "CD", -1.0),
            (vec![2], "ABD", 14.0),
            (vec![0, 2], "BD", -18.5),
            (vec![0, 3], "BC", 19.0),
            (vec![3], "ABC", 16.5),
        ];
        assert_eq!(found, wanted.map(|(own, aliases, value)| (own, aliases.to_string(), value)));
    }

    #[test]
    fn a_negative_word_turns_its_estimate() {
        let half = TwoLevel::fractional(3, &["C = -AB"]).unwrap();
        // The response is the level of C.
        let response: Vec<f64> = half.runs().iter().map(|run| f64::from(run[2])).collect();
        let effects = analyse(&half, &half.runs(), &response, None).unwrap().effects;
        assert_eq!((&effects[2].factors[..], effects[2].value), (&[2][..], 2.0));
        assert_eq!(sum(&effects[2].aliases), "-AB");
    }

    #[test]
    fn half_normal_quantiles() {
        // The normal quantile of 0.75 is 0.674490.
        assert_relative_eq!(half_normal_quantile(0, 1), 0.674_489_750_196, epsilon = 1e-9);
        assert!(half_normal_quantile(6, 7) > half_normal_quantile(5, 7));
    }
}
