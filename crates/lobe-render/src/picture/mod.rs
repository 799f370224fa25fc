//! Films as files: EXR with everything, PNG to look at.

mod environment_file;
mod exr_file;
mod meta;
mod png_file;

use std::io::Write;
use std::path::{Path, PathBuf};

pub use environment_file::read_environment;
pub use exr_file::{read_partial, write_exr};
pub use lobe_colour::ToneMap;
pub use meta::Meta;
pub use png_file::{encode_png, encode_rgb, write_png};

/// Why a picture cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The system refuses.
    #[error("{file}: {error}")]
    Io {
        /// The file.
        file: PathBuf,
        /// What the system says.
        error: std::io::Error,
    },
    /// The file is damaged or of another kind.
    #[error("{file}: found {found}; expected {expected}")]
    Content {
        /// The file.
        file: PathBuf,
        /// What is there.
        found: String,
        /// What should be there.
        expected: &'static str,
    },
}

/// Writes next to the file and renames, so that there is never half a file.
fn replace(path: &Path, bytes: &[u8]) -> Result<(), PictureError> {
    let failed = |error| PictureError::Io { file: path.into(), error };
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = tempfile::Builder::new().prefix(".lobe-").tempfile_in(folder).map_err(failed)?;
    file.write_all(bytes).map_err(failed)?;
    // A temporary file is private; a picture is as readable as what the folder's owner makes otherwise.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = std::fs::metadata(path).map_or(0o644, |old| old.permissions().mode() & 0o777);
        file.as_file().set_permissions(std::fs::Permissions::from_mode(mode)).map_err(failed)?;
    }
    file.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}
