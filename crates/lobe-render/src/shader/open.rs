//! Opens materials from files of any format.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use lobe::formats::{Document, FormatError};
use lobe::table::{Data, mirror};
use lobe::{Material, OpenError, Options, SamplerError, SamplerOptions, Scatter};

use super::{Backend, BsdfShader, Delta, DeltaShader, Shader};
use crate::channels::Channels as _;
use crate::clock::Instant;
use crate::transport::{Rgb, Transport};

/// The reason why a file does not give a material.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// The file cannot be read.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// Its content cannot be evaluated.
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

/// Opens any file that [`lobe`] can open as a material of a picture.
///
/// # Errors
/// [`MaterialError`] names the file.
pub fn open(path: &Path, options: &Options, backend: Backend) -> Result<Arc<dyn Shader<Rgb>>, MaterialError> {
    open_with(path, options, backend, None, &mut |_, _| {})
}

/// Like [`open`], but calls `progress(done, all)` after each slice of the distributions from which directions are
/// sampled. If they would take much longer than `limit` to build, coarser ones are built, which gives more noise.
///
/// # Errors
/// The same as for [`open`].
pub fn open_with(
    path: &Path,
    options: &Options,
    backend: Backend,
    limit: Option<Duration>,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Arc<dyn Shader<Rgb>>, MaterialError> {
    from_document(&lobe::formats::open(path)?.1, path, options, backend, limit, progress)
}

/// Like [`open_with`], for a file that was already read; `path` is only used in errors.
///
/// # Errors
/// The same as for [`open`].
pub fn from_document(
    document: &Document,
    path: &Path,
    options: &Options,
    backend: Backend,
    limit: Option<Duration>,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Arc<dyn Shader<Rgb>>, MaterialError> {
    from_document_in(&(), document, path, options, backend, limit, progress)
}

/// Like [`from_document`], in the channels of a picture.
///
/// # Errors
/// The same as for [`open`].
pub fn from_document_in<T: Transport>(
    basis: &T::Basis,
    document: &Document,
    path: &Path,
    options: &Options,
    backend: Backend,
    limit: Option<Duration>,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Arc<dyn Shader<T>>, MaterialError> {
    if let Some(data) = document.only().and_then(Data::mirror)
        && data.scatter() == Scatter::Reflection
    {
        return Ok(Arc::new(DeltaShader(mirror::<T>(basis, data))));
    }
    let material = Material::from_document(document, options).map_err(|error| error.in_file(path))?;
    prepare(basis, material, path, backend, limit, progress)
}

/// Opens the files of a sheet, measured with light on its front and on its back, as [`Material::open_sheet`] does.
///
/// # Errors
/// [`MaterialError`] names the file.
pub fn open_sheet(
    front: &[PathBuf],
    back: &[PathBuf],
    options: &Options,
    backend: Backend,
) -> Result<Arc<dyn Shader<Rgb>>, MaterialError> {
    open_sheet_with_progress(front, back, options, backend, &mut |_, _| {})
}

/// Like [`open_sheet`], with `progress` as in [`open_with`].
///
/// # Errors
/// The same as for [`open_sheet`].
pub fn open_sheet_with_progress(
    front: &[PathBuf],
    back: &[PathBuf],
    options: &Options,
    backend: Backend,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Arc<dyn Shader<Rgb>>, MaterialError> {
    open_sheet_in(&(), front, back, options, backend, progress)
}

/// Like [`open_sheet_with_progress`], in the channels of a picture.
///
/// # Errors
/// The same as for [`open_sheet`].
pub fn open_sheet_in<T: Transport>(
    basis: &T::Basis,
    front: &[PathBuf],
    back: &[PathBuf],
    options: &Options,
    backend: Backend,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Arc<dyn Shader<T>>, MaterialError> {
    let first = front.iter().chain(back).next().cloned().unwrap_or_default();
    prepare(basis, Material::open_sheet(front, back, options)?, &first, backend, None, progress)
}

fn prepare<T: Transport>(
    basis: &T::Basis,
    material: Material,
    path: &Path,
    backend: Backend,
    limit: Option<Duration>,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Arc<dyn Shader<T>>, MaterialError> {
    let material = material.with_backend(backend);
    let bytes = limit.map(|limit| affordable(&material, limit));
    let options = SamplerOptions { bytes, ..SamplerOptions::default() };
    let shader = BsdfShader::<T>::measured_in(basis, material, &options, progress);
    Ok(Arc::new(shader.map_err(|why| MaterialError::Sampler { file: path.into(), why })?))
}

/// Bytes of histograms that are built in about this time.
fn affordable(material: &Material, limit: Duration) -> usize {
    const TRIALS: usize = 512;
    let direction = |k: usize| {
        let (z, turn) = ((k as f32 * 0.754_877_7).fract(), k as f32 * 2.4);
        let radius = (1.0 - z * z).max(0.0).sqrt();
        [radius * turn.cos(), radius * turn.sin(), z]
    };
    let (wi, wo): (Vec<_>, Vec<_>) = (0..TRIALS).map(|k| (direction(k), direction(7 * k + 3))).unzip();
    let mut values = vec![0.0; TRIALS * material.channel_count()];
    let begun = Instant::now();
    material.eval_batch(&wi, &wo, &mut values);
    let evaluations = limit.as_secs_f64() / begun.elapsed().as_secs_f64().max(1e-9) * TRIALS as f64;
    (0.5 * evaluations) as usize
}

/// Reflectance by the polar angle of the light, averaged over its azimuths.
fn mirror<T: Transport>(basis: &T::Basis, specular: &mirror::Data) -> Delta<T::Spectrum> {
    let [sigma, psi] = specular.knots();
    let spectra = T::measured(basis, specular.channels(), specular.values());
    let mean = |row: &[T::Spectrum]| -> T::Spectrum {
        let mut mean = T::Spectrum::ZERO;
        for (channel, mean) in mean.as_mut().iter_mut().enumerate() {
            *mean = (row.iter().map(|spectrum| spectrum.as_ref()[channel]).sum::<f32>() / row.len() as f32).max(0.0);
        }
        mean
    };
    let shares = sigma.iter().zip(spectra.chunks_exact(psi.len())).map(|(angle, row)| (*angle as f32, mean(row)));
    Delta::Measured(shares.collect())
}
