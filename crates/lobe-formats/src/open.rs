//! Reading a file or a folder of any format.

use std::path::Path;

use lobe_files::{Unpacked, is_folder, is_gzip, is_web_page, unpacked};

use crate::adjust::adjust;
use crate::registry::{Format, sniff};
use crate::unknown::{is_other, unknown};
use crate::{Document, FormatError, Place, ReadOptions, folder, goniometer, plain, sidecar};

/// Reads a file of any supported format, which is recognised by its content. Formats that do not say whether they hold
/// reflection or transmission are assumed to hold reflection, except that the extension decides for those of Integra:
/// `.ddt` and `.sdt` are transmission. A [sidecar], if there is one, supplies facts that the file leaves open.
///
/// A file compressed with gzip is unpacked. In a folder, the files with one incident direction each (RPC Photonics,
/// pab) are read as one material.
///
/// # Errors
/// [`FormatError`] if the file or its sidecar cannot be read, is of no known format, or is damaged. For other kinds of
/// files, it says what they are.
pub fn open(path: &Path) -> Result<(Format, Document), FormatError> {
    open_with(path, &ReadOptions::default())
}

/// Like [`open`], with options, which take precedence over those of a [sidecar].
///
/// # Errors
/// The same as for [`open`], and if the options do not apply to the file.
pub fn open_with(path: &Path, options: &ReadOptions) -> Result<(Format, Document), FormatError> {
    let options = options.clone().or(sidecar::find(path)?);
    if is_folder(path) {
        let (format, document) = folder::open(path)?;
        let document = adjusted(document, format, path, &options)?;
        return Ok((format, Document { format: Some(format.name()), ..document }.printable()));
    }
    let bytes = lobe_files::read(path)?;
    read_any(&bytes, path, &options)
}

/// Reads the content of a file in memory, of any format. `path` names it in errors, and its extension is used as in
/// [`open`].
///
/// # Errors
/// The same as for [`open`].
pub fn from_bytes(bytes: &[u8], path: &Path) -> Result<Document, FormatError> {
    from_bytes_with(bytes, path, &ReadOptions::default())
}

/// Like [`from_bytes`], with options; a sidecar is not read.
///
/// # Errors
/// The same as for [`open_with`].
pub fn from_bytes_with(bytes: &[u8], path: &Path, options: &ReadOptions) -> Result<Document, FormatError> {
    Ok(read_any(bytes, path, options)?.1)
}

fn read_any(bytes: &[u8], path: &Path, options: &ReadOptions) -> Result<(Format, Document), FormatError> {
    let Unpacked { bytes: content, name } = unpacked(bytes, path)?;
    let found = match recognised(&content, options) {
        Some(format) => read_with(format, &content, &name, options).map(|document| (format, document)),
        None => {
            let error = unknown(&content, &name, is_gzip(bytes));
            Err(FormatError { expected: error.expected + &left_out(), ..error })
        }
    };
    found.map_err(|error| FormatError { file: path.into(), ..error })
}

/// The format of content that may be a table, if the options say so or it looks like one.
fn recognised(content: &[u8], options: &ReadOptions) -> Option<Format> {
    // A web page that shows a file contains the words of the file.
    if is_web_page(content) {
        return None;
    }
    let is_table = || !options.of_tables().is_empty() || (goniometer::may_be(content) && !is_other(content));
    sniff(content).or_else(|| is_table().then_some(Format::Goniometer))
}

/// A remark for programs built without some formats, if none is recognised.
fn left_out() -> String {
    let features = [
        ("json", cfg!(feature = "json")),
        ("mueller", cfg!(feature = "mueller")),
        ("rgl", cfg!(feature = "rgl")),
        ("spherical", cfg!(feature = "spherical")),
        ("window", cfg!(feature = "window")),
    ];
    let left_out: Vec<&str> = features.into_iter().filter(|(_, is_built)| !is_built).map(|(name, _)| name).collect();
    match left_out.is_empty() {
        true => String::new(),
        false => format!(" (built without the features {})", left_out.join(", ")),
    }
}

/// Reads `bytes` as a file of this format, without recognising it. `path` names it in errors, and its extension is used
/// as in [`open`].
///
/// # Errors
/// [`FormatError`] if the bytes are not a valid file of the format.
pub fn read(format: Format, bytes: &[u8], path: &Path) -> Result<Document, FormatError> {
    read_with(format, bytes, path, &ReadOptions::default())
}

/// Like [`read`], with options.
///
/// # Errors
/// The same as for [`read`], and if the options do not apply to the file.
pub fn read_with(format: Format, bytes: &[u8], path: &Path, options: &ReadOptions) -> Result<Document, FormatError> {
    let spec = format.spec();
    let Some(read) = spec.read else {
        return Err(FormatError::new(
            path,
            Place::File,
            format!("{format}, which is only written"),
            "a format to read",
        ));
    };
    let document = read(&plain::text(bytes), path, options)?;
    Ok(Document { format: Some(spec.name), ..adjusted(document, format, path, options)? }.printable())
}

/// Converts the values as the options say.
fn adjusted(document: Document, format: Format, path: &Path, options: &ReadOptions) -> Result<Document, FormatError> {
    let is_table = format == Format::Goniometer;
    if !is_table {
        options.check_no_table(path, format.name())?;
    }
    adjust(document, options, is_table, path)
}
