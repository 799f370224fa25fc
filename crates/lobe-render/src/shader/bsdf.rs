//! Uses any [`Bsdf`] as a material of pictures: a measured one, an analytic model, or a program's own function.

use std::fmt::Debug;
use std::sync::Arc;

use lobe::{Aspect, Bsdf, Given, Material, Sampler, SamplerError, SamplerOptions, Scatter};
use lobe_model::{Model, is_isotropic};
use lobe_table::bsdf::ByHistograms;
use lobe_table::{DistributionError, DistributionOptions};

use super::{Backend, Evaluated, Lobes, Sampled, Scratch, Shader, albedo_of, times_cosine};
use crate::transport::{Conversion, Rgb, Transport, TransportMode};
use crate::vec3::Vec3;

/// A function of pairs of directions, converted to the scattering of the transport.
#[derive(Debug)]
pub struct BsdfShader<T: Transport = Rgb> {
    bsdf: Arc<dyn Bsdf>,
    backend: Backend,
    conversion: T::Conversion,
    lobes: Lobes,
    /// `true` if there are matrices, and they are needed.
    is_polarised: bool,
    albedo: [f32; 3],
}

/// The most memory that the histograms of a model take: enough to follow the sharpest peaks, of `alpha` = 0.01.
const BYTES: usize = 4 << 20;

impl<T: Transport> BsdfShader<T> {
    /// A function that is evaluated and sampled on the backend given, in the channels of a picture.
    pub fn new_in(basis: &T::Basis, bsdf: Arc<dyn Bsdf>, backend: Backend) -> Self {
        let conversion = T::Conversion::of(bsdf.channels(), basis);
        let transmits = Aspect::ALL.into_iter().any(|aspect| aspect != Aspect::REFLECTION && bsdf.holds(aspect));
        let lobes = Lobes { values: true, delta: bsdf.samples_mirrors(), transmits };
        let is_polarised = T::POLARISED && bsdf.is_polarised();
        let mut shader = BsdfShader { bsdf, backend, conversion, lobes, is_polarised, albedo: [0.0; 3] };
        shader.albedo = albedo_of::<T>(&shader, basis);
        shader
    }

    /// Like [`measured_with`](Self::measured_with), in the channels of a picture.
    ///
    /// # Errors
    /// The same as for [`measured`](Self::measured).
    pub fn measured_in(
        basis: &T::Basis,
        material: Material,
        options: &SamplerOptions,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, SamplerError> {
        let backend = material.backend();
        let sampler = Sampler::with_progress(Arc::new(material), options, progress)?;
        Ok(BsdfShader::new_in(basis, Arc::new(sampler), backend))
    }

    /// A reflecting model, in as many channels as it has, with histograms of its values.
    ///
    /// # Errors
    /// The same as for [`model`](Self::model).
    pub(crate) fn model_in(
        basis: &T::Basis,
        model: impl Bsdf + 'static,
        isotropic: bool,
        backend: Backend,
    ) -> Result<Self, DistributionError> {
        let options = DistributionOptions::unknown(Scatter::Reflection, isotropic, BYTES);
        let sampled = ByHistograms::new(model, backend, Given::Viewer, &options)?;
        Ok(BsdfShader::new_in(basis, Arc::new(sampled), backend))
    }

    /// The matrices of pairs of directions, each times a factor.
    fn matrices(
        &self,
        [light, viewer]: [&[Vec3]; 2],
        factor: impl Fn(usize) -> f32,
        out: &mut [T::Scattering],
        scratch: &mut Scratch,
    ) {
        let matrices = scratch.values(16 * self.conversion.count() * light.len());
        self.bsdf.mueller_batch(self.backend, light.into(), viewer.into(), matrices);
        self.conversion.convert_matrices(matrices, out);
        out.iter_mut().enumerate().for_each(|(at, matrix)| *matrix = T::scale(*matrix, factor(at)));
    }
}

impl<T: Transport<Basis = ()>> BsdfShader<T> {
    /// A function that is evaluated and sampled on the backend given.
    pub fn new(bsdf: Arc<dyn Bsdf>, backend: Backend) -> Self {
        BsdfShader::new_in(&(), bsdf, backend)
    }

    /// A material and the distributions from which its directions are sampled, on the backend of the material.
    ///
    /// # Errors
    /// If there is no sampler for the material.
    pub fn measured(material: Material) -> Result<Self, SamplerError> {
        BsdfShader::measured_with(material, &SamplerOptions::default(), &mut |_, _| {})
    }

    /// Like [`measured`](Self::measured), but calls `progress(done, all)` after each slice of a distribution.
    ///
    /// # Errors
    /// The same as for [`measured`](Self::measured).
    pub fn measured_with(
        material: Material,
        options: &SamplerOptions,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, SamplerError> {
        BsdfShader::measured_in(&(), material, options, progress)
    }

    /// A reflecting model, with histograms of its values, from which directions are sampled.
    ///
    /// # Errors
    /// If no distribution can be built from the values of the model.
    pub fn model(
        model: impl Model + Debug + Send + Sync + 'static,
        backend: Backend,
    ) -> Result<Self, DistributionError> {
        let model = lobe_model::Rgb(model);
        let options = DistributionOptions::unknown(Scatter::Reflection, is_isotropic(&model), BYTES);
        let sampled = ByHistograms::new(model, backend, Given::Viewer, &options)?;
        Ok(BsdfShader::new(Arc::new(sampled), backend))
    }
}

/// Which direction is known.
fn given(mode: TransportMode) -> Given {
    match mode {
        TransportMode::Radiance => Given::Viewer,
        TransportMode::Importance => Given::Light,
    }
}

impl<T: Transport> Shader<T> for BsdfShader<T> {
    fn lobes(&self) -> Lobes {
        self.lobes
    }

    fn albedo(&self) -> [f32; 3] {
        self.albedo
    }

    fn eval(&self, mode: TransportMode, wi: &[Vec3], wo: &[Vec3], out: Evaluated<'_, T>, scratch: &mut Scratch) {
        let Evaluated { f, pdf } = out;
        let [light, viewer] = match mode {
            TransportMode::Radiance => [wi, wo],
            TransportMode::Importance => [wo, wi],
        };
        if self.is_polarised && mode == TransportMode::Radiance {
            self.bsdf.pdf_batch(self.backend, given(mode), light, viewer, pdf);
            return self.matrices([light, viewer], |at| wi[at][2].abs(), f, scratch);
        }
        if let Some(values) = self.conversion.in_place(f) {
            self.bsdf.eval_pdf_batch(self.backend, given(mode), light, viewer, values, pdf);
        } else {
            let values = scratch.values(wi.len() * self.conversion.count());
            self.bsdf.eval_pdf_batch(self.backend, given(mode), light, viewer, values, pdf);
            self.conversion.convert(values, f);
        }
        times_cosine::<T>(f, wi);
    }

    fn pdf(&self, mode: TransportMode, wi: &[Vec3], wo: &[Vec3], pdf: &mut [f32], _: &mut Scratch) {
        let [light, viewer] = match mode {
            TransportMode::Radiance => [wi, wo],
            TransportMode::Importance => [wo, wi],
        };
        self.bsdf.pdf_batch(self.backend, given(mode), light, viewer, pdf);
    }

    /// Separately measured mirrors are sampled too: their density is infinite.
    fn sample(&self, mode: TransportMode, wo: &[Vec3], u: &[[f32; 2]], out: Sampled<'_, T>, scratch: &mut Scratch) {
        let Sampled { wi, weight, pdf } = out;
        let is_polarised = self.is_polarised && mode == TransportMode::Radiance;
        if is_polarised && !self.lobes.delta {
            self.bsdf.draw_batch(self.backend, wo, u, wi, pdf);
            let factor = |at: usize| if pdf[at] > 0.0 { wi[at][2].abs() / pdf[at] } else { 0.0 };
            return self.matrices([wi, wo], factor, weight, scratch);
        }
        if let Some(values) = self.conversion.in_place(weight) {
            let sampled = lobe::Sampled { directions: wi, weights: values, pdfs: pdf };
            self.bsdf.sample_batch(self.backend, given(mode), wo, u, sampled);
        } else {
            let values = scratch.values(wo.len() * self.conversion.count());
            let sampled = lobe::Sampled { directions: wi, weights: values, pdfs: pdf };
            self.bsdf.sample_batch(self.backend, given(mode), wo, u, sampled);
            self.conversion.convert(values, weight);
        }
        if is_polarised {
            let mut matrices = vec![T::ABSORBED; wo.len()];
            let factor = |at: usize| wi[at][2].abs() / pdf[at].max(f32::MIN_POSITIVE);
            self.matrices([wi, wo], factor, &mut matrices, scratch);
            for ((weight, matrix), pdf) in weight.iter_mut().zip(matrices).zip(&*pdf) {
                // A separately measured mirror has no matrix.
                if *pdf > 0.0 && pdf.is_finite() {
                    *weight = matrix;
                }
            }
        }
    }
}
