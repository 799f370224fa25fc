//! Analytic models: evaluated one pair at a time, sampled by histograms of what they answer.

use std::fmt::Debug;

use lobe::Scatter;
use lobe_model::{Model, is_isotropic};
use lobe_table::{Distribution, DistributionError, DistributionOptions};

use super::{Backend, Evaluated, Sampled, Scratch, Shader, albedo_of, times_cosine};
use crate::transport::{Rgb, TransportMode};
use crate::vec3::Vec3;

/// A model that reflects, and the distribution that directions are sampled from.
#[derive(Debug)]
pub struct ModelShader<M> {
    model: M,
    distribution: Distribution,
    backend: Backend,
    albedo: [f32; 3],
}

/// The most memory that the histograms of a model take: the sharpest peaks of `alpha` = 0.01 are followed.
const BYTES: usize = 4 << 20;

impl<M: Model + Debug + Send + Sync> ModelShader<M> {
    /// Measures where the model sends light; it is the model itself that is seen.
    ///
    /// # Errors
    /// If no distribution can be made of the model's answers.
    pub fn new(model: M, backend: Backend) -> Result<Self, DistributionError> {
        let options = DistributionOptions::unknown(Scatter::Reflection, is_isotropic(&lobe_model::Rgb(&model)), BYTES);
        let mut colours = Vec::new();
        // Models are reciprocal, so it does not matter that the known direction is the viewer's.
        let mut light = |wo: &[[f32; 3]], wi: &[[f32; 3]], out: &mut [f32]| {
            colours.resize(wi.len(), [0.0; 3]);
            values(&model, wi, wo, &mut colours);
            out.iter_mut().zip(&colours).for_each(|(out, [r, g, b])| *out = 0.2126 * r + 0.7152 * g + 0.0722 * b);
        };
        let distribution = Distribution::of_function(backend, &options, &mut light, &mut |_, _| {})?;
        let mut shader = ModelShader { model, distribution, backend, albedo: [0.0; 3] };
        shader.albedo = albedo_of(&shader);
        Ok(shader)
    }
}

/// `f` in 1/sr of many pairs.
fn values(model: &impl Model, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [[f32; 3]]) {
    for ((wi, wo), out) in wi.iter().zip(wo).zip(out) {
        *out = model.f(wi.map(f64::from), wo.map(f64::from)).map(|x| x as f32);
    }
}

impl<M: Model + Debug + Send + Sync> Shader<Rgb> for ModelShader<M> {
    fn albedo(&self) -> [f32; 3] {
        self.albedo
    }

    // Models are reciprocal: both modes have the same values.
    fn eval(&self, _: TransportMode, wi: &[Vec3], wo: &[Vec3], out: Evaluated<'_, Rgb>, _: &mut Scratch) {
        values(&self.model, wi, wo, out.f);
        times_cosine::<Rgb>(out.f, wi);
        self.distribution.pdf_batch(self.backend, wo, wi, out.pdf);
    }

    fn sample(&self, _: TransportMode, wo: &[Vec3], u: &[[f32; 2]], out: Sampled<'_, Rgb>, _: &mut Scratch) {
        let Sampled { wi, weight, pdf } = out;
        self.distribution.draw_batch(self.backend, wo, u, wi, pdf);
        values(&self.model, wi, wo, weight);
        times_cosine::<Rgb>(weight, wi);
        for (weight, &pdf) in weight.iter_mut().zip(&*pdf) {
            *weight = if pdf > 0.0 { weight.map(|w| w / pdf) } else { [0.0; 3] };
        }
    }
}
