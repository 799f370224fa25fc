//! A packet of coherent rays, one ray per lane.

use lobe_lane::{Floats, Lanes, MAX_LANES, Mask, call};

use super::{Single, Walk};
use crate::block::{first_ray, mask_of};
use crate::bvh::Child;
use crate::hull::Hull;
use crate::leaves::{Around, Leaves};
use crate::slab::{Sides, SlabRay};

/// A hybrid walk traces rays one by one if at most this many are live.
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
    let octant = rays.octant(at + live.trailing_zeros() as usize);
    let sides = Sides::of(octant);
    let never = lanes.splat(f32::INFINITY);
    let there = mask_of(lanes, live);
    let t_min = lanes.select(there, lanes.load(&rays.t_min[at..]), never);
    let mut hull = Hull::around(lanes, rays, at, octant, there);
    if let Some(hull) = &mut hull {
        hull.shorten(lanes, lanes.load(&found.t[at..]), there);
    }
    let nodes = bvh.all;
    let mut enters = [[0.0; MAX_LANES]; W];
    let mut order = [(0.0, 0); W];
    let mut waiting = 0;
    let mut child = Child::node(0);
    let mut bits = live;
    loop {
        if bits.count_ones() <= few {
            let walk = Walk { bvh, leaves: &mut *leaves, rays, found: &mut *found, stacks: &mut *stacks };
            call(lanes.narrow(), Single { walk, from: child, live: (bits as u64) << at });
        } else if child.is_leaf() {
            let around = match &hull {
                Some(hull) => Around::Hull(hull),
                None => Around::Nothing,
            };
            let hit = leaves.packet(lanes, child, rays, (bits as u64) << at, found, around);
            if let Some(hull) = &mut hull
                && hit != 0
            {
                hull.shorten(lanes, lanes.load(&found.t[at..]), there);
            }
        } else {
            let node = &nodes[child.index()];
            let best = lanes.load(&found.t[at..]);
            let mut hits = 0;
            // Rays are tested one by one only if their hull hits a child.
            let mut met = match &hull {
                Some(hull) => hull.children(lanes, node, &sides),
                None => (1 << W) - 1,
            };
            while met != 0 {
                let slot = met.trailing_zeros() as usize & (W - 1);
                met &= met - 1;
                let [near, far] = sides.child(lanes, node, slot);
                let [enter, leave] = slab.interval(lanes, near, far);
                let enter = enter.max(t_min);
                let meets = enter.le(leave.min(best));
                let bits = meets.bits();
                if bits != 0 {
                    lanes.store(&mut enters[slot], lanes.select(meets, enter, never));
                    // The first ray that hits it decides for all; the nearest child is pushed last.
                    let key = enters[slot][bits.trailing_zeros() as usize & (MAX_LANES - 1)];
                    let mut place = hits & (W - 1);
                    while place > 0 && order[place - 1].0 < key {
                        order[place] = order[place - 1];
                        place -= 1;
                    }
                    order[place] = (key, slot);
                    hits += 1;
                }
            }
            let mut place = 0;
            while place < hits {
                let slot = order[place & (W - 1)].1 & (W - 1);
                bvh.prefetch(lanes, node.child(slot));
                stacks.group[waiting] = node.child(slot);
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
