//! A TOML document whose tables are queried for the keys that they may have, so that every mistake is reported with its
//! place.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// An error of a scene, and its place.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}:{line}: {key}{}{message}", file.display(), if key.is_empty() { "" } else { ": " })]
pub struct SceneError {
    /// The scene file.
    pub file: PathBuf,
    /// The line, counted from 1; also 1 if the error is about the file as a whole.
    pub line: usize,
    /// The key, with dots between its parts; empty if there is none.
    pub key: String,
    /// What was found and what was expected.
    pub message: String,
}

/// The text of a scene file.
pub(crate) struct Source<'t> {
    pub file: &'t Path,
    pub text: &'t str,
}

impl Source<'_> {
    pub fn error(&self, at: usize, key: impl Into<String>, message: impl Into<String>) -> SceneError {
        let before = &self.text.as_bytes()[..at.min(self.text.len())];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
        SceneError { file: self.file.into(), line, key: key.into(), message: message.into() }
    }

    /// Parses the text.
    pub fn table(&self) -> Result<Spanned<DeTable<'_>>, SceneError> {
        DeTable::parse(self.text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start);
            self.error(at, "", error.message().lines().collect::<Vec<_>>().join("; "))
        })
    }
}

/// A table that remembers which of its keys were read.
pub(crate) struct Node<'s, 't> {
    source: &'s Source<'t>,
    /// The name of the table: `camera`, `light[2]`.
    pub name: String,
    at: usize,
    table: &'s DeTable<'s>,
    asked: RefCell<BTreeSet<String>>,
}

type Value<'s> = &'s Spanned<DeValue<'s>>;

impl<'s, 't> Node<'s, 't> {
    pub fn new(source: &'s Source<'t>, name: impl Into<String>, at: usize, table: &'s DeTable<'s>) -> Self {
        Node { source, name: name.into(), at, table, asked: RefCell::default() }
    }

    fn path(&self, key: &str) -> String {
        if self.name.is_empty() { key.into() } else { format!("{}.{key}", self.name) }
    }

    fn get(&self, key: &str) -> Option<Value<'s>> {
        self.asked.borrow_mut().insert(key.into());
        self.table.get(key)
    }

    /// `true` if there is such a key.
    pub fn has(&self, key: &str) -> bool {
        self.table.get(key).is_some()
    }

    /// An error about the value of a key, or about the table if the key is missing.
    pub fn error(&self, key: &str, message: impl Into<String>) -> SceneError {
        match self.table.get(key) {
            Some(value) => self.source.error(value.span().start, self.path(key), message),
            None if key.is_empty() => self.source.error(self.at, &*self.name, message),
            None => self.source.error(self.at, self.path(key), message),
        }
    }

    fn missing(&self, key: &str, expected: &str) -> SceneError {
        self.error(key, format!("found nothing; expected {expected}"))
    }

    fn wrong<T>(&self, key: &str, value: Value<'_>, expected: &str) -> Result<T, SceneError> {
        Err(self.error(key, format!("found {}; expected {expected}", shown(value.get_ref()))))
    }

    /// Fails if there are keys that were never read.
    pub fn finish(&self) -> Result<(), SceneError> {
        let asked = self.asked.borrow();
        match self.table.keys().find(|key| !asked.contains(&**key.get_ref())) {
            None => Ok(()),
            Some(key) => {
                let known: Vec<&str> = asked.iter().map(String::as_str).collect();
                let hint = similar(key.get_ref(), &known).map(|known| format!(", did you mean `{known}`?"));
                let message = format!("no such key{}; expected one of {}", hint.unwrap_or_default(), known.join(", "));
                Err(self.source.error(key.span().start, self.path(key.get_ref()), message))
            }
        }
    }

    /// The keys, in their order.
    pub fn keys(&self) -> Vec<String> {
        self.table.keys().map(|key| key.get_ref().to_string()).collect()
    }

    /// A table in this one.
    pub fn child(&self, key: &str) -> Result<Option<Node<'s, 't>>, SceneError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        match value.get_ref().as_table() {
            Some(table) => Ok(Some(Node::new(self.source, self.path(key), value.span().start, table))),
            None => self.wrong(key, value, "a table"),
        }
    }

    /// The tables of an array; none if there is no such key.
    pub fn children(&self, key: &str) -> Result<Vec<Node<'s, 't>>, SceneError> {
        let Some(value) = self.get(key) else { return Ok(Vec::new()) };
        let Some(array) = value.get_ref().as_array() else { return self.wrong(key, value, "an array of tables") };
        let node = |(index, value): (usize, Value<'s>)| match value.get_ref().as_table() {
            Some(table) => {
                Ok(Node::new(self.source, format!("{}[{index}]", self.path(key)), value.span().start, table))
            }
            None => self.wrong(key, value, "a table"),
        };
        array.iter().enumerate().map(node).collect()
    }

    /// A text.
    pub fn text(&self, key: &str) -> Result<Option<&'s str>, SceneError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        match value.get_ref().as_str() {
            Some(text) => Ok(Some(text)),
            None => self.wrong(key, value, "text in quotes"),
        }
    }

    /// A text that is required.
    pub fn required_text(&self, key: &str, expected: &str) -> Result<&'s str, SceneError> {
        self.text(key)?.ok_or_else(|| self.missing(key, expected))
    }

    /// An array of texts; none if there is no such key.
    pub fn texts(&self, key: &str) -> Result<Vec<&'s str>, SceneError> {
        let Some(value) = self.get(key) else { return Ok(Vec::new()) };
        let texts =
            value.get_ref().as_array().and_then(|array| array.iter().map(|text| text.get_ref().as_str()).collect());
        texts.map_or_else(|| self.wrong(key, value, "an array of texts in quotes"), Ok)
    }

    /// `true` or `false`; `false` if there is no such key.
    pub fn flag(&self, key: &str) -> Result<bool, SceneError> {
        let Some(value) = self.get(key) else { return Ok(false) };
        match value.get_ref().as_bool() {
            Some(flag) => Ok(flag),
            None => self.wrong(key, value, "true or false"),
        }
    }

    /// A number that `fits`, described by `expected`.
    pub fn number(&self, key: &str, expected: &str, fits: impl Fn(f64) -> bool) -> Result<Option<f64>, SceneError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        match number(value.get_ref()) {
            Some(found) if fits(found) => Ok(Some(found)),
            _ => self.wrong(key, value, expected),
        }
    }

    /// A number above 0.
    pub fn positive(&self, key: &str) -> Result<Option<f32>, SceneError> {
        let found = self.number(key, "a number above 0", |x| x > 0.0 && x as f32 > 0.0)?;
        Ok(found.map(|x| x as f32))
    }

    /// A whole number in a range.
    pub fn whole(&self, key: &str, range: std::ops::RangeInclusive<u32>) -> Result<Option<u32>, SceneError> {
        let expected = format!("a whole number from {} to {}", range.start(), range.end());
        let fits = |x: f64| x.fract() == 0.0 && x >= f64::from(*range.start()) && x <= f64::from(*range.end());
        Ok(self.number(key, &expected, fits)?.map(|x| x as u32))
    }

    /// An array of three numbers of which each `fits`.
    pub fn three(&self, key: &str, expected: &str, fits: impl Fn(f64) -> bool) -> Result<Option<[f64; 3]>, SceneError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        let numbers = value.get_ref().as_array().and_then(|array| {
            array.iter().map(|value| number(value.get_ref()).filter(|x| fits(*x))).collect::<Option<Vec<f64>>>()
        });
        match numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok()) {
            Some(three) => Ok(Some(three)),
            None => self.wrong(key, value, expected),
        }
    }

    /// An array of numbers.
    pub fn numbers(&self, key: &str, expected: &str) -> Result<Option<Vec<f64>>, SceneError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        let numbers = value.get_ref().as_array();
        let numbers = numbers.and_then(|array| array.iter().map(|value| number(value.get_ref())).collect());
        numbers.map_or_else(|| self.wrong(key, value, expected), |numbers| Ok(Some(numbers)))
    }

    /// `true` if the value of a key is text.
    pub fn is_text(&self, key: &str) -> bool {
        self.get(key).is_some_and(|value| value.get_ref().is_str())
    }

    /// A point or a direction.
    pub fn vector(&self, key: &str) -> Result<Option<[f32; 3]>, SceneError> {
        let three = self.three(key, "three numbers of magnitude up to 1e9", |x| x.abs() <= 1e9)?;
        Ok(three.map(|v| v.map(|x| x as f32)))
    }

    /// A point or a direction that is required.
    pub fn required_vector(&self, key: &str) -> Result<[f32; 3], SceneError> {
        self.vector(key)?.ok_or_else(|| self.missing(key, "three numbers"))
    }

    /// A colour: three numbers from 0 to `most`, or one for all three.
    pub fn colour(&self, key: &str, most: f64) -> Result<Option<[f32; 3]>, SceneError> {
        let expected = if most == f64::MAX {
            "three numbers that are not negative, or one".to_owned()
        } else {
            format!("three numbers from 0 to {most}, or one")
        };
        let fits = |x: f64| x >= 0.0 && x <= most && (x as f32).is_finite();
        if self.get(key).is_some_and(|value| !value.get_ref().is_array()) {
            return Ok(self.number(key, &expected, fits)?.map(|x| [x as f32; 3]));
        }
        Ok(self.three(key, &expected, fits)?.map(|c| c.map(|x| x as f32)))
    }

    /// A colour that is required.
    pub fn required_colour(&self, key: &str, most: f64) -> Result<[f32; 3], SceneError> {
        self.colour(key, most)?.ok_or_else(|| self.missing(key, "a colour, three numbers or one"))
    }
}

/// The most similar of several words, if it is similar enough.
fn similar<'w>(word: &str, known: &[&'w str]) -> Option<&'w str> {
    let likeness = |known: &&str| strsim::normalized_damerau_levenshtein(&word.to_lowercase(), known);
    let found = known.iter().copied().max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    (likeness(&found) > 0.6).then_some(found)
}

fn number(value: &DeValue<'_>) -> Option<f64> {
    let parsed = match (value.as_integer(), value.as_float()) {
        (Some(integer), _) if integer.radix() == 10 => integer.as_str().parse().ok(),
        (_, Some(float)) => float.as_str().parse().ok(),
        _ => None,
    };
    parsed.filter(|x: &f64| x.is_finite())
}

/// A value as shown in an error.
fn shown(value: &DeValue<'_>) -> String {
    let number = value.as_integer().map(|i| i.as_str()).or_else(|| value.as_float().map(|f| f.as_str()));
    match (number, value.as_str(), value.as_bool(), value.as_array()) {
        (Some(number), ..) => number.to_owned(),
        (_, Some(text), ..) => format!("`{}`", lobe_files::excerpt(text, 40)),
        (_, _, Some(flag), _) => flag.to_string(),
        (.., Some(array)) if array.len() <= 4 => {
            let parts: Vec<String> = array.iter().map(|value| shown(value.get_ref())).collect();
            format!("[{}]", parts.join(", "))
        }
        (.., Some(array)) => format!("an array of {}", array.len()),
        _ => format!("a {}", value.type_str()),
    }
}

#[cfg(test)]
mod tests {
    use super::similar;

    #[test]
    fn a_typo_finds_the_intended_word() {
        let known = ["material", "materials", "radius", "rotate", "shading", "two_sided"];
        for (word, meant) in
            [("raduis", "radius"), ("Radius", "radius"), ("two-sided", "two_sided"), ("matrial", "material")]
        {
            assert_eq!(similar(word, &known), Some(meant), "{word}");
        }
        assert_eq!(similar("colour", &known), None);
        assert_eq!(similar("x", &[]), None);
    }
}
