//! Text files of pab's gonio-photometers (pgII) and of Radiance's tools for them: one incident direction per file.
//!
//! Lines that start with `#` are the head: `#intheta` and `#inphi`, or `#incident_angle` with both, are the direction
//! of the light; `#upphi` is the azimuth of the upward direction on the sample, which becomes 90 degrees here;
//! `#colorimetry: CIE-XYZ` means three values per line; and `#format: theta phi BSDF` gives the contents of the
//! following lines: two angles in degrees and `f` in 1/sr (`BSDF`, `BRDF`, `BTDF`), or `f` times the cosine (`DSF`).
//! Both directions point away from the surface, and polar angles beyond 90 degrees are behind it.
//!
//! A material is the set of such files in a folder.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use lobe_table::{Channels, Scatter, Side};

use crate::lines::{Line, lines, shown};
use crate::records::Records;
use crate::spec::FormatSpec;
use crate::{Document, FormatError, Part, Place};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "pab gonio-photometer",
    word: "pab",
    extensions: &["txt", "dat"],
    matches,
    read: Some(|bytes, path, _| read(bytes, path)),
    read_set: Some(read_set),
    writer: None,
};

/// Values of `DSF` this close to the horizon, as a cosine, do not determine `f`.
const GRAZING: f64 = 1e-3;

/// `true` for a text whose head has a line `#format: theta phi ...`.
pub fn matches(bytes: &[u8]) -> bool {
    const HEAD: usize = 1 << 16;
    let head = &bytes[..bytes.len().min(HEAD)];
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    let is_head = |line: &&[u8]| line.is_empty() || line.starts_with(b"#");
    let mut lines = head.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii).take_while(is_head);
    lines.any(|line| of_format(&String::from_utf8_lossy(line)).is_some())
}

/// The words after `#format: theta phi`.
fn of_format(line: &str) -> Option<String> {
    let mut words = line.strip_prefix('#')?.split_whitespace();
    let is = |word: Option<&str>, name: &str| word.is_some_and(|word| word.eq_ignore_ascii_case(name));
    let is_format = is(words.next(), "format:") && is(words.next(), "theta") && is(words.next(), "phi");
    is_format.then(|| words.collect::<Vec<_>>().join(" "))
}

/// The contents of the head of a file.
struct Head {
    /// Polar angle and azimuth of the light, in degrees.
    light: [f64; 2],
    /// The angle to add to azimuths, in degrees.
    turn: f64,
    /// Values are `f` times the cosine.
    is_dsf: bool,
    channels: Channels,
    /// The number of lines of values.
    count: Option<usize>,
    source: Vec<(String, String)>,
}

/// Reads one file. `file` is only its name in errors.
///
/// # Errors
/// See [`read_set`].
pub fn read(bytes: &[u8], file: &Path) -> Result<Document, FormatError> {
    read_set(&[(file.to_path_buf(), bytes.to_vec())])
}

/// Reads the files of one material, each with its name for errors.
///
/// # Errors
/// [`FormatError`] with the line: no incident direction, values that are neither BSDF nor DSF (such as detector
/// currents), lines with another number of values, fewer lines than the head states, files whose channels or
/// orientation differ from those of the first, or two files of the same light on the same side.
pub fn read_set(files: &[(PathBuf, Vec<u8>)]) -> Result<Document, FormatError> {
    let mut records: BTreeMap<(Side, bool), Records> = BTreeMap::new();
    let mut first: Option<Head> = None;
    // The direction of the light, in bits, and whether its light is transmitted.
    let mut measured: BTreeMap<([u64; 2], bool), &Path> = BTreeMap::new();
    for (file, bytes) in files {
        let text = String::from_utf8_lossy(bytes);
        let (head, passes) = samples(file, &text, &mut records)?;
        let light = head.light.map(|angle| (angle + 0.0).to_bits());
        for passes in passes {
            if let Some(other) = measured.insert((light, passes), file) {
                let [theta, phi] = head.light;
                let found = format!("light at {theta}, {phi} degrees, as in {}", other.display());
                let expected = "files of one sample, each direction of the light once";
                return Err(FormatError::new(file, Place::File, found, expected));
            }
        }
        let Some(first) = &mut first else {
            first = Some(head);
            continue;
        };
        let unlike = |found: &str, expected: &str| Err(FormatError::new(file, Place::File, found, expected));
        if head.channels != first.channels {
            return unlike("other channels than in the first file of the folder", "the same in all");
        }
        if (head.turn != 0.0) != (first.turn != 0.0) {
            return unlike("an upphi unlike that of the first file of the folder", "one in all of them, or in none");
        }
        first.source.retain(|fact| head.source.contains(fact));
    }
    let name = files.first().map_or(Path::new(""), |(file, _)| file);
    let Some(first) = first else {
        return Err(FormatError::new(name, Place::File, "no file", "at least one"));
    };
    let is_two_sided = records.keys().any(|(side, _)| *side == Side::Back);
    let mut parts = Vec::new();
    for ((side, passes), records) in records {
        let scatter = if passes { Scatter::Transmission } else { Scatter::Reflection };
        let data = records.scattered(name, scatter, first.channels.clone())?;
        parts.push(Part { name: String::new(), side: is_two_sided.then_some(side), data: data.into() });
    }
    if parts.is_empty() {
        return Err(FormatError::new(name, Place::File, "no values", "lines of theta, phi and a value"));
    }
    let mut document = Document::of_parts(parts);
    document.source.extend(first.source);
    Ok(document)
}

/// Reads the samples of a file into those of its sides. Also returns whether some are not, and are, transmitted light.
fn samples(
    file: &Path,
    text: &str,
    records: &mut BTreeMap<(Side, bool), Records>,
) -> Result<(Head, BTreeSet<bool>), FormatError> {
    let all: Vec<Line<'_>> = lines(file, text).collect();
    let end = all.iter().position(|line| !line.text.starts_with('#')).unwrap_or(all.len());
    let (head_lines, value_lines) = all.split_at(end);
    let head = head(file, head_lines)?;
    let channels = head.channels.count();
    let [theta_i, phi_i] = head.light;
    let (light, lit) = folded(theta_i);
    let phi_i = phi_i + head.turn;
    let mut passes = BTreeSet::new();
    for line in value_lines.iter().filter(|line| !line.text.starts_with('#')) {
        let numbers = line.numbers()?;
        let &[theta, phi, ref values @ ..] = numbers.as_slice() else {
            return Err(line.error(format!("{} numbers", numbers.len()), "theta, phi and a value"));
        };
        if values.len() != channels {
            let found = format!("{} values after theta and phi", values.len());
            return Err(line.error(found, format!("{channels}, as the head says")));
        }
        if !(-180.0..=180.0).contains(&theta) {
            return Err(line.error(format!("theta {theta}"), "-180 to 180 degrees"));
        }
        let (view, seen) = folded(theta);
        let cos = libm::cos(theta.to_radians()).abs();
        if head.is_dsf && cos < GRAZING {
            continue;
        }
        let scale = if head.is_dsf { 1.0 / cos } else { 1.0 };
        let angles = [light, phi_i, view, phi + head.turn].map(f64::to_radians);
        passes.insert(lit != seen);
        let of_sides = records.entry((lit, lit != seen)).or_default();
        of_sides.push(angles, values.iter().map(|value| value * scale));
    }
    let count = value_lines.iter().filter(|line| !line.text.starts_with('#')).count();
    if let Some(stated) = head.count.filter(|stated| *stated > count) {
        let found = format!("{count} lines of values; the head states {stated}");
        return Err(FormatError::new(file, Place::File, found, "a whole file"));
    }
    Ok((head, passes))
}

/// A polar angle from the normal of its side, in degrees, and the side. Negative angles are in the other half of the
/// plane.
fn folded(theta: f64) -> (f64, Side) {
    if theta.abs() <= 90.0 { (theta, Side::Front) } else { ((180.0 - theta.abs()).copysign(theta), Side::Back) }
}

fn head(file: &Path, lines: &[Line<'_>]) -> Result<Head, FormatError> {
    let mut head = Head {
        light: [f64::NAN; 2],
        turn: 0.0,
        is_dsf: false,
        channels: Channels::Mono,
        count: None,
        source: Vec::new(),
    };
    let mut has_format = false;
    for line in lines {
        if let Some(quantity) = of_format(line.text) {
            head.is_dsf = is_dsf(*line, &quantity)?;
            has_format = true;
            continue;
        }
        let text = line.text.trim_start_matches('#').trim();
        let (name, value) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let (name, value) = (name.trim_end_matches(':'), value.trim());
        // Some files state the direction twice.
        let mut light = |axis: usize, word: &str| -> Result<(), FormatError> {
            let (before, angle) = (head.light[axis], line.number(word)?);
            if !before.is_nan() && before != angle {
                let found = format!("light at {angle} degrees, after {before} in a line above");
                return Err(line.error(found, "one direction of the light"));
            }
            head.light[axis] = angle;
            Ok(())
        };
        match name.to_ascii_lowercase().as_str() {
            "incident_angle" => {
                let (theta, phi) = value.split_once(char::is_whitespace).unwrap_or((value, ""));
                light(0, theta)?;
                if !phi.trim().is_empty() {
                    light(1, phi.trim())?;
                }
            }
            "intheta" => light(0, value)?,
            "inphi" => light(1, value)?,
            "upphi" => head.turn = (90.0 - line.number(value)?).rem_euclid(360.0),
            "datapoints_in_file" => head.count = value.parse().ok(),
            "colorimetry" => head.channels = colours(*line, value)?,
            _ => head.source.push((name.into(), value.trim_matches('"').into())),
        }
    }
    if !has_format {
        return Err(FormatError::new(file, Place::File, "no line `#format: theta phi ...`", "one before the values"));
    }
    if head.light[1].is_nan() {
        head.light[1] = 0.0;
    }
    match head.light[0] {
        theta if theta.is_nan() => {
            let expected = "the direction of the light: `#incident_angle THETA PHI`, or `#intheta` and `#inphi`";
            Err(FormatError::new(file, Place::File, "no incident direction", expected))
        }
        theta if !(-180.0..=180.0).contains(&theta) => {
            let found = format!("light at a polar angle of {theta}");
            Err(FormatError::new(file, Place::File, found, "-180 to 180 degrees"))
        }
        _ => Ok(head),
    }
}

/// `true` if values are `f` times the cosine.
fn is_dsf(line: Line<'_>, quantity: &str) -> Result<bool, FormatError> {
    match quantity.to_ascii_uppercase().as_str() {
        "DSF" => Ok(true),
        "BSDF" | "BRDF" | "BTDF" => Ok(false),
        // Currents of the detector, counts, and the like.
        _ => Err(line.error(
            format!("values of {}", shown(quantity)),
            "BSDF, BRDF, BTDF or DSF: detector signals are not a BSDF until they are divided by the signal of the \
             light, so export normalised values",
        )),
    }
}

fn colours(line: Line<'_>, value: &str) -> Result<Channels, FormatError> {
    match value.to_ascii_uppercase().as_str() {
        "CIE-XYZ" => Ok(Channels::Xyz),
        "CIE-Y" => Ok(Channels::Mono),
        _ => Err(line.error(format!("colorimetry {}", shown(value)), "CIE-XYZ or CIE-Y")),
    }
}
