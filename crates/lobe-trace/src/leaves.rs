//! The contents of the leaves of a tree: triangles, or instances of trees of triangles.

use lobe_lane::Lanes;

use crate::block::{Block, Found};
use crate::bundles::Bundles;
use crate::bvh::Child;
use crate::hull::Hull;

/// The common properties of several rays.
#[derive(Clone, Copy)]
pub(crate) enum Around<'a, L: Lanes> {
    Nothing,
    /// Those of a group.
    Hull(&'a Hull<L>),
    /// Those of a block.
    Bundles(&'a Bundles),
}

/// The operations of a walk at a leaf. Hits go to `found` if they are nearer than earlier ones.
pub(crate) trait Leaves {
    /// Any hit is enough.
    fn any(&self) -> bool;

    /// Tests several rays of one octant that have reached the leaf: those of `live`, one bit each. Leaves out anything
    /// that, according to `around`, none of them can hit. Returns the rays that may have hit something.
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
