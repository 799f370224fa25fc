//! Materials of the EPFL database, ready to be evaluated, and sampled by their published scheme.

use std::sync::Arc;

use lobe_backend::Backend;

use super::{Data, Drawn, Options, Table, UniformOrder, Wanted};
use crate::bsdf::{Bsdf, Scheme};
use crate::data::PrepareError;
use crate::{Channels, Directions, Given, Sampled, SamplerError, SamplerOptions};

/// Lays the data out.
pub(super) fn prepare(data: &Data, options: &crate::data::Options) -> Result<Box<dyn Bsdf>, PrepareError> {
    let table = Arc::new(Table::new(data, Options::default())?);
    Ok(Box::new(Prepared { table, indexed_by: options.indexed_by }))
}

/// A table, and the direction that indexes it.
#[derive(Clone, Debug)]
pub(crate) struct Prepared {
    pub(crate) table: Arc<Table>,
    pub(crate) indexed_by: Given,
}

impl Bsdf for Prepared {
    fn channels(&self) -> &Channels {
        self.table.channels()
    }

    fn is_isotropic(&self) -> bool {
        self.table.is_isotropic()
    }

    fn bytes(&self) -> usize {
        self.table.bytes()
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        let (index, other) = if self.indexed_by == Given::Light { (wi, wo) } else { (wo, wi) };
        self.table.eval_batch(backend, index, other, out);
    }

    fn sample_batch(&self, backend: Backend, given: Given, known: &[[f32; 3]], u: &[[f32; 2]], mut out: Sampled<'_>) {
        let drawn = Drawn { wo: &mut *out.directions, pdf: &mut *out.pdfs, weights: &mut *out.weights };
        self.table.sample_batch(backend, known.into(), u, UniformOrder::default(), drawn);
        if given != self.indexed_by {
            // These are the weights for exchanged light and viewer.
            let found = &*out.directions;
            let (wi, wo) = if given == Given::Light { (known, found) } else { (found, known) };
            self.eval_batch(backend, wi.into(), wo.into(), out.weights);
            out.times_cosine_over_density();
        }
    }

    fn pdf_batch(&self, backend: Backend, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], pdfs: &mut [f32]) {
        let (known, other) = if given == Given::Light { (wi, wo) } else { (wo, wi) };
        self.table.pdf_batch(backend, known.into(), other.into(), pdfs);
    }

    fn eval_pdf_batch(
        &self,
        backend: Backend,
        given: Given,
        wi: &[[f32; 3]],
        wo: &[[f32; 3]],
        values: &mut [f32],
        pdfs: &mut [f32],
    ) {
        if given == self.indexed_by {
            let (known, other) = if given == Given::Light { (wi, wo) } else { (wo, wi) };
            self.table.evaluate(backend, known.into(), other.into(), Wanted::ValuesAndPdf(values, pdfs));
        } else {
            self.eval_batch(backend, wi.into(), wo.into(), values);
            self.pdf_batch(backend, given, wi, wo, pdfs);
        }
    }

    fn sampled(
        &self,
        _: Backend,
        _: &SamplerOptions,
        _: &mut dyn FnMut(usize, usize),
    ) -> Result<Option<Scheme>, SamplerError> {
        Ok(Some(Scheme { bsdf: Arc::new(self.clone()), bytes: 0, is_limited: false }))
    }
}
