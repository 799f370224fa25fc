//! Samples, densities and brightnesses of many directions.

use std::ops::Range;

use lobe_backend::Backend;
use lobe_lane::{Kernel, Lanes, call};

use super::block;
use super::distribution::Distribution;
use super::incident::Incident;
use super::places::{Places, place};
use super::queries::{Brightnesses, Densities, Draws};
use crate::directions::{DirectionBlock, PADDING, Padding};
use crate::passes::block::{BLOCK, registers};
use crate::passes::blocks::{Blocks, Blockwise};
use crate::passes::pairs::{PairPadding, Pairs};

impl Distribution {
    /// Draws a scattered direction and its density for each known direction, from two numbers in `[0, 1)`; zeros if the
    /// known direction is not above the surface.
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn draw_batch(
        &self,
        backend: Backend,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        directions: &mut [[f32; 3]],
        pdfs: &mut [f32],
    ) {
        backend.run(self.drawing(known, u, directions, pdfs));
    }

    /// The sampling of many directions as a kernel, for lanes that are not a [`Backend`] (see
    /// [`draw_batch`](Self::draw_batch)).
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn drawing<'a>(
        &'a self,
        known: &'a [[f32; 3]],
        u: &'a [[f32; 2]],
        directions: &'a mut [[f32; 3]],
        pdfs: &'a mut [f32],
    ) -> impl Kernel<Out = ()> + 'a {
        Blocks(Draws::new(self, known, u, directions, pdfs))
    }

    /// The density of each of the `other` directions given the known one; 0 if one of them is not above the surface.
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn pdf_batch(&self, backend: Backend, known: &[[f32; 3]], other: &[[f32; 3]], pdfs: &mut [f32]) {
        backend.run(self.densities(known, other, pdfs));
    }

    /// The densities of many pairs as a kernel, for lanes that are not a [`Backend`] (see
    /// [`pdf_batch`](Self::pdf_batch)).
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn densities<'a>(
        &'a self,
        known: &'a [[f32; 3]],
        other: &'a [[f32; 3]],
        pdfs: &'a mut [f32],
    ) -> impl Kernel<Out = ()> + 'a {
        Blocks(Densities::new(self, known, other, pdfs))
    }

    /// The brightness of the surface for light from each known direction: the integral of luminance times `f` times
    /// cosine, interpolated between the slices; 0 if the direction is not above the surface.
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn brightness_batch(&self, backend: Backend, known: &[[f32; 3]], out: &mut [f32]) {
        backend.run(self.brightnesses(known, out));
    }

    /// The brightness for many directions as a kernel, for lanes that are not a [`Backend`] (see
    /// [`brightness_batch`](Self::brightness_batch)).
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn brightnesses<'a>(&'a self, known: &'a [[f32; 3]], out: &'a mut [f32]) -> impl Kernel<Out = ()> + 'a {
        Blocks(Brightnesses::new(self, known, out))
    }
}

/// The intermediate values of sampling.
pub(super) struct DrawScratch {
    passes: block::Scratch,
    places: Places,
    padding: Padding,
}

impl Blockwise for Draws<'_, Distribution> {
    type Scratch = DrawScratch;
    const SCRATCH: DrawScratch = DrawScratch { passes: block::Scratch::ZERO, places: Places::ZERO, padding: PADDING };

    fn count(&self) -> usize {
        self.u.len()
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, lanes: L, queries: Range<usize>, scratch: &mut DrawScratch) {
        let Draws { sampler: distribution, known, u, directions, pdfs } = self;
        let DrawScratch { passes, places, padding } = scratch;
        let known = known.block(lanes, queries.start, padding);
        call(lanes, Locate { distribution, known, count: queries.len(), places: &mut *places });
        let input = block::Input { known, u: &u[queries.clone()], places };
        let out = block::Out { directions: &mut directions[queries.clone()], pdfs: &mut pdfs[queries] };
        match distribution.slices.width {
            2 => block::draw(lanes, distribution, &distribution.slices.pairs(), input, passes, out),
            _ => block::draw(lanes, distribution, &distribution.slices.quads(), input, passes, out),
        }
    }
}

impl Blockwise for Densities<'_, Distribution> {
    type Scratch = PairPadding;
    const SCRATCH: PairPadding = PairPadding::ZERO;

    fn count(&self) -> usize {
        self.pdfs.len()
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, lanes: L, queries: Range<usize>, padding: &mut PairPadding) {
        let Densities { sampler: distribution, known, other, pdfs } = self;
        let Distribution { surface, sigma, psi, .. } = distribution;
        let Pairs { wi: known, wo: other } = padding.block(lanes, known, other, queries.start);
        let (at, count) = (queries.start, queries.len().min(BLOCK));
        let mut query = 0;
        while query < count {
            let incident = Incident::new(lanes, surface, known.load(lanes, query));
            let place = place(lanes, sigma, psi.as_ref(), &incident);
            let local = incident.locate(lanes, other.load(lanes, query));
            let density = distribution.density(lanes, &place, local);
            lanes.store_partial(&mut pdfs[at + query..at + count], density);
            query += L::LANES;
        }
    }
}

/// The intermediate values of brightnesses.
pub(super) struct BrightnessScratch {
    places: Places,
    padding: Padding,
}

impl Blockwise for Brightnesses<'_, Distribution> {
    type Scratch = BrightnessScratch;
    const SCRATCH: BrightnessScratch = BrightnessScratch { places: Places::ZERO, padding: PADDING };

    fn count(&self) -> usize {
        self.out.len()
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, lanes: L, queries: Range<usize>, scratch: &mut BrightnessScratch) {
        let Brightnesses { sampler: distribution, known, out } = self;
        let BrightnessScratch { places, padding } = scratch;
        let known = known.block(lanes, queries.start, padding);
        call(lanes, Locate { distribution, known, count: queries.len(), places: &mut *places });
        let (at, count) = (queries.start, queries.len().min(BLOCK));
        let mut query = 0;
        while query < count {
            let incident = Incident::new(lanes, &distribution.surface, known.load(lanes, query));
            let brightness = distribution.brightness(lanes, &places.load(lanes, query), incident.valid);
            lanes.store_partial(&mut out[at + query..at + count], brightness);
            query += L::LANES;
        }
    }
}

/// Finds the slices of a block. Sampling and brightnesses call this kernel, so that it is compiled once; densities need
/// its intermediate results, and repeat it.
struct Locate<'a> {
    distribution: &'a Distribution,
    known: DirectionBlock<'a>,
    count: usize,
    places: &'a mut Places,
}

impl Kernel for Locate<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Locate { distribution: Distribution { surface, sigma, psi, .. }, known, count, places } = self;
        let count = registers(lanes, count);
        let mut query = 0;
        while query < count {
            let incident = Incident::new(lanes, surface, known.load(lanes, query));
            places.store(lanes, query, place(lanes, sigma, psi.as_ref(), &incident));
            query += L::LANES;
        }
    }
}
