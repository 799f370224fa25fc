//! What the operations ask of a material.

use lobe::{Brdf, Material};
use lobe_table::Channels;

/// Anything that has a value for every pair of directions.
pub trait Scattering {
    /// What the channels of a value stand for.
    fn channels(&self) -> &Channels;

    /// `f` in 1/sr of many pairs of unit vectors, `wi` to the light and `wo` to the viewer:
    /// `out[query * channels + channel]`. The three slices fit together.
    fn eval_batch(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]);
}

impl Scattering for Material {
    fn channels(&self) -> &Channels {
        Material::channels(self)
    }

    fn eval_batch(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        Material::eval_batch(self, wi, wo, out);
    }
}

impl Scattering for Brdf {
    fn channels(&self) -> &Channels {
        self.table().channels()
    }

    fn eval_batch(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        Brdf::eval_batch(self, wi, wo, out);
    }
}

/// Evaluates pairs of directions that are `f64`.
pub(crate) fn eval_pairs(scattering: &dyn Scattering, pairs: &[([f64; 3], [f64; 3])]) -> Vec<f32> {
    let narrow = |direction: [f64; 3]| direction.map(|c| c as f32);
    let (wi, wo): (Vec<_>, Vec<_>) = pairs.iter().map(|&(wi, wo)| (narrow(wi), narrow(wo))).unzip();
    let mut out = vec![0.0; pairs.len() * scattering.channels().count()];
    scattering.eval_batch(&wi, &wo, &mut out);
    out
}
