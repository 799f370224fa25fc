//! Writes materials to files.

use std::path::Path;
use std::sync::Arc;

use lobe::{Aspect, Lookup, Material, Options, Scatter};
use lobe_files::check_output;
use lobe_formats::{ChannelMap, ConvertError, Document, Format, RESAMPLED, convert, sidecar};
use lobe_ops::Subject;
use lobe_ops::certificate::{Certificate, DraftError, Stated};
use lobe_ops::certify::Certified;
use lobe_ops::remeasure::{
    Mapped, MaterialSurface, Nodes, RemeasureError, Sides, refine, remeasure, resampled_matrices,
};
use lobe_table::window::klems;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::errors::Failure;
use crate::operations::class;
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
    /// The largest relative error (root mean square) that is accepted.
    pub error: Option<f64>,
}

/// A file that was written.
struct Saved {
    format: Format,
    /// The nodes at which it was resampled, in words; `None` if values and nodes are unchanged.
    nodes: Option<String>,
    /// How the channels were changed; `None` if they were not.
    note: Option<String>,
    /// The error, or why it is unknown; `None` if nothing changed.
    stated: Option<Stated>,
}

/// Writes the values and knots unchanged or, if requested, resampled at the nodes of the format. Returns an instance of
/// the class `Saved`.
///
/// # Errors
/// `ValueError` if the format does not have their representation, or the bound of the error is not met; `FormatError` if
/// the file cannot be written.
pub fn save<'py>(
    py: Python<'py>,
    subject: &Arc<Subject>,
    path: &Path,
    wanted: &Wanted<'_>,
) -> PyResult<Bound<'py, PyAny>> {
    if let Some(error) = wanted.error.filter(|error| !(*error > 0.0 && error.is_finite())) {
        return Err(PyValueError::new_err(format!("error: found {error}; expected a number above 0")));
    }
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
    let saved = threads::watched(py, |watch| written(subject, format, path, wanted, watch))??;
    saved.described(py)
}

impl Saved {
    fn described<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let largest = |of: &dyn Fn(&Certified) -> f64| match &self.stated {
            None => Some(0.0),
            Some(Ok(Certificate(errors))) => Some(errors.iter().map(of).fold(0.0, f64::max)),
            Some(Err(_)) => None,
        };
        let lines: Vec<String> = match &self.stated {
            Some(Ok(certificate)) => certificate.lines().collect(),
            _ => Vec::new(),
        };
        let unknown = self.stated.as_ref().and_then(|stated| stated.as_ref().err());
        let keywords = PyDict::new(py);
        keywords.set_item("format", self.format.spec().word)?;
        keywords.set_item("exact", self.stated.is_none())?;
        keywords.set_item("nodes", &self.nodes)?;
        keywords.set_item("note", &self.note)?;
        keywords.set_item("max", largest(&|error| error.difference.max))?;
        keywords.set_item("rms", largest(&|error| error.difference.rms))?;
        keywords.set_item("relative_rms", largest(&|error| error.difference.relative_rms))?;
        keywords.set_item("errors", PyTuple::new(py, lines)?)?;
        keywords.set_item("unknown", unknown.map(ToString::to_string))?;
        class(py, "Saved")?.call((), Some(&keywords))
    }
}

/// Writes values and nodes unchanged; `None` if the format cannot hold them. If the error is larger than the bound, no
/// file is written.
fn kept(subject: &Subject, format: Format, path: &Path, wanted: &Wanted<'_>) -> Result<Option<Saved>, Failure> {
    let write = |path: &Path| convert(&subject.document, format, wanted.channel, path);
    if let Some(bound) = wanted.error {
        let folder = tempfile::tempdir().map_err(|error| Failure::from(DraftError::from(error)))?;
        let draft = folder.path().join(path.file_name().unwrap_or_default());
        // What cannot be written is reported below, with the name of the file.
        if let Ok(Some(_)) = write(&draft)
            && let Some(stated) = Certificate::of_kept(subject, wanted.channel, format, &draft)?
        {
            let error = bounded(stated, path)?.worst();
            if error > bound {
                let found = format!("the error of the unchanged nodes is {error:.3e}");
                return Err(Failure::Value(format!("{}: {found}; expected {bound} or less", path.display())));
            }
        }
    }
    let Some(written) = write(path).map_err(unconverted)? else { return Ok(None) };
    let stated = Certificate::of_kept(subject, wanted.channel, format, path)?;
    Ok(Some(Saved { format, nodes: None, note: written.note, stated }))
}

/// The error that is to be bounded.
fn bounded(stated: Stated, path: &Path) -> Result<Certificate, Failure> {
    stated.map_err(|why| {
        let expected = "a file that can be compared with the material";
        Failure::Value(format!("{}: found no error to bound ({why}); expected {expected}", path.display()))
    })
}

fn written(
    subject: &Subject,
    format: Format,
    path: &Path,
    wanted: &Wanted<'_>,
    watch: &Watch,
) -> Result<Saved, Failure> {
    let kind = subject.material.kind();
    let refuse = |found: &str, expected: &str| {
        Err(Failure::Value(format!("{}: found {found}; expected {expected} in {format}", path.display())))
    };
    if wanted.scatter.is_none_or(|scatter| subject.aspects().iter().all(|aspect| aspect.scatter == scatter))
        && let Some(saved) = kept(subject, format, path, wanted)?
    {
        return Ok(saved);
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
    let channels = map.channels.count();
    let at_nodes = |nodes: &Nodes| -> Result<Document, Failure> {
        let document = match resampled_matrices(&subject.document, nodes).map_err(invalid)? {
            Some(document) => document,
            None => remeasure(&surface, true, sides, nodes, || watch.check()).map_err(invalid)?,
        };
        let facts = subject.document.source.iter().filter(|(name, _)| name != RESAMPLED).cloned().collect();
        Ok(Document { source: facts, kept: subject.document.kept.clone(), ..document })
    };
    let stated = |document: &Document| -> Result<Stated, Failure> {
        watch.check();
        Ok(Certificate::of_draft(subject, wanted.channel, document, format, path)?)
    };
    let (nodes, mut document) = match wanted.error {
        None => {
            let document = at_nodes(&nodes)?;
            (nodes, document)
        }
        Some(bound) => {
            let found = refine(nodes, channels, bound, |nodes| {
                let document = at_nodes(nodes)?;
                let error = bounded(stated(&document)?, path)?.worst();
                Ok::<_, Failure>((document, error))
            })?;
            if !found.is_met {
                return Err(Failure::Value(format!(
                    "{}: found {:.3e} as the smallest error, with {}; expected {bound} or less",
                    path.display(),
                    found.error,
                    found.nodes
                )));
            }
            (found.nodes, found.measured)
        }
    };
    let stated = stated(&document)?;
    if let Ok(certificate) = &stated {
        document.source.push((RESAMPLED.into(), format!("at {nodes}: {}", certificate.line())));
    }
    (writer.write)(&document, path)?;
    Ok(Saved { format, nodes: Some(nodes.to_string()), note: map.note.clone(), stated: Some(stated) })
}

fn unconverted(error: ConvertError) -> Failure {
    match error {
        ConvertError::Write(error) => error.into(),
        other => Failure::value(other),
    }
}
