//! NIST's Mueller matrices of sintered PTFE (T. A. Germer, "Full four-dimensional and reciprocal Mueller matrix
//! bidirectional reflectance distribution function of sintered polytetrafluoroethylene", Applied Optics 56, 2017).
//!
//! A line that names the columns, then comma-separated records: wavelength in micrometres, `thetai`, azimuth of
//! incidence, `thetar`, `phir` in degrees, the unpolarised BRDF in 1/sr, and 15 elements of the Mueller matrix relative
//! to it, which are not read. `thetai` is negative if the light is on the side of azimuth 180.

use std::path::Path;

use lobe_table::{Scatter, scattered};

use crate::lines::{lines, shown};
use crate::records::ByWavelength;
use crate::spec::FormatSpec;
use crate::{Document, FormatError, Place};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "NIST Mueller CSV",
    word: "nist",
    extensions: &["csv"],
    matches,
    read: Some(|bytes, path, _| Ok(Document::new(read(bytes, path)?))),
    read_set: None,
    writer: None,
};

const COLUMNS: usize = 21;

/// `true` if the first line names the columns.
pub fn matches(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(1024)]);
    let names: Vec<String> = head.lines().next().unwrap_or_default().split(',').map(simple).collect();
    names.len() == COLUMNS && names[0] == "lambda" && names[1] == "thetai" && names[5] == "fr11"
}

fn simple(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_ascii_lowercase()
}

/// Reads the unpolarised BRDF. `file` is only its name in errors.
///
/// # Errors
/// [`FormatError`] with the line that does not have 21 finite numbers, or if wavelengths have different directions.
pub fn read(bytes: &[u8], file: &Path) -> Result<scattered::Data, FormatError> {
    let text = String::from_utf8_lossy(bytes);
    let mut lines = lines(file, &text);
    match lines.next() {
        Some(_) if matches(bytes) => {}
        Some(line) => return Err(line.error(shown(line.text), "the names of 21 columns, lambda first")),
        None => return Err(FormatError::new(file, Place::File, "an empty file", "the names of 21 columns")),
    }
    let mut samples = ByWavelength::default();
    for line in lines {
        let [micrometres, theta_i, phi_i, theta_o, phi_o, value, ..] = line.exactly::<COLUMNS>("21 columns")?;
        let nm = (micrometres * 1e9).round() / 1e6;
        if !(nm > 0.0 && nm.is_finite()) {
            return Err(line.error(format!("wavelength {micrometres}"), "a positive number of micrometres"));
        }
        samples.push(nm, [theta_i, phi_i, theta_o, phi_o].map(f64::to_radians), value);
    }
    samples.scattered(file, Scatter::Reflection)
}
