//! Generates the meshes on which materials are previewed, with the same bytes on any machine.
//!
//! Generating them takes a moment (the cloth is a simulation), so they are also kept as files, which
//! [`ply::read`](crate::ply::read) and [`Geometry::complete`] turn into the same meshes.

mod ball;
mod cloth;
mod drape;

use crate::Geometry;

pub use ball::ball;
pub use drape::{Drape, drape};

/// A trefoil: the (2, 3) torus knot. Its tube shows the light every side, and the viewer every direction of a brushed
/// or woven material. Centred at the origin, about 3 wide and 1.2 high.
pub fn knot() -> Geometry {
    crate::shapes::torus_knot(2, 3, 0.19, 400, 28)
}
