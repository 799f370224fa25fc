//! Tables for the brightness of satellites, in the format of the lumos-sat project.
//!
//! `#` comments, the last of which names five columns separated by white space: zenith angle and azimuth of the
//! direction toward the light (there called phi and theta), those of the scattered light, and `f` in 1/sr. Degrees.
//! Zenith angles may be negative, which is the other half of the plane.

use std::path::Path;

use lobe_table::{Channels, Scatter, scattered};

use crate::Document;
use crate::FormatError;
use crate::facts::{Facts, comments};
use crate::lines::lines;
use crate::records::Records;
use crate::spec::FormatSpec;

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "lumos-sat CSV",
    word: "lumos",
    extensions: &["csv"],
    matches,
    read: Some(|bytes, path, _| Ok(Document::new(read(bytes, path)?).with_facts(facts(bytes)))),
    read_set: None,
    writer: None,
};

/// `true` if a comment at the start names the columns.
pub fn matches(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
    let mut comments = head.lines().take_while(|line| line.starts_with('#'));
    comments.any(|line| names_columns(&line[1..]))
}

fn names_columns(comment: &str) -> bool {
    let names: Vec<String> = comment.split_whitespace().map(str::to_ascii_lowercase).collect();
    let short: Vec<&str> = names.iter().map(|name| name.split_inclusive('_').next().unwrap_or_default()).collect();
    short == ["phi_", "theta_", "phi_", "theta_", "brdf"]
}

/// The comments, except for the one that names the columns.
fn facts(bytes: &[u8]) -> Facts {
    comments(bytes, "#", names_columns)
}

/// Reads a file. `file` is only its name in errors.
///
/// # Errors
/// [`FormatError`] with the line that does not have five finite numbers, or without a line if the file has no data.
pub fn read(bytes: &[u8], file: &Path) -> Result<scattered::Data, FormatError> {
    let text = String::from_utf8_lossy(bytes);
    let mut records = Records::default();
    for line in lines(file, &text).filter(|line| !line.text.starts_with('#')) {
        let [zenith_i, azimuth_i, zenith_o, azimuth_o, f] = line.exactly("two angles, two angles and a value")?;
        let angles = [zenith_i, azimuth_i, zenith_o, azimuth_o].map(f64::to_radians);
        records.push_line(line.number, angles, [f]);
    }
    records.scattered(file, Scatter::Reflection, Channels::Mono)
}
