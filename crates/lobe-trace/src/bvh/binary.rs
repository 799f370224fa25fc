//! Binary trees, made by the crate `obvhs`: nothing else of the project knows it.

use obvhs::aabb::Aabb as BuilderBox;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::PlocBuilder;
use obvhs::{Boundable, BvhBuildParams};

use crate::Aabb;

/// A node of a binary tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BinaryNode {
    pub bounds: Aabb,
    /// How many primitives a leaf has; 0 for an inner node.
    pub count: usize,
    /// A leaf's first place in the order of primitives; the first of an inner node's two neighbouring children.
    pub first: usize,
}

/// A binary tree over boxes; node 0 is the root, and there is none where there are no boxes.
#[derive(Debug)]
pub(crate) struct Binary {
    pub nodes: Vec<BinaryNode>,
    /// The primitives in the order of the leaves.
    pub order: Vec<u32>,
}

struct Primitive(Aabb);

impl Boundable for Primitive {
    fn aabb(&self) -> BuilderBox {
        BuilderBox::new(self.0.lower.into(), self.0.upper.into())
    }
}

impl Binary {
    /// Builds a tree over boxes with at most `leaf` of them in a leaf: parallel locally-ordered clustering (Meister and
    /// Bittner 2018), then reinsertion, which gave 9 to 23 per cent cheaper trees than 16-bin SAH in the same time.
    pub fn build(boxes: &[Aabb], leaf: usize) -> Self {
        if boxes.is_empty() {
            return Binary { nodes: Vec::new(), order: Vec::new() };
        }
        let reach = boxes.iter().fold(0.0, |most, bounds| bounds.reach().max(most));
        // In units of the largest number: surfaces of tiny boxes would all be zero.
        let scale = 1.0 / reach.max(f32::MIN_POSITIVE);
        let uneven = |(index, &bounds): (usize, &Aabb)| Primitive(loosened(bounds, index, scale));
        let primitives: Vec<Primitive> = boxes.iter().enumerate().map(uneven).collect();
        let Bvh2 { nodes, primitive_indices, .. } = clustered(&primitives, leaf);
        let nodes = nodes
            .into_iter()
            .map(|node| BinaryNode {
                bounds: Aabb::EMPTY,
                count: node.prim_count as usize,
                first: node.first_index as usize,
            })
            .collect();
        let mut tree = Binary { nodes, order: primitive_indices };
        tree.fit(boxes);
        tree
    }

    /// Gives every node the box around its primitives.
    fn fit(&mut self, boxes: &[Aabb]) {
        let mut parents_first = Vec::with_capacity(self.nodes.len());
        let mut waiting = vec![0];
        while let Some(at) = waiting.pop() {
            parents_first.push(at);
            let node = self.nodes[at];
            if node.count == 0 {
                waiting.extend([node.first, node.first + 1]);
            }
        }
        for at in parents_first.into_iter().rev() {
            let node = self.nodes[at];
            self.nodes[at].bounds = if node.count == 0 {
                self.nodes[node.first].bounds.union(self.nodes[node.first + 1].bounds)
            } else {
                let members = &self.order[node.first..node.first + node.count];
                members.iter().fold(Aabb::EMPTY, |sum, &member| sum.union(boxes[member as usize]))
            };
        }
    }
}

/// The share of nodes that a round of reinsertion moves: the presets' 0.05 takes a third longer and traces no faster.
const REINSERTED: f32 = 0.02;

/// What a box test costs, in triangle tests. Leaves of few triangles suit rays that are traced one by one; below 1.5
/// trees of a million triangles become too large for the caches.
const BOX_COST: f32 = 2.0;

/// The builder's own sequence for its medium preset, without the check that it adds in debug builds: that recurses as
/// deep as the tree and refuses trees deeper than reinsertion was expected to make them. The second reinsertion, after
/// leaves were joined, is left out: rays do not notice it.
fn clustered(primitives: &[Primitive], leaf: usize) -> Bvh2 {
    let preset = BvhBuildParams::medium_build();
    let mut tree = PlocBuilder::with_capacity(primitives.len()).build(
        preset.ploc_search_distance,
        primitives,
        (0..primitives.len() as u32).collect(),
        preset.sort_precision,
        preset.search_depth_threshold,
    );
    ReinsertionOptimizer::default().run(&mut tree, REINSERTED, None);
    collapse(&mut tree, leaf as u32, BOX_COST);
    tree
}

/// A scaled box made larger by up to a thirtieth of its size, a different part for each.
///
/// Clustering joins boxes that are each other's nearest. Where all costs are equal, as along a fence of equal posts or
/// in a heap of equal triangles, everybody's nearest is the neighbour on one side, only one pair joins a round, and a
/// million boxes take hours and make a tree a million deep. Uneven boxes have mutual neighbours everywhere.
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
