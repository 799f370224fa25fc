//! Writes `.brdf` and `.anisotropicbsdf` files as text.

use std::fmt::Write as _;
use std::path::Path;

use lobe_files::write_whole;
use lobe_table::{Channels, Data, Scatter};

use super::incident::{Incident, of_scattered, of_spherical};
use super::table::Table;
use crate::spec::{resampled, unfit};
use crate::text::nine_digits;
use crate::{Document, FormatError, Place, Sides};

/// The tables of a kind of scatter.
struct Side {
    scatter: Scatter,
    tables: Vec<Incident>,
    is_isotropic: bool,
}

/// The two kinds of files.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Brdf,
    Anisotropic,
}

/// The data of a document with at most one measurement of each kind of scatter, without a particular side.
fn parts(document: &Document) -> Option<Sides<&Data>> {
    let mut sides = Sides { reflection: None, transmission: None };
    for part in &document.parts {
        let side = match part.data.representation().scatter() {
            Scatter::Reflection => &mut sides.reflection,
            Scatter::Transmission => &mut sides.transmission,
        };
        if part.side.is_some() || side.replace(&part.data).is_some() {
            return None;
        }
    }
    Some(sides)
}

/// The tables of a document: grids, and samples that lie on grids.
fn sides(document: &Document) -> Option<Vec<Side>> {
    let Sides { reflection, transmission } = parts(document)?;
    let side = |(scatter, data): (Scatter, &Data)| {
        let tables = match data {
            Data::Spherical(grid) => of_spherical(grid),
            Data::Scattered(samples) => of_scattered(samples)?,
            _ => return None,
        };
        Some(Side { scatter, tables, is_isotropic: data.representation().is_isotropic() })
    };
    let parts = [(Scatter::Reflection, reflection), (Scatter::Transmission, transmission)];
    parts.into_iter().filter_map(|(scatter, data)| Some(side((scatter, data?)))).collect()
}

/// `true` if a document consists of tables of polar angle by azimuth.
pub(super) fn holds(document: &Document) -> bool {
    sides(document).is_some_and(|sides| !sides.is_empty())
}

/// Writes `path` completely or not at all, in the format of its extension, or as `.brdf` if the material is isotropic.
/// Values are read back bit for bit, angles to a billionth of a degree.
///
/// # Errors
/// [`FormatError`] if the file cannot be written; if the document does not consist of tables, has no wavelengths, or is
/// anisotropic while the file is a `.brdf`; if a table that is not black has no positive integral; and if the spectrum
/// of an `.anisotropicbsdf` would not be the same for all directions.
pub(super) fn write(document: &Document, path: &Path) -> Result<(), FormatError> {
    let refuse = |found: String, expected: &str| Err(FormatError::new(path, Place::File, found, expected));
    let Some(sides) = sides(document).filter(|sides| !sides.is_empty()) else {
        let expected = "tables of polar angle by azimuth for each incident direction: grids of spherical coordinates";
        return Err(unfit(document, path, expected));
    };
    let channels = document.parts[0].data.representation().channels();
    let Channels::Spectral(wavelengths) = &channels else {
        return refuse(format!("the channels {}", channels.names().join(" ")), "wavelengths in this format");
    };
    if document.parts.iter().any(|part| part.data.representation().channels() != channels) {
        return refuse("reflection and transmission at different wavelengths".into(), "the same ones in this format");
    }
    let is_isotropic = sides.iter().all(|side| side.is_isotropic);
    let kind = match path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase()) {
        Some(extension) if extension == "brdf" => Kind::Brdf,
        Some(extension) if extension == "anisotropicbsdf" => Kind::Anisotropic,
        _ if is_isotropic => Kind::Brdf,
        _ => Kind::Anisotropic,
    };
    if kind == Kind::Brdf && !is_isotropic {
        return refuse(
            "an anisotropic material".into(),
            "an isotropic one in .brdf, or the extension .anisotropicbsdf",
        );
    }
    let mut out = String::new();
    head(&mut out, document, kind);
    let flags = [Scatter::Reflection, Scatter::Transmission]
        .map(|scatter| u8::from(sides.iter().any(|side| side.scatter == scatter)));
    let _ = writeln!(out, "{}\t{}", flags[0], flags[1]);
    out.push_str("1\n");
    let written = match kind {
        Kind::Brdf => brdf(&mut out, &sides, wavelengths),
        Kind::Anisotropic => anisotropic(&mut out, &sides, wavelengths),
    };
    written.or_else(|Refusal { found, expected }| refuse(found, expected))?;
    write_whole(path, out.as_bytes())
}

/// The reason why tables do not fit into a file.
struct Refusal {
    found: String,
    expected: &'static str,
}

fn head(out: &mut String, document: &Document, kind: Kind) {
    let name = match kind {
        Kind::Brdf => "brdf",
        Kind::Anisotropic => "Anisotropic BSDF",
    };
    let comment = resampled(document).unwrap_or_else(|| "written by lobe".into());
    let description = document.source.iter().find(|(name, _)| name == "description" || name == "name");
    let description = description.map_or("", |(_, value)| value.lines().next().unwrap_or_default().trim());
    let _ = writeln!(out, "OPTIS - {name} surface file v8.0\n0\n{comment}");
    let _ = writeln!(out, "{}\n{description}", description.chars().count());
    if kind == Kind::Anisotropic {
        out.push_str("1\t0\t0\n");
    }
}

fn row(out: &mut String, numbers: impl Iterator<Item = f64>) {
    let words: Vec<String> = numbers.map(|number| number.to_string()).collect();
    let _ = writeln!(out, "{}", words.join("\t"));
}

/// One table per incident angle and wavelength, with its albedo.
fn brdf(out: &mut String, sides: &[Side], wavelengths: &[f64]) -> Result<(), Refusal> {
    let incidences: Vec<f64> = sides[0].tables.iter().map(|table| table.theta).collect();
    let is_alike = |side: &Side| side.tables.iter().map(|table| table.theta).eq(incidences.iter().copied());
    if !sides.iter().all(is_alike) {
        let found = "reflection and transmission at different incident angles".into();
        return Err(Refusal { found, expected: "the same in .brdf" });
    }
    let _ = writeln!(out, "{}\t{}", incidences.len(), wavelengths.len());
    row(out, incidences.into_iter());
    row(out, wavelengths.iter().copied());
    for side in sides {
        for table in &side.tables {
            for channel in 0..wavelengths.len() {
                let printed = Printed::new(side.scatter, table, wavelengths.len(), channel);
                let integral = printed.integral()?;
                let _ = writeln!(out, "{}", 100.0 * integral);
                printed.push(out);
            }
        }
    }
    Ok(())
}

/// Tables by rotation of the sample and incident angle, and a spectrum that holds for all of them.
fn anisotropic(out: &mut String, sides: &[Side], wavelengths: &[f64]) -> Result<(), Refusal> {
    let by_rotation: Vec<Vec<(f64, Vec<&Incident>)>> = sides.iter().map(rotations).collect();
    for rotations in &by_rotation {
        let _ = writeln!(out, "{}", rotations.len());
        row(out, rotations.iter().map(|(rotation, _)| *rotation));
        for (_, tables) in rotations {
            let _ = writeln!(out, "{}", tables.len());
            row(out, tables.iter().map(|table| table.theta));
        }
    }
    let mut shapes = Vec::new();
    for (side, rotations) in sides.iter().zip(&by_rotation) {
        let shape = Shape::of(side, wavelengths.len())?;
        // The spectrum is stated for the first table with light: of equally near rotations, readers take the first.
        let (rotation, tables) = &rotations[0];
        let mut printed = tables.iter().map(|table| {
            let printed = Printed::new(side.scatter, table, wavelengths.len(), shape.channel);
            printed.integral().map(|integral| (table.theta, integral))
        });
        let lit = loop {
            match printed.next().transpose()? {
                Some((_, 0.0)) => {}
                lit => break lit,
            }
        };
        let Some((theta, integral)) = lit else {
            let found = "no light at the first rotation".into();
            return Err(Refusal { found, expected: "a table with light, to which the spectrum of the file belongs" });
        };
        let _ = writeln!(out, "{theta}\t{rotation}\n");
        let _ = writeln!(out, "{}", wavelengths.len());
        for (nm, share) in wavelengths.iter().zip(&shape.shares) {
            let _ = writeln!(out, "{nm}\t{}", 100.0 * integral * share);
        }
        shapes.push(shape);
    }
    for ((side, rotations), shape) in sides.iter().zip(&by_rotation).zip(&shapes) {
        for table in rotations.iter().flat_map(|(_, tables)| tables) {
            Printed::new(side.scatter, table, wavelengths.len(), shape.channel).push(out);
        }
    }
    Ok(())
}

/// The tables by rotation of the sample, ascending; a whole turn ends with the first rotation again.
fn rotations(side: &Side) -> Vec<(f64, Vec<&Incident>)> {
    const SAME: f64 = 1e-6;
    let rotation = |table: &Incident| {
        let turned = (table.phi + 180.0).rem_euclid(360.0);
        if side.is_isotropic || turned > 360.0 - SAME { 0.0 } else { turned }
    };
    let mut sorted: Vec<(f64, &Incident)> = side.tables.iter().map(|table| (rotation(table), table)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.theta.total_cmp(&b.1.theta)));
    let mut rotations: Vec<(f64, Vec<&Incident>)> = Vec::new();
    for (rotation, table) in sorted {
        match rotations.last_mut() {
            Some((last, tables)) if rotation - *last < SAME => {
                // A knot at the end of a whole turn repeats that at its beginning.
                if tables.last().is_none_or(|last| table.theta - last.theta > SAME) {
                    tables.push(table);
                }
            }
            _ => rotations.push((rotation, vec![table])),
        }
    }
    if let Some((0.0, first)) = rotations.first().cloned() {
        rotations.push((360.0, first));
    }
    rotations
}

/// The one spectrum of a side.
struct Shape {
    /// The channel whose values are listed.
    channel: usize,
    /// The values of each channel relative to that one.
    shares: Vec<f64>,
}

impl Shape {
    /// The channels as multiples of the brightest.
    fn of(side: &Side, count: usize) -> Result<Self, Refusal> {
        const ROUNDING: f64 = 1e-5;
        let mut peak = (0.0_f64, vec![1.0; count], 0);
        for texel in side.tables.iter().flat_map(|table| table.values.chunks_exact(count)) {
            for (channel, value) in texel.iter().enumerate() {
                if f64::from(value.abs()) > peak.0 {
                    peak =
                        (f64::from(value.abs()), texel.iter().map(|other| f64::from(other / value)).collect(), channel);
                }
            }
        }
        let (most, shares, channel) = peak;
        for texel in side.tables.iter().flat_map(|table| table.values.chunks_exact(count)) {
            let value = f64::from(texel[channel]);
            if texel
                .iter()
                .zip(&shares)
                .any(|(other, share)| (f64::from(*other) - share * value).abs() > ROUNDING * most)
            {
                let found = "a spectrum that depends on the directions".into();
                let expected = "one for all directions in .anisotropicbsdf (or --channel NAME, or .brdf if isotropic)";
                return Err(Refusal { found, expected });
            }
        }
        Ok(Shape { channel, shares })
    }
}

/// A channel of a table with its angles and values as they are printed.
struct Printed {
    table: Table,
    /// In degrees, as in the file.
    thetas: Vec<f64>,
    phis: Vec<f64>,
    values: Vec<String>,
}

impl Printed {
    fn new(scatter: Scatter, table: &Incident, count: usize, channel: usize) -> Self {
        let columns = table.phis.len();
        let words = |row: &[f32]| -> Vec<String> {
            row.iter().skip(channel).step_by(count).map(|value| nine_digits(f64::from(*value))).collect()
        };
        let mut rows: Vec<(f64, Vec<String>)> =
            table.thetas.iter().copied().zip(table.values.chunks_exact(columns * count).map(words)).collect();
        // The directions of transmission are beyond the horizon.
        if scatter == Scatter::Transmission {
            rows.iter_mut().for_each(|(theta, _)| *theta = 180.0 - *theta);
            rows.reverse();
        }
        let thetas: Vec<f64> = rows.iter().map(|(theta, _)| *theta).collect();
        let values: Vec<String> = rows.into_iter().flat_map(|(_, values)| values).collect();
        let numbers: Vec<f64> = values.iter().map(|word| word.parse().unwrap_or_default()).collect();
        Printed { table: Table::of_bsdf(&thetas, &table.phis, numbers), thetas, phis: table.phis.clone(), values }
    }

    /// The integral that readers divide the values by.
    fn integral(&self) -> Result<f64, Refusal> {
        let integral = self.table.integral();
        if integral > 0.0 || self.table.is_black() {
            return Ok(integral.max(0.0));
        }
        let found = format!("a table with the integral {integral}");
        Err(Refusal { found, expected: "a positive one: the format states values relative to their albedo" })
    }

    fn push(&self, out: &mut String) {
        let _ = writeln!(out, "{} {}", self.thetas.len(), self.phis.len());
        out.push('\t');
        row(out, self.phis.iter().copied());
        for (theta, values) in self.thetas.iter().zip(self.values.chunks_exact(self.phis.len())) {
            let _ = writeln!(out, "{theta}\t{}", values.join("\t"));
        }
    }
}
