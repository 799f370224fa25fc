//! Code shared by the passes of all representations.
//!
//! A block of queries is evaluated in short passes over small arrays. One long kernel would be bound by latency: the
//! reorder buffer of a core holds a few hundred instructions, and the chain from a direction to a texel is longer than
//! that. Short passes over a block keep many independent queries in flight, with the same arithmetic.
//!
//! [`blocks`] runs work block by block, and [`pairs`] the evaluation of pairs of directions. The first passes compute
//! the coordinates of a representation (several share [`unit`](mod@unit) and [`half_vector`]); those of
//! [`grid`](crate::grid) follow.

pub(crate) mod block;
pub(crate) mod blocks;
pub(crate) mod half_vector;
pub(crate) mod pairs;
pub(crate) mod stokes;
pub(crate) mod unit;
