//! The contents of a file: the data, and facts about them.

use std::borrow::Cow;

use lobe_files::printable;
use lobe_table::{Data, Side, Uses};

/// The contents of a file, in the form in which they were measured.
#[derive(Clone, Debug)]
pub struct Document {
    /// The name of the format, if it was read from a file.
    pub format: Option<&'static str>,
    /// The measurements, in the order of the file. Several measurements belong to a sheet: reflection and transmission,
    /// or both of its sides.
    pub parts: Vec<Part>,
    /// Names and values of the header in the order of the file, for people to read. Comments have the name `comment`.
    /// Facts that became part of the data (knots, channels) are left out.
    pub source: Vec<(String, String)>,
    /// Total integrated scatter, the hemispherical integral of `f cos`, as stated in the file for each block of its
    /// data. Empty if it states none. Values are scaled to it only if [`ReadOptions::scale`](crate::ReadOptions::scale)
    /// says so.
    ///
    /// For data in specular coordinates `[channel][psi][sigma]`; for those in spherical coordinates
    /// `[theta_i][phi_i][channel]`, part by part.
    pub tis: Vec<f32>,
    /// How the reader understood a file that leaves something open, in sentences for people: the meaning of columns,
    /// and what was left out.
    pub notes: Vec<String>,
    /// Possible misunderstandings.
    pub doubts: Vec<String>,
    /// The content of a file besides its values, verbatim, so that a writer of the same format can restore it: the name
    /// of each piece, and its text.
    pub kept: Vec<(&'static str, String)>,
}

/// One measurement of a document.
#[derive(Clone, Debug)]
pub struct Part {
    /// The name in the file; may be empty.
    pub name: String,
    /// The side from which the light comes; `None` if the file does not distinguish the sides, or if the data do (see
    /// [`Representation::is_two_sided`](lobe_table::Representation::is_two_sided)).
    pub side: Option<Side>,
    /// The values.
    pub data: Data,
}

impl Part {
    /// A part of a file that does not distinguish the sides.
    pub fn new(name: impl Into<String>, data: impl Into<Data>) -> Self {
        Part { name: name.into(), side: None, data: data.into() }
    }

    /// `true` if the data apply to light from either side.
    pub fn is_of_any_side(&self) -> bool {
        self.side.is_none() && !self.data.representation().is_two_sided()
    }
}

impl Document {
    fn empty() -> Self {
        Document {
            format: None,
            parts: Vec::new(),
            source: Vec::new(),
            tis: Vec::new(),
            notes: Vec::new(),
            doubts: Vec::new(),
            kept: Vec::new(),
        }
    }

    /// One measurement without further facts.
    pub fn new(data: impl Into<Data>) -> Self {
        Document { format: None, parts: vec![Part::new("", data)], ..Document::empty() }
    }

    /// The measurements of a sheet. The name of a single measurement of no particular side becomes a header fact.
    pub fn of_parts(mut parts: Vec<Part>) -> Self {
        let mut source = Vec::new();
        if let [Part { name, side: None, .. }] = parts.as_mut_slice()
            && !name.is_empty()
        {
            source.push(("name".into(), std::mem::take(name)));
        }
        Document { parts, source, ..Document::empty() }
    }

    /// The data, if they are one measurement of no particular side.
    pub fn only(&self) -> Option<&Data> {
        match self.parts.as_slice() {
            [Part { side: None, data, .. }] => Some(data),
            _ => None,
        }
    }

    /// The options that affect any of the measurements.
    pub fn uses(&self) -> Uses {
        self.parts.iter().fold(Uses::default(), |uses, part| uses.or(part.data.representation().uses()))
    }

    /// The names of the representations, for people.
    pub fn kinds(&self) -> String {
        let kinds: Vec<&str> = self.parts.iter().map(|part| part.data.representation().kind().name()).collect();
        kinds.join(", ")
    }

    /// `true` if there are several measurements, or one of a particular side.
    pub fn is_sheet(&self) -> bool {
        self.only().is_none()
    }

    /// The same with header facts that were found earlier, placed first.
    pub(crate) fn with_facts(mut self, facts: Vec<(String, String)>) -> Self {
        self.source.extend(facts);
        self
    }

    /// The same with names and facts made safe to show: see [`printable`](lobe_files::printable).
    pub(crate) fn printable(mut self) -> Self {
        let facts = self.source.iter_mut().flat_map(|(name, value)| [name, value]);
        for text in facts.chain(self.parts.iter_mut().map(|part| &mut part.name)).chain(&mut self.notes) {
            if let Cow::Owned(shown) = printable(text) {
                *text = shown;
            }
        }
        self
    }

    /// The same with header facts; those without a value are left out.
    pub(crate) fn with_source(mut self, source: &[(&str, &str)]) -> Self {
        let stated = source.iter().filter(|(_, value)| !value.is_empty());
        self.source.extend(stated.map(|(name, value)| ((*name).into(), (*value).into())));
        self
    }
}

/// Data of a known type, and facts from their file.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured<T> {
    /// The data.
    pub data: T,
    /// The same as [`Document::source`].
    pub source: Vec<(String, String)>,
    /// The same as [`Document::tis`].
    pub tis: Vec<f32>,
}

impl<T: Into<Data>> From<Measured<T>> for Document {
    fn from(Measured { data, source, tis }: Measured<T>) -> Self {
        Document { source, tis, ..Document::new(data) }
    }
}
