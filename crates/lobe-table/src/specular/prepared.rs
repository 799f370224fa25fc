//! Specular tables, ready to be evaluated and sampled.

use std::sync::Arc;

use lobe_backend::Backend;

use super::Table;
use crate::bsdf::{Bsdf, Scheme};
use crate::{Aspect, Channels, Directions, Given, Sampled, Sampler, SamplerError, SamplerOptions, Scatter, Side};

/// A table that samplers may share.
#[derive(Clone, Debug)]
pub(crate) struct Prepared(pub(crate) Arc<Table>);

/// Tables of transmission accept light from either side.
fn holds(table: &Table, aspect: Aspect) -> bool {
    table.scatter() == aspect.scatter && (aspect.light == Side::Front || aspect.scatter == Scatter::Transmission)
}

impl Bsdf for Prepared {
    fn channels(&self) -> &Channels {
        self.0.channels()
    }

    fn holds(&self, aspect: Aspect) -> bool {
        holds(&self.0, aspect)
    }

    fn is_isotropic(&self) -> bool {
        !self.0.is_anisotropic()
    }

    fn bytes(&self) -> usize {
        self.0.bytes()
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.0.eval_batch(backend, wi, wo, out);
    }

    fn eval(&self, backend: Backend, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        self.0.eval(backend, wi, wo, out);
    }

    fn sampled(
        &self,
        backend: Backend,
        options: &SamplerOptions,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Option<Scheme>, SamplerError> {
        let sampler = Sampler::with_progress(backend, self.0.clone(), options, progress)?;
        let (bytes, is_limited) = (sampler.bytes(), sampler.distribution().is_limited());
        Ok(Some(Scheme { bsdf: Arc::new(sampler), bytes, is_limited }))
    }

    fn specular_table(&self) -> Option<&Arc<Table>> {
        Some(&self.0)
    }
}

impl Bsdf for Sampler {
    fn channels(&self) -> &Channels {
        self.table().channels()
    }

    fn holds(&self, aspect: Aspect) -> bool {
        holds(self.table(), aspect)
    }

    fn is_isotropic(&self) -> bool {
        !self.table().is_anisotropic()
    }

    fn bytes(&self) -> usize {
        self.table().bytes() + Sampler::bytes(self)
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.table().eval_batch(backend, wi, wo, out);
    }

    fn eval(&self, backend: Backend, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        self.table().eval(backend, wi, wo, out);
    }

    fn sample_batch(&self, backend: Backend, given: Given, known: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_>) {
        Sampler::sample_batch(self, backend, given, known, u, out);
    }

    fn draw_batch(&self, backend: Backend, known: &[[f32; 3]], u: &[[f32; 2]], out: &mut [[f32; 3]], pdfs: &mut [f32]) {
        self.distribution().draw_batch(backend, known, u, out, pdfs);
    }

    fn pdf_batch(&self, backend: Backend, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], pdfs: &mut [f32]) {
        Sampler::pdf_batch(self, backend, given, wi, wo, pdfs);
    }

    fn specular_table(&self) -> Option<&Arc<Table>> {
        Some(self.table())
    }
}
