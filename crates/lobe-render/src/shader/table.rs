//! Specular tables: evaluated and sampled in lanes.

use std::sync::Arc;

use lobe_lane::{Kernel, Lanes};
use lobe_table::{Given, Sampler, SamplerError, SamplerOptions, Scatter, Table};

use super::{Backend, Evaluated, Reduction, Sampled, Scratch, Shader, albedo_of, times_cosine};

/// A specular table and its sampler.
#[derive(Debug)]
pub struct TableShader {
    sampler: Sampler,
    reduction: Reduction,
    albedo: [f32; 3],
}

impl TableShader {
    /// Prepares a table.
    ///
    /// # Errors
    /// Where its grid is too fine for a sampler.
    pub fn new(table: Table) -> Result<Self, SamplerError> {
        let reduction = Reduction::new(table.channels());
        let sampler = Backend::best().strict().run(Build(Arc::new(table)))?;
        let mut shader = TableShader { sampler, reduction, albedo: [0.0; 3] };
        shader.albedo = albedo_of(&shader);
        Ok(shader)
    }
}

impl Shader<3> for TableShader {
    fn transmits(&self) -> bool {
        self.sampler.table().scatter() == Scatter::Transmission
    }

    fn albedo(&self) -> [f32; 3] {
        self.albedo
    }

    fn eval(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: Evaluated<'_, 3>, scratch: &mut Scratch) {
        let table = self.sampler.table();
        if self.reduction.is_identity() {
            backend.run(table.batch(wi, wo, out.f.as_flattened_mut()));
        } else {
            let values = scratch.values(wi.len() * self.reduction.channels());
            backend.run(table.batch(wi, wo, values));
            self.reduction.apply(values, out.f);
        }
        times_cosine(out.f, wi);
        backend.run(Density { sampler: &self.sampler, given: Given::Viewer, wi, wo, pdf: out.pdf });
    }

    fn sample(&self, backend: Backend, wo: &[[f32; 3]], u: &[[f32; 3]], out: Sampled<'_, 3>, scratch: &mut Scratch) {
        let Scratch { values, pairs } = scratch;
        let weights = if self.reduction.is_identity() {
            out.weight.as_flattened_mut()
        } else {
            values.resize(wo.len() * self.reduction.channels(), 0.0);
            values
        };
        let (directions, pdfs) = (out.wi, out.pdf);
        let sampled = lobe_table::Sampled { directions, weights, pdfs };
        backend.run(Draw { sampler: &self.sampler, given: Given::Viewer, wo, u: firsts(u, pairs), sampled });
        if !self.reduction.is_identity() {
            self.reduction.apply(&scratch.values, out.weight);
        }
        for weight in out.weight {
            *weight = weight.map(|w| w.max(0.0));
        }
    }
}

/// The first two numbers of each three.
pub(super) fn firsts<'a>(u: &[[f32; 3]], pairs: &'a mut Vec<[f32; 2]>) -> &'a [[f32; 2]] {
    pairs.clear();
    pairs.extend(u.iter().map(|u| [u[0], u[1]]));
    pairs
}

/// Builds a sampler, the same on every backend.
pub(super) struct Build(pub(super) Arc<Table>);

impl Kernel for Build {
    type Out = Result<Sampler, SamplerError>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Self::Out {
        Sampler::new(lanes, self.0, &SamplerOptions::default())
    }
}

/// Densities of pairs.
pub(super) struct Density<'a> {
    pub(super) sampler: &'a Sampler,
    pub(super) given: Given,
    pub(super) wi: &'a [[f32; 3]],
    pub(super) wo: &'a [[f32; 3]],
    pub(super) pdf: &'a mut [f32],
}

impl Kernel for Density<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        self.sampler.pdf_batch(lanes, self.given, self.wi, self.wo, self.pdf);
    }
}

/// Directions for viewers.
pub(super) struct Draw<'a> {
    pub(super) sampler: &'a Sampler,
    pub(super) given: Given,
    pub(super) wo: &'a [[f32; 3]],
    pub(super) u: &'a [[f32; 2]],
    pub(super) sampled: lobe_table::Sampled<'a>,
}

impl Kernel for Draw<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        self.sampler.sample_batch(lanes, self.given, self.wo, self.u, self.sampled);
    }
}
