//! The wide node: the boxes of all children side by side.

use bytemuck::{Pod, Zeroable};
use lobe_memory::Storage;

use crate::Aabb;

/// A child of a node: another node, or a leaf of up to eight primitives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    /// The most primitives that a leaf can have.
    pub const MOST: usize = 8;

    pub fn node(index: usize) -> Self {
        assert!(index < Self::LEAF as usize, "a tree of more nodes than a reference can count");
        Child(index as u32)
    }

    /// Leaf number `first`, of `count` primitives.
    pub fn leaf(first: usize, count: usize) -> Self {
        assert!(first < 1 << 28, "more leaves than a reference can count");
        assert!((1..=Self::MOST).contains(&count), "a leaf of {count} primitives");
        Child(Self::LEAF | ((count - 1) as u32) << 28 | first as u32)
    }

    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    #[inline(always)]
    pub fn bits(self) -> u32 {
        self.0
    }

    #[inline(always)]
    pub fn from_bits(bits: u32) -> Self {
        Child(bits)
    }

    /// The index of an inner node.
    #[inline(always)]
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// The number of a leaf; also of a node, if its larger range does not matter.
    #[inline(always)]
    pub fn first(self) -> usize {
        (self.0 & 0x0fff_ffff) as usize
    }

    /// The number of primitives of a leaf.
    #[inline(always)]
    pub fn count(self) -> usize {
        (self.0 >> 28 & 7) as usize + 1
    }
}

/// Up to `W` children, 4 cache lines for eight. Rows lower x, upper x, lower y, ... of their boxes, one entry per
/// child; the references to them as bits; and a row that fills the last line. Absent children come last and have the
/// empty box, which nothing hits.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(transparent)]
pub(crate) struct Node<const W: usize>([[f32; W]; 8]);

impl<const W: usize> Node<W> {
    const CHILDREN: usize = 6;

    pub const EMPTY: Self = {
        let (low, high, zero) = ([f32::INFINITY; W], [f32::NEG_INFINITY; W], [0.0; W]);
        Node([low, high, low, high, low, high, zero, zero])
    };

    /// A row of the boxes of all children.
    #[inline(always)]
    pub fn bounds(&self, row: usize) -> &[f32; W] {
        &self.0[row & 7]
    }

    #[inline(always)]
    pub fn child(&self, slot: usize) -> Child {
        Child::from_bits(self.0[Self::CHILDREN][slot & (W - 1)].to_bits())
    }

    pub fn set(&mut self, slot: usize, bounds: Aabb, child: Child) {
        for (row, bound) in self.0.iter_mut().zip(bounds.rows()) {
            row[slot] = bound;
        }
        self.refer(slot, child);
    }

    pub fn refer(&mut self, slot: usize, child: Child) {
        self.0[Self::CHILDREN][slot] = f32::from_bits(child.bits());
    }
}

/// A tree with up to `W` children per node; `W` is 4 or 8.
#[derive(Clone, Debug)]
pub struct WideBvh<const W: usize> {
    /// Node 0 is the root and always exists.
    pub(crate) nodes: Storage<Node<W>>,
    pub(crate) bounds: Aabb,
    /// The number of references that may wait at once during a walk, plus one that is overwritten.
    pub(crate) stack: usize,
}

impl<const W: usize> WideBvh<W> {
    /// The box around everything.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }
}
