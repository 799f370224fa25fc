//! Reads the header of an EXR file.

use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

use exr::prelude::{AttributeValue, Text};

use super::exr_file::{ATTRIBUTE, content};
use super::{Meta, PictureError};

/// Facts about an EXR file written by lobe.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspected {
    /// Description of the picture.
    pub meta: Meta,
    /// `true` if it has the exact sums, so that samples can be added.
    pub has_sums: bool,
    /// The kind of light that was followed.
    pub light: Light,
}

/// The kind of light that was followed in a picture, according to its channels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Light {
    /// The wavelengths in nm, ascending; none for red, green and blue.
    pub wavelengths: Vec<f64>,
    /// `true` if light was polarised.
    pub stokes: bool,
}

impl Light {
    /// The wavelengths as the bands of a picture; `None` for red, green and blue.
    ///
    /// # Errors
    /// If none of them is visible.
    pub fn bands(&self) -> Result<Option<Arc<lobe_spectrum::Bands>>, lobe_spectrum::SpectrumError> {
        if self.wavelengths.is_empty() {
            return Ok(None);
        }
        if self.stokes && self.wavelengths.len() > 16 {
            let found = self.wavelengths.len();
            return Err(lobe_spectrum::SpectrumError::Count { found, expected: "at most 16 of polarised light" });
        }
        lobe_spectrum::Bands::new(self.wavelengths.clone()).map(|bands| Some(Arc::new(bands)))
    }

    fn of<'a>(names: impl Iterator<Item = &'a str>) -> Self {
        let mut light = Light::default();
        for name in names {
            light.stokes |= name.starts_with("S1.");
            let nm = name.strip_prefix("S0.").and_then(|rest| rest.strip_suffix("nm"));
            light.wavelengths.extend(nm.and_then(|nm| nm.replace(',', ".").parse::<f64>().ok()));
        }
        light.wavelengths.sort_by(f64::total_cmp);
        light
    }
}

/// Reads the header of an EXR file.
///
/// # Errors
/// If the file cannot be read, is damaged, or is not a picture written by lobe.
pub fn inspect(path: &Path) -> Result<Inspected, PictureError> {
    const EXPECTED: &str = "a picture written by lobe";
    let bytes = lobe_files::bytes(path).map_err(|error| PictureError::Io { file: path.into(), error })?;
    let headers = exr::meta::MetaData::read_from_buffered(Cursor::new(&bytes), false)
        .map_err(|error| content(path, error, EXPECTED))?
        .headers;
    let text = headers.iter().find_map(|header| match header.own_attributes.other.get(&Text::from(ATTRIBUTE)) {
        Some(AttributeValue::Text(text)) => Some(text.to_string()),
        _ => None,
    });
    let text = text.ok_or_else(|| content(path, format!("no attribute `{ATTRIBUTE}`"), EXPECTED))?;
    let meta = Meta::parse(&text).ok_or_else(|| content(path, format!("`{text}`"), EXPECTED))?;
    let channels = headers.iter().flat_map(|header| &header.channels.list);
    let names: Vec<String> = channels.map(|channel| channel.name.to_string()).collect();
    let has_sums = names.iter().any(|name| name == "sum.albedo.R.0");
    Ok(Inspected { meta, has_sums, light: Light::of(names.iter().map(String::as_str)) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_wavelengths_than_a_picture_has_are_refused() {
        let light = |count: usize, stokes| {
            let wavelengths = (0..count).map(|k| 400.0 + 5.0 * k as f64).collect();
            Light { wavelengths, stokes }.bands().map(|bands| bands.map(|bands| bands.count())).map_err(|_| ())
        };
        assert_eq!((light(0, true), light(16, true), light(17, true)), (Ok(None), Ok(Some(16)), Err(())));
        assert_eq!((light(32, false), light(33, false)), (Ok(Some(32)), Err(())));
    }
}
