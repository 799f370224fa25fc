//! Tensor trees: a BSDF on an adaptive grid over two unit squares, or over one square and a radius.
//!
//! A direction becomes a point of the unit square by the concentric map of P. Shirley and K. Chiu ("A low distortion
//! map between disk and square", Journal of Graphics Tools 2(3), 1997) of its x and y. A tree of rank 4 is addressed by
//! the squares of the incident and of the exit direction; one of rank 3 is isotropic and has a radius in place of the
//! incident square. Every branch halves each dimension. Nothing is interpolated.
//!
//! Nodes and leaf values lie in flat arrays, so that a walk down the tree is a gather per level.

use thiserror::Error;

/// How many times a tree may halve its dimensions, leaf grids included: what a 32-bit index can address.
pub const MAX_DEPTH: usize = 24;

/// How a direction pair addresses a tree.
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
    /// `2^dimensions` child nodes that follow each other from this position. Child number `n` is in the upper half
    /// along dimension `d` where bit `d` of `n` is set.
    Branch(u32),
    /// A grid of `2^level` cells along each dimension.
    Leaf {
        /// Position of the first value. Dimension 0 varies slowest.
        first: u32,
        /// Halvings along each dimension.
        level: u32,
    },
}

/// Why nodes and values do not make a tree.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum TreeError {
    /// No node at all.
    #[error("no nodes; expected a root")]
    Empty,
    /// A branch whose children are not further along than itself, or not there.
    #[error("the children of node {node} start at {first}; expected a position after the node, and room for all")]
    Children {
        /// Position of the branch.
        node: usize,
        /// Where its children start.
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
    /// A leaf whose values are not there.
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

/// A BSDF of one side and one direction, in a tree. Values are `f` in 1/sr, without the cosine.
#[derive(Clone, Debug, PartialEq)]
pub struct TensorTree {
    rank: Rank,
    nodes: Vec<Node>,
    values: Vec<f32>,
}

impl TensorTree {
    /// Checks nodes and values and keeps them. Node 0 is the root.
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
                    if start <= node || start + children > nodes.len() {
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

    /// The value for light from `wi` to `wo`, unit vectors that point away from the surface, each on either side.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        match self.rank {
            Rank::Three => self.at(isotropic_position(wi, wo)),
            Rank::Four => {
                let ([a, b], [c, d]) = (square(-wi[0], -wi[1]), square(wo[0], wo[1]));
                self.at([a, b, c, d])
            }
        }
    }

    /// The value at a position in the unit cube; a tree of rank 3 ignores the fourth coordinate.
    fn at(&self, mut position: [f64; 4]) -> f64 {
        let dimensions = self.rank.dimensions();
        let mut node = 0;
        loop {
            match self.nodes[node] {
                Node::Branch(first) => {
                    let mut child = 0;
                    for (dimension, x) in position[..dimensions].iter_mut().enumerate() {
                        let upper = *x >= 0.5;
                        child |= usize::from(upper) << dimension;
                        *x = 2.0 * *x - f64::from(u8::from(upper));
                    }
                    node = first as usize + child;
                }
                Node::Leaf { first, level } => {
                    let cells = 1_usize << level;
                    let cell = position[..dimensions]
                        .iter()
                        .fold(0, |at, x| at * cells + ((x * cells as f64) as usize).min(cells - 1));
                    return f64::from(self.values[first as usize + cell]);
                }
            }
        }
    }
}

/// The position of a direction pair in a tree of rank 3. The exit direction is turned with the incident one onto the
/// plane of incidence; only the lower half of the radius dimension is in use, as in the files.
fn isotropic_position(wi: [f64; 3], wo: [f64; 3]) -> [f64; 4] {
    let (x, y) = (-wi[0], -wi[1]);
    let radius = x.hypot(y);
    let (cos, sin) = if radius > 0.0 { (x / radius, y / radius) } else { (1.0, 0.0) };
    let [c, d] = square(cos * wo[0] + sin * wo[1], cos * wo[1] - sin * wo[0]);
    [(0.5 - 1e-6 - 0.5 * radius).max(0.0), c, d, 0.0]
}

/// Shirley and Chiu's concentric map of the unit disk onto the unit square.
pub fn square(x: f64, y: f64) -> [f64; 2] {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
    let r = x.hypot(y).min(1.0);
    let mut phi = y.atan2(x);
    if phi < -FRAC_PI_4 {
        phi += 2.0 * PI;
    }
    let (a, b) = if phi < FRAC_PI_4 {
        (r, phi * r / FRAC_PI_4)
    } else if phi < 3.0 * FRAC_PI_4 {
        ((FRAC_PI_2 - phi) * r / FRAC_PI_4, r)
    } else if phi < 5.0 * FRAC_PI_4 {
        (-r, (PI - phi) * r / FRAC_PI_4)
    } else {
        ((phi - 3.0 * FRAC_PI_2) * r / FRAC_PI_4, -r)
    };
    [0.5 * (a + 1.0), 0.5 * (b + 1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_keeps_the_axes_and_the_diagonals() {
        let half = 0.5_f64.sqrt();
        let wanted = [
            ([0.0, 0.0], [0.5, 0.5]),
            ([1.0, 0.0], [1.0, 0.5]),
            ([0.0, 1.0], [0.5, 1.0]),
            ([-1.0, 0.0], [0.0, 0.5]),
            ([0.0, -1.0], [0.5, 0.0]),
            ([half, half], [1.0, 1.0]),
            ([-half, half], [0.0, 1.0]),
            ([-half, -half], [0.0, 0.0]),
            ([half, -half], [1.0, 0.0]),
        ];
        for ([x, y], [a, b]) in wanted {
            let [c, d] = square(x, y);
            assert!((a - c).abs() < 1e-12 && (b - d).abs() < 1e-12, "({x}, {y}) -> ({c}, {d}), not ({a}, {b})");
        }
    }

    #[test]
    fn children_and_cells_are_in_opposite_orders() {
        // The low half along dimension 0, the first child's bit 0, holds a grid; dimension 0 varies slowest in a grid.
        let mut nodes = vec![Node::Branch(1)];
        nodes.push(Node::Leaf { first: 0, level: 1 });
        nodes.extend((8..15).map(|first| Node::Leaf { first, level: 0 }));
        let tree = TensorTree::new(Rank::Three, nodes, (0..15).map(|v| v as f32).collect()).expect("a tree");
        assert_eq!(tree.at([0.3, 0.1, 0.1, 0.0]), 4.0);
        assert_eq!(tree.at([0.1, 0.1, 0.3, 0.0]), 1.0);
        assert_eq!(tree.at([0.6, 0.1, 0.1, 0.0]), 8.0);
        assert_eq!(tree.at([0.1, 0.1, 0.6, 0.0]), 11.0);
        assert_eq!(tree.at([1.0, 1.0, 1.0, 0.0]), 14.0);
    }

    #[test]
    fn trees_that_are_none_are_refused() {
        let leaf = Node::Leaf { first: 0, level: 0 };
        let new = |nodes| TensorTree::new(Rank::Three, nodes, vec![1.0]);
        assert_eq!(new(vec![]), Err(TreeError::Empty));
        assert_eq!(new(vec![Node::Branch(0)]), Err(TreeError::Children { node: 0, first: 0 }));
        assert_eq!(new(vec![Node::Branch(u32::MAX)]), Err(TreeError::Children { node: 0, first: u32::MAX }));
        assert_eq!(new(vec![leaf, leaf]), Err(TreeError::Parents { node: 1, parents: 0 }));
        assert_eq!(new(vec![Node::Leaf { first: 0, level: 1 }]), Err(TreeError::Values { node: 0 }));
        assert_eq!(new(vec![Node::Leaf { first: 0, level: 22 }]), Err(TreeError::Values { node: 0 }));
        assert_eq!(new(vec![Node::Leaf { first: 0, level: 25 }]), Err(TreeError::Depth { node: 0 }));
        assert_eq!(
            TensorTree::new(Rank::Three, vec![leaf], vec![f32::NAN]),
            Err(TreeError::ValueNotFinite { index: 0 })
        );
    }
}
