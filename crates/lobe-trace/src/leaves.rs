//! What stands in the leaves of a tree: triangles, or instances of trees of triangles.

use lobe_lane::Lanes;

use crate::block::{Block, Found};
use crate::bundles::Bundles;
use crate::bvh::Child;
use crate::hull::Hull;

/// What is known of several rays at once.
#[derive(Clone, Copy)]
pub(crate) enum Around<'a, L: Lanes> {
    Nothing,
    /// Of a group.
    Hull(&'a Hull<L>),
    /// Of a block.
    Bundles(&'a Bundles),
}

/// What a walk calls when it comes to a leaf. Hits go to `found` if they are nearer than what stands there.
pub(crate) trait Leaves {
    /// Any hit is enough.
    fn any(&self) -> bool;

    /// Several rays of one octant have met the leaf: those of `live`, one bit each. What `around` tells that none of them
    /// meets is left out. Returns which rays may have been hit.
    fn packet<L: Lanes>(
        &mut self,
        lanes: L,
        leaf: Child,
        rays: &Block,
        live: u64,
        found: &mut Found,
        around: Around<'_, L>,
    ) -> u64;

    /// One ray has met the leaf.
    fn single<L: Lanes>(&mut self, lanes: L, leaf: Child, rays: &Block, ray: usize, found: &mut Found);
}
