//! The stacks of a walk.

use crate::block::RAYS;
use crate::bvh::Child;

/// A child to be visited and the t at which the ray enters it, in one integer, so that the nearest is the smallest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Entry(i64);

impl Entry {
    /// Comes after all other entries.
    pub const LAST: Self = Entry(i64::MAX);

    /// For a child that is entered at `key`, which must not be negative: the bits of such floats are in the same order.
    #[inline(always)]
    pub fn new(key: f32, child: Child) -> Self {
        Entry((key.to_bits() as i64) << 32 | child.bits() as i64)
    }

    /// At or above the entry of every child that is entered at `t` or earlier; if `t` is negative, at zero.
    #[inline(always)]
    pub fn until(t: f32) -> Self {
        let t = if t > 0.0 { t } else { 0.0 };
        Entry((t.to_bits() as i64) << 32 | u32::MAX as i64)
    }

    #[inline(always)]
    pub fn child(self) -> Child {
        Child::from_bits(self.0 as u32)
    }
}

/// The state of a single ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct State {
    /// The child that it visits.
    pub child: Child,
    /// Its part of the stack, and the position of its next entry.
    pub bottom: u32,
    pub top: u32,
}

/// A child of a node to be visited by some bundles, one bit each; `key` is a lower bound of the t at which their rays
/// enter it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LargeEntry {
    pub key: f32,
    pub node: u32,
    pub slot: u32,
    pub bundles: u32,
}

/// Memory for one walk of each kind over a tree.
#[derive(Clone, Debug)]
pub(crate) struct Stacks {
    pub single: Vec<Entry>,
    pub states: [State; RAYS],
    pub group: Vec<Child>,
    /// The t at which the rays of a group enter the children of [`group`](Stacks::group).
    pub enter: Vec<[f32; lobe_lane::MAX_LANES]>,
    pub large: Vec<LargeEntry>,
}

impl Stacks {
    /// For trees that keep at most `depth` references waiting.
    pub fn new(depth: usize) -> Self {
        let entry = Entry::new(0.0, Child::node(0));
        Stacks {
            single: vec![entry; RAYS * depth],
            states: [State { child: Child::node(0), bottom: 0, top: 0 }; RAYS],
            group: vec![Child::node(0); depth],
            enter: vec![[0.0; lobe_lane::MAX_LANES]; depth],
            large: vec![LargeEntry { key: 0.0, node: 0, slot: 0, bundles: 0 }; depth],
        }
    }
}
