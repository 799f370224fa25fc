//! Batches of vectors in any memory layout.
//!
//! `float32` arrays whose vectors or whose columns of components are contiguous are read in place. All others
//! (`float64`, slices, repeated vectors) are copied piece by piece, by the thread that works on the piece: a copy of
//! the whole batch would take as long as evaluating it.

use std::ops::Range;

use lobe::Directions;
use numpy::ndarray::{ArrayViewD, Axis};
use numpy::prelude::*;
use numpy::{Element, PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::{numbers, shown};
use crate::strided::Strided;

/// How far the square of the length of a unit vector may be from 1: vectors with three digits are accepted.
const LENGTH: f32 = 5e-3;
/// The largest number of vectors of a batch that are checked, at equal steps: a caller who forgets to normalise does so
/// for most of them.
const CHECKED: usize = 1024;

/// An array of one of the types that are read without converting the whole array.
enum Array<'py> {
    Single(Bound<'py, PyArrayDyn<f32>>),
    Double(Bound<'py, PyArrayDyn<f64>>),
}

impl<'py> Array<'py> {
    fn of(value: &Bound<'py, PyAny>) -> Option<Self> {
        fn plain<'py, T: Element>(value: &Bound<'py, PyAny>) -> Option<Bound<'py, PyArrayDyn<T>>> {
            let array = value.cast::<PyArrayDyn<T>>().ok()?;
            (array.is_aligned() && array.is_exact_instance_of::<PyArrayDyn<T>>()).then(|| array.clone())
        }
        plain(value).map(Array::Single).or_else(|| plain(value).map(Array::Double))
    }

    /// Any array of real numbers, converted if necessary.
    fn new(value: &Bound<'py, PyAny>, name: &str) -> PyResult<Self> {
        if let Some(array) = Array::of(value) {
            return Ok(array);
        }
        let numbers = numbers(value, name)?;
        match Array::of(&numbers) {
            Some(array) => Ok(array),
            None => Ok(Array::Single(numbers.call_method1("astype", ("float32",))?.cast_into()?)),
        }
    }

    fn shape(&self) -> &[usize] {
        match self {
            Array::Single(array) => array.shape(),
            Array::Double(array) => array.shape(),
        }
    }

    /// The same, broadcast to the shape without a copy.
    fn repeated(self, shape: &[usize]) -> PyResult<Self> {
        fn wide<'py, T: Element>(
            array: Bound<'py, PyArrayDyn<T>>,
            shape: &[usize],
        ) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
            let numpy = array.py().import("numpy")?;
            let shape = PyTuple::new(array.py(), shape)?;
            Ok(numpy.call_method1("broadcast_to", (array, shape))?.cast_into()?)
        }
        Ok(match self {
            Array::Single(array) => Array::Single(wide(array, shape)?),
            Array::Double(array) => Array::Double(wide(array, shape)?),
        })
    }
}

/// Vectors of `N` components, in an array that this value keeps alive.
pub struct Vectors<'py, const N: usize> {
    name: &'static str,
    array: Array<'py>,
}

impl<'py, const N: usize> Vectors<'py, N> {
    /// Wraps an array of shape `(..., N)`.
    ///
    /// # Errors
    /// `ValueError` if its last axis has another length; `TypeError` if it does not hold real numbers.
    pub fn new(value: &Bound<'py, PyAny>, name: &'static str) -> PyResult<Self> {
        let array = Array::new(value, name)?;
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

    /// The vectors of a batch of this shape, to which they are broadcast.
    ///
    /// # Errors
    /// If other code writes to the array.
    pub fn batch(self, shape: &[usize]) -> PyResult<Batch<'py, N>> {
        let Vectors { name, array } = self;
        let full = [shape, &[N]].concat();
        let array = if array.shape() == full { array } else { array.repeated(&full)? };
        let read = match array {
            Array::Single(array) => array.try_readonly().map(Read::Single),
            Array::Double(array) => array.try_readonly().map(Read::Double),
        };
        let read = read.map_err(|error| PyValueError::new_err(format!("{name}: {error}")))?;
        Ok(Batch { name, read })
    }
}

enum Read<'py> {
    Single(PyReadonlyArrayDyn<'py, f32>),
    Double(PyReadonlyArrayDyn<'py, f64>),
}

/// The vectors of a batch, which nothing writes to.
pub struct Batch<'py, const N: usize> {
    name: &'static str,
    read: Read<'py>,
}

impl<const N: usize> Batch<'_, N> {
    /// The vectors; contiguous ones are read in place.
    pub fn rows(&self) -> Source<'_, N> {
        match &self.read {
            Read::Single(array) => match array.as_array().to_slice() {
                Some(values) => Source::Rows(values.as_chunks().0),
                None => Source::Single(Strided::new(array.as_array())),
            },
            Read::Double(array) => Source::Double(Strided::new(array.as_array())),
        }
    }
}

impl Batch<'_, 3> {
    /// The directions, in rows or columns.
    ///
    /// # Errors
    /// `ValueError` if they are not of unit length; vectors of zero length are accepted, as missing directions.
    pub fn directions(&self) -> PyResult<Source<'_, 3>> {
        let columns = match &self.read {
            Read::Single(array) => columns(&array.as_array()),
            Read::Double(_) => None,
        };
        self.of_unit_length(columns.map_or_else(|| self.rows(), Source::Columns))
    }

    /// Like [`directions`](Self::directions), but with the components of each direction contiguous.
    ///
    /// # Errors
    /// The same as for [`directions`](Self::directions).
    pub fn rows_of_directions(&self) -> PyResult<Source<'_, 3>> {
        self.of_unit_length(self.rows())
    }

    fn of_unit_length<'a>(&self, source: Source<'a, 3>) -> PyResult<Source<'a, 3>> {
        let count = source.count();
        for index in (0..count).step_by(count.div_ceil(CHECKED).max(1)) {
            let [x, y, z] = source.get(index);
            let square = x * x + y * y + z * z;
            if (square - 1.0).abs() > LENGTH && square != 0.0 {
                return Err(PyValueError::new_err(format!(
                    "{}: found vector {index}, ({x}, {y}, {z}), of length {}; expected unit vectors (normalize() makes them)",
                    self.name,
                    square.sqrt()
                )));
            }
        }
        Ok(source)
    }
}

/// The columns of components, if each is contiguous, as in the transpose of an array of columns.
fn columns<'a>(view: &ArrayViewD<'a, f32>) -> Option<[&'a [f32]; 3]> {
    let last = Axis(view.ndim() - 1);
    let column = |k| view.clone().index_axis_move(last, k).to_slice();
    // A single vector is both a row and three columns.
    if view.len_of(last) != 3 || view.len() == 3 {
        return None;
    }
    Some([column(0)?, column(1)?, column(2)?])
}

/// Vectors in their memory layout.
pub enum Source<'a, const N: usize> {
    Rows(&'a [[f32; N]]),
    Columns([&'a [f32]; N]),
    Single(Strided<'a, f32>),
    Double(Strided<'a, f64>),
}

impl<const N: usize> Source<'_, N> {
    /// The number of vectors.
    pub fn count(&self) -> usize {
        match self {
            Source::Rows(rows) => rows.len(),
            Source::Columns(columns) => columns[0].len(),
            Source::Single(vectors) => vectors.count(),
            Source::Double(vectors) => vectors.count(),
        }
    }

    /// The vector at an index.
    pub fn get(&self, index: usize) -> [f32; N] {
        let mut one = [[0.0; N]];
        self.copy(index, &mut one);
        one[0]
    }

    /// Vectors `range`, copied to `room` if they are not contiguous rows.
    pub fn rows<'r>(&'r self, range: Range<usize>, room: &'r mut Vec<[f32; N]>) -> &'r [[f32; N]] {
        if let Source::Rows(rows) = self {
            return &rows[range];
        }
        room.resize(range.len(), [0.0; N]);
        self.copy(range.start, room);
        room
    }

    /// `true` if kernels can read them in place.
    pub fn is_near(&self) -> bool {
        matches!(self, Source::Rows(_) | Source::Columns(_))
    }

    fn copy(&self, from: usize, out: &mut [[f32; N]]) {
        match self {
            Source::Rows(rows) => out.copy_from_slice(&rows[from..from + out.len()]),
            Source::Columns(columns) => {
                for (index, vector) in out.iter_mut().enumerate() {
                    *vector = columns.map(|column| column[from + index]);
                }
            }
            Source::Single(vectors) => vectors.copy(from, out),
            Source::Double(vectors) => vectors.copy(from, out),
        }
    }
}

impl Source<'_, 3> {
    /// Directions `range`, copied to `room` if kernels cannot read them in place.
    pub fn directions<'r>(&'r self, range: Range<usize>, room: &'r mut Vec<[f32; 3]>) -> Directions<'r> {
        match self {
            Source::Columns(columns) => Directions::Columns(columns.map(|column| &column[range.clone()])),
            _ => self.rows(range, room).into(),
        }
    }
}

impl Source<'_, 2> {
    /// Pairs `range`, copied to `room` if they are not contiguous rows. Numbers below 1 stay below 1 when they are
    /// rounded.
    pub fn draws<'r>(&'r self, range: Range<usize>, room: &'r mut Vec<[f32; 2]>) -> &'r [[f32; 2]] {
        let Source::Double(pairs) = self else { return self.rows(range, room) };
        room.resize(range.len(), [0.0; 2]);
        pairs.convert(range.start, room, |number| {
            let rounded = number as f32;
            if number < 1.0 && rounded == 1.0 { 1.0_f32.next_down() } else { rounded }
        });
        room
    }
}
