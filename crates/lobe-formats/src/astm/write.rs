//! Writes ASTM E1392 files.

use std::fmt::Write as _;
use std::path::Path;

use lobe_files::write_whole;
use lobe_table::Channels;

use crate::listed::samples;
use crate::spec::unfit;
use crate::{Document, FormatError};

/// Writes `path` completely or not at all: one record per sample, or per node above the horizon. Values are read back
/// bit for bit, and so are the angles of samples.
///
/// # Errors
/// [`FormatError`] if the file cannot be written, or the document is not a list of samples of a reflectance.
pub(super) fn write(document: &Document, path: &Path) -> Result<(), FormatError> {
    let (Some(samples), Some(data)) = (samples(document), document.only()) else {
        return Err(unfit(document, path, "samples, or nodes in specular or spherical coordinates, of a reflectance"));
    };
    let channels = data.representation().channels();
    let mut out = String::new();
    for (key, value) in &document.source {
        // One line per fact; readers take its first word as the keyword.
        let key = key.split_whitespace().collect::<Vec<_>>().join("_");
        if !key.is_empty() && !["VARS", "NUM_POINTS"].contains(&key.as_str()) {
            let _ = writeln!(out, "{key} {}", value.split_whitespace().collect::<Vec<_>>().join(" "));
        }
    }
    let _ = writeln!(out, "NUM_POINTS {}", samples.len());
    let names = match channels.count() {
        1 if !matches!(channels, Channels::Spectral(_)) => "bsdf".to_owned(),
        _ => channels.names().join(","),
    };
    let _ = writeln!(out, "VARS theta_i,phi_i,theta_s,phi_s,{names}");
    for sample in samples {
        let [theta_i, phi_i, theta_o, phi_o] = sample.angles;
        let _ = write!(out, "{theta_i},{phi_i},{theta_o},{phi_o}");
        for value in sample.values {
            let _ = write!(out, ",{value}");
        }
        out.push('\n');
    }
    write_whole(path, out.as_bytes())
}
