//! Keeps all contestants on one core, and measures processor time.

use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};
use rustix::time::{ClockId, clock_gettime};

/// Keeps this thread, and the threads and processes that inherit from it, on the last core that it may use. Returns
/// this core, or `None` if the system refuses.
pub fn pin() -> Option<usize> {
    let allowed = sched_getaffinity(None).ok()?;
    let core = (0..CpuSet::MAX_CPU).rev().find(|&core| allowed.is_set(core))?;
    let mut one = CpuSet::new();
    one.set(core);
    sched_setaffinity(None, &one).ok()?;
    Some(core)
}

/// Seconds for which this process has run on a processor.
///
/// Unlike a wall clock, this does not count the time of other programs on the core, so long runs can be timed on a
/// machine that is not idle.
pub fn seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}
