//! Materials that are known exactly.

use lobe_model::{Conductor, Ggx, Model};
use lobe_table::Channels;

use crate::Scattering;

/// An analytic model as it is, without a table between.
pub(crate) struct Exact<M>(pub(crate) M);

impl<M: Model> Scattering for Exact<M> {
    fn channels(&self) -> &Channels {
        &Channels::Rgb
    }

    fn eval_batch(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        for ((wi, wo), texel) in wi.iter().zip(wo).zip(out.chunks_exact_mut(3)) {
            let value = self.0.f(wi.map(f64::from), wo.map(f64::from));
            texel.iter_mut().zip(value).for_each(|(out, value)| *out = value as f32);
        }
    }
}

/// A function of two directions, the same in one channel.
pub(crate) struct Mono<F>(pub(crate) F);

impl<F: Fn([f64; 3], [f64; 3]) -> f64> Scattering for Mono<F> {
    fn channels(&self) -> &Channels {
        &Channels::Mono
    }

    fn eval_batch(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        for ((wi, wo), out) in wi.iter().zip(wo).zip(out) {
            *out = (self.0)(wi.map(f64::from), wo.map(f64::from)) as f32;
        }
    }
}

/// Angles in degrees as radians.
pub(crate) fn degrees(angles: &[f64]) -> Vec<f64> {
    angles.iter().map(|angle| angle.to_radians()).collect()
}

/// Rough gold.
pub(crate) fn gold(alpha: f64) -> Conductor {
    Conductor { ggx: Ggx { alpha: [alpha; 2] }, eta: [0.143, 0.375, 1.442], k: [3.983, 2.386, 1.603] }
}
