//! A descent of a search tree held in registers of sixteen floats.

use lobe_lane::{Floats, Lanes};

use super::find::{Cell, Find};
use super::tree::Tree;

/// A tree of `LEVELS` levels, and cells in `N` registers of sixteen floats.
#[derive(Clone, Copy)]
pub(crate) struct Descend<L: Lanes, const LEVELS: usize, const N: usize> {
    root: L::F,
    /// Levels two to four, five, and the two halves of six.
    knots: [L::F; 4],
    first: [L::F; N],
    inverse: [L::F; N],
    lowest: L::F,
}

impl<L: Lanes, const LEVELS: usize, const N: usize> Descend<L, LEVELS, N> {
    #[inline(always)]
    pub(crate) fn new(lanes: L, tree: &Tree) -> Self {
        let mut knots = [lanes.splat(0.0); 4];
        let mut register = 0;
        while register < 4 {
            knots[register] = lanes.load(&tree.knots[16 * register..]);
            register += 1;
        }
        let (mut first, mut inverse) = ([lanes.splat(0.0); N], [lanes.splat(0.0); N]);
        let mut register = 0;
        while register < N {
            first[register] = lanes.load(&tree.first[16 * register..]);
            inverse[register] = lanes.load(&tree.inverse[16 * register..]);
            register += 1;
        }
        Descend { root: lanes.splat(tree.knots[1]), knots, first, inverse, lowest: lanes.splat(f32::MIN) }
    }
}

impl<L: Lanes, const LEVELS: usize, const N: usize> Find<L> for Descend<L, LEVELS, N> {
    #[inline(always)]
    fn find(self, lanes: L, x: L::F) -> Cell<L> {
        // The sign of NaN means nothing; NaN counts as below all knots, as in searches that compare with the knots.
        let within = x.max(self.lowest);
        let mut node = lanes.descend(lanes.splat_int(1), within - self.root);
        let mut level = 1;
        while level < LEVELS {
            let knot = if level < 4 {
                lanes.look_up([self.knots[0]], node)
            } else if level == 4 {
                lanes.look_up([self.knots[1]], node)
            } else {
                lanes.look_up([self.knots[2], self.knots[3]], node)
            };
            node = lanes.descend(node, within - knot);
            level += 1;
        }
        let (first, inverse) = (lanes.look_up(self.first, node), lanes.look_up(self.inverse, node));
        Cell { index: node ^ lanes.splat_int((2 << LEVELS) - 1), fraction: (x - first) * inverse }
    }
}
