//! The amount of available memory: a program that uses more is ended by the system, and cannot say why.

use std::fmt;

/// Something would take more memory than is available.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoRoom {
    /// The bytes that it would take.
    pub needed: u64,
    /// The bytes that are available.
    pub available: u64,
}

impl fmt::Display for NoRoom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of memory, of which {} are free", Bytes(self.needed), Bytes(self.available))
    }
}

impl std::error::Error for NoRoom {}

/// Formats bytes for people.
struct Bytes(u64);

impl fmt::Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 as f64 {
            bytes if bytes < 1e9 => write!(f, "{:.0} MB", bytes / 1e6),
            bytes => write!(f, "{:.1} GB", bytes / 1e9),
        }
    }
}

/// Checks that this many more bytes are available, as far as the system reports it.
///
/// # Errors
/// [`NoRoom`] says how many are available.
pub fn require(bytes: u64) -> Result<(), NoRoom> {
    // Small amounts are always tried, without asking the system.
    const LITTLE: u64 = 64 << 20;
    match available() {
        Some(available) if bytes > LITTLE && bytes > available => Err(NoRoom { needed: bytes, available }),
        _ => Ok(()),
    }
}

/// The bytes that this program can still take before the system refuses or ends it: the free memory of the machine,
/// within the limits of the address space and of the control group. `None` if the system does not report it, as on
/// systems other than Linux.
pub fn available() -> Option<u64> {
    let limits = [machine(), address_space(), control_group()];
    limits.into_iter().flatten().min()
}

fn machine() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    Some(kilobytes(&text, "MemAvailable:")? + kilobytes(&text, "SwapFree:").unwrap_or(0))
}

fn address_space() -> Option<u64> {
    let limits = std::fs::read_to_string("/proc/self/limits").ok()?;
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    // Fails for `unlimited`, which means no limit.
    let limit: u64 = line.split_whitespace().next()?.parse().ok()?;
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    Some(limit.saturating_sub(kilobytes(&status, "VmSize:")?))
}

/// Version 2 of control groups, whose root a container sees as its own.
fn control_group() -> Option<u64> {
    let groups = std::fs::read_to_string("/proc/self/cgroup").ok()?;
    let group = groups.lines().find_map(|line| line.strip_prefix("0::"))?.trim_matches('/').to_owned();
    let mut tightest = None;
    // The limits of all groups that contain it.
    let mut folder = std::path::Path::new("/sys/fs/cgroup").join(group);
    while folder.starts_with("/sys/fs/cgroup") {
        let read = |name: &str| std::fs::read_to_string(folder.join(name)).ok();
        let number = |name: &str| read(name)?.trim().parse::<u64>().ok();
        if let (Some(most), Some(used)) = (number("memory.max"), number("memory.current")) {
            // Cached file pages can be reclaimed.
            let stat = read("memory.stat").unwrap_or_default();
            let files = stat.lines().find_map(|line| line.strip_prefix("inactive_file ")?.parse().ok()).unwrap_or(0);
            let left = most.saturating_sub(used.saturating_sub(files));
            tightest = Some(tightest.map_or(left, |tightest: u64| tightest.min(left)));
        }
        if !folder.pop() {
            break;
        }
    }
    tightest
}

/// The number of kB of a line such as `MemAvailable:  123 kB`, in bytes.
fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.split_whitespace().next()?.parse::<u64>().ok()?.checked_mul(1024)
}

#[cfg(all(test, not(miri)))]
mod tests {
    use super::*;

    #[test]
    fn huge_amounts_are_refused_and_small_ones_are_not() {
        assert_eq!(require(1 << 20), Ok(()));
        if cfg!(target_os = "linux") {
            let error = require(1 << 60).unwrap_err();
            assert!(error.to_string().starts_with("1152921504.6 GB of memory, of which "), "{error}");
            assert!(error.available > 0);
        }
    }
}
