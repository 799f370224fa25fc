//! From two children a node to `W`.

use super::{Binary, Child, Node, WideBvh};
use crate::Aabb;

impl<const W: usize> WideBvh<W> {
    /// Opens the child of the largest surface until a node has `W` of them (Wald, Benthin, Boulos 2008). `emit` makes
    /// the leaf of a run of primitives. Nodes lie in the order of a depth-first walk, a subtree in one piece.
    pub(crate) fn collapse(binary: &Binary, mut emit: impl FnMut(&[u32]) -> Child) -> Self {
        const { assert!(W == 4 || W == 8, "nodes have 4 or 8 children") };
        let Some(root) = binary.nodes.first() else {
            return WideBvh { nodes: vec![Node::EMPTY], bounds: Aabb::EMPTY, stack: W };
        };
        let mut nodes: Vec<Node<W>> = Vec::with_capacity(binary.nodes.len() / W + 1);
        let mut waiting = vec![Waiting { at: 0, depth: 1, parent: 0, slot: 0 }];
        let mut deepest = 1;
        while let Some(Waiting { at, depth, parent, slot }) = waiting.pop() {
            deepest = deepest.max(depth);
            let index = nodes.len();
            // The root has no parent, and is no node yet.
            if let Some(parent) = nodes.get_mut(parent) {
                parent.children[slot] = Child::node(index);
            }
            let mut node = Node::EMPTY;
            let (open, count) = widen::<W>(binary, at);
            for &child in open[..count].iter().rev() {
                let source = binary.nodes[child];
                let reference = if source.count > 0 {
                    emit(&binary.order[source.first..source.first + source.count])
                } else {
                    waiting.push(Waiting { at: child, depth: depth + 1, parent: index, slot: node.count });
                    Child::node(0)
                };
                node.push(source.bounds, reference);
            }
            nodes.push(node);
        }
        WideBvh { nodes, bounds: root.bounds, stack: deepest * (W - 1) + 1 }
    }
}

/// A binary node that is to become a wide one, and the slot of the parent that is to refer to it.
struct Waiting {
    at: usize,
    depth: usize,
    parent: usize,
    slot: usize,
}

/// The up to `W` binary nodes that become the children of a wide one.
fn widen<const W: usize>(binary: &Binary, at: usize) -> ([usize; W], usize) {
    let mut open = [at; W];
    let mut count = 1;
    while count < W {
        let inner = |&slot: &usize| binary.nodes[open[slot]].count == 0;
        let area = |slot: &usize| binary.nodes[open[*slot]].bounds.half_area();
        let widest = (0..count).filter(inner).max_by(|a, b| area(a).total_cmp(&area(b)));
        let Some(slot) = widest else { break };
        let first = binary.nodes[open[slot]].first;
        open[slot] = first;
        open[count] = first + 1;
        count += 1;
    }
    (open, count)
}
