//! The class `Sampler`.

use std::borrow::Cow;
use std::sync::Arc;

use lobe::{Directions, Sampled, SamplerOptions};
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::broadcast;
use crate::batches::Vectors;
use crate::errors::Failure;
use crate::options::given;
use crate::results::{output, written};
use crate::tasks;
use crate::threads;

type Floats<'py> = Bound<'py, PyArrayDyn<f32>>;

/// Samples directions for a material in proportion to luminance times f times cosine.
///
/// Directions are unit vectors away from the surface, normal on +z; densities are per steradian. Material.sampler()
/// creates samplers; threads may share one.
#[pyclass(frozen, module = "lobe_bsdf")]
pub struct Sampler {
    sampler: lobe::Sampler,
    material: Py<PyAny>,
    defensive: f32,
    luminance: Option<Vec<f32>>,
}

impl Sampler {
    /// Builds the distributions of a material, whose Python object is `owner`.
    ///
    /// # Errors
    /// `ValueError` if the options are invalid for it.
    pub fn build(
        owner: Bound<'_, PyAny>,
        material: Arc<lobe::Material>,
        defensive: f32,
        luminance: Option<Vec<f32>>,
    ) -> PyResult<Self> {
        let options = SamplerOptions { defensive, luminance: luminance.clone(), ..SamplerOptions::default() };
        let sampler = threads::watched(owner.py(), |watch| {
            lobe::Sampler::with_progress(material, &options, &mut |_, _| watch.check())
        });
        let sampler = sampler?.map_err(|error| PyErr::from(Failure::value(error)))?;
        Ok(Sampler { sampler, material: owner.unbind(), defensive, luminance })
    }
}

#[pymethods]
impl Sampler {
    /// The material that is sampled.
    #[getter]
    fn material(&self, py: Python<'_>) -> Py<PyAny> {
        self.material.clone_ref(py)
    }

    /// Bytes of memory of the distributions, in addition to the material.
    #[getter]
    fn nbytes(&self) -> usize {
        self.sampler.bytes()
    }

    /// Samples a direction for each direction w, which is the direction of the light if `given` is "light", or of the
    /// viewer if it is "viewer".
    ///
    /// w is an array of unit vectors of shape (..., 3), u of numbers in [0, 1) of shape (..., 2); they broadcast. The
    /// result is the directions (..., 3), their densities (...), and the weights (..., channels): f times cosine over
    /// the density. If no direction was sampled, all three are 0; a mirror has an infinite density.
    #[pyo3(signature = (w, u, *, given="light"))]
    fn sample<'py>(
        &self,
        py: Python<'py>,
        w: &Bound<'py, PyAny>,
        u: &Bound<'py, PyAny>,
        given: &str,
    ) -> PyResult<(Floats<'py>, Floats<'py>, Floats<'py>)> {
        let given = self::given(given)?;
        let (w, u) = (Vectors::<3>::new(w, "w")?, Vectors::<2>::new(u, "u")?);
        let shape = broadcast(["w", "u"], w.shape(), u.shape())?;
        let (w, u) = (w.batch(&shape)?, u.batch(&shape)?);
        let (known, u) = (w.rows_of_directions()?, u.rows());
        let channels = self.sampler.material().channel_count();
        let with = |last: &[usize]| output(py, None, &[shape.as_slice(), last].concat());
        let (directions, pdfs, weights) = (with(&[3])?, with(&[])?, with(&[channels])?);
        let (mut of_directions, mut of_pdfs, mut of_weights) =
            (written(&directions)?, written(&pdfs)?, written(&weights)?);
        let all = of_directions.as_slice_mut()?.as_chunks_mut::<3>().0;
        let (all_pdfs, all_weights) = (of_pdfs.as_slice_mut()?, of_weights.as_slice_mut()?);
        let out = Sampled { directions: all, weights: all_weights, pdfs: all_pdfs };
        if let Some(index) = tasks::sample(py, &self.sampler, given, &known, &u, out)? {
            let message = format!("u: found {:?} at {index}; expected numbers in [0, 1)", u.get(index));
            return Err(Failure::Value(message).into());
        }
        drop((of_directions, of_pdfs, of_weights));
        Ok((directions, pdfs, weights))
    }

    /// The density per steradian with which sample() finds the direction that is not given, without mirrors. wi and wo
    /// have shapes (..., 3) that broadcast; the result is float32 of shape (...).
    #[pyo3(signature = (wi, wo, *, given="light"))]
    fn pdf<'py>(
        &self,
        py: Python<'py>,
        wi: &Bound<'py, PyAny>,
        wo: &Bound<'py, PyAny>,
        given: &str,
    ) -> PyResult<Floats<'py>> {
        let given = self::given(given)?;
        let (wi, wo) = (Vectors::<3>::new(wi, "wi")?, Vectors::<3>::new(wo, "wo")?);
        let shape = broadcast(["wi", "wo"], wi.shape(), wo.shape())?;
        let (wi, wo) = (wi.batch(&shape)?, wo.batch(&shape)?);
        let (wi, wo) = (wi.rows_of_directions()?, wo.rows_of_directions()?);
        let result = output(py, None, &shape)?;
        let mut written = written(&result)?;
        let pdfs = written.as_slice_mut()?;
        tasks::evaluate(py, [&wi, &wo], 1, pdfs, &|wi, wo, pdfs| {
            self.sampler.pdf_batch(given, &vectors(wi), &vectors(wo), pdfs);
        })?;
        drop(written);
        Ok(result)
    }

    /// It is immutable, so it is its own copy.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let resampled = py.import("lobe_bsdf._copies")?.getattr("sampler_of")?;
        let arguments = (self.material.clone_ref(py), self.defensive, self.luminance.clone()).into_pyobject(py)?;
        Ok((resampled, arguments))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("<lobe_bsdf.Sampler of {}>", self.material.bind(py).repr()?))
    }
}

/// Directions as vectors, which those that were asked for in rows are already.
fn vectors(directions: Directions<'_>) -> Cow<'_, [[f32; 3]]> {
    match directions {
        Directions::Vectors(rows) => rows.into(),
        columns => (0..columns.count()).map(|index| columns.get(index)).collect::<Vec<_>>().into(),
    }
}
