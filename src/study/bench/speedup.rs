//! FEM's time over a model's, at an error that neither exceeds.

use super::point::{Against, BEST, BenchPoint, CaseBench, Origin};
use crate::fem::Code;
use crate::study::source::{Engine, Source};
use crate::study::timing::{Ratio, Timing};
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
    /// The code of the fastest mesh within the level; files name it where it is not FEniCSx.
    #[serde(default = "Engine::fenicsx", skip_serializing_if = "Engine::is_fenicsx")]
    pub engine: Engine,
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

/// FEM against the published method on cells at the error that it reaches in each case, timed in
/// one run.
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
    let live = |p: &BenchPoint| p.origin == Origin::LiveFem;
    let (fem, fem_time) = fastest(case, level, Against::Fem, &live)?;
    let (model, model_time) = fastest(case, level, against, chosen)?;
    Some(Speedup {
        case: case.case.name.clone(),
        level,
        against,
        engine: fem.source.engine()?.clone(),
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

/// The fastest of the `chosen` points of a case whose error is within the level.
fn fastest<'a>(
    case: &'a CaseBench,
    level: f64,
    against: Against,
    chosen: &dyn Fn(&BenchPoint) -> bool,
) -> Option<(&'a BenchPoint, Timing)> {
    let within = |p: &&BenchPoint| chosen(p) && p.error(against).is_some_and(|e| e <= level);
    let timed = case.points.iter().filter(within).filter_map(|p| Some((p, p.timing?)));
    timed.min_by(|a, b| a.1.median_s.total_cmp(&b.1.median_s))
}

/// Two codes at an error that neither exceeds, timed in one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CodeTimes {
    /// The case.
    pub case: String,
    /// The error that neither exceeds, against the finest mesh of the first code (p0).
    pub level: f64,
    /// The fastest mesh of each within the level, the fastest first.
    pub codes: Vec<CodeTime>,
    /// The time of the slowest over that of the fastest.
    pub ratio: Ratio,
}

/// A code's fastest mesh within a level of error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CodeTime {
    /// The code.
    pub engine: Engine,
    /// Relative element size.
    pub size: f64,
    /// Its error (p0).
    pub error: f64,
    /// Median seconds and spread.
    pub seconds: (f64, f64),
}

/// The times of the codes at each level that more than one of them reaches in this run.
pub fn code_times(cases: &[CaseBench], levels: &[f64]) -> Vec<CodeTimes> {
    let at = |case: &CaseBench, level: f64| {
        let of_code = |code: Code| {
            let own = Source::from(Engine::of(code));
            let live = |p: &BenchPoint| p.origin == Origin::LiveFem && p.source == own;
            let (point, timing) = fastest(case, level, Against::Fem, &live)?;
            Some(CodeTime {
                engine: Engine::of(code),
                size: point.setting,
                error: point.error(Against::Fem)?,
                seconds: timing.with_spread(),
            })
        };
        let mut codes: Vec<CodeTime> = Code::ALL.into_iter().filter_map(of_code).collect();
        codes.sort_by(|a, b| a.seconds.0.total_cmp(&b.seconds.0));
        let [first, .., last] = &codes[..] else { return None };
        let ratio = Ratio::new(last.seconds, first.seconds);
        Some(CodeTimes { case: case.case.name.clone(), level, codes, ratio })
    };
    let of_case = |case| levels.iter().filter_map(move |&level| at(case, level));
    cases.iter().flat_map(of_case).collect()
}
