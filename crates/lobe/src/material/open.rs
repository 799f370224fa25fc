//! Materials from files, from bytes, from documents and from data.

use std::path::Path;
use std::sync::Arc;

use lobe_formats::{Document, FormatError, Part};
use lobe_table::{Data, Options, Side};

use super::mirror::Mirror;
use super::sheet::{self, SHEET, Sheet};
use super::{Material, Origin};
use crate::{Backend, OpenError};

/// The measurements of a sheet, while they are read.
#[derive(Default)]
struct Parts {
    parts: Vec<sheet::Part>,
    mirrors: Vec<Mirror>,
}

impl Parts {
    fn add(&mut self, side: Option<Side>, data: &Data, options: &Options) -> Result<(), OpenError> {
        match data.mirror() {
            Some(mirror) => self.mirrors.push(Mirror { side, data: mirror.clone() }),
            None => {
                let data = data.representation();
                self.parts.push(sheet::Part { scatter: data.scatter(), side, bsdf: data.prepare(options)? });
            }
        }
        Ok(())
    }

    fn finish(self, origin: Origin) -> Result<Material, OpenError> {
        let Parts { parts, mirrors } = self;
        let Some(first) = parts.first() else { return Err(OpenError::not_a_material("mirror reflectances")) };
        let channels = first.bsdf.channels().clone();
        let differ = parts.iter().any(|part| *part.bsdf.channels() != channels)
            || mirrors.iter().any(|mirror| *mirror.data.channels() != channels);
        if differ {
            return Err(OpenError::not_a_material("parts with different channels"));
        }
        let origin = Origin { kind: SHEET, ..origin };
        Ok(Material { origin, bsdf: Arc::new(Sheet { channels, parts }), mirrors, backend: Backend::detect()? })
    }
}

impl Material {
    /// Opens a file of any format that [`formats`](crate::formats) reads, on the detected backend.
    ///
    /// # Errors
    /// [`OpenError`] if the file cannot be read, has no values for pairs of directions, or `LOBE_BACKEND` is invalid.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        Material::open_with(path, &Options::default())
    }

    /// Like [`open`](Material::open), with options for facts that the file leaves open.
    ///
    /// # Errors
    /// The same as for [`open`](Material::open).
    pub fn open_with(path: impl AsRef<Path>, options: &Options) -> Result<Self, OpenError> {
        let path = path.as_ref();
        let (_, document) = lobe_formats::open(path)?;
        Material::from_document(&document, options).map_err(|error| error.in_file(path))
    }

    /// A material from the content of a file in memory. `name` is the name of the file in errors; its extension is used
    /// only if the content is ambiguous, as in [`formats::open`](lobe_formats::open).
    ///
    /// # Errors
    /// The same as for [`open`](Material::open).
    pub fn from_bytes(bytes: &[u8], name: impl AsRef<Path>, options: &Options) -> Result<Self, OpenError> {
        let name = name.as_ref();
        let document = lobe_formats::from_bytes(bytes, name)?;
        Material::from_document(&document, options).map_err(|error| error.in_file(name))
    }

    /// A material from a document that was read or created.
    ///
    /// # Errors
    /// The same as for [`open`](Material::open); the error names no file.
    pub fn from_document(document: &Document, options: &Options) -> Result<Self, OpenError> {
        let origin = Origin { format: document.format, source: document.source.clone(), kind: SHEET };
        if let Some(data) = document.only() {
            let bsdf = data.representation().prepare(options)?;
            let origin = Origin { kind: data.representation().kind(), ..origin };
            return Ok(Material { origin, bsdf: bsdf.into(), mirrors: Vec::new(), backend: Backend::detect()? });
        }
        let mut parts = Parts::default();
        for part in &document.parts {
            parts.add(part.side, &part.data, options)?;
        }
        parts.finish(origin)
    }

    /// A material from samples in any representation, such as [`specular::Data`](lobe_table::specular::Data).
    ///
    /// # Errors
    /// The same as for [`from_document`](Material::from_document).
    pub fn from_samples(samples: impl Into<Data>, options: &Options) -> Result<Self, OpenError> {
        Material::from_document(&Document::new(samples), options)
    }

    /// A sheet whose sides were measured into separate files: those measured with light in front (z > 0), and those
    /// with light behind, each with its own side up. Files of mirror reflectance (SDR) and of straight-through
    /// transmittance (SDT) become its [mirrors](Material::mirror).
    ///
    /// Transmission that was measured in one direction only is assumed to be the same in the other one; a side without
    /// reflection is black.
    ///
    /// # Errors
    /// The same as for [`open`](Material::open), and if the files have different channels, or one of them is itself a
    /// sheet.
    pub fn open_sheet<P: AsRef<Path>>(front: &[P], back: &[P], options: &Options) -> Result<Self, OpenError> {
        let mut parts = Parts::default();
        let mut last = None;
        for (paths, side) in [(front, Side::Front), (back, Side::Back)] {
            for path in paths.iter().map(AsRef::as_ref) {
                let document = add_file(&mut parts, path, side, options).map_err(|error| error.in_file(path))?;
                let origin = Origin { format: document.format, source: document.source, kind: SHEET };
                last = Some((path, origin));
            }
        }
        let Some((path, origin)) = last else { return Err(OpenError::not_a_material("no files")) };
        parts.finish(origin).map_err(|error| error.in_file(path))
    }
}

fn add_file(parts: &mut Parts, path: &Path, side: Side, options: &Options) -> Result<Document, OpenError> {
    let (_, document) = lobe_formats::open(path).map_err(|error: FormatError| OpenError::from(error))?;
    match document.parts.as_slice() {
        [part] if Part::is_of_any_side(part) => parts.add(Some(side), &part.data, options)?,
        _ => return Err(OpenError::not_a_material("data that cannot be part of a sheet")),
    }
    Ok(document)
}
