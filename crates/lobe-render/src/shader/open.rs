//! Materials from files of any format.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use lobe::formats::FormatError;
use lobe::table::{Data, mirror};
use lobe::{Material, OpenError, Options, SamplerError, Scatter};
use lobe_colour::Reduction;

use super::{Backend, BsdfShader, Delta, DeltaShader, Shader};
use crate::transport::Rgb;

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
    if let Some(data) = document.only().and_then(Data::mirror)
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
    let shader = BsdfShader::measured(material.with_backend(backend));
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
