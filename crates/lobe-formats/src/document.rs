//! What a file holds: the data, and what the file says about them.

use std::path::Path;

use lobe_table::{Data, Scatter, Side};

use crate::{
    Format, FormatError, Place, alta, astm, cornell, ddr, fred, goniometer, light_tools, lumos, mbsdf, merl, nist,
    openmaterial, pbsdf, rgl, sdr, sniff, speos, ssdd, utia, window_xml, zemax,
};

/// What was found in a file, in the form in which it was measured.
#[derive(Clone, Debug)]
pub struct Document {
    /// The format, if it was read from a file.
    pub format: Option<Format>,
    /// The measurements, in the order of the file. More than one are those of a sheet: reflection and transmission, or
    /// both of its sides.
    pub parts: Vec<Part>,
    /// Names and values of the header in the order of the file, for people to read. Comments have the name `comment`.
    /// What became part of the data (knots, channels) is left out.
    pub source: Vec<(String, String)>,
    /// Total integrated scatter, the hemispherical integral of `f cos`, as the file states it for each block of its
    /// data, in the order of the file. Empty if it states none. Nothing is computed from it.
    pub tis: Vec<f32>,
}

/// One measurement of a document.
#[derive(Clone, Debug)]
pub struct Part {
    /// The name in the file; may be empty.
    pub name: String,
    /// The side from which the light comes; `None` if the file does not distinguish the sides, or if the data do (see
    /// [`Representation::is_two_sided`](lobe_table::Representation::is_two_sided)).
    pub side: Option<Side>,
    /// The values.
    pub data: Data,
}

impl Part {
    /// A part of a file that does not distinguish the sides.
    pub fn new(name: impl Into<String>, data: impl Into<Data>) -> Self {
        Part { name: name.into(), side: None, data: data.into() }
    }

    /// `true` if the data hold whichever side the light comes from.
    pub fn is_of_any_side(&self) -> bool {
        self.side.is_none() && !self.data.representation().is_two_sided()
    }
}

impl Document {
    /// One measurement about which there is nothing else to say.
    pub fn new(data: impl Into<Data>) -> Self {
        Document { format: None, parts: vec![Part::new("", data)], source: Vec::new(), tis: Vec::new() }
    }

    /// The measurements of a sheet. The name of a single one that is of no particular side becomes a fact of the header.
    pub fn of_parts(mut parts: Vec<Part>) -> Self {
        let mut source = Vec::new();
        if let [Part { name, side: None, .. }] = parts.as_mut_slice()
            && !name.is_empty()
        {
            source.push(("name".into(), std::mem::take(name)));
        }
        Document { format: None, parts, source, tis: Vec::new() }
    }

    /// The data, if they are one measurement of no particular side.
    pub fn only(&self) -> Option<&Data> {
        match self.parts.as_slice() {
            [Part { side: None, data, .. }] => Some(data),
            _ => None,
        }
    }

    /// `true` if there are several measurements, or one of a particular side.
    pub fn is_sheet(&self) -> bool {
        self.only().is_none()
    }

    /// The same with facts of the header; those without a value are left out.
    fn with_source(mut self, source: &[(&str, &str)]) -> Self {
        let stated = source.iter().filter(|(_, value)| !value.is_empty());
        self.source.extend(stated.map(|(name, value)| ((*name).into(), (*value).into())));
        self
    }
}

/// Data of a known type, and what their file says about them.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured<T> {
    /// The data.
    pub data: T,
    /// As [`Document::source`].
    pub source: Vec<(String, String)>,
    /// As [`Document::tis`].
    pub tis: Vec<f32>,
}

impl<T: Into<Data>> From<Measured<T>> for Document {
    fn from(Measured { data, source, tis }: Measured<T>) -> Self {
        Document { source, tis, ..Document::new(data) }
    }
}

/// Reads a file of any supported format, which is recognised from the content. Formats that do not say whether they
/// hold reflection or transmission are assumed to hold reflection; only for those of Integra the extension decides:
/// `.ddt` and `.sdt` are transmission.
///
/// A folder is read as the RPC Photonics files in it, which are one material.
///
/// # Errors
/// [`FormatError`] if the file cannot be read, is of no known format, or is damaged.
pub fn open(path: &Path) -> Result<(Format, Document), FormatError> {
    if path.is_dir() {
        let document = Document::new(fred::read_rpc_folder(path)?);
        return Ok((Format::Rpc, Document { format: Some(Format::Rpc), ..document }));
    }
    let bytes = std::fs::read(path)
        .map_err(|error| FormatError::new(path, Place::File, error.to_string(), "a file that can be read"))?;
    let format = recognised(&bytes, path)?;
    Ok((format, read(format, &bytes, path)?))
}

/// Reads the content of a file in memory, whatever its format. `path` names it in errors, and its extension counts as in
/// [`open`].
///
/// # Errors
/// As [`open`].
pub fn from_bytes(bytes: &[u8], path: &Path) -> Result<Document, FormatError> {
    read(recognised(bytes, path)?, bytes, path)
}

fn recognised(bytes: &[u8], path: &Path) -> Result<Format, FormatError> {
    sniff(bytes).ok_or_else(|| {
        let known: Vec<&str> = Format::ALL.iter().map(Format::name).collect();
        FormatError::new(path, Place::File, "content of no known format", format!("one of {}", known.join(", ")))
    })
}

/// Reads `bytes` as a file of this format, whatever they look like. `path` names it in errors, and its extension counts
/// as in [`open`].
///
/// # Errors
/// [`FormatError`] if the bytes are not a valid file of the format.
pub fn read(format: Format, bytes: &[u8], path: &Path) -> Result<Document, FormatError> {
    let document = match format {
        Format::Pbsdf => Document::new(pbsdf::read(bytes, path)?),
        Format::Rgl => {
            let data = rgl::read(bytes, path)?;
            let description = data.parts().description.clone();
            Document::new(data).with_source(&[("description", &description)])
        }
        Format::Mbsdf => Document::of_parts(mbsdf::read(bytes, path)?.into_parts()),
        Format::WindowXml => window_xml::read(bytes, path)?.into(),
        Format::Speos => Document::of_parts(speos::read(bytes, path)?.into_parts()),
        Format::Merl => Document::new(merl::read(bytes, path)?),
        Format::Utia => {
            let unit = ("unit", "not documented; values are as they are stored");
            Document::new(utia::read(bytes, path)?).with_source(&[unit])
        }
        Format::Zemax => zemax::read(bytes, path)?.into(),
        Format::LightTools => Document::of_parts(light_tools::read(bytes, path)?),
        Format::Ssdd => Document::of_parts(ssdd::read(bytes, path)?),
        Format::Astm => Document::new(astm::read(bytes, path)?),
        Format::OpenMaterial => Document::new(openmaterial::read(bytes, path)?),
        Format::Fred => Document::new(fred::read(bytes, path)?),
        Format::Rpc => Document::new(fred::read_rpc(bytes, path)?),
        Format::Cornell => Document::new(cornell::read(bytes, path)?),
        Format::Alta => Document::new(alta::read(bytes, path)?),
        Format::Nist => Document::new(nist::read(bytes, path)?),
        Format::Lumos => Document::new(lumos::read(bytes, path)?),
        Format::Goniometer => Document::new(goniometer::read(bytes, path)?),
        Format::Ddr => ddr::read(bytes, path, scatter_of_extension(path))?.into(),
        Format::Sdr => sdr::read(bytes, path, scatter_of_extension(path))?.into(),
    };
    Ok(Document { format: Some(format), ..document })
}

/// Integra's extensions: a `t` at the end is transmission.
pub(crate) fn scatter_of_extension(path: &Path) -> Scatter {
    let is = |extension: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension));
    if is("ddt") || is("sdt") { Scatter::Transmission } else { Scatter::Reflection }
}
