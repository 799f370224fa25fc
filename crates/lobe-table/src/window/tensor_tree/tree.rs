//! Trees as measured.

use crate::Kind;
use thiserror::Error;

/// The name of the representation.
pub const KIND: Kind = Kind::new("tensor trees");

/// The most halvings of the dimensions of a tree, including leaf grids, that a 32-bit index can address.
pub const MAX_DEPTH: usize = 24;

/// The distance below the middle at which the radii of a tree of rank 3 begin.
pub(super) const INSET: f64 = 1e-6;

/// The way in which a pair of directions addresses a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rank {
    /// Isotropic: radius of the incident direction, square of the exit direction.
    Three,
    /// Anisotropic: squares of both directions.
    Four,
}

impl Rank {
    /// The number of dimensions, 3 or 4.
    pub fn dimensions(self) -> usize {
        match self {
            Rank::Three => 3,
            Rank::Four => 4,
        }
    }
}

/// A node of a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Node {
    /// `2^dimensions` consecutive child nodes that start at this position. Child number `n` is in the upper half
    /// along dimension `d` if bit `d` of `n` is set.
    Branch(u32),
    /// A grid of `2^level` cells along each dimension.
    Leaf {
        /// Position of the first value. Dimension 0 varies slowest.
        first: u32,
        /// Halvings along each dimension.
        level: u32,
    },
}

/// Nodes and values that cannot form a tree.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum TreeError {
    /// No node at all.
    #[error("no nodes; expected a root")]
    Empty,
    /// A branch whose children do not follow it, or do not exist.
    #[error("the children of node {node} start at {first}; expected a position after the node, and room for all")]
    Children {
        /// Position of the branch.
        node: usize,
        /// The start of its children.
        first: u32,
    },
    /// A node with no parent, or with two.
    #[error("node {node} has {parents} parents; expected one")]
    Parents {
        /// Position of the node.
        node: usize,
        /// What was found.
        parents: u32,
    },
    /// A branch or leaf that divides further than [`MAX_DEPTH`].
    #[error("node {node} divides more than {MAX_DEPTH} times")]
    Depth {
        /// Position of the node.
        node: usize,
    },
    /// A leaf whose values do not exist.
    #[error("the grid of node {node} ends beyond the values")]
    Values {
        /// Position of the leaf.
        node: usize,
    },
    /// A value that is NaN or infinite.
    #[error("value {index} is not finite")]
    ValueNotFinite {
        /// Position in the value array.
        index: usize,
    },
}

/// A BSDF of one side and one scatter, as a tree. Values are `f` in 1/sr, without the cosine.
#[derive(Clone, Debug, PartialEq)]
pub struct TensorTree {
    pub(super) rank: Rank,
    pub(super) nodes: Vec<Node>,
    pub(super) values: Vec<f32>,
}

impl TensorTree {
    /// Checks nodes and values and stores them. Node 0 is the root.
    ///
    /// # Errors
    /// [`TreeError`] names the node.
    pub fn new(rank: Rank, nodes: Vec<Node>, values: Vec<f32>) -> Result<Self, TreeError> {
        if nodes.is_empty() {
            return Err(TreeError::Empty);
        }
        if let Some(index) = values.iter().position(|v| !v.is_finite()) {
            return Err(TreeError::ValueNotFinite { index });
        }
        let children = 1 << rank.dimensions();
        let mut parents = vec![0_u32; nodes.len()];
        let mut depth = vec![0_usize; nodes.len()];
        for (node, kind) in nodes.iter().enumerate() {
            match *kind {
                Node::Branch(first) => {
                    let start = first as usize;
                    if start <= node || start.checked_add(children).is_none_or(|end| end > nodes.len()) {
                        return Err(TreeError::Children { node, first });
                    }
                    if depth[node] >= MAX_DEPTH {
                        return Err(TreeError::Depth { node });
                    }
                    for child in start..start + children {
                        parents[child] += 1;
                        depth[child] = depth[node] + 1;
                    }
                }
                Node::Leaf { first, level } => {
                    if depth[node] + level as usize > MAX_DEPTH {
                        return Err(TreeError::Depth { node });
                    }
                    let size = 1_usize.checked_shl(level * rank.dimensions() as u32);
                    let end = size.and_then(|size| size.checked_add(first as usize));
                    if end.is_none_or(|end| end > values.len()) {
                        return Err(TreeError::Values { node });
                    }
                }
            }
        }
        parents[0] += 1;
        if let Some(node) = parents.iter().position(|&n| n != 1) {
            return Err(TreeError::Parents { node, parents: parents[node] });
        }
        Ok(TensorTree { rank, nodes, values })
    }

    /// Three or four dimensions.
    pub fn rank(&self) -> Rank {
        self.rank
    }

    /// All nodes; the root first, children after their parent.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The values of all leaf grids, in 1/sr.
    pub fn values(&self) -> &[f32] {
        &self.values
    }
}
