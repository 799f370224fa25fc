//! The ideal diffuse surface.

use std::f32::consts::PI;

use lobe::{Kernel, Lanes};
use lobe_lane::MAX_LANES;

use super::{Backend, Evaluated, Sampled, Scratch, Shader};
use crate::channels::Channels;
use crate::transport::{Transport, TransportMode};
use crate::vec3::Vec3;
use crate::vectors::cosine_hemisphere;

/// A surface that looks equally bright from everywhere.
#[derive(Clone, Copy, Debug)]
pub struct Lambert<S: Channels = [f32; 3]> {
    albedo: S,
    backend: Backend,
}

impl<S: Channels> Lambert<S> {
    /// A surface that reflects this share of the light, per channel, in `[0, 1]`.
    pub fn new(albedo: S, backend: Backend) -> Self {
        Lambert { albedo, backend }
    }
}

impl<T: Transport> Shader<T> for Lambert<T::Spectrum> {
    fn albedo(&self) -> [f32; 3] {
        T::colour(T::radiance(T::START, self.albedo))
    }

    fn eval(&self, _: TransportMode, wi: &[Vec3], wo: &[Vec3], out: Evaluated<'_, T>, _: &mut Scratch) {
        let albedo = T::scattering(self.albedo);
        for (i, (wi, wo)) in wi.iter().zip(wo).enumerate() {
            let pdf = if wo[2] > 0.0 { wi[2].max(0.0) / PI } else { 0.0 };
            (out.f[i], out.pdf[i]) = (T::scale(albedo, pdf), pdf);
        }
    }

    fn sample(&self, _: TransportMode, wo: &[Vec3], u: &[[f32; 2]], out: Sampled<'_, T>, _: &mut Scratch) {
        let Sampled { wi, weight, pdf } = out;
        sample_cosine(self.backend, u, wi);
        let albedo = T::scattering(self.albedo);
        for (i, wo) in wo.iter().enumerate() {
            let above = wo[2] > 0.0;
            pdf[i] = if above { wi[i][2] / PI } else { 0.0 };
            weight[i] = if above { albedo } else { T::ABSORBED };
        }
    }
}

/// Not generic, so that its kernel is compiled with this crate.
fn sample_cosine(backend: Backend, u: &[[f32; 2]], wi: &mut [Vec3]) {
    backend.run(SampleCosine { u, wi });
}

/// Directions by the cosine.
struct SampleCosine<'a> {
    u: &'a [[f32; 2]],
    wi: &'a mut [[f32; 3]],
}

impl Kernel for SampleCosine<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let SampleCosine { u, wi } = self;
        let mut columns = [[0.0; MAX_LANES]; 3];
        let mut at = 0;
        while at < u.len() {
            let u = lanes.gather_pair(u, lanes.splat_int(at as i32) + lanes.iota());
            let sampled = cosine_hemisphere(lanes, u);
            let mut k = 0;
            while k < 3 {
                lanes.store(&mut columns[k], sampled[k]);
                k += 1;
            }
            for (lane, wi) in wi[at..].iter_mut().take(L::LANES).enumerate() {
                *wi = [columns[0][lane], columns[1][lane], columns[2][lane]];
            }
            at += L::LANES;
        }
    }
}
