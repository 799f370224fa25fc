//! Generates rays from surfaces in directions given in the frames of their materials.

use lobe::{Backend, Kernel, Lanes};

use super::rays::Ray;
use crate::columns::{Column, RAYS, ZEROS, ensure_len, store, vector};
use crate::interaction::Interactions;
use crate::vec3::Vec3;

/// The origins of rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Origin {
    /// On the triangles.
    Surface,
    /// On the smooth surface that the triangles approximate, as for shadow rays.
    Lifted,
}

/// Rays from 64 surfaces.
#[derive(Clone, Debug)]
pub(crate) struct SpawnedRays {
    origin: [Column; 3],
    direction: [Column; 3],
    /// 1 if the ray is on the same side of the triangle and of the smooth surface, otherwise 0.
    goes: Column,
}

impl SpawnedRays {
    const ZEROS: Self = SpawnedRays { origin: [ZEROS; 3], direction: [ZEROS; 3], goes: ZEROS };

    /// `true` if a ray is on the same side of the triangle and of the smooth surface.
    pub fn goes(&self, at: usize) -> bool {
        self.goes[at] > 0.0
    }

    /// Origin and direction.
    pub fn ray(&self, at: usize) -> Ray {
        Ray { origin: vector(&self.origin, at), direction: vector(&self.direction, at) }
    }
}

/// The rays from hits in the directions `local`, which must fill the lanes.
pub(crate) fn spawn_rays(
    backend: Backend,
    hits: &Interactions,
    from: Origin,
    local: &[Vec3],
    out: &mut Vec<SpawnedRays>,
) {
    ensure_len(out, hits.len().div_ceil(RAYS), SpawnedRays::ZEROS);
    backend.run(SpawnRays { hits, from, local, out });
}

struct SpawnRays<'a> {
    hits: &'a Interactions,
    from: Origin,
    local: &'a [Vec3],
    out: &'a mut [SpawnedRays],
}

impl Kernel for SpawnRays<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let SpawnRays { hits, from, local, out } = self;
        let (one, zero) = (lanes.splat(1.0), lanes.splat(0.0));
        let mut at = 0;
        while at < hits.len() {
            let (out, lane) = (&mut out[at / RAYS], at & (RAYS - L::LANES));
            let surface = hits.load(lanes, at);
            let local = lanes.load_xyz(&local[at..]);
            let world = surface.world(local);
            let origin = match from {
                Origin::Surface => surface.position,
                Origin::Lifted => surface.lifted,
            };
            store(lanes, &mut out.origin, lane, surface.offset_origin(lanes, origin, world));
            store(lanes, &mut out.direction, lane, world);
            lanes.store(&mut out.goes[lane..], lanes.select(surface.same_side(lanes, world, local), one, zero));
            at += L::LANES;
        }
    }
}
