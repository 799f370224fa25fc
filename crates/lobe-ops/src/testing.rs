//! Materials with known values.

use std::fmt;

use lobe::Backend;
pub(crate) use lobe_model::Rgb as Exact;
use lobe_model::{Conductor, Ggx};
use lobe_table::{Bsdf, Channels, Directions};

use crate::OnBackend;

/// A function of two directions, as a material with one channel.
pub(crate) struct Mono<F>(pub(crate) F);

impl<F> fmt::Debug for Mono<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Mono")
    }
}

impl<F: Fn([f64; 3], [f64; 3]) -> f64 + Send + Sync> Bsdf for Mono<F> {
    fn channels(&self) -> &Channels {
        &Channels::Mono
    }

    fn eval_batch(&self, _: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        for (query, out) in out.iter_mut().enumerate() {
            *out = (self.0)(wi.get(query).map(f64::from), wo.get(query).map(f64::from)) as f32;
        }
    }
}

impl<'a, F: Fn([f64; 3], [f64; 3]) -> f64 + Send + Sync> From<&'a Mono<F>> for OnBackend<'a> {
    fn from(function: &'a Mono<F>) -> Self {
        OnBackend::new(function, Backend::best())
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
