//! Shared by the benchmarks and the report: workloads, baselines, contests, and the clock.

pub mod baseline;
pub mod clock;
pub mod contest;
pub mod tables;
#[cfg(feature = "tracing")]
pub mod tracing;
pub mod workload;
