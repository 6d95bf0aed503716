//! The profile whose largest stress over all loads is smallest.

use super::uncertain::unit_hypercube;
use crate::base::{Error, HertzScales, Result};
use crate::body::EdgeModel;
use crate::case::{Case, Design, Objective};
use crate::solve::{Options, SolvedCase, Summary, peak};
use crate::stress::Critical;
use argmin::core::{CostFunction, Executor};
use argmin::solver::neldermead::NelderMead;
use rayon::prelude::*;
use std::sync::Mutex;

/// How a profile is sought.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The edge model.
    pub method: EdgeModel,
    /// Tolerance (p0) of the solutions on the way; the optimum is solved with the case's own.
    pub tolerance: f64,
    /// Seed of the first sample.
    pub seed: u64,
    /// Searches from different places.
    pub starts: usize,
}

/// Points of the first sample for each parameter.
const SAMPLES: usize = 6;

/// Size of a search's first simplex, a part of the bounds.
const SIMPLEX: f64 = 0.15;

/// Spread of the objective in a simplex, relative to the first sample's best, at which a search has
/// ended, and its most steps.
const SPREAD: f64 = 3e-4;
const STEPS: u64 = 30;

/// Points of a line through the optimum along each parameter.
const SCAN: usize = 9;

/// Points of a pressure line.
const LINE: usize = 161;

/// One set of parameters that was tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// 0 in the first sample, then the search's number.
    pub search: usize,
    /// Values of the parameters, in their own units.
    pub values: Vec<f64>,
    /// The objective (Pa): the largest value over all loads; none where a load could not be solved.
    pub objective_pa: Option<f64>,
}

/// What one load makes of a profile.
#[derive(Debug, Clone)]
pub struct LoadResult {
    /// The case under the load.
    pub case: Case,
    /// The scales.
    pub hertz: HertzScales,
    /// Its summary.
    pub summary: Summary,
    /// The largest values in the order of [`Objective::ALL`], in p0 and C.
    pub peaks: [Critical; 3],
    /// y (C) and pressure (p0) along x = 0.
    pub line: Vec<[f64; 2]>,
}

/// The outcome of a search.
#[derive(Debug, Clone)]
pub struct Optimum {
    /// The best parameters.
    pub values: Vec<f64>,
    /// Their objective at the tolerance of the search (Pa).
    pub searched_pa: f64,
    /// The same at the case's own tolerance.
    pub confirmed_pa: f64,
    /// All trials, in their order.
    pub history: Vec<Trial>,
    /// For each parameter a line through the optimum: its value and the objective (Pa).
    pub scans: Vec<Vec<(f64, f64)>>,
    /// What each load makes of the best profile.
    pub loads: Vec<LoadResult>,
    /// What each load makes of the case's own profile: its objective (Pa), none where it could not
    /// be solved.
    pub before: Vec<Option<f64>>,
    /// Number of contacts solved.
    pub solves: usize,
}

/// Seeks the profile of `design`; tells `progress` of each trial and the best objective (Pa) so
/// far.
///
/// A Latin hypercube of the bounds is tried first. From its best points Nelder and Mead's simplex
/// descends (Computer Journal 7, 1965, by argmin), which needs no derivatives: the largest of
/// several maxima has none where two are equal. Points beyond the bounds count as the nearest ones
/// within, plus a penalty. No search proves that there is no better profile; several starts that
/// end alike are the evidence.
///
/// # Errors
/// The first error of a solution if no profile of the first sample could be solved under all loads,
/// or the best one could not at the case's own tolerance.
pub fn seek(
    design: &Design,
    settings: &Settings,
    progress: &(dyn Fn(usize, f64) + Sync),
) -> Result<Optimum> {
    let desk = Desk { design, settings, progress, state: Mutex::default() };
    let sample =
        unit_hypercube(design.parameters.len(), SAMPLES * design.parameters.len(), settings.seed);
    let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
    let mut first_error = None;
    for place in sample {
        match desk.objective(0, &place) {
            Ok(objective) => found.push((objective, place)),
            Err(Error::Stopped) => return Err(Error::Stopped),
            Err(e) => drop(first_error.get_or_insert(e)),
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some((unit, _)) = found.first().cloned() else {
        return Err(first_error.expect("a sample has points"));
    };
    for (search, (_, start)) in found.iter().take(settings.starts).enumerate() {
        found_by_simplex(&desk, search + 1, start, unit)?;
    }
    let best = desk.best();
    let scans = desk.scans(&best);
    let values = desk.values(&best);
    let searched_pa = desk.state.lock().unwrap_or_else(|e| e.into_inner()).best.0;
    let count = 0..design.loads.len();
    let loads: Vec<LoadResult> = count
        .clone()
        .into_par_iter()
        .map(|load| desk.load(&design.loaded(&values, load)?))
        .collect::<Result<_>>()?;
    let own = Objective::ALL.iter().position(|o| *o == design.objective).expect("one of all");
    let objective_pa = |load: &LoadResult| load.peaks[own].value * load.hertz.p0_pa;
    let before = count.into_par_iter().map(|load| {
        let found = design.before(load).and_then(|case| desk.load(&case)).ok()?;
        Some(objective_pa(&found))
    });
    let confirmed_pa = loads.iter().map(objective_pa).fold(0.0, f64::max);
    let before = before.collect();
    let state = desk.state.into_inner().unwrap_or_else(|e| e.into_inner());
    Ok(Optimum {
        values,
        searched_pa,
        confirmed_pa,
        history: state.history,
        scans,
        loads,
        before,
        solves: state.solves,
    })
}

/// What the searches share.
struct Desk<'a> {
    design: &'a Design,
    settings: &'a Settings,
    progress: &'a (dyn Fn(usize, f64) + Sync),
    state: Mutex<Found>,
}

/// What was found so far.
struct Found {
    history: Vec<Trial>,
    /// The least objective (Pa), and where: parts of the way between the bounds.
    best: (f64, Vec<f64>),
    solves: usize,
}

impl Default for Found {
    fn default() -> Self {
        Self { history: Vec::new(), best: (f64::INFINITY, Vec::new()), solves: 0 }
    }
}

impl Desk<'_> {
    fn values(&self, place: &[f64]) -> Vec<f64> {
        self.design
            .parameters
            .iter()
            .zip(place)
            .map(|(parameter, part)| parameter.at(*part))
            .collect()
    }

    fn best(&self) -> Vec<f64> {
        self.state.lock().unwrap_or_else(|e| e.into_inner()).best.1.clone()
    }

    /// The objective of one load (Pa) at the search's tolerance.
    fn peak_pa(&self, case: &Case) -> Result<f64> {
        let case =
            case.clone().with_tolerance(self.settings.tolerance.max(case.accuracy.tolerance));
        let options = Options { curves: Vec::new(), ..Options::new(self.settings.method) };
        let solved = SolvedCase::new(&case, &options)?;
        let found = peak(&solved, self.design.objective, self.design.exclude_c);
        Ok(found.value * solved.hertz().p0_pa)
    }

    /// The objective (Pa) at a place between the bounds, which is recorded.
    fn objective(&self, search: usize, place: &[f64]) -> Result<f64> {
        crate::base::stop::go_on()?;
        let values = self.values(place);
        let loads = 0..self.design.loads.len();
        let solves = loads.len();
        let each =
            loads.into_par_iter().map(|load| self.peak_pa(&self.design.loaded(&values, load)?));
        let found: Result<Vec<f64>> = each.collect();
        let found = found.map(|all| all.into_iter().fold(0.0, f64::max));
        let mut state = self.state.lock().unwrap_or_else(|e| e.into_inner());
        state.solves += solves;
        state.history.push(Trial { search, values, objective_pa: found.as_ref().ok().copied() });
        if let Some(objective) = found.as_ref().ok().filter(|objective| **objective < state.best.0)
        {
            state.best = (*objective, place.iter().map(|part| part.clamp(0.0, 1.0)).collect());
        }
        (self.progress)(state.history.len(), state.best.0);
        found
    }

    /// Lines through the best place along each parameter. A point that cannot be solved is left
    /// out.
    fn scans(&self, best: &[f64]) -> Vec<Vec<(f64, f64)>> {
        let line = |i: usize| {
            let mut parts: Vec<f64> = (0..SCAN).map(|j| j as f64 / (SCAN - 1) as f64).collect();
            parts.push(best[i]);
            parts.sort_by(f64::total_cmp);
            let point = |part: f64| {
                let place: Vec<f64> = best
                    .iter()
                    .enumerate()
                    .map(|(j, own)| if j == i { part } else { *own })
                    .collect();
                let values = self.values(&place);
                let each = 0..self.design.loads.len();
                let each = each.map(|load| self.peak_pa(&self.design.loaded(&values, load)?));
                let all: Vec<f64> = each.collect::<Result<_>>().ok()?;
                Some((values[i], all.into_iter().fold(0.0, f64::max)))
            };
            parts.into_par_iter().filter_map(point).collect()
        };
        (0..best.len()).map(line).collect()
    }

    /// What a case under one load sees, at the case's own tolerance.
    fn load(&self, case: &Case) -> Result<LoadResult> {
        let options = Options { curves: Vec::new(), ..Options::new(self.settings.method) };
        let solved = SolvedCase::new(case, &options)?;
        let hertz = *solved.hertz();
        let summary = solved.solution().summary;
        let [from, to] = summary.contact_y_m.map(|y| y / hertz.c_m);
        let place = |i: usize| from + (to - from) * i as f64 / (LINE - 1) as f64;
        Ok(LoadResult {
            case: case.clone(),
            hertz,
            peaks: Objective::ALL.map(|objective| peak(&solved, objective, self.design.exclude_c)),
            line: (0..LINE).map(place).map(|y| [y, solved.pressure(0.0, y)]).collect(),
            summary,
        })
    }
}

/// The objective of one search as argmin takes it: relative to `unit`, places beyond the bounds
/// with a penalty.
struct Cost<'a> {
    desk: &'a Desk<'a>,
    search: usize,
    unit: f64,
}

/// The objective, relative to the best of the first sample, of a profile that cannot be solved.
const UNSOLVED: f64 = 10.0;

impl CostFunction for Cost<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, place: &Vec<f64>) -> std::result::Result<f64, argmin::core::Error> {
        let beyond: f64 = place.iter().map(|part| (part - part.clamp(0.0, 1.0)).abs()).sum();
        match self.desk.objective(self.search, place) {
            Ok(objective) => Ok(objective / self.unit * (1.0 + beyond)),
            Err(Error::Stopped) => Err(argmin::core::Error::msg(Error::Stopped.to_string())),
            Err(_) => Ok(UNSOLVED * (1.0 + beyond)),
        }
    }
}

/// Descends from `start`. What is found is in the history of the desk.
fn found_by_simplex(desk: &Desk, search: usize, start: &[f64], unit: f64) -> Result<()> {
    let corner = |i: usize| {
        let mut place = start.to_vec();
        // Away from the nearer bound.
        place[i] += if place[i] < 0.5 { SIMPLEX } else { -SIMPLEX };
        place
    };
    let simplex = std::iter::once(start.to_vec()).chain((0..start.len()).map(corner)).collect();
    let fault = |e: argmin::core::Error| Error::Value {
        key: "search".into(),
        value: search.to_string(),
        reason: e.to_string(),
        remedy: "give other bounds".into(),
    };
    let solver = NelderMead::new(simplex).with_sd_tolerance(SPREAD).map_err(fault)?;
    let run = Executor::new(Cost { desk, search, unit }, solver)
        .configure(|state| state.max_iters(STEPS))
        .run()
        .map_err(fault)?;
    debug_assert!(run.state().get_best_cost().is_finite());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// A crown for a load in the middle and one beside it: one parameter, which can be tried all
    /// along.
    #[test]
    fn the_search_meets_the_best_crown_of_a_dense_line() {
        let text = "case = \"flush-short\"\nobjective = \"pressure\"\n[profile]\nkind = \"crown\"\n\
                    [bounds]\nradius_m = [0.2, 20.0]\n[[loads]]\nforce_n = 1e4\n\
                    [[loads]]\nforce_n = 1e4\neccentricity_m = 0.1e-3\n";
        let design = Design::parse(text, Path::new("d.toml")).unwrap();
        let method = EdgeModel::QuarterSpace;
        let settings = Settings { method, tolerance: 5e-3, seed: 3, starts: 1 };
        let found = seek(&design, &settings, &|_, _| {}).unwrap();
        let desk = Desk {
            design: &design,
            settings: &settings,
            progress: &|_, _| {},
            state: Mutex::default(),
        };
        let line = (0..=40).map(|i| desk.objective(0, &[f64::from(i) / 40.0]).unwrap());
        let least = line.fold(f64::INFINITY, f64::min);
        assert!(found.searched_pa < 1.002 * least, "{} of {least}", found.searched_pa);
        let confirmed = found.confirmed_pa / found.searched_pa;
        assert!((confirmed - 1.0).abs() < 0.05, "{confirmed}");
        assert!(found.values[0] > 1.0 && found.values[0] < 19.9, "{:?}", found.values);
        let worst = found.scans[0].iter().map(|(_, objective)| *objective).fold(0.0, f64::max);
        assert!(worst > 1.01 * least, "{worst} of {least}");
        // The same seed gives the same search.
        let again = seek(&design, &settings, &|_, _| {}).unwrap();
        assert_eq!(again.history, found.history);
    }
}
