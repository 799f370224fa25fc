//! One ray against all boxes of a node, a child a lane.

use lobe_lane::{Floats, Lanes, MAX_LANES};

use super::stack::Entry;
use super::{Walk, prefetch};
use crate::block::RAYS;
use crate::bvh::{Child, Node};
use crate::leaves::Leaves;
use crate::slab::{Sides, SlabRay, child_bits};

#[inline(always)]
pub(super) fn walk<L: Lanes, V: Leaves, const W: usize>(lanes: L, walk: Walk<'_, V, W>, from: Child, ray: usize) {
    let Walk { bvh, leaves, rays, found, stacks } = walk;
    let ray = ray & (RAYS - 1);
    let slab = SlabRay::single(lanes, rays, ray);
    let sides = Sides::of(rays.octant(ray));
    let t_min = lanes.splat(rays.t_min[ray]);
    let nodes = bvh.nodes.as_slice();
    let stack = stacks.single.as_mut_slice();
    let ready = leaves.ready(lanes, rays, ray);
    let mut best = found.t[ray];
    let mut waiting = 0;
    let mut child = from;
    loop {
        if child.is_leaf() {
            leaves.single(lanes, child, rays, ray, ready, found);
            best = found.t[ray];
        } else {
            let node = &nodes[child.index()];
            let mut enters = [t_min; W];
            let mut bits = 0;
            let mut slot = 0;
            while slot < W {
                let [near, far] = sides.children(lanes, node, slot);
                let [enter, leave] = slab.interval(lanes, near, far);
                enters[slot / L::LANES] = enter.max(t_min);
                bits |= child_bits::<L, W>(enters[slot / L::LANES].le(leave.min(lanes.splat(best))), slot);
                slot += L::LANES;
            }
            // Most often one child is met, or none.
            if bits.is_power_of_two() {
                child = node.children[bits.trailing_zeros() as usize & (W - 1)];
                continue;
            }
            if bits != 0 {
                let mut keys = [0.0; MAX_LANES];
                let mut slot = 0;
                while slot < W {
                    lanes.store(&mut keys[slot..], enters[slot / L::LANES]);
                    slot += L::LANES;
                }
                // The nearer of the first two; the others wait, sorted in among themselves, the nearest on top.
                let one = entry(node, &keys, bits);
                bits &= bits - 1;
                let other = entry(node, &keys, bits);
                bits &= bits - 1;
                let (near, far) = if other.key < one.key { (other, one) } else { (one, other) };
                prefetch(lanes, nodes, leaves, far.child);
                let floor = waiting;
                stack[waiting] = far;
                waiting += 1;
                if bits == 0 {
                    child = near.child;
                    continue;
                }
                stack[waiting] = near;
                waiting += 1;
                while bits != 0 {
                    let entry = entry(node, &keys, bits);
                    bits &= bits - 1;
                    prefetch(lanes, nodes, leaves, entry.child);
                    let mut place = waiting;
                    while place > floor && stack[place - 1].key < entry.key {
                        stack[place] = stack[place - 1];
                        place -= 1;
                    }
                    stack[place] = entry;
                    waiting += 1;
                }
                waiting -= 1;
                child = stack[waiting].child;
                continue;
            }
        }
        // A child that begins exactly at the best hit may still hold one that wins the tie.
        loop {
            if waiting == 0 {
                return;
            }
            waiting -= 1;
            if stack[waiting].key <= best {
                child = stack[waiting].child;
                break;
            }
        }
    }
}

/// The first child of `bits`.
#[inline(always)]
fn entry<const W: usize>(node: &Node<W>, keys: &[f32; MAX_LANES], bits: u32) -> Entry {
    let slot = bits.trailing_zeros() as usize & (W - 1);
    Entry { key: keys[slot], child: node.children[slot] }
}
