//! Values and densities of many pairs of directions.

use std::ops::Range;

use lobe_backend::Backend;
use lobe_lane::{Kernel, Lanes, call};

use super::passes::{Scratch, Values};
use super::table::Table;
use crate::directions::Directions;
use crate::passes::block::registers;
use crate::passes::blocks::{Blocks, Blockwise};
use crate::passes::pairs::{PairPadding, PairScratch};

/// The quantities to compute for each pair of directions, and their outputs.
#[derive(Debug)]
pub enum Wanted<'a> {
    /// `f` in 1/sr, without the cosine: `[query][channel]`.
    Values(&'a mut [f32]),
    /// `f cos(theta_o)` in 1/sr: `[query][channel]`.
    ValuesCos(&'a mut [f32]),
    /// The density of sampling `wo` for a `wi`, 1/sr, one per query.
    Pdf(&'a mut [f32]),
    /// `f`, and the density.
    ValuesAndPdf(&'a mut [f32], &'a mut [f32]),
    /// `f cos(theta_o)`, and the density.
    ValuesCosAndPdf(&'a mut [f32], &'a mut [f32]),
}

impl<'a> Wanted<'a> {
    fn parts(self) -> Parts<'a> {
        match self {
            Wanted::Values(values) => Parts { values: Some(values), cosine: false, pdf: None },
            Wanted::ValuesCos(values) => Parts { values: Some(values), cosine: true, pdf: None },
            Wanted::Pdf(pdf) => Parts { values: None, cosine: true, pdf: Some(pdf) },
            Wanted::ValuesAndPdf(values, pdf) => Parts { values: Some(values), cosine: false, pdf: Some(pdf) },
            Wanted::ValuesCosAndPdf(values, pdf) => Parts { values: Some(values), cosine: true, pdf: Some(pdf) },
        }
    }
}

/// The requested quantities, one by one.
struct Parts<'a> {
    values: Option<&'a mut [f32]>,
    /// `true` if values keep the cosine.
    cosine: bool,
    pdf: Option<&'a mut [f32]>,
}

impl Table {
    /// Evaluates `f` in 1/sr of many pairs on a backend: `out[query * channels + channel]`.
    ///
    /// # Panics
    /// If the numbers of `wi` and `wo` differ, or the length of `out` is not that number times the number of channels.
    pub fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.evaluate(backend, wi, wo, Wanted::Values(out));
    }

    /// The density over solid angle, 1/sr, with which `wo` is sampled for `wi`, for many pairs on a backend.
    ///
    /// # Panics
    /// If the lengths of `wi`, `wo` and `out` differ.
    pub fn pdf_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.evaluate(backend, wi, wo, Wanted::Pdf(out));
    }

    /// Evaluates `f` in 1/sr of one pair into `out`, one value per channel, on a backend.
    ///
    /// # Panics
    /// If the length of `out` is not the number of channels.
    pub fn eval(&self, backend: Backend, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        self.eval_batch(backend.narrow(), (&[wi]).into(), (&[wo]).into(), out);
    }

    /// Evaluates the wanted quantities for many pairs on a backend. Computing values and densities together takes less
    /// time than one after the other.
    ///
    /// # Panics
    /// The same as for [`batch`](Self::batch).
    pub fn evaluate(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, wanted: Wanted<'_>) {
        backend.run(self.batch(wi, wo, wanted));
    }

    /// The evaluation of many pairs as a kernel, for lanes that are not a [`Backend`].
    ///
    /// # Panics
    /// If the numbers of `wi` and `wo` differ, or a slice in `wanted` does not have the required length.
    pub fn batch<'a>(
        &'a self,
        wi: Directions<'a>,
        wo: Directions<'a>,
        wanted: Wanted<'a>,
    ) -> impl Kernel<Out = ()> + 'a {
        let (wanted, count) = (wanted.parts(), wi.count());
        assert_eq!(count, wo.count(), "as many wi as wo");
        if let Some(values) = &wanted.values {
            assert_eq!(values.len(), count * self.channel_count(), "one value per query and channel");
        }
        if let Some(pdf) = &wanted.pdf {
            assert_eq!(pdf.len(), count, "one density per query");
        }
        Evaluation { table: self, wi, wo, wanted }
    }
}

/// All queries of a batch, with blends of `SLICES`: `PAIRS` corners of a cell in one dimension, and `FOURS` in two.
struct Batch<'a, const SLICES: usize, const PAIRS: usize, const FOURS: usize> {
    table: &'a Table,
    wi: Directions<'a>,
    wo: Directions<'a>,
    wanted: Parts<'a>,
}

impl<const SLICES: usize, const PAIRS: usize, const FOURS: usize> Blockwise for Batch<'_, SLICES, PAIRS, FOURS> {
    type Scratch = PairScratch<Scratch>;
    const SCRATCH: Self::Scratch = PairScratch { passes: Scratch::ZERO, padding: PairPadding::ZERO };

    fn count(&self) -> usize {
        self.wi.count()
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, lanes: L, queries: Range<usize>, scratch: &mut Self::Scratch) {
        let PairScratch { passes: scratch, padding } = scratch;
        let Batch { table, wi, wo, wanted: Parts { values, cosine, pdf } } = self;
        let (at, left, channels) = (queries.start, queries.len(), table.channel_count());
        let n = registers(lanes, left);
        table.locate::<L, SLICES>(lanes, n, padding.block(lanes, wi, wo, at), *cosine, scratch);
        if let Some(values) = values {
            let out = &mut values[at * channels..][..left * channels];
            call(lanes, Values::<SLICES, PAIRS, FOURS> { table, n, scratch: &mut *scratch, out });
        }
        if let Some(pdf) = pdf {
            table.density::<L, SLICES>(lanes, n, scratch);
            pdf[at..][..left].copy_from_slice(&scratch.density.0[..left]);
        }
    }
}

/// The kernel for the slices that a table blends.
struct Evaluation<'a> {
    table: &'a Table,
    wi: Directions<'a>,
    wo: Directions<'a>,
    wanted: Parts<'a>,
}

impl Kernel for Evaluation<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Evaluation { table, wi, wo, wanted } = self;
        if table.blends_azimuths() {
            Blocks(Batch::<4, 8, 16> { table, wi, wo, wanted }).run(lanes);
        } else {
            Blocks(Batch::<2, 4, 8> { table, wi, wo, wanted }).run(lanes);
        }
    }
}
