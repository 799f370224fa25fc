//! Binary trees, made by the crate `obvhs`: nothing else of the project knows it.

use obvhs::aabb::Aabb as BuilderBox;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
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
    pub fn build(boxes: impl IntoIterator<Item = Aabb>, leaf: usize) -> Self {
        let primitives: Vec<Primitive> = boxes.into_iter().map(Primitive).collect();
        if primitives.is_empty() {
            return Binary { nodes: Vec::new(), order: Vec::new() };
        }
        let params = BvhBuildParams { max_prims_per_leaf: leaf as u32, ..BvhBuildParams::medium_build() };
        let Bvh2 { nodes, primitive_indices, .. } = build_bvh2(&primitives, params, &mut Default::default());
        let nodes = nodes
            .into_iter()
            .map(|node| BinaryNode {
                bounds: Aabb { lower: node.min.to_array(), upper: node.max.to_array() },
                count: node.prim_count as usize,
                first: node.first_index as usize,
            })
            .collect();
        Binary { nodes, order: primitive_indices }
    }
}
