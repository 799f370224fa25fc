//! The class `Material`.

use numpy::prelude::*;
use numpy::{PyArray1, PyArray2, PyArrayDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::broadcast;
use crate::aspects::Asked;
use crate::batches::Vectors;
use crate::content::{Reduced, arrays, remake};
use crate::opened::Opened;
use crate::operations;
use crate::resampling;
use crate::results::{output, written};
use crate::sampler::Sampler;
use crate::saving;
use crate::tasks;
use crate::threads;

/// A measured material, in the representation in which it was measured: nothing is resampled.
///
/// Directions are unit vectors away from the surface, normal on +z: wi to the light, wo to the viewer. Values are f in
/// 1/sr, without the cosine, one per channel. Materials do not change, and threads may share one.
///
/// Use open(), from_bytes() or from_samples() to get one.
#[pyclass(frozen, module = "lobe_bsdf")]
pub struct Material {
    opened: Opened,
}

impl From<Opened> for Material {
    fn from(opened: Opened) -> Self {
        Material { opened }
    }
}

#[pymethods]
impl Material {
    /// The names of the channels, such as ("R", "G", "B").
    #[getter]
    fn channels<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.opened.material.channels().names())
    }

    /// The wavelength of each channel in nm, as an array, or None if channels are not wavelengths.
    #[getter]
    fn wavelengths<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.opened.material.wavelengths().map(|wavelengths| PyArray1::from_slice(py, wavelengths))
    }

    /// The representation, such as "specular table" or "EPFL database".
    #[getter]
    fn kind(&self) -> &'static str {
        self.opened.material.kind().name()
    }

    /// The name of the format of the file, or None if there is no file.
    #[getter]
    fn format(&self) -> Option<&'static str> {
        self.opened.material.format()
    }

    /// The facts in the header of the file: pairs of names and values, in the order of the file.
    #[getter]
    fn facts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.opened.material.source().iter().map(|(name, value)| (name, value)))
    }

    /// The assumptions that the reader made because facts were missing in the file, in sentences.
    #[getter]
    fn notes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.opened.subject.document.notes)
    }

    /// The measurements: some of "reflection front", "transmission front", "reflection back" and "transmission back".
    #[getter]
    fn aspects<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.opened.subject.aspects().iter().map(ToString::to_string))
    }

    /// True if values do not depend on the rotation of the sample.
    #[getter]
    fn is_isotropic(&self) -> bool {
        self.opened.material.is_isotropic()
    }

    /// The name of the backend that evaluates the material.
    #[getter]
    fn backend(&self) -> &'static str {
        self.opened.material.backend().name()
    }

    /// True if values have the same bits on all machines.
    #[getter]
    fn strict(&self) -> bool {
        self.opened.material.backend().is_strict()
    }

    /// Bytes of memory of the prepared data.
    #[getter]
    fn nbytes(&self) -> usize {
        self.opened.material.bytes()
    }

    /// The difference from the material from which this one was resampled; None if it was not resampled.
    #[getter]
    fn resampling<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.opened.resampling.as_ref().map(|found| resampling::shown(py, found)).transpose()
    }

    /// The measured values as arrays, under the names of the arguments of from_samples(). Raises ValueError if the
    /// representation is neither a grid of four angles nor scattered samples.
    fn arrays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = PyDict::new(py);
        match arrays(py, &self.opened.subject.document, &found)? {
            true => Ok(found),
            false => Err(PyValueError::new_err(format!(
                "found {}; expected a grid of four angles or scattered samples",
                self.opened.material.kind()
            ))),
        }
    }

    /// f in 1/sr, without the cosine, for light from wi to wo.
    ///
    /// wi and wo are unit vectors: arrays of shapes (..., 3) that broadcast. The result is float32 of shape (...,
    /// channels), and is written to `out` if it is given. Contiguous float32 is not copied, and neither are columns, as
    /// in the transpose of an array of shape (3, n); everything else is copied piece by piece. Large batches are shared
    /// among threads, without the lock of the interpreter.
    #[pyo3(signature = (wi, wo, *, out=None))]
    fn eval<'py>(
        &self,
        py: Python<'py>,
        wi: &Bound<'py, PyAny>,
        wo: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
        let (wi, wo) = (Vectors::<3>::new(wi, "wi")?, Vectors::<3>::new(wo, "wo")?);
        let mut shape = broadcast(["wi", "wo"], wi.shape(), wo.shape())?;
        let (wi, wo) = (wi.batch(&shape)?, wo.batch(&shape)?);
        let (wi, wo) = (wi.directions()?, wo.directions()?);
        let channels = self.opened.material.channel_count();
        shape.push(channels);
        let result = output(py, out, &shape)?;
        let mut written = written(&result)?;
        let values = written.as_slice_mut()?;
        let material = &self.opened.material;
        tasks::evaluate(py, [&wi, &wo], channels, values, &|wi, wo, values| material.eval_batch(wi, wo, values))?;
        drop(written);
        Ok(result)
    }

    /// The Mueller matrices in 1/sr, without the cosine, for light from wi to wo, in the Stokes frames of the Kaist
    /// database.
    ///
    /// At all wavelengths, in SIMD lanes: float32 of shape (..., channels, 4, 4), written to `out` if it is given. At
    /// one wavelength in nm, between the measured ones if necessary: float64 of shape (..., 4, 4), at many times the
    /// cost per matrix. Arrays are as in eval(). Raises ValueError if the material has no polarisation.
    #[pyo3(signature = (wi, wo, wavelength=None, *, out=None))]
    fn mueller<'py>(
        &self,
        py: Python<'py>,
        wi: &Bound<'py, PyAny>,
        wo: &Bound<'py, PyAny>,
        wavelength: Option<f64>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let material = &self.opened.material;
        if !material.is_polarised() {
            let found = material.kind();
            return Err(PyValueError::new_err(format!("found {found}; expected a material with polarisation")));
        }
        let (wi, wo) = (Vectors::<3>::new(wi, "wi")?, Vectors::<3>::new(wo, "wo")?);
        let mut shape = broadcast(["wi", "wo"], wi.shape(), wo.shape())?;
        let (wi, wo) = (wi.batch(&shape)?, wo.batch(&shape)?);
        let (wi, wo) = (wi.directions()?, wo.directions()?);
        let Some(wavelength) = wavelength else {
            let channels = material.channel_count();
            shape.extend([channels, 4, 4]);
            let result = output(py, out, &shape)?;
            let mut written = written(&result)?;
            let matrices = written.as_slice_mut()?;
            tasks::evaluate(py, [&wi, &wo], 16 * channels, matrices, &|wi, wo, matrices| {
                material.mueller_batch(wi, wo, matrices);
            })?;
            drop(written);
            return Ok(result.into_any());
        };
        if out.is_some() {
            return Err(PyValueError::new_err(
                "out: found with a wavelength; expected only matrices at all wavelengths",
            ));
        }
        let mut values = Vec::new();
        threads::batches(py, wi.count(), |part| {
            for index in part {
                let matrix = material.mueller(wi.get(index), wo.get(index), wavelength).unwrap_or_default();
                values.extend(matrix.into_iter().flatten());
            }
        })?;
        shape.extend([4, 4]);
        Ok(PyArray1::from_vec(py, values).reshape(shape)?.into_any())
    }

    /// A sampler, which samples directions in proportion to luminance times f times cosine. Building it takes a while.
    ///
    /// `defensive` is the cosine-weighted share of every distribution; `luminance` is the weight of each channel, by
    /// default according to its meaning.
    #[pyo3(signature = (*, defensive=0.05, luminance=None))]
    fn sampler(slf: Bound<'_, Self>, defensive: f32, luminance: Option<Vec<f32>>) -> PyResult<Sampler> {
        let material = slf.get().opened.material.clone();
        Sampler::build(slf.into_any(), material, defensive, luminance)
    }

    /// The measured directions of the light: an array of shape (n, 2) of polar angles and azimuths in radians.
    #[pyo3(signature = (*, scatter=None, side=None))]
    fn incidences<'py>(
        &self,
        py: Python<'py>,
        scatter: Option<&str>,
        side: Option<&str>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let aspect = Asked::new(scatter, side)?.of(&self.opened.subject)?;
        let angles: Vec<f64> = self.opened.subject.incidences(aspect).into_iter().flatten().collect();
        let count = angles.len() / 2;
        PyArray1::from_vec(py, angles).reshape([count, 2])
    }

    /// The albedo for light at polar angles theta and azimuths phi in radians, arrays that broadcast: the integral of f
    /// times cosine over the hemisphere, as float64 of shape (..., channels).
    ///
    /// `tolerance` is the absolute error to aim for. With `errors`, the result is a pair, and its second part is the
    /// estimated error of each integral, of shape (...). `scatter` and `side` select a measurement of a sheet.
    #[pyo3(signature = (theta, phi=None, *, scatter=None, side=None, tolerance=1e-4, errors=false))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of Python")]
    fn albedo<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        phi: Option<&Bound<'py, PyAny>>,
        scatter: Option<&str>,
        side: Option<&str>,
        tolerance: f64,
        errors: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let aspect = Asked::new(scatter, side)?.of(&self.opened.subject)?;
        operations::albedo(py, &self.opened.subject, aspect, [Some(theta), phi], tolerance, errors)
    }

    /// Checks the measurement: values, knots, coverage, energy, reciprocity and more. Returns a list of Finding.
    fn check<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        operations::check(py, &self.opened.subject)
    }

    /// Compares another material with this one, over `pairs` pairs of directions with polar angles up to `limit` in
    /// radians. Returns a Difference. Materials with the same channels are compared in these channels, others in CIE
    /// XYZ.
    #[pyo3(signature = (other, *, scatter=None, side=None, pairs=100_000, limit=operations::LIMIT))]
    fn compare<'py>(
        &self,
        other: &Bound<'py, Material>,
        scatter: Option<&str>,
        side: Option<&str>,
        pairs: usize,
        limit: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let asked = Asked::new(scatter, side)?;
        let theirs = other.get().opened.subject.aspects();
        let mut shared = self.opened.subject.aspects();
        shared.retain(|aspect| theirs.contains(aspect));
        operations::compare(
            other.py(),
            [&self.opened.subject, &other.get().opened.subject],
            asked.one(&shared)?,
            pairs,
            limit,
        )
    }

    /// Resamples this material to a table in specular coordinates, whose attribute `resampling` is the difference.
    ///
    /// Axes that are not given, in radians, get the knots that keep the interpolation error below `error`, relative to
    /// the largest value, or with `per_value` to each value above a thousandth of that. The default of `error` is 0.01,
    /// as an aim. Errors count up to polar angles of `limit`. Raises ValueError if a given `error` cannot be met.
    #[pyo3(signature = (error=None, *, sigma=None, psi=None, theta=None, phi=None, per_value=false, limit=resampling::LIMIT,
        scatter=None, side=None))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of Python")]
    fn resample(
        &self,
        py: Python<'_>,
        error: Option<f64>,
        sigma: Option<Vec<f64>>,
        psi: Option<Vec<f64>>,
        theta: Option<Vec<f64>>,
        phi: Option<Vec<f64>>,
        per_value: bool,
        limit: f64,
        scatter: Option<&str>,
        side: Option<&str>,
    ) -> PyResult<Material> {
        let aspect = Asked::new(scatter, side)?.of(&self.opened.subject)?;
        let wanted = resampling::Wanted { error, per_value, limit, axes: [sigma, psi, theta, phi] };
        resampling::resample(py, &self.opened, aspect, wanted).map(Material::from)
    }

    /// Writes a file. Its format is `format` (see formats()), or given by the extension of the file name. The values
    /// and knots are written unchanged if the format has their representation. Otherwise this is an error, unless
    /// `resample` is true: then the material is evaluated at the nodes of the format.
    ///
    /// Returns a Saved, with the error of the file: its difference from this material at 100,000 pairs of directions, up
    /// to polar angles of 85 degrees. With `error`, nodes are refined until its relative root mean square is at most
    /// that; raises ValueError, and writes no file, if this cannot be reached.
    ///
    /// `channel` is the channel to write if the format has only one, and `scatter`, "reflection" or "transmission", the
    /// measurement to write of a material that has both.
    #[pyo3(signature = (path, format=None, *, channel=None, resample=false, error=None, scatter=None))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments of Python")]
    fn save<'py>(
        &self,
        py: Python<'py>,
        path: std::path::PathBuf,
        format: Option<&str>,
        channel: Option<&str>,
        resample: bool,
        error: Option<f64>,
        scatter: Option<&str>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let scatter = scatter.map(crate::aspects::scatter).transpose()?;
        let wanted = saving::Wanted { format, channel, resample, scatter, error };
        saving::save(py, &self.opened.subject, &path, &wanted)
    }

    /// It is immutable, so it is its own copy.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let remade = py.import("lobe_bsdf._copies")?.getattr("remade")?;
        Ok((remade, remake(py, &self.opened.content, &self.opened.subject, &self.opened.choices)?))
    }

    fn __repr__(&self) -> String {
        let channels = self.opened.material.channels().names();
        let channels = match channels.len() {
            0..=4 => channels.join(" "),
            count => format!("{count} channels, {} to {}", channels[0], channels[count - 1]),
        };
        let format = self.opened.material.format().map(|format| format!(" from {format}")).unwrap_or_default();
        let form = if self.strict() { ", strict" } else { "" };
        format!("<lobe_bsdf.Material: {}{format}, {channels}; {}{form}>", self.opened.material.kind(), self.backend())
    }
}
