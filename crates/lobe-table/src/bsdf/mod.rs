//! Functions of pairs of directions that can be evaluated and sampled in batches.

mod cosine;
mod histograms;
mod lanes;

use std::fmt::Debug;
use std::sync::Arc;

use lobe_backend::Backend;

use crate::mueller::Matrix;
use crate::{
    Aspect, Channels, Directions, DistributionError, Given, PatchSampler, Sampled, SamplerError, SamplerOptions,
    specular,
};

pub use histograms::ByHistograms;
pub use lanes::BsdfLanes;

/// A function of pairs of directions: a measured material, an analytic model, or anything else that scatters light.
///
/// `wi` points to the light and `wo` to the viewer: unit vectors away from the surface, normal on +z. Values are `f` in
/// 1/sr, without the cosine, one per channel; densities are over solid angle, in 1/sr. A delta function in direction
/// has no value here; if [`sample_batch`](Self::sample_batch) draws such a direction, its density is infinite, and
/// [`samples_mirrors`](Self::samples_mirrors) says so.
///
/// Only [`channels`](Self::channels) and [`eval_batch`](Self::eval_batch) have to be implemented: directions are then
/// sampled in proportion to the cosine, on the sides that [`holds`](Self::holds) names.
pub trait Bsdf: Debug + Send + Sync {
    /// The meaning of the channels of a value.
    fn channels(&self) -> &Channels;

    /// `true` if there are values for light from this side and this scatter: by default, for reflection on the front.
    fn holds(&self, aspect: Aspect) -> bool {
        aspect == Aspect::REFLECTION
    }

    /// `true` if values are known not to depend on the rotation of the sample.
    fn is_isotropic(&self) -> bool {
        false
    }

    /// `true` if sampled directions may be those of mirrors, which have an infinite density.
    fn samples_mirrors(&self) -> bool {
        false
    }

    /// Bytes of memory that the data take.
    fn bytes(&self) -> usize {
        0
    }

    /// Values of many pairs: `out[query * channels + channel]`.
    ///
    /// # Panics
    /// If the numbers of `wi` and `wo` differ, or the length of `out` is not that number times the number of channels.
    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]);

    /// The value of one pair, one number per channel.
    ///
    /// # Panics
    /// If the length of `out` is not the number of channels.
    fn eval(&self, backend: Backend, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        self.eval_batch(backend.narrow(), (&[wi]).into(), (&[wo]).into(), out);
    }

    /// Samples one direction for each of the `known` ones, from two numbers in `[0, 1)` each. `given` says whether the
    /// known directions are to the light or to the viewer. Weights are values times cosine over density.
    ///
    /// # Panics
    /// If `u` or a field of `out` does not have one entry per direction, or the weights do not have one per direction
    /// and channel.
    fn sample_batch(&self, backend: Backend, given: Given, known: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_>) {
        cosine::sample_batch(self, backend, given, known, u, out);
    }

    /// Draws directions and their densities as [`sample_batch`](Self::sample_batch) does, without the weights.
    ///
    /// # Panics
    /// If the slices do not have the same length.
    fn draw_batch(&self, backend: Backend, known: &[[f32; 3]], u: &[[f32; 2]], out: &mut [[f32; 3]], pdfs: &mut [f32]) {
        let mut weights = vec![0.0; known.len() * self.channels().count()];
        let out = Sampled { directions: out, weights: &mut weights, pdfs };
        self.sample_batch(backend, Given::Light, known, u, out);
    }

    /// The densities with which [`sample_batch`](Self::sample_batch) draws the other direction of each pair.
    ///
    /// # Panics
    /// If the numbers of `wi`, `wo` and `pdfs` differ.
    fn pdf_batch(&self, backend: Backend, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], pdfs: &mut [f32]) {
        let _ = backend;
        cosine::pdf_batch(self, given, wi, wo, pdfs);
    }

    /// Values and densities of many pairs: computing both at once may take less time than one after the other.
    ///
    /// # Panics
    /// The same as for [`eval_batch`](Self::eval_batch) and [`pdf_batch`](Self::pdf_batch).
    fn eval_pdf_batch(
        &self,
        backend: Backend,
        given: Given,
        wi: &[[f32; 3]],
        wo: &[[f32; 3]],
        values: &mut [f32],
        pdfs: &mut [f32],
    ) {
        self.eval_batch(backend, wi.into(), wo.into(), values);
        self.pdf_batch(backend, given, wi, wo, pdfs);
    }

    /// The same function, sampled in proportion to luminance times value times cosine, if it has its own scheme for
    /// that. `progress` is called with the number of finished parts and their total.
    ///
    /// # Errors
    /// If the options do not apply to it.
    fn sampled(
        &self,
        backend: Backend,
        options: &SamplerOptions,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Option<Scheme>, SamplerError> {
        let _ = (backend, options, progress);
        Ok(None)
    }

    /// A separate lobe for one side and scatter, if the function is constant on patches. `luminance` gives the weight
    /// of each channel, and `defensive` the part that is a cosine distribution.
    ///
    /// # Errors
    /// If the options do not apply to it.
    fn patches(
        &self,
        aspect: Aspect,
        luminance: &[f32],
        defensive: f32,
    ) -> Result<Option<PatchSampler>, DistributionError> {
        let _ = (aspect, luminance, defensive);
        Ok(None)
    }

    /// The Mueller matrix at a wavelength in nm, if polarisation is known.
    fn mueller(&self, wi: [f32; 3], wo: [f32; 3], nm: f64) -> Option<Matrix> {
        let _ = (wi, wo, nm);
        None
    }

    /// `true` if there are Mueller matrices for pairs of directions.
    fn is_polarised(&self) -> bool {
        false
    }

    /// The Mueller matrices of many pairs at every wavelength of the channels: `out[query][channel][row][column]`, in
    /// 1/sr, without the cosine, in the Stokes frames of [`stokes_basis`](crate::mueller::stokes_basis). Returns
    /// whether there are any; if not, `out` is unchanged.
    ///
    /// # Panics
    /// If the numbers of `wi` and `wo` differ, or the length of `out` is not that number times 16 times the number of
    /// channels.
    fn mueller_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) -> bool {
        let _ = (backend, wi, wo, out);
        false
    }

    /// The table, if this is one in specular coordinates, for evaluation inside the caller's own kernel.
    fn specular_table(&self) -> Option<&Arc<specular::Table>> {
        None
    }
}

/// A function with its own sampling scheme.
#[derive(Clone, Debug)]
pub struct Scheme {
    /// The function; its values are unchanged.
    pub bsdf: Arc<dyn Bsdf>,
    /// Bytes of memory that the distributions take in addition to the values.
    pub bytes: usize,
    /// `true` if the distributions would be finer without [`SamplerOptions::evaluations`].
    pub is_limited: bool,
}

/// A function and the backend that it is evaluated on.
#[derive(Clone, Copy, Debug)]
pub struct OnBackend<'a> {
    /// The function.
    pub bsdf: &'a dyn Bsdf,
    /// The backend that evaluates it.
    pub backend: Backend,
}

impl<'a> OnBackend<'a> {
    /// A function on the given backend.
    pub fn new(bsdf: &'a dyn Bsdf, backend: Backend) -> Self {
        OnBackend { bsdf, backend }
    }

    /// The meaning of the channels of a value.
    pub fn channels(&self) -> &'a Channels {
        self.bsdf.channels()
    }

    /// Values of many pairs, as [`Bsdf::eval_batch`].
    ///
    /// # Panics
    /// The same as for [`Bsdf::eval_batch`].
    pub fn eval_batch<'b>(&self, wi: impl Into<Directions<'b>>, wo: impl Into<Directions<'b>>, out: &mut [f32]) {
        self.bsdf.eval_batch(self.backend, wi.into(), wo.into(), out);
    }
}

/// Evaluates pair by pair with an evaluator in `f64`, which receives directions normalised in `f64`. Directions that
/// have no length or are not finite give 0.
///
/// # Panics
/// If the numbers of `wi` and `wo` differ, or the length of `out` is not that number times the number of channels.
pub(crate) fn pair_by_pair(
    channels: &Channels,
    wi: Directions<'_>,
    wo: Directions<'_>,
    out: &mut [f32],
    mut eval: impl FnMut([f64; 3], [f64; 3], &mut [f32]),
) {
    let (count, channels) = (wi.count(), channels.count());
    assert_eq!(count, wo.count(), "as many wi as wo");
    assert_eq!(out.len(), count * channels, "one value per query and channel");
    for (query, texel) in out.chunks_exact_mut(channels).enumerate() {
        match unit(wi.get(query)).zip(unit(wo.get(query))) {
            Some((wi, wo)) => eval(wi, wo, texel),
            None => texel.fill(0.0),
        }
    }
}

/// A direction normalised in `f64`; `None` if it has no length or is not finite.
pub(crate) fn unit(direction: [f32; 3]) -> Option<[f64; 3]> {
    let v = direction.map(f64::from);
    let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
    (length.is_finite() && length > 0.0).then(|| v.map(|c| c / length))
}
