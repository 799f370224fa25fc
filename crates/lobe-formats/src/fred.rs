//! Tables of scattered light from FRED, and from RPC Photonics (now VIAVI) for engineered diffusers.
//!
//! Both have lines of two angles, the polar angle and azimuth in which light *travels* toward the surface, each
//! followed by lines of polar angle, azimuth and `f` in 1/sr. So the mirrored and the straight-through ray have the
//! azimuth of the incident one, and the direction toward the light has the opposite azimuth. A FRED table starts with
//! `type bsdf_data` and a `format` line; an RPC file starts with comments (`!!`) and holds one incident direction of a
//! transmitting sheet, so that a material is a set of files.

mod write;

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use lobe_table::{Channels, Scatter, scattered, specular};

use crate::facts::{Facts, comments, named};
use crate::lines::{Line, lines, shown};
use crate::listed::is_listed;
use crate::records::Records;
use crate::spec::{FormatSpec, Writer, reflection};
use crate::{Document, FormatError, Place};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "FRED",
    word: "fred",
    extensions: &["txt"],
    matches,
    read: Some(|bytes, path, _| Ok(Document::new(read(bytes, path)?).with_facts(facts(bytes)))),
    read_set: None,
    writer: Some(Writer {
        extensions: &[],
        holds_channels: |channels| matches!(channels, Channels::Mono),
        channels: "one channel",
        holds: is_listed,
        holds_sheets: false,
        scatter: reflection,
        resampled_as: Ok(specular::KIND),
        write: write::write,
    }),
};

/// This format in the registry.
pub(crate) static RPC: FormatSpec = FormatSpec {
    name: "RPC Photonics",
    word: "rpc",
    extensions: &["txt"],
    matches: matches_rpc,
    read: Some(|bytes, path, _| Ok(Document::new(read_rpc(bytes, path)?).with_facts(rpc_facts(bytes)))),
    read_set: Some(|files| {
        let facts = files.iter().flat_map(|(_, bytes)| rpc_facts(bytes)).collect();
        Ok(Document::new(read_rpc_set(files)?).with_facts(facts))
    }),
    writer: None,
};

/// `true` for a FRED table.
pub fn matches(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(256)]);
    let first = head.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
    first.split_whitespace().map(str::to_ascii_lowercase).eq(["type", "bsdf_data"])
}

/// `true` for an RPC file.
pub fn matches_rpc(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
    head.trim_start().starts_with("!!") && head.lines().any(|line| line.trim() == "!!BSDF Data")
}

/// The statement of values in a table.
fn facts(bytes: &[u8]) -> Facts {
    let mut facts = named(bytes, |key| matches!(key, "type" | "format").then(|| key.into()));
    facts.retain(|(key, _)| key == "format");
    facts
}

/// The comments of an RPC file.
fn rpc_facts(bytes: &[u8]) -> Facts {
    comments(bytes, "!!", |text| text == "BSDF Data")
}

/// The statement of angles and values in a table.
struct Units {
    to_radians: f64,
    scale: f64,
}

/// Reads a FRED table as reflection, which the format does not distinguish from transmission; see [`read_as`].
///
/// # Errors
/// See [`read_as`].
pub fn read(bytes: &[u8], file: &Path) -> Result<scattered::Data, FormatError> {
    read_as(bytes, file, Scatter::Reflection)
}

/// Reads a FRED table. `file` is only its name in errors.
///
/// # Errors
/// [`FormatError`] with the line: a format other than values at angles in degrees or radians, lines that are neither
/// two angles nor three numbers, or a value before the first incident direction.
pub fn read_as(bytes: &[u8], file: &Path, scatter: Scatter) -> Result<scattered::Data, FormatError> {
    let text = String::from_utf8_lossy(bytes);
    let mut lines = lines(file, &text);
    let mut next = |expected: &str| {
        lines.next().ok_or_else(|| FormatError::new(file, Place::File, "the end of the file", expected))
    };
    let first = next("`type bsdf_data`")?;
    if !first.words().map(str::to_ascii_lowercase).eq(["type", "bsdf_data"]) {
        return Err(first.error(shown(first.text), "`type bsdf_data`"));
    }
    let units = units(next("a `format` line")?)?;
    let mut records = Records::default();
    blocks(lines, &units, &mut records)?;
    records.scattered(file, scatter, Channels::Mono)
}

fn units(line: Line<'_>) -> Result<Units, FormatError> {
    let mut words = line.words();
    if words.next().is_none_or(|word| !word.eq_ignore_ascii_case("format")) {
        return Err(line.error(shown(line.text), "a `format` line"));
    }
    let mut units = Units { to_radians: PI / 180.0, scale: 1.0 };
    for word in words {
        match word.to_ascii_lowercase().split_once('=') {
            Some(("angles", "deg")) => units.to_radians = PI / 180.0,
            Some(("angles", "rad")) => units.to_radians = 1.0,
            Some(("bsdf", "value")) => {}
            Some(("scale", scale)) => units.scale = line.number(scale)?,
            _ => return Err(line.error(shown(word), "angles=deg, angles=rad, bsdf=value or scale=NUMBER")),
        }
    }
    Ok(units)
}

/// Reads one RPC file. `file` is only its name in errors.
///
/// # Errors
/// See [`read_rpc_set`].
pub fn read_rpc(bytes: &[u8], file: &Path) -> Result<scattered::Data, FormatError> {
    read_rpc_set(&[(file.to_path_buf(), bytes)])
}

/// Reads the files of one material, each with its name for errors.
///
/// # Errors
/// [`FormatError`] with the line, as in [`read_as`], and if two files have the same incident direction.
pub fn read_rpc_set<B: AsRef<[u8]>>(files: &[(PathBuf, B)]) -> Result<scattered::Data, FormatError> {
    let units = Units { to_radians: PI / 180.0, scale: 1.0 };
    let mut records = Records::default();
    let mut measured: BTreeMap<[u64; 2], &Path> = BTreeMap::new();
    for (file, bytes) in files {
        let (text, before) = (String::from_utf8_lossy(bytes.as_ref()), records.angles.len());
        blocks(lines(file, &text).filter(|line| !line.text.starts_with("!!")), &units, &mut records)?;
        for [theta, phi, ..] in &records.angles[before..] {
            let light = [*theta, *phi].map(|angle| (angle + 0.0).to_bits());
            let other = *measured.entry(light).or_insert(file);
            if other != file.as_path() {
                let found = format!("light at {} degrees, as in {}", theta.to_degrees(), other.display());
                let expected = "files of one sample, each incident direction once";
                return Err(FormatError::new(file, Place::File, found, expected));
            }
        }
    }
    let name = files.first().map_or(Path::new(""), |(file, _)| file);
    records.scattered(name, Scatter::Transmission, Channels::Mono)
}

/// Reads all RPC files of a folder as one material; other files in it are ignored.
///
/// # Errors
/// [`FormatError`] if the folder or a file cannot be read or none is an RPC file, and as in [`read_rpc_set`].
pub fn read_rpc_folder(folder: &Path) -> Result<scattered::Data, FormatError> {
    read_rpc_set(&folder_files(folder)?)
}

/// The RPC files of a folder, by name.
fn folder_files(folder: &Path) -> Result<Vec<(PathBuf, Vec<u8>)>, FormatError> {
    let paths = lobe_files::files_of(folder)
        .map_err(|error| FormatError::new(folder, Place::File, error.to_string(), "files that can be read"))?;
    let mut files = Vec::new();
    for path in paths {
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("txt")) {
            let bytes = lobe_files::read(&path)?;
            if matches_rpc(&bytes) {
                files.push((path, bytes));
            }
        }
    }
    if files.is_empty() {
        return Err(FormatError::new(
            folder,
            Place::File,
            "no such file",
            "files that start with `!!` and `!!BSDF Data`",
        ));
    }
    files.sort();
    Ok(files)
}

fn blocks<'a>(lines: impl Iterator<Item = Line<'a>>, units: &Units, records: &mut Records) -> Result<(), FormatError> {
    let mut incident: Option<[f64; 2]> = None;
    for line in lines {
        match (line.numbers()?.as_slice(), incident) {
            (&[theta, phi], _) => incident = Some([theta * units.to_radians, phi * units.to_radians + PI]),
            (&[theta, phi, value], Some([theta_i, phi_i])) => {
                let angles = [theta_i, phi_i, theta * units.to_radians, phi * units.to_radians];
                records.push_line(line.number, angles, [value * units.scale]);
            }
            (&[_, _, _], None) => return Err(line.error("a value", "the two angles of an incident direction first")),
            (numbers, _) => {
                let found = format!("{} numbers", numbers.len());
                return Err(line.error(found, "2 angles, or 2 angles and a value"));
            }
        }
    }
    Ok(())
}
