//! Lookup tables of ASAM OpenMATERIAL 3D, `.xompt`: JSON with rows of wavelength in m, `theta_i`, `theta_o`, `phi_o`
//! relative to the incident azimuth, in radians, and `f` in 1/sr.

use std::path::Path;

use lobe_table::{Scatter, scattered};
use serde::Deserialize;
use serde_json::Value;

use crate::records::ByWavelength;
use crate::spec::FormatSpec;
use crate::{Document, FormatError, Place};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "OpenMATERIAL 3D",
    word: "openmaterial",
    extensions: &["xompt"],
    matches,
    read: Some(|bytes, path, _| {
        let json = parse(bytes, path)?;
        Ok(Document::new(table(&json, path)?).with_facts(facts(&json)))
    }),
    read_set: None,
    writer: None,
};

#[derive(Deserialize)]
struct Json {
    brdf: Brdf,
    #[serde(default)]
    metadata: serde_json::Map<String, Value>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Brdf {
    lookup_table: Vec<[Option<f64>; 5]>,
}

/// `true` for JSON that has a `brdf` with a list as its `lookupTable`.
pub fn matches(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(1 << 16)]);
    let head = head.trim_start_matches('\u{feff}').trim_start();
    let table = head.split_once("\"lookupTable\"").map(|(_, after)| after.trim_start());
    let is_list =
        table.and_then(|after| after.strip_prefix(':')).is_some_and(|value| value.trim_start().starts_with('['));
    head.starts_with('{') && head.contains("\"brdf\"") && is_list
}

/// Reads a file. `file` is only its name in errors. Rows with a null are left out: null means "not measured".
///
/// # Errors
/// [`FormatError`] with the line of the JSON that is wrong; wavelengths that are not positive; or if wavelengths have
/// different directions.
pub fn read(bytes: &[u8], file: &Path) -> Result<scattered::Data, FormatError> {
    table(&parse(bytes, file)?, file)
}

fn parse(bytes: &[u8], file: &Path) -> Result<Json, FormatError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    serde_json::from_slice(bytes).map_err(|error| {
        FormatError::new(file, Place::Line(error.line()), error.to_string(), "brdf.lookupTable, rows of 5 numbers")
    })
}

/// The metadata that are words or numbers, or lists of these.
fn facts(document: &Json) -> Vec<(String, String)> {
    let word = |value: &Value| match value {
        Value::String(text) => Some(text.clone()),
        Value::Number(number) => Some(number.to_string()),
        Value::Bool(flag) => Some(flag.to_string()),
        _ => None,
    };
    let text = |value: &Value| match value {
        Value::Array(values) => Some(values.iter().filter_map(word).collect::<Vec<_>>().join(", ")),
        value => word(value),
    };
    let fact = |(name, value): (&String, &Value)| Some((name.clone(), text(value)?));
    document.metadata.iter().filter_map(fact).filter(|(_, text)| !text.is_empty()).collect()
}

fn table(document: &Json, file: &Path) -> Result<scattered::Data, FormatError> {
    let mut samples = ByWavelength::default();
    for (row, numbers) in document.brdf.lookup_table.iter().enumerate() {
        if let &[Some(metres), Some(theta_i), Some(theta_o), Some(phi), Some(value)] = numbers {
            // Rounded to a millionth of a nanometre, so that 4.1e-7 m is 410 nm.
            let nm = (metres * 1e15).round() / 1e6;
            if !(nm > 0.0 && nm.is_finite()) {
                let found = format!("wavelength {metres} in row {row}");
                return Err(FormatError::new(file, Place::File, found, "a positive number of metres"));
            }
            samples.push(nm, [theta_i, 0.0, theta_o, phi], value);
        }
    }
    samples.scattered(file, Scatter::Reflection)
}
