//! Materials of the EPFL database, evaluated and sampled in lanes.

use lobe_table::rgl::{Drawn, RglTable, UniformOrder, Wanted};

use super::table::firsts;
use super::{Backend, Evaluated, Reduction, Sampled, Scratch, Shader, albedo_of, times_cosine};

/// A material of the EPFL database. Its tables are indexed by the viewer, as the renderers of its authors do, so that
/// directions are drawn for what is evaluated.
#[derive(Debug)]
pub struct RglShader {
    table: RglTable,
    reduction: Reduction,
    albedo: [f32; 3],
}

impl RglShader {
    /// Prepares a table.
    pub fn new(table: RglTable) -> Self {
        let reduction = Reduction::new(table.channels());
        let mut shader = RglShader { table, reduction, albedo: [0.0; 3] };
        shader.albedo = albedo_of(&shader);
        shader
    }
}

impl Shader<3> for RglShader {
    fn albedo(&self) -> [f32; 3] {
        self.albedo
    }

    fn eval(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: Evaluated<'_, 3>, scratch: &mut Scratch) {
        if self.reduction.is_identity() {
            let wanted = Wanted::ValuesAndPdf(out.f.as_flattened_mut(), out.pdf);
            backend.run(self.table.batch(wo, wi, wanted));
        } else {
            let values = scratch.values(wi.len() * self.reduction.channels());
            backend.run(self.table.batch(wo, wi, Wanted::ValuesAndPdf(values, out.pdf)));
            self.reduction.apply(values, out.f);
        }
        times_cosine(out.f, wi);
    }

    fn sample(&self, backend: Backend, wo: &[[f32; 3]], u: &[[f32; 3]], out: Sampled<'_, 3>, scratch: &mut Scratch) {
        let Scratch { values, pairs } = scratch;
        let weights = if self.reduction.is_identity() {
            out.weight.as_flattened_mut()
        } else {
            values.resize(wo.len() * self.reduction.channels(), 0.0);
            values
        };
        let drawn = Drawn { wo: out.wi, pdf: out.pdf, weights };
        backend.run(self.table.sampling(wo, firsts(u, pairs), UniformOrder::default(), drawn));
        if !self.reduction.is_identity() {
            self.reduction.apply(&scratch.values, out.weight);
        }
        for weight in out.weight {
            *weight = weight.map(|w| w.max(0.0));
        }
    }
}
