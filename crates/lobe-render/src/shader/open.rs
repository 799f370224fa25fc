//! Opens materials from files of any format.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use lobe::formats::{Document, FormatError};
use lobe::table::{Data, mirror};
use lobe::{Aspect, Material, OpenError, Options, Sampler, SamplerError, SamplerOptions, Scatter, Side};

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

/// A material of a picture, ready to be evaluated and sampled.
#[derive(Debug)]
pub struct Prepared<T: Transport = Rgb> {
    /// The material.
    pub shader: Arc<dyn Shader<T>>,
    /// `true` if directions are sampled from coarser distributions than without a limit of time.
    pub is_limited: bool,
}

/// Opens any file that [`lobe`] can open as a material of a picture.
///
/// # Errors
/// [`MaterialError`] names the file.
pub fn open(path: &Path, options: &Options, backend: Backend) -> Result<Arc<dyn Shader<Rgb>>, MaterialError> {
    open_with(path, options, backend, None, &mut |_, _| {})
}

/// Like [`open`], but calls `progress(done, all)` after each slice of the distributions from which directions are
/// sampled. If they would take longer than `limit` to build, coarser ones are built, which gives more noise.
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
    Ok(from_document(&lobe::formats::open(path)?.1, path, options, backend, limit, progress)?.shader)
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
) -> Result<Prepared, MaterialError> {
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
) -> Result<Prepared<T>, MaterialError> {
    if let Some(data) = document.only().and_then(Data::mirror)
        && data.scatter() == Scatter::Reflection
    {
        return Ok(Prepared { shader: Arc::new(DeltaShader(mirror::<T>(basis, data))), is_limited: false });
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
    Ok(prepare(basis, Material::open_sheet(front, back, options)?, &first, backend, None, progress)?.shader)
}

fn prepare<T: Transport>(
    basis: &T::Basis,
    material: Material,
    path: &Path,
    backend: Backend,
    limit: Option<Duration>,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Prepared<T>, MaterialError> {
    let material = material.with_backend(backend);
    let evaluations = limit.map(|limit| affordable(&material, limit));
    let options = SamplerOptions { evaluations, ..SamplerOptions::default() };
    let refused = |why| MaterialError::Sampler { file: path.into(), why };
    let sampler = Sampler::with_progress(Arc::new(material), &options, progress).map_err(refused)?;
    let is_limited = sampler.is_limited();
    Ok(Prepared { shader: Arc::new(BsdfShader::<T>::new_in(basis, Arc::new(sampler), backend)), is_limited })
}

/// The number of pairs of directions that are evaluated in this time, as distributions do it: many directions for one
/// of the light, on each side that the material scatters to.
fn affordable(material: &Material, limit: Duration) -> usize {
    const BATCH: usize = 128;
    /// The trials take about this part of the limit.
    const SHARE: u32 = 50;
    let direction = |k: usize| {
        let (z, turn) = ((k as f32 * 0.754_877_7).fract(), k as f32 * 2.4);
        let radius = (1.0 - z * z).max(0.0).sqrt();
        [radius * turn.cos(), radius * turn.sin(), z]
    };
    let flipped = |[x, y, z]: [f32; 3], is_down: bool| if is_down { [x, y, -z] } else { [x, y, z] };
    let aspects: Vec<Aspect> = Aspect::ALL.into_iter().filter(|&aspect| material.holds(aspect)).collect();
    if aspects.is_empty() {
        return usize::MAX;
    }
    let mut values = vec![0.0; BATCH * material.channel_count()];
    let mut begun = Instant::now();
    let mut pairs = 0;
    for round in 0.. {
        for aspect in &aspects {
            let is_back = aspect.light == Side::Back;
            let is_below = is_back != (aspect.scatter == Scatter::Transmission);
            let wi = [flipped(direction(round + 1), is_back); BATCH];
            let wo: Vec<_> = (0..BATCH).map(|k| flipped(direction(BATCH * round + k), is_below)).collect();
            material.eval_batch(&wi, &wo, &mut values);
            pairs += BATCH;
        }
        if begun.elapsed() >= limit / SHARE {
            break;
        }
        if round == 0 {
            // The first values are slow, because the table is not in any cache yet.
            (begun, pairs) = (Instant::now(), 0);
        }
    }
    (limit.as_secs_f64() / begun.elapsed().as_secs_f64().max(1e-9) * pairs as f64) as usize
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
