//! A check before large requests: those that need more memory than is free are refused.

use crate::base::{Error, Result};
use std::path::{Path, PathBuf};

/// Free memory if the system does not report it (bytes).
const UNKNOWN: u64 = 4 << 30;

/// Free memory (bytes): what the system reports as available, or the rest of the control group's
/// limit if that is less.
fn free_memory() -> u64 {
    let text = |path: &Path| std::fs::read_to_string(path).unwrap_or_default();
    let system = available(&text(Path::new("/proc/meminfo"))).unwrap_or(UNKNOWN);
    // The process's own group and all above it.
    let own = own_group(&text(Path::new("/proc/self/cgroup")));
    let groups = own.ancestors().map(|group| Path::new("/sys/fs/cgroup").join(group));
    let left = groups.filter_map(|group| {
        let of = |name: &str| text(&group.join(name));
        left_in_group(&of("memory.max"), &of("memory.current"), &of("memory.stat"))
    });
    left.fold(system, u64::min)
}

/// The path of the process's control group below the root of all, from the text of
/// `/proc/self/cgroup`.
fn own_group(cgroup: &str) -> PathBuf {
    let path = cgroup.lines().find_map(|line| line.strip_prefix("0::/")).unwrap_or("");
    PathBuf::from(path.trim_end())
}

/// What a control group's limit leaves (bytes), from the texts of its files; `None` without a
/// limit. The kernel gives up files that nobody has used lately before it refuses memory.
fn left_in_group(limit: &str, current: &str, stat: &str) -> Option<u64> {
    let limit: u64 = limit.trim().parse().ok()?;
    let used: u64 = current.trim().parse().unwrap_or(0);
    let idle = stat.lines().find_map(|line| line.strip_prefix("inactive_file "));
    let idle: u64 = idle.and_then(|bytes| bytes.trim().parse().ok()).unwrap_or(0);
    Some(limit.saturating_sub(used.saturating_sub(idle)))
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
    fn a_groups_limit_leaves_what_is_not_in_use() {
        assert_eq!(own_group("1:cpu:/x\n0::/jobs/7\n"), Path::new("jobs/7"));
        assert_eq!(own_group("0::/\n"), Path::new(""));
        let stat = "anon 5\ninactive_file 300\nactive_file 20\n";
        assert_eq!(left_in_group("1000\n", "900\n", stat), Some(400));
        assert_eq!(left_in_group("1000\n", "", ""), Some(1000));
        assert_eq!(left_in_group("1000\n", "2000\n", ""), Some(0));
        assert_eq!(left_in_group("max\n", "900\n", stat), None);
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
