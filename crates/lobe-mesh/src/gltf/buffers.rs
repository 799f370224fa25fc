//! The bytes of buffers: inside the file, in its text, or in files beside it.

use std::borrow::Cow;
use std::path::{Component, Path, PathBuf};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use lobe_formats::FormatError;

use super::document::Document;
use crate::file::{self, wrong};

/// Loads all buffers. `binary` is the second chunk of a binary file.
pub(super) fn load<'a>(
    path: &Path,
    document: &Document,
    binary: Option<&'a [u8]>,
) -> Result<Vec<Cow<'a, [u8]>>, FormatError> {
    let mut buffers = Vec::new();
    for (number, buffer) in document.buffers.iter().enumerate() {
        let (name, bytes) = match (&buffer.uri, binary) {
            (Some(uri), _) => (shown(uri), external(path, number, uri)?),
            (None, Some(binary)) if number == 0 => ("the binary chunk".into(), Cow::Borrowed(binary)),
            (None, _) => return Err(wrong(path, format!("no bytes of buffer {number}"), "a uri or a binary chunk")),
        };
        if bytes.len() < buffer.byte_length {
            let found = format!("{} bytes of buffer {number} in {name}", bytes.len());
            return Err(wrong(path, found, format!("{}, its byteLength", buffer.byte_length)));
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

fn external<'a>(path: &Path, number: usize, uri: &str) -> Result<Cow<'a, [u8]>, FormatError> {
    if let Some(data) = uri.strip_prefix("data:") {
        let text = data.split_once(";base64,").map(|(_, text)| text);
        let bytes = text.and_then(|text| STANDARD.decode(text).ok());
        let bytes = bytes.ok_or_else(|| wrong(path, format!("the data uri of buffer {number}"), "base64"))?;
        return Ok(Cow::Owned(bytes));
    }
    Ok(Cow::Owned(file::bytes(&beside(path, uri)?)?))
}

/// The file that a relative uri names. A scene must not open what lies elsewhere.
fn beside(path: &Path, uri: &str) -> Result<PathBuf, FormatError> {
    let decoded = percent_encoding::percent_decode_str(uri).decode_utf8();
    let relative = decoded.ok().map(|uri| PathBuf::from(&*uri)).filter(|file| {
        file.components().all(|component| matches!(component, Component::Normal(_) | Component::CurDir))
    });
    match relative {
        Some(file) if !uri.contains("://") => Ok(path.parent().unwrap_or(Path::new("")).join(file)),
        _ => Err(wrong(path, format!("the uri {}", shown(uri)), "the name of a file in the same folder or below")),
    }
}

/// A uri short enough for a message.
fn shown(uri: &str) -> String {
    uri.chars().take(60).collect()
}
