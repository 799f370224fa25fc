//! Materials from NumPy arrays.

use std::f64::consts::TAU;

use lobe::{Channels, Data, Scatter};
use lobe_formats::{Document, Format};
use lobe_table::{scattered, specular, spherical};
use numpy::prelude::*;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::arrays::{doubles, floats, shown};
use crate::aspects::scatter;
use crate::content::Content;
use crate::errors::Failure;
use crate::material::Material;
use crate::opened::Opened;
use crate::options::Choices;
use crate::scattered::Scattered;

/// The meaning of channels, as given by the caller.
#[derive(FromPyObject)]
pub enum Meaning {
    /// `mono`, `rgb` or `xyz`.
    Word(String),
    /// A name for each.
    Names(Vec<String>),
}

/// The given axes, by name.
struct Axes<'py> {
    names: [&'static str; 4],
    given: [Option<Bound<'py, PyAny>>; 4],
    degrees: bool,
}

impl Axes<'_> {
    fn any(&self) -> bool {
        self.given.iter().any(Option::is_some)
    }

    /// An axis in radians; `None` if it was not given, which is allowed only for azimuths.
    fn axis(&self, axis: usize) -> PyResult<Option<Vec<f64>>> {
        let name = self.names[axis];
        let Some(given) = &self.given[axis] else {
            return match axis {
                1 => Ok(None),
                _ => Err(PyTypeError::new_err(format!("found no {name}; expected the angles of this axis"))),
            };
        };
        let array = doubles(given, name)?;
        if array.ndim() != 1 {
            let found = shown(array.shape());
            return Err(PyValueError::new_err(format!("{name}: found an array of shape {found}; expected one axis")));
        }
        let array = array.try_readonly().map_err(|error| PyValueError::new_err(error.to_string()))?;
        let angles = array.as_array().iter().map(|&angle| if self.degrees { degrees(angle) } else { angle }).collect();
        Ok(Some(angles))
    }
}

/// An angle in radians; common ones are exact.
fn degrees(angle: f64) -> f64 {
    if angle == 360.0 { TAU } else { angle.to_radians() }
}

/// A material from values f in 1/sr, without the cosine, at given angles.
///
/// The given axes distinguish three kinds of data:
///
/// - a table in specular coordinates: sigma, theta and phi, and psi unless the material is isotropic; values of shape
///   (sigma, psi, theta, phi[, channel]), or (sigma, theta, phi[, channel]) without psi;
/// - a grid in spherical coordinates: theta_i, theta_o and phi_o, and phi_i unless the material is isotropic; without
///   phi_i, phi_o is the angle between the azimuths; values of shape (theta_i, phi_i, theta_o, phi_o[, channel]), or
///   without phi_i;
/// - scattered samples: theta_i, theta_o, phi_o, and phi_i unless it is 0, one of each per sample; values of shape (n,)
///   or (n, channel).
///
/// Angles are in radians, or in degrees if `degrees` is true; the axes of grids must ascend. Polar   angles count from
/// the normal on the side of their direction. `channels` is "mono", "rgb", "xyz" or one name per   channel; or
/// `wavelengths` has one wavelength in nm per channel. `facts` are pairs of names and values for readers.
///
/// Raises ValueError if shapes, angles or values do not fit together, and names the axis and the position.
#[expect(clippy::too_many_arguments, reason = "keyword arguments of Python")]
#[pyfunction]
#[pyo3(signature = (values, *, sigma=None, psi=None, theta=None, phi=None, theta_i=None, phi_i=None, theta_o=None,
    phi_o=None, channels=None, wavelengths=None, scatter="reflection", refraction=None, degrees=false, facts=Vec::new(),
    backend=None, strict=false, edges="clamp", lookup="nearest", indexed_by="light", decode="raw"))]
pub fn from_samples<'py>(
    values: &Bound<'py, PyAny>,
    sigma: Option<Bound<'py, PyAny>>,
    psi: Option<Bound<'py, PyAny>>,
    theta: Option<Bound<'py, PyAny>>,
    phi: Option<Bound<'py, PyAny>>,
    theta_i: Option<Bound<'py, PyAny>>,
    phi_i: Option<Bound<'py, PyAny>>,
    theta_o: Option<Bound<'py, PyAny>>,
    phi_o: Option<Bound<'py, PyAny>>,
    channels: Option<Meaning>,
    wavelengths: Option<Vec<f64>>,
    scatter: &str,
    refraction: Option<Vec<f64>>,
    degrees: bool,
    facts: Vec<(String, String)>,
    backend: Option<String>,
    strict: bool,
    edges: &str,
    lookup: &str,
    indexed_by: &str,
    decode: &str,
) -> PyResult<Material> {
    let py = values.py();
    let choices = Choices::new(backend, strict, edges, lookup, indexed_by, decode);
    let scatter = self::scatter(scatter)?;
    let specular = Axes { names: specular::AXIS_NAMES, given: [sigma, psi, theta, phi], degrees };
    let spherical = Axes { names: spherical::AXIS_NAMES, given: [theta_i, phi_i, theta_o, phi_o], degrees };
    let values = floats(values, "values")?;
    let shape = values.shape().to_vec();
    let values = values.call_method1("ravel", ("C",))?.cast_into::<numpy::PyArray1<f32>>()?;
    let values = values.try_readonly().map_err(|error| PyValueError::new_err(error.to_string()))?.as_slice()?.to_vec();
    if specular.any() == spherical.any() {
        let found =
            if specular.any() { "both sigma, psi, theta, phi and theta_i, phi_i, theta_o, phi_o" } else { "no axes" };
        return Err(PyTypeError::new_err(format!("found {found}; expected the axes of one system of coordinates")));
    }
    let is_scattered = spherical.any() && shape.len() <= 2;
    if refraction.is_some() && !specular.any() {
        return Err(PyTypeError::new_err("found refraction; expected it only for tables in specular coordinates"));
    }
    let label = |channel_axis: Option<usize>| meaning(channels, wavelengths, channel_axis);
    let (data, content): (Data, Content) = if is_scattered {
        let samples = scattered_samples(&spherical, scatter, &shape, values, label)?;
        let Scattered { scatter, channels, angles, values } = &samples;
        let data = scattered::Data::new(*scatter, channels.clone(), angles, values).map_err(value)?;
        (data.into(), Content::Scattered(samples))
    } else {
        let axes = if specular.any() { &specular } else { &spherical };
        let (knots, of) = knots(axes, &shape, label)?;
        let data = if specular.any() {
            let table = specular::Data::new(scatter, knots, of, values).map_err(value)?;
            match refraction {
                Some(offsets) => {
                    let offsets = offsets.into_iter().map(|o| if degrees { o.to_radians() } else { o }).collect();
                    table.with_refraction(offsets).map_err(value)?.into()
                }
                None => table.into(),
            }
        } else {
            spherical::Data::new(scatter, knots, of, values).map_err(value)?.into()
        };
        (data, Content::Data)
    };
    let document = Document { source: facts, ..Document::new(data) };
    Opened::new(py, None, Format::Goniometer, document, choices, content).map(Material::from)
}

fn value(error: impl std::fmt::Display) -> PyErr {
    Failure::value(error).into()
}

/// The knots of a grid, whose values have this shape, and its channels.
fn knots(
    axes: &Axes<'_>,
    shape: &[usize],
    label: impl FnOnce(Option<usize>) -> PyResult<Channels>,
) -> PyResult<([Vec<f64>; 4], Channels)> {
    let mut lengths = Vec::new();
    let mut knots: [Vec<f64>; 4] = Default::default();
    let mut names = Vec::new();
    for (axis, name) in axes.names.into_iter().enumerate() {
        match axes.axis(axis)? {
            Some(angles) => {
                lengths.push(angles.len());
                names.push(name);
                knots[axis] = angles;
            }
            None => knots[axis] = vec![0.0],
        }
    }
    let (found, channel) = match shape.strip_prefix(lengths.as_slice()) {
        Some([]) => (true, None),
        Some([count]) => (true, Some(*count)),
        _ => (false, None),
    };
    if !found {
        return Err(PyValueError::new_err(format!(
            "values: found an array of shape {}; expected {} for ({}), with or without an axis of channels",
            shown(shape),
            shown(&lengths),
            names.join(", ")
        )));
    }
    Ok((knots, label(channel)?))
}

fn scattered_samples(
    axes: &Axes<'_>,
    scatter: Scatter,
    shape: &[usize],
    values: Vec<f32>,
    label: impl FnOnce(Option<usize>) -> PyResult<Channels>,
) -> PyResult<Scattered> {
    let [count, channel @ ..] = shape else {
        return Err(PyValueError::new_err("values: found a single number; expected one per sample"));
    };
    let mut angles = vec![[0.0; 4]; *count];
    for (axis, name) in axes.names.into_iter().enumerate() {
        let Some(of_axis) = axes.axis(axis)? else { continue };
        if of_axis.len() != *count {
            let found = of_axis.len();
            return Err(PyValueError::new_err(format!(
                "{name}: found {found} angles; expected one per sample, {count}"
            )));
        }
        angles.iter_mut().zip(of_axis).for_each(|(angles, angle)| angles[axis] = angle);
    }
    Ok(Scattered { scatter, channels: label(channel.first().copied())?, angles, values })
}

/// The meaning of the channels; without an axis of channels there is one.
fn meaning(channels: Option<Meaning>, wavelengths: Option<Vec<f64>>, axis: Option<usize>) -> PyResult<Channels> {
    let found = axis.unwrap_or(1);
    let meant = match (channels, wavelengths) {
        (Some(_), Some(_)) => {
            return Err(PyTypeError::new_err("found channels and wavelengths; expected one of them"));
        }
        (None, None) if found == 1 => Channels::Mono,
        (None, None) => {
            return Err(PyTypeError::new_err(format!(
                "found {found} channels; expected channels= or wavelengths= with their meaning"
            )));
        }
        (None, Some(wavelengths)) => Channels::Spectral(wavelengths),
        (Some(Meaning::Names(names)), None) => match names.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
            ["R", "G", "B"] => Channels::Rgb,
            ["X", "Y", "Z"] => Channels::Xyz,
            ["Y"] => Channels::Mono,
            _ => Channels::Named(names),
        },
        (Some(Meaning::Word(word)), None) => {
            let words = [("mono", 0), ("rgb", 1), ("xyz", 2)];
            match crate::options::word("channels", &word, &words)? {
                0 => Channels::Mono,
                1 => Channels::Rgb,
                _ => Channels::Xyz,
            }
        }
    };
    match meant.count() {
        expected if expected == found => Ok(meant),
        expected => Err(PyValueError::new_err(format!(
            "found {found} channels; expected {expected}, the number of their names"
        ))),
    }
}
