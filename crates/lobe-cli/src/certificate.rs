//! The file that is being converted, with which the written one is compared.

use std::borrow::Cow;
use std::path::Path;

use lobe::{Material, Options};
use lobe_formats::{Document, Format};
use lobe_ops::Subject;
use lobe_ops::certificate::{Certificate, DraftError, Stated};

use crate::failure::Failure;
use crate::message::say;
use crate::target::Target;

/// The file that is being converted.
pub struct Source<'a> {
    subject: Subject,
    file: &'a Path,
    channel: Option<&'a str>,
}

impl<'a> Source<'a> {
    /// Takes the document of a file, of which only `channel` is written if there is one. `None` if the document has no
    /// values for pairs of directions.
    pub fn new(file: &'a Path, document: &Document, target: Target, channel: Option<&'a str>) -> Option<Self> {
        let options = Options::default();
        let material = Material::from_document(document, &options).ok()?;
        // A subject has the format from which it was read, which is not used here.
        let subject = Subject::new(target.format, document.clone(), material, &options);
        Some(Source { subject, file, channel })
    }

    pub fn document(&self) -> &Document {
        &self.subject.document
    }

    /// `true` if the file has Mueller matrices.
    pub fn is_polarised(&self) -> bool {
        self.document().parts.iter().any(|part| part.data.representation().is_polarised())
    }

    /// The name of the file.
    pub fn name(&self) -> Cow<'_, str> {
        self.file.file_name().unwrap_or_default().to_string_lossy()
    }

    /// The error of a written file with the values and nodes of the source; `None` if it is the same between them.
    pub fn certify_kept(&self, format: Format, written: &Path) -> Result<Option<Stated>, Failure> {
        Ok(Certificate::of_kept(&self.subject, self.channel, format, written)?)
    }

    /// Compares what would be read from a written document with the source.
    pub fn certify_draft(&self, document: &Document, target: Target, out: &Path) -> Result<Stated, Failure> {
        Ok(Certificate::of_draft(&self.subject, self.channel, document, target.format, out)?)
    }
}

/// The error of a file if it is known, otherwise the reason why it is not.
pub fn split(stated: Stated) -> (Option<Certificate>, Option<String>) {
    match stated {
        Ok(certificate) => (Some(certificate), None),
        Err(why) => (None, Some(why.to_string())),
    }
}

/// Reports the error of a file on standard error, or the reason why none is known.
pub fn report(stated: &Stated) {
    match stated {
        Ok(certificate) => certificate.lines().for_each(|line| say(format_args!("  {line}"))),
        Err(why) => say(format_args!("  the error of the file is not stated: {why}")),
    }
}

impl From<DraftError> for Failure {
    fn from(error: DraftError) -> Self {
        match error {
            DraftError::Write(error) => error.into(),
            DraftError::Read(error) => error.into(),
            other => Failure::File(other.to_string()),
        }
    }
}
