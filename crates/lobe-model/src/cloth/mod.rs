//! A simulated woven cloth, measured by tracing light through its threads.
//!
//! Tables of cloth were computed from a model of the threads before they were measured: V. Volevich, A. Khodulev,
//! E. Kopylov and O. Karpenko, *An approach to cloth synthesis and visualization*, GraphiCon 1997. This is the same
//! idea with today's means. A [`Weave`] says where each yarn is on top, and how high; a [`Yarn`] says how its fibres
//! reflect. The two form a periodic height field of triangles, and [`Cloth`] follows light through it, from yarn to
//! yarn, until it leaves.
//!
//! Lengths are in units of the distance between neighbouring yarns. The warp runs along y, the weft along x.

mod height_field;
mod light;
mod weave;
mod yarn;

pub use light::Cloth;
pub use weave::{Ply, Weave};
pub use yarn::Yarn;
