//! The scenes that materials are previewed on, the same bytes on any machine.
//!
//! They are large enough to take a moment (the cloth is a simulation), so they are also kept as files, which
//! [`ply::read`](crate::ply::read) and [`Geometry::complete`] turn into the same meshes.

mod ball;
mod cloth;
mod drape;

use crate::Geometry;

pub use ball::ball;
pub use drape::{Drape, drape};

/// A trefoil: the (2, 3) torus knot, whose tube turns every side to the light and every direction of a brushed or woven
/// material to the viewer. Centred at the origin, about 3 wide and 1.2 high.
pub fn knot() -> Geometry {
    crate::shapes::torus_knot(2, 3, 0.19, 400, 28)
}
