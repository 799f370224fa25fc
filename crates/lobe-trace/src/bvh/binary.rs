//! Binary trees, built by the crate `obvhs`, which is used only here.

use obvhs::aabb::Aabb as BuilderBox;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance};
use obvhs::{Boundable, BvhBuildParams};

use crate::Aabb;

/// A node of a binary tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BinaryNode {
    pub bounds: Aabb,
    /// The first place of its primitives in the order of primitives.
    first: u32,
    /// The number of its primitives.
    count: u32,
    /// The index of its second child. The first child of a node that has children is the next node.
    second: u32,
}

impl BinaryNode {
    /// Without children.
    pub fn is_single(&self) -> bool {
        self.second == 0
    }

    pub fn count(&self) -> usize {
        self.count as usize
    }

    /// The places of its primitives in the order of primitives.
    pub fn members(&self) -> std::ops::Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }

    pub fn second(&self) -> usize {
        self.second as usize
    }
}

/// A binary tree over boxes; node 0 is the root, and without boxes there are no nodes.
#[derive(Debug)]
pub(crate) struct Binary {
    /// In the order of a depth-first walk.
    pub nodes: Vec<BinaryNode>,
    /// The primitives in the order of that walk.
    pub order: Vec<u32>,
}

struct Primitive(Aabb);

impl Boundable for Primitive {
    fn aabb(&self) -> BuilderBox {
        BuilderBox::new(self.0.lower.into(), self.0.upper.into())
    }
}

impl Binary {
    /// Builds a tree over boxes: parallel locally-ordered clustering (Meister and Bittner 2018), then reinsertion,
    /// which gave 9 to 23 per cent cheaper trees than 16-bin SAH in the same time. With `pairs`, two leaves of one
    /// parent become one: if leaves may hold more, splitting hardly any pair is better.
    pub fn build(boxes: &[Aabb], pairs: bool) -> Self {
        if boxes.is_empty() {
            return Binary { nodes: Vec::new(), order: Vec::new() };
        }
        let reach = boxes.iter().fold(0.0, |most, bounds| bounds.reach().max(most));
        // In units of the largest number, as the areas of tiny boxes would otherwise all be zero.
        let scale = 1.0 / reach.max(f32::MIN_POSITIVE);
        let uneven = |(index, &bounds): (usize, &Aabb)| Primitive(loosened(bounds, index, scale));
        let primitives: Vec<Primitive> = boxes.iter().enumerate().map(uneven).collect();
        let mut tree = Self::walked(&clustered(&primitives), boxes.len(), pairs);
        tree.fit(boxes);
        tree
    }

    /// Puts nodes and primitives, of which the source has one per leaf, in the order of a depth-first walk.
    fn walked(source: &Bvh2, primitives: usize, pairs: bool) -> Self {
        let (mut nodes, mut order) = (Vec::with_capacity(source.nodes.len()), Vec::with_capacity(primitives));
        // Nodes still to be visited, and the node whose second child each is.
        let mut waiting = vec![(0, None)];
        while let Some((at, parent)) = waiting.pop() {
            let node = &source.nodes[at];
            let index = nodes.len() as u32;
            if let Some(parent) = parent {
                let parent: &mut BinaryNode = &mut nodes[parent as usize];
                parent.second = index;
            }
            nodes.push(BinaryNode {
                bounds: Aabb::EMPTY,
                first: order.len() as u32,
                count: node.prim_count,
                second: 0,
            });
            let first = node.first_index as usize;
            let mut add = |leaf: &Bvh2Node| order.push(source.primitive_indices[leaf.first_index as usize]);
            if node.is_leaf() {
                add(node);
            } else if pairs && source.nodes[first..first + 2].iter().all(Bvh2Node::is_leaf) {
                source.nodes[first..first + 2].iter().for_each(add);
                nodes[index as usize].count = 2;
            } else {
                waiting.extend([(first + 1, Some(index)), (first, None)]);
            }
        }
        Binary { nodes, order }
    }

    /// Gives every node its primitives and the box around them.
    fn fit(&mut self, boxes: &[Aabb]) {
        for at in (0..self.nodes.len()).rev() {
            let node = self.nodes[at];
            let (bounds, count) = if node.is_single() {
                let members = &self.order[node.members()];
                (members.iter().fold(Aabb::EMPTY, |sum, &member| sum.union(boxes[member as usize])), node.count)
            } else {
                let [one, other] = [self.nodes[at + 1], self.nodes[node.second()]];
                (one.bounds.union(other.bounds), one.count + other.count)
            };
            self.nodes[at] = BinaryNode { bounds, count, ..node };
        }
    }
}

/// The distance along the curve at which a box searches for its nearest neighbour: two boxes in each direction. After
/// reinsertion, trees cost about as much as with the medium preset's fourteen (1.3 per cent more to 3.5 per cent less,
/// over twelve meshes), and they are built in two thirds of the time.
const SEARCH: PlocSearchDistance = PlocSearchDistance::VeryLow;

/// The share of nodes that a round of reinsertion moves: the 0.05 of the presets takes a third longer, for trees that
/// cost half a per cent less.
const REINSERTED: f32 = 0.005;

/// Such a share would hardly change small trees, so a round moves at least twice this many nodes if the tree has them.
const FEWEST: f32 = 500.0;

/// The builder's own sequence for its medium preset, without the check that it adds in debug builds: that check
/// recurses as deep as the tree and refuses trees deeper than reinsertion was expected to make them. Joining leaves is
/// left to the wide tree, which knows their costs.
fn clustered(primitives: &[Primitive]) -> Bvh2 {
    let preset = BvhBuildParams::medium_build();
    let mut tree = PlocBuilder::with_capacity(primitives.len()).build(
        SEARCH,
        primitives,
        (0..primitives.len() as u32).collect(),
        preset.sort_precision,
        preset.search_depth_threshold,
    );
    let share = REINSERTED.max(FEWEST / primitives.len() as f32).min(1.0);
    ReinsertionOptimizer::default().run(&mut tree, share, None);
    tree
}

/// A scaled box enlarged by up to a thirtieth of its size, by a different amount for each.
///
/// Clustering joins boxes that are each other's nearest. If all costs are equal, as along a fence of equal posts or in
/// a heap of equal triangles, the nearest box is always the neighbour on the same side, only one pair joins per round,
/// and a million boxes take hours and make a tree a million levels deep. Uneven boxes have mutual nearest neighbours
/// everywhere.
fn loosened(bounds: Aabb, index: usize, scale: f32) -> Aabb {
    let mut bounds = bounds;
    let mut state = index as u64;
    for axis in 0..3 {
        // SplitMix64 (Steele, Lea, Flood 2014).
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut hash = (state ^ state >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        hash = (hash ^ hash >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        let part = ((hash ^ hash >> 31) >> 40) as f32 / 16_777_216.0;
        let [lower, upper] = [bounds.lower[axis] * scale, bounds.upper[axis] * scale];
        let more = part * ((upper - lower) / 64.0 + 1.0 / 1_048_576.0);
        bounds.lower[axis] = lower - more;
        bounds.upper[axis] = upper + more;
    }
    bounds
}
