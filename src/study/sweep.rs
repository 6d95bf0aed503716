//! A run over any number of cases, of which a block is in memory at a time. Similar cases are
//! solved once. A case that fails has a row like any other. The rows can be divided into shards,
//! and a stopped run can be continued.

use super::groups::groups as scenes;
use crate::base::{Error, Result};
use crate::body::EdgeModel;
use crate::case::{Case, Sweep};
use crate::solve::{KeyResults, KeySolution, Scene, SceneKey};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::collections::hash_map::{DefaultHasher, Entry, HashMap};
use std::hash::{Hash, Hasher};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};

/// Rows in memory at a time.
const BLOCK: usize = 8192;

/// Memory of the solutions that later blocks may need again (bytes).
const KEPT_BYTES: usize = 256 << 20;

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
    /// What the input says of a row.
    type Cells: Send + Sync;

    /// The rows in their order.
    ///
    /// # Errors
    /// When the input cannot be read.
    fn rows(&self) -> Result<impl Iterator<Item = Result<Self::Cells>>>;

    /// The case of row `i`.
    ///
    /// # Errors
    /// What is wrong with the row.
    fn row(&self, i: usize, cells: &Self::Cells) -> Result<Case>;
}

impl Cases for Sweep {
    type Cells = Vec<String>;

    fn rows(&self) -> Result<impl Iterator<Item = Result<Vec<String>>>> {
        Sweep::rows(self)
    }

    fn row(&self, i: usize, cells: &Vec<String>) -> Result<Case> {
        self.case(i, cells)
    }
}

impl Cases for Vec<Case> {
    type Cells = ();

    fn rows(&self) -> Result<impl Iterator<Item = Result<()>>> {
        Ok(self.iter().map(|_| Ok(())))
    }

    fn row(&self, i: usize, _: &()) -> Result<Case> {
        Sweep::check_smooth(&self[i])?;
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

/// Where the rows of a sweep go to, in their order.
pub trait Rows<Cells>: Send {
    /// Whether the row is there from an earlier run.
    ///
    /// # Errors
    /// When something else is there in its place.
    fn has(&mut self, row: usize, cells: &Cells) -> Result<bool>;

    /// Compares the row that was just found there with its `outcome` of this run.
    ///
    /// # Errors
    /// When they are not the same: rows of another run must not stand beside those of this one.
    fn check(&mut self, _row: usize, _outcome: &Outcome) -> Result<()> {
        Ok(())
    }

    /// Adds a row.
    ///
    /// # Errors
    /// When it cannot be written, which ends the run.
    fn add(&mut self, row: usize, cells: &Cells, outcome: &Outcome) -> Result<()>;
}

/// How much a run has done.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Done {
    /// Rows of the part of the sweep.
    pub rows: usize,
    /// Contact problems solved.
    pub problems: usize,
}

/// A row of a block.
struct Row<Cells> {
    index: usize,
    cells: Cells,
    case: std::result::Result<Case, String>,
    /// The contact problem that it shares with others.
    key: Option<SceneKey>,
}

/// Chooses the rows of a shard: every n-th problem with all of its rows, so that no two shards
/// solve the same problem.
struct Selection {
    shard: Option<Shard>,
    /// The places of the problems, in the order of their first rows, by the hash of their keys.
    places: HashMap<u64, usize>,
    problems: usize,
}

impl Selection {
    fn new(shard: Option<Shard>) -> Self {
        Self { shard, places: HashMap::new(), problems: 0 }
    }

    fn takes(&mut self, key: Option<&SceneKey>) -> bool {
        let Some(shard) = self.shard else { return true };
        let mut next = || {
            self.problems += 1;
            self.problems - 1
        };
        let place = match key {
            None => next(),
            Some(key) => {
                let mut hasher = DefaultHasher::new();
                key.hash(&mut hasher);
                match self.places.entry(hasher.finish()) {
                    Entry::Occupied(place) => *place.get(),
                    Entry::Vacant(place) => *place.insert(next()),
                }
            }
        };
        place % shard.count == shard.index - 1
    }
}

/// The rows of `cases` in blocks, those of the shard alone.
///
/// # Errors
/// An iterator's item is the error of the input.
fn blocks<C: Cases>(
    cases: &C,
    settings: &Settings,
    shard: Option<Shard>,
) -> Result<impl Iterator<Item = Result<Vec<Row<C::Cells>>>>> {
    let mut rows = cases.rows()?.enumerate();
    let mut selection = Selection::new(shard);
    let row = |(index, cells): (usize, C::Cells)| {
        let case = case_of(cases, index, &cells, settings);
        let key = case.as_ref().ok().and_then(|case| key_of(case, settings));
        Row { index, cells, case, key }
    };
    Ok(std::iter::from_fn(move || {
        let read: Result<Vec<_>> =
            rows.by_ref().take(BLOCK).map(|(i, cells)| Ok((i, cells?))).collect();
        let mut block: Vec<Row<C::Cells>> = match read {
            Ok(read) if read.is_empty() => return None,
            Ok(read) => read.into_par_iter().map(row).collect(),
            Err(e) => return Some(Err(e)),
        };
        block.retain(|row| selection.takes(row.key.as_ref()));
        Some(Ok(block))
    }))
}

/// The case of row `i` under `settings`.
fn case_of<C: Cases>(
    cases: &C,
    i: usize,
    cells: &C::Cells,
    settings: &Settings,
) -> std::result::Result<Case, String> {
    let case = cases.row(i, cells).map_err(|e| e.to_string())?;
    Ok(match settings.tolerance {
        Some(tolerance) => case.with_tolerance(tolerance),
        None => case,
    })
}

/// The contact problem of a case. A force that has to be found first is found for a row alone.
fn key_of(case: &Case, settings: &Settings) -> Option<SceneKey> {
    let known = case.load.approach_m.is_none();
    known.then(|| Scene::new(case, settings.method, None).key())
}

/// Number of rows of a shard.
///
/// # Errors
/// That of the input.
pub fn count<C: Cases>(cases: &C, settings: &Settings, shard: Option<Shard>) -> Result<usize> {
    blocks(cases, settings, shard)?.map(|block| Ok(block?.len())).sum()
}

/// Solves the rows of a shard on `jobs` threads and hands them to `rows` in their order, each as
/// soon as it and all before it are known. The first row that is there from an earlier run is
/// solved again and compared. One thread solves one problem: with many problems no thread is idle.
/// Memory does not grow with the number of rows: a block of them is read at a time, and solutions
/// are kept for later blocks up to a limit.
///
/// # Errors
/// The first error of the input or of `rows`, which also stops the run; or [`Error::Io`] when no
/// thread can be started.
pub fn run<C: Cases>(
    cases: &C,
    settings: &Settings,
    shard: Option<Shard>,
    jobs: usize,
    rows: &mut dyn Rows<C::Cells>,
) -> Result<Done> {
    let mut done = Done::default();
    let known = Known::default();
    let mut compared = false;
    for block in blocks(cases, settings, shard)? {
        let mut todo = block?;
        done.rows += todo.len();
        let mut kept = 0;
        while let Some(row) = todo.get(kept)
            && rows.has(row.index, &row.cells)?
        {
            // The values that rows share, a base's for example, are none of their cells.
            if !compared {
                let outcome = known.outcome(row, settings.method, &mut None);
                compared = outcome.is_ok();
                if compared {
                    rows.check(row.index, &outcome)?;
                }
            }
            kept += 1;
        }
        todo.drain(..kept);
        solve_block(settings, jobs, &todo, &known, rows)?;
    }
    done.problems = known.solved.into_inner();
    Ok(done)
}

/// A solution, or why there is none.
type Shared = std::result::Result<Arc<KeySolution>, String>;

/// The solutions so far, those of the first problems up to [`KEPT_BYTES`].
#[derive(Default)]
struct Known {
    solutions: Mutex<HashMap<SceneKey, Shared>>,
    bytes: AtomicUsize,
    /// Number of contact problems solved.
    solved: AtomicUsize,
}

impl Known {
    fn solutions(&self) -> MutexGuard<'_, HashMap<SceneKey, Shared>> {
        self.solutions.lock().unwrap_or_else(|e| e.into_inner())
    }

    fn keep(&self, key: &SceneKey, solution: &Shared) {
        let bytes = size_of::<SceneKey>()
            + match solution {
                Ok(solution) => solution.bytes(),
                Err(message) => message.len(),
            };
        if self.bytes.fetch_add(bytes, Ordering::Relaxed) + bytes <= KEPT_BYTES {
            self.solutions().insert(key.clone(), solution.clone());
        }
    }

    /// The solution that all rows of `key` share, among which `case` is.
    fn shared(&self, key: &SceneKey, case: &Case, method: EdgeModel) -> Shared {
        let found = self.solutions().get(key).cloned();
        found.unwrap_or_else(|| {
            let solution = self.solve(case, method).map(|(_, solution)| Arc::new(solution));
            self.keep(key, &solution);
            solution
        })
    }

    /// The outcome of a row. `shared` is the solution of its problem, once a row of it was solved.
    fn outcome<Cells>(
        &self,
        row: &Row<Cells>,
        method: EdgeModel,
        shared: &mut Option<Shared>,
    ) -> Outcome {
        let case = row.case.clone()?;
        let Some(key) = &row.key else { return self.alone(&case, method) };
        let solution = shared.get_or_insert_with(|| self.shared(key, &case, method)).clone()?;
        if !solution.serves(&case) {
            return self.alone(&case, method);
        }
        let results = solution.of(&case);
        Ok((case, results))
    }

    /// The outcome of a row with a solution of its own.
    fn alone(&self, case: &Case, method: EdgeModel) -> Outcome {
        let (case, solution) = self.solve(case, method)?;
        let results = solution.of(&case);
        Ok((case, results))
    }

    /// The solution of a contact, and the case with its force. A panic in one case must not end the
    /// run: it becomes the error of that case.
    fn solve(
        &self,
        case: &Case,
        method: EdgeModel,
    ) -> std::result::Result<(Case, KeySolution), String> {
        self.solved.fetch_add(1, Ordering::Relaxed);
        let solved = catch_unwind(AssertUnwindSafe(|| KeySolution::new(case, method)));
        match solved {
            Ok(solved) => solved.map_err(|e| e.to_string()),
            Err(_) => Err("the program failed at this case; please report it".to_string()),
        }
    }
}

/// Hands the outcomes of a block to its rows' place in their order.
struct InOrder<'a, Cells> {
    block: &'a [Row<Cells>],
    rows: &'a mut dyn Rows<Cells>,
    /// The next one to be handed on.
    next: usize,
    /// Those that wait for an earlier one.
    waiting: BTreeMap<usize, Outcome>,
}

impl<Cells> InOrder<'_, Cells> {
    /// Takes the outcome of the row at the place `at` of the block.
    fn add(&mut self, at: usize, outcome: Outcome) -> Result<()> {
        self.waiting.insert(at, outcome);
        while let Some(outcome) = self.waiting.remove(&self.next) {
            let row = &self.block[self.next];
            self.rows.add(row.index, &row.cells, &outcome)?;
            self.next += 1;
        }
        Ok(())
    }
}

/// Solves the rows of a block.
fn solve_block<Cells: Send + Sync>(
    settings: &Settings,
    jobs: usize,
    block: &[Row<Cells>],
    known: &Known,
    rows: &mut dyn Rows<Cells>,
) -> Result<()> {
    let groups = scenes(block.iter().map(|row| row.key.clone()));
    let found = Mutex::new(InOrder { block, rows, next: 0, waiting: BTreeMap::new() });
    let add = |at: usize, outcome: Outcome| {
        found.lock().unwrap_or_else(|e| e.into_inner()).add(at, outcome)
    };
    let solve = |group: &Vec<usize>| solve_rows(settings.method, block, group, known, &add);
    side_by_side(&groups, jobs, &solve)
}

/// Solves the rows of one problem, which are at the places `group` of the block.
fn solve_rows<Cells>(
    method: EdgeModel,
    block: &[Row<Cells>],
    group: &[usize],
    known: &Known,
    add: &impl Fn(usize, Outcome) -> Result<()>,
) -> Result<()> {
    let mut shared = None;
    for &at in group {
        add(at, known.outcome(&block[at], method, &mut shared))?;
    }
    Ok(())
}

/// Does `work` for all `groups` on `jobs` threads.
fn side_by_side(
    groups: &[Vec<usize>],
    jobs: usize,
    work: &(impl Fn(&Vec<usize>) -> Result<()> + Sync),
) -> Result<()> {
    let next = AtomicUsize::new(0);
    let stop = AtomicBool::new(false);
    let failed: Mutex<Option<Error>> = Mutex::new(None);
    let fail = |e: Error| {
        stop.store(true, Ordering::Relaxed);
        failed.lock().unwrap_or_else(|e| e.into_inner()).get_or_insert(e);
    };
    let thread = || {
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
                if let Err(e) = work(group) {
                    return fail(e);
                }
            }
        });
    };
    std::thread::scope(|scope| {
        for _ in 0..jobs.min(groups.len()).max(1) {
            scope.spawn(thread);
        }
    });
    failed.into_inner().unwrap_or_else(|e| e.into_inner()).map_or(Ok(()), Err)
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

    /// The rows in memory; the first `there` of them are from an earlier run.
    #[derive(Default)]
    struct Kept {
        there: usize,
        rows: Vec<(usize, Outcome)>,
    }

    impl<Cells> Rows<Cells> for Kept {
        fn has(&mut self, row: usize, _: &Cells) -> Result<bool> {
            Ok(row < self.there)
        }

        fn add(&mut self, row: usize, _: &Cells, outcome: &Outcome) -> Result<()> {
            self.rows.push((row, outcome.clone()));
            Ok(())
        }
    }

    fn rows_of(sweep: &Sweep, shard: Option<Shard>) -> Vec<usize> {
        let blocks = blocks(sweep, &SETTINGS, shard).unwrap();
        blocks.flat_map(|block| block.unwrap()).map(|row| row.index).collect()
    }

    #[test]
    fn similar_rows_are_one_problem_and_bad_ones_stand_alone() {
        let sweep = sweep("[dimensionless]\nW = [1e-4, 1e-3]\nS_l = [5, 6]\nL_r = [1.0, 2e3]\n");
        let block = blocks(&sweep, &SETTINGS, None).unwrap().next().unwrap().unwrap();
        let groups = scenes(block.into_iter().map(|row| row.key));
        assert_eq!(groups, [vec![0, 4], vec![1], vec![2, 6], vec![3], vec![5], vec![7]]);
        let shards = [1, 2, 3].map(|index| rows_of(&sweep, Some(Shard { index, count: 3 })));
        assert_eq!(shards, [vec![0, 3, 4], vec![1, 5], vec![2, 6, 7]]);
        let second = Some(Shard { index: 2, count: 3 });
        assert_eq!(count(&sweep, &SETTINGS, second).unwrap(), 2);
    }

    #[test]
    fn rows_of_one_problem_differ_by_their_scale() {
        let sweep = sweep("[dimensionless]\nW = [1e-4, 4e-4, 9.0]\nS_l = 5\nL_r = 1.0\n");
        let mut found = Kept::default();
        let done = run(&sweep, &SETTINGS, None, 2, &mut found).unwrap();
        assert_eq!(done, Done { rows: 3, problems: 1 });
        let of = |i: usize| &found.rows[i].1.as_ref().unwrap().1;
        // p0 grows with the root of W, and so does everything that is proportional to it.
        let p_centre_pa = |i: usize| of(i).p_centre * of(i).hertz.p0_pa;
        let critical_y_m = |i: usize| of(i).critical.at[1] * of(i).hertz.c_m;
        assert!((p_centre_pa(1) / p_centre_pa(0) - 2.0).abs() < 1e-9);
        assert!((critical_y_m(1) / critical_y_m(0) - 2.0).abs() < 1e-9);
        assert!(found.rows[2].1.as_ref().unwrap_err().contains("dimensionless.W = 9 "));
    }

    #[test]
    fn blocks_share_solutions_and_are_read_one_at_a_time() {
        let sweep = sweep(&format!(
            "[dimensionless]\nW = {{ from = 1e-4, to = 1e-3, count = {} }}\nS_l = 5\nL_r = [0.9, 1.0]\n",
            BLOCK + 100
        ));
        assert!(sweep.len() > 2 * BLOCK);
        let read = AtomicUsize::new(0);
        let counted = Counted { sweep: &sweep, read: &read };
        /// Counts the rows that are read.
        struct Counted<'a> {
            sweep: &'a Sweep,
            read: &'a AtomicUsize,
        }
        impl Cases for Counted<'_> {
            type Cells = Vec<String>;
            fn rows(&self) -> Result<impl Iterator<Item = Result<Vec<String>>>> {
                let count = |row| {
                    self.read.fetch_add(1, Ordering::Relaxed);
                    row
                };
                Ok(self.sweep.rows()?.map(count))
            }
            fn row(&self, i: usize, cells: &Vec<String>) -> Result<Case> {
                self.sweep.case(i, cells)
            }
        }
        /// Checks that rows come in their order, and never more than a block behind those that are
        /// read.
        struct Watched<'a> {
            next: usize,
            read: &'a AtomicUsize,
        }
        impl Rows<Vec<String>> for Watched<'_> {
            fn has(&mut self, row: usize, _: &Vec<String>) -> Result<bool> {
                self.next += usize::from(row < 10);
                Ok(row < 10)
            }
            fn add(&mut self, row: usize, _: &Vec<String>, outcome: &Outcome) -> Result<()> {
                assert!(outcome.is_ok() && row == self.next);
                assert!(self.read.load(Ordering::Relaxed) <= row + BLOCK);
                self.next += 1;
                Ok(())
            }
        }
        let mut watched = Watched { next: 0, read: &read };
        let done = run(&counted, &SETTINGS, None, 2, &mut watched).unwrap();
        assert_eq!((done, watched.next), (Done { rows: sweep.len(), problems: 2 }, sweep.len()));
    }

    #[test]
    fn a_rough_case_of_a_list_is_not_solved_as_the_smooth_one_beside_it() {
        let smooth = crate::case::builtin_case("flush-short").unwrap().unwrap();
        let surface = crate::case::Surface {
            heights: "h.npy".into(),
            dx_m: 1e-6,
            dy_m: 1e-6,
            detrend: None,
            samples: None,
        };
        let cases = vec![smooth.clone(), Case { surface: Some(surface), ..smooth }];
        let mut kept = Kept::default();
        run(&cases, &SETTINGS, None, 1, &mut kept).unwrap();
        let [(0, Ok(_)), (1, Err(said))] = &kept.rows[..] else { panic!("{:?}", kept.rows) };
        assert!(said.contains("surface.heights") && said.contains("are smooth"), "{said}");
    }

    #[test]
    fn solutions_are_kept_up_to_a_limit() {
        let sweep = sweep("[dimensionless]\nW = [1e-4, 1e-3]\nS_l = 5\nL_r = 1.0\n");
        let block = blocks(&sweep, &SETTINGS, None).unwrap().next().unwrap().unwrap();
        let (case, key) = (block[0].case.as_ref().unwrap(), block[0].key.as_ref().unwrap());
        let known = Known::default();
        let solution = known.shared(key, case, SETTINGS.method);
        let bytes = known.bytes.load(Ordering::Relaxed);
        assert!((1_000..40_000).contains(&bytes), "{bytes} bytes");
        assert!(Arc::ptr_eq(
            &solution.unwrap(),
            &known.shared(key, case, SETTINGS.method).unwrap()
        ));
        let full = Known { bytes: AtomicUsize::new(KEPT_BYTES), ..Known::default() };
        full.shared(key, case, SETTINGS.method).unwrap();
        assert!(full.solutions().is_empty());
    }

    #[test]
    fn an_output_that_fails_stops_the_run() {
        struct Refusing(usize);
        impl Rows<Vec<String>> for Refusing {
            fn has(&mut self, _: usize, _: &Vec<String>) -> Result<bool> {
                Ok(false)
            }
            fn add(&mut self, _: usize, _: &Vec<String>, _: &Outcome) -> Result<()> {
                self.0 += 1;
                let source = std::io::Error::other("full");
                Err(Error::Io { action: "write", path: "there".into(), source })
            }
        }
        let sweep = sweep("[dimensionless]\nW = 1e-4\nS_l = 5\nL_r = [1.1, 1.2, 1.3]\n");
        let mut rows = Refusing(0);
        let said = run(&sweep, &SETTINGS, None, 1, &mut rows).unwrap_err().to_string();
        assert!(said.contains("full"), "{said}");
        assert_eq!(rows.0, 1);
    }

    #[test]
    fn shards_are_counted_from_one() {
        assert_eq!("2/8".parse(), Ok(Shard { index: 2, count: 8 }));
        for bad in ["0/8", "9/8", "2", "2/0", "a/b", "/", "-1/3"] {
            assert!(bad.parse::<Shard>().is_err(), "{bad}");
        }
    }
}
