//! Resamples any material to a table in specular coordinates.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use lobe_formats::{Document, Format};
use lobe_ops::resample::{Bound as Limit, Knots, PROBES, Resampling, candidates, choose, error};
use lobe_ops::{Aspect, Subject};
use lobe_table::Data;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::content::Content;
use crate::errors::Failure;
use crate::opened::Opened;
use crate::operations::{class, directions};
use crate::threads::{self, Watch};

/// The polar angle up to which errors count: 80 degrees.
pub const LIMIT: f64 = 80.0 * PI / 180.0;
/// The default bound of the error.
const ERROR: f64 = 0.01;

/// The requested table.
pub struct Wanted {
    pub error: Option<f64>,
    pub per_value: bool,
    pub limit: f64,
    /// Knots of sigma, psi, theta and phi in radians.
    pub axes: [Option<Vec<f64>>; 4],
}

/// Resamples a material to a table.
///
/// # Errors
/// `ValueError` if the bound is invalid or cannot be met, or the knots do not form a table.
pub fn resample(py: Python<'_>, material: &Opened, aspect: Aspect, wanted: Wanted) -> PyResult<Opened> {
    let is_sound = wanted.limit > 0.0 && wanted.limit <= FRAC_PI_2;
    if !is_sound || wanted.error.is_some_and(|error| error.is_nan() || error <= 0.0) {
        return Err(PyValueError::new_err(format!(
            "found an error of {:?} and a limit of {} rad; expected an error above 0, and a limit above 0 up to pi/2",
            wanted.error, wanted.limit
        )));
    }
    if wanted.per_value && wanted.error.is_none() && wanted.axes.iter().all(Option::is_some) {
        let message = "found per_value, but all axes are given; expected no option that changes nothing";
        return Err(PyValueError::new_err(message));
    }
    let subject = &material.subject;
    let (table, found) = threads::watched(py, |watch| table(subject, aspect, wanted, watch))??;
    let document = Document { source: subject.document.source.clone(), ..Document::new(table) };
    // Options for the file do not apply to the table.
    let choices = material.choices.of_table();
    let made = Opened::new(py, None, Format::Ddr, document, choices, Content::Data)?;
    Ok(Opened { resampling: Some(found), ..made })
}

fn table(
    subject: &Arc<Subject>,
    aspect: Aspect,
    wanted: Wanted,
    watch: &Watch,
) -> Result<(lobe_table::specular::Data, Resampling), Failure> {
    let is_all_given = wanted.axes.iter().all(Option::is_some);
    let own = if let Some(Data::Specular(samples)) = subject.data(aspect) { Some(samples) } else { None };
    let candidates = own.map_or_else(|| candidates(subject.is_isotropic()), |samples| samples.knots().clone());
    let mut axes = candidates.map(Knots::Choose);
    for (axis, knots) in axes.iter_mut().zip(wanted.axes) {
        if let Some(knots) = knots {
            *axis = Knots::Keep(knots);
        }
    }
    let bound = Limit {
        error: wanted.error.unwrap_or(ERROR),
        per_value: wanted.per_value,
        limit: wanted.limit,
        is_aim: wanted.error.is_none(),
    };
    let chosen = choose(&subject.material, aspect, &axes, bound, |_| watch.check()).map_err(Failure::value)?;
    // If all knots are given, they are used whatever the error.
    if chosen.error > bound.error && wanted.error.is_some() && !is_all_given {
        return Err(Failure::Value(format!(
            "error: the smallest one reached is {:.4}; expected {} or less",
            chosen.least, bound.error
        )));
    }
    let found = error(&subject.material, aspect, &chosen.samples, bound.limit, PROBES)?;
    Ok((chosen.samples, found))
}

/// The error as an object of the package.
///
/// # Errors
/// If there is not enough memory.
pub fn shown<'py>(py: Python<'py>, found: &Resampling) -> PyResult<Bound<'py, PyAny>> {
    let keywords = PyDict::new(py);
    keywords.set_item("probes", found.probes)?;
    keywords.set_item("peak", found.peak)?;
    keywords.set_item("max", found.max)?;
    keywords.set_item("rms", found.rms)?;
    keywords.set_item("relative_to_peak", found.relative_to_peak)?;
    keywords.set_item("relative_to_value", found.relative_to_value)?;
    keywords.set_item("worst", directions(py, found.worst)?)?;
    class(py, "Resampling")?.call((), Some(&keywords))
}
