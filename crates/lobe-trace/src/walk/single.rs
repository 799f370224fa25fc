//! One ray against all boxes of a node, one child per lane; all rays of a block are in flight at once.
//!
//! A single ray waits at every step, first for boxes to arrive and then for the comparison of eight of them, and its
//! next step is unpredictable. So the rays take turns, one step each, and others advance while one waits.

use core::hint::select_unpredictable;

use lobe_lane::{Floats, Lanes, MAX_LANES};

use super::stack::{Entry, State};
use super::{Nodes, Walk};
use crate::block::{Block, Found, RAYS};
use crate::bvh::{Child, Node};
use crate::leaves::Leaves;
use crate::slab::{Sides, SlabRay, child_bits};

/// Traces the rays of `live`, starting at a child.
#[inline(always)]
pub(super) fn walk<L: Lanes, V: Leaves, const W: usize>(lanes: L, walk: Walk<'_, V, W>, from: Child, live: u64) {
    let Walk { bvh, leaves, rays, found, stacks } = walk;
    let mut keys = [0.0; MAX_LANES];
    let mut flock = Flock::new(&mut stacks.states, stacks.single.as_mut_slice(), from, live);
    // In one round each ray at a node takes a step, then each at a leaf.
    while flock.nodes.count + flock.leaves.count > 0 {
        let mut turns = flock.nodes.take();
        while let Some(ray) = turns.next() {
            let State { child, top, .. } = flock.states[ray];
            let node = &bvh.all[child.index()];
            let bits = hit_children(lanes, node, rays, found, ray, &mut keys);
            let top = flock.push(top as usize, node, &keys, bits);
            flock.go_next(lanes, &bvh, found, ray, top);
        }
        let mut turns = flock.leaves.take();
        while let Some(ray) = turns.next() {
            let State { child, top, bottom } = flock.states[ray];
            leaves.single(lanes, child, rays, ray, found);
            let ended = leaves.any() && found.t[ray] == f32::NEG_INFINITY;
            flock.go_next(lanes, &bvh, found, ray, if ended { bottom } else { top } as usize);
        }
    }
}

/// Rays whose turn it is.
#[derive(Clone, Copy)]
struct List {
    rays: [u8; RAYS],
    count: usize,
}

/// The rays of a list when a round began.
struct Turns {
    list: List,
    at: usize,
}

impl List {
    const EMPTY: Self = List { rays: [0; RAYS], count: 0 };

    /// Adds a ray if `wanted`.
    #[inline(always)]
    fn add(&mut self, ray: usize, wanted: bool) {
        self.rays[self.count & (RAYS - 1)] = ray as u8;
        self.count += usize::from(wanted);
    }

    #[inline(always)]
    fn take(&mut self) -> Turns {
        let list = *self;
        self.count = 0;
        Turns { list, at: 0 }
    }
}

impl Turns {
    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        if self.at == self.list.count {
            return None;
        }
        let ray = self.list.rays[self.at & (RAYS - 1)];
        self.at += 1;
        Some(ray as usize & (RAYS - 1))
    }
}

/// The rays under way.
struct Flock<'a> {
    states: &'a mut [State; RAYS],
    nodes: List,
    leaves: List,
    stack: &'a mut [Entry],
}

impl<'a> Flock<'a> {
    #[inline(always)]
    fn new(states: &'a mut [State; RAYS], stack: &'a mut [Entry], from: Child, live: u64) -> Self {
        let depth = (stack.len() / RAYS) as u32;
        let mut flock = Flock { states, nodes: List::EMPTY, leaves: List::EMPTY, stack };
        let mut left = live;
        let mut at = 0;
        while left != 0 {
            let ray = left.trailing_zeros() as usize;
            left &= left - 1;
            flock.states[ray] = State { child: from, bottom: at, top: at };
            flock.enlist(ray, from);
            at += depth;
        }
        flock
    }

    #[inline(always)]
    fn enlist(&mut self, ray: usize, child: Child) {
        self.nodes.add(ray, !child.is_leaf());
        self.leaves.add(ray, child.is_leaf());
    }

    /// Pushes the children whose bits are set, the nearest on top. Returns where the next entry goes.
    #[inline(always)]
    fn push<const W: usize>(
        &mut self,
        mut top: usize,
        node: &Node<W>,
        keys: &[f32; MAX_LANES],
        mut bits: u32,
    ) -> usize {
        // The number of hit children, and the nearer of two, are unpredictable, so up to two are pushed without a
        // branch.
        let one = entry(node, keys, bits);
        let more = bits & bits.wrapping_sub(1);
        let other = entry(node, keys, more);
        let (mut near, mut far) = (one.min(other), one.max(other));
        let floor = top;
        self.stack[top] = far;
        top += usize::from(more != 0);
        bits = more & more.wrapping_sub(1);
        while bits != 0 {
            let other = entry(node, keys, bits);
            bits &= bits - 1;
            far = near.max(other);
            near = near.min(other);
            let mut place = floor;
            while place < top {
                let below = self.stack[place];
                self.stack[place] = below.max(far);
                far = below.min(far);
                place += 1;
            }
            self.stack[top] = far;
            top += 1;
        }
        self.stack[top] = near;
        // If nothing was hit, neither of the two exists.
        if near == Entry::LAST { floor } else { top + 1 }
    }

    /// Finds the next step of a ray: the entry on its stack below `top`.
    #[inline(always)]
    fn go_next<L: Lanes, const W: usize>(
        &mut self,
        lanes: L,
        bvh: &Nodes<'_, W>,
        found: &Found,
        ray: usize,
        mut top: usize,
    ) {
        let state = &mut self.states[ray];
        // A child that begins exactly at the best hit may still contain a hit that wins the tie.
        let end = Entry::until(found.t[ray]);
        while top != state.bottom as usize {
            top -= 1;
            let entry = self.stack[top];
            if entry <= end {
                let child = entry.child();
                bvh.prefetch(lanes, child);
                state.child = child;
                state.top = top as u32;
                self.enlist(ray, child);
                return;
            }
        }
    }
}

/// The bits of the children that a ray hits before its best hit, and the t at which it enters them.
#[inline(always)]
fn hit_children<L: Lanes, const W: usize>(
    lanes: L,
    node: &Node<W>,
    rays: &Block,
    found: &Found,
    ray: usize,
    keys: &mut [f32; MAX_LANES],
) -> u32 {
    let slab = SlabRay::single(lanes, rays, ray);
    let sides = Sides::of(rays.octant(ray));
    let (t_min, best, zero) = (lanes.splat(rays.t_min[ray]), lanes.splat(found.t[ray]), lanes.splat(0.0));
    let mut bits = 0;
    let mut slot = 0;
    while slot < W {
        let [near, far] = sides.children(lanes, node, slot);
        let [enter, leave] = slab.interval(lanes, near, far);
        let enter = enter.max(t_min);
        bits |= child_bits::<L, W>(enter.le(leave.min(best)), slot);
        lanes.store(&mut keys[slot..], enter.max(zero));
        slot += L::LANES;
    }
    bits
}

/// The first child of `bits`; the last entry of all if there is none.
#[inline(always)]
fn entry<const W: usize>(node: &Node<W>, keys: &[f32; MAX_LANES], bits: u32) -> Entry {
    let slot = bits.trailing_zeros() as usize & (W - 1);
    select_unpredictable(bits == 0, Entry::LAST, Entry::new(keys[slot], node.child(slot)))
}
