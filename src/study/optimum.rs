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
use std::sync::atomic::{AtomicUsize, Ordering};

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

/// Spread of the objective in a simplex, relative to the best when its search began, at which that
/// has ended, and its most steps.
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
    /// The largest value under the loads looked at (Pa); none where one could not be solved.
    pub objective_pa: Option<f64>,
    /// How many of the loads were looked at. Under the others no trial is better than the best one.
    pub loads: usize,
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
    /// be solved, or did not settle.
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
/// Few of the loads stress a good profile most, and trials look at those alone. The largest stress
/// under some of the loads is a lower bound of that under all, so the best trial is the one whose
/// bound is still the least once all loads have been looked at; a load that is worse there joins,
/// and the search goes on.
///
/// # Errors
/// The first error of a solution if no profile of the first sample could be solved under all loads,
/// or the best one could not at the case's own tolerance.
pub fn seek(
    design: &Design,
    settings: &Settings,
    progress: &(dyn Fn(usize, f64) + Sync),
) -> Result<Optimum> {
    let desk = Desk { design, settings, progress, solves: AtomicUsize::new(0) };
    let mut found = desk.sample()?;
    let starts = found.least(settings.starts).into_iter();
    let starts: Vec<Vec<f64>> = starts.map(|i| found.all[i].place.clone()).collect();
    for (search, mut start) in (1..).zip(starts) {
        loop {
            let known = found.counting.len();
            found = desk.simplex(search, &start, found)?;
            let best = desk.settle(&mut found, 1)?;
            if found.counting.len() == known {
                break;
            }
            start = found.all[best].place.clone();
        }
    }
    let best = found.least(1)[0];
    let (place, searched_pa) = (&found.all[best].place, found.all[best].bound());
    let scans = desk.scans(place);
    let values = desk.values(place);
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
        found.summary.converged.then(|| objective_pa(&found))
    });
    let confirmed_pa = loads.iter().map(objective_pa).fold(0.0, f64::max);
    let before = before.collect();
    let history = found.all.into_iter().map(|tried| tried.trial).collect();
    let solves = desk.solves.into_inner();
    Ok(Optimum { values, searched_pa, confirmed_pa, history, scans, loads, before, solves })
}

/// A trial, where it lies, and what it knows.
#[derive(Debug, Clone)]
struct Tried {
    trial: Trial,
    /// Parts of the ways between the bounds.
    place: Vec<f64>,
    /// What each load sees (Pa), none where it has not been looked at.
    seen_pa: Vec<Option<f64>>,
}

impl Tried {
    /// The largest value under the loads looked at (Pa), infinite for an unsolvable profile.
    fn bound(&self) -> f64 {
        self.trial.objective_pa.unwrap_or(f64::INFINITY)
    }

    fn is_complete(&self) -> bool {
        self.trial.objective_pa.is_none() || self.trial.loads == self.seen_pa.len()
    }
}

/// What was found so far.
#[derive(Debug)]
struct Found {
    all: Vec<Tried>,
    /// The loads that searches look at.
    counting: Vec<usize>,
}

impl Found {
    /// The `count` trials with the least bounds, the least one first.
    fn least(&self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.all.len()).collect();
        order.sort_by(|i, j| self.all[*i].bound().total_cmp(&self.all[*j].bound()));
        order.truncate(count);
        order
    }
}

/// What the searches share.
struct Desk<'a> {
    design: &'a Design,
    settings: &'a Settings,
    progress: &'a (dyn Fn(usize, f64) + Sync),
    /// Contacts solved.
    solves: AtomicUsize,
}

impl Desk<'_> {
    fn values(&self, place: &[f64]) -> Vec<f64> {
        let parameters = self.design.parameters.iter().zip(place);
        parameters.map(|(parameter, part)| parameter.at(*part)).collect()
    }

    fn all_loads(&self) -> Vec<usize> {
        (0..self.design.loads.len()).collect()
    }

    /// What `load` makes of a profile with these parameters (Pa), at the search's tolerance.
    fn peak_pa(&self, values: &[f64], load: usize) -> Result<f64> {
        crate::base::stop::go_on()?;
        self.solves.fetch_add(1, Ordering::Relaxed);
        let case = self.design.loaded(values, load)?;
        let tolerance = self.settings.tolerance.max(case.accuracy.tolerance);
        let case = case.with_tolerance(tolerance);
        let options = Options { curves: Vec::new(), ..Options::new(self.settings.method) };
        let solved = SolvedCase::new(&case, &options)?;
        let found = peak(&solved, self.design.objective, self.design.exclude_c);
        Ok(found.value * solved.hertz().p0_pa)
    }

    /// Looks at the `loads` of a trial that have not been looked at. What cannot be solved has no
    /// objective.
    fn look(&self, tried: &mut Tried, loads: &[usize]) -> Result<()> {
        let new: Vec<usize> =
            loads.iter().copied().filter(|load| tried.seen_pa[*load].is_none()).collect();
        let values = &tried.trial.values;
        let found = new.par_iter().map(|load| self.peak_pa(values, *load));
        let found: Result<Vec<f64>> = found.collect();
        match found {
            Ok(found) => {
                let seen = new.iter().zip(found);
                seen.for_each(|(load, value)| tried.seen_pa[*load] = Some(value));
                let known = || tried.seen_pa.iter().flatten();
                tried.trial.loads = known().count();
                tried.trial.objective_pa = known().copied().reduce(f64::max);
                Ok(())
            }
            Err(error) => {
                tried.trial.objective_pa = None;
                Err(error)
            }
        }
    }

    /// A trial at a place, under these loads, and why it cannot be solved.
    fn tried(&self, search: usize, place: &[f64], loads: &[usize]) -> (Tried, Result<()>) {
        let place: Vec<f64> = place.iter().map(|part| part.clamp(0.0, 1.0)).collect();
        let trial = Trial { search, values: self.values(&place), objective_pa: None, loads: 0 };
        let mut tried = Tried { trial, place, seen_pa: vec![None; self.design.loads.len()] };
        let outcome = self.look(&mut tried, loads);
        (tried, outcome)
    }

    /// The first sample: the first profile of it that can be solved under all loads says which one
    /// counts, and the `starts` best ones are looked at under all.
    fn sample(&self) -> Result<Found> {
        let inputs = self.design.parameters.len();
        let mut places = unit_hypercube(inputs, SAMPLES * inputs, self.settings.seed).into_iter();
        let mut found = Found { all: Vec::new(), counting: Vec::new() };
        let mut first_error = None;
        for place in places.by_ref() {
            let (tried, outcome) = self.tried(0, &place, &self.all_loads());
            self.record(&mut found, tried);
            match outcome {
                Ok(()) => break,
                Err(Error::Stopped) => return Err(Error::Stopped),
                Err(e) => drop(first_error.get_or_insert(e)),
            }
        }
        let first = found.all.len() - 1;
        self.count_worst(&mut found, first);
        let places: Vec<Vec<f64>> = places.collect();
        let rest = places.par_iter().map(|place| self.tried(0, place, &found.counting));
        for (tried, _) in rest.collect::<Vec<_>>() {
            self.record(&mut found, tried);
        }
        crate::base::stop::go_on()?;
        let best = self.settle(&mut found, self.settings.starts)?;
        match found.all[best].trial.objective_pa {
            Some(_) => Ok(found),
            None => Err(first_error.expect("the first profile could not be solved")),
        }
    }

    fn record(&self, found: &mut Found, tried: Tried) {
        found.all.push(tried);
        let best = found.all.iter().map(Tried::bound).fold(f64::INFINITY, f64::min);
        (self.progress)(found.all.len(), best);
    }

    /// Lets the load count that is the worst for a trial, or without one all that it lacks.
    fn count_worst(&self, found: &mut Found, trial: usize) {
        let Tried { trial, seen_pa, .. } = &found.all[trial];
        let counts = |(load, seen): (usize, &Option<f64>)| {
            let worst = trial.objective_pa.is_none_or(|_| *seen == trial.objective_pa);
            (worst && !found.counting.contains(&load)).then_some(load)
        };
        let new: Vec<usize> = seen_pa.iter().enumerate().filter_map(counts).collect();
        found.counting.extend(new);
    }

    /// Looks at the trials with the least bounds under all loads, until the `count` least ones are
    /// those of all loads; returns the best one. What they find the worst counts from there on.
    fn settle(&self, found: &mut Found, count: usize) -> Result<usize> {
        loop {
            let least = found.least(count);
            let Some(&open) = least.iter().find(|i| !found.all[**i].is_complete()) else {
                return Ok(least[0]);
            };
            if let Err(Error::Stopped) = self.look(&mut found.all[open], &self.all_loads()) {
                return Err(Error::Stopped);
            }
            self.count_worst(found, open);
        }
    }

    /// Descends from `start`; what is tried joins what was `found`.
    fn simplex(&self, search: usize, start: &[f64], found: Found) -> Result<Found> {
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
        let unit = found.all[found.least(1)[0]].bound();
        let found = Mutex::new(found);
        let solver = NelderMead::new(simplex).with_sd_tolerance(SPREAD).map_err(fault)?;
        let run = Executor::new(Cost { desk: self, search, unit, found: &found }, solver)
            .configure(|state| state.max_iters(STEPS))
            .run()
            .map_err(fault)?;
        debug_assert!(run.state().get_best_cost().is_finite());
        Ok(found.into_inner().unwrap_or_else(|e| e.into_inner()))
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
                let each = each.map(|load| self.peak_pa(&values, load));
                let all: Vec<f64> = each.collect::<Result<_>>().ok()?;
                Some((values[i], all.into_iter().fold(0.0, f64::max)))
            };
            parts.into_par_iter().filter_map(point).collect()
        };
        (0..best.len()).map(line).collect()
    }

    /// What a case under one load sees, at the case's own tolerance.
    fn load(&self, case: &Case) -> Result<LoadResult> {
        self.solves.fetch_add(1, Ordering::Relaxed);
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

/// The objective of one search as argmin takes it: relative to `unit`, the best when it began, and
/// with a penalty at places beyond the bounds.
struct Cost<'a> {
    desk: &'a Desk<'a>,
    search: usize,
    unit: f64,
    found: &'a Mutex<Found>,
}

/// The objective of a profile that cannot be solved, relative to the best when its search began.
const UNSOLVED: f64 = 10.0;

impl CostFunction for Cost<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, place: &Vec<f64>) -> std::result::Result<f64, argmin::core::Error> {
        let beyond: f64 = place.iter().map(|part| (part - part.clamp(0.0, 1.0)).abs()).sum();
        let mut found = self.found.lock().unwrap_or_else(|e| e.into_inner());
        let (tried, outcome) = self.desk.tried(self.search, place, &found.counting);
        let objective = tried.bound();
        self.desk.record(&mut found, tried);
        match outcome {
            Ok(()) => Ok(objective / self.unit * (1.0 + beyond)),
            Err(Error::Stopped) => Err(argmin::core::Error::msg(Error::Stopped.to_string())),
            Err(_) => Ok(UNSOLVED * (1.0 + beyond)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// A crown for a load in the middle, one beside it and a light one: one parameter, which can be
    /// tried all along.
    #[test]
    fn the_search_meets_the_best_crown_of_a_dense_line() {
        let text = "case = \"flush-short\"\nobjective = \"pressure\"\n[profile]\nkind = \"crown\"\n\
                    [bounds]\nradius_m = [0.2, 20.0]\n[[loads]]\nforce_n = 1e4\n\
                    [[loads]]\nforce_n = 1e4\neccentricity_m = 0.1e-3\n[[loads]]\nforce_n = 3e3\n";
        let design = Design::parse(text, Path::new("d.toml")).unwrap();
        let method = EdgeModel::QuarterSpace;
        let settings = Settings { method, tolerance: 5e-3, seed: 3, starts: 1 };
        let found = seek(&design, &settings, &|_, _| {}).unwrap();
        let desk = Desk {
            design: &design,
            settings: &settings,
            progress: &|_, _| {},
            solves: AtomicUsize::new(0),
        };
        let under_all = |part: f64| desk.tried(0, &[part], &[0, 1, 2]).0.bound();
        let line = (0..=40).map(|i| under_all(f64::from(i) / 40.0));
        let least = line.fold(f64::INFINITY, f64::min);
        assert!(found.searched_pa < 1.002 * least, "{} of {least}", found.searched_pa);
        let confirmed = found.confirmed_pa / found.searched_pa;
        assert!((confirmed - 1.0).abs() < 0.05, "{confirmed}");
        assert!(found.values[0] > 1.0 && found.values[0] < 19.9, "{:?}", found.values);
        let worst = found.scans[0].iter().map(|(_, objective)| *objective).fold(0.0, f64::max);
        assert!(worst > 1.01 * least, "{worst} of {least}");
        // The best trial is the best under all loads, of which most trials looked at few.
        let least_bound = found.history.iter().filter_map(|trial| trial.objective_pa);
        assert_eq!(least_bound.fold(f64::INFINITY, f64::min), found.searched_pa);
        let best =
            found.history.iter().find(|t| t.objective_pa == Some(found.searched_pa)).unwrap();
        let each = (0..3).map(|load| desk.peak_pa(&best.values, load).unwrap());
        assert_eq!(each.fold(0.0, f64::max), found.searched_pa);
        assert_eq!((best.loads, &best.values), (3, &found.values));
        let looked: usize = found.history.iter().map(|trial| trial.loads).sum();
        assert!(looked < 2 * found.history.len(), "{looked} of {}", found.history.len());
        // The same seed gives the same search.
        let again = seek(&design, &settings, &|_, _| {}).unwrap();
        assert_eq!(again.history, found.history);
    }
}
