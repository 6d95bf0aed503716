//! Repeated timing of the semi-analytical solve.
//!
//! A time has a meaning only with its conditions. A solve in a separate process (`cold`, which
//! builds every table) is distinguished from repeats in one process (`warm`), and one thread from
//! all. The result is the median, with the quartiles as spread: a busy machine makes single runs
//! slower, never faster, so a mean would be biased.

use super::factorial::median;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// Times of repeated runs of one piece of work.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// Threads that the work could use.
    pub threads: usize,
    /// Seconds of the work in a separate process without its start and files, where measured.
    pub cold_s: Option<f64>,
    /// Median of the repeats (s).
    pub median_s: f64,
    /// First and third quartile of the repeats (s); the extremes of fewer than four repeats, for
    /// which quartiles mean little.
    pub quartiles_s: [f64; 2],
    /// Number of repeats.
    pub repeats: usize,
}

impl Timing {
    /// From the times of at least one run (s).
    pub fn new(threads: usize, seconds: &[f64]) -> Self {
        let mut sorted = seconds.to_vec();
        sorted.sort_by(f64::total_cmp);
        let tail = if sorted.len() < 4 { 0.0 } else { 0.25 };
        Self {
            threads,
            cold_s: None,
            median_s: median(sorted.clone()),
            quartiles_s: [quantile(&sorted, tail), quantile(&sorted, 1.0 - tail)],
            repeats: sorted.len(),
        }
    }

    /// Median and spread (s), as [`Ratio::new`] takes them.
    pub fn with_spread(&self) -> (f64, f64) {
        (self.median_s, self.spread_s())
    }

    /// Half the distance of the quartiles (s): the median's +-.
    pub fn spread_s(&self) -> f64 {
        0.5 * (self.quartiles_s[1] - self.quartiles_s[0])
    }
}

/// Linear interpolation between the order statistics of a sorted list that is not empty.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * (sorted.len() - 1) as f64;
    let low = place.floor() as usize;
    let high = (low + 1).min(sorted.len() - 1);
    sorted[low] + (place - low as f64) * (sorted[high] - sorted[low])
}

/// Repeats of one measurement stop after this time in total (s): slow work needs fewer repeats for
/// the same accuracy, and a study measures many pieces of work.
const BUDGET_S: f64 = 0.5;

/// Runs `work` once without timing, which builds the tables, and then up to `repeats` times, at
/// least once, on `threads` threads (0: all of the machine).
///
/// # Errors
/// The first error of `work`: failed work has no time.
pub fn measure<T: Send, E: Send>(
    threads: usize,
    repeats: usize,
    work: impl Fn() -> Result<T, E> + Sync + Send,
) -> Result<Timing, E> {
    let timed = || {
        let start = Instant::now();
        work().map(|result| {
            let seconds = start.elapsed().as_secs_f64();
            // Freeing the result is not part of computing it.
            drop(result);
            seconds
        })
    };
    let all = || -> Result<Timing, E> {
        timed()?;
        let mut warm = vec![timed()?];
        // One run alone would have no spread.
        while warm.len() < repeats && (warm.len() < 2 || warm.iter().sum::<f64>() < BUDGET_S) {
            warm.push(timed()?);
        }
        Ok(Timing::new(rayon::current_num_threads(), &warm))
    };
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(all),
        // Without new threads the work runs on this one.
        Err(_) => all(),
    }
}

/// Ratio of two medians with the uncertainty that their spreads give it (first order).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Ratio {
    /// slow / fast.
    pub value: f64,
    /// Its +-.
    pub plus_minus: f64,
}

impl Ratio {
    /// `slow` and `fast` are pairs of median and spread (s), measured on one machine in one run.
    pub fn new(slow: (f64, f64), fast: (f64, f64)) -> Self {
        let value = slow.0 / fast.0;
        Self { value, plus_minus: value * (slow.1 / slow.0).hypot(fast.1 / fast.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_and_quartiles() {
        let timing = Timing::new(1, &[5.0, 1.0, 3.0, 2.0, 4.0]);
        assert_eq!((timing.median_s, timing.quartiles_s), (3.0, [2.0, 4.0]));
        assert_eq!((timing.with_spread(), timing.repeats), ((3.0, 1.0), 5));
        // Two runs say no more than how far they are apart.
        assert_eq!(Timing::new(1, &[5.0, 4.0]).with_spread(), (4.5, 0.5));
    }

    #[test]
    fn ratio_carries_both_uncertainties() {
        let ratio = Ratio::new((100.0, 3.0), (0.01, 0.0004));
        assert!((ratio.value - 1e4).abs() < 1e-9);
        assert!((ratio.plus_minus - 500.0).abs() < 1e-9);
    }

    #[test]
    fn the_first_run_does_not_count_and_errors_stop_the_timing() {
        let calls = std::sync::atomic::AtomicUsize::new(0);
        let count = || calls.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let timing = measure(1, 3, || Ok::<_, ()>(count())).unwrap();
        assert_eq!((timing.threads, timing.repeats), (1, 3));
        assert_eq!(count(), 4);
        assert_eq!(measure(1, 3, || Err::<(), _>("no")), Err("no"));
        let slow = || {
            std::thread::sleep(std::time::Duration::from_millis(300));
            Ok::<_, ()>(())
        };
        assert_eq!(measure(1, 50, slow).unwrap().repeats, 2);
        let slower = || {
            std::thread::sleep(std::time::Duration::from_millis(600));
            Ok::<_, ()>(())
        };
        assert_eq!(measure(1, 50, slower).unwrap().repeats, 2);
    }
}
