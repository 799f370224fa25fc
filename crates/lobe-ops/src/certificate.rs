//! The error that is stated of a converted file.

use std::io;
use std::path::Path;

use lobe::{OpenError, Options};
use lobe_formats::{Document, Format, FormatError};
use serde::Serialize;
use thiserror::Error;

use crate::Subject;
use crate::certify::{Certified, Incomparable, LIMIT, PAIRS, certify, worst};

/// The errors of a converted file, one per measurement, as `lobe compare` finds them.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Certificate(pub Vec<Certified>);

/// Why no error is stated of a file.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Unstated {
    /// The format is only written.
    #[error("lobe does not read this format")]
    NotRead,
    /// There is nothing to compare.
    #[error(transparent)]
    Incomparable(#[from] Incomparable),
}

/// A draft of a file could not be written or read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum DraftError {
    /// There is no place for it.
    #[error("a temporary folder: {0}")]
    Folder(#[from] io::Error),
    /// It cannot be written.
    #[error(transparent)]
    Write(#[from] FormatError),
    /// It cannot be read back.
    #[error(transparent)]
    Read(#[from] OpenError),
}

/// A file that keeps values and nodes rounds them: differences up to this are not an error. It is the root mean square
/// of the difference relative to that of the values.
pub const ROUNDED: f64 = 2e-6;
/// The same for the largest difference, relative to the largest value.
const ROUNDED_PEAK: f64 = 1e-5;

/// The error of a file, or the reason why none is stated.
pub type Stated = Result<Certificate, Unstated>;

impl Certificate {
    /// Compares a written file with its source, of which only `channel` was written if there is one.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn of_file(source: &Subject, channel: Option<&str>, written: &Path) -> Result<Stated, OpenError> {
        let written = Subject::open(written, &Options::default())?;
        Ok(certify(source, &written, channel, PAIRS).map(Certificate).map_err(Unstated::from))
    }

    /// The error of a file with the values and nodes of its source, of which only `channel` was written if there is one.
    /// `None` if the values between the nodes are the same too, except for rounding, or if lobe does not read the format.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn of_kept(
        source: &Subject,
        channel: Option<&str>,
        format: Format,
        written: &Path,
    ) -> Result<Option<Stated>, OpenError> {
        if format.spec().read.is_none() {
            return Ok(None);
        }
        let written = Subject::open(written, &Options::default())?;
        Ok(Certificate::between_nodes(source, &written, channel))
    }

    /// The same for a file that was read.
    ///
    /// The format may turn the nodes into another representation; and samples that are listed in another order, or whose
    /// angles are rounded, may be joined to other triangles.
    pub fn between_nodes(source: &Subject, written: &Subject, channel: Option<&str>) -> Option<Stated> {
        let is_same_kind = source.document.kinds() == written.document.kinds();
        match certify(source, written, channel, PAIRS) {
            Ok(errors) if is_same_kind && errors.iter().all(is_rounding) => None,
            Err(_) if is_same_kind => None,
            certified => Some(certified.map(Certificate).map_err(Unstated::from)),
        }
    }

    /// Compares what would be read from a file: writes the document to a temporary folder, under the name of the file,
    /// and reads it back.
    ///
    /// # Errors
    /// [`DraftError`], whose messages name the file, not the temporary one.
    pub fn of_draft(
        source: &Subject,
        channel: Option<&str>,
        document: &Document,
        format: Format,
        out: &Path,
    ) -> Result<Stated, DraftError> {
        let (Some(writer), true) = (format.writer(), format.spec().read.is_some()) else {
            return Ok(Err(Unstated::NotRead));
        };
        drafted(out, |draft| {
            (writer.write)(document, draft)?;
            Ok(Certificate::of_file(source, channel, draft)?)
        })
    }

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

fn is_rounding(Certified { difference, .. }: &Certified) -> bool {
    difference.relative_rms <= ROUNDED && difference.max <= ROUNDED_PEAK * difference.peak
}

/// Does work on a file of the same name in a temporary folder.
///
/// # Errors
/// Those of the work, with the name of `out` in place of the temporary one.
fn drafted<T>(out: &Path, work: impl FnOnce(&Path) -> Result<T, DraftError>) -> Result<T, DraftError> {
    let folder = tempfile::tempdir()?;
    let draft = folder.path().join(out.file_name().unwrap_or_default());
    work(&draft).map_err(|error| match error {
        DraftError::Write(error) | DraftError::Read(OpenError::Format(error)) if error.file == draft => {
            DraftError::Write(FormatError { file: out.into(), ..error })
        }
        DraftError::Read(error) => DraftError::Read(error.in_file(out)),
        other => other,
    })
}
