//! The text files of the Cornell Program of Computer Graphics' goniometer, `.brdf`.
//!
//! `#` comments; the number of wavelengths; the wavelengths in nm; then a record per pair of directions: `theta_i`,
//! `phi_i`, `theta_o`, `phi_o` in radians and `f` in 1/sr for each wavelength.

use std::path::Path;

use lobe_table::{Channels, Scatter, scattered};

use crate::Document;
use crate::FormatError;
use crate::facts::{Facts, comments};
use crate::records::Records;
use crate::spec::FormatSpec;
use crate::text::Text;

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "Cornell BRDF",
    word: "cornell",
    extensions: &["brdf"],
    matches,
    read: Some(|bytes, path, _| Ok(Document::new(read(bytes, path)?).with_facts(facts(bytes)))),
    read_set: None,
    writer: None,
};

/// `true` if the comments at the start announce the number of wavelengths.
pub fn matches(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
    let mut comments = head.lines().map(str::trim).take_while(|line| line.is_empty() || line.starts_with('#'));
    comments.any(|comment| comment.trim_start_matches(['#', ' ']).eq_ignore_ascii_case("num wls"))
}

/// The comments of the header that do not describe its structure.
fn facts(bytes: &[u8]) -> Facts {
    comments(bytes, "#", |text| {
        let text = text.to_ascii_lowercase();
        matches!(text.as_str(), "num wls" | "wls") || text.starts_with("theta i")
    })
}

/// Reads a file. `file` is only its name in errors.
///
/// # Errors
/// [`FormatError`] with the line: missing or invalid numbers, a last record that is cut off, or polar angles that are
/// on no side of a surface.
pub fn read(bytes: &[u8], file: &Path) -> Result<scattered::Data, FormatError> {
    let mut text = Text::new(file, bytes, "#");
    let count = text.count("wavelengths")?;
    let mut wavelengths = Vec::with_capacity(count);
    for _ in 0..count {
        let nm = text.number("a wavelength in nm")?;
        if nm <= 0.0 {
            return Err(text.error(text.line(), format!("wavelength {nm}"), "a positive number of nm"));
        }
        wavelengths.push(nm);
    }
    let mut records = Records::default();
    let mut values = vec![0.0; count];
    while text.peek().is_some() {
        let mut angles = [0.0; 4];
        for angle in &mut angles {
            *angle = text.number("an angle in radians")?;
        }
        for value in &mut values {
            *value = text.number("a value")?;
        }
        records.push(angles, values.iter().copied());
    }
    records.scattered(file, Scatter::Reflection, Channels::Spectral(wavelengths))
}
