//! The memory use of a piece of work.

use std::hint::black_box;

use peak_alloc::PeakAlloc;

/// Makes a program count the memory that it allocates. Invoke it once, at the root of a test or fuzz target.
#[macro_export]
macro_rules! count_memory {
    () => {
        #[global_allocator]
        static ALLOCATOR: $crate::PeakAlloc = $crate::PeakAlloc;
    };
}

/// The result of `work`, and its peak memory use beyond what was in use before, in bytes. Allocations of all threads
/// count, so a program that measures must have a single test.
///
/// # Panics
/// If the program does not count allocations; see [`count_memory`].
pub fn peak<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = PeakAlloc.current_usage();
    let counted = black_box(vec![0u8; 1 << 12]);
    assert!(
        PeakAlloc.current_usage() > before,
        "allocations are not counted: `lobe_testing::count_memory!()` is missing"
    );
    drop(counted);
    PeakAlloc.reset_peak_usage();
    let before = PeakAlloc.current_usage();
    let result = work();
    (result, PeakAlloc.peak_usage().saturating_sub(before))
}
