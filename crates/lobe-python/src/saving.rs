//! Writes materials to files.

use std::path::Path;
use std::sync::Arc;

use lobe::{Aspect, Lookup, Material, Options, Scatter};
use lobe_files::check_output;
use lobe_formats::{ChannelMap, ConvertError, Document, Format, convert, sidecar};
use lobe_ops::Subject;
use lobe_ops::remeasure::{Mapped, MaterialSurface, Nodes, RemeasureError, Sides, remeasure, resampled_matrices};
use lobe_table::window::klems;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::Failure;
use crate::threads::{self, Watch};

/// The format to write: the given one, or the one of the extension.
fn target(path: &Path, word: Option<&str>) -> Result<Format, Failure> {
    let wrong =
        |why: String| Failure::Value(format!("{}: {why}; expected format= with the format to write", path.display()));
    if let Some(word) = word {
        let found = Format::writable().find(|format| format.spec().word == word);
        return found.ok_or_else(|| {
            let words: Vec<&str> = Format::writable().map(|format| format.spec().word).collect();
            Failure::Value(format!("format: found {word:?}; expected one of {}", words.join(", ")))
        });
    }
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let fits = |format: &Format| format.writer().is_some_and(|writer| writer.extensions.contains(&extension.as_str()));
    match Format::writable().filter(fits).collect::<Vec<_>>().as_slice() {
        [one] => Ok(*one),
        [] if extension.is_empty() => Err(wrong("found no extension".into())),
        [] => Err(wrong(format!("found the extension .{extension}, which belongs to no format that lobe writes"))),
        several => {
            let words: Vec<&str> = several.iter().map(|format| format.spec().word).collect();
            Err(wrong(format!("found the extension .{extension}, which is shared by {}", words.join(" and "))))
        }
    }
}

/// Options of writing.
pub struct Wanted<'a> {
    /// The word for the format, if the name of the file does not say it.
    pub format: Option<&'a str>,
    /// The channel for a format that has only one.
    pub channel: Option<&'a str>,
    /// `true` if the material may be resampled.
    pub resample: bool,
    /// The measurement of a sheet, for a format that has only one of the two.
    pub scatter: Option<Scatter>,
}

/// Writes the values and knots unchanged or, if requested, resampled at the nodes of the format.
///
/// # Errors
/// `ValueError` if the format does not have their representation; `FormatError` if the file cannot be written.
pub fn save(py: Python<'_>, subject: &Arc<Subject>, path: &Path, wanted: &Wanted<'_>) -> PyResult<()> {
    let format = target(path, wanted.format)?;
    let sidecar = sidecar::path_of(path);
    if sidecar.exists() {
        return Err(PyValueError::new_err(format!(
            "{}: found a file that says how another {} is read; expected no such file",
            sidecar.display(),
            path.display()
        )));
    }
    check_output::<&Path>(path, &[]).map_err(Failure::from)?;
    threads::watched(py, |watch| written(subject, format, path, wanted, watch))??;
    Ok(())
}

fn written(subject: &Subject, format: Format, path: &Path, wanted: &Wanted<'_>, watch: &Watch) -> Result<(), Failure> {
    let kind = subject.material.kind();
    let refuse = |found: &str, expected: &str| {
        Err(Failure::Value(format!("{}: found {found}; expected {expected} in {format}", path.display())))
    };
    if wanted.scatter.is_none_or(|scatter| subject.aspects().iter().all(|aspect| aspect.scatter == scatter))
        && convert(&subject.document, format, wanted.channel, path).map_err(unconverted)?.is_some()
    {
        return Ok(());
    }
    let Some(writer) = format.writer() else { return refuse("a format that is only read", "one that is written") };
    let kind_of_nodes = match writer.resampled_as {
        Ok(kind_of_nodes) => kind_of_nodes,
        Err(expected) => return refuse(kind.name(), expected),
    };
    if !wanted.resample {
        return Err(Failure::Value(format!(
            "{}: found {kind}, whose values {format} cannot hold unchanged; expected resample=True, which resamples \
             them at its nodes",
            path.display()
        )));
    }
    // Files interpolate between their nodes, and so do the materials from which they are made.
    let options = Options { lookup: Lookup::Linear, ..Options::default() };
    let material = Material::from_document(&subject.document, &options)?.with_backend(subject.material.backend());
    let of_one_side = subject.document.only().filter(|data| !data.representation().is_two_sided());
    let sides = match of_one_side {
        Some(data) => Sides::One(data.representation().scatter()),
        None if kind_of_nodes == klems::KIND && wanted.scatter.is_none() => Sides::Both,
        None => {
            let aspects = [Scatter::Reflection, Scatter::Transmission].map(Aspect::front);
            let held: Vec<_> = aspects.into_iter().filter(|&aspect| material.holds(aspect)).collect();
            match wanted.scatter.or((writer.scatter)(path)) {
                Some(scatter) if held.contains(&Aspect::front(scatter)) => Sides::One(scatter),
                None if held.len() == 1 => Sides::One(held[0].scatter),
                Some(_) => return refuse("no such light from the front", "the requested scatter"),
                None => return refuse("reflection and transmission", "scatter= with one of the two"),
            }
        }
    };
    let scatter = if let Sides::One(scatter) = sides { Some(scatter) } else { None };
    if let (Some(found), Some(expected)) = (scatter, (writer.scatter)(path))
        && found != expected
    {
        let word = |scatter| if scatter == Scatter::Reflection { "reflection" } else { "transmission" };
        return refuse(word(found), word(expected));
    }
    let map = ChannelMap::new(material.channels(), wanted.channel, format).map_err(unconverted)?;
    let surface = MaterialSurface { material, scatter };
    let surface = Mapped { surface: &surface, map: &map };
    let is_isotropic = lobe_model::is_isotropic(&surface);
    // All kinds of nodes suit isotropic materials.
    let Some(nodes) = Nodes::of(kind_of_nodes, is_isotropic) else {
        return refuse("an anisotropic material", "an isotropic one");
    };
    let invalid = |error: RemeasureError| Failure::Value(format!("{}: {error}", path.display()));
    if subject.material.is_polarised() && nodes.are_of_matrices() && wanted.channel.is_some() {
        return refuse("channel=", "matrices of all wavelengths");
    }
    let document = match resampled_matrices(&subject.document, &nodes).map_err(invalid)? {
        Some(document) => document,
        None => remeasure(&surface, true, sides, &nodes, || watch.check()).map_err(invalid)?,
    };
    let source = subject.document.source.clone();
    Ok((writer.write)(&Document { source, ..document }, path)?)
}

fn unconverted(error: ConvertError) -> Failure {
    match error {
        ConvertError::Write(error) => error.into(),
        other => Failure::value(other),
    }
}
