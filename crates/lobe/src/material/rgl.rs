//! The EPFL database, by its `f64` reference.

use lobe_table::Channels;
use lobe_table::rgl::{Reference, UniformOrder};

use super::evaluator::{Evaluator, pair_by_pair, round, unit};
use crate::{Kind, Sample};

/// Values are indexed by the light, as they were measured; samples, which are drawn for a viewer, by the viewer.
impl Evaluator for Reference {
    fn kind(&self) -> Kind {
        Kind::Rgl
    }

    fn channels(&self) -> &Channels {
        &self.rgl().parts().channels
    }

    fn eval_batch(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        let mut value = vec![0.0; Evaluator::channels(self).count()];
        pair_by_pair(wi, wo, out, |wi, wo, texel| {
            self.eval(wi, wo, &mut value);
            round(texel, &value);
        });
    }

    fn pdf(&self, wi: [f32; 3], wo: [f32; 3]) -> Option<f32> {
        Some(unit(wi).zip(unit(wo)).map_or(0.0, |(wi, wo)| Reference::pdf(self, wo, wi) as f32))
    }

    fn sample(&self, wo: [f32; 3], uniform: [f32; 2]) -> Option<Sample> {
        let drawn =
            unit(wo).and_then(|wo| Reference::sample(self, wo, uniform.map(f64::from), UniformOrder::default()));
        Some(drawn.map_or(Sample::NONE, |drawn| Sample { wi: drawn.wo.map(|c| c as f32), pdf: drawn.pdf as f32 }))
    }
}
