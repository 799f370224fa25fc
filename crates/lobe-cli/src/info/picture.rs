//! `lobe info` of an OpenEXR picture.

use std::io::Write;
use std::path::Path;

use lobe_files::printable;
use lobe_render::picture::{Inspected, Quantity, SpectralPicture, inspect, read_spectral};
use serde::Serialize;

use crate::failure::Failure;
use crate::message;

/// The first bytes of every OpenEXR file.
const SIGNATURE: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Whether a file is an OpenEXR picture.
pub fn is_picture(path: &Path) -> bool {
    lobe_files::begins_with(path, &SIGNATURE)
}

/// Everything that is printed, in both forms.
#[derive(Serialize)]
struct Info {
    file: String,
    format: &'static str,
    file_bytes: Option<u64>,
    columns: usize,
    rows: usize,
    /// The position of the upper left corner.
    origin: [i32; 2],
    quantity: &'static str,
    /// In nm; none for red, green and blue.
    wavelengths: Vec<f64>,
    /// S0 alone if light was not followed as polarised.
    stokes: Vec<String>,
    /// The mean of S0 of each channel.
    mean: Vec<f64>,
    /// `None` if light was not followed as polarised.
    polarisation: Option<Polarisation>,
    /// Values that are infinite or not numbers.
    not_finite: usize,
    /// For pictures of `lobe render`.
    rendering: Option<Rendering>,
    /// Channels that belong to no spectrum.
    other_channels: Vec<String>,
    attributes: Vec<(String, String)>,
}

/// The degree of linear polarisation, from 0 to 1.
#[derive(Serialize)]
struct Polarisation {
    /// Over all pixels that light reaches, each counted by its luminance.
    mean: f64,
    largest: f32,
}

#[derive(Serialize)]
struct Rendering {
    version: String,
    arithmetic: String,
    /// The first sample, and the one after the last.
    samples: [u32; 2],
    /// The samples of the whole picture.
    total: u32,
    /// Whether samples can be added.
    has_sums: bool,
}

/// Prints the contents of a picture.
pub fn run(file: &Path, json: bool) -> Result<(), Failure> {
    let picture = read_spectral(file)?;
    let info = Info::new(file, picture);
    let mut out = message::out(json);
    if json {
        serde_json::to_writer_pretty(&mut out, &info)?;
        writeln!(out)?;
    } else {
        info.print(&mut out)?;
    }
    Ok(out.flush()?)
}

/// The rows of a table about a picture.
pub fn rows(file: &Path, picture: &SpectralPicture) -> Vec<(String, String)> {
    let mut rows = Info::new(file, picture.clone()).rows();
    rows.extend(picture.attributes.iter().cloned());
    rows
}

/// A name for what was followed.
pub fn light(picture: &SpectralPicture) -> String {
    let channels = match &picture.channels {
        lobe::Channels::Spectral(nm) => match &nm[..] {
            [only] => format!("{only} nm"),
            [first, .., last] => format!("{} wavelengths, {first} to {last} nm", nm.len()),
            [] => String::new(),
        },
        _ => "red, green and blue".into(),
    };
    match picture.stokes.len() {
        1 => channels,
        count => format!("{channels}, Stokes components S0 to S{}", count - 1),
    }
}

impl Info {
    fn new(file: &Path, picture: SpectralPicture) -> Self {
        let metadata = std::fs::metadata(file).ok().filter(std::fs::Metadata::is_file);
        let rendering = inspect(file).ok().map(|Inspected { meta, has_sums, .. }| Rendering {
            version: meta.version,
            arithmetic: meta.arithmetic,
            samples: [meta.samples.start, meta.samples.end],
            total: meta.total,
            has_sums,
        });
        let wavelengths = match &picture.channels {
            lobe::Channels::Spectral(nm) => nm.clone(),
            _ => Vec::new(),
        };
        let is_spectral = !wavelengths.is_empty();
        Info {
            file: file.display().to_string(),
            format: if is_spectral { "spectral OpenEXR picture" } else { "OpenEXR picture" },
            file_bytes: metadata.map(|metadata| metadata.len()),
            columns: picture.size[0],
            rows: picture.size[1],
            origin: picture.origin,
            quantity: match picture.quantity {
                Quantity::Radiance => "radiance",
                Quantity::Shares => "shares of light",
            },
            wavelengths,
            stokes: (0..picture.stokes.len()).map(|k| format!("S{k}")).collect(),
            mean: picture.mean(),
            polarisation: Polarisation::of(&picture),
            not_finite: picture.not_finite(),
            rendering,
            other_channels: picture.others.clone(),
            attributes: picture.attributes,
        }
    }

    fn print(&self, out: &mut impl Write) -> std::io::Result<()> {
        writeln!(out, "{}", printable(&self.file))?;
        for (name, value) in self.rows() {
            writeln!(out, "{name:<9} {}", printable(&value))?;
        }
        for (name, value) in &self.attributes {
            writeln!(out, "  {}: {}", printable(name), printable(value))?;
        }
        Ok(())
    }

    fn rows(&self) -> Vec<(String, String)> {
        let mut rows: Vec<(&str, String)> = vec![("format", self.format.into())];
        if let Some(bytes) = self.file_bytes {
            rows.push(("file", format!("{bytes} bytes")));
        }
        let at = if self.origin == [0, 0] {
            String::new()
        } else {
            format!(", from column {} and row {}", self.origin[0], self.origin[1])
        };
        rows.push(("picture", format!("{} x {} pixels{at}", self.columns, self.rows)));
        let light = match &self.wavelengths[..] {
            [] => "red, green and blue".into(),
            [only] => format!("{only} nm"),
            [first, .., last] => format!("{} wavelengths from {first} to {last} nm", self.wavelengths.len()),
        };
        rows.push(("values", format!("{} of {light}", self.quantity)));
        rows.push(("Stokes", self.stokes.join(" ") + if self.stokes.len() == 1 { " (not polarised)" } else { "" }));
        let names: Vec<String> = match self.wavelengths.is_empty() {
            true => ["R", "G", "B"].map(String::from).into(),
            false => self.wavelengths.iter().map(|nm| format!("{nm}nm")).collect(),
        };
        let means: Vec<String> = names.iter().zip(&self.mean).map(|(name, mean)| format!("{name} {mean:.4}")).collect();
        rows.push(("mean", means.join("  ")));
        if let Some(Polarisation { mean, largest }) = self.polarisation {
            rows.push(("polarised", format!("{:.1} % in the mean, up to {:.1} %", 100.0 * mean, 100.0 * largest)));
        }
        if self.not_finite > 0 {
            rows.push(("doubtful", format!("{} values are infinite or not numbers", self.not_finite)));
        }
        if let Some(Rendering { version, arithmetic, samples, total, has_sums }) = &self.rendering {
            let sums = if *has_sums { ", with sums that can be continued" } else { "" };
            rows.push(("made by", format!("lobe {version}, {arithmetic} arithmetic")));
            rows.push(("samples", format!("{} to {} of {total}{sums}", samples[0], samples[1])));
        }
        if !self.other_channels.is_empty() {
            rows.push(("channels", self.other_channels.join(" ")));
        }
        rows.into_iter().map(|(name, value)| (name.into(), value)).collect()
    }
}

impl Polarisation {
    fn of(picture: &SpectralPicture) -> Option<Self> {
        let of_pixels = picture.linear_polarisation()?;
        let (mut polarised, mut all, mut largest) = (0.0, 0.0, 0.0_f32);
        for (pixel, [degree, _]) in of_pixels.into_iter().enumerate() {
            let light = f64::from(picture.luminance(0, pixel));
            if light > 0.0 && light.is_finite() {
                (polarised, all) = (polarised + light * f64::from(degree), all + light);
                largest = largest.max(degree);
            }
        }
        Some(Polarisation { mean: if all > 0.0 { polarised / all } else { 0.0 }, largest })
    }
}
