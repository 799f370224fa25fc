//! Surface files of Ansys Speos (formerly OPTIS), text form: `.brdf` and `.anisotropicbsdf`.
//!
//! Both hold tables of polar angle by azimuth for each incident direction, for reflection, transmission, or both. A
//! table is proportional to `f`, or to `f cos` ("intensity"); its scale comes from a percentage, the albedo, that the
//! file states per wavelength. In `.brdf`, every incident angle and wavelength has its own table and percentage; an
//! `.anisotropicbsdf` has tables per rotation of the sample and incident angle, and one spectrum of percentages, which
//! applies to one of its incident directions. Azimuth 0 is the direction in which the light continues, so that the
//! mirror direction of incidence `i` is at polar angle `i`, azimuth 0; polar angles of transmission are above 90
//! degrees.

mod anisotropic;
mod brdf;
mod incident;
pub mod surface;
mod table;
mod write;

use std::path::Path;

use lobe_table::{Channels, scattered, spherical};

use crate::facts::Facts;
use crate::lines::shown;
use crate::spec::{FormatSpec, Writer, either};
use crate::{Document, FormatError, Sides};
use table::Source;

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "Speos BSDF",
    word: "speos",
    extensions: &["brdf", "anisotropicbsdf"],
    matches,
    read: Some(|bytes, path, _| Ok(Document::of_parts(read(bytes, path)?.into_parts()).with_facts(facts(bytes)))),
    read_set: None,
    writer: Some(Writer {
        extensions: &["brdf", "anisotropicbsdf"],
        holds_channels: |channels| matches!(channels, Channels::Spectral(_)),
        channels: "wavelengths, or one channel",
        holds: write::holds,
        holds_sheets: true,
        scatter: either,
        resampled_as: Ok(spherical::KIND),
        write: write::write,
    }),
};

/// `true` if the first line identifies one of these files.
pub fn matches(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(128)]).to_ascii_lowercase();
    head.starts_with("optis - ")
        && (head.contains("brdf surface file") || head.contains("anisotropic bsdf surface file"))
}

/// The comment of a text file.
fn facts(bytes: &[u8]) -> Facts {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
    let comment = head.lines().nth(2).map(str::trim).filter(|comment| !comment.is_empty());
    comment.map(|comment| ("comment".into(), comment.into())).into_iter().collect()
}

/// Reads a file of either kind. `file` is only its name in errors.
///
/// # Errors
/// [`FormatError`] with the line: another kind of file, the binary form, counts for which the rest of the file is too
/// short, missing or invalid numbers, or tables that are all 0 and cannot be scaled.
pub fn read(bytes: &[u8], file: &Path) -> Result<Sides<scattered::Data>, FormatError> {
    let text = String::from_utf8_lossy(bytes);
    let mut source = Source::new(file, &text);
    let header = source.line("the line that names the file")?;
    let is_brdf = match header.to_ascii_lowercase() {
        header if header.starts_with("optis - brdf surface file") => true,
        header if header.starts_with("optis - anisotropic bsdf surface file") => false,
        _ => return Err(source.error(shown(header), "`OPTIS - brdf` or `OPTIS - Anisotropic BSDF surface file`")),
    };
    match source.line("0, text")?.trim() {
        "0" => {}
        // Binary data follow the line, or are in it.
        mode if mode.starts_with('1') && !mode[1..].starts_with(|c: char| c.is_ascii_digit()) => {
            let expected =
                "mode 0, text. The binary form is not public: save the file as text, in the BSDF viewer of Speos";
            return Err(source.error("mode 1, the binary form", expected));
        }
        other => return Err(source.error(shown(other), "mode 0, text")),
    }
    source.line("a comment")?;
    let length = source.line("the length of the description")?.trim().parse::<usize>();
    let length = length.map_err(|_| source.error("a word that is not a number", "the length of the description"))?;
    source.description(length)?;
    if is_brdf { brdf::read(&mut source) } else { anisotropic::read(&mut source) }
}
