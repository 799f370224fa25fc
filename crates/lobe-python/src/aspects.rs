//! Selects a measurement of a sheet.

use lobe::{Aspect, Scatter, Side};
use lobe_ops::Subject;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::options::word;

/// The selection.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    scatter: Option<Scatter>,
    side: Option<Side>,
}

/// Reflection or transmission.
///
/// # Errors
/// `ValueError` if it is neither.
pub fn scatter(found: &str) -> PyResult<Scatter> {
    word("scatter", found, &[("reflection", Scatter::Reflection), ("transmission", Scatter::Transmission)])
}

impl Asked {
    /// The selection by keyword arguments.
    ///
    /// # Errors
    /// `ValueError` if they are not among the words allowed.
    pub fn new(scatter_word: Option<&str>, side: Option<&str>) -> PyResult<Self> {
        let side = side.map(|side| word("side", side, &[("front", Side::Front), ("back", Side::Back)])).transpose()?;
        Ok(Asked { scatter: scatter_word.map(scatter).transpose()?, side })
    }

    /// The only measurement of `all` that matches.
    ///
    /// # Errors
    /// `ValueError` if there is none, or several.
    pub fn one(self, all: &[Aspect]) -> PyResult<Aspect> {
        let fits = |aspect: &&Aspect| {
            self.scatter.is_none_or(|scatter| scatter == aspect.scatter)
                && self.side.is_none_or(|side| side == aspect.light)
        };
        let chosen: Vec<Aspect> = all.iter().filter(fits).copied().collect();
        match chosen.as_slice() {
            [one] => Ok(*one),
            [] => Err(PyValueError::new_err(format!("found {}; expected the requested scatter and side", shown(all)))),
            several => Err(PyValueError::new_err(format!(
                "found {}; expected scatter= or side= to select one",
                shown(several)
            ))),
        }
    }

    /// The only measurement of a file that matches.
    ///
    /// # Errors
    /// The same as for [`one`](Self::one).
    pub fn of(self, subject: &Subject) -> PyResult<Aspect> {
        self.one(&subject.aspects())
    }
}

fn shown(aspects: &[Aspect]) -> String {
    let shown: Vec<String> = aspects.iter().map(Aspect::to_string).collect();
    if shown.is_empty() { "no measurement".into() } else { shown.join(", ") }
}
