//! Where work is done: without the interpreter's lock, and with no panic getting out.

use crate::errors::Error;
use edgeline::base::stop::stoppable;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How long a signal, such as that of Ctrl-C, may have to wait.
pub const PATIENCE: Duration = Duration::from_millis(100);

/// Calls that are at work.
static AT_WORK: AtomicUsize = AtomicUsize::new(0);

/// The threads of one process, by its number.
static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

/// All threads of this process. A forked process has none of its parent's threads, only what
/// looks like them: waiting for those would never end.
fn threads() -> Option<Arc<ThreadPool>> {
    let mut known = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    if let Some((own, pool)) = &*known
        && *own == process
    {
        return Some(pool.clone());
    }
    let pool = Arc::new(ThreadPoolBuilder::new().build().ok()?);
    if let Some((_, of_parent)) = known.replace((process, pool.clone())) {
        // Ending threads that are not there would never end either.
        std::mem::forget(of_parent);
    }
    Some(pool)
}

/// Counts a call as at work while it lives.
struct AtWork;

impl AtWork {
    /// This call, and whether another one was at work before.
    fn begin() -> (Self, bool) {
        (Self, AT_WORK.fetch_add(1, Ordering::Relaxed) > 0)
    }
}

impl Drop for AtWork {
    fn drop(&mut self) {
        AT_WORK.fetch_sub(1, Ordering::Relaxed);
    }
}

/// The exception that a panic becomes.
pub fn panicked() -> PyErr {
    Error::new_err("the program failed at this case; please report it")
}

/// Does `work` without the interpreter's lock; it learns whether another call is at work.
///
/// # Errors
/// [`Error`] where `work` panics.
pub fn guarded<T: Send>(py: Python<'_>, work: impl FnOnce(bool) -> T + Send) -> PyResult<T> {
    py.detach(|| {
        let (_at_work, beside) = AtWork::begin();
        catch_unwind(AssertUnwindSafe(|| work(beside)))
    })
    .map_err(|_| panicked())
}

/// As [`guarded`]. One call has all processors; a call beside another one has a thread of its own,
/// so that calls of several Python threads do not wait for each other's parts. In a forked process
/// the count of calls is that of its parent's threads, of which none goes on.
///
/// # Errors
/// As [`guarded`].
pub fn work<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    guarded(py, |beside| {
        let one = || ThreadPoolBuilder::new().num_threads(1).build().ok().map(Arc::new);
        match if beside { one() } else { threads() } {
            Some(pool) => pool.install(work),
            // Where no thread is to be had, this one is left.
            None => work(),
        }
    })
}

/// As [`work`], beside this thread, which listens to signals: one whose handler raises, such as
/// that of Ctrl-C, stops the work where it asks for that.
///
/// # Errors
/// As [`guarded`], and what a signal's handler raises.
pub fn heard<T: Send>(py: Python<'_>, todo: impl FnOnce() -> T + Send) -> PyResult<T> {
    let stop = Arc::new(AtomicBool::new(false));
    let (done, wait) = channel::<()>();
    py.detach(move || {
        std::thread::scope(|scope| {
            let working = scope.spawn(|| {
                let _done = done;
                Python::attach(|py| work(py, || stoppable(&stop, todo)))
            });
            let mut raised = Ok(());
            // Its end is told by the sender's.
            while wait.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                if raised.is_ok() {
                    raised = Python::attach(|py| py.check_signals());
                    stop.store(raised.is_err(), Ordering::Relaxed);
                }
            }
            let found = working.join().map_err(|_| panicked())?;
            raised.and(found)
        })
    })
}

/// Panics where a solve would; for the tests.
#[pyfunction]
pub fn fail(py: Python<'_>) -> PyResult<()> {
    work(py, || panic!("as the tests asked for"))
}
