//! Writes FRED tables.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

use lobe_files::write_whole;
use lobe_table::{Channels, Data};

use crate::angle::{Unit, exact_degrees};
use crate::listed::{Sample, samples, samples_of};
use crate::spec::unfit;
use crate::{Document, FormatError, Place};

/// Writes `path` completely or not at all: for each incident direction, one line per sample or node above the horizon.
/// Values are read back bit for bit. So are the angles of samples, which are in degrees, or in radians if degrees would
/// not restore one of them; but readers add half a turn to the azimuth of the light, which rounds small azimuths.
///
/// # Errors
/// [`FormatError`] if the file cannot be written, or the document is not a list of samples of a reflectance or has
/// several channels.
pub(super) fn write(document: &Document, path: &Path) -> Result<(), FormatError> {
    let (Some(samples), Some(data)) = (samples(document), document.only()) else {
        return Err(unfit(document, path, "samples, or nodes in specular or spherical coordinates, of a reflectance"));
    };
    let channels = data.representation().channels();
    if channels.count() != 1 {
        let found = format!("the channels {}", channels.names().join(" "));
        return Err(FormatError::new(path, Place::File, found, "one channel in this format"));
    }
    if let Channels::Spectral(_) = channels {
        let found = format!("the wavelength {}", channels.names().join(" "));
        return Err(FormatError::new(path, Place::File, found, "one channel without a wavelength in this format"));
    }
    let (samples, unit) = match data {
        Data::Scattered(data) => samples_of(data, PI),
        _ => (in_degrees(samples), Unit::Deg),
    };
    let unit = if unit == Unit::Deg { "deg" } else { "rad" };
    let mut out = format!("type bsdf_data\nformat angles={unit} bsdf=value scale=1\n");
    let mut incident = None;
    for sample in samples {
        let [theta_i, travels, theta_o, phi_o] = sample.angles;
        if incident != Some([theta_i, travels]) {
            let _ = writeln!(out, "{theta_i} {travels}");
            incident = Some([theta_i, travels]);
        }
        let _ = writeln!(out, "{theta_o} {phi_o} {}", sample.values[0]);
    }
    write_whole(path, out.as_bytes())
}

/// Samples in degrees, with the azimuth in which the light continues instead of that from which it comes.
fn in_degrees(mut samples: Vec<Sample<'_>>) -> Vec<Sample<'_>> {
    for sample in &mut samples {
        sample.angles = sample.angles.map(|angle| exact_degrees(angle).unwrap_or(angle.to_degrees()));
        sample.angles[1] -= 180.0;
    }
    samples
}
