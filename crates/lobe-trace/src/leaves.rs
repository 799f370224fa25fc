//! What the leaves of a tree hold: triangles, or instances of trees of triangles.

use lobe_lane::Lanes;

use crate::block::{Block, Found};
use crate::bundles::Bundles;
use crate::bvh::Child;
use crate::hull::Hull;

/// What several rays have in common.
#[derive(Clone, Copy)]
pub(crate) enum Around<'a, L: Lanes> {
    Nothing,
    /// Of a group.
    Hull(&'a Hull<L>),
    /// Of a block.
    Bundles(&'a Bundles),
}

/// What a walk calls at a leaf. Hits go to `found` if they are nearer than those already there.
pub(crate) trait Leaves {
    /// Any hit is enough.
    fn any(&self) -> bool;

    /// Tests several rays of one octant that have reached the leaf: those of `live`, one bit each. Whatever `around`
    /// shows that none of them can hit is left out. Returns which rays may have hit something.
    fn packet<L: Lanes>(
        &mut self,
        lanes: L,
        leaf: Child,
        rays: &Block,
        live: u64,
        found: &mut Found,
        around: Around<'_, L>,
    ) -> u64;

    /// Tests one ray that has reached the leaf.
    fn single<L: Lanes>(&mut self, lanes: L, leaf: Child, rays: &Block, ray: usize, found: &mut Found);
}
