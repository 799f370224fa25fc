//! Writing a file so that it is whole or not there.

use std::io::Write as _;
use std::path::Path;

use crate::{FormatError, Place};

/// Writes `content` to a temporary file beside `path` and renames it, so that nobody ever sees half a file.
pub(crate) fn write_whole(path: &Path, content: &[u8]) -> Result<(), FormatError> {
    let failed =
        |error: std::io::Error| FormatError::new(path, Place::File, error.to_string(), "a file that can be written");
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    // Temporary files are private by default; this one becomes an ordinary file, under the user's umask.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder).map_err(failed)?;
    file.write_all(content).map_err(failed)?;
    file.as_file().sync_all().map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}
