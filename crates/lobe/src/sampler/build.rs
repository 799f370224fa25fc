//! Building on the backend that is found when the program runs.

use std::sync::Arc;

use lobe_lane::{Kernel, Lanes};
use lobe_table::{
    Distribution, DistributionError, DistributionOptions, Sampler, SamplerError, SamplerOptions, specular,
};

pub(super) struct BuildTable<'a> {
    pub(super) table: Arc<specular::Table>,
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
