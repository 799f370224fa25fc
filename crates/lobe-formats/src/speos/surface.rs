//! Surfaces of Speos described by a few numbers: `.simplescattering` and `.coated`.
//!
//! Both are text: the line that names the file, a description, and numbers in percent.
//!
//! A simple scattering surface has `Reflection`, `Transmission` or `Both`. The light that is not absorbed is divided
//! into a Lambertian part and a Gaussian part with its width; the rest is not scattered. `Both` has these for
//! reflection and for transmission, followed either by 1, for a split by Fresnel's laws, or by 0 and the reflected
//! part.
//!
//! A coating has the numbers of incident angles and of wavelengths, the wavelengths, and for each angle two lines of
//! reflectance and transmittance at each wavelength: one for P polarisation, which begins with the angle, and one for
//! S.

use std::path::Path;

use lobe_table::{Channels, Scatter, mirror, spherical};

use super::table::Source;
use crate::lines::shown;
use crate::spec::FormatSpec;
use crate::{Document, FormatError, Part};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "Speos surface",
    word: "speos-surface",
    extensions: &["simplescattering", "coated"],
    matches,
    read: Some(|bytes, path, _| read(bytes, path)),
    read_set: None,
    writer: None,
};

const SIMPLE: &str = "optis - simple scattering surface file";
const COATED: &str = "optis - coated surface file";

/// `true` if the first line identifies one of these files.
pub fn matches(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(128)]).to_ascii_lowercase();
    head.starts_with(SIMPLE) || head.starts_with(COATED)
}

/// Reads a file of either kind. `file` is only its name in errors.
///
/// # Errors
/// [`FormatError`] with the line: another kind of file, missing or invalid numbers or percentages; a Gaussian part,
/// whose profile is not public; a split by Fresnel's laws, for which the file has no refractive index.
pub fn read(bytes: &[u8], file: &Path) -> Result<Document, FormatError> {
    let text = String::from_utf8_lossy(bytes);
    let mut source = Source::new(file, &text);
    let header = source.line("the line that names the file")?;
    let lower = header.to_ascii_lowercase();
    let is_simple = lower.starts_with(SIMPLE);
    if !is_simple && !lower.starts_with(COATED) {
        return Err(source.error(shown(header), "`OPTIS - Simple scattering` or `OPTIS - Coated surface file`"));
    }
    let description = source.line("a description")?.to_string();
    let parts = if is_simple { simple(&mut source)? } else { coated(&mut source)? };
    Ok(Document::of_parts(parts).with_source(&[("description", description.as_str())]))
}

/// A number in percent, as a fraction of 1.
fn share(source: &mut Source<'_>, what: &str) -> Result<f64, FormatError> {
    let percent = source.number(what)?;
    match (0.0..=100.0).contains(&percent) {
        true => Ok(percent / 100.0),
        false => Err(source.error(format!("{what} {percent}"), "0 to 100 percent")),
    }
}

fn simple(source: &mut Source<'_>) -> Result<Vec<Part>, FormatError> {
    let mode = loop {
        match source.line("Reflection, Transmission or Both")?.trim() {
            "" => {}
            line => break line.to_ascii_lowercase(),
        }
    };
    let scatters: &[Scatter] = match mode.as_str() {
        "reflection" => &[Scatter::Reflection],
        "transmission" => &[Scatter::Transmission],
        "both" => &[Scatter::Reflection, Scatter::Transmission],
        other => return Err(source.error(shown(other), "Reflection, Transmission or Both")),
    };
    let absorbed = share(source, "the absorption")?;
    let mut read = |what: &str, scatters: &[Scatter]| {
        scatters.iter().map(|_| share(source, what)).collect::<Result<Vec<f64>, FormatError>>()
    };
    let lambertian = read("a Lambertian part", scatters)?;
    let gaussian = read("a Gaussian part", scatters)?;
    for _ in scatters {
        source.number("the width of the Gaussian part")?;
    }
    let mut parts = Vec::new();
    let mut totals = vec![1.0 - absorbed];
    if scatters.len() == 2 {
        if source.flag("whether Fresnel's laws split the light")? {
            let expected = "0 and the reflected part: the file has no refractive index";
            return Err(source.error("a split by Fresnel's laws", expected));
        }
        let reflected = share(source, "the reflected part")?;
        totals = vec![(1.0 - absorbed) * reflected, (1.0 - absorbed) * (1.0 - reflected)];
    }
    for (at, &scatter) in scatters.iter().enumerate() {
        if gaussian[at] > 0.0 {
            let expected =
                "0: Speos' definition of the profile with that width is not public. Export the surface as .brdf";
            return Err(source.error(format!("a Gaussian part of {} percent", gaussian[at] * 100.0), expected));
        }
        parts.extend(surface(scatter, totals[at], lambertian[at]).map_err(|found| source.error(found, "a surface"))?);
    }
    Ok(parts)
}

/// The scattered and the unscattered part of light, of which the share `total` is neither absorbed nor goes elsewhere.
fn surface(scatter: Scatter, total: f64, lambertian: f64) -> Result<Vec<Part>, String> {
    let f = (total * lambertian / std::f64::consts::PI) as f32;
    let knots = [vec![0.0], vec![0.0], vec![0.0], vec![0.0]];
    let data = spherical::Data::new(scatter, knots, Channels::Mono, vec![f]).map_err(|error| error.to_string())?;
    let mut parts = vec![Part::new("", data)];
    let straight = total * (1.0 - lambertian);
    if straight > 0.0 {
        let data = mirror::Data::new(scatter, [vec![0.0], vec![0.0]], Channels::Mono, vec![straight as f32]);
        parts.push(Part::new("", data.ok_or("numbers that are not finite")?));
    }
    Ok(parts)
}

fn coated(source: &mut Source<'_>) -> Result<Vec<Part>, FormatError> {
    let (angles, wavelengths) =
        (source.count("the number of incident angles")?, source.count("the number of wavelengths")?);
    let wavelengths = source.list(wavelengths, "a wavelength in nm")?;
    if wavelengths.iter().any(|nm| *nm <= 0.0) || wavelengths.windows(2).any(|pair| pair[0] >= pair[1]) {
        return Err(source.error("wavelengths out of order", "positive numbers of nm, ascending"));
    }
    let mut thetas: Vec<f64> = Vec::new();
    let (mut reflectance, mut transmittance) = (Vec::new(), Vec::new());
    for _ in 0..angles {
        let theta = source.number("an incident angle")?;
        if !(0.0..=90.0).contains(&theta) || thetas.last().is_some_and(|last| *last >= theta.to_radians()) {
            return Err(source.error(format!("incident angle {theta}"), "0 to 90 degrees, ascending"));
        }
        thetas.push(theta.to_radians());
        let first = reflectance.len();
        for _ in &wavelengths {
            reflectance.push(share(source, "a reflectance")?);
            transmittance.push(share(source, "a transmittance")?);
        }
        // Unpolarised light is the mean of both.
        for at in first..reflectance.len() {
            reflectance[at] = (reflectance[at] + share(source, "a reflectance")?) / 2.0;
            transmittance[at] = (transmittance[at] + share(source, "a transmittance")?) / 2.0;
        }
    }
    let channels = if wavelengths.len() == 1 { Channels::Mono } else { Channels::Spectral(wavelengths) };
    let of_scatter = |scatter: Scatter, values: &[f64]| {
        let values = values.iter().map(|value| *value as f32).collect();
        mirror::Data::new(scatter, [thetas.clone(), vec![0.0]], channels.clone(), values)
            .map(|data| Part::new("", data))
    };
    let parts = [(Scatter::Reflection, &reflectance), (Scatter::Transmission, &transmittance)];
    let parts = parts.map(|(scatter, values)| of_scatter(scatter, values));
    parts
        .into_iter()
        .collect::<Option<Vec<Part>>>()
        .ok_or_else(|| source.error("numbers that are not finite", "a coating"))
}
