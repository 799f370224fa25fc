//! Materials from files and from bytes, and lists of formats and backends.

use std::path::{Path, PathBuf};

use lobe_formats::{Document, Format, FormatError, ReadOptions, sidecar};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList};

use crate::content::{Content, Version};
use crate::errors::{Failure, check_readable};
use crate::material::Material;
use crate::opened::Opened;
use crate::options::{Choices, Factor, Reading};
use crate::threads;

/// Opens the file of a measured material, of any format, which is detected from the content.
///
/// `backend` names the instruction set (see backends()), by default the best that this machine has; `strict` rounds in
/// the same way on all machines. `edges` says how a table in specular coordinates continues beyond its outermost
/// angles: "clamp", "extrapolate" or "zero". `lookup`, "nearest" or "linear", says how grids of half and difference
/// angles (MERL) are looked up. `indexed_by`, "light" or "viewer", is the direction that selects the slice of a
/// material of the EPFL database, and `decode`, "raw" or "srgb", says how the numbers of the UTIA database are decoded.
///
/// The other arguments give facts that are missing in a file, like the options of `lobe import` or a file
/// NAME.lobe.toml: columns, unit, values, scale (a number, or "tis"), holds, in_plane, azimuth_from, decimal_comma.
///
/// Raises OSError if the file cannot be read, FormatError with file and line if it is damaged or of no known format,
/// and ValueError for an option that is wrong or would change nothing. Warns with GuessWarning about values that are
/// guessed and not measured.
#[expect(clippy::too_many_arguments, reason = "keyword arguments of Python")]
#[pyfunction]
#[pyo3(signature = (path, *, backend=None, strict=false, edges="clamp", lookup="nearest", indexed_by="light", decode="raw",
    columns=None, unit=None, values=None, scale=None, holds=None, in_plane=None, azimuth_from=None, decimal_comma=None))]
pub fn open(
    py: Python<'_>,
    path: PathBuf,
    backend: Option<String>,
    strict: bool,
    edges: &str,
    lookup: &str,
    indexed_by: &str,
    decode: &str,
    columns: Option<String>,
    unit: Option<String>,
    values: Option<String>,
    scale: Option<Factor>,
    holds: Option<String>,
    in_plane: Option<String>,
    azimuth_from: Option<String>,
    decimal_comma: Option<bool>,
) -> PyResult<Material> {
    let choices = Choices::new(backend, strict, edges, lookup, indexed_by, decode);
    let words = Reading { columns, unit, values, scale, holds, in_plane, azimuth_from, decimal_comma };
    let reading = words.understood()?;
    check_readable(&path)?;
    let version = Version::of(&path)?;
    let read = |path: &Path| -> Result<(Format, Document, ReadOptions), FormatError> {
        let reading = reading.or(sidecar::find(path)?);
        let (format, document) = lobe_formats::open_with(path, &reading)?;
        Ok((format, document, reading))
    };
    let (format, document, reading) = threads::watched(py, |_| read(&path))?.map_err(Failure::from)?;
    let content = Content::File { path: path.clone(), version, reading };
    Opened::new(py, Some(&path), format, document, choices, content).map(Material::from)
}

/// A material from the content of a file in memory. `name` is the name of the file in errors; its extension matters
/// only if the format is not clear from the content. Everything else is as in open(), except that no file
/// NAME.lobe.toml is read.
#[expect(clippy::too_many_arguments, reason = "keyword arguments of Python")]
#[pyfunction]
#[pyo3(signature = (data, name=PathBuf::from("memory"), *, backend=None, strict=false, edges="clamp", lookup="nearest",
    indexed_by="light", decode="raw", columns=None, unit=None, values=None, scale=None, holds=None, in_plane=None,
    azimuth_from=None, decimal_comma=None))]
pub fn from_bytes(
    data: &Bound<'_, PyAny>,
    name: PathBuf,
    backend: Option<String>,
    strict: bool,
    edges: &str,
    lookup: &str,
    indexed_by: &str,
    decode: &str,
    columns: Option<String>,
    unit: Option<String>,
    values: Option<String>,
    scale: Option<Factor>,
    holds: Option<String>,
    in_plane: Option<String>,
    azimuth_from: Option<String>,
    decimal_comma: Option<bool>,
) -> PyResult<Material> {
    let py = data.py();
    let choices = Choices::new(backend, strict, edges, lookup, indexed_by, decode);
    let words = Reading { columns, unit, values, scale, holds, in_plane, azimuth_from, decimal_comma };
    let reading = words.understood()?;
    // Memory that others may write to is copied; nobody can write to bytes.
    let bytes = match data.cast::<PyBytes>() {
        Ok(bytes) => bytes.clone(),
        Err(_) => {
            let builtins = py.import("builtins")?;
            builtins.call_method1("bytes", (builtins.call_method1("memoryview", (data,))?,))?.cast_into()?
        }
    };
    let content = bytes.as_bytes();
    let read = || lobe_formats::from_bytes_with(content, &name, &reading);
    let document = threads::watched(py, |_| read())?.map_err(Failure::from)?;
    let format = Format::ALL.iter().copied().find(|format| Some(format.name()) == document.format);
    let content = Content::Bytes { bytes: bytes.clone().unbind(), name: name.clone(), reading };
    let format = format.unwrap_or(Format::Goniometer);
    Opened::new(py, Some(&name), format, document, choices, content).map(Material::from)
}

/// The names of the backends that this machine can run, slowest first.
#[pyfunction]
pub fn backends() -> Vec<&'static str> {
    lobe::Backend::available().iter().map(lobe::Backend::name).collect()
}

/// The known formats, as tuples of the short name of the format, its full name, the extensions of its files, whether it
/// can be read and whether it can be written.
#[pyfunction]
pub fn formats(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    let class = py.import("lobe_bsdf._results")?.getattr("FormatInfo")?;
    let list = PyList::empty(py);
    for format in Format::ALL {
        let spec = format.spec();
        let extensions = pyo3::types::PyTuple::new(py, spec.extensions)?;
        list.append(class.call1((spec.word, spec.name, extensions, spec.read.is_some(), spec.writer.is_some()))?)?;
    }
    Ok(list)
}
