//! A search tree for registers of sixteen floats.

/// The largest number of cells.
pub(crate) const MAX_CELLS: usize = 64;

/// Stands for a knot that does not exist: every query is below it.
const BEYOND: f32 = f32::INFINITY;

/// Up to 63 inner knots in the order of a breadth-first search, and the cells that they lead to.
///
/// The tree is mirrored: if a query is below the knot of node `n`, it continues at node `2 n + 1`, otherwise at `2 n`.
/// So a step needs only the sign bit of the difference between query and knot, and after the last step the node gives
/// the number of cells *above* the query's cell.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub(crate) levels: usize,
    /// The knot of node `n` at index `n`, starting with the root, 1.
    pub(crate) knots: [f32; 64],
    /// The first knot and the inverse width of the cell of last node `n`, indexed by the low bits of `n`: four of them,
    /// as a table in registers uses, or one per level if that is more.
    pub(crate) first: [f32; 64],
    pub(crate) inverse: [f32; 64],
}

impl Tree {
    /// The tree of all but the outermost knots, and of the first knots and inverse widths of the cells.
    pub(crate) fn new(knots: &[f32], cells: &[[f32; 2]]) -> Self {
        let inner = &knots[1..knots.len() - 1];
        let levels = (cells.len().next_power_of_two().ilog2() as usize).max(3);
        let mut tree = Tree { levels, knots: [BEYOND; 64], first: [0.0; 64], inverse: [0.0; 64] };
        for (node, knot) in tree.knots.iter_mut().enumerate().take(1 << levels).skip(1) {
            let level = node.ilog2() as usize;
            // The last node of a level is the middle of the first part into which the level divides the knots.
            let part = 1 << (levels - level);
            let rank = ((2 << level) - 1 - node) * part + part / 2 - 1;
            // Avoids the difference of zeros of different signs, which would have a sign.
            *knot = inner.get(rank).map_or(BEYOND, |&knot| if knot == 0.0 { -0.0 } else { knot });
        }
        let last_nodes = 1 << levels;
        for above in 0..last_nodes {
            let cell = cells[(last_nodes - 1 - above).min(cells.len() - 1)];
            let at = (last_nodes + above) % last_nodes.max(16);
            [tree.first[at], tree.inverse[at]] = cell;
        }
        tree
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The descent in plain numbers.
    fn cell(tree: &Tree, x: f32) -> (usize, [f32; 2]) {
        let mut node = 1;
        for _ in 0..tree.levels {
            node = 2 * node + usize::from((x - tree.knots[node]).is_sign_negative());
        }
        let at = node % (1 << tree.levels.max(4));
        ((2 << tree.levels) - 1 - node, [tree.first[at], tree.inverse[at]])
    }

    #[test]
    fn queries_reach_their_cells() {
        for count in 1..=MAX_CELLS {
            // Zero is a knot of every other axis.
            let knots: Vec<f32> = (0..=count).map(|i| (i * i) as f32 - (count % 2 * 9) as f32).collect();
            let cells: Vec<[f32; 2]> = knots.windows(2).map(|ends| [ends[0], 1.0 / (ends[1] - ends[0])]).collect();
            let tree = Tree::new(&knots, &cells);
            let around = knots.iter().flat_map(|&knot| [knot.next_down(), knot, knot.next_up()]);
            for x in around.chain([-0.0, 0.0, f32::MIN, f32::MAX, f32::NEG_INFINITY]) {
                let expected = knots[1..count].partition_point(|&knot| knot <= x);
                assert_eq!(cell(&tree, x), (expected, cells[expected]), "{x} among {count} cells");
            }
        }
    }
}
