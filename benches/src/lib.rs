//! What the benchmarks and the report share: workloads, baselines and the clock.

pub mod baseline;
pub mod clock;
pub mod tables;
pub mod workload;
