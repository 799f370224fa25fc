//! A packet of coherent rays, a ray a lane.

use lobe_lane::{Floats, Lanes, MAX_LANES, Mask};

use super::{Single, Walk, enter};
use crate::block::{first_ray, mask_of};
use crate::bvh::Child;
use crate::leaves::Leaves;
use crate::slab::{Sides, SlabRay};

/// From how few live rays on a hybrid traces them one by one.
pub(super) const FEW: u32 = 2;

#[inline(always)]
pub(super) fn walk<L: Lanes, V: Leaves, const W: usize>(
    lanes: L,
    walk: Walk<'_, V, W>,
    at: usize,
    live: u32,
    few: u32,
) {
    let Walk { bvh, leaves, rays, found, stacks } = walk;
    let at = first_ray::<L>(at);
    let slab = SlabRay::group(lanes, rays, at);
    let sides = Sides::of(rays.octant(at + live.trailing_zeros() as usize));
    let never = lanes.splat(f32::INFINITY);
    let t_min = lanes.select(mask_of(lanes, live), lanes.load(&rays.t_min[at..]), never);
    let nodes = bvh.nodes.as_slice();
    let mut enters = [[0.0; MAX_LANES]; W];
    let mut order = [(0.0, 0); W];
    let mut waiting = 0;
    let mut child = Child::node(0);
    let mut bits = live;
    loop {
        if bits.count_ones() <= few {
            let walk = Walk { bvh, leaves: &mut *leaves, rays, found: &mut *found, stacks: &mut *stacks };
            enter(lanes, Single { walk, from: child, live: (bits as u64) << at });
        } else if child.is_leaf() {
            leaves.packet(lanes, child, rays, (bits as u64) << at, found, None);
        } else {
            let node = &nodes[child.index()];
            let best = lanes.load(&found.t[at..]);
            let mut hits = 0;
            let mut slot = 0;
            while slot < W {
                let [near, far] = sides.child(lanes, node, slot);
                let [enter, leave] = slab.interval(lanes, near, far);
                let enter = enter.max(t_min);
                let meets = enter.le(leave.min(best));
                let bits = meets.bits();
                if bits != 0 {
                    lanes.store(&mut enters[slot], lanes.select(meets, enter, never));
                    // The first ray that meets it speaks for all; the nearest comes last.
                    let key = enters[slot][bits.trailing_zeros() as usize & (MAX_LANES - 1)];
                    let mut place = hits & (W - 1);
                    while place > 0 && order[place - 1].0 < key {
                        order[place] = order[place - 1];
                        place -= 1;
                    }
                    order[place] = (key, slot);
                    hits += 1;
                }
                slot += 1;
            }
            let mut place = 0;
            while place < hits {
                let slot = order[place & (W - 1)].1 & (W - 1);
                stacks.group[waiting] = node.children[slot];
                lanes.store(&mut stacks.enter[waiting], lanes.load(&enters[slot]));
                waiting += 1;
                place += 1;
            }
        }
        let best = lanes.load(&found.t[at..]);
        loop {
            if waiting == 0 {
                return;
            }
            waiting -= 1;
            let live = lanes.load(&stacks.enter[waiting]).le(best);
            if live.any() {
                bits = live.bits();
                child = stacks.group[waiting];
                break;
            }
        }
    }
}
