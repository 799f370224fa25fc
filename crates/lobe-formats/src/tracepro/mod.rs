//! Surface properties of TracePro, as the program exports them: those with a table of scatter.
//!
//! The first line is `TracePro Surface Property Data`; a head of names and values follows, then `Temperature` and the
//! names of the other columns of the specular data, and their rows. After `Table_BSDF_Data` and names of columns come
//! rows of temperature, wavelength in micrometres, polar angle and azimuth of incidence in degrees, `ScatterBeta`,
//! `ScatterAzimuth`, and the BRDF and BTDF in 1/sr.
//!
//! `ScatterBeta` is the abscissa of Harvey and Shack: the distance, in the plane of the surface, between the
//! projections of the scattered and of the specular direction, both unit vectors. A table that depends on it alone is
//! stored as rings about the specular direction. The file does not say where azimuth 0 is; that depends on the surface
//! to which the property is applied.

mod rings;
mod sections;

use std::path::Path;

use lobe_table::{Channels, Scatter, mirror};

use crate::records::Records;
use crate::spec::FormatSpec;
use crate::{Document, FormatError, Part};
use rings::Curve;
use sections::Sheet;

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "TracePro surface property",
    word: "tracepro",
    extensions: &["txt"],
    matches,
    read: Some(|bytes, path, _| read(bytes, path)),
    read_set: None,
    writer: None,
};

const FIRST_LINE: &str = "TracePro Surface Property Data";

/// `true` if the first line identifies a surface property.
pub fn matches(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(256)];
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start();
    head.get(..FIRST_LINE.len()).is_some_and(|start| start.eq_ignore_ascii_case(FIRST_LINE.as_bytes()))
}

/// Reads a file: reflection and transmission of each side that has a table, and the mirror reflectance and
/// straight-through transmittance in addition. `file` is only its name in errors.
///
/// # Errors
/// [`FormatError`] with the line: rows with missing or other columns, a second property, gratings, several
/// temperatures, a property that is a formula, or tables that depend on `ScatterAzimuth` or whose angles differ between
/// wavelengths.
pub fn read(bytes: &[u8], file: &Path) -> Result<Document, FormatError> {
    let text = String::from_utf8_lossy(bytes);
    let property = sections::read(file, &text)?;
    let is_one_sided = property.sheets.iter().all(|(side, _)| side.is_none());
    let mut parts = Vec::new();
    let mut source = property.source.clone();
    for (side, sheet) in &property.sheets {
        let wavelengths = sheet.wavelengths();
        let channels = match wavelengths.as_slice() {
            [_] => Channels::Mono,
            several => Channels::Spectral(several.to_vec()),
        };
        if let [nm] = wavelengths.as_slice() {
            source.push(("Wavelength".into(), format!("{nm} nm")));
        }
        let side = if is_one_sided { None } else { *side };
        let is_dark = sheet.table.iter().all(|row| row.brdf == 0.0 && row.btdf == 0.0);
        for scatter in [Scatter::Reflection, Scatter::Transmission] {
            let curves = rings::curves(file, sheet, &wavelengths, scatter)?;
            if !curves.iter().all(Curve::is_dark) || (is_dark && scatter == Scatter::Reflection) {
                let mut records = Records::default();
                curves.iter().for_each(|curve| curve.samples(&mut records));
                let data = records.scattered(file, scatter, channels.clone())?;
                parts.push(Part { name: String::new(), side, data: data.into() });
            }
            match specular(sheet, &wavelengths, scatter, &channels) {
                Specular::None => {}
                Specular::Mirror(data) => parts.push(Part { name: String::new(), side, data: data.into() }),
                Specular::Unlike => source.push((
                    format!(
                        "specular {}",
                        if scatter == Scatter::Reflection { "reflectance" } else { "transmittance" }
                    ),
                    "not read: its wavelengths are not those of the table".into(),
                )),
            }
        }
    }
    let mut document = Document::of_parts(parts);
    document.source.extend(source);
    Ok(document)
}

/// The unscattered light of a sheet.
enum Specular {
    /// It has none.
    None,
    Mirror(mirror::Data),
    /// It has other wavelengths than the table.
    Unlike,
}

fn specular(sheet: &Sheet, wavelengths: &[f64], scatter: Scatter, channels: &Channels) -> Specular {
    let of_scatter = |row: &sections::SpecularRow| match scatter {
        Scatter::Reflection => row.reflectance,
        Scatter::Transmission => row.transmittance,
    };
    if sheet.specular.iter().all(|row| of_scatter(row) == 0.0) {
        return Specular::None;
    }
    let mut angles: Vec<f64> = sheet.specular.iter().map(|row| row.theta).collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    let mut values = Vec::new();
    for theta in &angles {
        for nm in wavelengths {
            let mut rows = sheet.specular.iter().filter(|row| row.theta == *theta && row.nm == *nm);
            match (rows.next(), rows.next()) {
                (Some(row), None) => values.push(of_scatter(row) as f32),
                _ => return Specular::Unlike,
            }
        }
    }
    if values.len() != sheet.specular.len() {
        return Specular::Unlike;
    }
    let knots = [angles.iter().map(|angle| angle.to_radians()).collect(), vec![0.0]];
    mirror::Data::new(scatter, knots, channels.clone(), values).map_or(Specular::Unlike, Specular::Mirror)
}
