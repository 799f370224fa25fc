//! Normalises arrays of directions.

use numpy::PyArrayDyn;
use numpy::prelude::*;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{doubles, shown};
use crate::results::{output, written};

/// Unit vectors with the directions of v, an array of shape (..., 3), as float32.
///
/// They are rounded once, and have the same bits as those that the program lobe computes from its arguments. Raises
/// ValueError if a vector is zero or not finite.
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
                "v: found vector {index}, {vector:?}; expected a finite vector of any length except 0"
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
