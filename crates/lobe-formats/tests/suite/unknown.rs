//! Files that are compressed, damaged or something else, and the messages about them.

use std::io::Write as _;
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;
use lobe_formats::{Document, Format, FormatError, Place, from_bytes, open};
use lobe_table::Scatter;
use lobe_testing::examples::{self, LIGHT_TOOLS, tiny_merl};

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).expect("memory");
    encoder.finish().expect("memory")
}

#[track_caller]
fn refusal(bytes: &[u8], name: &str) -> FormatError {
    let error = from_bytes(bytes, Path::new(name)).map(|_| ()).expect_err("a refusal");
    assert_eq!(error.file, Path::new(name));
    error
}

#[track_caller]
fn refused(bytes: &[u8], name: &str, found: &str, expected: &str) {
    let error = refusal(bytes, name);
    assert!(error.found.contains(found) && error.expected.contains(expected), "{error}");
}

/// A comparable form of everything that was read.
fn shown(document: &Document) -> String {
    format!("{document:?}")
}

#[test]
fn every_format_may_be_compressed() {
    for (format, bytes) in examples::all() {
        let plain = from_bytes(&bytes, Path::new("a")).unwrap_or_else(|error| panic!("{format}: {error}"));
        let packed = from_bytes(&gzip(&bytes), Path::new("a.gz")).unwrap_or_else(|error| panic!("{format}: {error}"));
        assert_eq!(shown(&plain), shown(&packed), "{format}");
    }
    // The name of the content is used, and errors name the file.
    let document = from_bytes(&gzip(examples::DDR.as_bytes()), Path::new("film.ddt.gz")).expect("a table");
    assert_eq!(document.parts[0].data.representation().aspects()[0].scatter, Scatter::Transmission);
    let error = refusal(&gzip(examples::DDR.replace("gre", "grx").as_bytes()), "film.ddt.gz");
    assert!(matches!(error.place, Place::Line(line) if line > 5), "{error}");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("film.bsdf");
    std::fs::write(&path, gzip(LIGHT_TOOLS.as_bytes())).expect("a file");
    assert_eq!(open(&path).expect("a table").0, Format::LightTools);
    refused(&gzip(LIGHT_TOOLS.as_bytes())[..100], "a.gz", "gzip that is cut short: 100 bytes", "again");
    refused(&gzip(b"%PDF-1.4"), "a.gz", "gzip, and in it a PDF document", "a measured material");
    refused(&gzip(b"hello"), "a.gz", "gzip, and in it content of no known format", "one of ");
}

#[test]
fn merl_files_that_are_damaged_are_recognised() {
    let database = [[90_i32, 90, 180], [90, 90, 360]];
    for dims in database {
        let head = dims.map(i32::to_le_bytes).concat();
        let size = 12 + 24 * dims.iter().map(|dim| *dim as usize).product::<usize>();
        let of = if dims[2] == 180 { "34,992,012" } else { "69,984,012" };
        assert_eq!(size.to_string(), of.replace(',', ""));
        for (len, found) in [(1012, "1,012"), (12, "12"), (size - 1, ""), (size + 1, "")] {
            let mut bytes = head.clone();
            bytes.resize(len, 1);
            let how = if len < size { "cut short" } else { "with more bytes than its header states" };
            refused(&bytes, "any.name", how, "fetch the file again");
            refused(&bytes, "any.name", found, "");
            refused(&bytes, "any.name", &format!(" of {of} bytes)"), "");
        }
        let mut swapped = dims.map(i32::to_be_bytes).concat();
        swapped.resize(5000, 1);
        refused(&swapped, "a", &format!("a MERL file in big-endian order, 5,000 of {of} bytes"), "Reverse");
    }
    refused(&[90, 0, 0, 0, 90], "a.binary", "a MERL file cut short (5 of 34,992,012 bytes)", "again");
    let small = tiny_merl();
    assert!(from_bytes(&small, Path::new("small.binary")).is_ok());
    for end in 13..small.len() {
        refused(&small[..end], "small.binary", "cut short", "again");
    }
    let (header, values) = small.split_at(12);
    let swap =
        |bytes: &[u8], word: usize| bytes.chunks(word).flat_map(|w| w.iter().rev().copied()).collect::<Vec<u8>>();
    let swapped = [swap(header, 4), swap(values, 8)].concat();
    refused(&swapped, "any", "a MERL file in big-endian order", "little-endian");
    let halves = [header, &vec![0x3d; values.len() / 2]].concat();
    refused(&halves, "any", "values of 32 bits (84 bytes instead of 156)", "f64");
    // Half of the values of a whole file are as many bytes as all of them in 32 bits.
    for value in [0.01_f64, 300.0] {
        let dims = [90_i32, 90, 180].map(i32::to_le_bytes).concat();
        let values = (0..90 * 90 * 90 * 3).map(|at| value * f64::from(1 + at % 7)).flat_map(f64::to_le_bytes);
        let half: Vec<u8> = dims.into_iter().chain(values).collect();
        refused(&half, "any", "cut short (17,496,012 of 34,992,012 bytes)", "again");
    }
}

#[test]
fn utia_files_of_another_size_are_described() {
    let values: Vec<u8> = (0..3000).flat_map(|at| (20.0 + f64::from(at % 7)).to_le_bytes()).collect();
    refused(&values[..23_999], "m001.bin", "possibly a UTIA file cut short (23,999 of 1,990,656 bytes)", "again");
    refused(&values.repeat(100), "m001.BIN", "with more bytes", "again");
    refused(&values, "m001.dat", "content of no known format, binary data that begin 00 00", "one of");
    refused(&[0xfe; 4000], "m001.bin", "content of no known format", "one of");
}

#[test]
fn other_files_are_described() {
    let page = format!("<!DOCTYPE html>\n<html><body><pre>{LIGHT_TOOLS}</pre></body></html>");
    refused(page.as_bytes(), "a.bsdf", "a web page (HTML)", "Raw");
    refused(b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 5\n", "a", "Git LFS", "git lfs pull");
    refused(b"", "a.bsdf", "an empty file", "fetch the file again");
    refused(b"\x89HDF\r\n\x1a\n\0\0", "a.axf", "an AxF file of X-Rite", "CSV, ASTM E1392");
    refused(
        b"OPTIS - something else v8.0\n0\nComment\n",
        "a.brdf",
        "another kind of Speos file, `OPTIS - something else v8.0`",
        ".brdf",
    );
    let binary = b"OPTIS - Anisotropic BSDF surface file v9.0\n1\x03\0\0\0";
    refused(binary, "a.anisotropicbsdf", "mode 1, the binary form", "save the file as text");
    refused(b"OPTIS - brdf surface file v8.0\r\n1\r\n\x07", "a.brdf", "mode 1, the binary form", "not public");
    refused(b"P2\n2 2\n255\n1 2\n3 4\n", "a.csv", "a picture (PGM)", "textures");
    refused(b"just words\n", "a.txt", "content of no known format, text that begins `just words`", "one of ");
}

#[test]
fn control_characters_of_files_are_escaped() {
    let harmless = |text: &str| !text.chars().any(char::is_control);
    let evil = "\u{1b}[31mred\u{7}\u{9b}1m\u{202e}";
    for name in ["a", "a\u{1b}[2J.ddr"] {
        for bytes in
            [evil.to_string(), format!("OPTIS - {evil} v1\n"), format!("<{evil}>"), format!("{{\"{evil}\": 1}}")]
        {
            let message = refusal(bytes.as_bytes(), name).to_string();
            assert!(harmless(&message), "{message:?}");
        }
    }
    let damaged = LIGHT_TOOLS.replace("DataEnd", &format!("{evil} 7\nTIS {evil}"));
    assert!(harmless(&refusal(damaged.as_bytes(), "a").to_string()));
    let files = [
        LIGHT_TOOLS.replace("# made by hand", &format!("# {evil}\nModel {evil}: {evil}")),
        examples::DDR.replace("Source Measured", &format!("Source {evil}\n{evil} {evil}")),
        examples::sheet("Columns", examples::NINE).replace("Visible", evil).replace("a &amp; b", "a&#27;[31m"),
        examples::SSDD.replace("thin film", evil),
        examples::PAB.replace("made here", evil),
        examples::TRACE_PRO.replace("made", evil),
    ];
    for text in files {
        let document = from_bytes(text.as_bytes(), Path::new("a")).unwrap_or_else(|error| panic!("{error}"));
        let facts = document.source.iter().flat_map(|(name, value)| [name.clone(), value.clone()]);
        let names = document.parts.iter().flat_map(|part| {
            let sections = part.data.representation().sections();
            let of_section = |s: &lobe_table::data::Section<'_>| [vec![s.name.clone()], s.channels.names()].concat();
            sections.iter().flat_map(of_section).chain([part.name.clone()]).collect::<Vec<_>>()
        });
        let all: Vec<String> = facts.chain(names).collect();
        assert!(
            all.iter().all(|text| harmless(text)) && all.iter().any(|text| text.contains("\\u{1b}[31m")),
            "{all:?}"
        );
    }
}
