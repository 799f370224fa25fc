//! What the passes of all representations share.
//!
//! A block of queries is evaluated in short passes over small arrays. One long kernel would be bound by latency: the
//! reorder buffer of a core holds a few hundred instructions, and the chain from a direction to a texel is longer than
//! that. Short passes over a block keep many independent queries in flight, with the same arithmetic.
//!
//! [`blocks`] takes work through its blocks, and [`pairs`] the evaluation of pairs of directions. Passes begin with the
//! coordinates of a representation ([`unit`](mod@unit) and [`half_vector`] are those of several) and go on with those of
//! [`grid`](crate::grid).

pub(crate) mod block;
pub(crate) mod blocks;
pub(crate) mod half_vector;
pub(crate) mod pairs;
pub(crate) mod stokes;
pub(crate) mod unit;
