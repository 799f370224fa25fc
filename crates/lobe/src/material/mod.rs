//! A measured material, whatever its representation, ready to be evaluated.

mod frames;
mod mirror;
mod open;
mod sheet;

use std::sync::Arc;

use lobe_table::bsdf::OnBackend;
use lobe_table::mueller::Matrix;
use lobe_table::{Aspect, Bsdf, Channels, Directions, Kind, Scatter, Side, specular};

use crate::error::{ShapeError, expect, fitting};
use crate::{Backend, parallel};
pub(crate) use frames::flipped;
use mirror::Mirror;
pub(crate) use mirror::mirrored;
pub use sheet::SHEET;

/// The source of a material.
#[derive(Clone, Debug)]
struct Origin {
    format: Option<&'static str>,
    source: Vec<(String, String)>,
    kind: Kind,
}

/// A measured material in the form in which it was measured: nothing is resampled.
///
/// `wi` points to the light and `wo` to the viewer: unit vectors away from the surface, normal on +z. Values are `f` in
/// 1/sr, without the cosine, one per channel. All representations are evaluated in the SIMD lanes of the backend.
///
/// Batches of [`PARALLEL_FROM`](crate::PARALLEL_FROM) queries or more are divided among the threads of the current
/// rayon pool (feature `rayon`); results have the same bits for any number of threads.
///
/// ```no_run
/// let material = lobe::Material::open("paint.bsdf")?;
/// println!("{} with {}", material.kind(), material.channels().names().join(" "));
/// let wi = [[0.5, 0.0, 0.866], [0.0, 0.6, 0.8]];
/// let wo = [[-0.5, 0.0, 0.866], [0.0, -0.6, 0.8]];
/// let mut f = vec![0.0; wi.len() * material.channel_count()];
/// material.eval_batch(&wi, &wo, &mut f);
/// # Ok::<(), lobe::OpenError>(())
/// ```
///
/// Clones share the prepared tables.
#[derive(Clone, Debug)]
pub struct Material {
    origin: Origin,
    bsdf: Arc<dyn Bsdf>,
    mirrors: Vec<Mirror>,
    backend: Backend,
}

impl Material {
    /// The same material on another backend.
    pub fn with_backend(self, backend: Backend) -> Self {
        Material { backend, ..self }
    }

    /// The backend that evaluates the material.
    pub fn backend(&self) -> Backend {
        self.backend
    }

    /// The name of the format of the file, if it was read from one.
    pub fn format(&self) -> Option<&'static str> {
        self.origin.format
    }

    /// The representation: the `KIND` of its module, or [`SHEET`].
    pub fn kind(&self) -> Kind {
        self.origin.kind
    }

    /// The facts in the header of the file: names and values, in its order.
    pub fn source(&self) -> &[(String, String)] {
        &self.origin.source
    }

    /// The meaning of the channels.
    pub fn channels(&self) -> &Channels {
        self.bsdf.channels()
    }

    /// The number of channels of a value.
    pub fn channel_count(&self) -> usize {
        self.channels().count()
    }

    /// The wavelength of each channel in nm, if channels are wavelengths.
    pub fn wavelengths(&self) -> Option<&[f64]> {
        match self.channels() {
            Channels::Spectral(wavelengths) => Some(wavelengths),
            _ => None,
        }
    }

    /// Bytes of memory that the data take.
    pub fn bytes(&self) -> usize {
        self.bsdf.bytes()
    }

    /// `true` if values do not depend on the rotation of the sample.
    pub fn is_isotropic(&self) -> bool {
        self.bsdf.is_isotropic()
    }

    /// `true` if there are values for light from a side that is reflected or transmitted.
    pub fn holds(&self, aspect: Aspect) -> bool {
        self.bsdf.holds(aspect)
    }

    /// Writes the share of the light from `wi` that is mirrored or goes straight through to `out`, one value per
    /// channel, and returns the direction in which it continues; `None` if that was not measured. Such light has no
    /// value for a pair of directions.
    ///
    /// # Panics
    /// If the length of `out` is not the number of channels.
    pub fn mirror(&self, wi: [f32; 3], scatter: Scatter, out: &mut [f32]) -> Option<[f32; 3]> {
        let aspect = Aspect { scatter, light: Side::of(wi) };
        let mirror = self.mirrors.iter().find(|mirror| mirror.answers(aspect))?;
        out.copy_from_slice(&mirror.reflectance(wi));
        Some(mirrored(wi, scatter))
    }

    /// `true` if there is a [mirror](Material::mirror).
    pub fn has_mirrors(&self) -> bool {
        !self.mirrors.is_empty()
    }

    /// The table, if the material is one in specular coordinates: for its axes, and for evaluation in lanes inside your
    /// own kernel.
    pub fn specular_table(&self) -> Option<&Arc<specular::Table>> {
        self.bsdf.specular_table()
    }

    /// The function without the backend, for code that takes any [`Bsdf`].
    pub fn bsdf(&self) -> &dyn Bsdf {
        &*self.bsdf
    }

    /// Evaluates one pair into `out`, one value per channel. For many pairs use [`eval_batch`](Material::eval_batch).
    ///
    /// # Panics
    /// If the length of `out` is not the number of channels.
    pub fn eval(&self, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) {
        fitting(self.try_eval(wi, wo, out));
    }

    /// Like [`eval`](Material::eval), with an error instead of a panic.
    ///
    /// # Errors
    /// If the length of `out` is not the number of channels.
    pub fn try_eval(&self, wi: [f32; 3], wo: [f32; 3], out: &mut [f32]) -> Result<(), ShapeError> {
        expect("values", out.len(), self.channel_count())?;
        self.bsdf.eval(self.backend, wi, wo, out);
        Ok(())
    }

    /// Evaluates many pairs: `out[query * channel_count + channel]`. `wi` and `wo` are slices of vectors, or
    /// [columns](Directions::columns) of components.
    ///
    /// # Panics
    /// If the numbers of `wi` and `wo` differ, or the length of `out` is not that number times the number of channels.
    pub fn eval_batch<'a>(&self, wi: impl Into<Directions<'a>>, wo: impl Into<Directions<'a>>, out: &mut [f32]) {
        fitting(self.try_eval_batch(wi, wo, out));
    }

    /// Like [`eval_batch`](Material::eval_batch), with an error instead of a panic.
    ///
    /// # Errors
    /// If the numbers of `wi` and `wo` differ, or the length of `out` is not that number times the number of channels.
    pub fn try_eval_batch<'a>(
        &self,
        wi: impl Into<Directions<'a>>,
        wo: impl Into<Directions<'a>>,
        out: &mut [f32],
    ) -> Result<(), ShapeError> {
        self.try_eval_on(self.backend, wi.into(), wo.into(), out)
    }

    /// Like [`eval_batch`](Material::eval_batch), but on the given backend: for a renderer that chooses one backend for
    /// a whole picture.
    ///
    /// # Panics
    /// The same as for [`eval_batch`](Material::eval_batch).
    pub fn eval_batch_on<'a>(
        &self,
        backend: Backend,
        wi: impl Into<Directions<'a>>,
        wo: impl Into<Directions<'a>>,
        out: &mut [f32],
    ) {
        fitting(self.try_eval_on(backend, wi.into(), wo.into(), out));
    }

    fn try_eval_on(
        &self,
        backend: Backend,
        wi: Directions<'_>,
        wo: Directions<'_>,
        out: &mut [f32],
    ) -> Result<(), ShapeError> {
        let (count, channels) = (length(wi)?, self.channel_count());
        expect("directions wo", length(wo)?, count)?;
        expect("values", out.len(), count * channels)?;
        parallel::fill(channels, out, &|range, out| {
            self.bsdf.eval_batch(backend, wi.part(range.clone()), wo.part(range), out);
        });
        Ok(())
    }

    /// The Mueller matrix in 1/sr for light from `wi` to `wo` at a wavelength in nm, in the Stokes frames of
    /// [`stokes_basis`](lobe_table::mueller::stokes_basis). `None` if the representation has no polarisation.
    ///
    /// In `f64`; for many pairs use [`mueller_batch`](Material::mueller_batch).
    pub fn mueller(&self, wi: [f32; 3], wo: [f32; 3], nm: f64) -> Option<Matrix> {
        self.bsdf.mueller(wi, wo, nm)
    }

    /// `true` if there are Mueller matrices for pairs of directions.
    pub fn is_polarised(&self) -> bool {
        self.bsdf.is_polarised()
    }

    /// The Mueller matrices of many pairs in 1/sr, without the cosine, at every wavelength of the channels, in the SIMD
    /// lanes of the backend: `out[query][channel][row][column]`, 16 floats per matrix in C order, with the Stokes
    /// frames of [`mueller`](Material::mueller). `false` if the representation has no polarisation, which leaves `out`
    /// unchanged.
    ///
    /// # Panics
    /// If the numbers of `wi` and `wo` differ, or the length of `out` is not that number times 16 times the number of
    /// channels.
    pub fn mueller_batch<'a>(
        &self,
        wi: impl Into<Directions<'a>>,
        wo: impl Into<Directions<'a>>,
        out: &mut [f32],
    ) -> bool {
        fitting(self.try_mueller_on(self.backend, wi.into(), wo.into(), out))
    }

    /// Like [`mueller_batch`](Material::mueller_batch), with an error instead of a panic.
    ///
    /// # Errors
    /// If the numbers of `wi` and `wo` differ, or the length of `out` is not that number times 16 times the number of
    /// channels.
    pub fn try_mueller_batch<'a>(
        &self,
        wi: impl Into<Directions<'a>>,
        wo: impl Into<Directions<'a>>,
        out: &mut [f32],
    ) -> Result<bool, ShapeError> {
        self.try_mueller_on(self.backend, wi.into(), wo.into(), out)
    }

    fn try_mueller_on(
        &self,
        backend: Backend,
        wi: Directions<'_>,
        wo: Directions<'_>,
        out: &mut [f32],
    ) -> Result<bool, ShapeError> {
        if !self.is_polarised() {
            return Ok(false);
        }
        let (count, width) = (length(wi)?, 16 * self.channel_count());
        expect("directions wo", length(wo)?, count)?;
        expect("elements of matrices", out.len(), count * width)?;
        parallel::fill(width, out, &|range, out| {
            self.bsdf.mueller_batch(backend, wi.part(range.clone()), wo.part(range), out);
        });
        Ok(true)
    }
}

/// The number of directions.
fn length(directions: Directions<'_>) -> Result<usize, ShapeError> {
    match directions {
        Directions::Vectors(vectors) => Ok(vectors.len()),
        Directions::Columns([x, y, z]) => {
            expect("components y", y.len(), x.len())?;
            expect("components z", z.len(), x.len())?;
            Ok(x.len())
        }
    }
}

/// Evaluates like [`Material::eval_batch_on`], and samples in proportion to the cosine; a [`Sampler`](crate::Sampler)
/// samples better. [Mirrors](Material::mirror) have no value and no density.
impl Bsdf for Material {
    fn channels(&self) -> &Channels {
        self.bsdf.channels()
    }

    fn holds(&self, aspect: Aspect) -> bool {
        self.bsdf.holds(aspect)
    }

    fn is_isotropic(&self) -> bool {
        self.bsdf.is_isotropic()
    }

    fn bytes(&self) -> usize {
        self.bsdf.bytes()
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.eval_batch_on(backend, wi, wo, out);
    }

    fn mueller(&self, wi: [f32; 3], wo: [f32; 3], nm: f64) -> Option<Matrix> {
        self.bsdf.mueller(wi, wo, nm)
    }

    fn is_polarised(&self) -> bool {
        self.bsdf.is_polarised()
    }

    fn mueller_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) -> bool {
        fitting(self.try_mueller_on(backend, wi, wo, out))
    }

    fn specular_table(&self) -> Option<&Arc<specular::Table>> {
        self.bsdf.specular_table()
    }
}

impl<'a> From<&'a Material> for OnBackend<'a> {
    fn from(material: &'a Material) -> Self {
        OnBackend::new(material, material.backend)
    }
}
