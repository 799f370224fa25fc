//! Loads the bytes of buffers: from the file itself, from its text, or from files next to it.

use std::collections::HashMap;
use std::path::{Component, Path, PathBuf};
use std::rc::Rc;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use lobe_files::FormatError;

use super::document::Document;
use crate::file::{self, wrong};

/// Loads all buffers. `binary` is the second chunk of a binary file.
pub(super) fn load(path: &Path, document: &Document, binary: Option<&[u8]>) -> Result<Vec<Rc<[u8]>>, FormatError> {
    let mut buffers = Vec::new();
    // Each file is read once: a thousand buffers may name the same one.
    let mut files: HashMap<PathBuf, Rc<[u8]>> = HashMap::new();
    for (number, buffer) in document.buffers.iter().enumerate() {
        let bytes: Rc<[u8]> = match (&buffer.uri, binary) {
            (Some(uri), _) => match uri.strip_prefix("data:") {
                Some(data) => decode(path, number, data)?.into(),
                None => {
                    let name = beside(path, uri)?;
                    match files.get(&name) {
                        Some(bytes) => bytes.clone(),
                        None => files.entry(name.clone()).or_insert(file::bytes(&name)?.into()).clone(),
                    }
                }
            },
            (None, Some(binary)) if number == 0 => binary.into(),
            (None, _) => return Err(wrong(path, format!("no bytes of buffer {number}"), "a uri or a binary chunk")),
        };
        if bytes.len() < buffer.byte_length {
            let name = buffer.uri.as_deref().map_or("the binary chunk".into(), shown);
            let found = format!("{} bytes of buffer {number} in {name}", bytes.len());
            return Err(wrong(path, found, format!("{}, its byteLength", buffer.byte_length)));
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

/// Decodes the part of a uri after `data:`.
fn decode(path: &Path, number: usize, data: &str) -> Result<Vec<u8>, FormatError> {
    let text = data.split_once(";base64,").map(|(_, text)| text);
    let bytes = text.and_then(|text| STANDARD.decode(text).ok());
    bytes.ok_or_else(|| wrong(path, format!("the data uri of buffer {number}"), "base64"))
}

/// The file that a relative uri names. A scene must not open files elsewhere.
fn beside(path: &Path, uri: &str) -> Result<PathBuf, FormatError> {
    let decoded = percent_encoding::percent_decode_str(uri).decode_utf8().unwrap_or_default();
    let mut file = path.parent().unwrap_or(Path::new("")).to_path_buf();
    for component in Path::new(&*decoded).components() {
        match component {
            Component::CurDir => {}
            Component::Normal(name) if !uri.contains("://") => file.push(name),
            _ => {
                return Err(wrong(
                    path,
                    format!("the uri {}", shown(uri)),
                    "the name of a file in the same folder or below",
                ));
            }
        }
    }
    Ok(file)
}

/// A uri short enough for a message.
fn shown(uri: &str) -> String {
    lobe_files::excerpt(uri, 60)
}
