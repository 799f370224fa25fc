//! The ideal diffuse surface.

use std::f32::consts::PI;

use lobe::{Kernel, Lanes};
use lobe_lane::MAX_LANES;

use super::{Backend, Evaluated, Sampled, Scratch, Shader};
use crate::vectors::cosine_hemisphere;

/// A surface that looks equally bright from everywhere.
#[derive(Clone, Copy, Debug)]
pub struct Lambert<const C: usize> {
    albedo: [f32; C],
    backend: Backend,
}

impl<const C: usize> Lambert<C> {
    /// A surface that reflects this share of the light, per channel, in `[0, 1]`.
    pub fn new(albedo: [f32; C], backend: Backend) -> Self {
        Lambert { albedo, backend }
    }
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
        let Sampled { wi, weight, pdf } = out;
        self.backend.run(Draw { u, wi });
        for (i, wo) in wo.iter().enumerate() {
            let above = wo[2] > 0.0;
            pdf[i] = if above { wi[i][2] / PI } else { 0.0 };
            weight[i] = if above { self.albedo } else { [0.0; C] };
        }
    }
}

/// Directions by the cosine.
struct Draw<'a> {
    u: &'a [[f32; 2]],
    wi: &'a mut [[f32; 3]],
}

impl Kernel for Draw<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Draw { u, wi } = self;
        let mut columns = [[0.0; MAX_LANES]; 3];
        let mut at = 0;
        while at < u.len() {
            let u = lanes.gather_pair(u, lanes.splat_int(at as i32) + lanes.iota());
            let drawn = cosine_hemisphere(lanes, u);
            let mut k = 0;
            while k < 3 {
                lanes.store(&mut columns[k], drawn[k]);
                k += 1;
            }
            for (lane, wi) in wi[at..].iter_mut().take(L::LANES).enumerate() {
                *wi = [columns[0][lane], columns[1][lane], columns[2][lane]];
            }
            at += L::LANES;
        }
    }
}
