//! Data files of the ALTA library, text form.
//!
//! `#KEY value` lines, among them `#DIM inputs outputs`, `#PARAM_IN` and `#PARAM_OUT`, then one record per line. Two
//! parametrisations of isotropic materials are read: `ISOTROPIC_TL_TV_PROJ_DPHI`, which is `theta_i`, `theta_o
//! cos(dphi)`, `theta_o sin(dphi)`, and `ISOTROPIC_TV_TL_DPHI`, which is `theta_o`, `theta_i`, `dphi`; radians. Values
//! are `f` in 1/sr (`INV_STERADIAN`), or with the cosine of the outgoing direction (`INV_STERADIAN_COSINE_FACTOR`),
//! which is divided out; at the horizon, where it is zero, such a sample has no information and is left out.

use std::path::Path;

use lobe_table::{Channels, Scatter, scattered};

use crate::facts::{Facts, named};
use crate::lines::{lines, shown};
use crate::records::Records;
use crate::spec::FormatSpec;
use crate::{Document, FormatError, Place};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "ALTA",
    word: "alta",
    extensions: &["dat"],
    matches,
    read: Some(|bytes, path, _| Ok(Document::new(read(bytes, path)?).with_facts(facts(bytes)))),
    read_set: None,
    writer: None,
};

/// Below this cosine, a value cannot be distinguished from the error of the division.
const LEAST_COSINE: f64 = 1e-3;

/// `true` if the lines at the start that begin with `#` have `#DIM` and `#PARAM_IN`.
pub fn matches(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
    let has = |key: &str| head.lines().take_while(|line| line.starts_with('#')).any(|line| line.starts_with(key));
    has("#DIM ") && has("#PARAM_IN ")
}

/// The facts about the sample in the lines at the start.
fn facts(bytes: &[u8]) -> Facts {
    let mut facts = named(bytes, |key| key.strip_prefix('#').map(String::from));
    facts.retain(|(key, _)| !matches!(key.as_str(), "DIM" | "VS"));
    facts
}

enum Input {
    Projected,
    Angles,
}

/// Reads a file. `file` is only its name in errors.
///
/// # Errors
/// [`FormatError`] with the line: another parametrisation, a `#DIM` that does not match it, or records of another
/// length.
pub fn read(bytes: &[u8], file: &Path) -> Result<scattered::Data, FormatError> {
    let text = String::from_utf8_lossy(bytes);
    let (mut input, mut has_cosine, mut outputs) = (None, false, None);
    let mut records = Records::default();
    for line in lines(file, &text) {
        if let Some(header) = line.text.strip_prefix('#') {
            let (key, value) = header.split_once(char::is_whitespace).unwrap_or((header, ""));
            match (key, value.trim()) {
                ("DIM", value) => {
                    let mut counts = value.split_whitespace().map(str::parse::<usize>);
                    outputs = match (counts.next(), counts.next()) {
                        (Some(Ok(3)), Some(Ok(n @ (1 | 3)))) => Some(n),
                        _ => return Err(line.error(shown(value), "3 inputs and 1 or 3 outputs")),
                    };
                }
                ("PARAM_IN", "ISOTROPIC_TL_TV_PROJ_DPHI") => input = Some(Input::Projected),
                ("PARAM_IN", "ISOTROPIC_TV_TL_DPHI") => input = Some(Input::Angles),
                ("PARAM_IN", other) => {
                    return Err(line.error(shown(other), "ISOTROPIC_TL_TV_PROJ_DPHI or ISOTROPIC_TV_TL_DPHI"));
                }
                ("PARAM_OUT", "INV_STERADIAN") => has_cosine = false,
                ("PARAM_OUT", "INV_STERADIAN_COSINE_FACTOR") => has_cosine = true,
                ("PARAM_OUT", other) => {
                    return Err(line.error(shown(other), "INV_STERADIAN or INV_STERADIAN_COSINE_FACTOR"));
                }
                ("VS", value) if value != "0" => {
                    return Err(line.error(format!("#VS {}", shown(value)), "#VS 0, values without intervals"));
                }
                _ => {}
            }
            continue;
        }
        let (Some(input), Some(outputs)) = (&input, outputs) else {
            return Err(line.error("a record", "#DIM and #PARAM_IN first"));
        };
        let numbers = line.numbers()?;
        if numbers.len() != 3 + outputs {
            return Err(line.error(format!("{} numbers", numbers.len()), format!("3 inputs and {outputs} outputs")));
        }
        let (theta_i, theta_o, dphi) = match input {
            Input::Projected => (numbers[0], libm::hypot(numbers[1], numbers[2]), libm::atan2(numbers[2], numbers[1])),
            Input::Angles => (numbers[1], numbers[0], numbers[2]),
        };
        let cosine = if has_cosine { libm::cos(theta_o) } else { 1.0 };
        if cosine >= LEAST_COSINE {
            let values = numbers[3..].iter().map(|value| value / cosine);
            records.push_line(line.number, [theta_i, 0.0, theta_o, dphi], values);
        }
    }
    let channels = match outputs {
        Some(1) => Channels::Mono,
        Some(_) => Channels::Rgb,
        None => return Err(FormatError::new(file, Place::File, "no #DIM", "#DIM, #PARAM_IN and records")),
    };
    records.scattered(file, Scatter::Reflection, channels)
}
