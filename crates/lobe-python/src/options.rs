//! Keyword arguments for the backend, and for facts that are missing in a file.

use lobe::{Backend, Decode, Edges, Given, Lookup, Options};
use lobe_formats::reading::parse_columns;
use lobe_formats::{Document, ReadOptions};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::Failure;

/// The words for each of several choices.
type Words<T> = &'static [(&'static str, T)];

const EDGES: Words<fn() -> Edges> =
    &[("clamp", Edges::default), ("extrapolate", Edges::extrapolate), ("zero", Edges::zero)];
const LOOKUPS: Words<Lookup> = &[("nearest", Lookup::Nearest), ("linear", Lookup::Linear)];
const DECODES: Words<Decode> = &[("raw", Decode::Raw), ("srgb", Decode::Srgb)];
const GIVEN: Words<Given> = &[("light", Given::Light), ("viewer", Given::Viewer)];

/// The choice that a word stands for.
///
/// # Errors
/// `ValueError` with the allowed words.
pub fn word<T: Copy>(argument: &str, found: &str, words: &[(&'static str, T)]) -> PyResult<T> {
    let known = words.iter().find(|(word, _)| *word == found).map(|(_, choice)| *choice);
    known.ok_or_else(|| {
        let expected: Vec<String> = words.iter().map(|(word, _)| format!("{word:?}")).collect();
        PyValueError::new_err(format!("{argument}: found {found:?}; expected {}", expected.join(" or ")))
    })
}

/// The given direction.
///
/// # Errors
/// `ValueError` if it is neither.
pub fn given(found: &str) -> PyResult<Given> {
    word("given", found, GIVEN)
}

/// The backend of this name, or the detected one.
///
/// # Errors
/// `ValueError` if this machine has no backend of this name.
pub fn backend(name: Option<&str>, strict: bool) -> PyResult<Backend> {
    let found = match name {
        Some(name) => Backend::named(name),
        None => Backend::detect(),
    };
    let found = found.map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(if strict { found.strict() } else { found })
}

/// How a material is evaluated, as given by the caller, so that a copy can use the same.
#[derive(Clone, Debug)]
pub struct Choices {
    backend: Option<String>,
    strict: bool,
    edges: String,
    lookup: String,
    indexed_by: String,
    decode: String,
}

/// The same, parsed.
#[derive(Clone, Debug)]
pub struct Chosen {
    /// How data are prepared.
    pub options: Options,
    /// The backend.
    pub backend: Backend,
}

impl Choices {
    /// The words of keyword arguments.
    pub fn new(
        backend: Option<String>,
        strict: bool,
        edges: &str,
        lookup: &str,
        indexed_by: &str,
        decode: &str,
    ) -> Self {
        let [edges, lookup, indexed_by, decode] = [edges, lookup, indexed_by, decode].map(String::from);
        Choices { backend, strict, edges, lookup, indexed_by, decode }
    }

    /// The same for a table in specular coordinates.
    pub fn of_table(&self) -> Self {
        let edges = self.edges.clone();
        Choices { edges, ..Choices::new(self.backend.clone(), self.strict, "clamp", "nearest", "light", "raw") }
    }

    /// Parses the words.
    ///
    /// # Errors
    /// `ValueError` for an unexpected word.
    pub fn chosen(&self) -> PyResult<Chosen> {
        let options = Options {
            edges: word("edges", &self.edges, EDGES)?(),
            lookup: word("lookup", &self.lookup, LOOKUPS)?,
            decode: word("decode", &self.decode, DECODES)?,
            indexed_by: word("indexed_by", &self.indexed_by, GIVEN)?,
        };
        Ok(Chosen { options, backend: backend(self.backend.as_deref(), self.strict)? })
    }

    /// Refuses options that would make no difference, because the caller expects one.
    ///
    /// # Errors
    /// If no part of the document uses an option that is not the default.
    pub fn check(&self, document: &Document) -> Result<(), Failure> {
        let uses = document.uses();
        let check = |option: &str, is_given: bool, applies: bool, expected: &str| match is_given && !applies {
            true => Err(Failure::value(format!("{option}: found {}; expected {expected}", document.kinds()))),
            false => Ok(()),
        };
        check("edges", self.edges != "clamp", uses.edges, "a table in specular coordinates")?;
        check("lookup", self.lookup != "nearest", uses.lookup, "a grid of half and difference angles")?;
        check("indexed_by", self.indexed_by != "light", uses.indexed_by, "a material of the EPFL database")?;
        check("decode", self.decode != "raw", uses.decode, "a material of the UTIA database")
    }

    /// The keyword arguments that are not the default.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn keywords<'py>(&self, keywords: &Bound<'py, pyo3::types::PyDict>) -> PyResult<()> {
        if let Some(backend) = &self.backend {
            keywords.set_item("backend", backend)?;
        }
        if self.strict {
            keywords.set_item("strict", true)?;
        }
        let words = [
            ("edges", &self.edges),
            ("lookup", &self.lookup),
            ("indexed_by", &self.indexed_by),
            ("decode", &self.decode),
        ];
        for (name, word) in words {
            keywords.set_item(name, word)?;
        }
        Ok(())
    }
}

/// Facts missing in a file, as on the command line.
#[derive(FromPyObject)]
pub enum Factor {
    /// A number.
    Number(f64),
    /// `tis`.
    Word(String),
}

/// The keyword arguments that give facts missing in a file.
#[derive(Default)]
pub struct Reading {
    pub columns: Option<String>,
    pub unit: Option<String>,
    pub values: Option<String>,
    pub scale: Option<Factor>,
    pub holds: Option<String>,
    pub in_plane: Option<String>,
    pub azimuth_from: Option<String>,
    pub decimal_comma: Option<bool>,
}

impl Reading {
    /// Parses them.
    ///
    /// # Errors
    /// `ValueError` with what was expected.
    pub fn understood(self) -> PyResult<ReadOptions> {
        fn parsed<T: std::str::FromStr<Err = String>>(argument: &str, text: Option<String>) -> PyResult<Option<T>> {
            let parsed = text.map(|text| text.parse()).transpose();
            parsed.map_err(|error| PyValueError::new_err(format!("{argument}: {error}")))
        }
        let scale = self.scale.map(|factor| match factor {
            Factor::Number(number) => number.to_string(),
            Factor::Word(word) => word,
        });
        let columns = self.columns.as_deref().map(parse_columns).transpose();
        Ok(ReadOptions {
            columns: columns.map_err(|error| PyValueError::new_err(format!("columns: {error}")))?.unwrap_or_default(),
            unit: parsed("unit", self.unit)?,
            values: parsed("values", self.values)?,
            scale: parsed("scale", scale)?,
            holds: parsed("holds", self.holds)?,
            in_plane: parsed("in_plane", self.in_plane)?,
            azimuth_from: parsed("azimuth_from", self.azimuth_from)?,
            decimal_comma: self.decimal_comma,
        })
    }
}

/// The keyword arguments for options of reading.
///
/// # Errors
/// If there is not enough memory.
pub fn reading_keywords(options: &ReadOptions, keywords: &Bound<'_, pyo3::types::PyDict>) -> PyResult<()> {
    if !options.columns.is_empty() {
        let columns: Vec<String> = options.columns.iter().map(ToString::to_string).collect();
        keywords.set_item("columns", columns.join(","))?;
    }
    let words = [
        ("unit", options.unit.map(|word| word.to_string())),
        ("values", options.values.map(|word| word.to_string())),
        ("scale", options.scale.map(|word| word.to_string())),
        ("holds", options.holds.map(|word| word.to_string())),
        ("in_plane", options.in_plane.map(|word| word.to_string())),
        ("azimuth_from", options.azimuth_from.map(|word| word.to_string())),
    ];
    for (name, word) in words {
        if let Some(word) = word {
            keywords.set_item(name, word)?;
        }
    }
    if let Some(comma) = options.decimal_comma {
        keywords.set_item("decimal_comma", comma)?;
    }
    Ok(())
}
