//! The cell of each lane, and ways to find it.

use lobe_lane::Lanes;

/// The cell of each lane.
#[derive(Clone, Copy, Debug)]
pub struct Cell<L: Lanes> {
    /// The index of the cell, from 0.
    pub index: L::I,
    /// The fraction: 0 at the first knot of the cell and 1 at the second, and beyond them outside the knots.
    pub fraction: L::F,
}

/// A way to find cells. Queries outside the knots belong to the outermost cells.
pub(crate) trait Find<L: Lanes>: Copy {
    /// The cell of each lane of `x`, in radians.
    fn find(self, lanes: L, x: L::F) -> Cell<L>;
}

/// Work to be done with the searcher of an axis, of whatever type.
pub(crate) trait Visitor<L: Lanes> {
    type Out;
    /// Must be `#[inline(always)]`.
    fn visit<S: Find<L>>(self, find: S) -> Self::Out;
}
