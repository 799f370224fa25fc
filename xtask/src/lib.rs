//! The workspace's own commands, as a library so that the tests run the same checks.
#![forbid(unsafe_code)]

pub mod asm;
pub mod fixtures;
pub mod gallery;
pub mod golden;
mod noise;
#[cfg(target_os = "linux")]
pub mod peers;
pub mod report;
mod steps;
pub mod sweep;

pub use xtask_equivalence as equivalence;
