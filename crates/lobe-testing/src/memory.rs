//! How much memory a piece of work takes.

use std::hint::black_box;

use peak_alloc::PeakAlloc;

/// Makes the program count the memory that it allocates: stands once at the root of a test or fuzz target.
#[macro_export]
macro_rules! count_memory {
    () => {
        #[global_allocator]
        static ALLOCATOR: $crate::PeakAlloc = $crate::PeakAlloc;
    };
}

/// The result of `work`, and the most memory it had at once beyond what there was before, in bytes. The allocations of
/// all threads count, so a program that measures has one test.
///
/// # Panics
/// If the program does not count: see [`count_memory`](crate::count_memory).
pub fn peak<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = PeakAlloc.current_usage();
    let counted = black_box(vec![0u8; 1 << 12]);
    assert!(PeakAlloc.current_usage() > before, "nothing counts: `lobe_testing::count_memory!()` is missing");
    drop(counted);
    PeakAlloc.reset_peak_usage();
    let before = PeakAlloc.current_usage();
    let result = work();
    (result, PeakAlloc.peak_usage().saturating_sub(before))
}
