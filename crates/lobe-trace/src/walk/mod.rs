//! Ways to walk a tree.

mod group;
mod large;
mod single;
mod stack;

use bytemuck::Pod;
use lobe_lane::{Kernel, Lanes, call};

use crate::Form;
use crate::block::{Block, Found, RAYS, group_bits, mask_of};
use crate::bvh::{Child, Node, WideBvh};
use crate::leaves::Leaves;

pub(crate) use stack::Stacks;

/// The nodes of a tree, and the memory of its nodes and leaves.
#[derive(Clone, Copy)]
pub(crate) struct Nodes<'a, const W: usize> {
    all: &'a [Node<W>],
    memory: [&'a [f32]; 2],
    strides: [usize; 2],
}

impl<'a, const W: usize> Nodes<'a, W> {
    /// The nodes of a tree whose leaf number `i` is `blocks[i]`.
    pub fn new<B: Pod>(bvh: &'a WideBvh<W>, blocks: &'a [B]) -> Self {
        let all = bvh.nodes.as_slice();
        let sizes = [size_of::<Node<W>>(), size_of::<B>()];
        Nodes {
            all,
            memory: [bytemuck::cast_slice(all), bytemuck::cast_slice(blocks)],
            strides: sizes.map(|bytes| bytes / size_of::<f32>()),
        }
    }

    /// Prefetches the next entry. Whether that is a node or a leaf is unpredictable, so there is no branch on it.
    #[inline(always)]
    fn prefetch<L: Lanes>(&self, lanes: L, child: Child) {
        let kind = usize::from(child.is_leaf());
        lanes.prefetch::<5, f32>(self.memory[kind], child.first() * self.strides[kind]);
    }
}

/// A tree, the rays that walk it, and the memory for their hits.
pub(crate) struct Walk<'a, V, const W: usize> {
    pub bvh: Nodes<'a, W>,
    pub leaves: &'a mut V,
    pub rays: &'a Block,
    pub found: &'a mut Found,
    pub stacks: &'a mut Stacks,
}

impl<V: Leaves, const W: usize> Walk<'_, V, W> {
    /// Traces the rays of `live` by a form; those that are not coherent are traced one by one.
    #[inline(always)]
    pub fn trace<L: Lanes>(self, lanes: L, form: Form, live: u64) {
        let Walk { bvh, leaves, rays, found, stacks } = self;
        let mut alone = live;
        if form == Form::Large {
            let mut left = live;
            while left != 0 {
                let ray = left.trailing_zeros() as usize;
                let together = rays.of_octant(lanes, rays.octant(ray), left);
                left &= !(together | 1 << ray);
                if together.count_ones() > large::FEW {
                    let walk = Walk { bvh, leaves: &mut *leaves, rays, found: &mut *found, stacks: &mut *stacks };
                    call(lanes, Large(walk, together));
                    alone &= !together;
                }
            }
        }
        let mut at = if form == Form::Single || form == Form::Large { RAYS } else { 0 };
        while at < RAYS {
            let bits = group_bits::<L>(live, at);
            if bits != 0 && rays.group_is_coherent(lanes, at, mask_of(lanes, bits)) {
                let few = if form == Form::Packet { 0 } else { group::FEW };
                let walk = Walk { bvh, leaves: &mut *leaves, rays, found: &mut *found, stacks: &mut *stacks };
                call(lanes, Group { walk, at, live: bits, few });
                alone &= !((bits as u64) << at);
            }
            at += L::LANES;
        }
        if alone != 0 {
            let walk = Walk { bvh, leaves, rays, found, stacks };
            call(lanes.narrow(), Single { walk, from: Child::node(0), live: alone });
        }
    }
}

/// Traces rays one by one, starting at a child.
struct Single<'a, V, const W: usize> {
    walk: Walk<'a, V, W>,
    from: Child,
    live: u64,
}

impl<V: Leaves, const W: usize> Kernel for Single<'_, V, W> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        single::walk(lanes, self.walk, self.from, self.live);
    }
}

/// The group that begins at ray `at`; single rays if at most `few` are live.
struct Group<'a, V, const W: usize> {
    walk: Walk<'a, V, W>,
    at: usize,
    live: u32,
    few: u32,
}

impl<V: Leaves, const W: usize> Kernel for Group<'_, V, W> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        group::walk(lanes, self.walk, self.at, self.live, self.few);
    }
}

/// All rays that are live.
struct Large<'a, V, const W: usize>(Walk<'a, V, W>, u64);

impl<V: Leaves, const W: usize> Kernel for Large<'_, V, W> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        large::walk(lanes, self.0, self.1);
    }
}
