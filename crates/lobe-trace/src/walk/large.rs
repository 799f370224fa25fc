//! A packet of 64 coherent rays.
//!
//! All children of a node are tested at once against the interval of the rays, a child a lane. A child that survives is
//! entered by the groups from the first one on that meets its box: most often the first that is tried.

use lobe_lane::{Floats, Lanes, MAX_LANES, Mask};

use super::stack::LargeEntry;
use super::{Walk, prefetch};
use crate::block::{Block, Found, RAYS, first_ray};
use crate::bvh::Node;
use crate::leaves::{Bounded, Leaves};
use crate::slab::{Beam, Sides, SlabRay, child_bits, least_lane};

#[inline(always)]
pub(super) fn walk<L: Lanes, V: Leaves, const W: usize>(lanes: L, walk: Walk<'_, V, W>, live: u64) {
    let Walk { bvh, leaves, rays, found, stacks } = walk;
    let octant = rays.octant(live.trailing_zeros() as usize);
    let sides = Sides::of(octant);
    let beam = Beam::around(lanes, rays, octant);
    let nodes = bvh.nodes.as_slice();
    let stack = stacks.large.as_mut_slice();
    let mut keys = [0.0; MAX_LANES];
    let mut farthest = farthest_best(lanes, found);
    let mut waiting = 0;
    let mut current = 0;
    let mut first = 0;
    loop {
        let node = &nodes[current];
        let best = lanes.splat(farthest);
        let mut bits = 0;
        let mut slot = 0;
        while slot < W {
            let [near, far] = sides.children(lanes, node, slot);
            let [enter, leave] = beam.interval(lanes, near, far);
            bits |= child_bits::<L, W>(enter.le(leave.min(best)), slot);
            lanes.store(&mut keys[slot..], enter);
            slot += L::LANES;
        }
        let floor = waiting;
        while bits != 0 {
            let slot = bits.trailing_zeros() as usize & (W - 1);
            bits &= bits - 1;
            let entry = LargeEntry { key: keys[slot], node: current as u32, slot: slot as u32, first };
            prefetch(lanes, nodes, leaves, node.children[slot]);
            let mut place = waiting;
            while place > floor && stack[place - 1].key < entry.key {
                stack[place] = stack[place - 1];
                place -= 1;
            }
            stack[place] = entry;
            waiting += 1;
        }
        loop {
            if waiting == 0 {
                return;
            }
            waiting -= 1;
            let entry = stack[waiting];
            if entry.key > farthest {
                continue;
            }
            let node = &nodes[entry.node as usize];
            let slot = entry.slot as usize & (W - 1);
            let child = node.children[slot];
            let mut at = entry.first as usize;
            let mut meets = 0;
            while at < RAYS {
                meets = group_meets(lanes, &sides, node, slot, rays, found, at);
                if meets != 0 {
                    break;
                }
                at += L::LANES;
            }
            if meets == 0 {
                continue;
            }
            if !child.is_leaf() {
                current = child.index();
                first = at as u32;
                break;
            }
            let mut live = (meets as u64) << at;
            at += L::LANES;
            while at < RAYS {
                live |= (group_meets(lanes, &sides, node, slot, rays, found, at) as u64) << at;
                at += L::LANES;
            }
            leaves.packet(lanes, child, rays, live, found, Some(Bounded { beam: &beam, end: farthest }));
            farthest = farthest_best(lanes, found);
        }
    }
}

/// The bits of those rays of a group that meet a child before their best hit.
#[inline(always)]
fn group_meets<L: Lanes, const W: usize>(
    lanes: L,
    sides: &Sides,
    node: &Node<W>,
    slot: usize,
    rays: &Block,
    found: &Found,
    at: usize,
) -> u32 {
    let at = first_ray::<L>(at);
    let [near, far] = sides.child(lanes, node, slot);
    let [enter, leave] = SlabRay::group(lanes, rays, at).interval(lanes, near, far);
    let enter = enter.max(lanes.load(&rays.t_min[at..]));
    enter.le(leave.min(lanes.load(&found.t[at..]))).bits()
}

/// Where the last of the rays ends as things stand.
#[inline(always)]
fn farthest_best<L: Lanes>(lanes: L, found: &Found) -> f32 {
    let mut most = lanes.load(&found.t);
    let mut at = L::LANES;
    while at < RAYS {
        most = most.max(lanes.load(&found.t[at & (RAYS - L::LANES)..]));
        at += L::LANES;
    }
    -least_lane(lanes, -most)
}
