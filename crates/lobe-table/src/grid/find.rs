//! A cell in each lane, and ways to find it.

use lobe_lane::Lanes;

/// A cell in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Cell<L: Lanes> {
    /// Which cell, from 0.
    pub index: L::I,
    /// How far into it: 0 at its first knot and 1 at its second, beyond them outside the knots.
    pub fraction: L::F,
}

/// A way to find cells. Queries outside the knots belong to the outermost cells.
pub(crate) trait Find<L: Lanes>: Copy {
    /// The cell of each lane of `x`, in radians.
    fn find(self, lanes: L, x: L::F) -> Cell<L>;
}

/// Work to be done with the searcher of an axis, whichever that is.
pub(crate) trait Visitor<L: Lanes> {
    type Out;
    /// Must be `#[inline(always)]`.
    fn visit<S: Find<L>>(self, find: S) -> Self::Out;
}
