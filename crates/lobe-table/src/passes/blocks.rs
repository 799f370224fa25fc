//! Work on many queries, block by block.

use std::ops::Range;

use lobe_lane::{Kernel, Lanes};

use super::block::BLOCK;

/// Work on many queries that is done block by block.
pub(crate) trait Blockwise {
    /// The intermediate values of its passes.
    type Scratch;
    /// The scratch before the first block.
    const SCRATCH: Self::Scratch;

    /// The number of queries.
    fn count(&self) -> usize;

    /// Processes `queries`: a full block, or the last ones. Must be `#[inline(always)]`.
    fn block<L: Lanes>(&mut self, lanes: L, queries: Range<usize>, scratch: &mut Self::Scratch);
}

/// All blocks of such work, as a kernel.
pub(crate) struct Blocks<W>(pub(crate) W);

impl<W: Blockwise> Kernel for Blocks<W> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Blocks(mut work) = self;
        let count = work.count();
        let mut scratch = W::SCRATCH;
        let mut at = 0;
        while at < count {
            let end = count.min(at + BLOCK);
            work.block(lanes, at..end, &mut scratch);
            at = end;
        }
    }
}
