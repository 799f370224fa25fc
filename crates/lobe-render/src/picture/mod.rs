//! Films as files: EXR with everything, PNG for viewing.

mod environment_file;
mod exr_file;
mod inspect;
mod layout;
mod meta;
mod png_file;
mod spectra;

use std::path::{Path, PathBuf};

use lobe_files::sentence;

pub use environment_file::{read_environment, read_environment_as};
pub use exr_file::{read_partial, read_partial_in, write_exr, write_exr_in};
pub use inspect::{Inspected, Light, inspect};
pub use lobe_colour::ToneMap;
pub use meta::{Difference, Meta};
pub use png_file::{Shown, encode_png, encode_png_in, encode_rgb, write_png, write_png_in};
pub use spectra::{Quantity, SpectralPicture, read_spectral};

/// The reason why a picture cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// An error of the system.
    #[error("{file}: {error}")]
    Io {
        /// The file.
        file: PathBuf,
        /// The error of the system.
        error: std::io::Error,
    },
    /// The file is damaged or of another kind.
    #[error("{}: {}", file.display(), sentence(found, expected))]
    Content {
        /// The file.
        file: PathBuf,
        /// What was found.
        found: String,
        /// What was expected.
        expected: &'static str,
    },
}

/// Writes a file completely or leaves the old one alone.
fn replace(path: &Path, bytes: &[u8]) -> Result<(), PictureError> {
    lobe_files::replace(path, bytes).map_err(|error| PictureError::Io { file: path.into(), error })
}
