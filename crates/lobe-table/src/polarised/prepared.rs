//! Mueller matrices in specular coordinates, ready to be evaluated and sampled. For unpolarised light, they are a
//! specular table; whole matrices are laid out when they are first needed, because they take sixteen times the memory.

use std::sync::{Arc, OnceLock};

use lobe_backend::Backend;

use super::{Data, Matrices};
use crate::bsdf::{Bsdf, Scheme, unit};
use crate::data::{Options, PrepareError};
use crate::mueller::{ELEMENTS, Matrix};
use crate::{
    Aspect, Channels, Directions, Edges, Given, Sampled, Sampler, SamplerError, SamplerOptions, TableError, specular,
};

/// Lays the data out.
pub(super) fn prepare(data: &Data, options: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
    let edges = options.edges;
    let elements = data.values().len();
    if u32::try_from(elements).is_err() {
        let nodes = elements / (ELEMENTS * data.wavelengths().len());
        return Err(TableError::TooLarge { nodes, channels: ELEMENTS * data.wavelengths().len() }.into());
    }
    let table = Arc::new(specular::Table::new(data.unpolarised(), &edges)?);
    let polarised = Arc::new(Polarised { data: data.clone(), edges, matrices: OnceLock::new() });
    Ok(Box::new(Prepared { table, polarised }))
}

/// The matrices.
#[derive(Debug)]
struct Polarised {
    data: Data,
    edges: Edges,
    matrices: OnceLock<Matrices>,
}

impl Polarised {
    fn matrices(&self) -> &Matrices {
        let matrices =
            || Matrices::new(&self.data, &self.edges).expect("axes that the unpolarised table has, and an index");
        self.matrices.get_or_init(matrices)
    }

    fn bytes(&self) -> usize {
        size_of_val(self.data.values()) + self.matrices.get().map_or(0, Matrices::bytes)
    }

    fn mueller(&self, wi: [f32; 3], wo: [f32; 3], nm: f64) -> Matrix {
        unit(wi).zip(unit(wo)).map_or([[0.0; 4]; 4], |(wi, wo)| self.data.eval(&self.edges, wi, wo, nm))
    }
}

/// The matrices, and a table of their elements for unpolarised light.
#[derive(Clone, Debug)]
struct Prepared {
    table: Arc<specular::Table>,
    polarised: Arc<Polarised>,
}

/// The same, with a specular sampler.
#[derive(Debug)]
struct Drawn {
    sampler: Sampler,
    polarised: Arc<Polarised>,
}

/// The data of both.
macro_rules! polarised {
    () => {
        fn mueller(&self, wi: [f32; 3], wo: [f32; 3], nm: f64) -> Option<Matrix> {
            Some(self.polarised.mueller(wi, wo, nm))
        }

        fn is_polarised(&self) -> bool {
            true
        }

        fn mueller_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) -> bool {
            self.polarised.matrices().eval_batch(backend, wi, wo, out);
            true
        }
    };
}

impl Bsdf for Prepared {
    fn channels(&self) -> &Channels {
        self.table.channels()
    }

    fn is_isotropic(&self) -> bool {
        !self.table.is_anisotropic()
    }

    fn bytes(&self) -> usize {
        self.table.bytes() + self.polarised.bytes()
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.table.eval_batch(backend, wi, wo, out);
    }

    fn eval(&self, backend: Backend, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        self.table.eval(backend, wi, wo, out);
    }

    fn sampled(
        &self,
        backend: Backend,
        options: &SamplerOptions,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Option<Scheme>, SamplerError> {
        let sampler = Sampler::with_progress(backend, self.table.clone(), options, progress)?;
        let (bytes, is_limited) = (sampler.bytes(), sampler.distribution().is_limited());
        let polarised = self.polarised.clone();
        Ok(Some(Scheme { bsdf: Arc::new(Drawn { sampler, polarised }), bytes, is_limited }))
    }

    fn specular_table(&self) -> Option<&Arc<specular::Table>> {
        Some(&self.table)
    }

    polarised!();
}

impl Bsdf for Drawn {
    fn channels(&self) -> &Channels {
        self.sampler.channels()
    }

    fn holds(&self, aspect: Aspect) -> bool {
        aspect == Aspect::REFLECTION
    }

    fn is_isotropic(&self) -> bool {
        self.sampler.is_isotropic()
    }

    fn bytes(&self) -> usize {
        Bsdf::bytes(&self.sampler) + self.polarised.bytes()
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        Bsdf::eval_batch(&self.sampler, backend, wi, wo, out);
    }

    fn eval(&self, backend: Backend, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        Bsdf::eval(&self.sampler, backend, wi, wo, out);
    }

    fn sample_batch(&self, backend: Backend, given: Given, known: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_>) {
        Bsdf::sample_batch(&self.sampler, backend, given, known, u, out);
    }

    fn draw_batch(&self, backend: Backend, known: &[[f32; 3]], u: &[[f32; 2]], out: &mut [[f32; 3]], pdfs: &mut [f32]) {
        Bsdf::draw_batch(&self.sampler, backend, known, u, out, pdfs);
    }

    fn pdf_batch(&self, backend: Backend, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], pdfs: &mut [f32]) {
        Bsdf::pdf_batch(&self.sampler, backend, given, wi, wo, pdfs);
    }

    fn specular_table(&self) -> Option<&Arc<specular::Table>> {
        Bsdf::specular_table(&self.sampler)
    }

    polarised!();
}
