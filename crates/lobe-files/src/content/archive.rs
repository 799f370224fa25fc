//! Compressed files and archives.

use std::path::Path;

use super::Content;
use crate::printable;

const UNPACK: &str = "Unpack it first";
const EXPORT: &str = "Export the sheet as CSV";

pub(super) fn content(bytes: &[u8], path: &Path) -> Option<Content> {
    const PACKED: [(&[u8], &str); 8] = [
        (b"BZh", "an archive or file packed with bzip2"),
        (b"\xfd7zXZ\0", "an archive or file packed with xz"),
        (b"\x28\xb5\x2f\xfd", "an archive or file packed with zstd"),
        (b"\x04\x22\x4d\x18", "a file packed with lz4"),
        (b"7z\xbc\xaf\x27\x1c", "a 7-Zip archive"),
        (b"Rar!\x1a\x07", "a RAR archive"),
        (b"MSCF\0\0\0\0", "a cabinet archive (.cab)"),
        (b"\x1f\x9d", "a file packed with compress (.Z)"),
    ];
    if let Some((_, what)) = PACKED.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return Some(Content::new(*what, UNPACK));
    }
    if bytes.get(257..262) == Some(b"ustar") {
        return Some(Content::new("a tar archive", UNPACK));
    }
    if crate::is_gzip(bytes) {
        return Some(Content::new("a file packed with gzip", UNPACK));
    }
    if bytes.starts_with(b"PK\x05\x06") {
        return Some(Content::new("an empty zip archive", super::AGAIN));
    }
    bytes.starts_with(b"PK\x03\x04").then(|| zip(bytes, path))
}

/// A zip archive, on which many formats are built.
fn zip(bytes: &[u8], path: &Path) -> Content {
    let name = first_name(bytes);
    let is_named = |extension: &str| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(extension));
    // Workbooks may have any name, and any file first.
    let has = |part: &str| {
        const ENDS: usize = 1 << 18;
        let ends = [&bytes[..bytes.len().min(ENDS)], &bytes[bytes.len().saturating_sub(ENDS)..]];
        ends.iter().any(|end| end.windows(part.len()).any(|window| window == part.as_bytes()))
    };
    match () {
        () if name.starts_with("xl/") || is_named("xlsx") || is_named("xlsm") || has("xl/workbook.") => {
            Content::new("an Excel workbook (.xlsx)", EXPORT)
        }
        () if is_named("ods") || has("opendocument.spreadsheet") => Content::new("a spreadsheet (.ods)", EXPORT),
        () if name.starts_with("word/")
            || has("word/document.xml")
            || has("opendocument.text")
            || is_named("docx")
            || is_named("odt") =>
        {
            Content::new("a text document", "Save its table as CSV")
        }
        () if name.ends_with(".npy") => {
            Content::new("NumPy arrays (.npz)", "Save the angles and values as columns of a CSV file")
        }
        () if name.is_empty() => Content::new("a damaged zip archive", super::AGAIN),
        () => Content::new(format!("a zip archive with {name}"), UNPACK),
    }
}

/// The name of the first file, from its header.
fn first_name(bytes: &[u8]) -> String {
    let length = bytes.get(26..28).map_or(0, |length| usize::from(u16::from_le_bytes([length[0], length[1]])));
    let name = bytes.get(30..).unwrap_or_default();
    let name = String::from_utf8_lossy(&name[..length.min(name.len()).min(60)]).into_owned();
    printable(&name).into_owned()
}
