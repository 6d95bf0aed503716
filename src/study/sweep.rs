//! A run over thousands of cases. Similar cases are solved once. A case that fails has a row like
//! any other. The rows can be divided into shards, and a stopped run can be continued.

use super::groups::groups as scenes;
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::{Case, Sweep};
use crate::solve::{KeyResults, Scene, SceneKey, key_results};
use rayon::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// One part of a sweep that is divided into several.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Which one, from 1.
    pub index: usize,
    /// Of how many.
    pub count: usize,
}

impl std::str::FromStr for Shard {
    type Err = String;

    /// Reads `i/n`, with 1 <= i <= n.
    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let parsed = text.split_once('/').and_then(|(i, n)| {
            Some(Shard { index: i.trim().parse().ok()?, count: n.trim().parse().ok()? })
        });
        match parsed {
            Some(shard) if (1..=shard.count).contains(&shard.index) => Ok(shard),
            _ => Err("write i/n with i from 1 to n, for example 2/8".to_string()),
        }
    }
}

/// Where the cases of a sweep come from.
pub trait Cases: Sync {
    /// Number of rows.
    fn rows(&self) -> usize;

    /// The case of row `i`.
    ///
    /// # Errors
    /// What is wrong with the row.
    fn row(&self, i: usize) -> Result<Case>;
}

impl Cases for Sweep {
    fn rows(&self) -> usize {
        self.len()
    }

    fn row(&self, i: usize) -> Result<Case> {
        self.case(i)
    }
}

impl Cases for Vec<Case> {
    fn rows(&self) -> usize {
        self.len()
    }

    fn row(&self, i: usize) -> Result<Case> {
        Ok(self[i].clone())
    }
}

/// How a sweep is solved.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The edge model.
    pub method: EdgeModel,
    /// Tolerance of all rows in place of their own.
    pub tolerance: Option<f64>,
}

/// The outcome of a row: its case and key results, or the error in words.
pub type Outcome = std::result::Result<(Case, KeyResults), String>;

/// Rows that share one contact problem.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Their indices, ascending.
    pub rows: Vec<usize>,
}

/// The case of row `i` under `settings`.
fn case_of(sweep: &dyn Cases, i: usize, settings: &Settings) -> std::result::Result<Case, String> {
    let case = sweep.row(i).map_err(|e| e.to_string())?;
    Ok(match settings.tolerance {
        Some(tolerance) => case.with_tolerance(tolerance),
        None => case,
    })
}

/// The sweep's rows by contact problem, in the order of their first rows.
///
/// A shard has every n-th problem with all of its rows, so that no two shards solve the same
/// problem.
pub fn groups(sweep: &dyn Cases, settings: &Settings, shard: Option<Shard>) -> Vec<Group> {
    // A force that has to be found first is found for a row alone.
    let known = |case: &Case| case.load.approach_m.is_none();
    let key = |case: Case| known(&case).then(|| Scene::new(&case, settings.method, None).key());
    let keys: Vec<Option<SceneKey>> = (0..sweep.rows())
        .into_par_iter()
        .map(|i| case_of(sweep, i, settings).ok().and_then(key))
        .collect();
    let groups = scenes(keys).into_iter().map(|rows| Group { rows }).collect::<Vec<_>>();
    let Some(shard) = shard else { return groups };
    groups.into_iter().skip(shard.index - 1).step_by(shard.count).collect()
}

/// Solves `groups` on `jobs` threads. Each thread passes the outcome of a row to `done` as soon as
/// it is known. One thread solves one problem: with many problems no thread is idle.
///
/// # Errors
/// The first error of `done`, which also stops the run; or [`Error::Io`] when no thread can be
/// started.
pub fn run(
    sweep: &dyn Cases,
    settings: &Settings,
    groups: &[Group],
    jobs: usize,
    done: &(dyn Fn(usize, Outcome) -> Result<()> + Sync),
) -> Result<()> {
    let next = AtomicUsize::new(0);
    let stop = AtomicBool::new(false);
    let failed: Mutex<Option<Error>> = Mutex::new(None);
    let fail = |e: Error| {
        stop.store(true, Ordering::Relaxed);
        failed.lock().unwrap_or_else(|e| e.into_inner()).get_or_insert(e);
    };
    let work = || {
        // Parallel parts of a problem run on this thread alone.
        let pool = match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
            Ok(pool) => pool,
            Err(e) => {
                let source = std::io::Error::other(e);
                let path = "a thread".into();
                return fail(Error::Io { action: "start", path, source });
            }
        };
        pool.install(|| {
            while !stop.load(Ordering::Relaxed) {
                let i = next.fetch_add(1, Ordering::Relaxed);
                let Some(group) = groups.get(i) else { return };
                if let Err(e) = solve_rows(sweep, settings, &group.rows, done) {
                    return fail(e);
                }
            }
        });
    };
    std::thread::scope(|scope| {
        for _ in 0..jobs.clamp(1, groups.len().max(1)) {
            scope.spawn(work);
        }
    });
    failed.into_inner().unwrap_or_else(|e| e.into_inner()).map_or(Ok(()), Err)
}

/// Solves the rows of one problem.
fn solve_rows(
    sweep: &dyn Cases,
    settings: &Settings,
    rows: &[usize],
    done: &(dyn Fn(usize, Outcome) -> Result<()> + Sync),
) -> Result<()> {
    let mut cases = Vec::with_capacity(rows.len());
    let mut of = Vec::with_capacity(rows.len());
    for &row in rows {
        match case_of(sweep, row, settings) {
            Ok(case) => {
                cases.push(case);
                of.push(row);
            }
            Err(message) => done(row, Err(message))?,
        }
    }
    let mut handed = 0;
    let mut fault = Ok(());
    // A panic in one case must not end the run: it becomes the error of that case.
    let solved = catch_unwind(AssertUnwindSafe(|| {
        key_results(&cases, settings.method, |i, results| {
            if fault.is_ok() {
                handed = i + 1;
                // A force that was found becomes the case's.
                let case = cases[i].clone().with_force(results.load_n);
                fault = done(of[i], Ok((case, results)));
            }
        })
    }));
    fault?;
    let message = match solved {
        Ok(Ok(())) => return Ok(()),
        Ok(Err(e)) => e.to_string(),
        Err(_) => "the program failed at this case; please report it".to_string(),
    };
    of[handed..].iter().try_for_each(|&row| done(row, Err(message.clone())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn sweep(text: &str) -> Sweep {
        let text = format!(
            "[roller]\nradius_m = 10e-3\nyoung_pa = 210e9\npoisson = 0.3\n\
             [block]\nyoung_pa = 210e9\npoisson = 0.3\n{text}"
        );
        Sweep::parse(&text, Path::new("s.toml")).unwrap()
    }

    const SETTINGS: Settings = Settings { method: EdgeModel::QuarterSpace, tolerance: Some(1e-2) };

    #[test]
    fn similar_rows_are_one_problem_and_bad_ones_stand_alone() {
        let sweep = sweep("[dimensionless]\nW = [1e-4, 1e-3]\nS_l = [5, 6]\nL_r = [1.0, 2e3]\n");
        let rows: Vec<Vec<usize>> =
            groups(&sweep, &SETTINGS, None).into_iter().map(|g| g.rows).collect();
        assert_eq!(rows, [vec![0, 4], vec![1], vec![2, 6], vec![3], vec![5], vec![7]]);
        let shards: Vec<usize> = (1..=3)
            .flat_map(|index| groups(&sweep, &SETTINGS, Some(Shard { index, count: 3 })))
            .flat_map(|g| g.rows)
            .collect();
        let mut sorted = shards.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..8).collect::<Vec<_>>());
        assert_eq!(shards[..3], [0, 4, 3]);
    }

    #[test]
    fn rows_of_one_problem_differ_by_their_scale() {
        let sweep = sweep("[dimensionless]\nW = [1e-4, 4e-4, 9.0]\nS_l = 5\nL_r = 1.0\n");
        let found: Mutex<Vec<(usize, Outcome)>> = Mutex::new(Vec::new());
        let groups = groups(&sweep, &SETTINGS, None);
        run(&sweep, &SETTINGS, &groups, 2, &|row, outcome| {
            found.lock().unwrap().push((row, outcome));
            Ok(())
        })
        .unwrap();
        let mut found = found.into_inner().unwrap();
        found.sort_by_key(|f| f.0);
        let of = |i: usize| &found[i].1.as_ref().unwrap().1;
        // p0 grows with the root of W, and so does everything that is proportional to it.
        let p_centre_pa = |i: usize| of(i).p_centre * of(i).hertz.p0_pa;
        let critical_y_m = |i: usize| of(i).critical.at[1] * of(i).hertz.c_m;
        assert!((p_centre_pa(1) / p_centre_pa(0) - 2.0).abs() < 1e-9);
        assert!((critical_y_m(1) / critical_y_m(0) - 2.0).abs() < 1e-9);
        assert!(found[2].1.as_ref().unwrap_err().contains("dimensionless.W = 9e0"));
    }

    #[test]
    fn an_output_that_fails_stops_the_run() {
        let sweep = sweep("[dimensionless]\nW = 1e-4\nS_l = 5\nL_r = [1.1, 1.2, 1.3]\n");
        let calls = AtomicUsize::new(0);
        let refuse = |_: usize, _: Outcome| {
            calls.fetch_add(1, Ordering::Relaxed);
            let source = std::io::Error::other("full");
            Err(Error::Io { action: "write", path: "there".into(), source })
        };
        let groups = groups(&sweep, &SETTINGS, None);
        let said = run(&sweep, &SETTINGS, &groups, 1, &refuse).unwrap_err().to_string();
        assert!(said.contains("full"), "{said}");
        assert_eq!(calls.load(Ordering::Relaxed), 1);
    }

    #[test]
    fn shards_are_counted_from_one() {
        assert_eq!("2/8".parse(), Ok(Shard { index: 2, count: 8 }));
        for bad in ["0/8", "9/8", "2", "2/0", "a/b", "/", "-1/3"] {
            assert!(bad.parse::<Shard>().is_err(), "{bad}");
        }
    }
}
