//! Albedo, checks and comparison.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use lobe_ops::albedo::albedo_of;
use lobe_ops::check::{Status, Thoroughness};
use lobe_ops::compare::{difference, visible};
use lobe_ops::hemisphere::Effort;
use lobe_ops::{Aspect, Subject};
use numpy::prelude::*;
use numpy::{PyArray1, PyArrayDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

use crate::arrays::{broadcast, doubles};
use crate::threads;

/// The polar angle up to which materials are compared: 85 degrees.
pub const LIMIT: f64 = 85.0 * std::f64::consts::PI / 180.0;

/// Pixels across the spheres that are compared visually.
const PIXELS: usize = 128;

/// A class of `lobe_bsdf/_results.py`.
///
/// # Errors
/// If the package is incomplete.
pub fn class<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("lobe_bsdf._results")?.getattr(name)
}

/// The albedos for light at angles that broadcast; the azimuth may be missing.
///
/// # Errors
/// `ValueError` for light below the horizon, or if there is no albedo.
pub fn albedo<'py>(
    py: Python<'py>,
    subject: &Arc<Subject>,
    aspect: Aspect,
    [theta, phi]: [Option<&Bound<'py, PyAny>>; 2],
    tolerance: f64,
    errors: bool,
) -> PyResult<Bound<'py, PyAny>> {
    if tolerance.is_nan() || tolerance <= 0.0 {
        return Err(PyValueError::new_err(format!("tolerance: found {tolerance}; expected a number above 0")));
    }
    if subject.is_in_plane(aspect) {
        let message = format!(
            "found {aspect} measured only in the plane of incidence; expected a hemisphere, which an albedo needs"
        );
        return Err(PyValueError::new_err(message));
    }
    let angles = |given: Option<&Bound<'py, PyAny>>, name| match given {
        Some(given) => doubles(given, name),
        None => Ok(py.import("numpy")?.call_method1("zeros", (PyTuple::empty(py),))?.cast_into()?),
    };
    let (theta, phi) = (angles(theta, "theta")?, angles(phi, "phi")?);
    let mut shape = broadcast(["theta", "phi"], theta.shape(), phi.shape())?;
    let wide = |array: Bound<'py, PyArrayDyn<f64>>| -> PyResult<Vec<f64>> {
        let shape = PyTuple::new(py, &shape)?;
        let wide = py.import("numpy")?.call_method1("broadcast_to", (array, shape))?;
        let wide = wide.call_method1("ravel", ("C",))?.cast_into::<PyArray1<f64>>()?;
        let wide = wide.try_readonly().map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(wide.as_slice()?.to_vec())
    };
    let (theta, phi) = (wide(theta)?, wide(phi)?);
    let fits = |theta: &&f64| !(0.0..FRAC_PI_2).contains(*theta);
    if let Some(bad) = theta.iter().find(fits).or_else(|| phi.iter().find(|phi| !phi.is_finite())) {
        let message =
            format!("found light at {bad} rad; expected polar angles from 0 to below pi/2, and finite azimuths");
        return Err(PyValueError::new_err(message));
    }
    let effort = Effort { tolerance, ..Effort::default() };
    let found = threads::watched(py, |watch| {
        let one = |(&theta, &phi): (&f64, &f64)| {
            watch.check();
            albedo_of(subject, aspect, [theta, phi], effort)
        };
        theta.iter().zip(&phi).map(one).collect::<Vec<_>>()
    })?;
    let of_errors: Vec<f64> = found.iter().map(|albedo| albedo.error).collect();
    let of_errors = PyArray1::from_vec(py, of_errors).reshape(shape.clone())?;
    let values: Vec<f64> = found.into_iter().flat_map(|albedo| albedo.values).collect();
    shape.push(subject.material.channel_count());
    let values = PyArray1::from_vec(py, values).reshape(shape)?;
    match errors {
        true => Ok((values, of_errors).into_pyobject(py)?.into_any()),
        false => Ok(values.into_any()),
    }
}

/// The findings of a check.
///
/// # Errors
/// `KeyboardInterrupt`.
pub fn check<'py>(py: Python<'py>, subject: &Arc<Subject>) -> PyResult<Bound<'py, PyAny>> {
    let check = |watch: &threads::Watch| lobe_ops::check::check(subject, &Thoroughness::default(), |_| watch.check());
    let findings = threads::watched(py, check)?;
    let class = class(py, "Finding")?;
    let list = PyList::empty(py);
    for finding in findings {
        let status = match finding.status {
            Status::Pass => "pass",
            Status::Note => "note",
            Status::Warn => "warn",
            Status::Fail => "fail",
        };
        let numbers = PyDict::new(py);
        finding.numbers.iter().try_for_each(|(name, number)| numbers.set_item(name, number))?;
        list.append(class.call1((status, finding.check, finding.part, finding.text, numbers))?)?;
    }
    Ok(list.into_any())
}

/// The difference between two materials.
///
/// # Errors
/// `ValueError` if the channels differ and have no colour, or the limit is invalid.
pub fn compare<'py>(
    py: Python<'py>,
    [first, second]: [&Arc<Subject>; 2],
    aspect: Aspect,
    pairs: usize,
    limit: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let is_sound = limit > 0.0 && limit < FRAC_PI_2;
    if !is_sound || pairs == 0 {
        return Err(PyValueError::new_err(format!(
            "found a limit of {limit} rad and {pairs} pairs; expected a limit between 0 and pi/2, and at least one pair"
        )));
    }
    let (a, b) = (&first.material, &second.material);
    let found = threads::watched(py, |watch| {
        let found = difference(a, b, aspect, limit, pairs);
        watch.check();
        found.map(|found| (found, visible(a, b, aspect, PIXELS).ok()))
    })?;
    let (found, delta_e) = found.map_err(|error| PyValueError::new_err(error.to_string()))?;
    let keywords = PyDict::new(py);
    keywords.set_item("aspect", aspect.to_string())?;
    keywords.set_item("channels", PyTuple::new(py, found.channels)?)?;
    keywords.set_item("pairs", found.pairs)?;
    keywords.set_item("peak", found.peak)?;
    keywords.set_item("max", found.max)?;
    keywords.set_item("rms", found.rms)?;
    keywords.set_item("bias", found.bias)?;
    keywords.set_item("relative_rms", found.relative_rms)?;
    keywords.set_item("worst", directions(py, found.worst)?)?;
    keywords.set_item("delta_e", delta_e.as_ref().map(|seen| seen.mean))?;
    keywords.set_item("delta_e_max", delta_e.as_ref().map(|seen| seen.max))?;
    self::class(py, "Difference")?.call((), Some(&keywords))
}

/// A pair of directions.
///
/// # Errors
/// If there is not enough memory.
pub fn directions<'py>(py: Python<'py>, [wi, wo]: [[f64; 3]; 2]) -> PyResult<Bound<'py, PyTuple>> {
    PyTuple::new(py, [PyTuple::new(py, wi)?, PyTuple::new(py, wo)?])
}
