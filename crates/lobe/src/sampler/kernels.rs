//! Batches as kernels, for the backend that is found when the program runs.

use std::sync::Arc;

use lobe_lane::{Kernel, Lanes};
use lobe_table::{
    Distribution, DistributionError, DistributionOptions, Given, Sampled, Sampler, SamplerError, SamplerOptions, Table,
};

pub(super) struct BuildTable<'a> {
    pub(super) table: Arc<Table>,
    pub(super) options: &'a SamplerOptions,
    pub(super) progress: &'a mut dyn FnMut(usize, usize),
}

impl Kernel for BuildTable<'_> {
    type Out = Result<Sampler, SamplerError>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Self::Out {
        Sampler::with_progress(lanes, self.table, self.options, self.progress)
    }
}

pub(super) struct SampleTable<'a> {
    pub(super) sampler: &'a Sampler,
    pub(super) given: Given,
    pub(super) directions: &'a [[f32; 3]],
    pub(super) u: &'a [[f32; 2]],
    pub(super) out: Sampled<'a>,
}

impl Kernel for SampleTable<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let SampleTable { sampler, given, directions, u, out } = self;
        sampler.sample_batch(lanes, given, directions, u, out);
    }
}

pub(super) struct PdfTable<'a> {
    pub(super) sampler: &'a Sampler,
    pub(super) given: Given,
    pub(super) wi: &'a [[f32; 3]],
    pub(super) wo: &'a [[f32; 3]],
    pub(super) pdfs: &'a mut [f32],
}

impl Kernel for PdfTable<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let PdfTable { sampler, given, wi, wo, pdfs } = self;
        sampler.pdf_batch(lanes, given, wi, wo, pdfs);
    }
}

pub(super) struct BuildDistribution<'a, F> {
    pub(super) options: &'a DistributionOptions,
    pub(super) light: F,
    pub(super) progress: &'a mut dyn FnMut(usize, usize),
}

impl<F: FnMut(&[[f32; 3]], &[[f32; 3]], &mut [f32])> Kernel for BuildDistribution<'_, F> {
    type Out = Result<Distribution, DistributionError>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Self::Out {
        Distribution::of_function(lanes, self.options, self.light, self.progress)
    }
}

pub(super) struct Brighten<'a> {
    pub(super) distribution: &'a Distribution,
    pub(super) known: &'a [[f32; 3]],
    pub(super) out: &'a mut [f32],
}

impl Kernel for Brighten<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        self.distribution.brightness_batch(lanes, self.known, self.out);
    }
}

pub(super) struct Draw<'a> {
    pub(super) distribution: &'a Distribution,
    pub(super) known: &'a [[f32; 3]],
    pub(super) u: &'a [[f32; 2]],
    pub(super) directions: &'a mut [[f32; 3]],
    pub(super) pdfs: &'a mut [f32],
}

impl Kernel for Draw<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Draw { distribution, known, u, directions, pdfs } = self;
        distribution.draw_batch(lanes, known, u, directions, pdfs);
    }
}

pub(super) struct Densities<'a> {
    pub(super) distribution: &'a Distribution,
    pub(super) known: &'a [[f32; 3]],
    pub(super) other: &'a [[f32; 3]],
    pub(super) pdfs: &'a mut [f32],
}

impl Kernel for Densities<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        self.distribution.pdf_batch(lanes, self.known, self.other, self.pdfs);
    }
}
