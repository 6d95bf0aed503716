//! FEM's time over a model's, at an error that neither exceeds.

use super::point::{Against, BEST, BenchPoint, CaseBench, Origin};
use crate::study::timing::Ratio;
use serde::{Deserialize, Serialize};

/// Grids whose error is within this factor of the least reach it.
const REACHED: f64 = 1.05;

/// FEM against [`BEST`] at an error that neither exceeds, timed in one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Speedup {
    /// The case.
    pub case: String,
    /// The error that neither exceeds (p0).
    pub level: f64,
    /// The reference of the model's error; FEM's error is always against its finest mesh.
    pub against: Against,
    /// Relative element size of the fastest mesh within the level.
    pub size: f64,
    /// Its unknowns.
    pub unknowns: Option<u64>,
    /// Its error (p0).
    pub fem_error: f64,
    /// Median seconds and spread.
    pub fem_seconds: (f64, f64),
    /// The fastest tolerance within the level; of the published method the number of cells.
    pub tolerance: f64,
    /// The model's error there (p0).
    pub model_error: f64,
    /// Median seconds and spread on one thread.
    pub model_seconds: (f64, f64),
    /// FEM's time over the model's.
    pub ratio: Ratio,
}

/// FEM against [`BEST`] at each level that both reach with a time of this run.
pub fn speedups(cases: &[CaseBench], levels: &[f64]) -> Vec<Speedup> {
    let mut all = Vec::new();
    for case in cases {
        for &level in levels {
            for against in [Against::Limit, Against::Fem] {
                all.extend(speedup(case, level, against));
            }
        }
    }
    all
}

/// FEM against the published method on cells at the error that it reaches in each case, timed in one
/// run.
pub fn published_speedups(cases: &[CaseBench]) -> Vec<Speedup> {
    let of_case = |case: &CaseBench| {
        let own = case.points.iter().filter(|p| p.origin == Origin::Cells);
        let least = own.filter_map(|p| p.error(Against::Fem)).reduce(f64::min)?;
        fem_over(case, REACHED * least, Against::Fem, &|p| p.origin == Origin::Cells)
    };
    cases.iter().filter_map(of_case).collect()
}

fn speedup(case: &CaseBench, level: f64, against: Against) -> Option<Speedup> {
    let best = |p: &BenchPoint| p.origin == Origin::Model && p.source == BEST.into();
    fem_over(case, level, against, &best)
}

/// FEM against the `chosen` points at a level of error.
fn fem_over(
    case: &CaseBench,
    level: f64,
    against: Against,
    chosen: &dyn Fn(&BenchPoint) -> bool,
) -> Option<Speedup> {
    let fastest = |chosen: &dyn Fn(&BenchPoint) -> bool, against: Against| {
        let within = |p: &&BenchPoint| chosen(p) && p.error(against).is_some_and(|e| e <= level);
        let timed = case.points.iter().filter(within).filter_map(|p| Some((p, p.timing?)));
        timed.min_by(|a, b| a.1.median_s.total_cmp(&b.1.median_s))
    };
    let (fem, fem_time) = fastest(&|p| p.origin == Origin::LiveFem, Against::Fem)?;
    let (model, model_time) = fastest(chosen, against)?;
    Some(Speedup {
        case: case.case.name.clone(),
        level,
        against,
        size: fem.setting,
        unknowns: fem.unknowns,
        fem_error: fem.error(Against::Fem)?,
        fem_seconds: fem_time.with_spread(),
        tolerance: model.setting,
        model_error: model.error(against)?,
        model_seconds: model_time.with_spread(),
        ratio: Ratio::new(fem_time.with_spread(), model_time.with_spread()),
    })
}
