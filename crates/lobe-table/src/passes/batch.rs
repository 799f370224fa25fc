//! A batch of pairs of directions, block by block, for the representations that have no more to it.

use lobe_lane::{Kernel, Lanes};

use super::block::BLOCK;
use crate::directions::{DirectionBlock, Directions, PADDING};

/// What evaluates a block of pairs.
pub(crate) trait Blockwise: Copy {
    /// What its passes hand on.
    type Scratch;
    /// The scratch before the first block.
    const SCRATCH: Self::Scratch;

    /// Values per pair.
    fn channel_count(self) -> usize;

    /// Evaluates queries `0..count` of a block into `out`, `[query][channel]`. Must be `#[inline(always)]`.
    fn block<L: Lanes>(
        self,
        lanes: L,
        count: usize,
        directions: (DirectionBlock<'_>, DirectionBlock<'_>),
        scratch: &mut Self::Scratch,
        out: &mut [f32],
    );
}

/// All queries of a batch.
pub(crate) struct Batch<'a, E> {
    evaluator: E,
    wi: Directions<'a>,
    wo: Directions<'a>,
    out: &'a mut [f32],
}

impl<'a, E: Blockwise> Batch<'a, E> {
    /// # Panics
    /// If there are not as many `wi` as `wo`, or `out` is not that many times the channels long.
    pub(crate) fn new(evaluator: E, wi: Directions<'a>, wo: Directions<'a>, out: &'a mut [f32]) -> Self {
        assert_eq!(wi.count(), wo.count(), "as many wi as wo");
        assert_eq!(out.len(), wi.count() * evaluator.channel_count(), "one output per query and channel");
        Batch { evaluator, wi, wo, out }
    }
}

impl<E: Blockwise> Kernel for Batch<'_, E> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Batch { evaluator, wi, wo, out } = self;
        let channels = evaluator.channel_count();
        let count = wi.count();
        let mut scratch = E::SCRATCH;
        let mut padding = (PADDING, PADDING);
        let mut at = 0;
        while at < count {
            let left = (count - at).min(BLOCK);
            let block = (wi.block(at, &mut padding.0), wo.block(at, &mut padding.1));
            evaluator.block(lanes, left, block, &mut scratch, &mut out[at * channels..][..left * channels]);
            at += left;
        }
    }
}
