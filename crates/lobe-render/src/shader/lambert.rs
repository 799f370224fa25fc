//! The ideal diffuse surface.

use std::f32::consts::PI;

use lobe::{Bsdf, Channels as Names, Directions, Given, Kernel, Lanes};
use lobe_lane::MAX_LANES;

use super::{Backend, Evaluated, Sampled, Scratch, Shader};
use crate::channels::Channels;
use crate::transport::{Transport, TransportMode};
use crate::vec3::Vec3;
use crate::vectors::cosine_hemisphere;

/// A surface that looks equally bright from all directions.
#[derive(Clone, Copy, Debug)]
pub struct Lambert<S: Channels = [f32; 3]> {
    albedo: S,
    /// Albedo in linear sRGB, for the albedo image.
    colour: [f32; 3],
    backend: Backend,
}

impl<S: Channels> Lambert<S> {
    /// A surface that reflects this share of the light, per channel, in `[0, 1]`.
    pub fn new(albedo: S, backend: Backend) -> Self {
        let colour = <[f32; 3]>::try_from(albedo.as_ref()).unwrap_or_else(|_| {
            let values = albedo.as_ref();
            [values.iter().sum::<f32>() / values.len().max(1) as f32; 3]
        });
        Lambert { albedo, colour, backend }
    }

    /// The same, with a colour for the albedo image.
    #[must_use]
    pub fn with_colour(self, colour: [f32; 3]) -> Self {
        Lambert { colour, ..self }
    }
}

/// Values for light on the front, on the backend given.
impl Bsdf for Lambert {
    fn channels(&self) -> &Names {
        &Names::Rgb
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn eval_batch(&self, _: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        assert_eq!(wi.count(), wo.count(), "as many wi as wo");
        assert_eq!(out.len(), 3 * wi.count(), "three values per query");
        for (query, texel) in out.chunks_exact_mut(3).enumerate() {
            let above = wi.get(query)[2] > 0.0 && wo.get(query)[2] > 0.0;
            texel.copy_from_slice(&self.albedo.map(|albedo| if above { albedo / PI } else { 0.0 }));
        }
    }

    fn sample_batch(&self, backend: Backend, _: Given, known: &[Vec3], u: &[[f32; 2]], out: lobe::Sampled<'_>) {
        let lobe::Sampled { directions, weights, pdfs } = out;
        assert_eq!(weights.len(), 3 * known.len(), "three weights per direction");
        self.draw_batch(backend, known, u, directions, pdfs);
        for (texel, known) in weights.chunks_exact_mut(3).zip(known) {
            texel.copy_from_slice(&if known[2] > 0.0 { self.albedo } else { [0.0; 3] });
        }
    }

    fn draw_batch(&self, backend: Backend, known: &[Vec3], u: &[[f32; 2]], out: &mut [Vec3], pdfs: &mut [f32]) {
        let count = known.len();
        assert_eq!((u.len(), out.len(), pdfs.len()), (count, count, count), "one of each per direction");
        sample_cosine(backend, u, out);
        for ((pdf, known), sampled) in pdfs.iter_mut().zip(known).zip(&*out) {
            *pdf = density(*known, *sampled);
        }
    }

    fn pdf_batch(&self, _: Backend, given: Given, wi: &[Vec3], wo: &[Vec3], pdfs: &mut [f32]) {
        assert_eq!((wi.len(), wo.len()), (pdfs.len(), pdfs.len()), "as many wi as wo and densities");
        let (known, other) = if given == Given::Light { (wi, wo) } else { (wo, wi) };
        for ((pdf, known), other) in pdfs.iter_mut().zip(known).zip(other) {
            *pdf = density(*known, *other);
        }
    }
}

/// The density with which a direction is sampled for a known direction.
fn density(known: Vec3, sampled: Vec3) -> f32 {
    if known[2] > 0.0 { sampled[2].max(0.0) / PI } else { 0.0 }
}

/// Like the [`Bsdf`], in the channels of any transport.
impl<T: Transport> Shader<T> for Lambert<T::Spectrum> {
    fn albedo(&self) -> [f32; 3] {
        self.colour
    }

    fn eval(&self, _: TransportMode, wi: &[Vec3], wo: &[Vec3], out: Evaluated<'_, T>, _: &mut Scratch) {
        let albedo = T::scattering(self.albedo);
        for (i, (wi, wo)) in wi.iter().zip(wo).enumerate() {
            let pdf = density(*wo, *wi);
            (out.f[i], out.pdf[i]) = (T::scale(albedo, pdf), pdf);
        }
    }

    fn pdf(&self, _: TransportMode, wi: &[Vec3], wo: &[Vec3], pdf: &mut [f32], _: &mut Scratch) {
        for ((pdf, wi), wo) in pdf.iter_mut().zip(wi).zip(wo) {
            *pdf = density(*wo, *wi);
        }
    }

    fn sample(&self, _: TransportMode, wo: &[Vec3], u: &[[f32; 2]], out: Sampled<'_, T>, _: &mut Scratch) {
        let Sampled { wi, weight, pdf } = out;
        sample_cosine(self.backend, u, wi);
        let albedo = T::scattering(self.albedo);
        for (i, wo) in wo.iter().enumerate() {
            pdf[i] = density(*wo, wi[i]);
            weight[i] = if wo[2] > 0.0 { albedo } else { T::ABSORBED };
        }
    }
}

/// Not generic, so that its kernel is compiled with this crate.
fn sample_cosine(backend: Backend, u: &[[f32; 2]], wi: &mut [Vec3]) {
    backend.run(SampleCosine { u, wi });
}

/// Samples directions in proportion to the cosine.
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
            let mut lane = 0;
            while lane < L::LANES && at + lane < wi.len() {
                wi[at + lane] = [columns[0][lane], columns[1][lane], columns[2][lane]];
                lane += 1;
            }
            at += L::LANES;
        }
    }
}
