//! One ray against all boxes of a node, a child a lane.

use lobe_lane::{Floats, Ints, Lanes, MAX_LANES};

use super::Walk;
use super::stack::Entry;
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
    let nodes = bvh.all;
    let stack = stacks.single.as_mut_slice();
    let ready = leaves.ready(lanes, rays, ray);
    let mut best = found.t[ray];
    let mut keys = [0; MAX_LANES];
    let mut waiting = 0;
    let mut child = from;
    loop {
        if child.is_leaf() {
            leaves.single(lanes, child, rays, ray, ready, found);
            best = found.t[ray];
        } else {
            let node = &nodes[child.index()];
            let mut bits = 0;
            let mut slot = 0;
            while slot < W {
                let [near, far] = sides.children(lanes, node, slot);
                let [enter, leave] = slab.interval(lanes, near, far);
                let enter = enter.max(t_min);
                bits |= child_bits::<L, W>(enter.le(leave.min(lanes.splat(best))), slot);
                lanes.store_int(&mut keys[slot..], ordered(lanes, enter));
                slot += L::LANES;
            }
            // Most often one child is met, or none.
            if bits.is_power_of_two() {
                child = node.child(bits.trailing_zeros() as usize);
                continue;
            }
            if bits != 0 {
                // The nearest is next; the others wait, the nearest of them on top. Which of two is nearer cannot be
                // foreseen, so entries are sorted without branches.
                let one = entry(node, &keys, bits);
                bits &= bits - 1;
                let other = entry(node, &keys, bits);
                bits &= bits - 1;
                let (mut next, far) = (one.min(other), one.max(other));
                bvh.prefetch(lanes, far.child());
                let floor = waiting;
                stack[waiting] = far;
                waiting += 1;
                while bits != 0 {
                    let other = entry(node, &keys, bits);
                    bits &= bits - 1;
                    bvh.prefetch(lanes, other.child());
                    let mut far = next.max(other);
                    next = next.min(other);
                    let mut place = floor;
                    while place < waiting {
                        let below = stack[place];
                        stack[place] = below.max(far);
                        far = below.min(far);
                        place += 1;
                    }
                    stack[waiting] = far;
                    waiting += 1;
                }
                child = next.child();
                continue;
            }
        }
        // A child that begins exactly at the best hit may still hold one that wins the tie.
        let end = Entry::until(best);
        loop {
            if waiting == 0 {
                return;
            }
            waiting -= 1;
            if stack[waiting] <= end {
                child = stack[waiting].child();
                break;
            }
        }
    }
}

/// Numbers whose order as integers is that of the floats.
#[inline(always)]
fn ordered<L: Lanes>(lanes: L, x: L::F) -> L::I {
    let bits = x.bits();
    let negative = lanes.splat_int(0) - bits.shr::<31>();
    bits ^ (negative & lanes.splat_int(i32::MAX))
}

/// The first child of `bits`.
#[inline(always)]
fn entry<const W: usize>(node: &Node<W>, keys: &[i32; MAX_LANES], bits: u32) -> Entry {
    let slot = bits.trailing_zeros() as usize & (W - 1);
    Entry::new(keys[slot], node.child(slot))
}
