//! Up to 64 rays of one octant.
//!
//! All children of a node are tested at once, one child per lane, against one bundle of eight rays after another. Rays
//! are tested one by one if all bundles are wide, and at the leaves.

use core::hint::select_unpredictable;

use lobe_lane::{Floats, Ints, Lanes, MAX_LANES, Mask, call};

use super::stack::LargeEntry;
use super::{Nodes, Single, Walk};
use crate::block::{Block, Found, first_ray, group_bits};
use crate::bundles::Bundles;
use crate::bvh::Node;
use crate::leaves::{Around, Leaves};
use crate::slab::{Sides, SlabRay, child_bits};

/// The width of a bundle, as a fraction of a box, up to which one of its rays is assumed to hit the box.
const WIDE: f32 = 0.5;

/// If at most this many rays hit a child, they continue one by one.
const ALONE: u32 = 5;

/// If an octant has at most this many rays, they are traced one by one.
pub(super) const FEW: u32 = 6;

#[inline(always)]
pub(super) fn walk<L: Lanes, V: Leaves, const W: usize>(lanes: L, walk: Walk<'_, V, W>, live: u64) {
    let Walk { bvh, leaves, rays, found, stacks } = walk;
    let octant = rays.octant(live.trailing_zeros() as usize);
    let sides = Sides::of(octant);
    let mut bundles = Bundles::around(lanes, rays, found, octant, live);
    let nodes = bvh.all;
    // Taken out, so that single rays can use the other stacks; put back at the end.
    let mut stack = std::mem::take(&mut stacks.large);
    let (mut keys, mut meeting) = ([0.0; MAX_LANES], [0; MAX_LANES]);
    let never = lanes.splat(f32::INFINITY);
    let mut waiting = 0;
    let mut current = 0;
    let mut asking = bundles.all();
    loop {
        let node = &nodes[current];
        let mut bits = 0;
        let mut slot = 0;
        while slot < W {
            let [near, far] = sides.children(lanes, node, slot);
            let (mut key, mut who) = (never, lanes.splat_int(0));
            let size = (far[0] - near[0]).abs().max((far[1] - near[1]).abs()).max((far[2] - near[2]).abs())
                * lanes.splat(WIDE);
            let mut left = asking;
            while left != 0 {
                let bundle = left.trailing_zeros();
                left &= left - 1;
                let [enter, leave] = bundles.interval(lanes, bundle as usize, near, far);
                let meets = enter.le(leave);
                // Also for a bundle that misses the child: a key may be too small, and this takes only one operation.
                key = enter.min(key);
                let narrow = bundles.width(lanes, bundle as usize, enter).le(size);
                let word = lanes.splat_int(0x100 << bundle).as_float().masked(narrow).bits();
                who = who | (word | lanes.splat_int(1 << bundle)).as_float().masked(meets).bits();
            }
            bits |= child_bits::<L, W>(!who.eq(lanes.splat_int(0)), slot);
            lanes.store(&mut keys[slot..], key);
            lanes.store_int(&mut meeting[slot..], who);
            slot += L::LANES;
        }
        let (parent, children) = ((node, current), (&keys, &meeting));
        let (met, end) = (bits, waiting + bits.count_ones() as usize);
        if leaves.any() {
            while bits != 0 {
                stack[waiting] = entry(lanes, &bvh, parent, bits.trailing_zeros() as usize, children);
                bits &= bits - 1;
                waiting += 1;
            }
        }
        // The nearest goes on top. Their number and order are unpredictable, so positions are counted, and two at a
        // time are pushed without a branch; a missing second one is written beyond the last.
        while bits != 0 {
            let one = bits.trailing_zeros() as usize & (W - 1);
            bits &= bits - 1;
            let there = bits != 0;
            let other = select_unpredictable(there, bits.trailing_zeros() as usize & (W - 1), one);
            bits &= bits.wrapping_sub(1);
            stack[waiting + farther::<L, W>(lanes, &keys, one, met)] = entry(lanes, &bvh, parent, one, children);
            let place = waiting + farther::<L, W>(lanes, &keys, other, met);
            stack[select_unpredictable(there, place, end)] = entry(lanes, &bvh, parent, other, children);
        }
        waiting = end;
        loop {
            if waiting == 0 {
                stacks.large = stack;
                return;
            }
            waiting -= 1;
            let entry = stack[waiting];
            asking = bundles.looking(lanes, entry.bundles, entry.key);
            if asking == 0 {
                continue;
            }
            let node = &nodes[entry.node as usize];
            let slot = entry.slot as usize & (W - 1);
            let child = node.child(slot);
            // A narrow bundle is trusted.
            if !child.is_leaf() && asking & entry.bundles >> 8 != 0 {
                current = child.index();
                break;
            }
            let mut left = bundles.rays(asking);
            let mut live = 0;
            while left != 0 {
                let at = first_ray::<L>(left.trailing_zeros() as usize);
                let bits = group_bits::<L>(left, at);
                left ^= (bits as u64) << at;
                live |= ((group_meets(lanes, &sides, node, slot, rays, found, at) & bits) as u64) << at;
            }
            if live == 0 {
                continue;
            }
            if !child.is_leaf() {
                if live.count_ones() <= ALONE && L::LANES >= 8 {
                    let walk = Walk { bvh, leaves: &mut *leaves, rays, found: &mut *found, stacks: &mut *stacks };
                    call(lanes.narrow(), Single { walk, from: child, live });
                    bundles.shorten(lanes, found, live);
                    continue;
                }
                current = child.index();
                asking = bundles.of_rays(live);
                break;
            }
            let hit = leaves.packet(lanes, child, rays, live, found, Around::Bundles(&bundles));
            bundles.shorten(lanes, found, hit);
        }
    }
}

/// The stack entry of a child of a node, which is prefetched.
#[inline(always)]
fn entry<L: Lanes, const W: usize>(
    lanes: L,
    bvh: &Nodes<'_, W>,
    (node, index): (&Node<W>, usize),
    slot: usize,
    (keys, meeting): (&[f32; MAX_LANES], &[i32; MAX_LANES]),
) -> LargeEntry {
    let slot = slot & (W - 1);
    bvh.prefetch(lanes, node.child(slot));
    LargeEntry { key: keys[slot], node: index as u32, slot: slot as u32, bundles: meeting[slot] as u32 }
}

/// The number of children of `met` that are behind one of them; of two at the same distance, the first counts as
/// behind.
#[inline(always)]
fn farther<L: Lanes, const W: usize>(lanes: L, keys: &[f32; MAX_LANES], slot: usize, met: u32) -> usize {
    let own = lanes.splat(keys[slot]);
    let (mut behind, mut beside) = (0, 0);
    let mut first = 0;
    while first < W {
        let all = lanes.load(&keys[first..]);
        behind |= own.lt(all).bits() << first;
        beside |= own.eq(all).bits() << first;
        first += L::LANES;
    }
    let before = (1 << slot) - 1;
    ((behind | beside & before) & met).count_ones() as usize
}

/// The bits of those rays of a group that hit a child before their best hit.
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
