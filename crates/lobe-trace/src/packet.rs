//! Rays and hits in lanes.

use lobe_lane::Lanes;

/// One ray per lane; see [`RaySoA`](crate::RaySoA) for what a ray is.
#[derive(Clone, Copy, Debug)]
pub struct Packet<L: Lanes> {
    /// Origins.
    pub origin: [L::F; 3],
    /// Directions.
    pub direction: [L::F; 3],
    /// The t at which the rays begin.
    pub t_min: L::F,
    /// The t at which the rays end.
    pub t_max: L::F,
}

/// The nearest hits of a packet; lanes outside `mask` hold a miss, as in [`HitSoA`](crate::HitSoA).
#[derive(Clone, Copy, Debug)]
pub struct PacketHits<L: Lanes> {
    /// The rays that hit something.
    pub mask: L::M,
    /// The position along the ray.
    pub t: L::F,
    /// Weight of the triangle's second vertex.
    pub u: L::F,
    /// Weight of the triangle's third vertex.
    pub v: L::F,
    /// The triangle's number in its mesh.
    pub primitive: L::I,
    /// The instance's number in the scene.
    pub instance: L::I,
}
