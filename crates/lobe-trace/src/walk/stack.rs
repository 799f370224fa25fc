//! What waits while a tree is walked.

use crate::bvh::Child;

/// A child to be visited and where the nearest ray enters it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    pub key: f32,
    pub child: Child,
}

/// A child of a node to be visited by some bundles, a bit each; `key` is below where any of their rays enters it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LargeEntry {
    pub key: f32,
    pub node: u32,
    pub slot: u32,
    pub bundles: u32,
}

/// Room for one walk of each kind over a tree.
#[derive(Clone, Debug)]
pub(crate) struct Stacks {
    pub single: Vec<Entry>,
    pub group: Vec<Child>,
    /// Where the rays of a group enter the children of [`group`](Stacks::group).
    pub enter: Vec<[f32; lobe_lane::MAX_LANES]>,
    pub large: Vec<LargeEntry>,
}

impl Stacks {
    /// For trees that keep at most `depth` references waiting.
    pub fn new(depth: usize) -> Self {
        let entry = Entry { key: 0.0, child: Child::node(0) };
        Stacks {
            single: vec![entry; depth],
            group: vec![Child::node(0); depth],
            enter: vec![[0.0; lobe_lane::MAX_LANES]; depth],
            large: vec![LargeEntry { key: 0.0, node: 0, slot: 0, bundles: 0 }; depth],
        }
    }
}
