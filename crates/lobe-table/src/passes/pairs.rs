//! Pairs of directions, and the values of many of them.

use std::ops::Range;

use lobe_lane::{Floats, Kernel, Lanes, MAX_LANES};

use super::block::{BLOCK, registers};
use super::blocks::{Blocks, Blockwise};
use crate::directions::{DirectionBlock, Directions, PADDING, Padding};

/// A block of pairs of directions.
#[derive(Clone, Copy)]
pub(crate) struct Pairs<'a, const B: usize = BLOCK> {
    pub(crate) wi: DirectionBlock<'a, B>,
    pub(crate) wo: DirectionBlock<'a, B>,
}

/// Space for the pairs of a block that is copied.
pub(crate) struct PairPadding {
    wi: Padding,
    wo: Padding,
}

impl PairPadding {
    pub(crate) const ZERO: Self = PairPadding { wi: PADDING, wo: PADDING };

    /// The block of pairs that starts at `at`.
    #[inline(always)]
    pub(crate) fn block<'a, L: Lanes>(
        &'a mut self,
        lanes: L,
        wi: &'a Directions<'_>,
        wo: &'a Directions<'_>,
        at: usize,
    ) -> Pairs<'a> {
        Pairs { wi: wi.block(lanes, at, &mut self.wi), wo: wo.block(lanes, at, &mut self.wo) }
    }
}

/// One pair per lane, held in registers by the caller's kernel.
pub(crate) struct LanePairs {
    wi: [[f32; MAX_LANES]; 3],
    wo: [[f32; MAX_LANES]; 3],
}

impl LanePairs {
    /// Lanes that `mask` leaves out get directions of no length, which have no value.
    #[inline(always)]
    pub(crate) fn new<L: Lanes>(lanes: L, wi: [L::F; 3], wo: [L::F; 3], mask: L::M) -> Self {
        let mut pairs = LanePairs { wi: [[0.0; MAX_LANES]; 3], wo: [[0.0; MAX_LANES]; 3] };
        let mut k = 0;
        while k < 3 {
            lanes.store(&mut pairs.wi[k], wi[k].masked(mask));
            lanes.store(&mut pairs.wo[k], wo[k].masked(mask));
            k += 1;
        }
        pairs
    }

    #[inline(always)]
    pub(crate) fn block(&self) -> Pairs<'_, MAX_LANES> {
        let ([ix, iy, iz], [ox, oy, oz]) = (&self.wi, &self.wo);
        Pairs { wi: DirectionBlock::of_columns([ix, iy, iz]), wo: DirectionBlock::of_columns([ox, oy, oz]) }
    }
}

/// Anything with values for pairs of directions.
pub(crate) trait Evaluate: Copy {
    /// The intermediate values of its passes.
    type Scratch;
    /// The scratch before the first block.
    const SCRATCH: Self::Scratch;

    /// The number of values per pair.
    fn channel_count(self) -> usize;

    /// Evaluates the first pairs of a block, as many as fit into `out`: `[query][channel]`. `n` is their number
    /// rounded up to the lanes. Must be `#[inline(always)]`.
    fn evaluate<L: Lanes>(self, lanes: L, n: usize, pairs: Pairs<'_>, scratch: &mut Self::Scratch, out: &mut [f32]);
}

/// The evaluation of a batch.
pub(crate) struct Evaluation<'a, E> {
    evaluator: E,
    wi: Directions<'a>,
    wo: Directions<'a>,
    out: &'a mut [f32],
}

/// The evaluation of many pairs: `out[query * channels + channel]`.
///
/// # Panics
/// If the numbers of `wi` and `wo` differ, or the length of `out` is not that number times the number of channels.
pub(crate) fn evaluation<'a, E: Evaluate + 'a>(
    evaluator: E,
    wi: Directions<'a>,
    wo: Directions<'a>,
    out: &'a mut [f32],
) -> impl Kernel<Out = ()> + 'a {
    assert_eq!(wi.count(), wo.count(), "as many wi as wo");
    assert_eq!(out.len(), wi.count() * evaluator.channel_count(), "one output per query and channel");
    Blocks(Evaluation { evaluator, wi, wo, out })
}

/// The intermediate values of passes over pairs, and space for the last pairs.
pub(crate) struct PairScratch<S> {
    pub(crate) passes: S,
    pub(crate) padding: PairPadding,
}

impl<E: Evaluate> Blockwise for Evaluation<'_, E> {
    type Scratch = PairScratch<E::Scratch>;
    const SCRATCH: Self::Scratch = PairScratch { passes: E::SCRATCH, padding: PairPadding::ZERO };

    fn count(&self) -> usize {
        self.wi.count()
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, lanes: L, queries: Range<usize>, scratch: &mut Self::Scratch) {
        let channels = self.evaluator.channel_count();
        let pairs = scratch.padding.block(lanes, &self.wi, &self.wo, queries.start);
        let n = registers(lanes, queries.len());
        let out = &mut self.out[queries.start * channels..][..queries.len() * channels];
        self.evaluator.evaluate(lanes, n, pairs, &mut scratch.passes, out);
    }
}
