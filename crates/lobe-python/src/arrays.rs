//! Arrays of numbers from anything that NumPy understands.

use numpy::PyArrayDyn;
use numpy::prelude::*;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

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
/// The same as for [`floats`].
pub fn doubles<'py>(value: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    Ok(numbers(value, name)?.call_method1("astype", ("float64",))?.cast_into()?)
}

/// An array of real numbers of any type.
///
/// # Errors
/// The same as for [`floats`].
pub fn numbers<'py>(value: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    let py = value.py();
    let numpy = py.import("numpy")?;
    if value.hasattr("mask")? && value.hasattr("filled")? {
        return Err(PyTypeError::new_err(format!(
            "{name}: found an array with a mask; expected one without masked values (its compressed(), for example)"
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

/// The shape to which two shapes broadcast.
///
/// # Errors
/// `ValueError` if they do not broadcast.
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

/// A shape in Python's notation.
pub fn shown(shape: &[usize]) -> String {
    match shape {
        [one] => format!("({one},)"),
        _ => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}
