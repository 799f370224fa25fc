//! From two children per node to `W`.

use std::ops::Range;

use lobe_memory::Storage;

use super::{Binary, Child, Node, WideBvh};
use crate::Aabb;

impl<const W: usize> WideBvh<W> {
    /// Builds the wide tree of least cost with up to `leaf` primitives per leaf. `emit` makes a leaf from a range of
    /// primitives in the binary tree's order. Nodes are in the order of a depth-first walk, each subtree in one piece.
    pub(crate) fn collapse(binary: &Binary, leaf: usize, mut emit: impl FnMut(Range<usize>) -> Child) -> Self {
        const { assert!(W == 4 || W == 8, "nodes have 4 or 8 children") };
        let Some(root) = binary.nodes.first() else {
            return WideBvh { nodes: Storage::copied(&[Node::EMPTY]), bounds: Aabb::EMPTY, stack: W };
        };
        let plans = plans::<W>(binary, leaf);
        let mut nodes: Vec<Node<W>> = Vec::with_capacity(binary.order.len() / W + 1);
        let mut waiting = vec![Waiting { at: 0, beside: 0, parent: 0, slot: 0 }];
        let mut most = 0;
        while let Some(Waiting { at, beside, parent, slot }) = waiting.pop() {
            let index = nodes.len();
            // The root has no parent, and is not a node yet.
            if let Some(parent) = nodes.get_mut(parent) {
                parent.refer(slot, Child::node(index));
            }
            let mut node = Node::EMPTY;
            let (children, count) = widen::<W>(binary, &plans, at);
            most = most.max(beside + count);
            for (slot, &child) in children[..count].iter().rev().enumerate() {
                let source = &binary.nodes[child];
                let reference = if plans[child].is_leaf() {
                    emit(source.members())
                } else {
                    waiting.push(Waiting { at: child, beside: beside + count - 1, parent: index, slot });
                    Child::node(0)
                };
                node.set(slot, source.bounds, reference);
            }
            nodes.push(node);
        }
        WideBvh { nodes: Storage::copied(&nodes), bounds: root.bounds, stack: most + 1 }
    }
}

/// The cost of a visit to a leaf, in visits to nodes.
const LEAF_COST: f32 = 1.5;

/// A binary node that is to become a wide one, and the slot of the parent that is to refer to it.
struct Waiting {
    at: usize,
    /// The most nodes that may wait while it is visited.
    beside: usize,
    parent: usize,
    slot: usize,
}

/// The plan for a binary subtree: whether it is best as a leaf, and how its two children share `k` roots if it may
/// become up to `k` subtrees of the wide tree, 4 bits for each `k`. Zero: it is better as one subtree.
#[derive(Clone, Copy, Default)]
struct Plan(u32);

impl Plan {
    const LEAF: Self = Plan(1);

    fn is_leaf(self) -> bool {
        self.0 & 1 != 0
    }

    fn set(&mut self, roots: usize, share: usize) {
        self.0 |= (share as u32) << (4 * roots - 4);
    }

    fn share(self, roots: usize) -> usize {
        if roots < 2 { 0 } else { (self.0 >> (4 * roots - 4) & 15) as usize }
    }
}

/// The plans of least cost (Ylitie, Karras, Laine 2017): the probability that a ray visits a node or a leaf is
/// proportional to its surface area.
fn plans<const W: usize>(binary: &Binary, leaf: usize) -> Vec<Plan> {
    let mut plans = vec![Plan::default(); binary.nodes.len()];
    // Costs of subtrees whose parents have not been visited, `[k - 1]` for at most `k` roots. Children come before
    // their parents, second children before first ones.
    let mut waiting: Vec<[f32; W]> = Vec::new();
    for (node, plan) in binary.nodes.iter().zip(&mut plans).rev() {
        let surface = node.bounds.half_area();
        let whole = LEAF_COST * surface;
        if node.is_single() {
            *plan = Plan::LEAF;
            waiting.push([whole; W]);
            continue;
        }
        let (Some(one), Some(other)) = (waiting.pop(), waiting.pop()) else { break };
        let mut own = [f32::INFINITY; W];
        // No more roots than primitives: for small subtrees, which are the majority, there is little to compare.
        let most = node.count().min(W);
        for roots in 2..=most {
            let mut best = 1;
            for share in 1..roots {
                let cost = one[share - 1] + other[roots - share - 1];
                if cost < own[roots - 1] {
                    (own[roots - 1], best) = (cost, share);
                }
            }
            plan.set(roots, best);
        }
        for roots in most + 1..=W {
            own[roots - 1] = own[most - 1];
            plan.set(roots, plan.share(most));
        }
        own[0] = own[W - 1] + surface;
        if node.count() <= leaf && whole <= own[0] {
            own[0] = whole;
            plan.0 |= 1;
        }
        for roots in 2..W {
            if own[0] < own[roots - 1] {
                own[roots - 1] = own[0];
                plan.0 &= !(15 << (4 * roots - 4));
            }
        }
        waiting.push(own);
    }
    plans
}

/// The up to `W` binary nodes that become the children of a wide one.
fn widen<const W: usize>(binary: &Binary, plans: &[Plan], at: usize) -> ([usize; W], usize) {
    let (mut children, mut count) = ([at; W], 0);
    // Subtrees, and the number of roots that they may have, at least one each.
    let (mut waiting, mut left) = ([(at, W); W], 1);
    while left > 0 {
        left -= 1;
        let (subtree, roots) = waiting[left];
        let share = plans[subtree].share(roots);
        if share == 0 {
            children[count] = subtree;
            count += 1;
        } else {
            let node = &binary.nodes[subtree];
            waiting[left] = (subtree + 1, share);
            waiting[left + 1] = (node.second(), roots - share);
            left += 2;
        }
    }
    (children, count)
}
