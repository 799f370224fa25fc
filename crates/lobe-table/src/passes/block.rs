//! A block of queries, and the columns passed from one pass to the next.

use lobe_lane::Lanes;

/// Queries per block: enough to keep the core busy within a pass, few enough that all columns stay in the first-level
/// cache.
pub(crate) const BLOCK: usize = 128;

/// The number of queries of a block in whole registers. It is never more than a block holds; stating this keeps the
/// compiler from masking positions, and lets it join the single lanes of the scalar backend.
#[inline(always)]
pub(crate) fn registers<L: Lanes>(_lanes: L, queries: usize) -> usize {
    queries.next_multiple_of(L::LANES).min(BLOCK)
}

/// One float for each query of a block; or for each lane, if a caller's kernel has no more queries than that.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Column<T = f32, const B: usize = BLOCK>(pub(crate) [T; B]);

impl<const B: usize> Column<f32, B> {
    pub(crate) const ZERO: Self = Column([0.0; B]);

    // Masking the position costs nothing in a loop and lets the compiler drop the bounds check.
    #[inline(always)]
    pub(crate) fn load<L: Lanes>(&self, lanes: L, at: usize) -> L::F {
        lanes.load(&self.0[at & (B - L::LANES)..][..L::LANES])
    }
    #[inline(always)]
    pub(crate) fn store<L: Lanes>(&mut self, lanes: L, at: usize, x: L::F) {
        lanes.store(&mut self.0[at & (B - L::LANES)..][..L::LANES], x);
    }
    #[inline(always)]
    pub(crate) fn one(&self, query: usize) -> f32 {
        self.0[query & (B - 1)]
    }
}

impl<const B: usize> Column<i32, B> {
    pub(crate) const ZERO: Self = Column([0; B]);

    #[inline(always)]
    pub(crate) fn load<L: Lanes>(&self, lanes: L, at: usize) -> L::I {
        lanes.load_int(&self.0[at & (B - L::LANES)..][..L::LANES])
    }
    #[inline(always)]
    pub(crate) fn store<L: Lanes>(&mut self, lanes: L, at: usize, x: L::I) {
        lanes.store_int(&mut self.0[at & (B - L::LANES)..][..L::LANES], x);
    }
    /// One float per lane, in memory.
    #[inline(always)]
    pub(crate) fn slice<L: Lanes>(&self, _lanes: L, at: usize) -> &[i32] {
        &self.0[at & (B - L::LANES)..][..L::LANES]
    }
    #[inline(always)]
    pub(crate) fn one(&self, query: usize) -> i32 {
        self.0[query & (B - 1)]
    }
}
