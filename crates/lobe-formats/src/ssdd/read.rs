//! Reads SSDD.

use std::f64::consts::TAU;
use std::path::Path;

use lobe_table::{Channels, Data, Scatter, mirror, specular, spherical};

use crate::facts::Facts;
use crate::lines::shown;
use crate::{FormatError, Part, Place};

/// `true` if the lines at the start have `VERSION` and `DATA_TYPE`.
pub fn matches(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(1 << 16)]);
    let has = |key: &str| head.lines().any(|line| line.split_whitespace().next() == Some(key));
    has("VERSION") && has("DATA_TYPE")
}

/// Reads all blocks. `file` is only its name in errors.
///
/// # Errors
/// [`FormatError`] with the line: missing or unknown keys, half-difference and distorted coordinates, which have no
/// representation here, two blocks of the same type, values that are cut off or not finite numbers.
pub fn read(bytes: &[u8], file: &Path) -> Result<Vec<Part>, FormatError> {
    let mut source = Source { file, bytes, at: if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 }, line: 0 };
    let (mut header, mut has_version) = (Header::default(), false);
    let (mut blocks, mut types) = (Vec::new(), Vec::new());
    while let Some(line) = source.next_line() {
        let (key, value) = line.split_once(char::is_whitespace).unwrap_or((&line, ""));
        let value = value.trim();
        match key {
            "VERSION" => has_version = true,
            _ if !has_version => return Err(source.error(shown(key), "VERSION")),
            "DATA" => {
                let is_binary = match value {
                    "ascii" => false,
                    "binary" => true,
                    _ => return Err(source.error(format!("DATA {}", shown(value)), "ascii or binary")),
                };
                if types.contains(&header.data_type) {
                    return Err(source.error(format!("a second {}", header.data_type), "each DATA_TYPE once"));
                }
                types.push(header.data_type.clone());
                blocks.push(std::mem::take(&mut header).block(&mut source, is_binary)?);
            }
            _ => header.set(&source, key, value)?,
        }
    }
    if blocks.is_empty() || !header.data_type.is_empty() {
        return Err(source.error("the end of the file", "DATA and values"));
    }
    Ok(blocks)
}

/// The comments, and the lines with keys of people and programs, above the first values.
pub(super) fn facts(bytes: &[u8]) -> Facts {
    const READ: [&str; 7] =
        ["VERSION", "DATA_TYPE", "COLOR_MODEL", "WAVELENGTH_LIST", "PARAM_TYPE", "REDUCTION_TYPE", "NAME"];
    let lines = bytes.split(|&byte| byte == b'\n').map(|line| String::from_utf8_lossy(line.trim_ascii()));
    let mut facts = Facts::new();
    for line in lines.take_while(|line| line.split_whitespace().next() != Some("DATA")) {
        let (key, value) = line.split_once(char::is_whitespace).unwrap_or((&line, ""));
        match line.strip_prefix('#').map(str::trim) {
            Some("") => {}
            Some(comment) => facts.push(("comment".into(), comment.into())),
            None if READ.contains(&key) || key.starts_with("PARAM") || value.trim().is_empty() => {}
            None => facts.push((key.into(), value.trim().into())),
        }
    }
    facts
}

struct Source<'a> {
    file: &'a Path,
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl Source<'_> {
    /// The next line that has more than a comment.
    fn next_line(&mut self) -> Option<String> {
        while self.at < self.bytes.len() {
            let rest = &self.bytes[self.at..];
            let end = rest.iter().position(|&byte| byte == b'\n').map_or(rest.len(), |end| end + 1);
            self.at += end;
            self.line += 1;
            let line = String::from_utf8_lossy(rest[..end].trim_ascii());
            if !line.is_empty() && !line.starts_with('#') {
                return Some(line.into_owned());
            }
        }
        None
    }

    fn error(&self, found: impl Into<String>, expected: impl Into<String>) -> FormatError {
        FormatError::new(self.file, Place::Line(self.line.max(1)), found, expected)
    }

    /// `count` values: one colour per line, or binary `f32`.
    fn values(&mut self, count: Option<usize>, channels: usize, is_binary: bool) -> Result<Vec<f32>, FormatError> {
        let rest = self.bytes.len() - self.at;
        // A value takes four bytes, or a digit and a separator.
        let most = if is_binary { rest / 4 } else { rest.div_ceil(2) };
        let Some(count) = count.filter(|count| *count <= most) else {
            let found = count.map_or("more values than can be counted".into(), |count| format!("{count} values"));
            return Err(self.error(found, format!("at most {most} in the rest of the file")));
        };
        if is_binary {
            let bytes = &self.bytes[self.at..self.at + 4 * count];
            self.at += 4 * count;
            return Ok(bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect());
        }
        let mut values = Vec::with_capacity(count);
        while values.len() < count {
            let line = self.next_line().ok_or_else(|| {
                self.error(format!("the end of the file after {} values", values.len()), format!("{count} values"))
            })?;
            let before = values.len();
            for word in line.split_whitespace() {
                let value = word.parse().ok().filter(|value: &f32| value.is_finite());
                values.push(value.ok_or_else(|| self.error(shown(word), "a finite number"))?);
            }
            if values.len() - before != channels {
                return Err(self.error(format!("{} values", values.len() - before), format!("a colour of {channels}")));
            }
        }
        Ok(values)
    }
}

/// The keys of a block.
#[derive(Default)]
struct Header {
    data_type: String,
    color_model: String,
    wavelengths: Vec<f64>,
    param_type: String,
    is_symmetric: bool,
    params: [Option<Vec<f64>>; 5],
    name: String,
}

impl Header {
    fn set(&mut self, source: &Source<'_>, key: &str, value: &str) -> Result<(), FormatError> {
        let one_of = |known: &[&str]| match known.contains(&value) {
            true => Ok(value.to_owned()),
            false => Err(source.error(format!("{key} {}", shown(value)), known.join(", "))),
        };
        let numbers = || {
            let number = |word: &str| word.parse().ok().filter(|number: &f64| number.is_finite());
            let numbers = value.split_whitespace().map(|word| number(word).ok_or(word)).collect::<Result<Vec<_>, _>>();
            numbers.map_err(|word| source.error(shown(word), format!("finite numbers for {key}")))
        };
        match key {
            "DATA_TYPE" => {
                self.data_type = one_of(&["brdf", "btdf", "specular_reflectance", "specular_transmittance"])?;
            }
            "COLOR_MODEL" => self.color_model = one_of(&["monochrome", "rgb", "xyz", "spectrum"])?,
            "WAVELENGTH_LIST" => self.wavelengths = numbers()?,
            "PARAM_TYPE" => self.param_type = one_of(&["specular_coordinate_system", "spherical_coordinate_system"])?,
            "REDUCTION_TYPE" => {
                for word in value.split_whitespace() {
                    match word {
                        "bilateral_symmetry" => self.is_symmetric = true,
                        // It only reduces half-difference coordinates, which are refused.
                        _ => return Err(source.error(format!("REDUCTION_TYPE {}", shown(word)), "bilateral_symmetry")),
                    }
                }
            }
            "NAME" => self.name = value.into(),
            _ => {
                let index = key.strip_prefix("PARAM").and_then(|rest| rest.strip_suffix("_LIST"));
                // There are many keys of people and programs, and none of them changes a value.
                if let Some(param) = index.and_then(|i| i.parse::<usize>().ok()).and_then(|i| self.params.get_mut(i)) {
                    let unit = f64::to_radians;
                    *param = Some(numbers()?.into_iter().map(unit).collect());
                }
            }
        }
        Ok(())
    }

    fn block(self, source: &mut Source<'_>, is_binary: bool) -> Result<Part, FormatError> {
        let missing = |key: &str| source.error("DATA", format!("{key} before it"));
        if self.data_type.is_empty() {
            return Err(missing("DATA_TYPE"));
        }
        let channels = match self.color_model.as_str() {
            "monochrome" => Channels::Mono,
            "rgb" => Channels::Rgb,
            "xyz" => Channels::Xyz,
            "spectrum" if !self.wavelengths.is_empty() => Channels::Spectral(self.wavelengths),
            "spectrum" => return Err(missing("WAVELENGTH_LIST")),
            _ => return Err(missing("COLOR_MODEL")),
        };
        let [p0, p1, p2, p3, offsets] = self.params;
        let is_delta = self.data_type.starts_with("specular_");
        let p0 = p0.ok_or_else(|| missing("PARAM0_LIST"))?;
        let p1 = p1.unwrap_or(vec![0.0]);
        let (p2, p3) = match is_delta {
            true => (vec![0.0], vec![0.0]),
            false => (p2.ok_or_else(|| missing("PARAM2_LIST"))?, p3.ok_or_else(|| missing("PARAM3_LIST"))?),
        };
        if !is_delta && self.param_type.is_empty() {
            return Err(missing("PARAM_TYPE"));
        }
        let sizes = [p0.len(), p1.len(), p2.len(), p3.len()];
        let count = sizes.iter().try_fold(channels.count(), |count, &size| count.checked_mul(size));
        let values = source.values(count, channels.count(), is_binary)?;
        let (p3, columns) = if self.is_symmetric && !is_delta { unfolded(p3) } else { (p3, (0..sizes[3]).collect()) };
        let values = reordered(&values, sizes, &columns, channels.count());
        let refused = |error: String| source.error(error, "angles and values that make a table");
        let is_reflection = matches!(self.data_type.as_str(), "brdf" | "specular_reflectance");
        let scatter = if is_reflection { Scatter::Reflection } else { Scatter::Transmission };
        let data = if is_delta {
            let mirror = mirror::Data::new(scatter, [p0, p1], channels, values);
            Data::Mirror(mirror.ok_or_else(|| refused("angles that do not ascend strictly".into()))?)
        } else if self.param_type == "spherical_coordinate_system" {
            let grid = spherical::Data::new(scatter, [p0, p1, p2, p3], channels, values);
            Data::Spherical(grid.map_err(|error| refused(error.to_string()))?)
        } else {
            let samples = specular::Data::new(scatter, [p0, p1, p2, p3], channels, values);
            let samples = samples.and_then(|samples| match offsets {
                Some(offsets) => samples.with_refraction(offsets),
                None => Ok(samples),
            });
            Data::Specular(samples.map_err(|error| refused(error.to_string()))?)
        };
        Ok(Part::new(self.name, data))
    }
}

/// Azimuths of half a turn and their mirror images, each with the position of its values.
fn unfolded(half: Vec<f64>) -> (Vec<f64>, Vec<usize>) {
    const SAME: f64 = 1e-9;
    let mut all: Vec<(f64, usize)> = half.iter().copied().zip(0..).collect();
    all.extend(half.iter().enumerate().rev().map(|(index, phi)| (TAU - phi, index)));
    all.dedup_by(|b, a| b.0 - a.0 < SAME);
    all.into_iter().unzip()
}

/// Converts the file's order, with the first parameter fastest, to `[p0][p1][p2][p3][channel]`, with the requested
/// columns of p3.
fn reordered(values: &[f32], [n0, n1, n2, _]: [usize; 4], columns: &[usize], channels: usize) -> Vec<f32> {
    let mut out = Vec::with_capacity(n0 * n1 * n2 * columns.len() * channels);
    for p0 in 0..n0 {
        for p1 in 0..n1 {
            for p2 in 0..n2 {
                for &p3 in columns {
                    let colour = p0 + n0 * (p1 + n1 * (p2 + n2 * p3));
                    out.extend_from_slice(&values[colour * channels..][..channels]);
                }
            }
        }
    }
    out
}
