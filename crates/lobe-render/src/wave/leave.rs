//! Rays from surfaces into directions that are given in the frames of the material.

use lobe::{Backend, Kernel, Lanes};

use crate::columns::{Column, NOTHING, RAYS, hold, store, vector};
use crate::hit::Hits;
use crate::vec3::Vec3;

/// Where rays begin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Start {
    /// On the triangles.
    Surface,
    /// On the smooth surface that the triangles stand for, as shadow rays do.
    Lifted,
}

/// Rays from 64 surfaces.
#[derive(Clone, Debug)]
pub(super) struct Leaving {
    origin: [Column; 3],
    direction: [Column; 3],
    /// 1 where the ray is on the same side of the triangle and of the smooth surface, else 0.
    goes: Column,
}

impl Leaving {
    const NOTHING: Self = Leaving { origin: [NOTHING; 3], direction: [NOTHING; 3], goes: NOTHING };

    /// Whether a ray is on the same side of the triangle and of the smooth surface.
    pub fn goes(&self, at: usize) -> bool {
        self.goes[at] > 0.0
    }

    /// Origin and direction.
    pub fn ray(&self, at: usize) -> (Vec3, Vec3) {
        (vector(&self.origin, at), vector(&self.direction, at))
    }
}

/// The rays from hits into the directions `local`, of which there are as many as fill the lanes.
pub(super) fn leave(backend: Backend, hits: &Hits, start: Start, local: &[Vec3], out: &mut Vec<Leaving>) {
    hold(out, hits.len().div_ceil(RAYS), Leaving::NOTHING);
    backend.run(Leave { hits, start, local, out });
}

struct Leave<'a> {
    hits: &'a Hits,
    start: Start,
    local: &'a [Vec3],
    out: &'a mut [Leaving],
}

impl Kernel for Leave<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Leave { hits, start, local, out } = self;
        let (one, zero) = (lanes.splat(1.0), lanes.splat(0.0));
        let mut at = 0;
        while at < hits.len() {
            let (out, lane) = (&mut out[at / RAYS], at & (RAYS - L::LANES));
            let place = hits.places(lanes, at);
            let local = lanes.load_xyz(&local[at..]);
            let world = place.world(local);
            let origin = match start {
                Start::Surface => place.position,
                Start::Lifted => place.lifted,
            };
            store(lanes, &mut out.origin, lane, place.leave(lanes, origin, world));
            store(lanes, &mut out.direction, lane, world);
            lanes.store(&mut out.goes[lane..], lanes.select(place.sees(lanes, world, local), one, zero));
            at += L::LANES;
        }
    }
}
