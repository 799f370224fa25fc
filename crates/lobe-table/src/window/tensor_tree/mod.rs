//! Tensor trees: a BSDF on an adaptive grid over two unit squares, or over one square and a radius.
//!
//! A direction becomes a point of the unit square by the concentric map of P. Shirley and K. Chiu ("A low distortion
//! map between disk and square", Journal of Graphics Tools 2(3), 1997) of its x and y. A tree of rank 4 is addressed by
//! the squares of the incident and of the exit direction; one of rank 3 is isotropic and has a radius in place of the
//! incident square. Every branch halves each dimension. Nothing is interpolated.
//!
//! Nodes and leaf values are in flat arrays, so a descent takes one gather per level. [`Table`](super::Table) evaluates
//! trees in SIMD lanes.

#[cfg(feature = "window")]
pub(crate) mod lanes;
mod reference;
#[cfg(test)]
mod tests;
mod tree;

pub use reference::square;
pub use tree::{KIND, MAX_DEPTH, Node, Rank, TensorTree, TreeError};
