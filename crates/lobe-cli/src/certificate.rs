//! The error of a written file, measured as by `lobe compare`.

use std::borrow::Cow;
use std::path::Path;

use lobe::{Material, Options};
use lobe_formats::Document;
use lobe_ops::Subject;
use lobe_ops::certify::{Certified, LIMIT, PAIRS, certify, worst};
use serde::Serialize;

use crate::failure::Failure;
use crate::target::Target;

/// The file that is being converted.
pub struct Source<'a> {
    subject: Subject,
    file: &'a Path,
    channel: Option<&'a str>,
}

/// The errors found, one per measurement.
#[derive(Serialize)]
#[serde(transparent)]
pub struct Certificate(Vec<Certified>);

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

    /// Compares a written file with the source. `None` if they have no channels, no colours or no side in common.
    pub fn certify(&self, written: &Path) -> Result<Option<Certificate>, Failure> {
        let written = Subject::open(written, &Options::default())?;
        let certified = certify(&self.subject, &written, self.channel, PAIRS).ok();
        Ok(certified.filter(|certified| !certified.is_empty()).map(Certificate))
    }

    /// Writes a document to a temporary folder, under the name of its file, reads it back, and compares it. `None` as
    /// in [`certify`](Self::certify), and of formats that are only written.
    pub fn certify_written(
        &self,
        document: &Document,
        target: Target,
        out: &Path,
    ) -> Result<Option<Certificate>, Failure> {
        if target.format.spec().read.is_none() {
            return Ok(None);
        }
        let failed = |error: std::io::Error| Failure::File(format!("a temporary folder: {error}"));
        let folder = tempfile::tempdir().map_err(failed)?;
        let draft = folder.path().join(out.file_name().unwrap_or_default());
        let shown = |error: lobe_formats::FormatError| {
            let error = error.to_string();
            Failure::File(error.replace(&*draft.to_string_lossy(), &out.to_string_lossy()))
        };
        (target.writer.write)(document, &draft).map_err(shown)?;
        self.certify(&draft)
    }

    /// The reason why an error cannot be bounded.
    pub fn no_bound(&self, out: &Path) -> Failure {
        let expected = "a format that lobe reads, and a side and channels or colours that the source also has";
        Failure::Usage(format!("{}: found nothing to compare with the source; expected {expected}", out.display()))
    }
}

impl Certificate {
    /// The largest of the relative errors (root mean square).
    pub fn worst(&self) -> f64 {
        worst(&self.0)
    }

    /// One line of text per measurement.
    pub fn lines(&self) -> impl Iterator<Item = String> {
        let is_one = self.0.len() == 1;
        self.0.iter().map(move |Certified { aspect, difference }| {
            let (pairs, max, rms) = (difference.pairs, difference.max, difference.rms);
            let prefix = if is_one { String::new() } else { format!("{aspect}: ") };
            format!(
                "{prefix}differs from the source by at most {max:.3e} 1/sr, rms {rms:.3e} 1/sr ({:.3} %), at {pairs} \
                 pairs up to {LIMIT} degrees",
                100.0 * difference.relative_rms
            )
        })
    }

    /// All measurements on one line.
    pub fn line(&self) -> String {
        self.lines().collect::<Vec<_>>().join("; ")
    }
}
