//! The ideal diffuse surface.

use std::f32::consts::PI;

use super::{Evaluated, Sampled, Scratch, Shader};
use crate::vec3::cosine_hemisphere;

/// A surface that looks equally bright from everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lambert<const C: usize> {
    /// Reflected share of the light, per channel, in `[0, 1]`.
    pub albedo: [f32; C],
}

impl<const C: usize> Shader<C> for Lambert<C> {
    fn albedo(&self) -> [f32; C] {
        self.albedo
    }

    fn eval(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: Evaluated<'_, C>, _: &mut Scratch) {
        for (i, (wi, wo)) in wi.iter().zip(wo).enumerate() {
            let pdf = if wo[2] > 0.0 { wi[2].max(0.0) / PI } else { 0.0 };
            (out.f[i], out.pdf[i]) = (self.albedo.map(|albedo| albedo * pdf), pdf);
        }
    }

    fn sample(&self, wo: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_, C>, _: &mut Scratch) {
        for (i, (wo, u)) in wo.iter().zip(u).enumerate() {
            let wi = cosine_hemisphere(*u);
            let above = wo[2] > 0.0;
            (out.wi[i], out.pdf[i]) = (wi, if above { wi[2] / PI } else { 0.0 });
            out.weight[i] = if above { self.albedo } else { [0.0; C] };
        }
    }
}
