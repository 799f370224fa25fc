//! Shared by the commands of the workspace.
#![forbid(unsafe_code)]

mod figures;
mod grid;
mod machine;
pub mod noise;
mod steps;
pub mod svg;
mod write;

pub use figures::{nanoseconds, times};
pub use grid::Grid;
pub use machine::Machine;
pub use steps::Steps;
pub use write::replace;
