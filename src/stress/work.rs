//! Counts of kernel evaluations.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// Kernel evaluations for stresses: those done, and those saved compared with a sum of all sources
/// over all wavenumbers.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Work {
    /// Evaluations done.
    pub done: u64,
    /// Saved: sources beyond the reach of a wave.
    pub beyond_reach: u64,
    /// Saved: end faces beyond the reach of a wavenumber from the contact.
    pub ends: u64,
    /// Saved: wavenumbers after a run of negligible ones.
    pub faded: u64,
}

impl std::iter::Sum for Work {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |sum, w| Self {
            done: sum.done + w.done,
            beyond_reach: sum.beyond_reach + w.beyond_reach,
            ends: sum.ends + w.ends,
            faded: sum.faded + w.faded,
        })
    }
}

/// [`Work`] shared by several threads.
#[derive(Debug, Default)]
pub(super) struct Counters {
    done: AtomicU64,
    beyond_reach: AtomicU64,
    ends: AtomicU64,
    faded: AtomicU64,
}

impl Counters {
    pub fn add(&self, work: &Work) {
        self.done.fetch_add(work.done, Relaxed);
        self.beyond_reach.fetch_add(work.beyond_reach, Relaxed);
        self.ends.fetch_add(work.ends, Relaxed);
        self.faded.fetch_add(work.faded, Relaxed);
    }

    /// The evaluations so far.
    pub fn work(&self) -> Work {
        let Self { done, beyond_reach, ends, faded } = self;
        let [done, beyond_reach, ends, faded] =
            [done, beyond_reach, ends, faded].map(|count| count.load(Relaxed));
        Work { done, beyond_reach, ends, faded }
    }
}
