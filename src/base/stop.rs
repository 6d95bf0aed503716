//! A calculation that may be stopped: by another thread, at the next of the places that ask.

use super::error::{Error, Result};
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

thread_local! {
    static ASKED: RefCell<Option<Arc<AtomicBool>>> = const { RefCell::new(None) };
}

/// Runs a calculation on this thread; it fails with [`Error::Stopped`] soon after `stop` is set.
pub fn stoppable<T>(stop: &Arc<AtomicBool>, calculation: impl FnOnce() -> T) -> T {
    /// Forgets the flag, after a panic too.
    struct Forget;
    impl Drop for Forget {
        fn drop(&mut self) {
            ASKED.set(None);
        }
    }
    ASKED.set(Some(stop.clone()));
    let _forget = Forget;
    calculation()
}

/// Whether the calculation on this thread is to go on; always outside of [`stoppable`].
///
/// # Errors
/// [`Error::Stopped`] once its flag is set.
pub fn go_on() -> Result<()> {
    let stopped = |flag: &Option<Arc<AtomicBool>>| {
        flag.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed))
    };
    if ASKED.with_borrow(stopped) { Err(Error::Stopped) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_calculation_goes_on_until_it_is_stopped() {
        let stop = Arc::new(AtomicBool::new(false));
        let calculation = || -> Result<()> {
            go_on()?;
            stop.store(true, Ordering::Relaxed);
            go_on()
        };
        assert!(matches!(stoppable(&stop, calculation), Err(Error::Stopped)));
        assert!(go_on().is_ok(), "what follows is not stopped");
    }
}
