//! Errors for files in unsupported formats: what they are, and what to do.

use std::path::Path;

use lobe_files::{Content, beginning, content};

use crate::{Format, FormatError, Place, merl, utia};

/// The error for a file in no known format. `bytes` is its content, which was compressed if `is_packed`; `name` is the
/// name of the content.
pub(crate) fn unknown(bytes: &[u8], name: &Path, is_packed: bool) -> FormatError {
    let known = merl::damaged(bytes, name)
        .or_else(|| speos(bytes))
        .or_else(|| content(bytes, name))
        .or_else(|| utia::damaged(bytes, name));
    let (found, expected) = match known {
        Some(content) => {
            let expected = content.expected("a measured material");
            (content.what, expected)
        }
        None => {
            let readable = Format::ALL.iter().filter(|format| format.spec().read.is_some());
            let known: Vec<&str> = readable.map(Format::name).collect();
            (format!("content of no known format, {}", beginning(bytes)), format!("one of {}", known.join(", ")))
        }
    };
    let found = if is_packed { format!("gzip, and in it {found}") } else { found };
    FormatError::new(name, Place::File, found, expected)
}

/// `true` for content that is known to be something else, even if it contains rows of numbers.
pub(crate) fn is_other(bytes: &[u8]) -> bool {
    content(bytes, Path::new("")).is_some()
}

/// The other files of Speos.
fn speos(bytes: &[u8]) -> Option<Content> {
    let line = bytes.strip_prefix(b"OPTIS - ").map(|_| bytes.split(|byte| *byte < b' ').next().unwrap_or_default())?;
    let line = String::from_utf8_lossy(&line[..line.len().min(80)]).into_owned();
    Some(Content {
        what: format!("another kind of Speos file, `{line}`"),
        advice: "Only Speos surfaces with measured values are read: export a .brdf or .anisotropicbsdf as text".into(),
    })
}
