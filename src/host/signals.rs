//! Requests to stop (Ctrl-C, SIGTERM, SIGHUP). While a child runs they are noted, and the child is
//! ended first; otherwise they have their default effect. The signal at the limit of a file's size
//! (SIGXFSZ) is left to the write that meets the limit.

use crate::base::{Error, Result};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
use signal_hook::flag;
use std::fs;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock, Mutex};

/// The state for the signal handlers.
struct Watch {
    /// The signal that arrived while a child ran; 0 if none did.
    interrupt: Arc<AtomicUsize>,
    /// Whether no child runs, so that a signal ends this process at once.
    idle: Arc<AtomicBool>,
    /// Number of running children.
    children: Mutex<usize>,
}

static WATCH: LazyLock<Watch> = LazyLock::new(|| {
    let watch = Watch {
        interrupt: Arc::new(AtomicUsize::new(0)),
        idle: Arc::new(AtomicBool::new(true)),
        children: Mutex::new(0),
    };
    for signal in [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|&s| !is_ignored(s)) {
        // The system refuses handlers only for signals that do not exist.
        let _ = flag::register_conditional_default(signal, watch.idle.clone());
        let _ = flag::register_usize(signal, watch.interrupt.clone(), signal as usize);
    }
    watch
});

/// Makes a write beyond the largest size of a file (`ulimit -f`) fail with an error as any other,
/// where the signal would end the process without a message. Children have the signal's default
/// effect.
pub(crate) fn let_large_files_fail() {
    // What the flag says is known from the error of the write.
    let _ = flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)));
}

/// Whether `signal` is ignored on purpose (nohup).
fn is_ignored(signal: i32) -> bool {
    fs::read_to_string("/proc/self/status").is_ok_and(|status| ignored(&status, signal))
}

/// [`is_ignored`] by the text of `/proc/self/status`, whose mask has signal 1 in its lowest bit.
fn ignored(status: &str, signal: i32) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let bits = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    bits.is_some_and(|bits| bits >> (signal - 1) & 1 == 1)
}

/// While a value of this type exists, requests to stop are noted for [`check_interrupt`].
pub(super) struct Active;

impl Active {
    pub(super) fn new() -> Self {
        Self::count(|children| children + 1);
        Self
    }

    fn count(change: impl Fn(usize) -> usize) {
        let mut children = WATCH.children.lock().unwrap_or_else(|e| e.into_inner());
        *children = change(*children);
        WATCH.idle.store(*children == 0, Ordering::SeqCst);
    }
}

impl Drop for Active {
    fn drop(&mut self) {
        Self::count(|children| children - 1);
    }
}

/// Checks for a request to stop that arrived while a child ran.
///
/// # Errors
/// [`Error::Interrupted`] if there was one.
pub(crate) fn check_interrupt() -> Result<()> {
    match WATCH.interrupt.load(Ordering::SeqCst) {
        0 => Ok(()),
        signal => Err(Error::Interrupted { signal: signal as i32 }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ignored_signals_are_read_from_the_status() {
        // The mask of a process started by nohup.
        let status = "Name:\tedgeline\nSigBlk:\t0000000000000000\nSigIgn:\t0000000000001001\n";
        assert!(ignored(status, SIGHUP));
        assert!(!ignored(status, SIGINT) && !ignored(status, SIGTERM));
        assert!(!ignored("", SIGHUP) && !ignored("SigIgn:\tno mask\n", SIGHUP));
    }
}
