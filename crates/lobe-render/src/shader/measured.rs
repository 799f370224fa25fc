//! Measured materials: files of any format, evaluated and sampled in lanes wherever their representation is.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use lobe::formats::FormatError;
use lobe::table::mirror;
use lobe::{Given, Material, OpenError, Options, Sampler, SamplerError, SamplerOptions, Scatter};
use lobe_colour::Reduction;

use super::{Backend, Delta, DeltaShader, Evaluated, Sampled, Scratch, Shader, albedo_of, times_cosine};

/// Why a file makes no material.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// The file cannot be read.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// What it holds cannot be evaluated.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// Directions cannot be drawn for it.
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
pub fn open(path: &Path, options: &Options, backend: Backend) -> Result<Arc<dyn Shader<3>>, MaterialError> {
    let (format, document) = lobe::formats::open(path)?;
    if let Some(data) = document.only().and_then(|data| data.representation().mirror())
        && data.scatter() == Scatter::Reflection
    {
        return Ok(Arc::new(DeltaShader(mirror(data))));
    }
    prepare(Material::new(path, format, document, options)?, path, backend)
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
) -> Result<Arc<dyn Shader<3>>, MaterialError> {
    let first = front.iter().chain(back).next().cloned().unwrap_or_default();
    prepare(Material::open_sheet(front, back, options)?, &first, backend)
}

fn prepare(material: Material, path: &Path, backend: Backend) -> Result<Arc<dyn Shader<3>>, MaterialError> {
    let shader = MeasuredShader::new(material.with_backend(backend));
    Ok(Arc::new(shader.map_err(|why| MaterialError::Sampler { file: path.into(), why })?))
}

/// Reflectance by the angle of the light, averaged over its azimuths.
fn mirror(specular: &mirror::Data) -> Delta<3> {
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
    reduction: Reduction,
    transmits: bool,
    albedo: [f32; 3],
}

impl MeasuredShader {
    /// Builds the distributions that directions are drawn by.
    ///
    /// # Errors
    /// Where there is no sampler for the material.
    pub fn new(material: Material) -> Result<Self, SamplerError> {
        let transmits = material.holds(true, Scatter::Transmission)
            || [Scatter::Reflection, Scatter::Transmission].into_iter().any(|way| material.holds(false, way));
        let reduction = Reduction::for_display(material.channels());
        let sampler = Sampler::new(Arc::new(material), &SamplerOptions::default())?;
        let mut shader = MeasuredShader { sampler, reduction, transmits, albedo: [0.0; 3] };
        shader.albedo = albedo_of(&shader);
        Ok(shader)
    }
}

impl Shader<3> for MeasuredShader {
    fn transmits(&self) -> bool {
        self.transmits
    }

    fn albedo(&self) -> [f32; 3] {
        self.albedo
    }

    fn eval(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: Evaluated<'_, 3>, scratch: &mut Scratch) {
        let Evaluated { f, pdf } = out;
        if self.reduction.is_identity() {
            self.sampler.eval_pdf_batch(Given::Viewer, wi, wo, f.as_flattened_mut(), pdf);
        } else {
            let values = scratch.values(wi.len() * self.reduction.channels());
            self.sampler.eval_pdf_batch(Given::Viewer, wi, wo, values, pdf);
            self.reduction.apply_batch(values, f);
        }
        times_cosine(f, wi);
    }

    /// Mirrors that were measured beside the values are drawn too: their density is infinite.
    fn sample(&self, wo: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_, 3>, scratch: &mut Scratch) {
        let Sampled { wi, weight, pdf } = out;
        if self.reduction.is_identity() {
            let sampled = lobe::Sampled { directions: wi, weights: weight.as_flattened_mut(), pdfs: pdf };
            self.sampler.sample_batch(Given::Viewer, wo, u, sampled);
        } else {
            let values = scratch.values(wo.len() * self.reduction.channels());
            let sampled = lobe::Sampled { directions: wi, weights: values, pdfs: pdf };
            self.sampler.sample_batch(Given::Viewer, wo, u, sampled);
            self.reduction.apply_batch(values, weight);
        }
    }
}
