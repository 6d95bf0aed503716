//! A check before large requests: those that need more memory than is free are refused.

use crate::base::{Error, Result};

/// Free memory if the system does not report it (bytes).
const UNKNOWN: u64 = 4 << 30;

/// Free memory (bytes): what the system reports as available, or the rest of the control group's
/// limit if that is less.
fn free_memory() -> u64 {
    let text = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
    let bytes = |path: &str| text(path).trim().parse::<u64>().ok();
    let system = available(&text("/proc/meminfo")).unwrap_or(UNKNOWN);
    let group = bytes("/sys/fs/cgroup/memory.max").map_or(u64::MAX, |limit| {
        limit.saturating_sub(bytes("/sys/fs/cgroup/memory.current").unwrap_or(0))
    });
    system.min(group)
}

/// Available bytes from the text of `/proc/meminfo`.
fn available(meminfo: &str) -> Option<u64> {
    let rest = meminfo.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    rest.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// Refuses `what` if its estimated `bytes` are not free; `remedy` says what to do instead.
///
/// # Errors
/// [`Error::Memory`] with the estimate.
pub fn check_memory(what: &str, bytes: f64, remedy: &str) -> Result<()> {
    let free = free_memory();
    if bytes <= free as f64 {
        return Ok(());
    }
    const GIB: f64 = (1u64 << 30) as f64;
    Err(Error::Memory {
        what: what.to_string(),
        needed_gib: bytes / GIB,
        free_gib: free as f64 / GIB,
        remedy: remedy.to_string(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_available_is_read_from_the_system() {
        assert_eq!(available("MemTotal: 9 kB\nMemAvailable:    2048 kB\n"), Some(2 << 20));
        for text in ["", "MemAvailable: x kB", "MemAvailable: 5 MB"] {
            assert_eq!(available(text), None, "{text}");
        }
        assert!(free_memory() > 1 << 20, "a test runs in some memory");
    }

    #[test]
    fn too_much_is_refused_with_the_estimate() {
        check_memory("a little", 1024.0, "").unwrap();
        let said = check_memory("a field", 2.5e18, "ask for less").unwrap_err().to_string();
        assert!(said.starts_with("a field takes about 2.3e9 GiB of memory, but only "), "{said}");
        assert!(said.ends_with(" GiB are free; ask for less"), "{said}");
        assert!(check_memory("not a number", f64::NAN, "").is_err());
    }
}
