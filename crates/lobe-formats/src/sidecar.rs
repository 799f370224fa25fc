//! A small file next to a measurement that says how to read it: `scan.csv.lobe.toml` next to `scan.csv`.
//!
//! ```toml
//! columns = "theta_i=1,theta_o=2,f=3"
//! unit = "deg"
//! values = "luminance-factor"
//! scale = 0.98
//! ```
//!
//! Keys are the fields of [`ReadOptions`], with a hyphen or an underscore between words. Numbers, and `true` and
//! `false`, may be written with or without quotes.

use std::ffi::OsString;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use lobe_files::SIDECAR;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::reading::{ReadOptions, parse_columns};
use crate::{FormatError, Place, plain};

const KEYS: &str = "columns, unit, values, scale, holds, in-plane, azimuth-from or decimal-comma";

/// The sidecar of a file, whether it exists or not.
pub fn path_of(file: &Path) -> PathBuf {
    let mut name = file.file_name().map(OsString::from).unwrap_or_default();
    name.push(SIDECAR);
    file.with_file_name(name)
}

/// The options in the sidecar of a file; empty if there is none.
///
/// # Errors
/// [`FormatError`] with the line if the sidecar cannot be read or understood.
pub fn find(file: &Path) -> Result<ReadOptions, FormatError> {
    let path = path_of(file);
    if !lobe_files::exists(&path) {
        return Ok(ReadOptions::default());
    }
    let bytes = lobe_files::read(&path)?;
    let bytes = plain::text(&bytes);
    let text = std::str::from_utf8(&bytes)
        .map_err(|error| FormatError::new(&path, Place::File, error.to_string(), "text in UTF-8"))?;
    parse(text, &path)
}

/// The options in the text of a sidecar; `path` names it in errors.
///
/// # Errors
/// [`FormatError`] with the line that cannot be understood.
pub fn parse(text: &str, path: &Path) -> Result<ReadOptions, FormatError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let line = |at: usize| Place::Line(1 + text.bytes().take(at).filter(|byte| *byte == b'\n').count());
    let table = DeTable::parse(text).map_err(|error| {
        let at = error.span().map_or(Place::File, |span| line(span.start));
        FormatError::new(path, at, error.message(), "TOML")
    })?;
    let mut options = ReadOptions::default();
    for (key, value) in table.get_ref() {
        let place = line(key.span().start);
        let word = word(value).ok_or_else(|| {
            FormatError::new(path, place, format!("{} of another kind", key.get_ref()), "a word or a number")
        })?;
        set(&mut options, key.get_ref(), &word).map_err(|message| {
            let (found, expected) = message.split_once("; expected ").unwrap_or((&message, "another value"));
            let found = found.strip_prefix("found ").unwrap_or(found);
            let found =
                if found.starts_with("the key") { found.into() } else { format!("{found} for {}", key.get_ref()) };
            FormatError::new(path, place, found, expected)
        })?;
    }
    Ok(options)
}

/// A value as on the command line; a table of columns becomes a list.
fn word(value: &Spanned<DeValue<'_>>) -> Option<String> {
    let DeValue::Table(table) = value.get_ref() else { return scalar(value.get_ref()) };
    let entries = table.iter().map(|(key, value)| Some(format!("{}={}", key.get_ref(), scalar(value.get_ref())?)));
    Some(entries.collect::<Option<Vec<_>>>()?.join(","))
}

fn scalar(value: &DeValue<'_>) -> Option<String> {
    match value {
        DeValue::String(text) => Some(text.to_string()),
        DeValue::Integer(number) => Some(number.to_string()),
        DeValue::Float(number) => Some(number.to_string()),
        DeValue::Boolean(value) => Some(value.to_string()),
        DeValue::Table(_) | DeValue::Array(_) | DeValue::Datetime(_) => None,
    }
}

/// Sets the option with this name to the meaning of a word.
///
/// # Errors
/// What was found and what was expected, if there is no such option or the word is invalid for it.
pub fn set(options: &mut ReadOptions, key: &str, word: &str) -> Result<(), String> {
    fn keep<T>(field: &mut T, value: Result<T, String>) -> Result<(), String> {
        *field = value?;
        Ok(())
    }
    let is_true = |word: &str| match word {
        "true" => Ok(true),
        "false" => Ok(false),
        _ => Err(format!("found {word:?}; expected true or false")),
    };
    match key.replace('_', "-").as_str() {
        "columns" => keep(&mut options.columns, parse_columns(word)),
        "unit" => keep(&mut options.unit, word.parse().map(Some)),
        "values" => keep(&mut options.values, word.parse().map(Some)),
        "scale" => keep(&mut options.scale, word.parse().map(Some)),
        "holds" => keep(&mut options.holds, word.parse().map(Some)),
        "in-plane" => keep(&mut options.in_plane, word.parse().map(Some)),
        "azimuth-from" => keep(&mut options.azimuth_from, word.parse().map(Some)),
        "decimal-comma" => keep(&mut options.decimal_comma, is_true(word).map(Some)),
        _ => Err(format!("found the key {key:?}; expected one of {KEYS}")),
    }
}

/// The text of a sidecar with these options.
pub fn to_text(options: &ReadOptions, name: &str) -> String {
    let mut out = format!("# How lobe reads {}.\n", name.escape_debug());
    let mut line = |key: &str, value: Option<String>| {
        if let Some(value) = value {
            let _ = writeln!(out, "{key} = {value}");
        }
    };
    let quoted = |text: String| {
        let mut quoted = String::from("\"");
        for c in text.chars() {
            match c {
                '\\' | '"' => quoted.extend(['\\', c]),
                _ if c.is_control() => {
                    let _ = write!(quoted, "\\u{:04x}", u32::from(c));
                }
                _ => quoted.push(c),
            }
        }
        quoted + "\""
    };
    let columns: Vec<String> = options.columns.iter().map(ToString::to_string).collect();
    line("columns", (!columns.is_empty()).then(|| quoted(columns.join(","))));
    line("unit", options.unit.map(|word| quoted(word.to_string())));
    line("values", options.values.map(|word| quoted(word.to_string())));
    line("scale", options.scale.map(|scale| quoted(scale.to_string())));
    line("holds", options.holds.map(|word| quoted(word.to_string())));
    line("in-plane", options.in_plane.map(|word| quoted(word.to_string())));
    line("azimuth-from", options.azimuth_from.map(|word| quoted(word.to_string())));
    line("decimal-comma", options.decimal_comma.map(|is| is.to_string()));
    out
}
