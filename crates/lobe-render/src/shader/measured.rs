//! Measured materials: files of any format, evaluated and sampled in lanes if their representation is.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use lobe::formats::FormatError;
use lobe::table::mirror;
use lobe::{Aspect, Given, Material, OpenError, Options, Sampler, SamplerError, SamplerOptions, Scatter};
use lobe_colour::Reduction;

use super::{
    Backend, Conversion, Delta, DeltaShader, Evaluated, Lobes, Sampled, Scratch, Shader, albedo_of, times_cosine,
};
use crate::transport::{Rgb, Transport, TransportMode};
use crate::vec3::Vec3;

/// Why a file makes no material.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// The file cannot be read.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// What it holds cannot be evaluated.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// Directions cannot be sampled for it.
    #[error("{file}: {why}")]
    Sampler {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        why: SamplerError,
    },
}

/// Opens any file that [`lobe`] opens as a material of a picture.
///
/// # Errors
/// [`MaterialError`] names the file.
pub fn open(path: &Path, options: &Options, backend: Backend) -> Result<Arc<dyn Shader<Rgb>>, MaterialError> {
    let (_, document) = lobe::formats::open(path)?;
    if let Some(data) = document.only().and_then(|data| data.representation().mirror())
        && data.scatter() == Scatter::Reflection
    {
        return Ok(Arc::new(DeltaShader(mirror(data))));
    }
    let material = Material::from_document(&document, options).map_err(|error| error.in_file(path))?;
    prepare(material, path, backend)
}

/// Opens the files of a sheet, measured with light on its front and on its back, as
/// [`Material::open_sheet`] does.
///
/// # Errors
/// [`MaterialError`] names the file.
pub fn open_sheet(
    front: &[PathBuf],
    back: &[PathBuf],
    options: &Options,
    backend: Backend,
) -> Result<Arc<dyn Shader<Rgb>>, MaterialError> {
    let first = front.iter().chain(back).next().cloned().unwrap_or_default();
    prepare(Material::open_sheet(front, back, options)?, &first, backend)
}

fn prepare(material: Material, path: &Path, backend: Backend) -> Result<Arc<dyn Shader<Rgb>>, MaterialError> {
    let shader = MeasuredShader::new(material.with_backend(backend));
    Ok(Arc::new(shader.map_err(|why| MaterialError::Sampler { file: path.into(), why })?))
}

/// Reflectance by the angle of the light, averaged over its azimuths.
fn mirror(specular: &mirror::Data) -> Delta {
    let [sigma, psi] = specular.knots();
    let reduction = Reduction::for_display(specular.channels());
    let mut colours = vec![[0.0; 3]; sigma.len() * psi.len()];
    reduction.apply_batch(specular.values(), &mut colours);
    let mean = |row: &[[f32; 3]]| -> [f32; 3] {
        std::array::from_fn(|k| (row.iter().map(|c| c[k]).sum::<f32>() / row.len() as f32).max(0.0))
    };
    let shares = sigma.iter().zip(colours.chunks_exact(psi.len())).map(|(angle, row)| (*angle as f32, mean(row)));
    Delta::Measured(shares.collect())
}

/// A material and its sampler, in the channels of the picture. It runs on the backend of the material.
#[derive(Debug)]
pub struct MeasuredShader {
    sampler: Sampler,
    conversion: <Rgb as Transport>::Conversion,
    lobes: Lobes,
    albedo: [f32; 3],
}

impl MeasuredShader {
    /// Builds the distributions that directions are sampled from.
    ///
    /// # Errors
    /// If there is no sampler for the material.
    pub fn new(material: Material) -> Result<Self, SamplerError> {
        let transmits = Aspect::ALL.into_iter().any(|aspect| aspect != Aspect::REFLECTION && material.holds(aspect));
        let conversion = <Rgb as Transport>::Conversion::of(material.channels());
        let sampler = Sampler::new(Arc::new(material), &SamplerOptions::default())?;
        // Whether there are mirrors in addition to the values is up to the sampler; their samples are marked.
        let lobes = Lobes { values: true, delta: true, transmits };
        let mut shader = MeasuredShader { sampler, conversion, lobes, albedo: [0.0; 3] };
        shader.albedo = albedo_of::<Rgb>(&shader);
        Ok(shader)
    }
}

/// Which direction is known.
fn given(mode: TransportMode) -> Given {
    match mode {
        TransportMode::Radiance => Given::Viewer,
        TransportMode::Importance => Given::Light,
    }
}

impl Shader<Rgb> for MeasuredShader {
    fn lobes(&self) -> Lobes {
        self.lobes
    }

    fn albedo(&self) -> [f32; 3] {
        self.albedo
    }

    fn eval(&self, mode: TransportMode, wi: &[Vec3], wo: &[Vec3], out: Evaluated<'_, Rgb>, scratch: &mut Scratch) {
        let Evaluated { f, pdf } = out;
        let [light, viewer] = match mode {
            TransportMode::Radiance => [wi, wo],
            TransportMode::Importance => [wo, wi],
        };
        if let Some(values) = self.conversion.in_place(f) {
            self.sampler.eval_pdf_batch(given(mode), light, viewer, values, pdf);
        } else {
            let values = scratch.values(wi.len() * self.conversion.count());
            self.sampler.eval_pdf_batch(given(mode), light, viewer, values, pdf);
            self.conversion.convert(values, f);
        }
        times_cosine::<Rgb>(f, wi);
    }

    /// Mirrors that were measured in addition to the values are sampled too: their density is infinite.
    fn sample(&self, mode: TransportMode, wo: &[Vec3], u: &[[f32; 2]], out: Sampled<'_, Rgb>, scratch: &mut Scratch) {
        let Sampled { wi, weight, pdf } = out;
        if let Some(values) = self.conversion.in_place(weight) {
            let sampled = lobe::Sampled { directions: wi, weights: values, pdfs: pdf };
            self.sampler.sample_batch(given(mode), wo, u, sampled);
        } else {
            let values = scratch.values(wo.len() * self.conversion.count());
            let sampled = lobe::Sampled { directions: wi, weights: values, pdfs: pdf };
            self.sampler.sample_batch(given(mode), wo, u, sampled);
            self.conversion.convert(values, weight);
        }
    }
}
