//! A material with its origin, prepared without the lock of the interpreter.

use std::path::Path;
use std::sync::Arc;

use lobe_formats::{Document, Format};
use lobe_ops::Subject;
use lobe_ops::check::guesses;
use lobe_ops::resample::Resampling;
use pyo3::prelude::*;

use crate::content::Content;
use crate::errors::Failure;
use crate::options::{Choices, Chosen};
use crate::threads;

/// A material and its origin.
pub struct Opened {
    /// The data, and the material for the operations.
    pub subject: Arc<Subject>,
    /// The same material.
    pub material: Arc<lobe::Material>,
    /// The source of the data.
    pub content: Content,
    /// How it is evaluated.
    pub choices: Choices,
    /// The difference from the material from which it was resampled.
    pub resampling: Option<Resampling>,
}

impl Opened {
    /// The material of a document, and of the file from which it was read, if there is one. Warns about guesses.
    ///
    /// # Errors
    /// If the document is not a material, or does not fit the options.
    pub fn new(
        py: Python<'_>,
        file: Option<&Path>,
        format: Format,
        document: Document,
        choices: Choices,
        content: Content,
    ) -> PyResult<Self> {
        let Chosen { options, backend } = choices.chosen()?;
        let prepared = threads::watched(py, |_| -> Result<Subject, Failure> {
            choices.check(&document)?;
            let material = lobe::Material::from_document(&document, &options);
            let material = material.map_err(|error| match file {
                Some(file) => Failure::from(error.in_file(file)),
                None => error.into(),
            })?;
            Ok(Subject::new(format, document, material.with_backend(backend), &options))
        });
        let subject = prepared??;
        let warn = py.import("lobe_bsdf._errors")?.getattr("warn_of_guess")?;
        for guess in guesses(&subject.document).iter().chain(&subject.document.doubts) {
            let file = file.map(|file| format!("{}: ", file.display())).unwrap_or_default();
            warn.call1((format!("{file}{guess}"),))?;
        }
        let material = Arc::new(subject.material.clone());
        Ok(Opened { subject: Arc::new(subject), material, content, choices, resampling: None })
    }
}
