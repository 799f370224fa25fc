//! Recognition of files in unsupported formats, so that an error can say what a file is, and what to do.

mod archive;
mod signatures;
mod text;

use std::path::Path;

/// A recognised kind of file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Content {
    /// In words, with an article: `a web page (HTML)`.
    pub what: String,
    /// What to do, as a sentence without a period; empty if there is no advice.
    pub advice: String,
}

impl Content {
    pub(crate) fn new(what: impl Into<String>, advice: impl Into<String>) -> Self {
        Content { what: what.into(), advice: advice.into() }
    }

    /// What was expected, and what to do.
    pub fn expected(&self, expected: &str) -> String {
        if self.advice.is_empty() { expected.into() } else { format!("{expected}. {}", self.advice) }
    }
}

/// The kind of the file `path` with this content, from its first bytes and, for container formats, its name. `None` for
/// plain text and for unknown content; [`beginning`] shows how it begins.
pub fn content(bytes: &[u8], path: &Path) -> Option<Content> {
    if bytes.is_empty() {
        return Some(Content::new("an empty file", AGAIN));
    }
    if bytes.iter().all(|byte| *byte == 0) {
        return Some(Content::new(format!("{} bytes that are all zero", bytes.len()), AGAIN));
    }
    archive::content(bytes, path).or_else(|| signatures::content(bytes, path)).or_else(|| text::content(bytes))
}

/// `true` for HTML, which may contain the keywords of other formats.
pub fn is_web_page(bytes: &[u8]) -> bool {
    let start = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    start.starts_with(b"<") && text::of(bytes).is_some_and(|text| text::is_web_page(text.trim_start()))
}

/// The beginning of a file, for people: the first line of a text, or the first bytes in hexadecimal.
pub fn beginning(bytes: &[u8]) -> String {
    const LIMIT: usize = 40;
    if let Some(text) = text::of(bytes) {
        let line = text.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or_default();
        let short: String = line.chars().take(LIMIT).collect();
        let ellipsis = if short.len() < line.len() { "..." } else { "" };
        return format!("text that begins `{}{ellipsis}`", crate::printable(&short));
    }
    let bytes: Vec<String> = bytes.iter().take(8).map(|byte| format!("{byte:02x}")).collect();
    format!("binary data that begin {}", bytes.join(" "))
}

/// Advice for files that were damaged in transfer.
pub(crate) const AGAIN: &str = "The copy or download failed: fetch the file again";

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn what(bytes: &[u8], name: &str) -> String {
        content(bytes, Path::new(name)).map_or("-".into(), |content| content.what)
    }

    #[test]
    fn signatures_are_recognised_and_texts_described() {
        let pdf = b"%PDF-1.7\n%\xe2\xe3";
        for (bytes, name, expected) in [
            (b"".as_slice(), "a", "an empty file"),
            (&[0; 99], "a", "99 bytes that are all zero"),
            (b"\x89HDF\r\n\x1a\n", "a.h5", "an HDF5 file"),
            (b"\x89HDF\r\n\x1a\n", "a.AXF", "an AxF file of X-Rite (HDF5)"),
            (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "a.xls", "an Excel workbook (.xls)"),
            (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "a", "a document of Microsoft Office (before 2007)"),
            (pdf, "a.bsdf", "a PDF document"),
            (b"\xff\xd8\xff\xe0", "a.exr", "a JPEG picture"),
            (b"BZh91AY&SY", "a", "an archive or file packed with bzip2"),
            (b"\x93NUMPY\x01\0v\0", "a.npy", "a NumPy array (.npy)"),
            (b"ply\nformat ascii 1.0\n", "a", "a mesh (PLY)"),
            (b"# Blender\nmtllib a.mtl\no Cube\nv 1 1 1\nv 0 0 1.5\nf 1 2 1\n", "a", "a mesh (OBJ)"),
            (b"solid thing\nfacet normal 0 0 1\n", "a", "a mesh (STL)"),
            (b"\x1c\x04\x04\0\x78\x9c", "a", "a mesh of Mitsuba (.serialized)"),
            (b"<!DOCTYPE html>\n<html>", "a.xml", "a web page (HTML)"),
            (b"\n  <HTML lang=en>", "a.xml", "a web page (HTML)"),
            (b"<?xml version='1.0'?><!-- c --><scene version=\"2\">", "a.xml", "a scene of Mitsuba"),
            (b"<materialx version=\"1.38\">", "a", "a material of MaterialX"),
            (b"<?xml version=\"1.0\"?>\n<svg xmlns=\"x\">", "a", "a picture (SVG)"),
            (b"<?xml version=\"1.0\"?>\n<note>", "a", "an XML file of another kind, <note>"),
            (b"version https://git-lfs.github.com/spec/v1\noid", "a", "a pointer of Git LFS in place of the file"),
            (b"/annex/objects/SHA256E-s12--34.bsdf\n", "a", "a pointer of git-annex in place of the file"),
            (b"{\"asset\": {\"version\": \"2.0\"}, \"meshes\": []}", "a", "a mesh (glTF)"),
            (b"{\"name\": 1, \"b\": 2}", "a", "a JSON file of another kind, with \"name\" and \"b\""),
            (b"analytic\n\n::begin parameters\n", "a.brdf", "a shader of Disney's BRDF Explorer, a formula"),
            (b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n", "a", "a picture (Radiance HDR)"),
            (
                b"#?RGBE\nEXPOSURE=1\n\n-Y 1 +X 3\n\x80\xff\x01\x81\x90\xa0\xb0\0\0\0\0\0",
                "a",
                "a picture (Radiance HDR)",
            ),
            (b"#?RADIANCE\npabopto2bsdf x\nFORMAT=BSDF_RBFmesh\n\n", "a", "an interpolated BSDF of Radiance (.sir)"),
            (b"404: Not Found", "a", "the message of a server, `404: Not Found`"),
            (b"IESNA:LM-63-2002\n", "a", "the light distribution of a lamp (IES)"),
            (b"Lamps Ltd\n1\n4\n24\n15\n37\n5\n\nDownlight\n", "a", "the light distribution of a lamp (EULUMDAT)"),
            (b"# a room\nvoid plastic red\n0\n0\n5 .7 .1 .1 0 0\n", "a", "a scene of Radiance"),
            (b"integrator = \"path\"\n[camera]\nposition = [0, 0, 1]\n", "a.toml", "a scene (TOML)"),
            (b"#!/bin/sh\nlobe info \"$1\"\n", "a", "a script"),
            (b"hello, world", "a", "-"),
            (&[1, 2, 3, 200], "a", "-"),
        ] {
            assert_eq!(what(bytes, name), expected, "{name}: {}", String::from_utf8_lossy(bytes));
        }
        assert!(content(pdf, Path::new("a")).expect("a PDF").expected("data").starts_with("data. "));
    }

    #[test]
    fn archives_are_described_by_their_contents() {
        // Local headers of two stored files.
        let entry = |name: &str| {
            let mut bytes = b"PK\x03\x04\x14\0\0\0\0\0\0\0\0\0".to_vec();
            bytes.extend([0; 12]);
            bytes.extend([name.len() as u8, 0, 0, 0]);
            bytes.extend(name.as_bytes());
            bytes
        };
        assert_eq!(what(&[entry("x.bsdf"), entry("y")].concat(), "a"), "a zip archive with x.bsdf");
        assert_eq!(what(&entry("bad\u{1b}[31m"), "a"), "a zip archive with bad\\u{1b}[31m");
        assert_eq!(what(&entry("xl/workbook.xml"), "a"), "an Excel workbook (.xlsx)");
        assert_eq!(
            what(&[entry("[Content_Types].xml"), entry("xl/a")].concat(), "a.xlsx"),
            "an Excel workbook (.xlsx)"
        );
        assert_eq!(what(&entry("values.npy"), "a.npz"), "NumPy arrays (.npz)");
        let workbook = [entry("[Content_Types].xml"), entry("docProps/app.xml"), entry("xl/workbook.xml")].concat();
        assert_eq!(what(&workbook, "scan.csv"), "an Excel workbook (.xlsx)");
        let sheet = [entry("mimetype"), b"application/vnd.oasis.opendocument.spreadsheet".to_vec()].concat();
        assert_eq!(what(&sheet, "scan.csv"), "a spreadsheet (.ods)");
        for end in 0..40 {
            what(&entry("x.bsdf")[..end.min(36)], "a");
        }
    }

    #[test]
    fn beginnings_are_short_and_harmless() {
        assert_eq!(beginning(b"\n hello\nworld"), "text that begins `hello`");
        assert_eq!(beginning(&[b'a'; 99]), format!("text that begins `{}...`", "a".repeat(40)));
        assert_eq!(beginning(b"\x1b[31mred"), "text that begins `\\u{1b}[31mred`");
        assert_eq!(beginning(&[0, 255, 7]), "binary data that begin 00 ff 07");
    }
}
