//! Arrays of vectors: anything that NumPy understands, as slices that kernels read. `float32` whose vectors, or whose columns
//! of components, lie next to each other is read where it is.

use lobe::Directions;
use numpy::prelude::*;
use numpy::{PyArrayDyn, PyReadonlyArrayDyn, PyReadwriteArrayDyn};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// How far the square of the length of a unit vector may be from 1: vectors with three digits pass.
const LENGTH: f32 = 5e-3;
/// At most as many vectors of a batch are checked, evenly chosen: whoever forgets to normalise forgets it for most.
const CHECKED: usize = 1024;

/// An array of real numbers as `float32`.
///
/// # Errors
/// `TypeError` if it holds anything else, or has masked values.
pub fn floats<'py>(value: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
    if let Ok(array) = value.cast::<PyArrayDyn<f32>>()
        && array.is_aligned()
        && array.is_exact_instance_of::<PyArrayDyn<f32>>()
    {
        return Ok(array.clone());
    }
    Ok(numbers(value, name)?.call_method1("astype", ("float32",))?.cast_into()?)
}

/// The same as `float64`, for angles.
///
/// # Errors
/// As [`floats`].
pub fn doubles<'py>(value: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    Ok(numbers(value, name)?.call_method1("astype", ("float64",))?.cast_into()?)
}

/// An array of real numbers of any type.
fn numbers<'py>(value: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    let py = value.py();
    let numpy = py.import("numpy")?;
    if value.hasattr("mask")? && value.hasattr("filled")? {
        return Err(PyTypeError::new_err(format!(
            "{name}: found an array with a mask; expected one whose values all count (its compressed(), for example)"
        )));
    }
    let is_foreign = !value.hasattr("__array__")? && !value.hasattr("__array_interface__")?;
    let array = match is_foreign && value.hasattr("__dlpack__")? {
        true => numpy.call_method1("from_dlpack", (value,))?,
        false => numpy.call_method1("asarray", (value,))?,
    };
    let dtype = array.getattr("dtype")?;
    let kind: String = dtype.getattr("kind")?.extract()?;
    match kind.as_str() {
        "f" | "i" | "u" => Ok(array),
        _ => Err(PyTypeError::new_err(format!("{name}: found an array of {dtype}; expected real numbers"))),
    }
}

/// The shape that two broadcast to.
///
/// # Errors
/// `ValueError` if they do not.
pub fn broadcast(names: [&str; 2], a: &[usize], b: &[usize]) -> PyResult<Vec<usize>> {
    let count = a.len().max(b.len());
    let at = |shape: &[usize], axis: usize| (axis + shape.len()).checked_sub(count).map_or(1, |axis| shape[axis]);
    let axes = (0..count).map(|axis| match (at(a, axis), at(b, axis)) {
        (1, other) | (other, 1) => Some(other),
        (one, other) if one == other => Some(one),
        _ => None,
    });
    axes.collect::<Option<Vec<usize>>>().ok_or_else(|| {
        let [first, second] = names;
        PyValueError::new_err(format!(
            "found {first} of shape {} and {second} of shape {}, without the last axis; expected shapes that broadcast",
            shown(a),
            shown(b)
        ))
    })
}

/// A shape as Python writes it.
pub fn shown(shape: &[usize]) -> String {
    match shape {
        [one] => format!("({one},)"),
        _ => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// Vectors of `N` components, in an array that lives as long as this.
pub struct Vectors<'py, const N: usize> {
    name: &'static str,
    array: Bound<'py, PyArrayDyn<f32>>,
}

impl<'py, const N: usize> Vectors<'py, N> {
    /// Takes an array of shape `(..., N)`.
    ///
    /// # Errors
    /// `ValueError` if its last axis has another length.
    pub fn new(value: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        let array = floats(value, name)?;
        match array.shape().last() {
            Some(&last) if last == N => Ok(Vectors { name, array }),
            _ => Err(PyValueError::new_err(format!(
                "{name}: found an array of shape {}; expected (..., {N})",
                shown(array.shape())
            ))),
        }
    }

    /// The shape without the last axis.
    pub fn shape(&self) -> &[usize] {
        &self.array.shape()[..self.array.shape().len() - 1]
    }

    /// The vectors of a batch of this shape, which they are repeated to.
    ///
    /// # Errors
    /// If something writes to the array.
    pub fn batch(self, shape: &[usize]) -> PyResult<Batch<'py, N>> {
        let may_be_columns = has_columns(&self.array);
        self.laid_out(shape, may_be_columns)
    }

    /// As [`batch`](Self::batch), each vector in one piece.
    ///
    /// # Errors
    /// As [`batch`](Self::batch).
    pub fn batch_of_rows(self, shape: &[usize]) -> PyResult<Batch<'py, N>> {
        self.laid_out(shape, false)
    }

    fn laid_out(self, shape: &[usize], are_columns: bool) -> PyResult<Batch<'py, N>> {
        let is_whole = self.shape() == shape;
        let array = match is_whole && (self.array.is_c_contiguous() || are_columns) {
            true => self.array,
            false => {
                let numpy = self.array.py().import("numpy")?;
                let full = PyTuple::new(self.array.py(), [shape, &[N]].concat())?;
                let wide = numpy.call_method1("broadcast_to", (&self.array, full))?;
                numpy.call_method1("ascontiguousarray", (wide,))?.cast_into()?
            }
        };
        let array = array.try_readonly().map_err(|error| PyValueError::new_err(format!("{}: {error}", self.name)))?;
        Ok(Batch { name: self.name, array })
    }
}

/// Whether all components of the same name lie next to each other, as in the transpose of an array of columns.
fn has_columns(array: &Bound<'_, PyArrayDyn<f32>>) -> bool {
    let (shape, strides) = (array.shape(), array.strides());
    let mut next = size_of::<f32>() as isize;
    for axis in (0..shape.len() - 1).rev() {
        if shape[axis] != 1 && strides[axis] != next {
            return false;
        }
        next *= shape[axis] as isize;
    }
    true
}

/// Vectors that a kernel can read.
pub struct Batch<'py, const N: usize> {
    name: &'static str,
    array: PyReadonlyArrayDyn<'py, f32>,
}

impl<const N: usize> Batch<'_, N> {
    /// The vectors, if they lie one after the other.
    pub fn rows(&self) -> Option<&[[f32; N]]> {
        self.array.as_array().to_slice().map(|values| values.as_chunks().0)
    }
}

impl Batch<'_, 3> {
    /// The directions, in either layout.
    ///
    /// # Errors
    /// `ValueError` if they are not of unit length; vectors of zero length are no directions, and pass.
    pub fn directions(&self) -> PyResult<Directions<'_>> {
        let directions = match self.rows() {
            Some(rows) => Directions::Vectors(rows),
            None => {
                let view = self.array.as_array();
                let last = numpy::ndarray::Axis(view.ndim() - 1);
                let column = |k| view.clone().index_axis_move(last, k);
                let columns = [0, 1, 2].map(|k| column(k).to_slice());
                match columns {
                    [Some(x), Some(y), Some(z)] => Directions::Columns([x, y, z]),
                    _ => return Err(PyValueError::new_err(format!("{}: found no vectors", self.name))),
                }
            }
        };
        let count = directions.count();
        for index in (0..count).step_by(count.div_ceil(CHECKED).max(1)) {
            let [x, y, z] = directions.get(index);
            let square = x * x + y * y + z * z;
            if (square - 1.0).abs() > LENGTH && square != 0.0 {
                return Err(PyValueError::new_err(format!(
                    "{}: found vector {index}, ({x}, {y}, {z}), of length {}; expected unit vectors (normalize() makes them)",
                    self.name,
                    square.sqrt()
                )));
            }
        }
        Ok(directions)
    }

    /// The directions as vectors; columns are copied.
    ///
    /// # Errors
    /// As [`directions`](Self::directions).
    pub fn vectors(&self) -> PyResult<std::borrow::Cow<'_, [[f32; 3]]>> {
        Ok(match self.directions()? {
            Directions::Vectors(rows) => rows.into(),
            columns => (0..columns.count()).map(|index| columns.get(index)).collect::<Vec<_>>().into(),
        })
    }
}

/// A new array of zeros, or the one to write to.
///
/// # Errors
/// `MemoryError`; `ValueError` if the array is of another shape or type, or cannot be written to.
pub fn output<'py>(
    py: Python<'py>,
    out: Option<&Bound<'py, PyAny>>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
    let Some(out) = out else {
        let shape = PyTuple::new(py, shape)?;
        return Ok(py.import("numpy")?.call_method1("zeros", (shape, "float32"))?.cast_into()?);
    };
    match out.cast::<PyArrayDyn<f32>>() {
        Ok(array) if array.shape() == shape && array.is_c_contiguous() && array.is_aligned() => Ok(array.clone()),
        _ => Err(PyValueError::new_err(format!(
            "out: found {}; expected a contiguous array of float32 of shape {}",
            described(out),
            shown(shape)
        ))),
    }
}

fn described(value: &Bound<'_, PyAny>) -> String {
    let attribute = |name: &str| value.getattr(name).map(|found| found.to_string());
    match (attribute("dtype"), attribute("shape")) {
        (Ok(dtype), Ok(shape)) => format!("an array of {dtype} of shape {shape}"),
        _ => format!("a {}", value.get_type()),
    }
}

/// The values to write to.
///
/// # Errors
/// `ValueError` if something else uses the array, or it is read-only.
pub fn written<'py>(array: &Bound<'py, PyArrayDyn<f32>>) -> PyResult<PyReadwriteArrayDyn<'py, f32>> {
    array.try_readwrite().map_err(|error| PyValueError::new_err(format!("out: {error}")))
}

/// Unit vectors with the directions of v, an array of shape (..., 3), as float32.
///
/// They are rounded once, and are the same bits as those that the program lobe makes of its arguments. ValueError if a vector
/// is zero or not finite.
#[pyo3::pyfunction]
pub fn normalize<'py>(v: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
    let array = doubles(v, "v")?;
    if array.shape().last() != Some(&3) {
        return Err(PyValueError::new_err(format!(
            "v: found an array of shape {}; expected (..., 3)",
            shown(array.shape())
        )));
    }
    let array = array.try_readonly().map_err(|error| PyValueError::new_err(error.to_string()))?;
    let result = output(v.py(), None, array.shape())?;
    let mut written = written(&result)?;
    let values = written.as_slice_mut()?.as_chunks_mut::<3>().0;
    for (index, (unit, vector)) in values.iter_mut().zip(array.as_array().rows()).enumerate() {
        let vector = [vector[0], vector[1], vector[2]];
        let largest = vector.iter().fold(0.0_f64, |largest, c| largest.max(c.abs()));
        if largest == 0.0 || !vector.iter().all(|c| c.is_finite()) {
            return Err(PyValueError::new_err(format!(
                "v: found vector {index}, {vector:?}; expected a finite vector of any length but 0"
            )));
        }
        // Scaled by the largest component first, so that no square overflows or vanishes.
        let vector = vector.map(|c| c / largest);
        let length = vector.iter().map(|c| c * c).sum::<f64>().sqrt();
        *unit = vector.map(|c| (c / length) as f32);
    }
    drop(written);
    Ok(result)
}
