//! Writes FRED tables.

use std::fmt::Write as _;
use std::path::Path;

use lobe_files::write_whole;
use lobe_table::Channels;

use crate::angle::exact_degrees;
use crate::listed::samples;
use crate::spec::unfit;
use crate::{Document, FormatError, Place};

/// Writes `path` completely or not at all: for each incident direction, one line per sample or node above the horizon.
/// Angles are in degrees; values are read back bit for bit, and so are angles if the azimuth of the light is 0.
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
    let degrees = |angle: f64| exact_degrees(angle).unwrap_or(angle.to_degrees());
    let mut out = String::from("type bsdf_data\nformat angles=deg bsdf=value scale=1\n");
    let mut incident = None;
    for sample in samples {
        let [theta_i, phi_i, theta_o, phi_o] = sample.angles;
        if incident != Some([theta_i, phi_i]) {
            // The direction in which the light continues, not the one from which it comes.
            let travels = degrees(phi_i) - 180.0;
            let _ = writeln!(out, "{} {travels}", degrees(theta_i));
            incident = Some([theta_i, phi_i]);
        }
        let _ = writeln!(out, "{} {} {}", degrees(theta_o), degrees(phi_o), sample.values[0]);
    }
    write_whole(path, out.as_bytes())
}
