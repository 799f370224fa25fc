//! What a file holds: the data, and what the file says about them.

use std::path::Path;

use lobe_table::{Scatter, half_diff, mueller, scattered, specular, spherical};

use crate::sheet::{Data, Part};
use crate::window_xml::WindowXml;
use crate::{
    Format, FormatError, Place, Specular, alta, astm, cornell, ddr, fred, goniometer, light_tools, lumos, mbsdf, merl,
    nist, openmaterial, pbsdf, rgl, sdr, sniff, speos, ssdd, utia, window_xml, zemax,
};

/// The content of one file.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured<T> {
    /// The data.
    pub data: T,
    /// Names and values of the header in the order of the file, for people to read. Comments have the name `comment`.
    /// What became part of the data (knots, channels) is left out.
    pub source: Vec<(String, String)>,
    /// Total integrated scatter, the hemispherical integral of `f cos`, as the file states it for each block of its
    /// data, in the order of the file. Empty where it states none. Nothing is computed from it.
    pub tis: Vec<f32>,
}

impl<T> Measured<T> {
    /// Data about which the file says this, as far as it says anything.
    fn new(data: T, source: &[(&str, &str)]) -> Self {
        let stated = source.iter().filter(|(_, value)| !value.is_empty());
        Measured { data, source: stated.map(|(name, value)| ((*name).into(), (*value).into())).collect(), tis: vec![] }
    }
}

/// What was found in a file, in the form in which it was measured.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Document {
    /// A BRDF or BTDF on a grid of specular coordinates.
    Table(Measured<specular::Data>),
    /// The mirror reflectance, or the transmittance straight through, of a smooth surface.
    Specular(Measured<Specular>),
    /// A BRDF or BTDF on a grid of spherical coordinates.
    Spherical(Measured<spherical::Data>),
    /// A BRDF or BTDF on no grid.
    Scattered(Measured<scattered::Data>),
    /// Several measurements of one sheet.
    Sheet(Measured<Vec<Part>>),
    /// The adaptive parameterisation of the EPFL database.
    Rgl(Measured<lobe_table::rgl::Data>),
    /// A grid of half and difference angles.
    HalfDiff(Measured<half_diff::Data>),
    /// The grid of the UTIA database.
    Utia(Measured<lobe_table::utia::Data>),
    /// Mueller matrices.
    Mueller(Measured<mueller::Data>),
    /// Klems matrices or tensor trees of the two sides of a sheet.
    Window(Measured<WindowXml>),
}

impl Document {
    /// A sheet; or its only measurement, where the file does not tell sides apart.
    fn sheet(mut parts: Vec<Part>) -> Self {
        match parts.pop() {
            Some(Part { name, side: None, data }) if parts.is_empty() => {
                let source = [("name", name.as_str())];
                match data {
                    Data::Table(data) => Document::Table(Measured::new(data, &source)),
                    Data::Spherical(data) => Document::Spherical(Measured::new(data, &source)),
                    Data::Scattered(data) => Document::Scattered(Measured::new(data, &source)),
                    Data::Specular(data) => Document::Specular(Measured::new(data, &source)),
                }
            }
            last => {
                parts.extend(last);
                Document::Sheet(Measured::new(parts, &[]))
            }
        }
    }

    /// What the header of the file says, see [`Measured::source`].
    pub fn source(&self) -> &[(String, String)] {
        self.stated().0
    }

    /// The total integrated scatter that the file states, see [`Measured::tis`].
    pub fn tis(&self) -> &[f32] {
        self.stated().1
    }

    fn stated(&self) -> (&[(String, String)], &[f32]) {
        match self {
            Document::Table(Measured { source, tis, .. })
            | Document::Specular(Measured { source, tis, .. })
            | Document::Spherical(Measured { source, tis, .. })
            | Document::Scattered(Measured { source, tis, .. })
            | Document::Sheet(Measured { source, tis, .. })
            | Document::Rgl(Measured { source, tis, .. })
            | Document::HalfDiff(Measured { source, tis, .. })
            | Document::Utia(Measured { source, tis, .. })
            | Document::Mueller(Measured { source, tis, .. })
            | Document::Window(Measured { source, tis, .. }) => (source, tis),
        }
    }
}

/// Reads a file of any supported format, which is told from the content. Formats that do not say whether they hold
/// reflection or transmission are taken for reflection; only those of Integra are asked for their extension: `.ddt` and
/// `.sdt` are transmission.
///
/// A folder is read as the RPC Photonics files in it, which are one material.
///
/// # Errors
/// [`FormatError`] where the file cannot be read, is of no known format, or is damaged.
pub fn open(path: &Path) -> Result<(Format, Document), FormatError> {
    if path.is_dir() {
        return Ok((Format::Rpc, Document::Scattered(Measured::new(fred::read_rpc_folder(path)?, &[]))));
    }
    let bytes = std::fs::read(path)
        .map_err(|error| FormatError::new(path, Place::File, error.to_string(), "a file that can be read"))?;
    let format = sniff(&bytes).ok_or_else(|| {
        let known: Vec<&str> = Format::ALL.iter().map(Format::name).collect();
        FormatError::new(path, Place::File, "content of no known format", format!("one of {}", known.join(", ")))
    })?;
    Ok((format, read(format, &bytes, path)?))
}

/// Reads `bytes` as a file of this format, whatever they look like. `path` names it in errors, and its extension counts
/// as in [`open`].
///
/// # Errors
/// [`FormatError`] where the bytes are no sound file of the format.
pub fn read(format: Format, bytes: &[u8], path: &Path) -> Result<Document, FormatError> {
    let scattered = |data| Ok(Document::Scattered(Measured::new(data, &[])));
    match format {
        Format::Pbsdf => Ok(Document::Mueller(Measured::new(pbsdf::read(bytes, path)?, &[]))),
        Format::Rgl => {
            let data = rgl::read(bytes, path)?;
            let description = data.parts().description.clone();
            Ok(Document::Rgl(Measured::new(data, &[("description", &description)])))
        }
        Format::Mbsdf => Ok(Document::sheet(mbsdf::read(bytes, path)?.into_parts(Data::Spherical))),
        Format::WindowXml => {
            let data = window_xml::read(bytes, path)?;
            let (name, manufacturer) = (data.name.clone(), data.manufacturer.clone());
            Ok(Document::Window(Measured::new(data, &[("name", &name), ("manufacturer", &manufacturer)])))
        }
        Format::Speos => Ok(Document::sheet(speos::read(bytes, path)?.into_parts(Data::Scattered))),
        Format::Merl => Ok(Document::HalfDiff(Measured::new(merl::read(bytes, path)?, &[]))),
        Format::Utia => {
            let unit = ("unit", "not documented; values are as they are stored");
            Ok(Document::Utia(Measured::new(utia::read(bytes, path)?, &[unit])))
        }
        Format::Zemax => zemax::read(bytes, path).map(Document::Table),
        Format::LightTools => light_tools::read(bytes, path).map(Document::sheet),
        Format::Ssdd => ssdd::read(bytes, path).map(Document::sheet),
        Format::Astm => scattered(astm::read(bytes, path)?),
        Format::OpenMaterial => scattered(openmaterial::read(bytes, path)?),
        Format::Fred => scattered(fred::read(bytes, path)?),
        Format::Rpc => scattered(fred::read_rpc(bytes, path)?),
        Format::Cornell => scattered(cornell::read(bytes, path)?),
        Format::Alta => scattered(alta::read(bytes, path)?),
        Format::Nist => scattered(nist::read(bytes, path)?),
        Format::Lumos => scattered(lumos::read(bytes, path)?),
        Format::Goniometer => Ok(Document::sheet(vec![Part::new("", goniometer::read(bytes, path)?)])),
        Format::Ddr => ddr::read(bytes, path, scatter_of_extension(path)).map(Document::Table),
        Format::Sdr => sdr::read(bytes, path, scatter_of_extension(path)).map(Document::Specular),
    }
}

/// Integra's extensions: a `t` at the end is transmission.
pub(crate) fn scatter_of_extension(path: &Path) -> Scatter {
    let is = |extension: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension));
    if is("ddt") || is("sdt") { Scatter::Transmission } else { Scatter::Reflection }
}
